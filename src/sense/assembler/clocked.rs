//! Frames by the clock: those of boards with a rate of their own.

use super::Assembler;
use super::board::BoardTrack;
use super::clock::{SLOT_NS, SlotClock};
use super::numbering::TimeBase;
use super::timed::TimedStream;
use crate::sense::{HoldDoubt, TileSample};
use crate::wire::SensorPacket;

/// Delay of frames by the clock while other boards, for which frames wait, are late.
const GRACE_NS: i64 = 20 * SLOT_NS;

/// Maximum number of frames made at once: with packets at 10 Hz and no poll in between, a hundred are due.
const MOST_DUE: i64 = 250;

impl Assembler {
    /// Whether frames come by the clock, so that the caller should poll it every millisecond.
    #[must_use]
    pub fn follows_clock(&self) -> bool {
        self.own_rates > 0
    }

    /// The next slot whose frame is due by the clock.
    pub(super) fn clocked_slot(&self) -> Option<i64> {
        let sends = |board: &BoardTrack| {
            board.own_rate.as_ref().is_some_and(|own| own.needs_frames(&board.stream.presence))
        };
        if self.own_rates == 0 || !self.slots.is_empty() || !self.boards.iter().any(sends) {
            return None;
        }
        let grace_ns = if self.slots.awaits_any() { GRACE_NS } else { 0 };
        let due = self.clock.as_ref()?.slot_before(self.times.now_ns() - grace_ns);
        let next = self.slots.done().saturating_add(1).max(due - MOST_DUE);
        (next <= due).then_some(next)
    }

    /// Takes the packet of a board at its own rate; returns false if board `number` sends once a millisecond.
    pub(super) fn is_at_own_rate(&mut self, number: usize, packet: &SensorPacket, clock: &SlotClock) -> bool {
        let now_ns = self.times.now_ns();
        let Self { boards, buffers, counters, alignment, swaps, .. } = self;
        let board = &mut boards[number];
        let is_same = board.repeats_packet(&packet.readings);
        // Only a repeated number makes the readings worth a comparison.
        let is_same = is_same.unwrap_or_else(|| {
            board.stream.numbers.last() == Some(packet.sequence) && board.holds(&packet.readings, buffers)
        });
        if board.note_number(packet, now_ns, !is_same, counters) {
            alignment.note_new_rate();
        }
        if board.own_rate.is_none() {
            return false;
        }
        board.take_at_own_rate(packet, now_ns, !is_same, clock, counters);
        let in_use = board.own_rate.as_ref().and_then(|own| Some((own.samples(), own.in_use.clone()?)));
        // A single board cannot change places.
        if let Some((count, sample)) = in_use.filter(|_| boards.len() > 1) {
            swaps.note(number, swaps.turn(number, count), &sample, boards);
            boards[number].set_swapped(swaps.of(number).is_some());
        }
        self.has_news |= self.boards[number].stream.presence.has_news();
        self.align();
        true
    }

    /// Counts a packet of board `number` that came too late, or that lies so far ahead that its board sends several
    /// packets a millisecond.
    pub(super) fn note_unusable(&mut self, number: usize, clock: &SlotClock) {
        let Self { boards, counters, alignment, times, .. } = self;
        let board = &mut boards[number];
        board.stream.note_late(counters);
        if let Some(pace) = board.stream.fast_pace(times.now_ns(), clock) {
            board.set_own_rate(TimedStream::new(TimeBase::Packets, pace), counters);
            alignment.note_new_rate();
        }
    }

    /// Passes the rates of the boards to all that depends on them.
    pub(super) fn note_rates(&mut self) {
        self.own_rates = self.boards.iter().filter(|board| board.own_rate.is_some()).count();
        self.slots.count_awaited(&self.boards);
        self.frame.samples.clear();
        if self.own_rates > 0 {
            self.frame.samples.resize(self.floor_tiles, TileSample::NOW);
        }
        for doubt in self.frame.hold_doubts.iter_mut().filter(|doubt| **doubt == Some(HoldDoubt::Slow)) {
            *doubt = (!self.health.is_noiseless()).then_some(HoldDoubt::Unlearned);
        }
        let own = || self.boards.iter().filter_map(|board| board.own_rate.as_ref());
        let intervals =
            own().flat_map(|own| own.tiles.iter().map(|tile| (*tile as usize, own.interval_ms())));
        self.health.set_intervals(intervals);
    }

    /// Marks the tiles of boards that are too slow for controls that act while they are held.
    pub(super) fn doubt_slow_boards(&mut self) {
        if self.own_rates == 0 {
            return;
        }
        let own = self.boards.iter().filter_map(|board| board.own_rate.as_ref());
        for tile in own.filter(|own| own.is_slow()).flat_map(|own| &own.tiles) {
            if let Some(doubt) = self.frame.hold_doubts.get_mut(*tile as usize) {
                *doubt = Some(HoldDoubt::Slow);
            }
        }
    }
}
