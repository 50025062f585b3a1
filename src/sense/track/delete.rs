//! Deletion of feet that have left: their places are proven empty.

use super::params::delete::{
    EMPTY_N, FAINT_S, FAR_M, GONE_SHARE, LIGHT_N, LIGHT_SHARE, MISPLACED, NOTICED_N, OWN_M, RECOVERS, RIM_M,
    RIM_SHARE, SURE,
};
use super::params::state::{LANDS_S, SHOE_M};
use super::state::{FORCE, Track};
use super::{Tracker, cell_of, first_of_least};
use crate::parallel;
use crate::sense::centroid::tile::LoadedTile;
use crate::sense::loaded::LoadedTiles;

impl Tracker {
    /// Deletes feet that are no longer there.
    pub(super) fn delete_empty(&mut self, tiles: &LoadedTiles, dt: f64) {
        let mut empty_s = std::mem::take(&mut self.empty_s);
        empty_s.resize(self.tracks.len(), 0.0);
        let heaviest = self.tracks.iter().map(|foot| foot.force());
        let heaviest = heaviest.fold(0.0, |most, force| if force > most { force } else { most });
        parallel::for_each(&mut empty_s, |which, empty_s| {
            let foot = &self.tracks[which];
            let gone = if foot.company.shared {
                self.is_empty(foot, tiles)
            } else {
                foot.force() < RIM_SHARE * heaviest && self.is_rim(which)
            };
            let change = if gone { 1.0 } else { -RECOVERS };
            *empty_s = (foot.empty_s + change * dt).max(0.0);
        });
        for (which, &empty_s) in empty_s.iter().enumerate() {
            let foot = &mut self.tracks[which];
            foot.empty_s = empty_s;
            if empty_s >= FAINT_S {
                for mate in self.mates.of(foot.company.group) {
                    self.tracks[mate].suppress_births();
                }
            }
        }
        let is_any_gone = empty_s.iter().any(|&empty_s| empty_s >= FAINT_S);
        self.empty_s = empty_s;
        if !is_any_gone {
            return;
        }
        for which in 0..self.tracks.len() {
            if self.tracks[which].empty_s >= FAINT_S {
                self.transfer_tiles(which);
            }
        }
        let groups = self.tracks.len();
        self.tracks.retain(|foot| foot.empty_s < FAINT_S);
        self.renew_groups(groups);
    }

    /// Whether the place of a foot that shares its tiles is proven empty.
    fn is_empty(&self, foot: &Track, tiles: &LoadedTiles) -> bool {
        let all: f64 = foot.force() + self.mates(foot).map(Track::force).sum::<f64>();
        if foot.force() >= LIGHT_N.max(LIGHT_SHARE * all) || self.has_own(foot, tiles.list()) {
            return false;
        }
        let sigma = foot.covariance[FORCE][FORCE].sqrt();
        if foot.force() + SURE * sigma < EMPTY_N {
            return true;
        }
        // The division among three feet on shared tiles is uncertain: the light one may result from a wrong division.
        let crowd = self.mates(foot).nth(1).is_some();
        crowd && foot.age > LANDS_S && foot.force() < GONE_SHARE * all
            || self.stands_on_nothing(foot, tiles, all)
    }

    /// Whether a foot with the smallest part of the load `all` that justifies a track would show on unloaded tiles.
    pub(super) fn stands_on_nothing(&self, foot: &Track, tiles: &LoadedTiles, all: f64) -> bool {
        let at = cell_of(foot.centre(), self.cells.pitch);
        let around = (at.y - 2..=at.y + 2)
            .flat_map(|row| (at.x - 2..=at.x + 2).filter_map(move |column| tiles.find(column, row)));
        let near = around
            .map(|position| &tiles.list()[position])
            .filter(|tile| tile.centre.as_dvec2().distance(foot.centre()) < self.cells.side() * 1.5);
        let on: f64 = near.map(|tile| foot.on(self.cells.of(tile)).share()).sum();
        // Allowance for the uncertainty of its place.
        let beside = 1.0 - on - MISPLACED;
        beside * LIGHT_N.max(GONE_SHARE * all) > NOTICED_N
    }

    /// Transfers the tiles of the deleted foot `which` to the nearest foot of its group, so that its remaining load
    /// starts no new track.
    fn transfer_tiles(&mut self, which: usize) {
        let gone = &self.tracks[which];
        let mates = self.mates.of(gone.company.group).filter(|&mate| self.tracks[mate].empty_s < FAINT_S);
        let away_s = mates.map(|mate| (self.tracks[mate].centre().distance(gone.centre()), mate));
        // A load farther away than the length of a shoe belongs to none of them.
        let successor = away_s.filter(|&(distance, _)| distance < SHOE_M).min_by(first_of_least);
        let Some((_, successor)) = successor else { return };
        let left = std::mem::take(&mut self.tracks[which].tiles);
        self.tracks[successor].inherit(&left);
    }

    /// Confirms tracks that were split from another one: those with a tile of their own that the other foot's shoe
    /// cannot reach, and those whose other track has ended.
    pub(super) fn confirm_split(&mut self, tiles: &LoadedTiles) {
        for which in 0..self.tracks.len() {
            let Some(from) = self.tracks[which].doubt.part_of else { continue };
            let other = self.tracks.iter().position(|track| track.id == from);
            if other.is_none_or(|other| self.is_apart(which, other, tiles.list())) {
                self.tracks[which].doubt.part_of = None;
            }
        }
    }

    /// Whether track `which` alone presses a tile that is out of reach of track `other`.
    fn is_apart(&self, which: usize, other: usize, list: &[LoadedTile]) -> bool {
        let (track, other) = (&self.tracks[which], &self.tracks[other]);
        track.tiles.iter().any(|position| {
            let centroid = list[*position as usize].centroid.as_dvec2();
            let is_own = self.mates(track).all(|mate| !mate.tiles.contains(position));
            is_own && !other.tiles.contains(position) && other.centre().distance(centroid) > OWN_M
        })
    }

    /// The other feet of its group.
    fn mates(&self, foot: &Track) -> impl Iterator<Item = &Track> {
        let id = foot.id;
        self.mates.of(foot.company.group).map(|mate| &*self.tracks[mate]).filter(move |mate| mate.id != id)
    }

    /// Whether foot `which` is only the rim of a heavy foot, on a tile that it pressed together with a foot that has
    /// gone.
    fn is_rim(&self, which: usize) -> bool {
        let foot = &self.tracks[which];
        let (place, force) = (foot.centre(), foot.force());
        foot.stillness.rest_point.distance(place).max(foot.step.landed.distance(place)) > FAR_M
            && self.near.others(which).any(|other| {
                let other = &self.tracks[other];
                force < RIM_SHARE * other.force() && other.centre().distance(place) < RIM_M
            })
    }

    /// Whether it presses a tile beyond the reach of all others: proof that it is still there.
    fn has_own(&self, foot: &Track, list: &[LoadedTile]) -> bool {
        foot.tiles.iter().any(|&position| {
            let place = list[position as usize].centroid.as_dvec2();
            self.mates(foot).all(|other| other.centre().distance(place) > OWN_M)
        })
    }
}
