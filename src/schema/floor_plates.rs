//! Missing tiles, and plates that differ from the others, in floor files.

use glam::Vec2;

use super::floor_codecs::{TILES, tile, whole};
use super::floor_measures::Misfit;
use crate::floor::{Geometry, GeometryError, OwnPlate, SensorPlaces, TileBlock, TileId};
use underfoot_format::codec::{At, By, Distinct, List, Written};
use underfoot_format::describe::FieldType;
use underfoot_format::text::RonText;
use underfoot_format::{Opt, Pair, list, num, record};

record! {
    /// Cells of the grid without a tile.
    pub(super) struct HoleRecord = "Hole";
    /// The cell in the south-west corner.
    at: Written<TileId> = "at", At(ANY_CELL);
    /// Width and depth in cells.
    size: [u16; 2] = "size", TILES => [1, 1];
}

record! {
    /// A plate that differs from the others, in the middle of its cell.
    pub(super) struct PlateRecord = "Plate";
    /// Its tile.
    tile: Written<TileId> = "tile", At(ANY_CELL);
    /// Width and depth; as `tile_m` where nothing is written.
    size: Option<Vec2> = "size_m", Opt(SIZE) => None;
    /// Places of its sensors, from its centre; as those of the other plates where nothing is written.
    sensors: Option<Vec<Vec2>> = "sensors_m", Opt(SENSOR_PLACES) => None;
}

/// A cell of any floor, as `(column, row)`.
const ANY_CELL: By<TileId> = By {
    shape: || FieldType::Words("(column, row), each a whole number from 0"),
    read: |node, ()| {
        let any = 0..Geometry::FARTHEST + 1 + Geometry::MAX_SIDE;
        node.tuple("(column, row)").and_then(|[column, row]| tile(column, row, [any.clone(), any.clone()]))
    },
    write: |tile| RonText::Tuple(whole([tile.column, tile.row])),
    stand_in: TileId::default,
};

const SIZE: Pair = Pair { each: num(0.05..=10.0), pattern: "(width, depth)", parts: ["width", "depth"] };

/// The places of a plate's sensors.
pub(super) const SENSOR_PLACES: List<Pair> =
    list("sensor", 4, Pair { each: num(-2.5..=2.5), pattern: "(east, north)", parts: ["east", "north"] })
        .at_least(3, "a plate has three or four sensors")
        .help("write their places from the plate's centre: [(-0.1, -0.1), (0.1, -0.1), (0, 0.12)]");

/// Maximum number of holes and of plates of their own: one for each tile of the largest floor.
const MOST: usize = (Geometry::MAX_SIDE as usize).pow(2);

pub(super) const HOLES: Distinct<HoleRecord> = Distinct {
    entry: "hole",
    most: MOST,
    about: |_, hole, fields, seen| {
        if !fields.have_failed(&["at"]) {
            seen.check(fields, format!("the hole at {}", hole.at.value), hole.at.at.clone());
        }
    },
};

pub(super) const PLATES: Distinct<PlateRecord> = Distinct {
    entry: "plate",
    most: MOST,
    about: |_, plate, fields, seen| {
        if !fields.have_failed(&["tile"]) {
            seen.check(fields, format!("the plate of tile {}", plate.tile.value), plate.tile.at.clone());
        }
    },
};

impl HoleRecord {
    /// Returns its cells.
    pub(super) fn block(&self, geometry: &Geometry) -> Result<TileBlock, Misfit> {
        let [columns, rows] = self.size;
        let hole = TileBlock { first: self.at.value, columns, rows };
        let floor = geometry.block();
        if hole.common(&floor) == hole {
            return Ok(hole);
        }
        let message = format!("this hole reaches beyond the floor of {floor}");
        Err(Misfit::of("missing", self.at.at.clone(), message, "leave out what is not on the grid"))
    }

    pub(super) fn of(block: TileBlock) -> Self {
        Self { at: block.first.into(), size: [block.columns, block.rows] }
    }
}

impl PlateRecord {
    /// Makes the plate on a floor whose other plates are those of `geometry`.
    pub(super) fn plate(&self, geometry: &Geometry) -> Result<OwnPlate, Misfit> {
        let tile = self.tile.value;
        if geometry.index(tile).is_none() {
            let message = format!("tile {tile} is not on the floor of {}", geometry.block());
            return Err(Misfit::of("plates", self.tile.at.clone(), message, "write a tile of the grid"));
        }
        let size = self.size.unwrap_or(geometry.tile_m());
        let sensors = match &self.sensors {
            Some(places) => SensorPlaces::at(places)
                .map_err(|error| Misfit::from(error).in_entry(self.tile.at.clone()))?,
            None => geometry.usual_sensors(size).map_err(|error| self.misfit(error))?,
        };
        Ok(OwnPlate { tile, size, sensors })
    }

    pub(super) fn of(plate: &OwnPlate, geometry: &Geometry) -> Self {
        let OwnPlate { tile, size, sensors } = *plate;
        Self {
            tile: tile.into(),
            size: (size != geometry.tile_m()).then_some(size),
            sensors: (Ok(sensors) != geometry.usual_sensors(size)).then(|| sensors.as_slice().to_vec()),
        }
    }

    /// The misfit of this plate.
    pub(super) fn misfit(&self, error: GeometryError) -> Misfit {
        Misfit::from(error).in_entry(self.tile.at.clone())
    }
}

/// Returns the missing tiles of a floor as few rectangles: each as wide as possible, then as deep.
pub(super) fn blocks(geometry: &Geometry) -> Vec<TileBlock> {
    let mut left: Vec<TileId> = geometry.tiles().filter(|tile| geometry.is_missing(*tile)).collect();
    let mut blocks = Vec::new();
    while let Some(&first) = left.first() {
        let is_left = |tile: TileId| {
            left.binary_search_by_key(&(tile.row, tile.column), |it| (it.row, it.column)).is_ok()
        };
        let columns = (0..).take_while(|east| is_left(TileId::new(first.column + east, first.row))).count();
        let row = |north: u16| TileBlock {
            first: TileId::new(first.column, first.row + north),
            columns: columns as u16,
            rows: 1,
        };
        let rows = (0..).take_while(|north| row(*north).tiles().all(is_left)).count();
        let block = TileBlock { rows: rows as u16, ..row(0) };
        left.retain(|tile| !block.contains(*tile));
        blocks.push(block);
    }
    blocks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ring_has_one_hole_and_a_cross_four() {
        let block = |column, row, columns, rows| TileBlock { first: TileId::new(column, row), columns, rows };
        let floor = Geometry::of_paper_tiles(5, 5).unwrap();
        let ring = floor.with_uneven(&[block(1, 1, 3, 3)], &[]).unwrap();
        assert_eq!(blocks(&ring), [block(1, 1, 3, 3)]);
        let corners = [block(0, 0, 2, 2), block(3, 0, 2, 2), block(0, 3, 2, 2), block(3, 3, 2, 2)];
        assert_eq!(blocks(&floor.with_uneven(&corners, &[]).unwrap()), corners);
        assert_eq!(blocks(&floor), []);
    }
}
