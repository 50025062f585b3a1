//! Maps a simulated floor by pressing known points, as people do on site.

use std::f32::consts::PI;
use std::fmt::Write;

use glam::Vec2;
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use thiserror::Error;

use super::floor::SimFloor;
use super::loadcell::{CELL_ERROR, read};
use super::sensor::{counts, normal};
use underfoot::floor::{Calibration, Corner, Floor, TileId};
use underfoot::sense::{MapError, MapFit, PressedPoint};
use underfoot::wire::Readings;

/// Number of points along each side of a tile.
const POINTS: usize = 9;

/// Forces at each point (N): from a light foot to more than half a person.
const FORCES: [f32; 4] = [45.0, 100.0, 200.0, 380.0];

/// Distance of the outermost points from the plate's edge (m).
const MARGIN_M: f32 = 0.008;

/// Aiming error at a point (m), one standard deviation along each axis.
const AIM_M: f32 = 0.0005;

/// Number of readings averaged at each point and force.
const READINGS: usize = 32;

/// Error: no map fits a tile.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("tile {tile}: {source}")]
pub struct MappingError {
    /// The tile.
    pub tile: TileId,
    /// The error of the fit.
    #[source]
    pub source: MapError,
}

/// Returns `floor`, which must be calibrated and tared, with a position map of each tile measured on its simulation
/// `sim`.
///
/// Presses 9 x 9 points of each tile, denser towards the edges, with 45, 100, 200 and 380 N each, within half a
/// millimetre, with a tool that has a load cell with an error of 0.5 %. [`MapFit::of_presses`] fits the map. Ignores
/// saturated presses. The same `seed` gives the same maps. A floor with boards that send newtons keeps its maps, and
/// so does a tile that no map improves.
///
/// # Errors
/// [`MappingError`] names the first tile without a fitting map.
pub fn mapped(floor: &Floor, sim: &SimFloor, seed: u64) -> Result<Floor, MappingError> {
    let mut floor = floor.clone();
    if !matches!(sim.readings().first(), Some(Readings::Counts(_))) {
        return Ok(floor);
    }
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    for (index, tile) in sim.geometry().tiles().enumerate() {
        if sim.geometry().is_missing(tile) {
            continue;
        }
        let presses = press(&floor, sim, index, &mut rng);
        match MapFit::of_presses(&presses, sim.geometry(), tile) {
            Ok(fit) => {
                if let Some(map) = floor.position_maps.get_mut(index) {
                    *map = Some(fit.map);
                }
            }
            Err(MapError::NoBetter { .. }) => {}
            Err(source) => return Err(MappingError { tile, source }),
        }
    }
    Ok(floor)
}

/// Returns the table of presses that [`mapped`] fits its maps to, in the format of [`underfoot::sense::PressTable`].
///
/// For a floor with boards that send newtons, the table has only its header.
#[must_use]
pub fn press_table(floor: &Floor, sim: &SimFloor, seed: u64) -> String {
    let names = Corner::ALL.map(|sensor| sim.geometry().sensor_name(sensor));
    let mut table = format!("x_m,y_m,col,row,f_{},force_n\n", names.join(",f_"));
    if !matches!(sim.readings().first(), Some(Readings::Counts(_))) {
        return table;
    }
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    for (index, tile) in sim.geometry().tiles().enumerate() {
        for PressedPoint { at, forces: [sw, se, nw, ne], force } in press(floor, sim, index, &mut rng) {
            let Vec2 { x, y } = sim.geometry().centre(tile) + at;
            let (column, row) = (tile.column, tile.row);
            // Writing to a string does not fail.
            let _ = writeln!(
                table,
                "{x:.5},{y:.5},{column},{row},{sw:.3},{se:.3},{nw:.3},{ne:.3},{:.2}",
                force.unwrap_or_default()
            );
        }
    }
    table
}

/// Forces measured by the sensors of one tile while its points are pressed.
fn press(floor: &Floor, sim: &SimFloor, tile: usize, rng: &mut Pcg64Mcg) -> Vec<PressedPoint> {
    let (Some(laws), Some(tares)) = (floor.calibration.get(tile), floor.tare.get(tile)) else {
        return Vec::new();
    };
    let id = sim.geometry().tile_at_index(tile);
    let known = sim.geometry().sensors(id);
    if known.is_empty() {
        return Vec::new();
    }
    let side = 0.5 * sim.geometry().plate_size(id) - MARGIN_M;
    // Denser towards the edges, because a fit near an edge has points on one side only.
    let step = |number: usize, side: f32| side * (PI * (number as f32 / (POINTS - 1) as f32 - 0.5)).sin();
    let points = (0..POINTS).flat_map(|row| (0..POINTS).map(move |column| (column, row)));
    let mut presses = Vec::with_capacity(POINTS * POINTS * FORCES.len());
    for (column, row) in points {
        let at = Vec2::new(step(column, side.x), step(row, side.y));
        for force in FORCES {
            let hit = at + Vec2::new(normal(rng), normal(rng)) * AIM_M;
            let supports = sim.pressed(tile, hit, force);
            let mut saturated = false;
            let forces = Corner::ALL.map(|corner| {
                if !known.contains(&corner) {
                    return 0.0;
                }
                let volts = sim.bench(tile, corner).0.volts(supports[corner.index()]);
                let law: Calibration = laws[corner.index()];
                // The creep of a sensor under the resting plate is in its tare and in every reading. For a sensor
                // without memory, `crept` is 0.
                let (part, rest) = sim.bench(tile, corner);
                let crept = law.force(counts(sim.empty_volts(tile, corner))).0
                    - law.force(counts(part.volts(rest))).0;
                let mut sum = 0.0;
                for _ in 0..READINGS {
                    let reading = read(volts, sim.noise_v(), rng);
                    saturated |= reading >= law.saturated();
                    sum += law.force(reading).0;
                }
                sum / READINGS as f32 + crept - tares[corner.index()].0
            });
            if !saturated {
                presses.push(PressedPoint {
                    at,
                    forces,
                    force: Some(force * (1.0 + CELL_ERROR * normal(rng))),
                });
            }
        }
    }
    presses
}
