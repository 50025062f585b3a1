//! Why the newtons of a whole frame may be wrong.

/// Why the newtons of a frame may be wrong by more than sensors err: by a third and more, anywhere on the floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum CalibrationFault {
    /// A board sends counts, or has sent some, and the floor file has no law for some of its sensors: they count as
    /// nominal parts.
    Missing,
    /// The empty floor reads otherwise than the floor file's tare on most tiles: it is the file of another floor.
    OtherFloor,
    /// Boards have changed places: each reads the empty tiles of another one.
    BoardsSwapped,
}
