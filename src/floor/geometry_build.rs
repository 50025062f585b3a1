//! Makes geometries from their measures, and parts of them.

use glam::Vec2;

use super::uneven::UnevenTiles;
use super::{Geometry, GeometryError, OwnPlate, SensorPlaces, TileBlock, TileId};

impl Geometry {
    /// A floor of `columns` x `rows` square tiles with sensors near their corners.
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
        Self::of_plates(columns, rows, Vec2::splat(tile_m), Vec2::splat(pitch_m), sensor_inset_m)
    }

    /// As [`Geometry::new`], with rectangular tiles: width east and depth north of a plate, and the distances between
    /// the centres of neighbours along both axes.
    ///
    /// # Errors
    /// [`GeometryError`] gives the invalid measure and its valid range.
    pub fn of_plates(
        columns: u16,
        rows: u16,
        tile: Vec2,
        pitch: Vec2,
        sensor_inset_m: f32,
    ) -> Result<Self, GeometryError> {
        let sides = 1..=Self::MAX_SIDE;
        if !sides.contains(&columns) || !sides.contains(&rows) {
            return Err(GeometryError::Grid { columns, rows });
        }
        if let Some(side) = tile.to_array().into_iter().find(|side| !Self::SIDES_M.contains(side)) {
            return Err(GeometryError::Tile(side));
        }
        let fits = |(pitch, tile): &(f32, f32)| (*tile..=2.0 * tile).contains(pitch);
        let mut axes = pitch.to_array().into_iter().zip(tile.to_array());
        if let Some((pitch, _)) = axes.find(|axis| !fits(axis)) {
            return Err(GeometryError::Pitch(pitch));
        }
        if !(0.0..0.5 * tile.min_element()).contains(&sensor_inset_m) {
            return Err(GeometryError::Inset(sensor_inset_m));
        }
        Ok(Self {
            first: TileId::new(0, 0),
            columns,
            rows,
            whole: (columns, rows),
            tile,
            pitch,
            sensor_inset_m: Some(sensor_inset_m),
            sensors: SensorPlaces::in_corners(tile, sensor_inset_m),
            uneven: None,
        })
    }

    /// Valid lengths of a plate's sides, in metres.
    const SIDES_M: std::ops::RangeInclusive<f32> = 0.05..=5.0;

    /// Returns the same floor with sensors at these places under each plate.
    ///
    /// # Errors
    /// [`GeometryError::SensorOff`] if a place is not under the plate.
    pub fn with_sensors(self, sensors: SensorPlaces) -> Result<Self, GeometryError> {
        check_under(self.tile, &sensors)?;
        Ok(Self { sensors, sensor_inset_m: None, ..self })
    }

    /// Returns the same floor without the tiles of `holes`, and with `plates` that differ from the others. A hole has
    /// no plate; of several plates of one tile, one counts.
    ///
    /// # Errors
    /// [`GeometryError`] if a plate is larger than its cell, if its sensors do not lie under it, or if the floor has
    /// no tile left.
    pub fn with_uneven(self, holes: &[TileBlock], plates: &[OwnPlate]) -> Result<Self, GeometryError> {
        plates.iter().try_for_each(|plate| self.check_plate(plate))?;
        let missing: Vec<TileId> =
            holes.iter().flat_map(|hole| hole.common(&self.block()).tiles().collect::<Vec<_>>()).collect();
        let geometry = Self { uneven: UnevenTiles::of(missing, plates.to_vec()), ..self };
        let has_any = geometry.tiles().any(|tile| geometry.has(tile));
        if has_any { Ok(geometry) } else { Err(GeometryError::NoTile) }
    }

    /// Checks that a plate fits into its cell, and that its sensors lie under it.
    ///
    /// # Errors
    /// [`GeometryError::OwnSize`] and [`GeometryError::SensorOff`].
    pub(crate) fn check_plate(&self, plate: &OwnPlate) -> Result<(), GeometryError> {
        let TileId { column, row } = plate.tile;
        let least = Vec2::splat(*Self::SIDES_M.start());
        if !(plate.size.cmpge(least) & plate.size.cmple(self.pitch)).all() {
            return Err(GeometryError::OwnSize { column, row, most: self.pitch.into() });
        }
        check_under(plate.size, &plate.sensors)
    }

    /// Returns the sensors of a plate of this size without places of its own.
    ///
    /// # Errors
    /// [`GeometryError::Inset`] if the plate is too small for sensors near its corners.
    pub(crate) fn usual_sensors(&self, plate: Vec2) -> Result<SensorPlaces, GeometryError> {
        match self.sensor_inset_m {
            Some(inset_m) if inset_m >= 0.5 * plate.min_element() => Err(GeometryError::Inset(inset_m)),
            Some(inset_m) => Ok(SensorPlaces::in_corners(plate, inset_m)),
            None => Ok(self.sensors),
        }
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

    /// Returns the part within `block`; `None` if there is no cell.
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
}

