//! Tables of known points pressed, for position maps.

use std::io::BufRead;

use glam::Vec2;

use super::position_map::{MapError, MapFit, PressedPoint, Sighting};
use crate::floor::{Calibration, Corner, Floor, Geometry, SensorId, TileId};
use crate::sense::table::{TableError, TableNotes, TableReader, TableRow};

/// The points pressed on each tile.
#[derive(Clone, Debug, PartialEq)]
pub struct PressTable {
    /// The tiles pressed, in tile-index order.
    pub tiles: Vec<TilePoints>,
    /// Number of presses left out because a sensor was at 98 % of its converter's range or above.
    pub saturated: usize,
    /// Skipped lines and unread columns.
    pub notes: TableNotes,
}

/// The points pressed on one tile.
#[derive(Clone, Debug, PartialEq)]
pub struct TilePoints {
    /// The tile.
    pub tile: TileId,
    /// Points with the readings of the sensors; empty if the table has places only.
    pub presses: Vec<PressedPoint>,
    /// Points with their measured places; empty if the table has the sensors' forces.
    pub sightings: Vec<Sighting>,
}

const SIGHTED: &[&str] = &["true_x_m", "true_y_m", "est_x_m", "est_y_m"];

/// Headers on floors with sensors near the corners of their tiles.
const CORNERS: [&[&str]; 3] = [
    &["x_m", "y_m", "col", "row", "f_sw", "f_se", "f_nw", "f_ne"],
    &["x_m", "y_m", "col", "row", "f_sw", "f_se", "f_nw", "f_ne", "force_n"],
    SIGHTED,
];

/// Headers on floors with sensors at given places.
const NUMBERS: [&[&str]; 5] = [
    &["x_m", "y_m", "col", "row", "f_0", "f_1", "f_2"],
    &["x_m", "y_m", "col", "row", "f_0", "f_1", "f_2", "force_n"],
    &["x_m", "y_m", "col", "row", "f_0", "f_1", "f_2", "f_3"],
    &["x_m", "y_m", "col", "row", "f_0", "f_1", "f_2", "f_3", "force_n"],
    SIGHTED,
];

impl PressTable {
    /// Reads a CSV table of points pressed on `floor`, all lengths in floor metres.
    ///
    /// With the columns `x_m,y_m,col,row,f_sw,f_se,f_nw,f_ne` (and `force_n`, if the pressing force is known): the
    /// point, its tile, and the readings of the tile's sensors, calibrated and tared; on floors with sensors at given
    /// places they are `f_0,f_1,f_2,f_3`, of which the last is empty or absent for plates with three. With
    /// `true_x_m,true_y_m,est_x_m,est_y_m`: the point and its place as measured by the floor without a map. Lines
    /// that cannot be read are skipped and listed in [`Self::notes`].
    ///
    /// # Errors
    /// [`TableError`] if the header belongs to another table, or `reader` fails.
    pub fn read(reader: impl BufRead, floor: &Floor) -> Result<Self, TableError> {
        let headers: &[_] = if floor.geometry.has_corners() { &CORNERS } else { &NUMBERS };
        let mut table = TableReader::new(reader, headers)?;
        let (header, mut row) =
            (headers.get(table.header()).copied().unwrap_or(SIGHTED), TableRow::default());
        let mut tiles: Vec<Option<TilePoints>> = vec![None; floor.geometry.tile_count()];
        let mut saturated = 0;
        while table.next_row(&mut row)? {
            if header == SIGHTED {
                let Some((tile, sighting)) = sighting(&mut table, &row, &floor.geometry) else { continue };
                points(&mut tiles, floor.geometry.index(tile), tile).sightings.push(sighting);
            } else {
                let Some((tile, press)) = press(&mut table, &row, header, &floor.geometry) else { continue };
                if is_saturated(floor, tile, press.forces) {
                    saturated += 1;
                } else {
                    points(&mut tiles, floor.geometry.index(tile), tile).presses.push(press);
                }
            }
        }
        let notes = table.into_notes();
        Ok(Self { tiles: tiles.into_iter().flatten().collect(), saturated, notes })
    }
}

