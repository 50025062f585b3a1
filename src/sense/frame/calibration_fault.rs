//! Faults that make the newtons of a whole frame wrong.

/// A fault that makes the newtons of a frame wrong by more than sensor errors: by a third and more, anywhere on the
/// floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum CalibrationFault {
    /// A board sends counts, or has sent some, and the floor file has no law for some of its sensors: they count as
    /// nominal parts.
    Missing,
    /// The empty floor differs from the floor file's tare on most tiles: the file belongs to another floor.
    OtherFloor,
    /// Boards have changed places: each reads the empty tiles of another one.
    BoardsSwapped,
}
