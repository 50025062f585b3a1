//! What can belong to a foot: where else one shoe may press.

use super::params::reach::{
    AHEAD_M_S, AROUND_LIGHT_M, AROUND_M, BEYOND_M, BORNE, HALVES, NOTED, NOTED_M, NOTED_PER_NOISE, RIM,
    RIM_AHEAD, RIM_OF_SHARED, SHOE,
};
use super::params::state::{FLAT_S, LANDS_S, SHOE_M, SLIDING_N};
use arrayvec::ArrayVec;
use glam::{DVec2, IVec2};

use super::elapsed::Elapsed;
use super::state::{EAST, NORTH, Track};
use super::strips::Axis;
use super::{Cells, cell_of};
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
        let centre = self.centre();
        let mut pressed: ArrayVec<DVec2, MOST_NOTED> = ArrayVec::new();
        if !self.shared {
            let tiles = self.tiles.as_slice();
            // On a single tile, it is the centre itself.
            let several = if tiles.len() > 1 { tiles } else { &[] };
            let least = NOTED * self.force();
            for &position in several {
                let tile = &list[position as usize];
                let force = f64::from(tile.wrench.force);
                if force > least && force > NOTED_PER_NOISE * tile.loaded_noise_n() {
                    // Never full: that many shares are more than the whole.
                    let _ = pressed.try_push(tile.centroid.as_dvec2());
                }
            }
        } else if self.covariance[EAST][EAST] + self.covariance[NORTH][NORTH] > NOTED_M * NOTED_M {
            return;
        }
        let kept = if self.bears() { elapsed.outline } else { elapsed.light_outline };
        self.outline.renew(centre, &pressed, kept);
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
    pub(super) fn reach(&mut self, tiles: &LoadedTiles, cells: &Cells) {
        self.tiles.clear();
        let reach = self.half() * HALVES + BEYOND_M;
        let mut low = cell_of(self.centre() - reach, cells.pitch);
        let mut high = cell_of(self.centre() + reach, cells.pitch);
        let (borne_low, borne_high) = self.borne;
        let (known_low, known_high) = (low.min(borne_low), high.max(borne_high));
        // Where it was alone, it also presses what it pressed then.
        if (known_low, known_high) != (low, high) && self.is_shape_known() {
            (low, high) = (known_low, known_high);
        }
        cells.visit(low, high, |index| {
            if let Some(position) = tiles.position(index) {
                self.tiles.push(position);
            }
        });
    }

    /// Notes between which columns and rows it has borne something where it was alone.
    pub(super) fn note_borne(&mut self) {
        let (mut low, mut high) = NOTHING_BORNE;
        for residual in self.residuals.iter().filter(|residual| residual.share > BORNE) {
            let (low, high) = match residual.axis {
                Axis::East => (&mut low.x, &mut high.x),
                Axis::North => (&mut low.y, &mut high.y),
            };
            (*low, *high) = ((*low).min(residual.number), (*high).max(residual.number));
        }
        self.borne = (low, high);
    }
}

/// The lowest and the highest column and row that a foot has borne something on which was never alone.
pub(super) const NOTHING_BORNE: (IVec2, IVec2) = (IVec2::MAX, IVec2::MIN);

/// Most tiles that carry more than [`NOTED`] of a foot each.
const MOST_NOTED: usize = (1.0 / NOTED) as usize;
