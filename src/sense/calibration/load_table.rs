//! Tables of load-cell measurements, and the evaluation of each sensor by them.

use std::io::BufRead;

use super::law_choice::Comparison;
use super::law_fit::{Fit, FitError, LoadPoint};
use crate::floor::{Calibration, Corner, Geometry, SensorId, TileId};
use crate::sense::table::{TableError, TableNotes, TableReader, TableRow, shown};
use crate::units::Newtons;

/// The measurements of each sensor in a table.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadTable {
    /// The sensors measured, by tile index and corner.
    pub sensors: Vec<SensorLoads>,
    /// Skipped lines and unread columns.
    pub notes: TableNotes,
}

/// One sensor's measurements.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorLoads {
    /// The sensor.
    pub sensor: SensorId,
    /// Its name on its floor: [`Geometry::sensor_name`].
    pub name: &'static str,
    /// The measurements, in the order of the table, without saturated readings.
    pub points: Vec<LoadPoint>,
    /// Number of readings left out because they are at 98 % of the converter's range or above.
    pub saturated: usize,
}

/// Verdict on a sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// It follows its law as well as typical parts.
    Good,
    /// It is usable, but with large position errors.
    Poor,
    /// The measurements are insufficient: measure it again.
    Unmeasured,
    /// It is broken.
    Replace,
}

/// A sensor's evaluation by its measurements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judgement {
    /// The verdict.
    pub verdict: Verdict,
    /// Its law and the residual, or the reason for which it has none.
    pub fit: Result<Fit, FitError>,
    /// The fit of all laws.
    pub laws: Comparison,
}

impl Verdict {
    /// Maximum residual of a good sensor: real parts miss their law by about 8 % of full scale (our choice).
    const GOOD: f32 = 0.08;

    /// Maximum residual of a usable sensor (our choice).
    const POOR: f32 = 0.15;

    /// The word for it: `good`, `poor`, `unmeasured` or `replace`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Poor => "poor",
            Self::Unmeasured => "unmeasured",
            Self::Replace => "replace",
        }
    }
}

const COLUMNS: [&[&str]; 2] =
    [&["col", "row", "corner", "volts", "newtons"], &["col", "row", "corner", "counts", "newtons"]];

impl LoadTable {
    /// Reads a CSV table with the columns `col,row,corner,volts,newtons` or `col,row,corner,counts,newtons`.
    ///
    /// One line per measurement, in any order: the sensor's tile and corner (`sw`, `se`, `nw`, `ne`), its output (0
    /// to 5 volts, or 0 to 65535 counts) and the reading of the load cell (-100 to 10000 newtons, including the
    /// plate's weight if it rests on the sensor). Lines that cannot be read are skipped and listed in
    /// [`Self::notes`].
    ///
    /// # Errors
    /// [`TableError`] if the header belongs to another table, or `reader` fails.
    pub fn read(reader: impl BufRead, geometry: &Geometry) -> Result<Self, TableError> {
        let mut table = TableReader::new(reader, &COLUMNS)?;
        let (header, mut row) = (table.header(), TableRow::default());
        let mut sensors: Vec<Option<SensorLoads>> = vec![None; geometry.tile_count() * 4];
        while table.next_row(&mut row)? {
            let column = table.whole(&row, 0, geometry.block().column_range());
            let line = table.whole(&row, 1, geometry.block().row_range());
            let written = table.text(&row, 2);
            let corner = corner(&written, geometry);
            if corner.is_none() {
                let (found, [sw, se, nw, ne]) = (shown(&written), names(geometry));
                table.report(&row, 2, format!("expected {sw}, {se}, {nw} or {ne}, found {found}"));
            }
            let output = if header == 0 {
                table
                    .number(&row, 3, 0.0..=f64::from(Calibration::FULL_SCALE_VOLTS))
                    .map(|volts| volts as f32)
            } else {
                table.number(&row, 3, 0.0..=65_535.0).map(|counts| volts_of(counts as f32))
            };
            let force = table.number(&row, 4, -100.0..=10_000.0);
            let (Some(column), Some(line), Some(corner), Some(volts), Some(force)) =
                (column, line, corner, output, force)
            else {
                continue;
            };
            let sensor = SensorId { tile: TileId::new(column, line), corner };
            let index = geometry.index(sensor.tile).map(|tile| tile * 4 + corner.index());
            let Some(slot) = index.and_then(|index| sensors.get_mut(index)) else { continue };
            let loads = slot.get_or_insert_with(|| {
                let name = geometry.sensor_name(corner);
                SensorLoads { sensor, name, points: Vec::new(), saturated: 0 }
            });
            if volts >= Calibration::volts(Calibration::SATURATED) {
                loads.saturated += 1;
            } else {
                loads.points.push(LoadPoint::new(volts, Newtons(force as f32)));
            }
        }
        Ok(Self { sensors: sensors.into_iter().flatten().collect(), notes: table.into_notes() })
    }
}

