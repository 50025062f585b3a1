//! Walking: load and roll of each foot, step by step.

use glam::Vec2;

use super::{Performance, SHIFT_S, SHORTEST_WAY_M, STAND_ROLL};
use crate::curve::Curve;
use crate::gait::Gait;
use crate::person::{MoveError, SIDES};
use crate::rolling::Rolling;
use crate::track::{FootTrack, Profile, forward};
use crate::way::Polyline;

impl Performance {
    /// Walks along a path without sharp bends.
    pub(super) fn walk_stretch(&mut self, points: &[Vec2]) -> Result<(), MoveError> {
        let way = Polyline::new(points);
        if way.length < SHORTEST_WAY_M {
            return Ok(());
        }
        self.turn(way.at(0.0).1)?;
        self.leave_standing();

        let usual = Gait::at_speed(self.person.speed_m_s);
        let steps = (way.length / usual.step_m).round().max(1.0) as usize;
        // The step length is adjusted so that a whole number of steps fits; the rhythm stays the same.
        let step_m = way.length / steps as f32;
        let mut gait = Gait::with_step(step_m, usual.speed_m_s * step_m / usual.step_m);
        if let Some(habit) = &self.habit {
            // Stances overlap by at least 6 % of a step, and a swing lasts at least half a step.
            let contact_s = habit.contact_s(gait.speed_m_s);
            gait.stance_s = contact_s.clamp(1.06 * gait.step_s, 1.5 * gait.step_s);
        }
        let step_s = f64::from(gait.step_s);
        let first_lift = self.now_s + SHIFT_S;
        let first_landing = first_lift + f64::from(gait.swing_s());
        let landing = |step: usize| first_landing + step_s * (step as f64 - 1.0);
        // The right foot moves first; the left one starts as the stance foot.
        let side_of = |step: usize| step % 2;
        self.shift_weight(1, 0.5, 0.0);
        self.push_off(0, landing(1) + f64::from(gait.double_support_s()), &gait);

        for step in 1..=steps {
            let (middle, heading) = way.at(way.length * step as f32 / steps as f32);
            let side = side_of(step);
            let lift =
                if step == 1 { first_lift } else { landing(step - 1) + f64::from(gait.double_support_s()) };
            let pose = self.person.foot_beside(middle, heading, side, self.person.step_width_m);
            self.tracks[side].roll.hold(lift);
            self.tracks[side].go(lift, landing(step), pose, Profile::Swing);
            if step < steps {
                self.stride(side, landing(step), &gait);
            } else {
                self.arrive(side, landing(step), &gait);
            }
        }
        // The last foot moves beside the one that has arrived.
        let (middle, heading) = way.at(way.length);
        let side = side_of(steps + 1);
        let gathered = landing(steps + 1);
        let lift = landing(steps) + f64::from(gait.double_support_s());
        let wider = 0.5 * (self.person.stand_width_m - self.person.step_width_m);
        let to_right = -forward(heading).perp();
        let standing = self.person.standing(middle + to_right * (wider * SIDES[side]), heading);
        self.tracks[side].go(lift, gathered, standing.feet[side], Profile::Swing);
        self.tracks[side].roll.hold(lift);
        self.tracks[side].roll.rest(gathered, 0.2);
        self.tracks[side].roll.rest(gathered + SHIFT_S, STAND_ROLL);
        self.now_s = gathered;
        self.shift_weight(side, 0.0, 0.5);
        self.resume_standing(standing);
        Ok(())
    }

    /// Returns the step that a foot begins at a moment; `None` for a person who rolls evenly.
    fn next_step(&mut self, side: usize, at_s: f64, gait: &Gait) -> Option<Rolling> {
        let step = self.habit.as_mut()?.step(gait.speed_m_s, self.person.foot_length_m, SIDES[side]);
        self.tracks[side].steps.push((at_s, step.clone()));
        Some(step)
    }