/// Checks that all sensors lie under a plate of this size.
fn check_under(plate: Vec2, sensors: &SensorPlaces) -> Result<(), GeometryError> {
    let half = 0.5 * plate + 1e-6;
    let is_off = |place: &Vec2| place.abs().cmpgt(half).any();
    match sensors.as_slice().iter().position(is_off) {
        Some(sensor) => Err(GeometryError::SensorOff { sensor, plate: plate.into() }),
        None => Ok(()),
    }
}

impl Default for Geometry {
    /// The paper's floor: 6 x 6 tiles of 30.4 cm, sensors 2 cm inside the edges.
    fn default() -> Self {
        let tile = Vec2::splat(0.304);
        Self {
            first: TileId::new(0, 0),
            columns: 6,
            rows: 6,
            whole: (6, 6),
            tile,
            pitch: tile,
            sensor_inset_m: Some(0.02),
            sensors: SensorPlaces::in_corners(tile, 0.02),
            uneven: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::floor::{Corner, Rect};

    #[test]
    fn impossible_measures_are_refused_by_name() {
        assert!(matches!(Geometry::new(0, 6, 0.3, 0.3, 0.02), Err(GeometryError::Grid { .. })));
        assert!(matches!(Geometry::new(6, 6, f32::NAN, 0.3, 0.02), Err(GeometryError::Tile(_))));
        assert!(matches!(Geometry::new(6, 6, 0.3, 0.2, 0.02), Err(GeometryError::Pitch(_))));
        assert!(matches!(Geometry::new(6, 6, 0.3, 0.3, 0.15), Err(GeometryError::Inset(_))));
    }

    #[test]
    fn plates_have_their_own_measures_and_sensors() {
        let board =
            Geometry::of_plates(1, 1, Vec2::new(0.511, 0.316), Vec2::new(0.511, 0.316), 0.039).unwrap();
        let ne = board.sensor(board.first(), Corner::NorthEast);
        assert!(ne.distance(Vec2::new(0.472, 0.277)) < 1e-6, "{ne}");
        let floor = Geometry::of_paper_tiles(2, 1).unwrap();
        let three =
            SensorPlaces::at(&[Vec2::new(-0.09, -0.09), Vec2::new(0.09, -0.09), Vec2::new(0.0, 0.09)])
                .unwrap();
        let own = OwnPlate { tile: TileId::new(1, 0), size: Vec2::splat(0.2), sensors: three };
        let mixed = floor.with_uneven(&[], &[own]).unwrap();
        assert_eq!([0, 1].map(|column| mixed.sensors(TileId::new(column, 0)).len()), [4, 3]);
        assert_eq!(mixed.plate(own.tile), Rect::from_centre_size(floor.centre(own.tile), own.size));
        assert_eq!((mixed.sensor_name(Corner::NorthEast), floor.sensor_name(Corner::NorthEast)), ("3", "ne"));
        let wide = OwnPlate { size: Vec2::new(0.4, 0.2), ..own };
        assert!(matches!(floor.with_uneven(&[], &[wide]), Err(GeometryError::OwnSize { column: 1, .. })));
        let far =
            SensorPlaces::at(&[Vec2::new(-0.2, 0.0), Vec2::new(0.1, -0.1), Vec2::new(0.0, 0.1)]).unwrap();
        assert_eq!(
            floor.with_sensors(far),
            Err(GeometryError::SensorOff { sensor: 0, plate: [0.304, 0.304] })
        );
    }
}
