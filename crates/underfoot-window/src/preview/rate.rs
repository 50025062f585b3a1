//! Rates of events.

/// Measures a rate per second over the last half second.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RateMeter {
    since_s: f64,
    count_then: u64,
    per_second: Option<f32>,
}

/// Interval between updates of the figure: slow enough to read.
const WINDOW_S: f64 = 0.5;

/// Pause after which the old count is discarded: a window without changes pauses for less.
const LONGEST_S: f64 = 30.0;

impl RateMeter {
    /// Takes the total `count` at `now_s`; a decrease restarts the measurement.
    pub(super) fn observe(&mut self, now_s: f64, count: u64) {
        let passed = now_s - self.since_s;
        if count < self.count_then || passed > LONGEST_S {
            *self = Self { since_s: now_s, count_then: count, per_second: None };
        } else if passed >= WINDOW_S {
            let per_second = Some(((count - self.count_then) as f64 / passed) as f32);
            *self = Self { since_s: now_s, count_then: count, per_second };
        }
    }

    /// The rate per second; `None` during the first half second.
    pub(super) fn per_second(self) -> Option<f32> {
        self.per_second
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_over_half_a_second_and_survives_a_restart() {
        let mut rate = RateMeter::default();
        // A window that opens late on its clock ignores the time before.
        rate.observe(100.0, 5000);
        assert_eq!(rate.per_second(), None);
        for frame in 1..=60 {
            rate.observe(100.0 + f64::from(frame) / 60.0, 5000 + frame as u64 * 17);
        }
        let seen = rate.per_second().unwrap();
        assert!((seen - 1020.0).abs() < 20.0, "{seen}");
        rate.observe(101.1, 3);
        assert_eq!(rate.per_second(), None);
    }
}
