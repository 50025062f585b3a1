//! The places of tiles and sensors.

use glam::Vec2;

use super::uneven::UnevenTiles;
use super::{Corner, OwnPlate, Rect, SensorPlaces, TileBlock, TileId};

/// The places of the tiles of a floor, or of a part of a larger floor, and of the sensors under them.
///
/// Tiles lie in the cells of a grid and are numbered row by row from the south-west. That number, the *tile index*,
/// orders every per-tile array of this crate; a cell without a tile keeps its number. A part has its own indices; its
/// tiles keep their columns and rows, and points keep their coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Geometry {
    pub(super) first: TileId,
    pub(super) columns: u16,
    pub(super) rows: u16,
    /// Columns and rows of the whole floor that contains this part.
    pub(super) whole: (u16, u16),
    pub(super) tile: Vec2,
    pub(super) pitch: Vec2,
    /// Distance of the sensors from the plates' edges; `None` for sensors at given places.
    pub(super) sensor_inset_m: Option<f32>,
    pub(super) sensors: SensorPlaces,
    /// The tiles that differ from the others.
    pub(super) uneven: Option<&'static UnevenTiles>,
}

impl Geometry {
    /// Maximum number of columns, and of rows, of a floor.
    pub const MAX_SIDE: u16 = 256;

    /// Last column, and last row, at which a part of a larger floor may begin: more than a kilometre of the paper's
    /// tiles, where an `f32` still resolves a tenth of a millimetre.
    pub const FARTHEST: u16 = 4095;

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

    /// Returns the tile in the south-west corner: (0, 0) unless this is a part of a larger floor.
    #[must_use]
    pub const fn first(&self) -> TileId {
        self.first
    }

    /// Returns its cells.
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

    /// Returns width and depth of a plate, in metres, of all that have no size of their own.
    #[must_use]
    pub const fn tile_m(&self) -> Vec2 {
        self.tile
    }

    /// Returns the distances between the centres of neighbouring tiles east and north, in metres: the size of a cell.
    #[must_use]
    pub const fn pitch_m(&self) -> Vec2 {
        self.pitch
    }

    /// Returns the distance of the sensors from the plates' edges, in metres; `None` if their places are given.
    #[must_use]
    pub const fn sensor_inset_m(&self) -> Option<f32> {
        self.sensor_inset_m
    }

    /// Returns the number of cells, at least 1: the length of per-tile arrays.
    #[must_use]
    pub const fn tile_count(&self) -> usize {
        self.columns as usize * self.rows as usize
    }

    /// Returns the rectangle of the floor or part.
    #[must_use]
    pub fn bounds(&self) -> Rect {
        let corner = |column: u16, row: u16| Vec2::new(f32::from(column), f32::from(row)) * self.pitch;
        let TileId { column, row } = self.first;
        Rect::new(corner(column, row), corner(column + self.columns, row + self.rows))
    }

    /// Returns all cells in index order, row by row from the south-west, also those without a tile.
    pub fn tiles(&self) -> impl Iterator<Item = TileId> + use<> {
        self.block().tiles()
    }

    /// Whether the floor has `tile`: a cell of the grid that is not missing.
    #[must_use]
    pub fn has(&self, tile: TileId) -> bool {
        self.index(tile).is_some() && !self.is_missing(tile)
    }

    /// Whether the floor has a hole in the cell of `tile`.
    #[inline]
    #[must_use]
    pub fn is_missing(&self, tile: TileId) -> bool {
        self.uneven.is_some_and(|uneven| uneven.is_missing(tile))
    }

