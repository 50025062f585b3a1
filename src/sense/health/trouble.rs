//! The faults of a sensor, and its recovery from them.

use crate::sense::Quality;

/// A sensor fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, thiserror::Error)]
pub enum Trouble {
    /// No current: it reads zero although its plate's weight alone requires more.
    #[error("open circuit")]
    Open,
    /// Full scale while the rest of its tile carries nothing.
    #[error("short circuit")]
    Short,
    /// Its reading is constant, dead or at any value, where its plate requires another one.
    #[error("stuck")]
    Stuck,
    /// It reads a load to which the other corners of its plate do not respond.
    #[error("reads a load that is not on its plate")]
    Offset,
    /// Its zero has moved by more than 20 % of its range.
    #[error("its zero has drifted too far")]
    Drifted,
    /// Its readings scatter by several newtons on an empty, quiet tile.
    #[error("noisy")]
    Noisy,
    /// It is switched off, in the floor file or by a request.
    #[error("switched off")]
    Off,
}

impl Trouble {
    /// Its name in JSON.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Open => "open",
            Self::Short => "short",
            Self::Stuck => "stuck",
            Self::Offset => "offset",
            Self::Drifted => "drifted",
            Self::Noisy => "noisy",
            Self::Off => "off",
        }
    }
}

/// Time for which a load without response is only suspect, not yet a fault (s).
const DOUBT_S: f32 = 0.5;

/// Time for which a broken sensor must read the value that its plate requires before it counts as repaired (s).
const PROBATION_S: f32 = 1.0;

/// Change after which a stuck sensor counts as loose again (N).
const LOOSE_N: f32 = 5.0;

/// The health of one sensor.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sensor {
    trouble: Option<Trouble>,
    /// Its reading when the fault was found (N).
    found_at: f32,
    /// Time since for which its reading has been wrong, and time for which it has been right (s).
    bad_for: f32,
    good_for: f32,
    /// Whether the reading has moved since.
    moved: bool,
    /// Whether the fault came from one millisecond to the next, faster than any foot.
    sudden: bool,
}

impl Sensor {
    pub(super) const fn trouble(&self) -> Option<Trouble> {
        self.trouble
    }

    /// Best possible quality of its readings.
    pub(super) fn quality(&self) -> Quality {
        match self.trouble {
            None => Quality::Live,
            Some(Trouble::Open | Trouble::Short | Trouble::Stuck | Trouble::Off) => Quality::Faulty,
            Some(Trouble::Offset) if self.bad_for >= DOUBT_S => Quality::Faulty,
            Some(Trouble::Offset | Trouble::Drifted | Trouble::Noisy) => Quality::Degraded,
        }
    }

    /// Whether its reading contains no information about the load, so that its tile continues with the other three.
    pub(super) fn is_out(&self) -> bool {
        self.quality() == Quality::Faulty
    }

    /// Whether nothing may start on its tile: the reading may contain a load that is not there.
    pub(super) fn forbids_start(&self) -> bool {
        self.trouble == Some(Trouble::Offset) && !self.is_out()
    }

    /// Notes a fault found at the reading `force`; returns false if the same or a worse one was known.
    pub(super) fn find(&mut self, trouble: Trouble, force: f32) -> bool {
        let rank = |trouble| match trouble {
            None => 0,
            Some(Trouble::Drifted | Trouble::Noisy) => 1,
            Some(Trouble::Offset) => 2,
            Some(Trouble::Open | Trouble::Short | Trouble::Stuck) => 3,
            Some(Trouble::Off) => 4,
        };
        let is_news = !self.is_out() && rank(Some(trouble)) > rank(self.trouble);
        if is_news {
            *self = Self { trouble: Some(trouble), found_at: force, ..Self::default() };
        }
        is_news
    }

    /// Switches it off, or on again as a healthy one; returns false if it was so already.
    pub(super) fn switch(&mut self, on: bool) -> bool {
        let is_on = self.trouble != Some(Trouble::Off);
        if is_on != on {
            *self = Self { trouble: (!on).then_some(Trouble::Off), ..Self::default() };
        }
        is_on != on
    }

    /// Whether its fault would show at a plate requirement known to within `slack` newtons: under a heavy foot a load
    /// that is not on the plate is not visible.
    pub(super) fn shows(&self, slack: f32) -> bool {
        self.trouble != Some(Trouble::Offset) || slack < 0.5 * self.found_at.abs()
    }

    /// Notes that its fault came from one millisecond to the next.
    pub(super) fn struck(&mut self) {
        self.sudden = true;
    }

    /// Starts the probation of a broken sensor again: of a block with gaps, nothing shows that its readings were right.
    pub(super) fn interrupt(&mut self) {
        self.good_for = 0.0;
    }

    /// Reviews its mean reading over `seconds`, and whether that is the required one; `alone` means that nothing
    /// stands on the tiles around.
    ///
    /// Only this improves its quality, and only after a second of evidence. A load without response does not count as
    /// wrong while it may be the edge of a foot on the next tile, beside a sensor that is dead and not yet known to
    /// be.
    pub(super) fn review(&mut self, mean: f32, is_good: bool, alone: bool, seconds: f32) {
        if matches!(self.trouble, None | Some(Trouble::Off)) {
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
    fn only_a_switch_brings_back_a_sensor_that_is_off() {
        let mut sensor = Sensor::default();
        assert!(sensor.switch(false) && !sensor.switch(false));
        for _ in 0..100 {
            sensor.review(40.0, true, true, 0.064);
            assert!(!sensor.find(Trouble::Short, 400.0));
        }
        assert!(sensor.is_out() && sensor.trouble() == Some(Trouble::Off));
        assert!(sensor.switch(true) && sensor.trouble().is_none());
    }

    #[test]
    fn the_second_of_right_readings_has_no_gap() {
        let mut sensor = Sensor::default();
        sensor.find(Trouble::Offset, 50.0);
        let reads_right = |sensor: &mut Sensor, blocks: usize| {
            (0..blocks).for_each(|_| sensor.review(0.0, true, true, 0.064));
            sensor.trouble()
        };
        assert_eq!(reads_right(&mut sensor, 15), Some(Trouble::Offset), "0.96 s");
        sensor.interrupt();
        assert_eq!(reads_right(&mut sensor, 15), Some(Trouble::Offset), "0.96 s since the gap");
        assert_eq!(reads_right(&mut sensor, 1), None);
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
