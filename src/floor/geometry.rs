//! Tiles, corners and sensors, and their places.

use std::fmt;

use glam::Vec2;
use serde::Serialize;
use thiserror::Error;

use super::{Rect, TileBlock};
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

/// A corner of a tile, and the sensor near it.
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
    /// All four corners, in the order of every sensor array of this crate: sw, se, nw, ne.
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
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

/// The places of the tiles of a floor, or of a part of a larger floor, and of the sensors under them.
///
/// Tiles are numbered row by row from the south-west. That number, the *tile index*, orders every per-tile array of
/// this crate. A part has its own indices; its tiles keep their columns and rows, and points keep their coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Geometry {
    first: TileId,
    columns: u16,
    rows: u16,
    /// Columns and rows of the whole floor that contains this part.
    whole: (u16, u16),
    tile_m: f32,
    pitch_m: f32,
    sensor_inset_m: f32,
}

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
    /// Tiles overlap, or their distance exceeds their width.
    #[error("pitch_m must be at least tile_m and at most twice as much, not {0}")]
    Pitch(f32),
    /// The sensors would lie outside the tile or beyond its centre.
    #[error("sensor_inset_m must be at least 0 and less than half of tile_m, not {0}")]
    Inset(f32),
}

impl Geometry {
    /// Maximum number of columns, and of rows, of a floor.
    pub const MAX_SIDE: u16 = 256;

    /// Last column, and last row, at which a part of a larger floor may begin: more than a kilometre of the paper's
    /// tiles, where an `f32` still resolves a tenth of a millimetre.
    pub const FARTHEST: u16 = 4095;

    /// A floor of `columns` x `rows` tiles.
    ///
    /// `tile_m` is the side of one plate, `pitch_m` the distance between the centres of neighbours, `sensor_inset_m`
    /// the distance of the sensors from the plate's edges.
    ///
    /// # Errors
    /// [`GeometryError`] gives the invalid measure and its valid range.
    pub fn new(
        columns: u16,
        rows: u16,
        tile_m: f32,
        pitch_m: f32,
        sensor_inset_m: f32,
    ) -> Result<Self, GeometryError> {
        let side = 1..=Self::MAX_SIDE;
        if !side.contains(&columns) || !side.contains(&rows) {
            return Err(GeometryError::Grid { columns, rows });
        }
        if !(0.05..=5.0).contains(&tile_m) {
            return Err(GeometryError::Tile(tile_m));
        }
        if !(tile_m..=2.0 * tile_m).contains(&pitch_m) {
            return Err(GeometryError::Pitch(pitch_m));
        }
        if !(0.0..0.5 * tile_m).contains(&sensor_inset_m) {
            return Err(GeometryError::Inset(sensor_inset_m));
        }
        let whole = (columns, rows);
        Ok(Self { first: TileId::new(0, 0), columns, rows, whole, tile_m, pitch_m, sensor_inset_m })
    }

    /// Returns the same grid as a part of a larger floor with its south-west corner at `first`; columns and rows past
    /// [`Geometry::FARTHEST`] count as that. The larger floor ends with this part: see [`Geometry::within`].
    #[must_use]
    pub const fn beginning_at(self, first: TileId) -> Self {
        const fn near(at: u16) -> u16 {
            if at > Geometry::FARTHEST { Geometry::FARTHEST } else { at }
        }
        let first = TileId::new(near(first.column), near(first.row));
        Self { first, ..self }.within((0, 0))
    }

    /// Returns the same part of a floor with this number of columns and rows, or of the smallest floor that contains
    /// it.
    #[must_use]
    pub const fn within(self, (columns, rows): (u16, u16)) -> Self {
        const fn most(one: u16, other: u16) -> u16 {
            if one > other { one } else { other }
        }
        let least = self.least_whole();
        Self { whole: (most(columns, least.0), most(rows, least.1)), ..self }
    }

    /// Returns columns and rows of the smallest floor that contains this part.
    pub(crate) const fn least_whole(&self) -> (u16, u16) {
        (self.first.column + self.columns, self.first.row + self.rows)
    }

    /// Returns columns and rows of the whole floor: its own, unless this is a part of a larger one.
    #[must_use]
    pub const fn whole(&self) -> (u16, u16) {
        self.whole
    }

    /// Whether this is a part of a larger floor.
    #[must_use]
    pub const fn is_part(&self) -> bool {
        self.columns < self.whole.0 || self.rows < self.whole.1
    }