/// Accepts fractions: a mean of several readings need not be an integer.
fn volts_of(counts: f32) -> f32 {
    counts * (Calibration::FULL_SCALE_VOLTS / f32::from(u16::MAX))
}

/// The sensor called `name` on a floor of this `geometry`.
fn corner(name: &str, geometry: &Geometry) -> Option<Corner> {
    let mut named = Corner::ALL.into_iter().zip(names(geometry));
    named.find(|(_, other)| other.eq_ignore_ascii_case(name)).map(|(corner, _)| corner)
}

fn names(geometry: &Geometry) -> [&'static str; 4] {
    Corner::ALL.map(|corner| geometry.sensor_name(corner))
}

impl SensorLoads {
    /// Selects the law of the sensor and evaluates the sensor.
    #[must_use]
    pub fn judge(&self) -> Judgement {
        let laws = Comparison::of(&self.points);
        let fit = laws.fit();
        let verdict = match fit {
            Ok(fit) if fit.residual <= Verdict::GOOD => Verdict::Good,
            Ok(fit) if fit.residual <= Verdict::POOR => Verdict::Poor,
            Ok(_) => Verdict::Replace,
            // A sensor at its end stays there under every load; so does one that always reads full scale.
            Err(FitError::TooFewPoints { .. }) if self.saturated >= Fit::MIN_POINTS => Verdict::Replace,
            Err(FitError::TooFewPoints { .. } | FitError::NotFinite { .. }) => Verdict::Unmeasured,
            Err(_) if !self.was_loaded() => Verdict::Unmeasured,
            Err(_) => Verdict::Replace,
        };
        Judgement { verdict, fit, laws }
    }

