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
        self.age > FLAT_S && self.still_s > STILL_S
    }

    /// Whether it is flat on the floor and hardly rolls: only another foot can move its centre of pressure far.
    pub(super) fn is_slow(&self) -> bool {
        self.stands() || self.age > FLAT_S && self.mean_speed < SLOW_M_S
    }

    /// Keeps it standing still at `rest_point`.
    pub(super) fn hold_at(&mut self, rest_point: DVec2) {
        self.rest_point = rest_point;
        self.sway_m = SWAY_LEAST_M;
        self.mean_speed = SHARED_SPEED_M_S;
    }

    /// Updates the foot's peak force, mean speed, rest point and travel.
    pub(super) fn roll(&mut self, elapsed: &Elapsed) {
        let dt = elapsed.dt;
        let centre = self.centre();
        self.peak = self.peak.max(self.force());
        let rolls = !self.shared || self.age < FLAT_S && !self.landed_together;
        let speed = if rolls { self.velocity().length().min(1.0) } else { SHARED_SPEED_M_S };
        // Weight that shifts to another foot moves the centre of pressure for a short time; the limit excludes that
        // motion.
        let change = (1.0 - elapsed.mean_speed) * (speed - self.mean_speed);
        self.mean_speed += change.min(SPEED_RISE_M_S2 * dt);
        if rolls {
            self.sway_m = (SWAY_LEAST_M + SWAY_PER_SPEED_S * self.mean_speed).min(SWAY_MOST_M);
        }
        self.rest(elapsed, rolls);
        if self.age < 0.01 {
            self.landed = centre;
        }
        self.travel = self.travel.max(centre.distance(self.landed));
        self.stand_still(dt);
    }

    /// Measures the time for which its centre of pressure has stayed in one place.
    fn stand_still(&mut self, dt: f64) {
        if self.partner_s <= dt && self.partner_s < PARTNER_S {
            // Standing on two feet begins a new stance.
            (self.anchor, self.anchored_s, self.astray_s) = (self.centre(), 0.0, 0.0);
            return;
        }
        let offset = self.centre() - self.anchor;
        if offset.length() < ANCHOR_M {
            self.anchored_s += dt;
            self.astray_s = 0.0;
            self.anchor += offset * (dt / ANCHOR_S).min(1.0);
        } else {
            self.astray_s += dt;
            if self.anchored_s < STANDS_S || self.astray_s > ASTRAY_S {
                (self.anchor, self.anchored_s, self.astray_s) = (self.centre(), 0.0, 0.0);
            }
        }
    }

    /// Updates the rest point, and the times of standing still and of moving.
    fn rest(&mut self, elapsed: &Elapsed, rolls: bool) {
        let (centre, dt) = (self.centre(), elapsed.dt);
        if self.shared {
            (self.still_s, self.away_s) = (0.0, 0.0);
            let soon = if rolls { 1.0 } else { 1.0 - elapsed.rest_point };
            self.rest_point += (centre - self.rest_point) * soon;
        } else if self.velocity().length() < STILL_M_S {
            self.still_s += dt;
            self.away_s = 0.0;
            self.rest_point += (centre - self.rest_point) * (1.0 - elapsed.still_rest_point);
        } else {
            self.away_s += dt;
            if self.away_s > AWAY_S {
                self.still_s = 0.0;
                self.rest_point = centre;
            }
        }
    }
}
