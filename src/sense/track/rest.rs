//! Where a foot rests, and whether it stands still, lingers or rolls.

use glam::DVec2;

use super::foot::{FLAT_S, Foot, SLIDING_N};

/// How far the centre of pressure of a foot that stands still strays, and that of one that rolls
/// while another one lands, in metres.
pub(super) const STRAY_LEAST_M: f64 = 0.01;
pub(super) const STRAY_MOST_M: f64 = 0.06;

/// How far it strays per speed, in seconds: as long as two feet are down while one walks.
const STRAY_S: f64 = 0.15;

/// How soon a foot that shares tiles has another home, in seconds.
const HOME_S: f64 = 1.0;

/// How soon one that stands still alone has.
const STILL_HOME_S: f64 = 0.03;

/// How fast the centre of pressure of a foot that shares tiles is expected to move, in metres per second.
const RESTLESS_M_S: f64 = 0.03;

/// Mean speed of its centre of pressure below which a foot hardly rolls, in metres per second.
const LINGERS_M_S: f64 = 0.15;

/// How soon a foot that stood still is taken to roll, in metres per second squared.
const ROUSED_M_S2: f64 = 0.2;

/// Speed of its centre of pressure below which a foot stands still, in metres per second.
const STILL_M_S: f64 = 0.12;

/// How long it must have done so, and how long it may then move before it rolls, in seconds.
const STILL_S: f64 = 0.08;
const AWAY_S: f64 = 0.15;

/// Speed that the centre of pressure of one foot does not have while it bears its weight, in metres per second, and the
/// share of the most it has pressed with from which on it does so (a recorded walk, played up to a third faster,
/// stayed below 0.7 m/s).
const RUSHED_M_S: f64 = 0.8;
const BEARS: f64 = 0.7;

/// How long at most weight is taken over by a partner that lands, in seconds.
const DRAWN_S: f64 = 0.6;

impl Foot {
    /// Whether it stands still alone, or has only just begun to move.
    pub(super) fn stands(&self) -> bool {
        self.age > FLAT_S && self.still > STILL_S
    }

    /// Whether its centre of pressure moves as that of no foot does that bears its weight: weight goes over to another.
    pub(super) fn is_rushed(&self) -> bool {
        self.age > FLAT_S
            && self.force() > SLIDING_N.max(BEARS * self.peak)
            && self.velocity().length() > RUSHED_M_S
    }

    /// Whether it is down flat and hardly rolls: what draws its centre of pressure far is somebody else's.
    pub(super) fn lingers(&self) -> bool {
        self.stands() || self.age > FLAT_S && self.restless < LINGERS_M_S
    }

    /// Goes on standing still at `home`.
    pub(super) fn stay(&mut self, home: DVec2) {
        self.home = home;
        self.stray = STRAY_LEAST_M;
        self.restless = RESTLESS_M_S;
    }

    /// Remembers where the foot has been.
    pub(super) fn roll(&mut self, dt: f64) {
        let (centre, foretold) = (self.centre(), self.past.centre);
        self.peak = self.peak.max(self.force());
        let rolls = !self.shared || self.age < FLAT_S;
        let speed = if rolls { self.velocity().length().min(1.0) } else { RESTLESS_M_S };
        // Weight that goes over to another foot draws it along for a moment: that is not its own.
        let change = (1.0 - (-dt / 0.25).exp()) * (speed - self.restless);
        self.restless += change.min(ROUSED_M_S2 * dt);
        if rolls {
            self.stray = (STRAY_LEAST_M + STRAY_S * self.restless).min(STRAY_MOST_M);
        }
        self.rest(dt, rolls);
        if self.age < 0.01 {
            self.landed = centre;
            self.farthest = centre;
        } else if foretold.distance_squared(self.landed) > self.farthest.distance_squared(self.landed) {
            self.farthest = foretold;
        }
    }

    /// Notes where the foot rests, and for how long it has stood still or been on the move.
    fn rest(&mut self, dt: f64, rolls: bool) {
        let centre = self.centre();
        let drift = |time_s: f64| 1.0 - (-dt / time_s).exp();
        if self.shared {
            (self.still, self.away) = (0.0, 0.0);
            let soon = if rolls { 1.0 } else { drift(HOME_S) };
            self.home += (centre - self.home) * soon;
        } else if self.velocity().length() < STILL_M_S {
            self.still += dt;
            self.away = 0.0;
            self.home += (centre - self.home) * drift(STILL_HOME_S);
        } else {
            self.away += dt;
            let rolls = self.away > AWAY_S && !self.is_drawn(centre - self.home, 0.0);
            if rolls || self.away > DRAWN_S {
                self.still = 0.0;
                if !self.is_rushed() {
                    self.home = centre;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::foot::{EAST, NORTH};
    use super::*;
    use crate::sense::contact::ContactId;

    #[test]
    fn a_newcomer_that_draws_a_rolling_foots_centre_along_stays_beyond_it() {
        // It has rolled 8 cm north.
        let mut foot = Foot::new(ContactId(1), 700.0, DVec2::ZERO, 0.01);
        foot.age = 0.5;
        foot.past.centre = DVec2::new(0.0, 0.08);
        foot.farthest = foot.past.centre;
        // A centimetre farther than a foot presses to the side of its roll, and around where it presses.
        for newcomer in [DVec2::new(0.12, 0.08), DVec2::new(0.0, 0.26)] {
            let drawn = foot.past.centre + 0.25 * (newcomer - foot.past.centre);
            (foot.state[EAST], foot.state[NORTH]) = (drawn.x, drawn.y);
            foot.roll(0.001);
            assert!((foot.beyond(newcomer) - 0.01).abs() < 1e-9, "{newcomer}: {}", foot.beyond(newcomer));
        }
    }
}