    /// Whether the loads differed enough for a sound sensor to show it.
    fn was_loaded(&self) -> bool {
        let loads = self.points.iter().map(|point| point.force.0);
        let (least, most) =
            loads.fold((f32::INFINITY, 0.0f32), |(least, most), f| (least.min(f), most.max(f)));
        most > 2.0 * least.max(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::floor::LawKind;

    const HEADER: &str = "col,row,corner,volts,newtons\n";

    fn read(text: &str) -> Result<LoadTable, TableError> {
        LoadTable::read(text.as_bytes(), &Geometry::of_paper_tiles(2, 2).unwrap())
    }

    fn loads(points: impl IntoIterator<Item = (f32, f32)>) -> SensorLoads {
        let points = points.into_iter().map(|(volts, force)| LoadPoint::new(volts, Newtons(force))).collect();
        let sensor = SensorId { tile: TileId::new(0, 0), corner: Corner::SouthWest };
        SensorLoads { sensor, name: "sw", points, saturated: 0 }
    }

    fn nominal(volts: f32) -> f32 {
        0.5 * (1.34 * volts).exp()
    }

    #[test]
    fn volts_and_counts_say_the_same_and_saturated_readings_are_counted() {
        let volts = read(&format!("{HEADER}1,0,ne,2.5,10\n1,0,NE,5,300\r\n\n0,1,sw,0,0\n")).unwrap();
        let counts =
            read("col,row,corner,counts,newtons\n1,0,ne,32767.5,10\n1,0,ne,65535,300\n0,1,sw,0,0").unwrap();
        assert_eq!(volts, counts);
        assert_eq!(volts.sensors.len(), 2);
        assert_eq!(volts.sensors[0].sensor, SensorId { tile: TileId::new(1, 0), corner: Corner::NorthEast });
        assert_eq!((volts.sensors[0].points.len(), volts.sensors[0].saturated), (1, 1));
    }

    #[test]
    fn every_problem_has_its_line_and_column() {
        let lines = "2,0,ne,1,1\n0,0,up,6,NaN\n0,0,ne,1\n0,-1,ne,,1\n1,1,ne,1,1\n";
        let table = read(&format!("{HEADER}{lines}")).unwrap();
        let problems = table.notes.problems;
        assert_eq!((problems.lines(), table.sensors.len()), (4, 1));
        let shown: Vec<String> = problems.shown().iter().map(ToString::to_string).collect();
        assert_eq!(
            shown,
            [
                "line 2, column col: expected a whole number from 0 to 1, found \"2\"",
                "line 3, column corner: expected sw, se, nw or ne, found \"up\"",
                "line 3, column volts: expected a number from 0 to 5, found \"6\"",
                "line 3, column newtons: expected a number from -100 to 10000, found \"NaN\"",
                "line 4: expected 5 fields, found 4",
                "line 5, column row: expected a whole number from 0 to 1, found \"-1\"",
                "line 5, column volts: expected a number from 0 to 5, found \"\"",
            ]
        );
        let table = read(&format!("{HEADER}{}", "0,0,ne,x,1\n".repeat(100))).unwrap();
        let problems = table.notes.problems;
        assert_eq!((problems.shown().len(), problems.more()), (20, 80));
        assert!(problems.to_string().ends_with("and 80 more like these"));
        assert!(read("").unwrap_err().to_string().contains("expected the header"));
    }

    #[test]
    fn verdicts_follow_the_residual() {
        let ramp = |error: f32| {
            loads((1..=40).map(|step| {
                let volts = 0.12 * step as f32;
                let off = if step % 2 == 0 { error } else { -error };
                (volts, nominal(volts) + off * nominal(4.8))
            }))
        };
        for (error, verdict) in
            [(0.0, Verdict::Good), (0.07, Verdict::Good), (0.11, Verdict::Poor), (0.2, Verdict::Replace)]
        {
            assert_eq!(ramp(error).judge().verdict, verdict, "{error}");
        }
    }

    #[test]
    fn a_verdict_is_of_the_law_that_the_part_follows() {
        let volts = || (1..=40).map(|step| 0.12 * step as f32);
        let power = loads(volts().map(|v| (v, 0.7 * v.powf(4.0)))).judge();
        assert_eq!((power.verdict, power.laws.chosen), (Verdict::Good, Some(LawKind::Power)));
        assert!(power.fit.unwrap().residual < 0.002, "{:?}", power.fit);
        let exponential = power.laws.candidate(LawKind::Exponential).fit.unwrap();
        assert!((0.015..0.06).contains(&exponential.residual), "{exponential:?}");
        // By the paper's law, a linear part would miss so far that it would have to be replaced.
        let linear = loads(volts().map(|v| (v, 80.0 * (v - 0.1)))).judge();
        assert_eq!((linear.verdict, linear.laws.chosen), (Verdict::Good, Some(LawKind::Linear)));
    }

    #[test]
    fn a_part_with_a_tiny_factor_is_as_good_as_its_residual() {
        let part = Calibration::exponential(4.4e-7, 4.1);
        let off = |step: u16| if step.is_multiple_of(2) { 1.05 } else { 0.95 };
        let points = (1..=40_u16).map(|step| 4.0 + 0.02 * f32::from(step)).zip(1_u16..);
        let judgement = loads(points.map(|(v, step)| (v, part.force_at(v).0 * off(step)))).judge();
        assert_eq!(judgement.verdict, Verdict::Good, "{judgement:?}");
        let candidate = judgement.laws.candidate(LawKind::Exponential).fit.unwrap();
        assert!((candidate.calibration.numbers()[0] / 4.4e-7 - 1.0).abs() < 0.2, "{candidate:?}");
    }

    #[test]
    fn broken_parts_are_told_from_parts_that_were_hardly_measured() {
        let steps = || (1..=20).map(|step| step as f32);
        // Open, shorted to a middle voltage, wired the wrong way round.
        assert_eq!(loads(steps().map(|k| (0.0, 10.0 * k))).judge().verdict, Verdict::Replace);
        assert_eq!(loads(steps().map(|k| (2.0, 10.0 * k))).judge().verdict, Verdict::Replace);
        assert_eq!(loads(steps().map(|k| (5.0 - 0.2 * k, 10.0 * k))).judge().verdict, Verdict::Replace);
        // Shorted to the supply: saturated readings only.
        let shorted = SensorLoads { saturated: 20, ..loads([]) };
        assert_eq!(shorted.judge().verdict, Verdict::Replace);
        // One load only, two points only, none.
        assert_eq!(loads(steps().map(|_| (2.0, 10.0))).judge().verdict, Verdict::Unmeasured);
        assert_eq!(loads([(1.0, 2.0), (2.0, 7.0)]).judge().verdict, Verdict::Unmeasured);
        assert_eq!(loads([]).judge().verdict, Verdict::Unmeasured);
    }

    proptest::proptest! {
        #[test]
        fn no_text_makes_it_panic(rows in "([0-9eE.,+\\-NaInfswne]{0,16},?\n?){0,40}") {
            let _ = read(&format!("{HEADER}{rows}"));
        }
    }
}
