//! Conversion of feet to contacts.

use super::params::dormant::{PLACE_M, REPORTED};
use super::params::output::{
    AMBIGUOUS_M, FITS, INFLATION, LEAST_N, LOST_M, OTHERS_MISREAD, STRAYED_M, TOGETHER_M,
};
use glam::Vec2;

use super::dormant::Dormant;
use super::state::{EAST, NORTH, Track};
use super::{Cells, Tracker};
use crate::parallel;
use crate::sense::centroid::tile::LoadedTile;
use crate::sense::centroid::uncertainty::SensorUncertainty;
use crate::sense::contact::pool::ContactPool;
use crate::sense::contact::{Contact, Covariance, TileLoad};
use crate::sense::loaded::LoadedTiles;
use crate::units::Newtons;

impl Tracker {
    /// Fills `pool` with the present feet, ordered by id.
    pub(super) fn describe(&mut self, tiles: &LoadedTiles, pool: &mut ContactPool) {
        let feet = self.tracks.len();
        self.by_id.clear();
        self.by_id.extend(self.tracks.iter().map(|foot| (foot.id, 0)));
        self.by_id.extend(self.dormant.iter().map(|dormant| (dormant.foot.id, 0)));
        self.by_id.iter_mut().zip(0..).for_each(|(entry, which)| entry.1 = which);
        sort_few(&mut self.by_id);
        let dormant = |which: u32| self.dormant.get((which as usize).checked_sub(feet)?);
        let existing = |dormant: &Dormant| self.tracks.iter().find(|foot| foot.id == dormant.existing);
        if !self.dormant.is_empty() {
            let is_shown = |which| dormant(which).is_none_or(|dormant| existing(dormant).is_some());
            self.by_id.retain(|&(_, which)| is_shown(which));
        }
        pool.clear();
        for &(id, _) in &self.by_id {
            pool.add(id);
        }
        parallel::for_each(pool.contacts_mut(), |at, contact| {
            let which = self.by_id[at].1;
            if let Some(foot) = self.tracks.get(which as usize) {
                foot.describe(tiles, &self.cells, &self.uncertainty, contact);
            } else if let Some(dormant) = dormant(which)
                && let Some(existing) = existing(dormant)
            {
                dormant.describe(existing, tiles.list(), contact);
            }
        });
    }
}

impl Dormant {
    /// Fills `contact`, which has only its id yet; `existing` carries the foot's load.
    fn describe(&self, existing: &Track, list: &[LoadedTile], contact: &mut Contact) {
        contact.centroid = self.foot.centre().as_vec2();
        contact.force = Newtons((REPORTED * existing.force()) as f32);
        contact.velocity = Vec2::ZERO;
        contact.ambiguous = true;
        contact.split = self.foot.doubt.part_of.is_some();
        contact.covariance = Covariance::isotropic(PLACE_M as f32);
        contact.tiles.extend(existing.tiles.iter().map(|&position| {
            let tile = &list[position as usize];
            TileLoad { force: Newtons(tile.wrench.force * REPORTED as f32), ..all_of(tile) }
        }));
        contact.finish();
    }
}

impl Track {
    /// Updates whether the foot is ambiguous.
    pub(super) fn judge(&mut self) {
        if !self.company.shared {
            (self.doubt.nis, self.doubt.misfit) = (0.0, 0.0);
        }
        self.doubt.ambiguous = if self.company.shared {
            self.company.beyond_filter
                || self.doubt.contested_s > 0.0
                || self.inflated() > AMBIGUOUS_M * AMBIGUOUS_M
        } else {
            self.arrivals.explanation.is_open()
        };
    }

    /// Variance of its place along the worse axis.
    fn variance(&self) -> f64 {
        self.covariance[EAST][EAST].max(self.covariance[NORTH][NORTH])
    }

    /// Covariance inflation 1 + `INFLATION` · NIS, limited by [`LOST_M`]: repeated innovations show that the filter's
    /// model of the feet is wrong.
    fn inflation(&self) -> f64 {
        (1.0 + INFLATION * self.doubt.nis).min(LOST_M * LOST_M / self.variance()).max(1.0)
    }

