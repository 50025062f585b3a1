//! Cues in the order of their samples, and the clock that converts times to samples.

use std::time::Duration;

use super::Cue;
use super::evicting_queue::QueueReader;
use super::sender::NumberedCue;
use crate::units::Instant;

/// Maximum number of cues that wait for their time; more stay in the ring.
pub(super) const WAITING: usize = 256;

/// Cues that wait for the block of their time.
#[derive(Debug)]
pub(super) struct Schedule {
    ring: QueueReader<NumberedCue>,
    /// In order of time for the block at hand.
    waiting: Vec<Due>,
}

/// A cue and its frame, counted from the start of the block at hand.
#[derive(Debug)]
pub(super) struct Due {
    pub(super) frame: i64,
    pub(super) cue: Cue,
    /// Time at which it was sent, for measuring latency.
    pub(super) sent: Instant,
    turns: u64,
}

impl Schedule {
    pub(super) fn new(ring: QueueReader<NumberedCue>) -> Self {
        Self { ring, waiting: Vec::with_capacity(WAITING) }
    }

    /// Drops every cue that was sent before silence had changed `turns` times; returns their number.
    pub(super) fn forget(&mut self, turns: u64) -> u32 {
        let before = self.waiting.len();
        self.waiting.retain(|due| due.turns >= turns);
        let mut forgotten = (before - self.waiting.len()) as u32;
        while self.ring.peek().is_some_and(|message| message.turns < turns) && self.ring.skip() {
            forgotten += 1;
        }
        forgotten
    }

    /// Cues evicted so far in favour of newer ones.
    pub(super) fn dropped(&self) -> u64 {
        self.ring.dropped()
    }

    /// Drops every cue sent so far; returns their number.
    pub(super) fn forget_all(&mut self) -> u32 {
        let mut forgotten = self.waiting.len() as u32;
        self.waiting.clear();
        while self.ring.skip() {
            forgotten += 1;
        }
        forgotten
    }

    /// Takes new cues from the ring and sorts all; `frame_of` gives the frame of a cue.
    pub(super) fn arrange(&mut self, frame_of: impl Fn(&Cue) -> i64) {
        while self.waiting.len() < WAITING
            && let Some(message) = self.ring.pop()
        {
            let NumberedCue { cue, turns, sent } = message;
            self.waiting.push(Due { frame: 0, cue, sent, turns });
        }
        for due in &mut self.waiting {
            due.frame = frame_of(&due.cue);
        }
        self.waiting.sort_unstable_by_key(|due| (due.frame, due.cue.received));
    }

    /// Removes, in order, the cues that are due before frame `end`.
    pub(super) fn take_before(&mut self, end: usize) -> impl Iterator<Item = Due> {
        let end = i64::try_from(end).unwrap_or(i64::MAX);
        let due = self.waiting.partition_point(|due| due.frame < end);
        self.waiting.drain(..due)
    }
}

/// The renderer's estimate of the time of its next sample.
///
/// Blocks that follow each other without a gap are counted in samples, so that a cue's sample does not depend on the
/// sizes of the blocks; their start, given in whole microseconds, only shows whether there was a gap.
#[derive(Debug)]
pub(super) struct SampleClock {
    sample_rate: u64,
    /// Start of the counting.
    anchor: Option<Instant>,
    /// Samples since then.
    position: u64,
}

/// Spans longer than this (139 years) count as infinite.
const FOR_EVER_US: u64 = 1 << 52;

impl SampleClock {
    pub(super) fn new(sample_rate: u32) -> Self {
        Self { sample_rate: u64::from(sample_rate), anchor: None, position: 0 }
    }

    /// Starts a block at `start`.
    pub(super) fn begin(&mut self, start: Instant) {
        let continues = self.anchor.is_some_and(|anchor| {
            let expected = anchor + Duration::from_micros(self.micros(self.position));
            start.since(expected).max(expected.since(start)) <= Duration::from_micros(1)
        });
        if !continues {
            self.anchor = Some(start);
            self.position = 0;
        }
    }

    /// Ends a block of this many frames.
    pub(super) fn advance(&mut self, frames: usize) {
        self.position += frames as u64;
    }

    /// Resets the clock, so that the next block starts a new count.
    pub(super) fn forget(&mut self) {
        self.anchor = None;
    }

    /// The frame nearest to `at`, counted from the start of the block at hand; negative if that is past.
    pub(super) fn frame_of(&self, at: Instant) -> i64 {
        let anchor = self.anchor.unwrap_or_default();
        let (ahead, behind) = (at.since(anchor), anchor.since(at));
        let frames = self.frames(ahead) as i64 - self.frames(behind) as i64;
        frames - i64::try_from(self.position).unwrap_or(i64::MAX)
    }

    fn frames(&self, span: Duration) -> u64 {
        let micros = u64::try_from(span.as_micros()).unwrap_or(u64::MAX).min(FOR_EVER_US);
        ((u128::from(micros) * u128::from(self.sample_rate) + 500_000) / 1_000_000) as u64
    }

    fn micros(&self, frames: u64) -> u64 {
        ((u128::from(frames) * 1_000_000 + u128::from(self.sample_rate / 2)) / u128::from(self.sample_rate))
            as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_moment_falls_on_the_same_sample_however_time_is_cut() {
        // 44.1 kHz: no block of 64 frames lasts a whole number of microseconds.
        let mut clock = SampleClock::new(44_100);
        let at = Instant::from_micros(1_234_567);
        let wanted = 54_444; // 1.234567 s * 44100 = 54444.4
        for block in 0..500_u64 {
            clock.begin(Instant::from_micros((block * 64 * 1_000_000 + 22_050) / 44_100));
            assert_eq!(clock.frame_of(at) + 64 * block as i64, wanted);
            clock.advance(64);
        }
    }

    #[test]
    fn a_gap_starts_the_count_anew() {
        let mut clock = SampleClock::new(48_000);
        clock.begin(Instant::START);
        clock.advance(48);
        clock.begin(Instant::from_millis(5));
        assert_eq!(clock.frame_of(Instant::from_millis(6)), 48);
        assert_eq!(clock.frame_of(Instant::from_millis(4)), -48);
        assert!(clock.frame_of(Instant::from_micros(u64::MAX)) > 1 << 40);
        // A gap of a single sample counts too.
        clock.advance(48);
        clock.begin(Instant::from_micros(6_021));
        assert_eq!(clock.frame_of(Instant::from_micros(7_021)), 48);
    }
}
