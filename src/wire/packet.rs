//! One packet of one board.

use arrayvec::ArrayVec;

use crate::units::Instant;

/// Maximum number of channels of one board.
pub const MAX_CHANNELS: usize = 64;

/// Readings of the channels of one board, in channel order.
#[derive(Clone, Debug, PartialEq)]
pub enum Readings {
    /// Raw converter counts, 0 to 65535; `None` for one that was outside that range.
    Counts(ArrayVec<Option<u16>, MAX_CHANNELS>),
    /// Counts of a converter with more than 16 bits or with a sign, on the scale of 16 bits with fractions: 65535 at full
    /// voltage, negative below zero volts; beyond these for counts beyond its range.
    Scaled(ArrayVec<f32, MAX_CHANNELS>),
    /// Newtons, already calibrated by the board; may hold NaN or infinities as received.
    Newtons(ArrayVec<f32, MAX_CHANNELS>),
}

impl Readings {
    /// Number of channels read.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Counts(counts) => counts.len(),
            Self::Scaled(values) | Self::Newtons(values) => values.len(),
        }
    }

    /// Whether no channel was read.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// One sample of one board, as received.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorPacket {
    /// The board's number: its place in [`crate::floor::Floor::boards`].
    pub board: u16,
    /// The packet's number, wrapping at 2^32: it counts samples, or it is a time in milliseconds, or it has no meaning;
    /// 0 for a packet without one.
    pub sequence: u32,
    /// Arrival time, on the clock of the [`crate::source::SensorSource`].
    pub received: Instant,
    /// The readings of its channels.
    pub readings: Readings,
}
