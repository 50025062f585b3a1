//! Units of layouts: tiles or metres.

use super::reader::Reader;
use crate::floor::Geometry;
use std::sync::Arc;
use underfoot_format::codec::By;
use underfoot_format::{Codec, Name, Named};

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

    /// Returns the length of one unit on a floor of this `geometry`, in metres.
    pub(super) fn metres(self, geometry: &Geometry) -> f64 {
        match self {
            Self::Tiles => geometry.pitch_m().into(),
            Self::Metres => 1.0,
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

/// The unit of all places and sizes that follow in the file.
pub(super) const UNITS: By<Units> = By {
    shape: || Codec::<Units>::shape(&Name),
    read: |node| {
        let units: Units = Name.read(node, None)?;
        units.apply_to(node.reader);
        Some(units)
    },
    write: |units| Name.write(units),
    stand_in: Units::default,
};

impl Units {
    /// Returns the unit of places and sizes in the file that `reader` reads.
    pub(super) fn of(reader: &Reader<'_>) -> Self {
        *reader.known()
    }

    /// Sets the unit of the places and sizes that `reader` reads from now on.
    pub(super) fn apply_to(self, reader: &Reader<'_>) {
        reader.know(Arc::new(self));
        reader.show_lengths_in(self.suffix());
    }
}