    /// Returns the part within `block`; `None` if there is no tile.
    #[must_use]
    pub fn part(&self, block: &TileBlock) -> Option<Self> {
        let TileBlock { first, columns, rows } = self.block().common(block);
        (columns > 0 && rows > 0).then_some(Self { first, columns, rows, ..*self })
    }

    /// The paper's tiles (30.4 cm, sensors 2 cm inside the edges) in a grid of another size.
    ///
    /// # Errors
    /// [`GeometryError::Grid`] if a side is 0 or above [`Geometry::MAX_SIDE`].
    pub fn of_paper_tiles(columns: u16, rows: u16) -> Result<Self, GeometryError> {
        Self::new(columns, rows, 0.304, 0.304, 0.02)
    }

    /// Returns the tile in the south-west corner: (0, 0) unless this is a part of a larger floor.
    #[must_use]
    pub const fn first(&self) -> TileId {
        self.first
    }

    /// Returns its tiles.
    #[must_use]
    pub const fn block(&self) -> TileBlock {
        TileBlock { first: self.first, columns: self.columns, rows: self.rows }
    }

    /// Returns the number of columns, at least 1.
    #[must_use]
    pub const fn columns(&self) -> u16 {
        self.columns
    }

    /// Returns the number of rows, at least 1.
    #[must_use]
    pub const fn rows(&self) -> u16 {
        self.rows
    }

    /// Returns the side of one plate, in metres.
    #[must_use]
    pub const fn tile_m(&self) -> f32 {
        self.tile_m
    }

    /// Returns the distance between the centres of neighbouring tiles, in metres.
    #[must_use]
    pub const fn pitch_m(&self) -> f32 {
        self.pitch_m
    }

    /// Returns the distance of the sensors from the plate's edges, in metres.
    #[must_use]
    pub const fn sensor_inset_m(&self) -> f32 {
        self.sensor_inset_m
    }

    /// Returns the number of tiles, at least 1.
    #[must_use]
    pub const fn tile_count(&self) -> usize {
        self.columns as usize * self.rows as usize
    }

    /// Returns the rectangle of the floor or part.
    #[must_use]
    pub fn bounds(&self) -> Rect {
        let corner = |column: u16, row: u16| Vec2::new(f32::from(column), f32::from(row)) * self.pitch_m;
        let TileId { column, row } = self.first;
        Rect::new(corner(column, row), corner(column + self.columns, row + self.rows))
    }

    /// Returns all tiles in index order: row by row from the south-west.
    pub fn tiles(&self) -> impl Iterator<Item = TileId> + use<> {
        self.block().tiles()
    }

    /// Returns the index of `tile`; `None` if it is not on this floor.
    #[must_use]
    pub fn index(&self, tile: TileId) -> Option<usize> {
        let column = tile.column.checked_sub(self.first.column)?;
        let row = tile.row.checked_sub(self.first.row)?;
        (column < self.columns && row < self.rows)
            .then(|| usize::from(row) * usize::from(self.columns) + usize::from(column))
    }

    /// Returns the tile at `index`, the inverse of [`Geometry::index`]; meaningless past the last tile.
    #[must_use]
    pub fn tile_at_index(&self, index: usize) -> TileId {
        let columns = usize::from(self.columns);
        TileId::new(self.first.column + (index % columns) as u16, self.first.row + (index / columns) as u16)
    }

    /// Returns the tile with `point` in its pitch cell; `None` outside the floor or for NaN.
    #[must_use]
    pub fn tile_under(&self, point: Vec2) -> Option<TileId> {
        self.bounds().contains(point).then(|| {
            let cell = (point / self.pitch_m).floor();
            let TileId { column, row } = self.first;
            TileId::new(
                (cell.x as u16).clamp(column, column + self.columns - 1),
                (cell.y as u16).clamp(row, row + self.rows - 1),
            )
        })
    }

    /// Returns the centre of `tile`, also for tiles beyond the floor.
    #[must_use]
    pub fn centre(&self, tile: TileId) -> Vec2 {
        (Vec2::new(f32::from(tile.column), f32::from(tile.row)) + 0.5) * self.pitch_m
    }

    /// Returns the plate of `tile`.
    #[must_use]
    pub fn plate(&self, tile: TileId) -> Rect {
        Rect::from_centre_size(self.centre(tile), Vec2::splat(self.tile_m))
    }

