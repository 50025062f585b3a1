//! Reasons for which measures of a floor are invalid.

use thiserror::Error;

use super::Geometry;

/// Reason for which measures of a floor are invalid.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum GeometryError {
    /// The grid has no tile, or more than [`Geometry::MAX_SIDE`] along a side.
    #[error("a floor has 1 to {max} columns and rows, not {columns} x {rows}", max = Geometry::MAX_SIDE)]
    Grid {
        /// Requested columns.
        columns: u16,
        /// Requested rows.
        rows: u16,
    },
    /// A tile's side is not a length between 5 cm and 5 m.
    #[error("tile_m must be between 0.05 and 5 m, not {0}")]
    Tile(f32),
    /// Tiles overlap, or their distance exceeds twice their width.
    #[error("pitch_m must be at least tile_m and at most twice as much, not {0}")]
    Pitch(f32),
    /// The sensors would lie outside the tile or beyond its centre.
    #[error("sensor_inset_m must be at least 0 and less than half of tile_m, not {0}")]
    Inset(f32),
    /// A sensor does not lie under its plate.
    #[error("sensor {sensor} lies beyond the edge of a plate of {} x {} m", plate[0], plate[1])]
    SensorOff {
        /// Its number, from 0.
        sensor: usize,
        /// Width and depth of the plate, in metres.
        plate: [f32; 2],
    },
    /// A plate of its own size overlaps its neighbours, or is smaller than 5 cm.
    #[error("the plate of tile ({column}, {row}) must be 0.05 x 0.05 to {} x {} m large", most[0], most[1])]
    OwnSize {
        /// Its column.
        column: u16,
        /// Its row.
        row: u16,
        /// Size of a cell, in metres.
        most: [f32; 2],
    },
    /// All tiles are missing.
    #[error("every tile of this floor is missing")]
    NoTile,
}
