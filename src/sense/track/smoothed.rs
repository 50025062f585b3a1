//! The smoothed state of a foot: the prediction from its last few hundredths of a second, against which a new foot
//! shows.

use glam::DVec2;
use smallvec::SmallVec;

use super::Cells;
use super::elapsed::Elapsed;
use super::patch::PatchOnTile;
use super::state::{EAST, FORCE, NORTH, Track};
use crate::sense::centroid::tile::LoadedTile;

/// Force, place and rates of a foot, predicted from its last few hundredths of a second.
#[derive(Clone, Debug, Default)]
pub(super) struct Smoothed {
    pub force: f64,
    pub force_rate: f64,
    pub centre: DVec2,
    pub velocity: DVec2,
    /// Smoothed force and moment (about the tile's centre) per tile.
    pub loads: SmallVec<[SmoothedLoad; 12]>,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SmoothedLoad {
    pub index: u32,
    pub force: f64,
    pub moment: DVec2,
}

impl Track {
    /// Updates the smoothed state with the foot's present state.
    pub(super) fn smooth(&mut self, elapsed: &Elapsed) {
        let (dt, keep) = (elapsed.dt, elapsed.smoothed);
        if dt <= 0.0 {
            return;
        }
        // A critically damped alpha-beta filter, x += α r and v += β r with residual r, α = 1 − k², β = (1 − k)² / dt
        // and k = exp(−dt/τ): it follows steady motion without lag or overshoot.
        let (alpha, beta) = (1.0 - keep * keep, (1.0 - keep) * (1.0 - keep) / dt);
        let offset = self.centre() - self.smoothed.centre;
        let gain = self.force() - self.smoothed.force;
        self.smoothed.centre += alpha * offset;
        self.smoothed.velocity += beta * offset;
        self.smoothed.force += alpha * gain;
        self.smoothed.force_rate += beta * gain;
    }

    /// Restarts the smoothed state at the present force and place, so that earlier frames have no influence.
    pub(super) fn restart_smoothing(&mut self) {
        self.smoothed = Smoothed { force: self.force(), centre: self.centre(), ..Smoothed::default() };
    }

    /// Updates the smoothed loads of its tiles with its present loads, and removes those of other tiles.
    pub(super) fn learn_loads(&mut self, list: &[LoadedTile], cells: &Cells, elapsed: &Elapsed) {
        let (whole, centre, half) = (self.force(), self.centre(), self.half());
        let tiles = self.tiles.as_slice();
        let loads = &mut self.smoothed.loads;
        // A foot that has just become alone starts from the measured loads.
        let fresh = !self.company.shared && loads.is_empty();
        let weight = if fresh && self.age > 0.0 { 1.0 } else { 1.0 - elapsed.smoothed };
        for (at, &position) in tiles.iter().enumerate() {
            let tile = &list[position as usize];
            let (force, moment) = if self.company.shared {
                let (low, high) = cells.of(tile);
                let on = PatchOnTile::new(low, high, centre, half);
                (on.share() * whole, on.moment() * whole)
            } else {
                let force = f64::from(tile.wrench.force);
                (force, (tile.centroid - tile.centre).as_dvec2() * force)
            };
            let known = position_of(loads, at, tile.index);
            if known.is_none() {
                loads.push(SmoothedLoad { index: tile.index, ..SmoothedLoad::default() });
            }
            let number = known.unwrap_or(loads.len() - 1);
            let load = &mut loads.as_mut_slice()[number];
            load.force += weight * (force - load.force);
            load.moment += weight * (moment - load.moment);
        }
        if loads.len() > tiles.len() {
            let is_pressed = |index: u32| tiles.iter().any(|&tile| list[tile as usize].index == index);
            loads.retain(|load| is_pressed(load.index));
        }
    }

    /// Smoothed load of the tile `index`, which is number `at` of its tiles; zero if there is none.
    #[inline]
    pub(super) fn smoothed_load(&self, at: usize, index: u32) -> SmoothedLoad {
        let loads = self.smoothed.loads.as_slice();
        position_of(loads, at, index).map(|position| loads[position]).unwrap_or_default()
    }

    /// Returns to the predicted state: the difference belongs to another foot.
    pub(super) fn back_to_prediction(&mut self) {
        self.state[FORCE] = self.smoothed.force.min(self.state[FORCE]);
        self.state[FORCE + 1] = self.smoothed.force_rate.clamp(-2e4, 2e4);
        self.state[EAST] = self.smoothed.centre.x;
        self.state[NORTH] = self.smoothed.centre.y;
        self.state[EAST + 1] = self.smoothed.velocity.x.clamp(-2.0, 2.0);
        self.state[NORTH + 1] = self.smoothed.velocity.y.clamp(-2.0, 2.0);
        self.reset_covariance(0.005);
        self.covariance[FORCE][FORCE] = 400.0;
    }
}

/// Position among the smoothed loads of tile `index`, which is number `at` of a foot's tiles: mostly number `at`,
/// too.
#[inline]
fn position_of(loads: &[SmoothedLoad], at: usize, index: u32) -> Option<usize> {
    if loads.get(at).is_some_and(|load| load.index == index) {
        return Some(at);
    }
    loads.iter().position(|load| load.index == index)
}
