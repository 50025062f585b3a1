//! The modal banks of all channels, computed in groups.

use super::ModalBank;
use super::mix::{LANES, LaneSet, MixBlock};
use super::modal::{SPAN, ring_side_by_side};
use super::push::Pushes;

/// The modal banks of all channels.
///
/// Most of the time a bank only rings on; then all banks of a group are rendered side by side, at the place of use. A
/// bank that is struck in the middle of a block is rendered into the mix's row, up to the strike and on from there.
#[derive(Clone, Debug)]
pub(super) struct ActiveModes {
    banks: Vec<ModalBank>,
    /// Pushes under way for each bank.
    pushes: Vec<Pushes>,
    /// Modes stolen since the last query.
    stolen: u32,
    /// For each bank, the number of samples of the block at hand that are in the mix's row already.
    in_row: Vec<usize>,
    groups: Vec<Group>,
}

/// The state of a group's banks.
#[derive(Clone, Copy, Debug, Default)]
struct Group {
    /// Banks that ring on.
    ringing: LaneSet,
    /// Banks rendered into the mix's rows: struck in the block at hand, with a push under way, or slow.
    in_rows: LaneSet,
    /// Banks rendered side by side in the block at hand.
    side_by_side: LaneSet,
}

impl ActiveModes {
    /// Silent banks for `modes` different modes on each of `channels`.
    pub(super) fn new(sample_rate: u32, channels: usize, modes: usize) -> Self {
        Self {
            banks: vec![ModalBank::new(f64::from(sample_rate), modes); channels],
            pushes: vec![Pushes::new(sample_rate as f32); channels],
            stolen: 0,
            in_row: vec![0; channels],
            groups: vec![Group::default(); channels.div_ceil(LANES)],
        }
    }

    /// Stops everything at once.
    pub(super) fn clear(&mut self) {
        self.banks.iter_mut().for_each(ModalBank::clear);
        self.pushes.iter_mut().for_each(Pushes::clear);
        self.groups.fill(Group::default());
    }

    /// Stops one channel at once.
    pub(super) fn clear_channel(&mut self, channel: usize) {
        if let (Some(bank), Some(pushes)) = (self.banks.get_mut(channel), self.pushes.get_mut(channel)) {
            bank.clear();
            pushes.clear();
        }
    }

    /// The bank of `channel` and its pushes; a strike on them is first audible in sample `at` of the block.
    ///
    /// Strikes of one channel come in the order of their samples.
    pub(super) fn strikable(
        &mut self,
        channel: usize,
        at: usize,
        mix: &mut MixBlock,
    ) -> (&mut ModalBank, &mut Pushes) {
        self.groups[channel / LANES].in_rows |= 1 << (channel % LANES);
        self.render_row(channel, at, mix);
        (&mut self.banks[channel], &mut self.pushes[channel])
    }

    /// Renders the banks in the mix's rows to the block's end, `frames`; returns the number of modes stolen
    /// meanwhile.
    pub(super) fn finish_rows(&mut self, frames: usize, mix: &mut MixBlock) -> u32 {
        for number in 0..self.groups.len() {
            let Group { ringing, in_rows, .. } = self.groups[number];
            self.groups[number].side_by_side = ringing & !in_rows;
            for lane in lanes(in_rows) {
                let channel = number * LANES + lane;
                self.render_row(channel, frames, mix);
                self.in_row[channel] = 0;
                let (bank, struck) = (&self.banks[channel], !self.pushes[channel].is_empty());
                let group = &mut self.groups[number];
                group.ringing = with(group.ringing, lane, !bank.is_silent());
                group.in_rows = with(group.in_rows, lane, struck || (bank.is_slow() && !bank.is_silent()));
            }
        }
        std::mem::take(&mut self.stolen)
    }

    /// Writes the next `samples` of a group's other banks, at most a span, to `columns`; returns false if there are
    /// none.
    pub(super) fn draw(&mut self, group: usize, samples: usize, columns: &mut [[f32; LANES]; SPAN]) -> bool {
        let first = group * LANES;
        let last = self.banks.len().min(first + LANES);
        let (banks, group) = (&mut self.banks[first..last], &mut self.groups[group]);
        if group.side_by_side == 0 {
            return false;
        }
        let ring_on = ring_side_by_side(banks, group.side_by_side, samples, columns);
        group.ringing &= !group.side_by_side | ring_on;
        true
    }

    /// Whether a group has banks to draw side by side.
    pub(super) fn has_more(&self, group: usize) -> bool {
        self.groups[group].side_by_side != 0
    }

    fn render_row(&mut self, channel: usize, end: usize, mix: &mut MixBlock) {
        let (bank, pushes) = (&mut self.banks[channel], &mut self.pushes[channel]);
        let start = self.in_row[channel];
        if !(bank.is_silent() && pushes.is_empty()) && end > start {
            self.stolen += pushes.render(bank, &mut mix.row(channel)[start..end]);
        }
        self.in_row[channel] = end;
    }
}

/// The lanes of a set, from the lowest on.
fn lanes(mut set: LaneSet) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = (set != 0).then(|| set.trailing_zeros() as usize);
        set &= set.wrapping_sub(1);
        lane
    })
}

/// The set with a lane, or without it.
fn with(set: LaneSet, lane: usize, is_in: bool) -> LaneSet {
    set & !(1 << lane) | LaneSet::from(is_in) << lane
}
