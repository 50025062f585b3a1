//! The result of a calibration by standing, in words and as JSON.

use serde_json::{Value, json};
use underfoot::floor::{Floor, TileId};
use underfoot::sense::{SensorFit, StandFit, StandingMark};
use underfoot::serve::StandWalk;

use super::count;
use underfoot_window::setup::{fit_words, mark_words, needy_tiles};

pub(super) fn print_marks(marks: &[StandingMark], floor: &Floor, json: bool) {
    if json {
        let marks: Vec<_> = marks
            .iter()
            .map(|mark| {
                let (tile, facing) = (mark.tile, if mark.facing == 0.0 { "north" } else { "south" });
                json!({ "col": tile.column, "row": tile.row, "x_m": mark.at.x, "y_m": mark.at.y, "facing": facing })
            })
            .collect();
        outln!("{}", json!({ "marks": marks }));
    } else {
        marks.iter().for_each(|mark| outln!("{}", mark_words(mark, floor)));
    }
}

pub(super) fn print(fit: &StandFit, walk: &StandWalk, floor: &Floor) {
    fit_words(fit).iter().for_each(|words| outln!("{words}"));
    // A neighbour that carried a foot's edge is no part of the walk.
    let walked = |tile: TileId| walk.marks().iter().any(|mark| mark.tile == tile);
    let needy: Vec<&SensorFit> = fit.needy().filter(|found| walked(found.sensor.tile)).collect();
    if needy.is_empty() {
        return;
    }
    outln!("tile      sensor  most, N  uncertain by");
    for found in needy {
        let name = floor.geometry.sensor_name(found.sensor.corner);
        let uncertain = match found.determined {
            0 => "no law".to_owned(),
            _ => format!("{:.0} %", 100.0 * found.uncertainty),
        };
        outln!("{:<9} {name:<6}  {:>7.0}  {uncertain:>12}", found.sensor.tile.to_string(), found.most.0);
    }
}

pub(super) fn as_json(fit: &StandFit, floor: &Floor, saved: Option<&Value>) -> Value {
    let sensor = |found: &SensorFit| {
        json!({
            "col": found.sensor.tile.column,
            "row": found.sensor.tile.row,
            "corner": floor.geometry.sensor_name(found.sensor.corner),
            "law": found.law.kind().name(),
            "numbers": found.law.numbers(),
            "tare_n": found.tare,
            "most_n": found.most,
            "uncertainty": found.uncertainty.is_finite().then_some(found.uncertainty),
            "determined": found.determined,
            "sure_to_n": found.sure_to.0.is_finite().then_some(found.sure_to),
            "needs_more": found.needs_more(),
        })
    };
    json!({
        "law": fit.kind.name(),
        "laws": fit.laws.iter().map(|laws| json!({
            "law": laws.kind.name(),
            "misfit": laws.misfit.is_finite().then_some(laws.misfit),
        })).collect::<Vec<_>>(),
        "weight_residual": fit.weight_residual,
        "place_residual_m": fit.place_residual_m,
        "lean_m": { "right": fit.lean_m.x, "forwards": fit.lean_m.y },
        "stands": fit.stands,
        "crossings": fit.crossings,
        "astray": fit.astray,
        "saturated": fit.saturated,
        "sensors": fit.sensors.iter().map(sensor).collect::<Vec<_>>(),
        "saved": saved,
    })
}

/// The tiles of the walk that need more stands, and how to repeat them.
pub(super) fn more(fit: &StandFit, walk: &StandWalk, floor: &Floor) -> Option<String> {
    let tiles = needy_tiles(fit, walk.marks(), floor);
    let list: Vec<String> = tiles.iter().map(|tile| format!("{},{}", tile.column, tile.row)).collect();
    (!tiles.is_empty()).then(|| {
        let tiles = count(tiles.len(), "tile");
        format!("{tiles} need more stands: stand again with --rounds 2, or with --tiles {}", list.join(" "))
    })
}
