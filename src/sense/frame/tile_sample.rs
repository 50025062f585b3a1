//! The age of a tile's forces.

use std::time::Duration;

/// The sample that the forces of one tile come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TileSample {
    /// Time from the sample to the frame: 0 for a board with one sample a frame, up to a period and the delay of its
    /// packets for a slow one.
    pub age: Duration,
    /// Whether the sample is new in this frame. Between the samples of a slow board, frames repeat the last one.
    pub is_new: bool,
}

impl TileSample {
    /// The sample of a board that samples once a frame.
    pub const NOW: Self = Self { age: Duration::ZERO, is_new: true };
}