/// A coordinate, in floor metres.
fn place<R: BufRead>(table: &mut TableReader<R>, row: &TableRow, field: usize) -> Option<f32> {
    table.number(row, field, -1e4..=1e4).map(|place| place as f32)
}

/// The point of a row and its measured place.
fn sighting<R: BufRead>(
    table: &mut TableReader<R>,
    row: &TableRow,
    geometry: &Geometry,
) -> Option<(TileId, Sighting)> {
    let [x, y, est_x, est_y] = std::array::from_fn(|field| place(table, row, field));
    let (at, estimate) = (Vec2::new(x?, y?), Vec2::new(est_x?, est_y?));
    let Some(tile) = geometry.tile_under(at) else {
        table.report(row, 0, "this point is not on the floor".into());
        return None;
    };
    let off = at.distance(estimate);
    if off > geometry.pitch_m().max_element() {
        table.report(row, 2, format!("{off:.2} m from where it was pressed: more than a tile"));
        return None;
    }
    let centre = geometry.centre(tile);
    Some((tile, Sighting { at: at - centre, estimate: estimate - centre }))
}

/// Place of the first sensor's force in the headers.
const FIRST_FORCE: usize = 4;

/// The point of a row and the forces under it.
fn press<R: BufRead>(
    table: &mut TableReader<R>,
    row: &TableRow,
    header: &[&str],
    geometry: &Geometry,
) -> Option<(TileId, PressedPoint)> {
    let [x, y] = std::array::from_fn(|field| place(table, row, field));
    let column = table.whole(row, 2, geometry.block().column_range());
    let line = table.whole(row, 3, geometry.block().row_range());
    let tile = column.zip(line).map(|(column, line)| TileId::new(column, line));
    let sensors = tile.map_or(Corner::ALL.len(), |tile| geometry.sensor_places(tile).count());
    let mut forces = [Some(0.0); 4];
    for (sensor, force) in forces.iter_mut().enumerate().take(sensors) {
        *force = table.number(row, FIRST_FORCE + sensor, -1e4..=1e5).map(|force| force as f32);
    }
    let known = header.iter().position(|name| *name == "force_n");
    let force = match known {
        Some(field) => table.number(row, field, 1.0..=1e5).map(|force| Some(force as f32)),
        None => Some(None),
    };
    let [first, second, third, fourth] = forces;
    let (x, y, force, forces) = (x?, y?, force?, [first?, second?, third?, fourth?]);
    let tile = tile?;
    if geometry.is_missing(tile) {
        table.report(row, 2, format!("tile {tile} is missing on this floor"));
        return None;
    }
    let at = Vec2::new(x, y) - geometry.centre(tile);
    let half = 0.5 * geometry.pitch_m();
    let mut is_on_tile = true;
    for (field, along, written, half) in [(0, at.x, x, half.x), (1, at.y, y, half.y)] {
        if along.abs() > half + 1e-4 {
            is_on_tile = false;
            let (least, most) = (written - along - half, written - along + half);
            table.report(row, field, format!("expected a point of tile {tile}, {least:.3} to {most:.3}"));
        }
    }
    is_on_tile.then_some((tile, PressedPoint { at, forces, force }))
}

fn points(tiles: &mut Vec<Option<TilePoints>>, index: Option<usize>, tile: TileId) -> &mut TilePoints {
    let index = index.unwrap_or(tiles.len());
    if index >= tiles.len() {
        tiles.resize(index + 1, None);
    }
    tiles[index].get_or_insert_with(|| TilePoints { tile, presses: Vec::new(), sightings: Vec::new() })
}

/// Whether a sensor is at the end of its converter's range.
fn is_saturated(floor: &Floor, tile: TileId, forces: [f32; 4]) -> bool {
    let tares = floor.geometry.index(tile).and_then(|tile| floor.tare.get(tile));
    let mut sensors = floor.geometry.sensors(tile).iter();
    sensors.any(|&corner| {
        let force = forces[corner.index()];
        let law = floor.law(SensorId { tile, corner });
        let tare = tares.map_or(0.0, |tares| tares[corner.index()].0);
        // The law of boards that calibrate themselves is not known here.
        law != Calibration::NOMINAL && force + tare >= law.force(law.saturated()).0
    })
}

