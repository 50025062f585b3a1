//! Scenes of one foot that operates a control, alone or beside a standing foot.

use std::f32::consts::PI;

use glam::Vec2;
use rand::RngExt;

use super::body::RandomPerson;
use super::thing::{STAND_ROLL, SceneObject};
use crate::sway::Sway;
use crate::track::forward;
use underfoot::floor::Rect;

/// One foot that lands on a control and rests on it, perhaps beside a standing one.
struct Work {
    foot: SceneObject,
    stands: Option<SceneObject>,
    /// Force of the working foot at rest (N).
    rests_n: f32,
    /// Start of the work (s).
    begin: f64,
}

impl Work {
    /// Lands, and rests for up to 1.5 s; `way` is the direction of the later slide, if any.
    fn of(body: &mut RandomPerson, bounds: Rect, way: Option<f32>) -> Self {
        let beside = body.rng.random_bool(0.5);
        let weight = body.weight_n();
        let rests_n = body.within(80.0, 250.0).min(0.4 * weight);
        let rest = [0.0, 0.1, 0.3, 0.6, 1.5][body.rng.random_range(0..5_usize)];
        let at = body.place(bounds, 0.65);
        let heading = body.angle();
        let mut foot = SceneObject::foot(body, at, heading);
        let landing = if beside { 1.3 } else { 0.3 };
        foot.presses(landing, 0.0).presses(landing + 0.12, rests_n);
        let stands = beside.then(|| {
            let out = match way {
                Some(way) => way + PI + body.within(-0.6, 0.6),
                None => body.angle(),
            };
            let aside = at + Vec2::from_angle(out) * body.within(0.3, 0.55);
            let turned = heading + body.within(-0.3, 0.3);
            let mut stands = SceneObject::foot(body, aside, turned);
            let mut sway = Sway::new(body.rng.random());
            sway.strength.rest(0.0, 1.0);
            stands.sway = Some((sway, 1.0));
            stands.presses(0.05, 0.0).presses(0.3, weight).presses(landing, weight);
            stands.presses(landing + 0.12, weight - rests_n);
            stands
        });
        Self { foot, stands, rests_n, begin: landing + 0.12 + rest }
    }

    /// Adds `more_n` to the resting force at `at_s`; the standing foot carries less.
    fn presses(&mut self, at_s: f64, more_n: f32, weight_n: f32) {
        self.foot.presses(at_s, self.rests_n + more_n);
        if let Some(stands) = &mut self.stands {
            stands.presses(at_s, weight_n - self.rests_n - more_n);
        }
    }

    /// Rests again after the work ended at `at_s`, and leaves.
    fn leave(mut self, body: &mut RandomPerson, at_s: f64) -> Vec<SceneObject> {
        let weight = body.weight_n();
        let off = at_s + f64::from(body.within(0.2, 0.8));
        self.presses(at_s, 0.0, weight);
        self.presses(off, 0.0, weight);
        self.foot.presses(off + 0.15, 0.0);
        if let Some(stands) = &mut self.stands {
            stands.presses(off + 0.15, weight).presses(off + 0.75, weight).presses(off + 1.0, 0.0);
        }
        std::iter::once(self.foot).chain(self.stands).collect()
    }
}

/// Slides 10 to 60 cm at 0.1 to 1 m/s, rests there and slides back.
pub(super) fn slide(body: &mut RandomPerson, bounds: Rect) -> Vec<SceneObject> {
    let way = body.angle();
    let mut work = Work::of(body, bounds, Some(way));
    let start = Vec2::new(work.foot.x.at(0.0), work.foot.y.at(0.0));
    // Limited to the floor.
    let inner = bounds.grown(-0.15);
    let goal = (start + Vec2::from_angle(way) * body.within(0.1, 0.6)).clamp(inner.min, inner.max);
    let speed = [0.1, 0.2, 0.35, 0.6, 1.0][body.rng.random_range(0..5_usize)];
    // The peak speed of a smooth ramp is 1.5 times its mean speed.
    let took = f64::from((1.5 * start.distance(goal) / speed).max(0.1));
    let again = f64::from(body.within(0.2, 0.8));
    let mut now = work.begin;
    work.foot.goes(now, start).goes(now + took, goal).goes(now + took + again, goal);
    now += 2.0 * took + again;
    work.foot.goes(now, start);
    work.leave(body, now)
}

/// Presses three times with 50 to 250 N more, within 0.1 to 0.4 s, and leans a little.
pub(super) fn press(body: &mut RandomPerson, bounds: Rect) -> Vec<SceneObject> {
    let mut work = Work::of(body, bounds, None);
    let weight = body.weight_n();
    let more = body.within(50.0, 250.0).min(0.45 * weight);
    let lean = body.within(-0.2, 0.2);
    let mut now = work.begin;
    for _ in 0..3 {
        let took = f64::from(body.within(0.1, 0.4));
        for (moment, pressing) in [(0.0, 0.0), (took, 1.0), (took + 0.15, 1.0), (2.0 * took + 0.15, 0.0)] {
            work.presses(now + moment, more * pressing, weight);
            work.foot.roll.rest(now + moment, STAND_ROLL + lean * pressing);
        }
        now += 2.0 * took + 0.3;
    }
    work.leave(body, now)
}

/// Rocks three times from heel to ball and back within 0.25 to 0.9 s, without lifting.
pub(super) fn rock(body: &mut RandomPerson, bounds: Rect) -> Vec<SceneObject> {
    let mut work = Work::of(body, bounds, None);
    let mut now = work.begin;
    work.foot.roll.rest(now, STAND_ROLL);
    for _ in 0..3 {
        let took = f64::from(body.within(0.25, 0.9));
        for (moment, roll) in [(took, 0.75), (took + 0.15, 0.75), (2.0 * took + 0.15, 0.08)] {
            work.foot.roll.rest(now + moment, roll);
        }
        now += 2.0 * took + 0.3;
        work.foot.roll.rest(now, 0.08);
    }
    work.foot.roll.rest(now + 0.2, STAND_ROLL);
    work.leave(body, now + 0.2)
}

/// Turns by 20 to 60 degrees about heel or ball within 0.3 to 1 s, and back.
pub(super) fn turn(body: &mut RandomPerson, bounds: Rect) -> Vec<SceneObject> {
    let mut work = Work::of(body, bounds, None);
    let length = body.person().foot_length_m;
    let about = length * if body.rng.random_bool(0.5) { -0.25 } else { 0.25 };
    let angle = body.within(0.35, 1.05) * body.sign();
    let (at, heading) = (Vec2::new(work.foot.x.at(0.0), work.foot.y.at(0.0)), work.foot.heading.at(0.0));
    let pivot = at + forward(heading) * about;
    let took = f64::from(body.within(0.3, 1.0));
    let mut now = work.begin;
    work.foot.stays(now);
    for (from, to) in [(0.0, angle), (angle, 0.0)] {
        for part in 1..=24_u8 {
            let share = f32::from(part) / 24.0;
            let eased = share * share * (3.0 - 2.0 * share);
            let per_s = 6.0 * share * (1.0 - share) * (to - from) / took as f32;
            let heading = heading + from + (to - from) * eased;
            let at = pivot - forward(heading) * about;
            let sideways = forward(heading).perp() * (-about * per_s);
            let moment = now + took * f64::from(share);
            work.foot.x.pass(moment, at.x, sideways.x);
            work.foot.y.pass(moment, at.y, sideways.y);
            work.foot.heading.pass(moment, heading, per_s);
        }
        now += took + 0.15;
        work.foot.stays(now);
    }
    work.leave(body, now)
}