    /// Returns the missing tiles of the whole floor, column by column.
    #[must_use]
    pub fn missing(&self) -> &'static [TileId] {
        self.uneven.map_or(&[], UnevenTiles::missing)
    }

    /// Returns the plates of the whole floor that differ from the others.
    #[must_use]
    pub fn own_plates(&self) -> &'static [OwnPlate] {
        self.uneven.map_or(&[], UnevenTiles::plates)
    }

    /// Returns the index of `tile`; `None` if its cell is not on this floor.
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

    /// Returns the tile with `point` in its cell; `None` outside the floor, over a missing tile or for NaN.
    #[must_use]
    pub fn tile_under(&self, point: Vec2) -> Option<TileId> {
        self.cell_under(point).filter(|tile| !self.is_missing(*tile))
    }

    /// Returns the cell that contains `point`, also that of a missing tile; `None` outside the floor or for NaN.
    #[must_use]
    pub fn cell_under(&self, point: Vec2) -> Option<TileId> {
        self.bounds().contains(point).then(|| {
            let cell = (point / self.pitch).floor();
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
        (Vec2::new(f32::from(tile.column), f32::from(tile.row)) + 0.5) * self.pitch
    }

    /// Returns the cell of `tile`: its plate and the gap around it.
    #[must_use]
    pub fn cell(&self, tile: TileId) -> Rect {
        Rect::from_centre_size(self.centre(tile), self.pitch)
    }

    /// Returns the plate of `tile`, also for missing tiles.
    #[must_use]
    pub fn plate(&self, tile: TileId) -> Rect {
        Rect::from_centre_size(self.centre(tile), self.plate_size(tile))
    }

    /// Returns width and depth of the plate of `tile`, in metres.
    #[must_use]
    pub fn plate_size(&self, tile: TileId) -> Vec2 {
        let own = self.uneven.and_then(|uneven| uneven.plate(tile));
        own.map_or(self.tile, |own| own.size)
    }

    /// Returns the places of the sensors under `tile`.
    #[inline]
    #[must_use]
    pub fn sensor_places(&self, tile: TileId) -> &SensorPlaces {
        match self.uneven {
            None => &self.sensors,
            Some(uneven) => uneven.plate(tile).map_or(&self.sensors, |own| &own.sensors),
        }
    }

    /// Returns the sensors of `tile`, by the names of their positions in every sensor array; none for a missing tile.
    #[must_use]
    pub fn sensors(&self, tile: TileId) -> &'static [Corner] {
        if self.is_missing(tile) { &[] } else { self.sensor_places(tile).sensors() }
    }

    /// Returns the place of `sensor` of `tile`, in floor metres.
    #[must_use]
    pub fn sensor(&self, tile: TileId, sensor: Corner) -> Vec2 {
        self.centre(tile) + self.sensor_places(tile).place(sensor)
    }

    /// Returns where a drawing of the plate of `tile` shows `sensor`, as shares of its width and depth from the
    /// south-west: near the edge of the drawing at the most.
    #[must_use]
    pub fn share_of_plate(&self, tile: TileId, sensor: Corner) -> Vec2 {
        let half = 0.5 * self.plate_size(tile);
        let share = self.sensor_places(tile).place(sensor) / half;
        0.5 + 0.5 * share.clamp(Vec2::splat(-0.72), Vec2::splat(0.72))
    }

    /// Whether all tiles are equal squares in a square grid, with sensors near their corners.
    #[must_use]
    pub fn is_square_grid(&self) -> bool {
        let is_square = |size: Vec2| size.x == size.y;
        is_square(self.tile)
            && is_square(self.pitch)
            && self.sensor_inset_m.is_some()
            && self.uneven.is_none()
    }

    /// Whether sensors have the names of corners; otherwise they have numbers, in the order of the floor file.
    #[must_use]
    pub fn has_corners(&self) -> bool {
        self.sensor_inset_m.is_some()
            && self.own_plates().iter().all(|plate| plate.sensors.rectangle().is_some())
    }

    /// Returns the name of a sensor in tables and messages: `sw`, `se`, `nw` or `ne`, or a number from 0.
    #[must_use]
    pub fn sensor_name(&self, sensor: Corner) -> &'static str {
        if self.has_corners() { sensor.name() } else { ["0", "1", "2", "3"][sensor.index()] }
    }

    /// Converts a length or point from tile units (1.0 = one pitch) to metres.
    #[must_use]
    pub fn metres_from_tiles(&self, tiles: Vec2) -> Vec2 {
        tiles * self.pitch
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::floor::GeometryError;

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
    fn a_foot_over_a_hole_is_on_no_tile_and_its_neighbours_keep_their_numbers() {
        let hole = TileBlock { first: TileId::new(1, 1), columns: 1, rows: 1 };
        let ring = Geometry::of_paper_tiles(3, 3).unwrap().with_uneven(&[hole], &[]).unwrap();
        let middle = ring.centre(TileId::new(1, 1));
        assert_eq!((ring.tile_under(middle), ring.cell_under(middle)), (None, Some(TileId::new(1, 1))));
        assert_eq!((ring.tile_count(), ring.index(TileId::new(2, 2))), (9, Some(8)));
        assert!(!ring.has(TileId::new(1, 1)) && ring.has(TileId::new(0, 1)) && !ring.has(TileId::new(3, 0)));
        assert!(ring.sensors(TileId::new(1, 1)).is_empty() && ring.has_corners());
        // A part of the floor has the same hole.
        let part = ring.part(&TileBlock { first: TileId::new(1, 0), columns: 2, rows: 2 }).unwrap();
        assert_eq!(
            (part.tile_under(middle), part.tile_under(ring.centre(TileId::new(2, 1)))),
            (None, Some(TileId::new(2, 1)))
        );
        let all = TileBlock { first: TileId::new(0, 0), columns: 3, rows: 3 };
        assert_eq!(ring.with_uneven(&[all], &[]), Err(GeometryError::NoTile));
    }
}
