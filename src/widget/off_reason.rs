//! The reasons why a control is off.

use std::fmt;

use crate::floor::FloorFile;

/// The reason why a control is off: no foot can press it, at any place.
///
/// A control that is on may ignore a foot for other reasons (`engine::Ignored`). Where several reasons apply at once,
/// the first in the order of [`OffReason::ALL`] counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum OffReason {
    /// An app has switched it off.
    Disabled,
    /// The floor has not been sensed yet: no packets have come, or the tare is being measured.
    Waiting,
    /// Boards have been swapped; controls with the guard `HoldToRun` are off everywhere, others on the tiles of these
    /// boards.
    BoardsSwapped,
    /// The floor file has no calibration of some sensors; only for controls with the guard `HoldToRun`.
    NotCalibrated,
    /// The floor file belongs to another floor; only for controls with the guard `HoldToRun`.
    OtherFloor,
    /// No usable packet has come for 100 ms from a board under the control.
    LinkLost,
    /// Sensors under the control are faulty or saturated.
    SensorTrouble,
    /// Sensors under the control repeat their readings bit for bit under a load; only for controls with the guard
    /// `HoldToRun`.
    RepeatedReadings,
    /// The readings under the control are too coarse to detect a frozen sensor; only for controls with the guard
    /// `HoldToRun`.
    CoarseReadings,
    /// Another control with the guard `HoldToRun` is held: only one acts at a time.
    OtherHeld,
    /// Boards under the control send fewer than 50 packets a second; only for controls with the guard `HoldToRun`.
    SlowReadings,
}

impl OffReason {
    /// All reasons, in order of precedence.
    pub const ALL: [Self; 11] = [
        Self::Disabled,
        Self::Waiting,
        Self::BoardsSwapped,
        Self::NotCalibrated,
        Self::OtherFloor,
        Self::LinkLost,
        Self::SensorTrouble,
        Self::RepeatedReadings,
        Self::CoarseReadings,
        Self::OtherHeld,
        Self::SlowReadings,
    ];

    /// Its name in OSC, JSON, C and Python; it stays the same in later versions.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Disabled => "disabled",
            Self::Waiting => "waiting",
            Self::BoardsSwapped => "boards_swapped",
            Self::OtherFloor => "other_floor",
            Self::NotCalibrated => "not_calibrated",
            Self::LinkLost => "link_lost",
            Self::SensorTrouble => "sensor_trouble",
            Self::SlowReadings => "slow_readings",
            Self::RepeatedReadings => "repeated_readings",
            Self::CoarseReadings => "coarse_readings",
            Self::OtherHeld => "other_held",
        }
    }

    /// The reason with this [`OffReason::name`]; `None` for any other text.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|reason| reason.name() == name)
    }

    /// Whether it lasts until a person acts. The others pass by themselves: packets come, a foot lets go, a sensor
    /// recovers.
    #[must_use]
    pub const fn is_lasting(self) -> bool {
        match self {
            Self::Disabled
            | Self::BoardsSwapped
            | Self::OtherFloor
            | Self::NotCalibrated
            | Self::SlowReadings
            | Self::CoarseReadings => true,
            Self::Waiting
            | Self::LinkLost
            | Self::SensorTrouble
            | Self::RepeatedReadings
            | Self::OtherHeld => false,
        }
    }

    /// The reason on a floor that was read from `file`, with a remedy, in a sentence without a full stop.
    #[must_use]
    pub fn explain(self, file: &FloorFile) -> String {
        match self {
            Self::Waiting => "the floor has not been sensed yet: no packets have come, or the tare is being measured".into(),
            Self::BoardsSwapped => {
                format!("boards have changed places: they read the tiles of other boards in {file}; run `underfoot wiring`")
            }
            Self::OtherFloor => format!(
                "the empty floor reads otherwise than {file} says: it is the file of another floor, or an old one; run \
                 `underfoot calibrate tare`"
            ),
            Self::NotCalibrated => match file.name() {
                Some(name) => format!("not calibrated: {name} lacks the calibration of some sensors; run `underfoot calibrate`"),
                None => "not calibrated: no floor file is given, and the built-in floor has no calibration; `underfoot \
                     calibrate` makes the file, and `underfoot simulate` writes the one of its simulated floor"
                    .into(),
            },
            Self::SlowReadings => {
                "boards under the control send fewer than 50 packets a second, too few for what acts while it is held: \
                 let them send more often"
                    .into()
            }
            Self::CoarseReadings => format!(
                "the readings under the control are so coarse that a frozen sensor cannot be noticed; {file} may name a \
                 source without noise"
            ),
            _ => self.to_string(),
        }
    }
}

impl fmt::Display for OffReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Disabled => "an app has switched it off",
            Self::Waiting => "the floor has not been sensed yet",
            Self::BoardsSwapped => "boards have changed places",
            Self::OtherFloor => "the floor file is another floor's",
            Self::NotCalibrated => "the floor is not calibrated",
            Self::LinkLost => "nothing usable comes from the boards under it",
            Self::SensorTrouble => "sensors under it are wrong or at the end of their range",
            Self::SlowReadings => "boards under it send fewer than 50 packets a second",
            Self::RepeatedReadings => "sensors under it repeat their readings bit for bit",
            Self::CoarseReadings => "readings under it are too coarse to notice a frozen sensor",
            Self::OtherHeld => "another control that acts while it is held is held",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_leads_back_to_its_reason() {
        for reason in OffReason::ALL {
            assert_eq!(OffReason::from_name(reason.name()), Some(reason));
        }
        assert_eq!(OffReason::from_name("none"), None);
    }

    #[test]
    fn what_a_floor_file_can_mend_names_the_file() {
        use OffReason::{BoardsSwapped, CoarseReadings, NotCalibrated, OtherFloor};
        let file = FloorFile::new("lab/floor.ron");
        for reason in OffReason::ALL {
            let about_the_file = [BoardsSwapped, OtherFloor, NotCalibrated, CoarseReadings].contains(&reason);
            assert_eq!(reason.explain(&file).contains("lab/floor.ron"), about_the_file, "{reason:?}");
        }
    }

    #[test]
    fn a_floor_without_a_file_says_where_one_comes_from() {
        let text = OffReason::NotCalibrated.explain(&FloorFile::NONE);
        assert!(text.contains("no floor file is given") && text.contains("underfoot calibrate"), "{text}");
        // The library does not name options of the program.
        assert!(!text.contains("--"), "{text}");
    }
}
