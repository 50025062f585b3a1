//! Units of layouts: tiles or metres.

use crate::floor::Geometry;
use underfoot_format::{Includes, Named};

/// The unit of the places, sizes and gaps of a layout.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Units {
    /// The floor's pitch: a layout keeps its arrangement on a floor with other tiles.
    #[default]
    Tiles,
    /// Metres: a layout keeps its measures on a floor with other tiles.
    Metres,
}

impl Units {
    /// Returns the suffix of a number.
    pub(super) const fn suffix(self) -> &'static str {
        match self {
            Self::Tiles => " tiles",
            Self::Metres => " m",
        }
    }

    /// Returns the name for a sentence.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Tiles => "tiles",
            Self::Metres => "metres",
        }
    }

    /// Returns the lengths of one unit east and north on a floor of this `geometry`, in metres.
    pub(super) fn metres(self, geometry: &Geometry) -> [f64; 2] {
        match self {
            Self::Tiles => geometry.pitch_m().to_array().map(f64::from),
            Self::Metres => [1.0; 2],
        }
    }

    /// Maximum distance of a place from its origin, well beyond any floor.
    pub(super) const fn furthest(self) -> f64 {
        match self {
            Self::Tiles => Geometry::MAX_SIDE as f64,
            Self::Metres => 1000.0,
        }
    }

    /// Minimum side of an area; far below any foot.
    pub(super) const fn shortest(self) -> f64 {
        match self {
            Self::Tiles => 0.05,
            Self::Metres => 0.01,
        }
    }
}

impl Named for Units {
    const ALL: &'static [(&'static str, Self)] = &[("Tiles", Self::Tiles), ("Metres", Self::Metres)];
}

impl Includes<Self> for Units {
    fn included(&self) -> &Self {
        self
    }
}