    /// Returns half the distance between neighbouring sensors of one tile, in metres.
    #[must_use]
    pub fn sensor_reach_m(&self) -> f32 {
        0.5 * self.tile_m - self.sensor_inset_m
    }

    /// Returns the place of the sensor under `corner` of `tile`.
    #[must_use]
    pub fn sensor(&self, tile: TileId, corner: Corner) -> Vec2 {
        self.centre(tile) + corner.direction() * self.sensor_reach_m()
    }

    /// Converts a length or point from tile units (1.0 = one pitch) to metres.
    #[must_use]
    pub fn metres_from_tiles(&self, tiles: Vec2) -> Vec2 {
        tiles * self.pitch_m
    }
}

impl Default for Geometry {
    /// The paper's floor: 6 x 6 tiles of 30.4 cm, sensors 2 cm inside the edges.
    fn default() -> Self {
        Self {
            first: TileId::new(0, 0),
            columns: 6,
            rows: 6,
            whole: (6, 6),
            tile_m: 0.304,
            pitch_m: 0.304,
            sensor_inset_m: 0.02,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_papers_floor_has_144_sensors_2_cm_inside_the_edges() {
        let floor = Geometry::default();
        assert_eq!(floor.tile_count() * Corner::ALL.len(), 144);
        let sw = floor.sensor(TileId::new(0, 0), Corner::SouthWest);
        assert!(sw.distance(Vec2::splat(0.02)) < 1e-6, "{sw}");
        let ne = floor.sensor(TileId::new(5, 5), Corner::NorthEast);
        assert!(ne.distance(Vec2::splat(6.0 * 0.304 - 0.02)) < 1e-6, "{ne}");
    }

    #[test]
    fn index_and_tile_are_inverse() {
        let floor = Geometry::of_paper_tiles(3, 2).unwrap();
        for (index, tile) in floor.tiles().enumerate() {
            assert_eq!(floor.index(tile), Some(index));
            assert_eq!(floor.tile_at_index(index), tile);
            assert_eq!(floor.tile_under(floor.centre(tile)), Some(tile));
        }
        assert_eq!(floor.index(TileId::new(3, 0)), None);
        assert_eq!(floor.tile_under(Vec2::new(-0.01, 0.1)), None);
        assert_eq!(floor.tile_under(Vec2::NAN), None);
    }

    #[test]
    fn a_part_s_tiles_keep_their_names_and_their_places() {
        let whole = Geometry::of_paper_tiles(12, 9).unwrap();
        let block = TileBlock { first: TileId::new(4, 3), columns: 30, rows: 2 };
        let part = whole.part(&block).unwrap();
        assert_eq!((part.first(), part.columns(), part.rows()), (TileId::new(4, 3), 8, 2));
        assert_eq!((part.whole(), part.part(&block).unwrap().whole()), ((12, 9), (12, 9)));
        let read = Geometry::of_paper_tiles(8, 2).unwrap().beginning_at(TileId::new(4, 3));
        assert_eq!((read.whole(), read.within((12, 9))), ((12, 5), part));
        for (index, tile) in part.tiles().enumerate() {
            assert_eq!(part.index(tile), Some(index));
            assert_eq!(part.tile_at_index(index), tile);
            assert_eq!(part.tile_under(whole.centre(tile)), Some(tile));
            assert_eq!(part.centre(tile), whole.centre(tile));
        }
        for tile in whole.tiles() {
            assert_eq!(part.index(tile).is_some(), block.contains(tile));
            assert_eq!(part.bounds().contains(whole.centre(tile)), block.contains(tile));
        }
        assert_eq!(part.tile_under(part.bounds().min), Some(part.first()));
        assert_eq!(whole.part(&TileBlock { first: TileId::new(12, 0), columns: 1, rows: 1 }), None);
        assert_eq!(whole.part(&whole.block()), Some(whole));
    }

    #[test]
    fn impossible_measures_are_refused_by_name() {
        assert!(matches!(Geometry::new(0, 6, 0.3, 0.3, 0.02), Err(GeometryError::Grid { .. })));
        assert!(matches!(Geometry::new(6, 6, f32::NAN, 0.3, 0.02), Err(GeometryError::Tile(_))));
        assert!(matches!(Geometry::new(6, 6, 0.3, 0.2, 0.02), Err(GeometryError::Pitch(_))));
        assert!(matches!(Geometry::new(6, 6, 0.3, 0.3, 0.15), Err(GeometryError::Inset(_))));
    }
}
