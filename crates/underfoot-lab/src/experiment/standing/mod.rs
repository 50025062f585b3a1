//! Accuracy of a calibration by standing, beside that by a load cell.

mod judges;
mod visit;

use std::fmt;
use std::time::Duration;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde::Serialize;

use self::judges::{JudgedFoot, judging_feet};
use self::visit::{first_marks, stood};
use super::errors::PositionErrors;
use super::rig::ExperimentError;
use underfoot::floor::{Calibration, Floor, Geometry, LawKind, SensorId};
use underfoot::sense::{StandData, StandFit};
use underfoot::units::Newtons;
use underfoot_sim::{BuildError, PartConfig, Person, SimConfig, SimFloor, SimulatedSensors, calibrated};

/// Tiles of each floor, columns by rows.
const TILES: (u16, u16) = (3, 2);

/// Mass of the calibrating person (kg), and standard error of the scales (share).
const MASS_KG: f32 = 72.0;
const SCALES: f32 = 0.005;

/// Noise of a reading, as a share of the force.
const NOISE: f32 = 0.02;

/// Deviations of the parts from their laws: none, and the paper's 5 % of full scale.
const DEVIATIONS: [f32; 2] = [0.0, 0.05];

/// Numbers of marks on each tile for which the laws are fitted; the last ones need a second round.
const MARKS: [usize; 4] = [1, 3, 5, 10];

/// Average parts of each law, with about 400 N at the end of their range.
const PARTS: [Calibration; 4] = [
    Calibration::NOMINAL,
    Calibration::of(LawKind::Power, [2.6, 3.15]),
    Calibration::of(LawKind::Divider, [45.0, 5.0]),
    Calibration::of(LawKind::Linear, [95.0, 0.4]),
];

/// Errors of forces and places on floors calibrated by standing and by a load cell.
#[derive(Clone, Debug)]
pub struct StandTable {
    cells: Vec<StandCell>,
}

/// The floors of one law, calibrated in one way.
#[derive(Clone, Debug)]
struct StandCell {
    deviation: f32,
    law: LawKind,
    /// Marks on each tile; `None` for the load cell.
    marks: Option<usize>,
    floors: u32,
    failed: u32,
    found: u32,
    time_s: f64,
    forces: PositionErrors,
    places: PositionErrors,
}

/// A line of the table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StandLine {
    /// Deviation of the parts from their laws, as a share of full scale.
    pub deviation: f32,
    /// The parts' law.
    pub law: &'static str,
    /// Marks on each tile; `None` for the load cell.
    pub marks: Option<usize>,
    /// Number of floors.
    pub floors: u32,
    /// Floors without a calibration.
    pub failed: u32,
    /// Number of floors with the right kind of law.
    pub found: u32,
    /// Time of the person for each tile (s), with the way between the marks; 0 for the load cell.
    pub tile_s: f64,
    /// Error of the force of a foot, median and 95th percentile (%).
    pub force_percent: [f32; 2],
    /// Error of its place, median and 95th percentile (cm).
    pub place_cm: [f32; 2],
}

impl Default for StandTable {
    /// A table without any floor.
    fn default() -> Self {
        let ways = || [None].into_iter().chain(MARKS.map(Some));
        let cells = DEVIATIONS.into_iter().flat_map(|deviation| {
            PARTS
                .iter()
                .flat_map(move |part| ways().map(move |marks| StandCell::new(deviation, part.kind(), marks)))
        });
        Self { cells: cells.collect() }
    }
}

impl StandCell {
    fn new(deviation: f32, law: LawKind, marks: Option<usize>) -> Self {
        let none = PositionErrors::default();
        let (forces, places) = (none.clone(), none);
        Self { deviation, law, marks, floors: 0, failed: 0, found: 0, time_s: 0.0, forces, places }
    }

    fn judge(&mut self, laws: &dyn Fn(SensorId) -> (Calibration, Newtons), feet: &[JudgedFoot]) {
        for foot in feet {
            let (force, at) = foot.felt(laws);
            self.forces.push((force / foot.force - 1.0).abs());
            self.places.push(at.distance(foot.at));
        }
    }
}

impl StandTable {
    /// Adds a floor of each law and deviation, with parts, person and judging feet from `seed`.
    ///
    /// The laws are judged on other feet of other people at other places than those of the calibration: 12 to 100 kg
    /// on one foot, turned and rolled at random. Their truth is the load that the sensors bore.
    ///
    /// # Errors
    /// [`ExperimentError`] if the load cell finds no law, or the simulated person cannot move.
    pub fn add_floor(&mut self, seed: u64) -> Result<(), ExperimentError> {
        let (columns, rows) = TILES;
        let geometry = Geometry::of_paper_tiles(columns, rows).unwrap_or_default();
        let wired = Floor::of(geometry);
        for deviation in DEVIATIONS {
            for nominal in PARTS {
                let parts = PartConfig { nominal, deviation, noise_share: NOISE, ..PartConfig::default() };
                let config = SimConfig { sensing: SimulatedSensors::Counts(parts), ..SimConfig::default() };
                let mut sim = SimFloor::new(&wired, config, seed);
                let by_cell = calibrated(&wired, &sim, seed).map_err(BuildError::from)?;
                let (data, time) = stood(&wired, &mut sim, seed)?;
                let feet = judging_feet(&wired, &mut sim, seed);
                for cell in &mut self.cells {
                    if (cell.deviation, cell.law) == (deviation, nominal.kind()) {
                        cell.add((&wired, &by_cell), (&data, time), &feet, seed);
                    }
                }
            }
        }
        Ok(())
    }

