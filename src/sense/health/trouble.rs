//! What can be wrong with a sensor, and when it is believed again.

use serde::Serialize;

use crate::sense::Quality;

/// What is wrong with a sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, thiserror::Error)]
#[serde(rename_all = "snake_case")]
pub enum Trouble {
    /// No current: it reads nothing where its plate alone should make it read more.
    #[error("open circuit")]
    Open,
    /// Full scale while the rest of its tile carries nothing.
    #[error("short circuit")]
    Short,
    /// Its reading stands still, dead or at any value, where its plate demands another one.
    #[error("stuck")]
    Stuck,
    /// It reads a load to which the other corners of its plate do not answer.
    #[error("reads a load that is not on its plate")]
    Offset,
    /// Its zero has moved by more than 20 % of its range.
    #[error("its zero has drifted too far")]
    Drifted,
    /// It scatters by several newtons on an empty, quiet tile.
    #[error("noisy")]
    Noisy,
}

/// How long a load without answer is only suspect, not yet known to be wrong.
const DOUBT_S: f32 = 0.5;

/// How long a broken sensor must read what its plate demands before it counts as repaired.
const PROBATION_S: f32 = 1.0;

/// By how much a stuck sensor must move to have come loose, in newtons.
const LOOSE_N: f32 = 5.0;

/// What is known of one sensor's health.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sensor {
    trouble: Option<Trouble>,
    /// What it read when the trouble was found, in newtons.
    found_at: f32,
    /// Seconds for which it has read what it cannot, or what it should, since.
    bad_for: f32,
    good_for: f32,
    /// Whether it has moved since.
    moved: bool,
    /// Whether it came to read so from one millisecond to the next, faster than any foot.
    sudden: bool,
}

impl Sensor {
    pub(super) const fn trouble(&self) -> Option<Trouble> {
        self.trouble
    }

    /// How far its readings can be trusted at best.
    pub(super) fn quality(&self) -> Quality {
        match self.trouble {
            None => Quality::Live,
            Some(Trouble::Open | Trouble::Short | Trouble::Stuck) => Quality::Faulty,
            Some(Trouble::Offset) if self.bad_for >= DOUBT_S => Quality::Faulty,
            Some(Trouble::Offset | Trouble::Drifted | Trouble::Noisy) => Quality::Degraded,
        }
    }

    /// Whether its reading says nothing of the load, so that its tile goes on with the other three.
    pub(super) fn is_out(&self) -> bool {
        self.quality() == Quality::Faulty
    }

    /// Whether nothing may start on its tile: a load is read that may not be there.
    pub(super) fn forbids_start(&self) -> bool {
        self.trouble == Some(Trouble::Offset) && !self.is_out()
    }

    /// Notes a trouble found while it reads `force`; false if as much was known before.
    pub(super) fn find(&mut self, trouble: Trouble, force: f32) -> bool {
        let rank = |trouble| match trouble {
            None => 0,
            Some(Trouble::Drifted | Trouble::Noisy) => 1,
            Some(Trouble::Offset) => 2,
            Some(Trouble::Open | Trouble::Short | Trouble::Stuck) => 3,
        };
        let is_news = !self.is_out() && rank(Some(trouble)) > rank(self.trouble);
        if is_news {
            *self = Self { trouble: Some(trouble), found_at: force, ..Self::default() };
        }
        is_news
    }

    /// Whether what is wrong with it would show where the plate's demand is known to within `slack` newtons:
    /// under a heavy foot a load that is not on the plate goes unnoticed.
    pub(super) fn shows(&self, slack: f32) -> bool {
        self.trouble != Some(Trouble::Offset) || slack < 0.5 * self.found_at.abs()
    }

    /// Notes that its trouble came from one millisecond to the next.
    pub(super) fn struck(&mut self) {
        self.sudden = true;
    }

    /// Takes in what it read on average over `seconds`, and whether that is what it should read; `alone` says
    /// that nobody stands on the tiles around.
    ///
    /// Only this improves its quality, and only after a second of evidence. A load without answer is
    /// not held against it while it may be the edge of a foot on the next tile, beside a sensor
    /// that is dead and not yet known to be.
    pub(super) fn review(&mut self, mean: f32, is_good: bool, alone: bool, seconds: f32) {
        if self.trouble.is_none() {
            return;
        }
        self.moved |= (mean - self.found_at).abs() > LOOSE_N;
        if !is_good {
            self.good_for = 0.0;
            if alone || self.sudden {
                self.bad_for = (self.bad_for + seconds).min(DOUBT_S);
            }
        } else if self.moved || self.trouble != Some(Trouble::Stuck) {
            self.good_for += seconds;
            if self.good_for >= PROBATION_S {
                *self = Self::default();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const ALL: [Trouble; 6] =
        [Trouble::Open, Trouble::Short, Trouble::Stuck, Trouble::Offset, Trouble::Drifted, Trouble::Noisy];

    #[test]
    fn a_stuck_sensor_that_happens_to_read_right_is_still_stuck() {
        let mut sensor = Sensor::default();
        sensor.find(Trouble::Stuck, 0.0);
        for _ in 0..100 {
            sensor.review(0.0, true, true, 0.064);
        }
        assert_eq!(sensor.trouble(), Some(Trouble::Stuck));
        sensor.review(40.0, true, true, 0.064);
        for _ in 0..16 {
            sensor.review(0.0, true, true, 0.064);
        }
        assert_eq!(sensor.trouble(), None);
    }

    #[test]
    fn a_load_without_answer_is_suspect_first_and_wrong_after_half_a_second() {
        let mut sensor = Sensor::default();
        assert!(sensor.find(Trouble::Offset, 50.0));
        assert!(sensor.forbids_start() && sensor.quality() == Quality::Degraded);
        for _ in 0..8 {
            sensor.review(50.0, false, true, 0.064);
        }
        assert!(sensor.is_out() && !sensor.forbids_start());
    }

    #[test]
    fn beside_a_standing_foot_only_a_sudden_load_without_answer_is_wrong() {
        for sudden in [false, true] {
            let mut sensor = Sensor::default();
            sensor.find(Trouble::Offset, 50.0);
            if sudden {
                sensor.struck();
            }
            for _ in 0..100 {
                sensor.review(50.0, false, false, 0.064);
            }
            assert_eq!(sensor.is_out(), sudden);
        }
    }

    proptest! {
        #[test]
        fn quality_improves_only_after_a_second_of_good_readings(
            steps in prop::collection::vec((0usize..6, any::<bool>(), any::<bool>(), -100.0f32..100.0), 0..200),
        ) {
            let mut sensor = Sensor::default();
            let mut good = 0;
            for (trouble, finds, is_good, mean) in steps {
                let before = sensor.quality();
                if finds {
                    sensor.find(ALL[trouble], mean);
                    prop_assert!(sensor.quality() >= before);
                }
                let before = sensor.quality();
                good = if is_good { good + 1 } else { 0 };
                sensor.review(mean, is_good, true, 0.064);
                prop_assert!(sensor.quality() >= before || good >= 15, "{good} good blocks");
            }
        }
    }
}
