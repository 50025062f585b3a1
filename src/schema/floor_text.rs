//! Writing of floor files.

use super::floor::FloorFileRecord;
use crate::floor::{Floor, LawKind};
use underfoot_format::text::RonText;

/// Comments above each field, and the comment in place of a field that is not written.
const COMMENTS: [(&str, &[&str], Option<&str>); 17] = [
    ("sensors_m", &["Where the sensors are under each plate, from its centre: (east, north)."], None),
    ("missing", &["Cells of the grid without a tile."], None),
    ("plates", &["Plates that differ from the others."], None),
    ("areas", &["The parts of the floor that a computer of its own serves."], None),
    ("gateway", &["Where the computer that joins them listens."], None),
    (
        "boards",
        &["Which tiles, or which sensors, are on the channels of each board."],
        Some("Each row of tiles has its own boards, up to eight tiles a board."),
    ),
    ("allow", &["Where the boards' packets come from."], None),
    ("serial", &["The serial ports of boards, and the columns of those that send lines of text."], None),
    ("noiseless", &["The readings have no noise of their own: that they repeat says nothing."], None),
    ("off", &["Sensors that are switched off."], None),
    ("tared", &[], None),
    (
        "sensors",
        &[
            "f = a exp(b v) with v in volts, then the tare is taken off. Sensors that are not listed are nominal.",
        ],
        Some("No sensor has been calibrated: all are taken as nominal parts."),
    ),
    (
        "maps",
        &[
            "Result of pressed points for each tile: a factor per sensor that follows its load,",
            "and a shift of the position. Measure them anew rather than edit them.",
        ],
        None,
    ),
    (
        "drive",
        &["Drive of the actuators: volts at full scale, and the power that a coil bears without end."],
        None,
    ),
    ("response_db", &["How strongly the plates move: hertz, and decibels relative to full_scale_n."], None),
    (
        "actuators",
        &["Output channels; tiles that are not listed have no actuator."],
        Some("Each tile has an actuator, channel by channel in tile order."),
    ),
    ("loudspeakers", &["Loudspeakers, by where they stand, in metres from the south-west corner."], None),
];

/// Lists that stand on one line.
const ON_ONE_LINE: [&str; 3] = ["sensors_m", "allow", "response_db"];

/// Writes the file that describes `floor`, with comments; [`super::parse_floor`] reads the same floor from it.
///
/// Fields as on [`Floor::of`] its geometry are omitted. A list of more than about 40,000 sensors, or 4,000 mapped
/// tiles, exceeds the 4 MB limit on reading; reading rejects such files and numbers outside of the valid ranges
/// (`save_floor` rejects them on writing).
#[must_use]
pub fn write_floor(floor: &Floor) -> String {
    let record = FloorFileRecord::of(floor);
    let is_told = |name: &str| COMMENTS.iter().any(|(told, ..)| *told == name);
    let (told, measures): (Vec<_>, Vec<_>) =
        record.written().into_iter().partition(|(name, _)| is_told(name));
    let mut text = "// A floor: where its tiles are and what is wired to them.\n\
         // Tiles are (column, row) from the south-west, lengths in metres, forces in newtons.\nFloor(\n"
        .to_owned();
    for (name, value) in measures {
        text.push_str(&format!("    {name}: {},\n", value.inline()));
    }
    text.push('\n');
    for (name, comments, absent) in COMMENTS {
        let Some((_, value)) = told.iter().find(|(told, _)| *told == name) else {
            absent.iter().for_each(|absent| text.push_str(&format!("    // {absent}\n")));
            continue;
        };
        comments.iter().for_each(|comment| text.push_str(&format!("    // {comment}\n")));
        let has = |kind| record.parts.sensors.iter().any(|sensor| sensor.law().kind() == kind);
        for kind in LawKind::ALL.into_iter().filter(|kind| name == "sensors" && has(*kind)) {
            text.push_str(meaning(kind));
        }
        let value = match value {
            RonText::List(values) if !ON_ONE_LINE.contains(&name) => {
                let lines = values.iter().map(|value| format!("        {},\n", value.inline()));
                format!("[\n{}    ]", lines.collect::<String>())
            }
            value => value.inline(),
        };
        text.push_str(&format!("    {name}: {value},\n"));
    }
    text.push_str(")\n");
    text
}

/// Returns the comment on a law other than the paper's, which the comment above all sensors explains.
fn meaning(kind: LawKind) -> &'static str {
    match kind {
        LawKind::Exponential => "",
        LawKind::Power => "    // Power: f = a_n v^exponent.\n",
        LawKind::Divider => "    // Divider: f = a_n v / (supply_v - v).\n",
        LawKind::Linear => "    // Linear: f = a_n_per_volt (v - zero_v).\n",
    }
}
