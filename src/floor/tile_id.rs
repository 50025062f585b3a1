//! The names of tiles, corners and sensors.

use std::fmt;

use glam::Vec2;
use serde::Serialize;

use underfoot_format::Named;

/// One tile, by column (east) and row (north), both from 0 at the south-west.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
pub struct TileId {
    /// Column, counted eastwards from 0.
    pub column: u16,
    /// Row, counted northwards from 0.
    pub row: u16,
}

impl TileId {
    /// The tile in `column` and `row`.
    #[must_use]
    pub const fn new(column: u16, row: u16) -> Self {
        Self { column, row }
    }
}

impl fmt::Display for TileId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "({}, {})", self.column, self.row)
    }
}

/// A corner of a tile, and the sensor near it; on floors with sensors at given places, the number of a sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Corner {
    /// South-west.
    SouthWest,
    /// South-east.
    SouthEast,
    /// North-west.
    NorthWest,
    /// North-east.
    NorthEast,
}

impl Corner {
    /// All four corners, in the order of every sensor array of this crate: sw, se, nw, ne. Where sensors lie at given
    /// places, these are the first to the fourth of the floor file's list.
    pub const ALL: [Self; 4] = [Self::SouthWest, Self::SouthEast, Self::NorthWest, Self::NorthEast];

    /// Returns the index in [`Corner::ALL`], 0 to 3.
    #[must_use]
    pub const fn index(self) -> usize {
        self as usize
    }

    /// Returns the direction of the corner from the tile's centre: -1 or 1 along each axis.
    #[must_use]
    pub const fn direction(self) -> Vec2 {
        match self {
            Self::SouthWest => Vec2::new(-1.0, -1.0),
            Self::SouthEast => Vec2::new(1.0, -1.0),
            Self::NorthWest => Vec2::new(-1.0, 1.0),
            Self::NorthEast => Vec2::new(1.0, 1.0),
        }
    }

    /// Returns the short name in files: `sw`, `se`, `nw` or `ne`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::SouthWest => "sw",
            Self::SouthEast => "se",
            Self::NorthWest => "nw",
            Self::NorthEast => "ne",
        }
    }
}

impl Named for Corner {
    const ALL: &'static [(&'static str, Self)] =
        &[("Sw", Self::SouthWest), ("Se", Self::SouthEast), ("Nw", Self::NorthWest), ("Ne", Self::NorthEast)];
}

impl fmt::Display for Corner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// One force sensor: its tile and corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SensorId {
    /// The tile on the sensor.
    pub tile: TileId,
    /// The corner above the sensor.
    pub corner: Corner,
}

impl fmt::Display for SensorId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "tile {} {}", self.tile, self.corner)
    }
}
