//! Floor files: calibration and tare of sensors.

use super::behaviour::single;
use super::day;
use super::fields::Fields;
use super::floor::{Grid, Seen, corner};
use super::node::Node;
use crate::floor::{Calibration, CalibrationRecord, Corner, Day, Exponential, Floor, LawKind, SensorId};
use crate::units::Newtons;

/// The names of the laws, as in Rust.
pub(super) const LAWS: [(&str, LawKind); 4] = [
    ("Exponential", LawKind::Exponential),
    ("Power", LawKind::Power),
    ("Divider", LawKind::Divider),
    ("Linear", LawKind::Linear),
];

/// Calibration and tare of the sensors that are listed.
pub(super) fn sensors(node: Node<'_>, grid: Grid, floor: &mut Floor) -> Option<()> {
    let most = floor.geometry.tile_count().max(1) * Corner::ALL.len();
    let mut seen = Seen::new();
    for node in node.list("sensor", if grid.known.is_some() { most } else { usize::MAX })? {
        let Some(mut fields) = node.fields("Sensor") else { continue };
        let tile = fields.read("tile", None, |node| grid.tile(node));
        let corner = fields.read("corner", None, corner);
        let law = sensor_law(&mut fields);
        let tare = fields.read("tare_n", Some(0.0), |node| single(node, -5000.0..=5000.0));
        let record = calibration_record(&mut fields);
        let span = fields.span("tile");
        // Which numbers an unknown law has is not known.
        if law == SensorLaw::Unknown {
            fields.finish_leniently();
        } else {
            fields.finish();
        }
        let (Some(tile), Some(corner)) = (tile, corner) else { continue };
        let sensor = SensorId { tile, corner };
        seen.check(node.reader, sensor, || format!("the sensor of {sensor}"), span);
        let (SensorLaw::Known(law), Some(tare), Some(record)) = (law, tare, record) else { continue };
        let index = floor.geometry.index(tile).unwrap_or(usize::MAX);
        if let (Some(calibration), Some(tares)) =
            (floor.calibration.get_mut(index), floor.tare.get_mut(index))
        {
            calibration[corner.index()] = law;
            tares[corner.index()] = Newtons(tare);
            floor.calibration_records[index][corner.index()] = record;
        }
    }
    Some(())
}

/// When a sensor's law was measured: `calibrated` and `residual`, both or neither.
fn calibration_record(fields: &mut Fields<'_>) -> Option<Option<CalibrationRecord>> {
    let day: Option<Option<Day>> = fields.read("calibrated", Some(None), |node| day::read(node).map(Some));
    let residual = fields.read("residual", Some(None), |node| single(node, 0.0..=1e6).map(Some));
    match (day?, residual?) {
        (Some(day), Some(residual)) => Some(Some(CalibrationRecord { day, residual })),
        (None, None) => Some(None),
        (day, _) => {
            day::report_half(fields, ("calibrated", "residual"), day.is_some());
            None
        }
    }
}

/// What a sensor's entry says of its law.
#[derive(Clone, Copy, PartialEq)]
enum SensorLaw {
    Known(Calibration),
    /// A known law with numbers that it can't have, or without them.
    Incomplete,
    /// A law that there is not.
    Unknown,
}

/// `law` and its two numbers; the nominal part's where an exponential law has none.
fn sensor_law(fields: &mut Fields<'_>) -> SensorLaw {
    let kind = fields.read("law", Some(LawKind::Exponential), |node| node.choice(&LAWS));
    let Some(kind) = kind else { return SensorLaw::Unknown };
    let Exponential { a_n, b_per_volt } = Exponential::NOMINAL;
    let usual = match kind {
        LawKind::Exponential => [Some(a_n), Some(b_per_volt)],
        LawKind::Power | LawKind::Divider | LawKind::Linear => [None; 2],
    };
    let [a, b] = kind.parameters();
    let a = fields.read(a.name, usual[0], |node| single(node, a.range));
    let b = fields.read(b.name, usual[1], |node| single(node, b.range));
    match (a, b) {
        (Some(a), Some(b)) => SensorLaw::Known(Calibration::of(kind, [a, b])),
        _ => SensorLaw::Incomplete,
    }
}

#[cfg(test)]
mod tests {
    use super::super::{parse_floor, write_floor};
    use super::*;
    use crate::floor::{Divider, Geometry, Linear, Power};

    fn complaints(sensor: &str) -> String {
        let text = format!("Floor(columns: 1, rows: 1, sensors: [(tile: (0, 0), corner: Sw, {sensor})])");
        parse_floor(&text, "floor.ron").unwrap_err().to_string()
    }

    #[test]
    fn each_law_is_written_by_name_and_read_back() {
        let mut floor = Floor::of(Geometry::of_paper_tiles(1, 1).unwrap());
        floor.calibration[0] = [
            Calibration::exponential(4.4e-6, 3.7),
            Calibration::Power(Power { a_n: 2.2, exponent: 3.1 }),
            Calibration::Divider(Divider { a_n: 35.0, supply_v: 5.0 }),
            Calibration::Linear(Linear { a_n_per_volt: 82.0, zero_v: -0.4 }),
        ];
        let text = write_floor(&floor);
        let sensors = text.lines().skip_while(|line| !line.contains("// f = a exp")).take(9);
        insta::assert_snapshot!(sensors.collect::<Vec<_>>().join("\n"), @r"
        // f = a exp(b v) with v in volts, then the tare is taken off. Sensors that are not listed are nominal.
        // Power: f = a_n v^exponent.
        // Divider: f = a_n v / (supply_v - v).
        // Linear: f = a_n_per_volt (v - zero_v).
        sensors: [
            (tile: (0, 0), corner: Sw, a_n: 4.4e-6, b_per_volt: 3.7, tare_n: 0.0),
            (tile: (0, 0), corner: Se, law: Power, a_n: 2.2, exponent: 3.1, tare_n: 0.0),
            (tile: (0, 0), corner: Nw, law: Divider, a_n: 35.0, supply_v: 5.0, tare_n: 0.0),
            (tile: (0, 0), corner: Ne, law: Linear, a_n_per_volt: 82.0, zero_v: -0.4, tare_n: 0.0),
        ");
        assert_eq!(parse_floor(&text, "floor.ron").unwrap_or_else(|told| panic!("{told}")), floor);
    }

    #[test]
    fn an_unknown_law_is_told_with_the_nearest_name_and_nothing_else() {
        let told = complaints("law: Powr, a_n: 2.2, exponent: 3.1");
        assert!(
            told.contains("there is no `law` called Powr") && told.contains("did you mean Power?"),
            "{told}"
        );
        assert!(told.contains("1 error"), "{told}");
        let told = complaints("law: Logarithm, a_n: 2.2, b_per_volt: 3.1");
        assert!(told.contains("expected Exponential, Power, Divider or Linear"), "{told}");
    }

    #[test]
    fn numbers_of_another_law_and_numbers_that_no_part_has_are_told() {
        let told = complaints("law: Power, a_n: 2.2, b_per_volt: 3.1");
        assert!(told.contains("unknown field `b_per_volt`") && told.contains("lacks `exponent`"), "{told}");
        let told = complaints("law: Linear, a_n_per_volt: -3, zero_v: 0");
        assert!(told.contains("`a_n_per_volt` is out of range"), "{told}");
        let told = complaints("law: Divider, supply_v: 5");
        assert!(told.contains("lacks `a_n`"), "{told}");
    }
}
