//! Sequence numbers for lines of text, which have none.

use std::time::Duration;

use underfoot::units::Instant;

/// Silence after which a sample begins a new stream: after it, the number of lines says nothing about the time.
const SILENT: Duration = Duration::from_millis(100);

/// Distance back to the first number of a new stream: no number of the old one lies near.
const BACK: u32 = 1 << 20;

/// Counts the lines of one board, also the rejected ones, so that these count as lost packets.
#[derive(Debug, Default)]
pub(super) struct LineSequence {
    next: u32,
    last: Option<Instant>,
}

impl LineSequence {
    /// The number of the line that ended at `now`.
    pub(super) fn number(&mut self, now: Instant) -> u32 {
        if self.last.is_some_and(|last| now.since(last) > SILENT) {
            self.restart();
        }
        self.last = Some(now);
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
    fn a_stream_after_a_silence_is_a_new_one() {
        let mut sequence = LineSequence::default();
        let mut at = |ms: u64| sequence.number(Instant::from_micros(1000 * ms));
        assert_eq!([at(0), at(10), at(110)], [0, 1, 2]);
        assert_eq!([at(211), at(212)], [3_u32.wrapping_sub(BACK), 4_u32.wrapping_sub(BACK)]);
    }
}
