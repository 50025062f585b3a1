//! A person who turns on the spot by small steps.

use glam::Vec2;
use rand::RngExt;

use super::body::RandomPerson;
use super::standing::{step_on, two_feet};
use super::thing::{STAND_ROLL, SceneObject};
use underfoot::floor::Rect;

/// Turns on the spot in three to eight steps of 25 to 55 degrees each, and lifts both feet.
///
/// The inner foot steps first. Each foot is lifted and put down around the middle between both; meanwhile the other one
/// carries the person and follows a part of the turn.
///
/// # Source
/// Our assumption, without a measurement behind it: a half turn takes some 2 to 3 s and four to six steps, so a step
/// takes about half a second, a third of it on both feet. Feet land flat or on the ball.
pub(super) fn turn_around(body: &mut RandomPerson, bounds: Rect) -> Vec<SceneObject> {
    let (weight, width) = (body.weight_n(), body.person().stand_width_m);
    let mut feet = two_feet(body, bounds, width);
    step_on(body, &mut feet, weight);
    let steps = body.rng.random_range(3..=8_u8);
    let way = body.sign();
    let turn = way * body.within(0.44, 0.96);
    let follows = body.within(0.0, 0.3);
    let at = |foot: &SceneObject| Vec2::new(foot.x.at(0.0), foot.y.at(0.0));
    let middle = 0.5 * (at(&feet[0]) + at(&feet[1]));
    // Offset from the middle, and heading, of each foot before the turn.
    let before = [&feet[0], &feet[1]].map(|foot| (at(foot) - middle, foot.heading.at(0.0)));
    let mut done: Vec<SceneObject> = Vec::new();
    let mut now = 1.5 + f64::from(body.within(0.0, 0.5));
    let mut which = if way > 0.0 { 0 } else { 1 };
    for step in 1..=steps {
        let lift = now + f64::from(body.within(0.10, 0.25));
        let land = lift + f64::from(body.within(0.25, 0.40));
        let both = land + f64::from(body.within(0.08, 0.20));
        let turned = turn * f32::from(step);
        let (offset, heading) = before[which];
        let place = middle + Vec2::from_angle(turned).rotate(offset) + scatter(body);
        let mut next = SceneObject::foot(body, place, heading + turned);
        next.sway.clone_from(&feet[which].sway);
        next.roll.rest(land, STAND_ROLL + body.within(0.0, 0.35));
        next.roll.rest(both + 0.1, STAND_ROLL);
        next.presses(land, 0.0).presses(both, 0.5 * weight);
        feet[which].presses(now, 0.5 * weight).presses(lift, 0.0);
        let stands = &mut feet[1 - which];
        stands.presses(now, 0.5 * weight).presses(lift, weight);
        stands.presses(land, weight).presses(both, 0.5 * weight);
        stands.heading.hold(lift);
        stands.heading.rest(land, stands.heading.at(lift) + follows * turn);
        done.push(std::mem::replace(&mut feet[which], next));
        which = 1 - which;
        now = both + f64::from(body.within(0.0, 0.15));
    }
    for foot in &mut feet {
        foot.presses(now, 0.5 * weight).presses(now + 0.3, 0.0);
    }
    done.extend(feet);
    done
}

/// Distance by which a foot misses its place: one centimetre along each axis, as a standard deviation.
fn scatter(body: &mut RandomPerson) -> Vec2 {
    0.01 * Vec2::new(body.normal(), body.normal()).clamp(Vec2::splat(-2.0), Vec2::splat(2.0))
}
