//! Scenes of people who stay in place: shifting, jumping, pivoting, kneeling, landing.

use glam::Vec2;
use rand::RngExt;

use super::body::RandomPerson;
use super::thing::{STAND_ROLL, SceneObject, Sole, pair};
use crate::sway::Sway;
use crate::track::forward;
use underfoot::floor::Rect;

/// Two feet of a standing, swaying person near the centre of the floor; left foot first, without force yet.
pub(super) fn two_feet(body: &mut RandomPerson, bounds: Rect, width_m: f32) -> [SceneObject; 2] {
    let middle = body.place(bounds, 0.5);
    let facing = body.angle();
    let turn_out = body.habit.turn_out();
    let mut sway = Sway::new(body.rng.random());
    sway.strength.rest(0.0, 1.0);
    let mut share = -1.0;
    pair(middle, facing, width_m, turn_out).map(|(at, heading)| {
        let mut foot = SceneObject::foot(body, at, heading);
        share = -share;
        foot.sway = Some((sway.clone(), share));
        foot
    })
}

/// Moves the load of both feet to shares of the weight; the feet reach them at `at_s`.
fn share_weight(feet: &mut [SceneObject; 2], at_s: f64, weight_n: f32, right: f32) {
    feet[0].presses(at_s, weight_n * (1.0 - right));
    feet[1].presses(at_s, weight_n * right);
}

/// The person steps onto the floor, one foot after the other, and stands on both after a second.
pub(super) fn step_on(body: &mut RandomPerson, feet: &mut [SceneObject; 2], weight_n: f32) {
    let first = if body.sign() > 0.0 { 0.0 } else { 1.0 };
    share_weight(feet, 0.1, 0.0, 0.5);
    share_weight(feet, 0.35, weight_n, first);
    share_weight(feet, 0.7, weight_n, first);
    share_weight(feet, 0.95, weight_n, 0.5);
}

/// One foot unloads to 10 to 20 %, in 0.2 or 1.2 s, and takes the weight back; twice.
pub(super) fn shifting(body: &mut RandomPerson, bounds: Rect) -> Vec<SceneObject> {
    let (weight, width) = (body.weight_n(), body.within(0.14, 0.30));
    let mut feet = two_feet(body, bounds, width);
    step_on(body, &mut feet, weight);
    let mut now = 2.0;
    for _ in 0..2 {
        let change = if body.sign() > 0.0 { 0.2 } else { 1.2 };
        let low = body.within(0.10, 0.20);
        let right = if body.sign() > 0.0 { low } else { 1.0 - low };
        let hold = f64::from(body.within(0.3, 3.0));
        share_weight(&mut feet, now, weight, 0.5);
        share_weight(&mut feet, now + change, weight, right);
        share_weight(&mut feet, now + change + hold, weight, right);
        now += 2.0 * change + hold;
        share_weight(&mut feet, now, weight, 0.5);
        now += f64::from(body.within(0.5, 1.5));
    }
    share_weight(&mut feet, now, weight, 0.5);
    share_weight(&mut feet, now + 0.3, 0.0, 0.5);
    feet.into()
}

/// Three jumps, each to a place a few centimetres away.
///
/// # Source
/// Our assumption of a hopping person: a push of a quarter of a second with 1.6 to 2.2 body weights, 0.30 to 0.45 s
/// in the air (11 to 25 cm high), a landing with 1.8 to 3 body weights within 60 ms.
pub(super) fn jumping(body: &mut RandomPerson, bounds: Rect) -> Vec<SceneObject> {
    let (weight, width) = (body.weight_n(), body.within(0.16, 0.35));
    let mut stand = two_feet(body, bounds, width);
    step_on(body, &mut stand, weight);
    let mut done: Vec<SceneObject> = Vec::new();
    let mut now = 1.5 + f64::from(body.within(0.0, 0.5));
    for _ in 0..3 {
        let right = 0.5 + 0.04 * body.normal().clamp(-2.0, 2.0);
        let push = body.within(1.6, 2.2);
        let flight = f64::from(body.within(0.30, 0.45));
        let landing = body.within(1.8, 3.0);
        share_weight(&mut stand, now, weight, 0.5);
        share_weight(&mut stand, now + 0.2, weight * 0.7, 0.5);
        share_weight(&mut stand, now + 0.45, weight * push, 0.5);
        share_weight(&mut stand, now + 0.55, 0.0, 0.5);
        let off = now + 0.55;
        let hop = Vec2::from_angle(body.angle()) * body.within(0.0, 0.12);
        let mut next = stand.clone();
        for foot in &mut stand {
            foot.roll.rest(now, STAND_ROLL);
            foot.roll.rest(now + 0.45, 0.75);
            foot.roll.rest(off, 0.95);
        }
        let down = off + flight;
        for (foot, late) in next.iter_mut().zip([0.0, f64::from(body.within(0.0, 0.015))]) {
            let (x, y, heading) = (foot.x.at(off), foot.y.at(off), foot.heading.at(off));
            let mut landed = SceneObject::foot(body, Vec2::new(x, y) + hop, heading);
            landed.sway.clone_from(&foot.sway);
            landed.roll.rest(down, 0.75);
            landed.roll.rest(down + 0.25, STAND_ROLL);
            landed.presses(down + late, 0.0);
            *foot = landed;
        }
        share_weight(&mut next, down + 0.06, weight * landing, right);
        share_weight(&mut next, down + 0.25, weight * 0.8, right);
        share_weight(&mut next, down + 0.5, weight, 0.5);
        done.extend(std::mem::replace(&mut stand, next));
        now = down + 0.6 + f64::from(body.within(0.2, 0.8));
    }
    share_weight(&mut stand, now, weight, 0.5);
    share_weight(&mut stand, now + 0.3, 0.0, 0.5);
    done.extend(stand);
    done
}

