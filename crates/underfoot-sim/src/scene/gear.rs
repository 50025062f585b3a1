//! Scenes with objects that people bring: sticks and wheels.

use glam::Vec2;
use rand::RngExt;

use super::body::RandomPerson;
use super::thing::{SceneObject, Sole};
use crate::gait::Gait;
use crate::track::forward;
use underfoot::floor::Rect;

/// A person who walks straight over the floor, step by step.
struct Stroll {
    /// The feet, in the order of their steps.
    steps: Vec<SceneObject>,
    /// Position of the body at each touchdown, and its time.
    landings: Vec<(Vec2, f64)>,
    step_s: f64,
}

/// A straight path over the floor through a point: start, heading and length.
fn way(body: &mut RandomPerson, bounds: Rect) -> (Vec2, f32, f32) {
    let through = body.place(bounds, 0.5);
    let heading = body.angle();
    let half = 0.5 * bounds.size().length() + 0.4;
    (through - forward(heading) * half, heading, 2.0 * half)
}

/// Walks the path at a speed in metres per second, with the weight `weight_n`.
fn stroll(
    body: &mut RandomPerson,
    (from, heading, length): (Vec2, f32, f32),
    speed: f32,
    weight_n: f32,
) -> Stroll {
    let gait = Gait::at_speed(speed);
    let contact_s = body.habit.contact_s(gait.speed_m_s);
    // Step duration at which stances of that contact time overlap by a quarter of a step.
    let step_s = f64::from((contact_s / 1.25).max(gait.step_s * 0.8));
    let step_m = gait.speed_m_s * step_s as f32;
    let right = -forward(heading).perp();
    let (width, turn_out) = (body.person().step_width_m, body.habit.turn_out());
    let mut side = body.sign();
    let (mut steps, mut landings) = (Vec::new(), Vec::new());
    for step in 0..(length / step_m) as u32 {
        let middle = from + forward(heading) * (step_m * step as f32);
        let at = middle + right * (0.5 * width * side);
        let landing_s = 0.2 + step_s * f64::from(step);
        let share = step_s as f32 / contact_s;
        let peak = |rolling: &crate::rolling::Rolling| weight_n * share / rolling.mean_force().max(0.2);
        steps.push(SceneObject::step(
            body,
            (at, heading - turn_out * side),
            side,
            landing_s,
            gait.speed_m_s,
            peak,
        ));
        landings.push((middle, landing_s));
        side = -side;
    }
    Stroll { steps, landings, step_s }
}

/// A stick of 15 mm radius on the far side, which lands with every other step and carries 6 to 25 % of the weight.
pub(super) fn stick(body: &mut RandomPerson, bounds: Rect) -> Vec<SceneObject> {
    let way = way(body, bounds);
    let speed = body.within(0.5, 1.0);
    let carried = body.within(0.06, 0.25);
    let weight = body.weight_n();
    let Stroll { steps, landings, step_s } = stroll(body, way, speed, weight * (1.0 - 0.5 * carried));
    let right = -forward(way.1).perp() * body.sign();
    let mut things = steps;
    for (middle, landing_s) in landings.into_iter().step_by(2) {
        let ahead = forward(way.1) * body.within(0.10, 0.20) + right * body.within(0.26, 0.34);
        let half_m = Vec2::splat(0.015);
        let mut tip = SceneObject::at(Sole::Round { half_m }, middle + ahead, way.1);
        let force = carried * weight;
        let begin = landing_s + f64::from(body.within(-0.05, 0.10)).max(-landing_s);
        tip.presses(begin, 0.0).presses(begin + 0.15, force);
        tip.presses(begin + step_s, force).presses(begin + step_s + 0.15, 0.0);
        things.push(tip);
    }
    things
}

/// Four wheels of a trolley (30 to 80 kg) or of an occupied wheelchair (60 to 140 kg), pushed by a person walking
/// behind.
///
/// # Source
/// Our assumption of usual sizes. Wheelchairs: some 0.42 m from axle to axle, 0.55 m wide, two thirds of the weight
/// on the large rear wheels; trolleys: 0.6 m long and 0.4 m wide.
pub(super) fn wheels(body: &mut RandomPerson, bounds: Rect) -> Vec<SceneObject> {
    let (from, heading, length) = way(body, bounds);
    let speed = body.within(0.4, 1.1);
    let weight = body.weight_n();
    let chair = body.rng.random_bool(0.5);
    let (base, wide, behind) = if chair { (0.42, 0.55, 0.66) } else { (0.6, 0.4, 0.5) };
    let total = 9.81 * if chair { body.within(60.0, 140.0) } else { body.within(30.0, 80.0) };
    let right = -forward(heading).perp();
    // Pushed with both hands: the walker's feet are half a metre behind the wheels.
    let Stroll { mut steps, .. } =
        stroll(body, (from - forward(heading) * 0.55, heading, length + 0.55), speed, weight);
    let took = f64::from(length / Gait::at_speed(speed).speed_m_s);
    for (ahead, side, share) in [
        (0.0, -1.0, 0.5 * behind),
        (0.0, 1.0, 0.5 * behind),
        (base, -1.0, 0.5 * (1.0 - behind)),
        (base, 1.0, 0.5 * (1.0 - behind)),
    ] {
        let at = from + forward(heading) * ahead + right * (0.5 * wide * side);
        let mut wheel = SceneObject::at(Sole::Round { half_m: Vec2::new(0.012, 0.02) }, at, heading);
        let velocity = forward(heading) * (length / took as f32);
        let end = 0.2 + took;
        wheel.presses(0.2, 0.0).presses(0.2, total * share).presses(end, total * share).presses(end, 0.0);
        for (moment, at) in [(0.2, at), (end, at + forward(heading) * length)] {
            wheel.x.pass(moment, at.x, velocity.x);
            wheel.y.pass(moment, at.y, velocity.y);
        }
        steps.push(wheel);
    }
    steps
}
