//! Calibration by standing: marks in words, and the laws in the floor.

use underfoot::floor::{CalibrationRecord, Day, Floor, TileId};
use underfoot::sense::{SensorFit, StandFit, StandingMark};

/// Describes a mark: tile, place and direction.
#[must_use]
pub fn mark_words(mark: &StandingMark, floor: &Floor) -> String {
    let off = 100.0 * (mark.at - floor.geometry.centre(mark.tile));
    let along = |(way, less, more): (f32, &str, &str)| {
        (way.abs() >= 0.05).then(|| format!("{:.1} cm {}", way.abs(), if way < 0.0 { less } else { more }))
    };
    let ways: Vec<String> =
        [(off.x, "west", "east"), (off.y, "south", "north")].into_iter().filter_map(along).collect();
    let place = if ways.is_empty() {
        "in the middle".to_owned()
    } else {
        format!("{} of the middle", ways.join(" and "))
    };
    let facing = if mark.facing == 0.0 { "north" } else { "south" };
    format!("tile {}, {place}, facing {facing}", mark.tile)
}

/// Stores the laws and tares of `fit`, which was measured on `day`, in the floor.
pub fn keep_laws(floor: &mut Floor, fit: &StandFit, day: Day) {
    for found in fit.sensors.iter().filter(|found| found.determined > 0) {
        let record = CalibrationRecord::rounded(day, found.uncertainty);
        floor.recalibrate(found.sensor, found.law, Some(record));
        let tile = floor.geometry.index(found.sensor.tile).and_then(|tile| floor.tare.get_mut(tile));
        if let Some(tares) = tile {
            tares[found.sensor.corner.index()] = found.tare;
        }
    }
    if fit.sensors.iter().all(|found| found.determined > 0) {
        floor.tared = Some(day);
    }
}

fn count(number: usize, name: &str) -> String {
    if number == 1 { format!("1 {name}") } else { format!("{number} {name}s") }
}

/// A sentence on the sensors for which laws of another kind give other forces.
fn unsure(fit: &StandFit) -> Option<String> {
    let loads = fit.sensors.iter().map(|found| found.sure_to.0).filter(|load| load.is_finite());
    let (sensors, least) = (loads.clone().count(), loads.reduce(f32::min)?);
    let sensors = count(sensors, "sensor");
    Some(format!(
        "Another kind of law fits {sensors} about as well, and differs by more than 10 % above {least:.0} N: take the \
         kind from the parts' data sheet (--law), or a heavier person."
    ))
}

/// Describes the result of a calibration by standing, in sentences.
#[must_use]
pub fn fit_words(fit: &StandFit) -> Vec<String> {
    let (stands, crossings) = (count(fit.stands, "stand"), count(fit.crossings, "way"));
    let mut words = vec![
        format!(
            "{stands} and {crossings} between them count. All sensors follow one kind of law: {}.",
            fit.kind.name()
        ),
        format!(
            "The sums miss the weight by {:.1} %, the feet their marks by {:.1} cm; the body leans {:.1} cm forwards \
             and {:.1} cm to the right.",
            100.0 * fit.weight_residual,
            100.0 * fit.place_residual_m,
            100.0 * fit.lean_m.y,
            100.0 * fit.lean_m.x
        ),
    ];
    if !fit.saturated.is_empty() {
        let stands = count(fit.saturated.len(), "stand");
        words.push(format!(
            "{stands} had a sensor at the end of its range, and told less: a lighter person tells more."
        ));
    }
    if !fit.astray.is_empty() {
        let numbers: Vec<String> = fit.astray.iter().map(|number| (number + 1).to_string()).collect();
        words
            .push(format!("Left out, because they disagree with all others: stands {}.", numbers.join(", ")));
    }
    words.extend(unsure(fit));
    words
}

/// Returns the tiles of `marks` with sensors that need more stands, in the order of their numbers.
#[must_use]
pub fn needy_tiles(fit: &StandFit, marks: &[StandingMark], floor: &Floor) -> Vec<TileId> {
    let is_good = |tile: TileId| {
        floor.geometry.sensors(tile).iter().all(|corner| {
            let own = |found: &&SensorFit| (found.sensor.tile, found.sensor.corner) == (tile, *corner);
            fit.sensors.iter().find(own).is_some_and(|found| !found.needs_more())
        })
    };
    let mut tiles: Vec<TileId> = marks.iter().map(|mark| mark.tile).collect();
    tiles.sort_by_key(|tile| floor.geometry.index(*tile));
    tiles.dedup();
    tiles.retain(|tile| !is_good(*tile));
    tiles
}