    /// Load and roll of a foot from touchdown to lift-off, in the middle of a walk.
    fn stride(&mut self, side: usize, landing: f64, gait: &Gait) {
        let step = self.next_step(side, landing, gait);
        let stance_s = f64::from(gait.stance_s);
        let at = |share: f32| landing + stance_s * f64::from(share);
        let slope = gait.strike / gait.stance_s;
        let FootTrack { load, roll, stepping, .. } = &mut self.tracks[side];
        load.rest(landing, 0.0);
        if let Some(step) = step {
            stepping.rest(landing, 1.0);
            let force = balanced(&step, gait);
            through(load, landing, gait.stance_s, 1.0, |phase| force * step.force(phase));
            load.rest(at(1.0), 0.0);
            roll.pass(landing, 0.0, 1.0 / gait.stance_s);
            roll.pass(at(1.0), 1.0, 1.0 / gait.stance_s);
            return;
        }
        load.pass(landing, 0.0, slope);
        load.rest(at(gait.peak_at), gait.peak);
        load.rest(at(0.5), gait.valley);
        load.rest(at(1.0 - gait.peak_at), gait.peak);
        load.pass(at(1.0), 0.0, -slope);
        load.rest(at(1.0), 0.0);
        roll.pass(landing, 0.0, 1.0 / gait.stance_s);
        roll.pass(at(1.0), 1.0, 1.0 / gait.stance_s);
    }

    /// Load of a foot from touchdown to standing on it alone, at the end of a walk.
    fn arrive(&mut self, side: usize, landing: f64, gait: &Gait) {
        let step = self.next_step(side, landing, gait);
        let FootTrack { load, roll, stepping, .. } = &mut self.tracks[side];
        load.rest(landing, 0.0);
        if let Some(step) = step {
            // Rolls as in a step until the foot stands.
            stepping.rest(landing, 1.0);
            stepping.rest(landing + f64::from(0.15 * gait.stance_s), 1.0);
            stepping.rest(landing + f64::from(0.5 * gait.stance_s), 0.0);
            let force = balanced(&step, gait);
            through(load, landing, gait.stance_s, 0.5, |phase| {
                let stands = ((phase - 0.15) / 0.35).clamp(0.0, 1.0);
                let stands = stands * stands * (3.0 - 2.0 * stands);
                force * step.force(phase) * (1.0 - stands) + stands
            });
        } else {
            load.pass(landing, 0.0, gait.strike / gait.stance_s);
            load.rest(landing + f64::from(gait.stance_s * gait.peak_at), gait.peak);
        }
        load.rest(landing + f64::from(gait.step_s), 1.0);
        roll.pass(landing, 0.0, 1.0 / gait.stance_s);
        roll.rest(landing + f64::from(0.5 * gait.stance_s), STAND_ROLL);
    }

    /// Load of a foot from standing on it alone, as now, to leaving the floor at `off`.
    fn push_off(&mut self, side: usize, off: f64, gait: &Gait) {
        let peak = off - f64::from(gait.stance_s * gait.peak_at);
        let now_s = self.now_s;
        let steps = self.next_step(side, now_s, gait).is_some();
        let FootTrack { load, roll, stepping, .. } = &mut self.tracks[side];
        if steps {
            stepping.rest(now_s, 0.0);
            stepping.rest(0.5 * (now_s + off), 1.0);
        }
        load.rest(peak, gait.peak);
        load.pass(off, 0.0, -gait.strike / gait.stance_s);
        load.rest(off, 0.0);
        roll.rest(self.now_s, STAND_ROLL);
        roll.pass(off, 1.0, 0.5 / gait.stance_s);
    }
}

/// Peak force, in body weights, for which steps like this one carry the body weight on average.
fn balanced(step: &Rolling, gait: &Gait) -> f32 {
    gait.step_s / (gait.stance_s * step.mean_force().max(0.2))
}

/// Appends knots of `value` from phase 0 to `end` of a stance of `stance_s` seconds.
fn through(curve: &mut Curve, landing: f64, stance_s: f32, end: f32, value: impl Fn(f32) -> f32) {
    const KNOTS: u16 = 40;
    let apart = end / f32::from(KNOTS);
    for knot in 0..=KNOTS {
        let phase = apart * f32::from(knot);
        let (before, after) = ((phase - 0.5 * apart).max(0.0), (phase + 0.5 * apart).min(end));
        let slope = (value(after) - value(before)) / ((after - before) * stance_s);
        curve.pass(landing + f64::from(phase * stance_s), value(phase), slope);
    }
}