    /// Adds the floors of another table.
    pub fn append(&mut self, other: Self) {
        for (own, other) in self.cells.iter_mut().zip(other.cells) {
            own.floors += other.floors;
            own.failed += other.failed;
            own.found += other.found;
            own.time_s += other.time_s;
            own.forces.append(other.forces);
            own.places.append(other.places);
        }
    }

    /// The lines, by deviation, law and number of marks.
    pub fn lines(&self) -> impl Iterator<Item = StandLine> + '_ {
        self.cells.iter().map(|cell| {
            let numbers = |errors: &PositionErrors| {
                errors.summary().map_or([f32::NAN; 2], |found| [found.median_cm, found.p95_cm])
            };
            let tiles = f64::from(TILES.0 * TILES.1) * f64::from(cell.floors.max(1));
            StandLine {
                deviation: cell.deviation,
                law: cell.law.name(),
                marks: cell.marks,
                floors: cell.floors,
                failed: cell.failed,
                found: cell.found,
                tile_s: cell.time_s / tiles,
                force_percent: numbers(&cell.forces),
                place_cm: numbers(&cell.places),
            }
        })
    }
}

impl StandCell {
    fn add(
        &mut self,
        (wired, by_cell): (&Floor, &Floor),
        (data, time): (&StandData, Duration),
        feet: &[JudgedFoot],
        seed: u64,
    ) {
        self.floors += 1;
        let Some(marks) = self.marks else {
            let laws = |sensor: SensorId| {
                let tile = by_cell.geometry.index(sensor.tile).unwrap_or_default();
                let tare = by_cell.tare.get(tile).map_or(Newtons::ZERO, |all| all[sensor.corner.index()]);
                (by_cell.law(sensor), tare)
            };
            self.found += 1;
            self.judge(&laws, feet);
            return;
        };
        let data = first_marks(data, marks);
        let share = marks as f64 / MARKS[MARKS.len() - 1] as f64;
        self.time_s += time.as_secs_f64() * share;
        let scales =
            1.0 + SCALES * (2.0 * Pcg64Mcg::seed_from_u64(seed).random_range(0.0..1.0f32) - 1.0) * 1.7;
        let weight = Person { mass_kg: MASS_KG, ..Person::default() }.weight() * scales;
        let Ok(fit) = StandFit::of(&data, weight, &wired.geometry, None) else {
            self.failed += 1;
            return;
        };
        self.found += u32::from(fit.kind == self.law);
        let laws = |sensor: SensorId| {
            let found = fit.sensors.iter().find(|found| found.sensor == sensor);
            found.map_or((Calibration::NOMINAL, Newtons::ZERO), |found| (found.law, found.tare))
        };
        self.judge(&laws, feet);
    }
}

impl fmt::Display for StandTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "Error of a foot's force and place after calibration, {MASS_KG} kg on {} x {} tiles",
            TILES.0, TILES.1
        )?;
        let mut deviation = None;
        for line in self.lines() {
            if deviation != Some(line.deviation) {
                deviation = Some(line.deviation);
                writeln!(
                    f,
                    "\nparts that deviate from their law by {:.0} % of full scale",
                    100.0 * line.deviation
                )?;
                writeln!(
                    f,
                    "{:<12} {:<12} {:>7} {:>7} {:>8} {:>16} {:>16}",
                    "law", "calibration", "floors", "found", "s a tile", "force, %", "place, cm"
                )?;
                writeln!(f, "{:>49} {:>8} {:>7} {:>8} {:>7}", "", "median", "95 %", "median", "95 %")?;
            }
            let by = line.marks.map_or("load cell".to_owned(), |marks| {
                format!("{marks} mark{}", if marks == 1 { "" } else { "s" })
            });
            let [force, force_95] = line.force_percent;
            let [place, place_95] = line.place_cm;
            let (floors, found, time) = (line.floors - line.failed, line.found, line.tile_s);
            writeln!(
                f,
                "{:<12} {by:<12} {floors:>7} {found:>7} {time:>8.0} {force:>8.2} {force_95:>7.2} {place:>8.2} {place_95:>7.2}",
                line.law
            )?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_floor_that_somebody_stood_on_reads_other_feet_within_the_goal() {
        let mut table = StandTable::default();
        table.add_floor(3).unwrap();
        let goal = |line: &StandLine| line.marks == Some(10) && line.deviation == 0.0;
        for line in table.lines().filter(goal) {
            assert_eq!(line.failed, 0, "{line:?}");
            assert!(line.force_percent[0] < 5.0 && line.place_cm[0] < 1.0, "{line:?}");
        }
        let by_cell = |line: &StandLine| line.marks.is_none() && line.deviation == 0.0;
        assert!(table.lines().filter(by_cell).all(|line| line.force_percent[0] < 1.5), "{table}");
    }
}
