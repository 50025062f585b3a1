//! Calibrates a simulated floor against a load cell, as a laboratory does.

use std::fmt::Write;

use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use thiserror::Error;

use super::floor::SimFloor;
use super::sensor::{counts, normal};
use underfoot::floor::{Calibration, Corner, Floor, SensorId};
use underfoot::sense::{Fit, FitError, LoadPoint};
use underfoot::units::Newtons;
use underfoot::wire::Readings;

/// Number of loads on each sensor, evenly spaced over its range.
const LOADS: usize = 40;

/// Loaded share of a sensor's range: a saturated reading follows no law.
const RANGE: f32 = 0.97;

/// Number of readings averaged at each load.
const READINGS: usize = 16;

/// Error of the load cell, as a share of its reading (one standard deviation).
pub(super) const CELL_ERROR: f32 = 0.005;

/// Number of readings averaged on the empty floor for the tare.
const TARE_READINGS: usize = 200;

/// Error: no law fits a sensor.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("{sensor}: {source}")]
pub struct CalibrationError {
    /// The sensor.
    pub sensor: SensorId,
    /// The error of the fit.
    #[source]
    pub source: FitError,
}

/// Returns `floor` with calibration and tare measured on its simulation `sim`.
///
/// The bench loads each sensor in 40 steps up to 97 % of its range, against a load cell with an error of 0.5 %, and
/// fits the law, of the parts' kind; then it reads the empty floor for the tare. The same `seed` gives the same calibration. Faults of
/// the floor do not affect the bench. A floor with boards that send newtons needs no calibration and gets a tare of
/// zero. A floor without noise is marked as [`Floor::noiseless`].
///
/// # Errors
/// [`CalibrationError`] names the first sensor without a fitting law.
pub fn calibrated(floor: &Floor, sim: &SimFloor, seed: u64) -> Result<Floor, CalibrationError> {
    let mut floor = floor.clone();
    floor.tare.fill([Newtons::ZERO; 4]);
    floor.noiseless |= sim.is_noiseless();
    if !matches!(sim.readings().first(), Some(Readings::Counts(_))) {
        return Ok(floor);
    }
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    for (index, tile) in sim.geometry().tiles().enumerate() {
        for &corner in sim.geometry().sensors(tile) {
            let calibration = on_the_bench(sim, index, corner, &mut rng)
                .map_err(|source| CalibrationError { sensor: SensorId { tile, corner }, source })?;
            let rest = sim.empty_volts(index, corner);
            let empty: f32 =
                (0..TARE_READINGS).map(|_| calibration.force(read(rest, sim.noise_v(), &mut rng)).0).sum();
            // If the floor and its simulation differ in size, sensors without a counterpart stay unchanged.
            if let (Some(laws), Some(tares)) = (floor.calibration.get_mut(index), floor.tare.get_mut(index)) {
                laws[corner.index()] = calibration;
                tares[corner.index()] = Newtons(empty / TARE_READINGS as f32);
            }
        }
    }
    Ok(floor)
}

fn on_the_bench(
    sim: &SimFloor,
    tile: usize,
    corner: Corner,
    rng: &mut Pcg64Mcg,
) -> Result<Calibration, FitError> {
    let kind = sim.bench(tile, corner).0.law.kind();
    Fit::of_kind(&loaded(sim, tile, corner, rng), kind).map(|fit| fit.calibration)
}

/// Output of a sensor and reading of the load cell at each load.
fn loaded(sim: &SimFloor, tile: usize, corner: Corner, rng: &mut Pcg64Mcg) -> [LoadPoint; LOADS] {
    let (part, _) = sim.bench(tile, corner);
    let range = RANGE * part.capacity();
    std::array::from_fn(|step| {
        let force = range * (step + 1) as f32 / LOADS as f32;
        let output = part.volts(force);
        let volts: f32 = (0..READINGS).map(|_| Calibration::volts(read(output, sim.noise_v(), rng))).sum();
        LoadPoint::new(volts / READINGS as f32, Newtons(force * (1.0 + CELL_ERROR * normal(rng))))
    })
}

/// Returns the table of load-cell measurements that [`calibrated`] fits, in the format of
/// [`underfoot::sense::LoadTable`].
///
/// For a floor with boards that send newtons, the table has only its header.
#[must_use]
pub fn load_table(sim: &SimFloor, seed: u64) -> String {
    let mut table = String::from("col,row,corner,volts,newtons\n");
    if !matches!(sim.readings().first(), Some(Readings::Counts(_))) {
        return table;
    }
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    for (index, tile) in sim.geometry().tiles().enumerate() {
        for &corner in sim.geometry().sensors(tile) {
            for LoadPoint { volts, force } in loaded(sim, index, corner, &mut rng) {
                let (column, row) = (tile.column, tile.row);
                let name = sim.geometry().sensor_name(corner);
                // Writing to a string does not fail.
                let _ = writeln!(table, "{column},{row},{name},{volts:.5},{:.3}", force.0);
            }
        }
    }
    table
}

