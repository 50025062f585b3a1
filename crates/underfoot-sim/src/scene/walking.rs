//! Scenes of walking people.

use std::f32::consts::PI;
use std::time::Duration;

use glam::Vec2;

use super::body::RandomPerson;
use crate::person::MoveError;
use crate::script::Script;
use underfoot::floor::Rect;

/// A starting place outside the floor: far enough from its centre that no part of a foot is on the floor.
fn outside(bounds: Rect, angle: f32) -> Vec2 {
    bounds.centre() + Vec2::from_angle(angle) * (0.5 * bounds.size().length() + 0.45)
}

fn seconds(body: &mut RandomPerson, low: f32, high: f32) -> Duration {
    Duration::from_secs_f32(body.within(low, high))
}

/// Heading of a person who walks along `way`.
fn heading(way: Vec2) -> f32 {
    way.to_angle() - 0.5 * PI
}

/// Walks onto the floor, stops, and walks off it.
pub(super) fn walk(body: &mut RandomPerson, bounds: Rect) -> Result<Script, MoveError> {
    let stop = body.place(bounds, 0.45);
    let from = outside(bounds, body.angle());
    let to = outside(bounds, body.angle());
    let mut walker = body.performance();
    walker.appear(from, heading(stop - from))?;
    walker.walk(&[stop])?;
    walker.wait(seconds(body, 0.5, 2.0));
    walker.walk(&[to])?;
    walker.disappear()?;
    Ok(Script::new(vec![walker], bounds))
}

/// Two or three steps aside and back.
pub(super) fn sidesteps(body: &mut RandomPerson, bounds: Rect) -> Result<Script, MoveError> {
    let middle = bounds.centre() + Vec2::new(body.within(-0.2, 0.2), body.within(-0.2, 0.2));
    let way = body.angle();
    let (from, to) = (outside(bounds, way), outside(bounds, body.angle()));
    let mut person = body.performance();
    person.appear(from, heading(middle - from))?;
    person.walk(&[middle])?;
    person.wait(seconds(body, 0.8, 1.5));
    let sideways = (middle - from).normalize_or_zero().perp() * body.sign();
    for far in [body.within(0.15, 0.45), body.within(-0.4, -0.1), 0.0] {
        person.sidestep(middle + sideways * far)?;
        person.wait(seconds(body, 0.3, 1.0));
    }
    person.walk(&[to])?;
    person.disappear()?;
    Ok(Script::new(vec![person], bounds))
}

/// Two people come from opposite sides, stand toe to toe, shift their weight, and go back.
pub(super) fn face_to_face(
    one: &mut RandomPerson,
    other: &mut RandomPerson,
    bounds: Rect,
) -> Result<Script, MoveError> {
    let way = one.angle();
    let middle = bounds.centre() + Vec2::new(one.within(-0.15, 0.15), one.within(-0.15, 0.15));
    // 8 to 25 cm from toes to toes.
    let feet = 0.5 * (one.person().foot_length_m + other.person().foot_length_m);
    let apart = feet + one.within(0.08, 0.25);
    let talk = one.within(2.0, 4.0);
    let mut cast = Vec::new();
    for (body, side) in [(one, 1.0), (other, -1.0)] {
        let away = Vec2::from_angle(way) * side;
        let stand = middle + away * (0.5 * apart);
        let from = outside(bounds, (away).to_angle());
        let mut person = body.performance();
        person.appear(from, heading(-away))?;
        person.wait(seconds(body, 0.1, 1.0));
        person.walk(&[stand])?;
        person.wait(Duration::from_secs_f32(0.5 * talk));
        let aside = body.within(0.05, 0.15) * body.sign();
        person.sidestep(stand + away.perp() * aside)?;
        person.wait(Duration::from_secs_f32(0.5 * talk));
        person.walk(&[from])?;
        person.disappear()?;
        cast.push(person);
    }
    Ok(Script::new(cast, bounds))
}
