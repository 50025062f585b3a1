//! Reasons for which the readings of a plate may not hold a control.

/// Reason for which the readings of a plate may not hold a control with the guard `HoldToRun`.
///
/// Such a control must end within 150 ms after its readings have become constant. That is possible only where a
/// sensor's own noise makes repeated readings improbable under a foot that keeps still.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum HoldDoubt {
    /// Its board sends fewer than 50 packets a second, so that a hold would end too late.
    Slow,
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
