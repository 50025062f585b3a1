//! What can belong to a foot: where else one shoe may press.

use super::params::reach::{
    AHEAD_M_S, AROUND_LIGHT_M, AROUND_M, BEYOND_M, BORNE, HALVES, KNOWN, NOTED, NOTED_M, NOTED_PER_NOISE,
    RIM, RIM_AHEAD, RIM_OF_SHARED, SHOE,
};
use super::params::state::{FLAT_S, LANDS_S, SHOE_M, SLIDING_N};
use glam::DVec2;

use super::cell_of;
use super::elapsed::Elapsed;
use super::outline::Outline;
use super::state::{EAST, NORTH, Track};
use super::strips::Axis;
use crate::sense::loaded::LoadedTiles;
use crate::sense::tile::LoadedTile;

impl Track {
    /// How far `point` is beyond what can belong to this foot, in metres; negative within.
    ///
    /// All its centres of pressure since it landed, and everything else it
    /// presses, lie under one shoe. Until it has come down flat, nothing is known
    /// of where the shoe's other end lies; from then on what it presses is around
    /// its centre of pressure, as its past foretells it: a newcomer draws along what is measured.
    pub(super) fn beyond(&self, point: DVec2) -> f64 {
        let beyond = self.outline.beyond(point, SHOE);
        if self.age <= FLAT_S {
            return beyond;
        }
        let around = if self.bears() { AROUND_M } else { AROUND_LIGHT_M };
        beyond.max(point.distance(self.smoothed.centre) - around)
    }

    /// Adds what it presses now to what it has pressed of late.
    pub(super) fn note_outline(&mut self, list: &[LoadedTile], elapsed: &Elapsed) {
        let mut now = Outline::new(self.centre());
        if !self.shared {
            for &position in &self.tiles {
                let tile = &list[position as usize];
                let force = f64::from(tile.wrench.force);
                if force > NOTED * self.force() && force > NOTED_PER_NOISE * tile.loaded_noise_n() {
                    now.add(tile.centroid.as_dvec2());
                }
            }
        } else if self.covariance[EAST][EAST] + self.covariance[NORTH][NORTH] > NOTED_M * NOTED_M {
            return;
        }
        let kept = if self.bears() { elapsed.outline } else { elapsed.light_outline };
        self.outline.relax(&now, kept);
        self.outline.unite(&now);
    }

    /// How far `point` is beyond where a foot may press that has just landed, of which therefore only a part has
    /// been seen; negative within, infinite for every other foot.
    pub(super) fn lands_about(&self, point: DVec2) -> f64 {
        if self.age < LANDS_S { point.distance(self.centre()) - SHOE_M } else { f64::INFINITY }
    }

    /// How far a light load at `point` is beyond the rim of this foot; negative within, infinite for a heavy load.
    pub(super) fn rims(&self, point: DVec2, force: f64) -> f64 {
        let ahead = (point - self.centre()).dot(self.velocity()) > AHEAD_M_S * point.distance(self.centre());
        let (share, reach) = if self.shared {
            RIM_OF_SHARED
        } else if ahead && self.force() < SLIDING_N {
            RIM_AHEAD
        } else {
            RIM
        };
        if force < share * self.force() { point.distance(self.centre()) - reach } else { f64::INFINITY }
    }

    /// Lists the loaded tiles that its patch may press.
    pub(super) fn reach(&mut self, tiles: &LoadedTiles, pitch: f64) {
        self.tiles.clear();
        let reach = self.half() * HALVES + BEYOND_M;
        let mut low = cell_of(self.centre() - reach, pitch);
        let mut high = cell_of(self.centre() + reach, pitch);
        let (mut known_low, mut known_high) = (low, high);
        for residual in self.residuals.iter().filter(|residual| residual.share > BORNE) {
            let (low, high) = match residual.axis {
                Axis::East => (&mut known_low.x, &mut known_high.x),
                Axis::North => (&mut known_low.y, &mut known_high.y),
            };
            (*low, *high) = ((*low).min(residual.number), (*high).max(residual.number));
        }
        // Where it was alone, it also presses what it pressed then.
        if (known_low, known_high) != (low, high) && self.residual_weight() > KNOWN {
            (low, high) = (known_low, known_high);
        }
        for row in low.y..=high.y {
            for column in low.x..=high.x {
                if let Some(position) = tiles.find(column, row) {
                    self.tiles.push(position as u32);
                }
            }
        }
    }
}
