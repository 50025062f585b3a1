//! Room for shoes: sizes, gaps, reach, and the position error of a foot.

use std::ops::Range;

use glam::Vec2;

use super::{Part, Subject, cm, predicted_error_m};
use underfoot::floor::{Geometry, Rect, TileId};
use underfoot::layout::{CursorRule, Stance, Widget};
use underfoot::widget::{Axis, Behaviour, Guard, Mapping};

/// Feet miss a control with a shorter side (m).
const MISSED_M: f32 = 0.05;
/// A shoe covers a control, or a part of one, with a shorter side (m).
pub const SMALL_M: f32 = 0.10;
/// Half the width of a foot (m).
const HALF_FOOT_M: f32 = 0.055;
/// Minimum gap between pedals for one foot, operated in sequence (m).
const SEQUENTIAL_M: f32 = 0.05;
/// Minimum gap between pedals for one foot, operated in any order (m).
const RANDOM_M: f32 = 0.10;
/// Maximum reach of a foot without moving the body (m).
pub const REACH_M: f32 = 0.8;
/// Maximum reach with a long step (m).
pub const STEP_AWAY_M: f32 = 1.2;
/// Half the width and half the length of a shoe: distance of a foot's middle from a stance zone's edges.
const HALF_SHOE: Vec2 = Vec2::new(0.06, 0.13);
/// Minimum distance between two adjacent values of a slider (m).
const STEP_M: f32 = 0.01;
/// Tolerance for rounding errors (m).
const SLACK_M: f32 = 1e-4;

pub(super) fn review(subject: &mut Subject<'_>) {
    size(subject);
    neighbours(subject);
    reach(subject);
    stance_tiles(subject);
    standing_cursor(subject);
    place_error(subject);
    steps(subject);
}

fn size(subject: &mut Subject<'_>) {
    let (size, part) = smallest_part(subject.widget);
    let side = size.min_element();
    let expected = format!("it is {} x {}", cm(size.x), cm(size.y));
    if side < MISSED_M - SLACK_M {
        let message = format!("{part}{} is smaller than feet can hit", subject.name());
        subject.error("U101", Part::Size, message, expected);
    } else if side < SMALL_M - SLACK_M {
        let message = format!("{part}{} is smaller than a shoe is wide", subject.name());
        subject.warning("U101", Part::Size, message, expected);
    }
}

/// Name of a guard, and the gaps below which the review reports an error and a warning.
fn gaps(guard: Guard) -> (&'static str, f32, f32) {
    match guard {
        Guard::Free => ("", 0.0, SEQUENTIAL_M),
        Guard::Confirm { .. } => ("`Confirm` ", 0.0, HALF_FOOT_M),
        Guard::HoldToRun { .. } => ("`HoldToRun` ", HALF_FOOT_M, RANDOM_M),
    }
}

/// The gap to its neighbours that a control needs, in metres; between two controls, the larger of theirs counts.
#[must_use]
pub fn needed_gap_m(widget: &Widget) -> f32 {
    gaps(widget.behaviour.thresholds().guard).2
}

/// The distance of two areas, in metres; 0 where they touch or overlap.
#[must_use]
pub fn gap_between_m(one: Rect, other: Rect) -> f32 {
    (other.min - one.max).max(one.min - other.max).max(Vec2::ZERO).length()
}

fn neighbours(subject: &mut Subject<'_>) {
    let area = subject.widget.area;
    let (word, least, wanted) = gaps(subject.widget.behaviour.thresholds().guard);
    let nearest = subject
        .others()
        .map(|other| (gap_between_m(area, other.area), other))
        .filter(|(gap, _)| *gap < wanted - SLACK_M)
        .min_by(|a, b| a.0.total_cmp(&b.0));
    let Some((gap, other)) = nearest else { return };
    // Of two controls with the same guard, the review reports the later one.
    let (_, other_least, other_wanted) = gaps(other.behaviour.thresholds().guard);
    let is_theirs = (other_least, other_wanted) > (least, wanted);
    let is_later =
        subject.layout.widgets.iter().position(|widget| widget.id == other.id) > Some(subject.index);
    if is_theirs || (is_later && (other_least, other_wanted) == (least, wanted)) {
        return;
    }
    let message = format!("{} is too close to \"{}\"", subject.name(), other.id);
    let expected = format!("{} apart; {word}controls need {}", cm(gap), cm(wanted));
    if gap < least - SLACK_M {
        subject.error("U102", Part::Place, message, expected);
    } else {
        subject.warning("U102", Part::Place, message, expected);
    }
}

/// Area in which the middle of a foot can be that stands within the zone.
#[must_use]
pub fn footing(stance: &Stance) -> Rect {
    let margin = HALF_SHOE.min(0.5 * stance.area.size());
    Rect::new(stance.area.min + margin, stance.area.max - margin)
}

/// The distance from `point` to the nearest place of a standing foot, in metres; `None` without stance zones.
#[must_use]
pub fn reach_m(stances: &[Stance], point: Vec2) -> Option<f32> {
    stances.iter().map(|stance| footing(stance).distance(point)).min_by(f32::total_cmp)
}

fn reach(subject: &mut Subject<'_>) {
    let Some(reach) = reach_m(&subject.layout.stances, subject.widget.area.centre()) else { return };
    if reach <= REACH_M + SLACK_M {
        return;
    }
    let expected = format!("{reach:.2} m from the nearest place to stand");
    if reach > STEP_AWAY_M {
        let message = format!("{} is beyond a step from every stance zone", subject.name());
        subject.error("U103", Part::Place, message, expected);
    } else {
        let message = format!("{} is out of reach of a foot from every stance zone", subject.name());
        subject.warning("U103", Part::Place, message, expected);
    }
}

