//! The duration of one sensor's repetition.

use std::time::Duration;

use crate::units::Instant;

/// Minimum duration of a repetition.
pub(super) const REPEATED_FOR: Duration = Duration::from_millis(100);

/// Milliseconds between two looks of [`super::noise`]: its share of repetitions applies to that many readings, and to
/// each reading of a board that sends less often.
const LOOK_MS: f32 = 8.0;

/// Maximum ratio of the probability of two values to that of one: for noise of one count 0.68 against 0.28 (normal
/// distribution).
const TWO_VALUES: f32 = 2.5;

/// The repetitions of one sensor since it was loaded.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Run {
    /// The last reading, the start of its run, and the run's length.
    value: u16,
    alike_since: Instant,
    alike: u32,
    /// The other value, if only two have been read, the start of the run of these two, and its length.
    other: u16,
    two_since: Instant,
    two: u32,
    /// Number of last readings that equal those a fixed lag before.
    cycle: u32,
}

impl Run {
    /// Takes one reading.
    pub(super) fn read(&mut self, raw: u16, now: Instant) {
        if self.alike == 0 {
            *self = Self { value: raw, other: raw, alike_since: now, two_since: now, ..Self::default() };
        }
        if raw == self.value {
            self.alike += 1;
            self.two += 1;
            return;
        }
        if raw == self.other || self.other == self.value {
            self.two += 1;
        } else {
            (self.two, self.two_since) = (self.alike + 1, self.alike_since);
        }
        self.other = std::mem::replace(&mut self.value, raw);
        (self.alike, self.alike_since) = (1, now);
    }

    /// The last reading; 0 before the first.
    pub(super) const fn value(&self) -> u16 {
        self.value
    }

    /// Notes the number of last readings that equal those some lag before.
    pub(super) fn note_cycle(&mut self, readings: u32) {
        self.cycle = readings;
    }

    /// Negative log likelihood (nats) of the repetition by chance, given the probabilities that the sensor reads the
    /// same value after 8 ms, and after a period of hum; zero before [`REPEATED_FOR`] has passed. Its readings are
    /// `interval_ms` apart. Only readings that repeat an earlier one count: two values of a slow board fill the time by
    /// themselves.
    ///
    /// A repetition in order may have any of `lags` lags, which reduces the result by ln `lags`.
    pub(super) fn nats(&self, [same, in_order]: [f32; 2], lags: u32, interval_ms: f32, now: Instant) -> f32 {
        let looks = interval_ms.min(LOOK_MS) / LOOK_MS;
        let of = |readings: u32, same: f32| readings as f32 * looks * -same.clamp(1e-6, 1.0).ln();
        let has_lasted = |since: Instant| now.since(since) >= REPEATED_FOR;
        let mut nats: f32 = 0.0;
        if has_lasted(self.alike_since) {
            nats = nats.max(of(self.alike.saturating_sub(1), same));
        }
        if has_lasted(self.two_since) {
            nats = nats.max(of(self.two.saturating_sub(2), TWO_VALUES * same));
        }
        if self.cycle > 0 {
            nats = nats.max(of(self.cycle, in_order) - (lags as f32).ln());
        }
        nats
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A run of these readings, a millisecond apart, and the time of the last.
    fn run(readings: impl Iterator<Item = u16>) -> (Run, Instant) {
        let (mut run, mut now) = (Run::default(), Instant::from_millis(5));
        for raw in readings {
            run.read(raw, now);
            now = now + Duration::from_millis(1);
        }
        (run, now)
    }

    #[test]
    fn a_value_that_stands_still_is_improbable_after_a_tenth_of_a_second() {
        let before = [7, 9, 4, 12, 8];
        for (repeated, is_improbable) in [(90, false), (110, true)] {
            let (run, now) = run(before.into_iter().chain(std::iter::repeat_n(8, repeated)));
            assert_eq!(run.nats([0.01; 2], 1, 1.0, now) > 30.0, is_improbable, "{repeated}");
        }
    }

    #[test]
    fn a_bit_that_toggles_at_random_is_as_improbable() {
        let mut state = 1_u32;
        let (run, now) = run((0..120).map(|_| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            if state >> 31 == 0 { 4000 } else { 4256 }
        }));
        assert!(run.nats([0.01; 2], 1, 1.0, now) > 30.0);
        assert!(run.nats([0.35; 2], 1, 1.0, now) < 3.0, "noise of less than a count does so");
    }

    #[test]
    fn a_slow_board_needs_as_long_and_fewer_readings() {
        // Five readings at 50 Hz.
        let (mut run, mut now) = (Run::default(), Instant::from_millis(5));
        for raw in [7, 9, 8, 8, 8, 8, 8, 8] {
            now = now + Duration::from_millis(20);
            run.read(raw, now);
        }
        assert!(run.nats([0.001; 2], 1, 20.0, now) > 30.0);
        assert!(run.nats([0.3; 2], 1, 20.0, now) < 10.0);
    }

    #[test]
    fn two_readings_of_a_slow_board_repeat_nothing_however_long_the_third_takes() {
        let (mut run, now) = (Run::default(), Instant::from_millis(5));
        run.read(7, now);
        run.read(9, now + Duration::from_millis(50));
        assert_eq!(run.nats([1e-6; 2], 1, 50.0, now + Duration::from_millis(149)), 0.0);
    }

    #[test]
    fn a_third_value_begins_anew() {
        let values = std::iter::repeat_n(1, 60).chain(std::iter::repeat_n(2, 30)).chain([3, 2, 3, 2]);
        let (run, now) = run(values);
        assert_eq!(run.nats([0.01; 2], 1, 1.0, now), 0.0);
        assert_eq!(run.two, 34, "the last two values");
    }
}
