//! The rest point of a foot, and whether it stands still, is slow or rolls.

use super::params::state::{FLAT_S, PARTNER_S};
use super::params::stillness::{
    ANCHOR_M, ANCHOR_S, ASTRAY_S, AWAY_S, SHARED_SPEED_M_S, SLOW_M_S, SPEED_RISE_M_S2, STANDS_S, STILL_M_S,
    STILL_S, SWAY_LEAST_M, SWAY_MOST_M, SWAY_PER_SPEED_S,
};
use glam::DVec2;

use super::elapsed::Elapsed;
use super::state::Track;

impl Track {
    /// Whether it stands still alone, or has only just begun to move.
    pub(super) fn stands(&self) -> bool {
        self.age > FLAT_S && self.stillness.still_s > STILL_S
    }

    /// Whether it is flat on the floor and hardly rolls: only another foot can move its centre of pressure far.
    pub(super) fn is_slow(&self) -> bool {
        self.stands() || self.age > FLAT_S && self.stillness.mean_speed < SLOW_M_S
    }

    /// Keeps it standing still at `rest_point`.
    pub(super) fn hold_at(&mut self, rest_point: DVec2) {
        self.stillness.rest_point = rest_point;
        self.stillness.sway_m = SWAY_LEAST_M;
        self.stillness.mean_speed = SHARED_SPEED_M_S;
    }

    /// Updates the foot's peak force, mean speed, rest point and travel.
    pub(super) fn roll(&mut self, elapsed: &Elapsed) {
        let dt = elapsed.dt;
        let centre = self.centre();
        self.step.peak = self.step.peak.max(self.force());
        let rolls = !self.company.shared || self.age < FLAT_S && !self.company.landed_together;
        let speed = if rolls { self.velocity().length().min(1.0) } else { SHARED_SPEED_M_S };
        // Weight that shifts to another foot moves the centre of pressure for a short time; the limit excludes that
        // motion.
        let change = (1.0 - elapsed.mean_speed) * (speed - self.stillness.mean_speed);
        self.stillness.mean_speed += change.min(SPEED_RISE_M_S2 * dt);
        if rolls {
            self.stillness.sway_m =
                (SWAY_LEAST_M + SWAY_PER_SPEED_S * self.stillness.mean_speed).min(SWAY_MOST_M);
        }
        self.rest(elapsed, rolls);
        if self.age < 0.01 {
            self.step.landed = centre;
        }
        self.step.travel = self.step.travel.max(centre.distance(self.step.landed));
        self.stand_still(dt);
    }

    /// Measures the time for which its centre of pressure has stayed in one place.
    fn stand_still(&mut self, dt: f64) {
        if self.company.partner_s <= dt && self.company.partner_s < PARTNER_S {
            // Standing on two feet begins a new stance.
            (self.stillness.anchor, self.stillness.anchored_s, self.stillness.astray_s) =
                (self.centre(), 0.0, 0.0);
            return;
        }
        let offset = self.centre() - self.stillness.anchor;
        if offset.length() < ANCHOR_M {
            self.stillness.anchored_s += dt;
            self.stillness.astray_s = 0.0;
            self.stillness.anchor += offset * (dt / ANCHOR_S).min(1.0);
        } else {
            self.stillness.astray_s += dt;
            if self.stillness.anchored_s < STANDS_S || self.stillness.astray_s > ASTRAY_S {
                (self.stillness.anchor, self.stillness.anchored_s, self.stillness.astray_s) =
                    (self.centre(), 0.0, 0.0);
            }
        }
    }

    /// Updates the rest point, and the times of standing still and of moving.
    fn rest(&mut self, elapsed: &Elapsed, rolls: bool) {
        let (centre, dt) = (self.centre(), elapsed.dt);
        if self.company.shared {
            (self.stillness.still_s, self.stillness.away_s) = (0.0, 0.0);
            let soon = if rolls { 1.0 } else { 1.0 - elapsed.rest_point };
            self.stillness.rest_point += (centre - self.stillness.rest_point) * soon;
        } else if self.velocity().length() < STILL_M_S {
            self.stillness.still_s += dt;
            self.stillness.away_s = 0.0;
            self.stillness.rest_point +=
                (centre - self.stillness.rest_point) * (1.0 - elapsed.still_rest_point);
        } else {
            self.stillness.away_s += dt;
            if self.stillness.away_s > AWAY_S {
                self.stillness.still_s = 0.0;
                self.stillness.rest_point = centre;
            }
        }
    }
}
