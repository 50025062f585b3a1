//! Keeps the boards' slots and the sample clock in step with the receive clock.

use super::board::BoardTrack;
use super::clock::{SLOT_NS, SlotClock};
use super::numbering::TimeBase;
use super::timed::TimedStream;
use crate::wire::LinkCounters;

/// Interval at which the boards' slots and the clock are compared with the receive clock.
const ALIGN_NS: i64 = 64 * SLOT_NS;

/// Lead of the slots of all boards over their packets above which the slots are moved back: steering would take a
/// minute, and a board that counts a thousandth too fast would pull the clock away.
const FAST_NS: i64 = 20 * SLOT_NS;

/// The comparison of slots and clock with the arrival of packets, at intervals.
#[derive(Clone, Debug)]
pub(super) struct Alignment {
    /// Time of the last comparison.
    aligned_ns: i64,
    /// Space for sorting the boards' delays.
    delays: Vec<(i64, usize)>,
    /// Whether the rate of a board has changed since the last look.
    has_new_rates: bool,
}

impl Alignment {
    pub(super) fn new(boards: usize) -> Self {
        Self { aligned_ns: 0, delays: Vec::with_capacity(boards), has_new_rates: false }
    }

    /// Begins the first interval.
    pub(super) const fn start(&mut self, now_ns: i64) {
        self.aligned_ns = now_ns;
    }

    /// Whether the rate of a board has changed since the last call.
    pub(super) const fn take_new_rates(&mut self) -> bool {
        std::mem::replace(&mut self.has_new_rates, false)
    }

    /// Notes that the rate of a board has changed.
    pub(super) const fn note_new_rate(&mut self) {
        self.has_new_rates = true;
    }

    /// Compares each board's slots with the arrival of its packets, and the clock with all of them; does nothing
    /// within an interval. `done` is the last slot made into a frame. Returns the number of slots by which boards have
    /// been moved.
    pub(super) fn align(
        &mut self,
        now_ns: i64,
        done: i64,
        clock: &mut SlotClock,
        boards: &mut [BoardTrack],
        counters: &mut LinkCounters,
    ) -> u64 {
        if now_ns - self.aligned_ns < ALIGN_NS {
            return 0;
        }
        self.aligned_ns = now_ns;
        self.delays.clear();
        let mut slipped = 0;
        for (number, board) in boards.iter_mut().enumerate() {
            if board.own_rate.is_some() {
                // It is no reference for the others.
                self.has_new_rates |= board.adopt_own_rate();
            } else if let Some(pace) = board.stream.other_pace() {
                board.set_own_rate(TimedStream::new(TimeBase::Packets, pace), counters);
                self.has_new_rates = true;
            } else if let Some(delay) = board.stream.least_delay(now_ns) {
                self.delays.push((delay, number));
            }
        }
        if !self.delays.is_empty() {
            let middle = (self.delays.len() - 1) / 2;
            let common = self.delays.select_nth_unstable(middle).1.0;
            // Nothing arrives before its sampling: slots that lie further ahead are moved back, and the clock is not.
            let common = if common < -FAST_NS { 0 } else { common };
            for &(delay, number) in &self.delays {
                slipped += boards[number].stream.slip(delay - common).unsigned_abs();
            }
            let jump = clock.correct(done, common);
            if jump != 0 {
                boards.iter_mut().for_each(|board| board.stream.slots_moved(jump));
            }
        }
        slipped
    }
}
