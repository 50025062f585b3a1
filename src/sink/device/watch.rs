//! Checks that a device asks for samples, and in time.

use std::collections::VecDeque;
use std::time::Duration;

/// Maximum time between two callbacks of a playing device.
const SILENCE: Duration = Duration::from_millis(200);

/// Minimum of that time in blocks, for devices with long blocks.
const SILENT_BLOCKS: u32 = 4;

/// Maximum wait for the first callback after opening: some devices start slowly.
const LONGEST_START: Duration = Duration::from_millis(3200);

/// Time after opening during which underruns are ignored: buffers are filling, priority is pending.
const STARTING: Duration = Duration::from_secs(1);

/// A storm: at least `STORM` underruns within `STORM_SPAN`.
const STORM: usize = 5;
const STORM_SPAN: Duration = Duration::from_secs(10);

/// Watches a device that should play: the callbacks must continue, and samples must be in time.
///
/// Pure: the caller passes the time and the counts.
#[derive(Debug, Default)]
pub(super) struct Watch {
    /// Block count and time of its last growth; `None` while no device is open.
    grown: Option<(u64, Duration)>,
    opened: Duration,
    /// Whether a block was played since the device was opened.
    started: bool,
    /// Maximum time to the first block; doubles with each failed attempt.
    start_within: Duration,
    underruns: u64,
    /// Times of the latest underruns.
    storm: VecDeque<Duration>,
}

/// A fault of the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Alarm {
    /// The callbacks have stopped.
    Silent,
    /// Repeated underruns: larger blocks would help.
    Storm,
}

impl Watch {
    /// Records that a device was opened, with the counts of blocks and underruns up to then.
    pub(super) fn opened(&mut self, now: Duration, blocks: u64, underruns: u64) {
        self.grown = Some((blocks, now));
        self.opened = now;
        self.started = false;
        self.start_within = self.start_within.max(SILENCE);
        self.underruns = underruns;
        self.storm.clear();
    }

    /// Records that the device was closed.
    pub(super) fn closed(&mut self) {
        self.grown = None;
        self.storm.clear();
    }

    /// Checks the present counts; `block` is the duration of one block.
    pub(super) fn look(
        &mut self,
        now: Duration,
        blocks: u64,
        underruns: u64,
        block: Duration,
    ) -> Option<Alarm> {
        let (seen, since) = self.grown.as_mut()?;
        if blocks != *seen {
            (*seen, *since) = (blocks, now);
            self.started = true;
            self.start_within = SILENCE;
        } else {
            let patience = if self.started { SILENCE } else { self.start_within };
            if now.saturating_sub(*since) >= patience.max(block * SILENT_BLOCKS) {
                if !self.started {
                    self.start_within = (self.start_within * 2).min(LONGEST_START);
                }
                return Some(Alarm::Silent);
            }
        }
        // Counts at most one storm's worth of underruns per check.
        let fresh = underruns.saturating_sub(self.underruns).min(STORM as u64);
        self.underruns = underruns;
        if now.saturating_sub(self.opened) < STARTING {
            return None;
        }
        self.storm.extend((0..fresh).map(|_| now));
        while self.storm.front().is_some_and(|first| now.saturating_sub(*first) > STORM_SPAN) {
            self.storm.pop_front();
        }
        if self.storm.len() >= STORM {
            self.storm.clear();
            return Some(Alarm::Storm);
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    #[test]
    fn a_callback_that_stops_is_noticed_after_200_ms() {
        let mut watch = Watch::default();
        watch.opened(ms(0), 0, 0);
        for at in (10..1000).step_by(10) {
            assert_eq!(watch.look(ms(at), at, 0, ms(1)), None);
        }
        assert_eq!(watch.look(ms(1180), 990, 0, ms(1)), None);
        assert_eq!(watch.look(ms(1190), 990, 0, ms(1)), Some(Alarm::Silent));
        // A device with blocks of 100 ms may be silent for four of them.
        watch.opened(ms(0), 0, 0);
        assert_eq!(watch.look(ms(390), 0, 0, ms(100)), None);
        assert_eq!(watch.look(ms(400), 0, 0, ms(100)), Some(Alarm::Silent));
    }

    #[test]
    fn a_device_that_is_slow_to_start_is_given_more_time_with_each_attempt() {
        let mut watch = Watch::default();
        for patience in [200, 400, 800, 1600, 3200, 3200] {
            watch.opened(ms(0), 7, 0);
            assert_eq!(watch.look(ms(patience - 1), 7, 0, ms(1)), None);
            assert_eq!(watch.look(ms(patience), 7, 0, ms(1)), Some(Alarm::Silent));
        }
        watch.opened(ms(0), 7, 0);
        assert_eq!(watch.look(ms(3000), 8, 0, ms(1)), None);
        assert_eq!(watch.look(ms(3200), 8, 0, ms(1)), Some(Alarm::Silent), "once started, it must not pause");
    }

    #[test]
    fn five_underruns_in_ten_seconds_are_a_storm_and_four_are_not() {
        let mut watch = Watch::default();
        watch.opened(ms(0), 0, 3);
        let mut look = |at, underruns| watch.look(ms(at), at, underruns, ms(1));
        for n in 1..=4 {
            assert_eq!(look(n * 1000, 3 + n), None);
        }
        assert_eq!(look(11_001, 8), None, "the first is over ten seconds ago");
        assert_eq!(look(11_500, 9), Some(Alarm::Storm));
        assert_eq!(look(11_600, 10), None, "counted anew");
        assert_eq!(look(11_700, 1_000_000), Some(Alarm::Storm));
    }

    #[test]
    fn what_is_closed_is_not_missed() {
        let mut watch = Watch::default();
        watch.opened(ms(0), 0, 0);
        watch.closed();
        assert_eq!(watch.look(ms(10_000), 0, 99, ms(1)), None);
    }
}