/// One noisy reading of an output in volts.
pub(super) fn read(volts: f32, noise_v: f32, rng: &mut Pcg64Mcg) -> u16 {
    counts(volts + noise_v * normal(rng))
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::{Foot, PartConfig, SimConfig, SimulatedSensors};
    use underfoot::floor::TileId;

    /// Tared force and centroid of everything on the floor, with the floor's calibration.
    fn sensed(floor: &Floor, readings: &[Readings]) -> (f32, Vec2) {
        let (mut force, mut moment) = (0.0, Vec2::ZERO);
        for (board, readings) in floor.boards.iter().zip(readings) {
            let Readings::Counts(counts) = readings else { panic!("a board that sends counts") };
            for (sensor, counts) in board.channels.iter().flatten().zip(counts) {
                let (tile, corner) = (floor.geometry.index(sensor.tile).unwrap(), sensor.corner.index());
                let newtons =
                    floor.calibration[tile][corner].force(counts.unwrap()) - floor.tare[tile][corner];
                // Like sensing, ignore sensors with nothing but noise.
                if newtons.abs() > Newtons(1.0) {
                    force += newtons.0;
                    moment += floor.geometry.sensor(sensor.tile, sensor.corner) * newtons.0;
                }
            }
        }
        (force, moment / force)
    }

    fn standing(position: Vec2, force: f32) -> Foot {
        Foot { position, heading: 0.3, length_m: 0.27, force: Newtons(force), roll: 0.45, left: false }
    }

    #[test]
    fn a_calibrated_floor_reads_a_standing_foot_as_well_as_the_paper_s() {
        let floor = Floor::default();
        let mut sim = SimFloor::new(&floor, SimConfig::default(), 20);
        let nominal = sensed(&floor, sim.step(&[])).0;
        let floor = calibrated(&floor, &sim, 1).unwrap();
        assert!(nominal > 500.0, "36 plates weigh on an untared floor: {nominal}");
        let (empty, _) = sensed(&floor, sim.step(&[]));
        assert!(empty.abs() < 5.0, "{empty}");
        // Places all over the floor, with the force of a standing person and of a button press.
        let (mut errors, mut gains) = (Vec::new(), Vec::new());
        for force in [120.0, 350.0] {
            for step in 0..40 {
                let place = Vec2::new(0.3 + 0.031 * step as f32, 1.5 - 0.029 * step as f32);
                let foot = standing(place, force);
                let (felt, at) = sensed(&floor, sim.step(&[foot]));
                errors.push(at.distance(foot.centre_of_pressure()));
                gains.push(felt / force);
            }
        }
        errors.sort_by(f32::total_cmp);
        gains.sort_by(f32::total_cmp);
        // The paper reports errors typically under 2 cm, and under 5 cm at worst.
        assert!(errors[40] < 0.02 && errors[79] < 0.05, "median {}, worst {}", errors[40], errors[79]);
        assert!(errors[40] > 0.001, "a real floor is not exact: {}", errors[40]);
        assert!(gains[0] > 0.75 && gains[79] < 1.25, "{} to {}", gains[0], gains[79]);
    }

    #[test]
    fn exact_parts_come_back_within_the_load_cell_s_error() {
        let floor = Floor::of(underfoot::floor::Geometry::of_paper_tiles(2, 2).unwrap());
        let config =
            SimConfig { sensing: SimulatedSensors::Counts(PartConfig::exact()), ..SimConfig::default() };
        let sim = SimFloor::new(&floor, config, 3);
        let floor = calibrated(&floor, &sim, 5).unwrap();
        for law in floor.calibration.iter().flatten() {
            let gain = law.force(58_000) / Calibration::NOMINAL.force(58_000);
            assert!((gain - 1.0).abs() < 0.005, "{law:?}");
        }
        let weight: Newtons = floor.tare[0].iter().copied().sum();
        // 2.6 kg of plate and 4 x 5 N of mounting.
        assert!((weight.0 - 45.5).abs() < 2.0, "{weight:?}");
    }

    #[test]
    fn boards_that_send_newtons_need_none() {
        let floor = Floor::default();
        let sim = SimFloor::new(&floor, SimConfig::ideal(), 3);
        assert_eq!(calibrated(&floor, &sim, 5), Ok(Floor { noiseless: true, ..floor }));
    }

    #[test]
    fn the_same_seed_calibrates_alike() {
        let floor = Floor::of(underfoot::floor::Geometry::of_paper_tiles(1, 1).unwrap());
        let sim = SimFloor::new(&floor, SimConfig::default(), 3);
        assert_eq!(calibrated(&floor, &sim, 5), calibrated(&floor, &sim, 5));
        assert_ne!(calibrated(&floor, &sim, 5), calibrated(&floor, &sim, 6));
        assert_eq!(sim.geometry().index(TileId::new(0, 0)), Some(0));
    }
}
