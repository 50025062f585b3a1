//! Sequence numbers for lines of text, which have none.

use std::time::Duration;

use underfoot::units::Instant;

/// Silence after which a sample begins a new stream: after it, the number of lines says nothing about the time. At
/// least so long, and so many intervals of a slow board.
const SILENT: Duration = Duration::from_millis(100);
const SILENT_INTERVALS: u32 = 4;

/// Distance back to the first number of a new stream: no number of the old one lies near.
const BACK: u32 = 1 << 20;

/// Counts the lines of one board, also the rejected ones, so that these count as lost packets.
#[derive(Debug, Default)]
pub(super) struct LineSequence {
    next: u32,
    last: Option<Instant>,
    /// The shorter one of the last two intervals.
    interval: Duration,
    before: Duration,
}

impl LineSequence {
    /// The number of the line that ended at `now`.
    pub(super) fn number(&mut self, now: Instant) -> u32 {
        let passed = self.last.map_or(Duration::ZERO, |last| now.since(last));
        if passed > SILENT.max(SILENT_INTERVALS * self.interval) {
            self.restart();
        }
        self.interval = passed.min(self.before);
        (self.before, self.last) = (passed, Some(now));
        let number = self.next;
        self.next = number.wrapping_add(1);
        number
    }

    /// The next line begins a new stream.
    pub(super) fn restart(&mut self) {
        self.next = self.next.wrapping_sub(BACK);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_board_at_9_hz_has_one_stream() {
        let mut sequence = LineSequence::default();
        let numbers: Vec<u32> = (0..20).map(|n| sequence.number(Instant::from_micros(110_000 * n))).collect();
        // Its interval is known from the third line on.
        assert!(numbers[3..].windows(2).all(|pair| pair[1] == pair[0] + 1), "{numbers:?}");
    }

    #[test]
    fn a_stream_after_a_silence_is_a_new_one() {
        let mut sequence = LineSequence::default();
        let mut at = |ms: u64| sequence.number(Instant::from_micros(1000 * ms));
        assert_eq!([at(0), at(10), at(110)], [0, 1, 2]);
        assert_eq!([at(211), at(212)], [3_u32.wrapping_sub(BACK), 4_u32.wrapping_sub(BACK)]);
    }
}
