//! What the last few hundredths of a second foretell of a foot: what a newcomer is measured against.

use glam::DVec2;
use smallvec::SmallVec;

use super::foot::{EAST, FORCE, Foot, NORTH};

/// Time constant of the slow past, in seconds: longer than a heel takes to strike, shorter than a roll-over.
const PAST_S: f64 = 0.05;

/// Force, place and rates of a foot as its last few hundredths of a second foretell them.
#[derive(Clone, Debug, Default)]
pub(super) struct Past {
    pub force: f64,
    pub force_rate: f64,
    pub centre: DVec2,
    pub velocity: DVec2,
    /// Slow force and moment (about the tile's centre) per tile.
    pub loads: SmallVec<[SlowLoad; 12]>,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SlowLoad {
    pub index: u32,
    pub force: f64,
    pub moment: DVec2,
    pub seen: bool,
}

impl Foot {
    /// Lets the slow past learn from where the foot is now.
    pub(super) fn learn_past(&mut self, dt: f64) {
        if dt <= 0.0 {
            return;
        }
        // A critically damped alpha-beta filter: no overshoot, steady motion followed without lag.
        let keep = (-dt / PAST_S).exp();
        let (alpha, beta) = (1.0 - keep * keep, (1.0 - keep) * (1.0 - keep) / dt);
        let offset = self.centre() - self.past.centre;
        let gain = self.force() - self.past.force;
        self.past.centre += alpha * offset;
        self.past.velocity += beta * offset;
        self.past.force += alpha * gain;
        self.past.force_rate += beta * gain;
    }

    /// Takes what it presses now for its slow past: nothing of what came before is to be held against it.
    pub(super) fn start_over(&mut self) {
        self.past = Past { force: self.force(), centre: self.centre(), ..Past::default() };
    }

    /// Lets the slow load of one tile learn; `force` and `moment` are the foot's own part of it.
    pub(super) fn learn_load(&mut self, index: u32, force: f64, moment: DVec2, dt: f64, fresh: bool) {
        let weight = 1.0 - (-dt / PAST_S).exp();
        let loads = &mut self.past.loads;
        let position = loads.iter().position(|load| load.index == index).unwrap_or_else(|| {
            loads.push(SlowLoad { index, ..SlowLoad::default() });
            loads.len() - 1
        });
        let load = &mut loads[position];
        let weight = if fresh { 1.0 } else { weight };
        load.force += weight * (force - load.force);
        load.moment += weight * (moment - load.moment);
        load.seen = true;
    }

    /// Drops the slow loads that were not learnt from since the last call.
    pub(super) fn forget_loads(&mut self) {
        self.past.loads.retain(|load| std::mem::take(&mut load.seen));
    }

    /// The slow load of one tile, nothing if it had none.
    pub(super) fn slow_load(&self, index: u32) -> SlowLoad {
        self.past.loads.iter().find(|load| load.index == index).copied().unwrap_or_default()
    }

    /// Goes back to where its past foretold it: somebody else is to blame for the difference.
    pub(super) fn step_back(&mut self) {
        self.state[FORCE] = self.past.force.min(self.state[FORCE]);
        self.state[FORCE + 1] = self.past.force_rate.clamp(-2e4, 2e4);
        self.state[EAST] = self.past.centre.x;
        self.state[NORTH] = self.past.centre.y;
        self.state[EAST + 1] = self.past.velocity.x.clamp(-2.0, 2.0);
        self.state[NORTH + 1] = self.past.velocity.y.clamp(-2.0, 2.0);
        self.be_sure(0.005);
        self.covariance[FORCE][FORCE] = 400.0;
    }
}