/// South-western and north-eastern tile under `area`.
fn tiles(geometry: &Geometry, area: Rect) -> (TileId, TileId) {
    let inset = Vec2::splat(1e-3);
    let tile = |corner: Vec2| {
        let at = (corner / geometry.pitch_m()).floor().as_u16vec2();
        let near = |at: u16, range: Range<u16>| at.clamp(range.start, range.end - 1);
        let block = geometry.block();
        TileId::new(near(at.x, block.column_range()), near(at.y, block.row_range()))
    };
    (tile(area.min + inset), tile(area.max - inset))
}

/// The number of free rows or columns of tiles between two areas, whichever is larger; negative where they share a
/// tile.
#[must_use]
pub fn free_tiles(geometry: &Geometry, one: Rect, other: Rect) -> i32 {
    let (first, last) = tiles(geometry, one);
    let (south_west, north_east) = tiles(geometry, other);
    let apart = |low: u16, high: u16, other_low: u16, other_high: u16| {
        i32::from(other_low.max(low)) - i32::from(other_high.min(high)) - 1
    };
    let columns = apart(first.column, last.column, south_west.column, north_east.column);
    columns.max(apart(first.row, last.row, south_west.row, north_east.row))
}

fn stance_tiles(subject: &mut Subject<'_>) {
    let geometry = subject.floor.geometry;
    let area = subject.widget.area;
    // Another rule reports overlaps.
    let too_near =
        |stance: &&Stance| free_tiles(&geometry, area, stance.area) < 1 && !stance.area.overlaps(area);
    let Some(stance) = subject.layout.stances.iter().find(too_near) else { return };
    let zone = if stance.label.is_empty() { String::new() } else { format!(" \"{}\"", stance.label) };
    let message = format!("{} has no free tile between it and the stance zone{zone}", subject.name());
    subject.warning("U104", Part::Place, message, "the two feet share sensors".into());
}

/// Reports a region in which a standing foot may be the cursor, at its first control.
fn standing_cursor(subject: &mut Subject<'_>) {
    let number = subject.widget.region;
    let Some(region) = subject.layout.regions.get(number) else { return };
    let is_first =
        subject.layout.widgets.iter().position(|widget| widget.region == number) == Some(subject.index);
    if !is_first || region.cursor != CursorRule::Largest {
        return;
    }
    let gap = |stance: &&Stance| gap_between_m(stance.area, region.area);
    let nearest = subject.layout.stances.iter().min_by(|a, b| gap(a).total_cmp(&gap(b)));
    let Some(stance) = nearest.filter(|stance| gap(stance) < HALF_SHOE.y - SLACK_M) else { return };
    let zone = if stance.label.is_empty() { String::new() } else { format!(" \"{}\"", stance.label) };
    let expected = match gap(&stance) {
        0.0 => "the zone reaches into the region".to_owned(),
        gap => format!("they are {} apart, a shoe reaches {}", cm(gap), cm(HALF_SHOE.y)),
    };
    let message = format!(
        "a foot that stands in or beside the stance zone{zone} can be the cursor of \"{}\"",
        region.id
    );
    subject.warning("U107", Part::Id, message, expected);
}

fn place_error(subject: &mut Subject<'_>) {
    let widget = subject.widget;
    let press = widget.behaviour.thresholds().press;
    let error = predicted_error_m(subject.floor, widget.area, press);
    let (size, part) = smallest_part(widget);
    let half = 0.5 * size.min_element();
    let expected = format!(
        "found within {} in 95 of 100 cases at {:.0} N, its edge is {} from its middle",
        cm(error),
        press.0,
        cm(half)
    );
    if error > half + SLACK_M {
        let message = format!("{part}{} is smaller than the error of finding a foot here", subject.name());
        subject.error("U105", Part::Size, message, expected);
    } else if error > 0.5 * half + SLACK_M {
        let message = format!("{part}{} is small for the error of finding a foot here", subject.name());
        subject.warning("U105", Part::Size, message, expected);
    }
}

fn steps(subject: &mut Subject<'_>) {
    let size = subject.widget.area.size();
    let step = match &subject.widget.behaviour {
        Behaviour::Slider(slider) if slider.mapping == Mapping::Absolute => {
            let share = slider.scale.step / slider.scale.range();
            // Measured at the middle, where a straight track and an arc have the same step.
            let [from, to] = [0.5, 0.5 + share].map(|share| slider.track.place_at(share, size) * size);
            (slider.scale.step > 0.0).then(|| from.distance(to))
        }
        Behaviour::Pad(pad) => {
            let axes =
                [(pad.x(), size.x), (pad.y(), size.y)].into_iter().filter(|(scale, _)| scale.step > 0.0);
            axes.map(|(scale, length)| length * scale.step / scale.range()).min_by(f32::total_cmp)
        }
        _ => None,
    };
    let Some(step) = step.filter(|step| *step < STEP_M - SLACK_M) else { return };
    let message = format!("{} has steps finer than a foot can hold", subject.name());
    subject.warning("U106", Part::Step, message, format!("{} from one value to the next", cm(step)));
}

/// Size of the smallest part of a control that a foot must hit, in metres, and the name of that part: empty for the
/// control as a whole.
#[must_use]
pub fn smallest_part(widget: &Widget) -> (Vec2, &'static str) {
    let size = widget.area.size();
    let split = |axis: Axis, parts: f32| match axis {
        Axis::East => Vec2::new(size.x / parts, size.y),
        Axis::North => Vec2::new(size.x, size.y / parts),
    };
    match &widget.behaviour {
        Behaviour::Selector(selector) => {
            (split(selector.axis, selector.options.len().max(1) as f32), "each option of ")
        }
        Behaviour::Stepper(stepper) => (split(stepper.axis, 2.0), "each half of "),
        _ => (size, ""),
    }
}
