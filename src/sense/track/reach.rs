//! The loads that can belong to a foot: the area that one shoe can press.

use super::params::reach::{
    AHEAD_M_S, AROUND_LIGHT_M, AROUND_M, BEYOND_M, BORNE, HALVES, NOTED, NOTED_M, NOTED_PER_NOISE, RIM,
    RIM_AHEAD, RIM_OF_SHARED, SHOE,
};
use super::params::state::{FLAT_S, LANDS_S, SHOE_M, SLIDING_N};
use arrayvec::ArrayVec;
use glam::{DVec2, IVec2};

use super::elapsed::Elapsed;
use super::state::{EAST, NORTH, Track};
use super::strips::StripAxis;
use super::{Cells, cell_of};
use crate::sense::centroid::tile::LoadedTile;
use crate::sense::loaded::LoadedTiles;

impl Track {
    /// Distance of `point` from the area that can belong to this foot (m); negative within.
    ///
    /// All its centres of pressure since it landed, and everything else it presses, lie under one shoe. Until the
    /// foot is flat, the place of the shoe's other end is unknown; from then on the foot presses around its centre of
    /// pressure, as the smoothed state predicts it: the measured one moves towards a new foot.
    pub(super) fn beyond(&self, point: DVec2) -> f64 {
        let beyond = self.outline.beyond(point, SHOE);
        if self.age <= FLAT_S {
            return beyond;
        }
        let around = if self.bears() { AROUND_M } else { AROUND_LIGHT_M };
        beyond.max(point.distance(self.smoothed.centre) - around)
    }

    /// Updates the outline with the points pressed now.
    pub(super) fn note_outline(&mut self, list: &[LoadedTile], elapsed: &Elapsed) {
        let centre = self.centre();
        let mut pressed: ArrayVec<DVec2, MOST_NOTED> = ArrayVec::new();
        if !self.company.shared {
            let tiles = self.tiles.as_slice();
            // On a single tile, the only point is the centre itself.
            let several = if tiles.len() > 1 { tiles } else { &[] };
            let least = NOTED * self.force();
            for &position in several {
                let tile = &list[position as usize];
                let force = f64::from(tile.wrench.force);
                if force > least && force > NOTED_PER_NOISE * tile.loaded_noise_n() {
                    // Never full: so many shares would exceed the whole.
                    let _ = pressed.try_push(tile.centroid.as_dvec2());
                }
            }
        } else if self.covariance[EAST][EAST] + self.covariance[NORTH][NORTH] > NOTED_M * NOTED_M {
            return;
        }
        let kept = if self.bears() { elapsed.outline } else { elapsed.light_outline };
        self.outline.renew(centre, &pressed, kept);
    }

    /// Distance of `point` from the area that a foot in touchdown, of which only a part is visible, may press (m);
    /// negative within, infinite for every other foot.
    pub(super) fn lands_about(&self, point: DVec2) -> f64 {
        if self.age < LANDS_S { point.distance(self.centre()) - SHOE_M } else { f64::INFINITY }
    }

    /// Distance of a light load at `point` from the rim of this foot (m); negative within, infinite for a heavy load.
    pub(super) fn rims(&self, point: DVec2, force: f64) -> f64 {
        let ahead = (point - self.centre()).dot(self.velocity()) > AHEAD_M_S * point.distance(self.centre());
        let (share, reach) = if self.company.shared {
            RIM_OF_SHARED
        } else if ahead && self.force() < SLIDING_N {
            RIM_AHEAD
        } else {
            RIM
        };
        if force < share * self.force() { point.distance(self.centre()) - reach } else { f64::INFINITY }
    }

    /// Lists the loaded tiles within reach of its patch.
    pub(super) fn reach(&mut self, tiles: &LoadedTiles, cells: &Cells) {
        self.tiles.clear();
        let reach = self.half() * HALVES + BEYOND_M;
        let mut low = cell_of(self.centre() - reach, cells.pitch);
        let mut high = cell_of(self.centre() + reach, cells.pitch);
        let (borne_low, borne_high) = self.shape.borne;
        let (known_low, known_high) = (low.min(borne_low), high.max(borne_high));
        // Where it was alone, it also presses the tiles that it pressed then.
        if (known_low, known_high) != (low, high) && self.is_shape_known() {
            (low, high) = (known_low, known_high);
        }
        cells.visit(low, high, |index| {
            if let Some(position) = tiles.position(index) {
                self.tiles.push(position);
            }
        });
    }

    /// Records the range of columns and rows on which it showed load while it was alone.
    pub(super) fn note_borne(&mut self) {
        let (mut low, mut high) = NOTHING_BORNE;
        for residual in self.shape.residuals.iter().filter(|residual| residual.share > BORNE) {
            let (low, high) = match residual.axis {
                StripAxis::East => (&mut low.x, &mut high.x),
                StripAxis::North => (&mut low.y, &mut high.y),
            };
            (*low, *high) = ((*low).min(residual.number), (*high).max(residual.number));
        }
        self.shape.borne = (low, high);
    }
}

/// Empty range of columns and rows: of a foot that was never alone.
pub(super) const NOTHING_BORNE: (IVec2, IVec2) = (IVec2::MAX, IVec2::MIN);

/// Maximum number of tiles that each carry more than [`NOTED`] of a foot.
const MOST_NOTED: usize = (1.0 / NOTED) as usize;