impl TilePoints {
    /// The tile's map from these points.
    ///
    /// # Errors
    /// Those of [`MapFit::of_presses`] and [`MapFit::of_sightings`].
    pub fn fit(&self, floor: &Floor) -> Result<MapFit, MapError> {
        if self.presses.is_empty() {
            MapFit::of_sightings(&self.sightings, &floor.geometry, self.tile)
        } else {
            MapFit::of_presses(&self.presses, &floor.geometry, self.tile)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn floor() -> Floor {
        Floor::of(Geometry::of_paper_tiles(2, 1).unwrap())
    }

    #[test]
    fn points_are_taken_from_their_tile_s_centre() {
        let text = "x_m,y_m,col,row,f_sw,f_se,f_nw,f_ne\n0.5,0.1,1,0,10,20,30,40\n";
        let table = PressTable::read(text.as_bytes(), &floor()).unwrap();
        let [points] = &table.tiles[..] else { panic!("one tile") };
        assert_eq!(points.tile, TileId::new(1, 0));
        assert!(points.presses[0].at.distance(Vec2::new(0.044, -0.052)) < 1e-6);
        assert_eq!((points.presses[0].forces, points.presses[0].force), ([10.0, 20.0, 30.0, 40.0], None));

        let text = "true_x_m,true_y_m,est_x_m,est_y_m\n0.5,0.1,0.51,0.12\n";
        let table = PressTable::read(text.as_bytes(), &floor()).unwrap();
        assert!(table.tiles[0].sightings[0].estimate.distance(Vec2::new(0.054, -0.032)) < 1e-6);
    }

    #[test]
    fn places_off_the_tile_are_named() {
        let text =
            "x_m,y_m,col,row,f_sw,f_se,f_nw,f_ne,force_n\n0.1,0.1,1,0,1,2,3,4,10\n0.4,0.1,1,0,1,2,3,4,0\n";
        let problems = PressTable::read(text.as_bytes(), &floor()).unwrap().notes.problems;
        assert_eq!(
            problems.to_string(),
            "line 2, column x_m: expected a point of tile (1, 0), 0.304 to 0.608\n\
             line 3, column force_n: expected a number from 1 to 100000, found \"0\""
        );
        let text = "true_x_m,true_y_m,est_x_m,est_y_m\n0.1,0.9,0.1,0.9\n0.1,0.1,0.5,0.1\n";
        let problems = PressTable::read(text.as_bytes(), &floor()).unwrap().notes.problems;
        assert_eq!(
            problems.to_string(),
            "line 2, column true_x_m: this point is not on the floor\n\
             line 3, column est_x_m: 0.40 m from where it was pressed: more than a tile"
        );
    }

    #[test]
    fn saturated_presses_are_left_out_and_counted() {
        let mut floor = floor();
        floor.calibration[0][3] = Calibration::exponential(0.4, 1.3);
        let most = floor.calibration[0][3].force(Calibration::SATURATED).0;
        floor.tare[0][3].0 = 20.0;
        let text = format!(
            "x_m,y_m,col,row,f_sw,f_se,f_nw,f_ne\n0.2,0.2,0,0,1,2,3,{}\n0.2,0.2,0,0,1,2,3,{}\n",
            most - 21.0,
            most - 19.0
        );
        let table = PressTable::read(text.as_bytes(), &floor).unwrap();
        assert_eq!((table.saturated, table.tiles[0].presses.len()), (1, 1));
    }

    proptest::proptest! {
        #[test]
        fn no_text_makes_it_panic(rows in "([0-9eE.,+\\-NaInf]{0,12},?\n?){0,40}") {
            for columns in CORNERS {
                let text = format!("{}\n{rows}", columns.join(","));
                let _ = PressTable::read(text.as_bytes(), &floor());
            }
        }
    }
}
