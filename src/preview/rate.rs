//! How often something happens a second.

/// Counts how often something happens a second, over the last half second.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Rate {
    since_s: f64,
    count_then: u64,
    per_second: Option<f32>,
}

/// How often the figure changes: slow enough to be read.
const WINDOW_S: f64 = 0.5;

/// Pause after which what was counted says nothing of the present: a window that has nothing to draw pauses for less.
const LONGEST_S: f64 = 30.0;

impl Rate {
    /// Takes the `count` of it so far at `now_s`; a count that went down starts anew.
    pub(super) fn observe(&mut self, now_s: f64, count: u64) {
        let passed = now_s - self.since_s;
        if count < self.count_then || passed > LONGEST_S {
            *self = Self { since_s: now_s, count_then: count, per_second: None };
        } else if passed >= WINDOW_S {
            let per_second = Some(((count - self.count_then) as f64 / passed) as f32);
            *self = Self { since_s: now_s, count_then: count, per_second };
        }
    }

    /// How often a second; `None` until half a second is counted.
    pub(super) fn per_second(self) -> Option<f32> {
        self.per_second
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_over_half_a_second_and_survives_a_restart() {
        let mut rate = Rate::default();
        // A window that opens late on its clock does not count the time before.
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