/// Turns on one heel by 30 to 110 degrees, with the other foot lifted and put down afterwards; there and back.
pub(super) fn heel_pivot(body: &mut RandomPerson, bounds: Rect) -> Vec<SceneObject> {
    let (weight, width) = (body.weight_n(), body.person().stand_width_m);
    let mut feet = two_feet(body, bounds, width);
    step_on(body, &mut feet, weight);
    if body.sign() > 0.0 {
        feet.swap(0, 1);
    }
    let [mut pivot, mut other] = feet;
    let heel = -0.33 * body.person().foot_length_m;
    let mut things = Vec::new();
    let mut now = 1.5 + f64::from(body.within(0.0, 0.5));
    let turn = body.within(0.5, 1.9) * body.sign();
    for turn in [turn, -turn] {
        let took = f64::from(body.within(0.4, 1.0));
        let (begin, end) = (now + 0.35, now + 0.35 + took);
        pivot.presses(now, 0.5 * weight).presses(begin, weight).presses(end, weight);
        other.presses(now, 0.5 * weight).presses(begin, 0.0);
        pivot.stays(now);
        pivot.roll.rest(begin, 0.05);
        pivot.roll.rest(end, 0.05);
        pivot.roll.rest(end + 0.4, STAND_ROLL);
        // About the heel: the foot's centre moves around it in small parts of the turn.
        let (at, heading) = (Vec2::new(pivot.x.at(now), pivot.y.at(now)), pivot.heading.at(now));
        let about = at + forward(heading) * heel;
        pivot.stays(begin);
        for part in 1..=24_u8 {
            let share = f32::from(part) / 24.0;
            let eased = share * share * (3.0 - 2.0 * share);
            let per_s = 6.0 * share * (1.0 - share) / took as f32;
            let heading = heading + turn * eased;
            let at = about - forward(heading) * heel;
            let sideways = forward(heading).perp() * (-heel * turn * per_s);
            let moment = begin + took * f64::from(share);
            pivot.x.pass(moment, at.x, sideways.x);
            pivot.y.pass(moment, at.y, sideways.y);
            pivot.heading.pass(moment, heading, turn * per_s);
        }
        // The other foot lands beside it, turned by the same angle.
        let was = Vec2::new(other.x.at(now), other.y.at(now));
        let placed = about + Vec2::from_angle(turn).rotate(was - about);
        let mut next = SceneObject::foot(body, placed, other.heading.at(now) + turn);
        next.sway.clone_from(&other.sway);
        let down = end + 0.1;
        next.presses(down, 0.0).presses(down + 0.4, 0.5 * weight);
        pivot.presses(down, weight).presses(down + 0.4, 0.5 * weight);
        things.push(std::mem::replace(&mut other, next));
        now = down + 0.4 + f64::from(body.within(0.5, 1.2));
    }
    for foot in [&mut pivot, &mut other] {
        foot.presses(now, 0.5 * weight).presses(now + 0.3, 0.0);
    }
    things.extend([pivot, other]);
    things
}

