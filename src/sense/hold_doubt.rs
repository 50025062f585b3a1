//! Why the readings of a plate may not hold a control.

use std::fmt;

use serde::Serialize;

/// Why the readings of a plate may not hold a control with the guard `HoldToRun`.
///
/// Such a control must end within 150 ms of the moment at which readings stand still. That is possible only where a
/// sensor's own noise makes it improbable that its readings repeat under a foot that keeps still.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum HoldDoubt {
    /// The noise of its sensors is not known yet: they were idle for less than a tenth of a second since the start, or
    /// read nothing while they are idle.
    Unlearned,
    /// Its sensors repeat themselves even while they work: their noise is less than one count, or they are sampled so
    /// seldom that a reading stays the same for longer than 8 ms.
    Coarse,
    /// Two or more of its sensors have repeated, for 100 ms, what they had read before, which their noise makes
    /// improbable: they stand still.
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

/// One sentence for people.
impl fmt::Display for HoldDoubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Unlearned => "the noise of its sensors is not known yet",
            Self::Coarse => "its sensors are too coarse or too slow to show that they stand still",
            Self::Repeats => "its sensors repeat what they have read",
        })
    }
}