    fn inflated(&self) -> f64 {
        self.inflation() * self.variance()
    }

    /// Fills `contact`, which has only its id yet.
    fn describe(
        &self,
        tiles: &LoadedTiles,
        cells: &Cells,
        uncertainty: &SensorUncertainty,
        contact: &mut Contact,
    ) {
        let (list, pressed) = (tiles.list(), self.tiles.as_slice());
        contact.centroid = self.centre().as_vec2();
        contact.force = Newtons(self.force() as f32);
        contact.velocity = self.velocity().as_vec2();
        // If the loads do not fit two feet of which one was assumed still, both places are wrong. The contact reports
        // that; the filter continues with its own covariance.
        let strayed_m =
            if self.doubt.misfit > FITS { STRAYED_M * (self.doubt.misfit - FITS).sqrt().sqrt() } else { 0.0 };
        contact.split = self.doubt.part_of.is_some();
        contact.ambiguous = self.doubt.ambiguous || contact.split;
        let mut covariance = Covariance::default();
        if self.company.shared {
            contact.ambiguous |= self.inflated().sqrt().hypot(strayed_m) > AMBIGUOUS_M;
            let inflation = self.inflation();
            covariance = Covariance {
                xx: (inflation * self.covariance[EAST][EAST]) as f32,
                xy: (inflation * self.covariance[EAST][NORTH]) as f32,
                yy: (inflation * self.covariance[NORTH][NORTH]) as f32,
            };
        } else {
            let left: f32 = pressed.iter().map(|&position| list[position as usize].left_n).sum();
            contact.force = Newtons((contact.force.0 - left).max(LEAST_N));
        }
        for &position in pressed {
            let tile = &list[position as usize];
            let mut share = 1.0;
            let mut load = all_of(tile);
            if self.company.shared {
                share = self.divide(tile, cells, &mut load);
                // The gain errors under the other feet are known in part, from when they stood alone.
                share += (1.0 - share) * OTHERS_MISREAD;
            }
            if load.force.0 > 0.0 {
                contact.tiles.push(load);
            }
            contact.quality = contact.quality.max(tile.quality);
            covariance +=
                uncertainty.covariance(tiles.geometry(), tile, share, contact.centroid, contact.force.0);
        }
        if contact.tiles.is_empty() {
            // Its patch now lies beside every tile that could carry it.
            contact.tiles.extend(pressed.first().map(|&position| {
                let tile = &list[position as usize];
                TileLoad { force: Newtons(tile.wrench.force.min(contact.force.0)), ..all_of(tile) }
            }));
        }
        covariance += Covariance::isotropic(strayed_m as f32);
        if self.company.landed_together {
            covariance += Covariance::isotropic(TOGETHER_M);
        }
        if !self.company.shared {
            covariance += Covariance::isotropic(self.arrivals.explanation.hidden_m() as f32);
        }
        contact.covariance = covariance;
        contact.finish();
    }

    /// Reduces `load`, all of the load of `tile`, to this foot's part; returns its share.
    #[cold]
    fn divide(&self, tile: &LoadedTile, cells: &Cells, load: &mut TileLoad) -> f32 {
        let on = self.on(cells.of(tile));
        let force = (self.force() * on.share()) as f32;
        let arm = if on.share() > 1e-6 { (on.moment() / on.share()).as_vec2() } else { Vec2::ZERO };
        load.force = Newtons(force.min(tile.wrench.force));
        load.centroid = tile.centre + arm;
        (force / tile.wrench.force).min(1.0)
    }
}

/// The whole load of `tile`.
fn all_of(tile: &LoadedTile) -> TileLoad {
    TileLoad {
        tile: tile.tile,
        index: tile.index as usize,
        force: Newtons(tile.wrench.force),
        centroid: tile.centroid,
    }
}

/// Sorts a nearly sorted list: only feet that were dormant are older than their positions indicate.
fn sort_few<T: Ord>(list: &mut [T]) {
    for at in 1..list.len() {
        if list[at] < list[at - 1] {
            let to = list[..at].partition_point(|before| *before < list[at]);
            list[to..=at].rotate_right(1);
        }
    }
}
