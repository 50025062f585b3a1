//! Reasons for which the readings of a plate may not hold a control.

use std::fmt;

use serde::Serialize;

/// Reason for which the readings of a plate may not hold a control with the guard `HoldToRun`.
///
/// Such a control must end within 150 ms after its readings have become constant. That is possible only where a
/// sensor's own noise makes repeated readings improbable under a foot that keeps still.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum HoldDoubt {
    /// The noise of its sensors is still unknown: they have been idle for less than a tenth of a second since the
    /// start, or they read zero while idle.
    Unlearned,
    /// Its sensors repeat their readings even while they work: their noise is less than one count, or their sampling
    /// is so slow that a reading stays constant for longer than 8 ms.
    Coarse,
    /// Two or more of its sensors have repeated their readings for 100 ms, which is improbable with their noise: the
    /// converters are frozen.
    Repeats,
}

impl HoldDoubt {
    /// The word for it: `unlearned`, `coarse` or `repeats`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Unlearned => "unlearned",
            Self::Coarse => "coarse",
            Self::Repeats => "repeats",
        }
    }
}

/// One sentence for the user.
impl fmt::Display for HoldDoubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Unlearned => "the noise of its sensors is not known yet",
            Self::Coarse => "its sensors are too coarse or too slow to show that they stand still",
            Self::Repeats => "its sensors repeat what they have read",
        })
    }
}
