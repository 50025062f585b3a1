//! The modal banks of all channels, computed in groups.

use super::ModalBank;
use super::mix::{LANES, Mix};
use super::modal::{SPAN, ring_side_by_side};
use super::push::Pushes;

/// The modal banks of all channels.
///
/// Most of the time a bank only rings on; then all banks of a group are
/// rendered side by side, where they are needed. A bank that is struck in the
/// middle of a block is rendered into the mix's row, up to the strike and on from there.
#[derive(Clone, Debug)]
pub(super) struct ActiveModes {
    banks: Vec<ModalBank>,
    /// What is still striking them.
    pushes: Vec<Pushes>,
    /// Modes that had to make room since somebody asked.
    stolen: u32,
    /// Samples of the block at hand that are in the mix's row; `None` for a bank that was not struck.
    in_row: Vec<Option<usize>>,
    /// Banks that ring and are not in the mix's row.
    side_by_side: Vec<bool>,
}

impl ActiveModes {
    /// Silent banks for `modes` different modes on each of `channels`.
    pub(super) fn new(sample_rate: u32, channels: usize, modes: usize) -> Self {
        Self {
            banks: vec![ModalBank::new(f64::from(sample_rate), modes); channels],
            pushes: vec![Pushes::new(sample_rate as f32); channels],
            stolen: 0,
            in_row: vec![None; channels],
            side_by_side: vec![false; channels],
        }
    }

    /// Stops everything at once.
    pub(super) fn clear(&mut self) {
        self.banks.iter_mut().for_each(ModalBank::clear);
        self.pushes.iter_mut().for_each(Pushes::clear);
    }

    /// Stops one channel at once.
    pub(super) fn clear_channel(&mut self, channel: usize) {
        if let (Some(bank), Some(pushes)) = (self.banks.get_mut(channel), self.pushes.get_mut(channel)) {
            bank.clear();
            pushes.clear();
        }
    }

    /// The bank of `channel` and its pushes, to be struck so that sample `at` of the block is the first that moves.
    ///
    /// Strikes of one channel come in the order of their samples.
    pub(super) fn strikable(
        &mut self,
        channel: usize,
        at: usize,
        mix: &mut Mix,
    ) -> (&mut ModalBank, &mut Pushes) {
        self.render_row(channel, at, mix);
        (&mut self.banks[channel], &mut self.pushes[channel])
    }

    /// Renders what must go through the mix's rows to the block's end, `frames`; the answer is how many
    /// modes had to make room meanwhile.
    pub(super) fn finish_rows(&mut self, frames: usize, mix: &mut Mix) -> u32 {
        for channel in 0..self.banks.len() {
            let bank = &self.banks[channel];
            if self.in_row[channel].is_some() || bank.is_slow() || !self.pushes[channel].is_empty() {
                self.render_row(channel, frames, mix);
                self.in_row[channel] = None;
                self.side_by_side[channel] = false;
            } else {
                self.side_by_side[channel] = !bank.is_silent();
            }
        }
        std::mem::take(&mut self.stolen)
    }

    /// Writes the next `samples` of a group's other banks, at most a span, to `columns`; false if there are none.
    pub(super) fn draw(&mut self, group: usize, samples: usize, columns: &mut [[f32; LANES]; SPAN]) -> bool {
        let first = group * LANES;
        let last = self.banks.len().min(first + LANES);
        let rings = &self.side_by_side[first..last];
        let any = rings.contains(&true);
        if any {
            ring_side_by_side(&mut self.banks[first..last], rings, samples, columns);
        }
        any
    }

    /// Whether a group has any bank to draw.
    pub(super) fn has_more(&self, group: usize) -> bool {
        let first = group * LANES;
        self.side_by_side[first..self.banks.len().min(first + LANES)].contains(&true)
    }

    fn render_row(&mut self, channel: usize, end: usize, mix: &mut Mix) {
        let (bank, pushes) = (&mut self.banks[channel], &mut self.pushes[channel]);
        let start = self.in_row[channel].unwrap_or(0);
        if !(bank.is_silent() && pushes.is_empty()) && end > start {
            self.stolen += pushes.render(bank, &mut mix.row(channel)[start..end]);
        }
        self.in_row[channel] = Some(end);
    }
}