/// Kneels on one knee or both, and gets up: knees of 6 x 8 cm, the toes behind them.
///
/// # Source
/// Our assumption of the load distribution: on one knee, half of the weight stays on the front foot; on both, three
/// quarters rest on the knees.
pub(super) fn kneeling(body: &mut RandomPerson, bounds: Rect) -> Vec<SceneObject> {
    let (weight, width) = (body.weight_n(), body.within(0.16, 0.26));
    let size = body.person().foot_length_m / 0.26;
    let mut feet = two_feet(body, bounds, width);
    let knee = |body: &mut RandomPerson, foot: &SceneObject| {
        let (at, heading) = (Vec2::new(foot.x.at(0.0), foot.y.at(0.0)), foot.heading.at(0.0));
        // Lower leg and foot bent up on the toes: 0.35 m from toes to knee.
        let knee = at + forward(heading) * (0.12 * size) + Vec2::from_angle(body.angle()) * 0.01;
        let toes = at - forward(heading) * (0.23 * size);
        let round = |half_m: Vec2| Sole::Round { half_m: half_m * size };
        (
            SceneObject::at(round(Vec2::new(0.03, 0.04)), knee, heading),
            SceneObject::at(round(Vec2::new(0.035, 0.02)), toes, heading),
        )
    };
    let (mut left, mut right) = (knee(body, &feet[0]), knee(body, &feet[1]));
    let hold = f64::from(body.within(1.5, 4.0));
    let both = body.sign() > 0.0;
    step_on(body, &mut feet, weight);
    // The right foot unloads, its toes land behind it and its knee in front of them.
    share_weight(&mut feet, 1.35, weight, 0.0);
    right.1.presses(1.7, 0.0).presses(2.0, 0.25 * weight).presses(2.3, 0.25 * weight);
    feet[0].presses(1.7, weight).presses(2.0, 0.75 * weight).presses(2.3, 0.75 * weight);
    right.0.presses(2.3, 0.0).presses(2.6, 0.35 * weight);
    right.1.presses(2.6, 0.15 * weight);
    feet[0].presses(2.6, 0.5 * weight);
    let mut now = 2.6 + hold;
    let hold_all = |things: &mut [(&mut SceneObject, f32)], from: f64, to: f64| {
        for (thing, share) in things {
            thing.presses(from, *share * weight).presses(to, *share * weight);
        }
    };
    if both {
        // The left foot follows: lifted, toes, knee.
        let lift = 2.6 + 0.5;
        feet[0].presses(lift, 0.5 * weight).presses(lift + 0.4, 0.0);
        hold_all(&mut [(&mut right.0, 0.35), (&mut right.1, 0.15)], lift, lift);
        right.0.presses(lift + 0.4, 0.7 * weight);
        right.1.presses(lift + 0.4, 0.3 * weight);
        left.1.presses(lift + 0.6, 0.0).presses(lift + 0.9, 0.125 * weight);
        left.0.presses(lift + 0.6, 0.0).presses(lift + 0.9, 0.375 * weight);
        right.0.presses(lift + 0.6, 0.7 * weight).presses(lift + 0.9, 0.375 * weight);
        right.1.presses(lift + 0.6, 0.3 * weight).presses(lift + 0.9, 0.125 * weight);
        now = lift + 0.9 + hold;
        hold_all(
            &mut [(&mut right.0, 0.375), (&mut right.1, 0.125), (&mut left.0, 0.375), (&mut left.1, 0.125)],
            now,
            now,
        );
    } else {
        hold_all(&mut [(&mut right.0, 0.35), (&mut right.1, 0.15), (&mut feet[0], 0.5)], now, now);
    }
    // Gets up and off the floor at once: everything lifts within 0.5 s.
    let [first, second] = feet;
    let mut things = vec![first, second, left.0, left.1, right.0, right.1];
    for thing in &mut things {
        thing.presses(now + 0.5, 0.0);
    }
    things
}

/// Two feet land within 20 ms of each other, 12 to 40 cm apart, stand for three seconds and leave.
pub(super) fn landing(body: &mut RandomPerson, bounds: Rect) -> Vec<SceneObject> {
    let (weight, width) = (body.weight_n(), body.within(0.12, 0.40));
    let mut feet = two_feet(body, bounds, width);
    let right = (0.5 + 0.03 * body.normal()).clamp(0.3, 0.7);
    let hop = body.within(1.0, 2.0);
    let lean = if body.sign() > 0.0 { 0.2 } else { -0.15 } * body.within(0.0, 1.0);
    for (foot, share) in feet.iter_mut().zip([1.0 - right, right]) {
        let begin = 0.1 + f64::from(body.within(0.0, 0.02));
        let peak = begin + f64::from(body.within(0.03, 0.12));
        foot.roll.rest(begin, STAND_ROLL + lean);
        foot.roll.rest(begin + 0.25, STAND_ROLL);
        foot.presses(begin, 0.0).presses(peak, weight * share * hop);
        foot.presses(0.45, weight * share).presses(3.15, weight * share).presses(3.3, 0.0);
    }
    feet.into()
}
