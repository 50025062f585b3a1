//! Association of loaded tiles with tracks, and new tracks for loads beyond all feet.

use super::params::associate::{ASTRIDE_M, NOISE_ARM_M, PENDING_S};
use super::params::state::LANDS_S;
use glam::DVec2;
use std::cmp::Reverse;

use super::elapsed::Elapsed;
use super::state::{EAST, FORCE, NORTH, Track};
use super::touchdown::Touchdown;
use super::{Tracker, UNASSIGNED, first_of_least};
use crate::sense::centroid::tile::LoadedTile;
use crate::sense::loaded::LoadedTiles;

/// A load beyond all feet near it that may be a new foot.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pending {
    pub index: u32,
    age: f64,
    force: f64,
    moment: DVec2,
    noise: f64,
    seen: bool,
}

/// A track that had an unassigned tile in the last frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct PreviousOwner {
    track: u32,
    /// The entry found before this one for the same tile, or `UNASSIGNED`.
    before: u32,
}

impl Tracker {
    /// Associates tiles with the tracks that reach them, tiles out of reach with the nearest track that may have
    /// grown onto them, and starts new tracks on the rest.
    pub(super) fn associate(&mut self, tiles: &LoadedTiles, elapsed: &Elapsed) {
        let list = tiles.list();
        self.owner.clear();
        self.owner.resize(list.len(), UNASSIGNED);
        for (which, foot) in self.tracks.iter().enumerate() {
            for &position in &foot.tiles {
                self.owner[position as usize] = which as u32;
            }
        }
        self.unassigned.clear();
        for (position, (tile, &owner)) in (0..).zip(list.iter().zip(&self.owner)) {
            if owner == UNASSIGNED {
                // Positive floats sort like their bits.
                self.unassigned.push((Reverse(tile.wrench.force.to_bits()), position));
            }
        }
        self.unassigned.sort_unstable();
        self.find_previous_owners(tiles);
        for pending in &mut self.pending {
            pending.seen = false;
        }
        for which_tile in 0..self.unassigned.len() {
            let position = self.unassigned[which_tile].1;
            let tile = &list[position as usize];
            let centroid = tile.centroid.as_dvec2();
            let force = f64::from(tile.wrench.force);
            let beyond = |foot: &Track| {
                foot.beyond(centroid).min(foot.lands_about(centroid)).min(foot.rims(centroid, force))
            };
            // A load that existed before starts no new track: it stays with the nearest of its previous owners.
            let known = |which: u32| self.previous_owners.get(which as usize);
            let last = known(self.last_previous_owner[position as usize]);
            let previous_owners = std::iter::successors(last, |owner| known(owner.before));
            let away_s = previous_owners.map(|owner| {
                let which = owner.track as usize;
                (self.tracks[which].centre().distance(centroid), which)
            });
            let nearest = away_s.min_by(first_of_least).or_else(|| {
                // A foot that may have grown onto it has its centre of pressure within a stride.
                let tracks = self.near.around(centroid).map(|which| (beyond(&self.tracks[which]), which));
                tracks.filter(|&(beyond, _)| beyond < 0.0).min_by(first_of_least)
            });
            match nearest {
                Some((_, which)) => {
                    let foot = &mut self.tracks[which];
                    foot.tiles.push(position);
                    if foot.age == 0.0 {
                        // A foot that lands on several tiles at once has their common centroid.
                        let whole = foot.force() + force;
                        let centre = foot.centre() + (centroid - foot.centre()) * (force / whole);
                        foot.state[FORCE] = whole;
                        foot.state[EAST] = centre.x;
                        foot.state[NORTH] = centre.y;
                        self.near.moved(which, centre);
                    }
                    self.owner[position as usize] = which as u32;
                }
                None if self.is_pending(tile, elapsed) => {
                    // Until confirmation the load counts towards the nearest foot.
                    let nearest = self.near.distances(centroid).min_by(first_of_least);
                    if let Some((_, which)) = nearest {
                        self.tracks[which].tiles.push(position);
                        self.owner[position as usize] = which as u32;
                    }
                }
                None => {
                    let mut foot = Track::new(self.identity(centroid), force, centroid, 0.02);
                    foot.arrivals.touchdown = self.touchdown_at(centroid);
                    foot.tiles.push(position);
                    self.owner[position as usize] = self.tracks.len() as u32;
                    self.near.add(&foot);
                    self.tracks.push(foot);
                }
            }
        }
    }

    /// Removes pending loads that are gone or assigned.
    pub(super) fn forget_pending(&mut self) {
        self.pending.retain(|pending| pending.seen);
    }

    /// Whether it is still uncertain that a load lies beyond all feet near it.
    fn is_pending(&mut self, tile: &LoadedTile, elapsed: &Elapsed) -> bool {
        let (dt, keep) = (elapsed.dt, elapsed.pending);
        let place = tile.centroid.as_dvec2();
        let mut near = self.near.distances(place);
        let is_near = near.any(|(distance, which)| distance < ASTRIDE_M && self.tracks[which].age > 0.0);
        if !is_near {
            return false;
        }
        let at = self.pending.iter().position(|pending| pending.index == tile.index).unwrap_or_else(|| {
            self.pending.push(Pending {
                index: tile.index,
                age: 0.0,
                force: 0.0,
                moment: DVec2::ZERO,
                noise: 0.0,
                seen: false,
            });
            self.pending.len() - 1
        });
        let pending = &mut self.pending[at];
        let force = f64::from(tile.wrench.force);
        pending.age += dt;
        pending.seen = true;
        pending.force = keep * pending.force + force;
        pending.moment = keep * pending.moment + place * force;
        pending.noise = keep * keep * pending.noise + tile.loaded_noise_n().powi(2);
        let middle = pending.moment / pending.force;
        let deviation = NOISE_ARM_M * pending.noise.sqrt() / pending.force;
        let (age, margin) = (pending.age, 0.005 + 3.0 * deviation);
        let sure = age >= PENDING_S.min(dt)
            && self.near.around(place).all(|which| {
                let foot = &self.tracks[which];
                foot.beyond(middle).min(foot.lands_about(middle)).min(foot.rims(middle, force)) > margin
            });
        !sure
    }

    /// Finds the tracks that had each unassigned tile in the last frame.
    fn find_previous_owners(&mut self, tiles: &LoadedTiles) {
        self.previous_owners.clear();
        if self.unassigned.is_empty() {
            return;
        }
        self.last_previous_owner.clear();
        self.last_previous_owner.resize(self.owner.len(), UNASSIGNED);
        for (track, foot) in (0..).zip(self.tracks.iter()) {
            for load in &foot.smoothed.loads {
                let Some(position) = tiles.position(load.index) else { continue };
                if self.owner[position as usize] == UNASSIGNED {
                    let last = &mut self.last_previous_owner[position as usize];
                    let before = std::mem::replace(last, self.previous_owners.len() as u32);
                    self.previous_owners.push(PreviousOwner { track, before });
                }
            }
        }
    }

    /// The standing foot beside which a foot lands at `place`, if there is one.
    fn touchdown_at(&self, place: DVec2) -> Option<Touchdown> {
        let near = self.near.distances(place);
        let (_, existing) = near.filter(|&(distance, _)| distance < ASTRIDE_M).min_by(first_of_least)?;
        let existing = &self.tracks[existing];
        (existing.is_slow() && !existing.company.shared)
            .then_some(Touchdown { existing: existing.id, from: existing.stillness.rest_point })
    }
}

impl Track {
    /// Assigns the tiles on which it was noticed to a foot in touchdown whose estimated place is beside all loaded
    /// tiles.
    pub(super) fn keep_noticed_tiles(&mut self, tiles: &LoadedTiles) {
        if self.tiles.is_empty() && self.age < LANDS_S {
            self.tiles.extend(self.smoothed.loads.iter().filter_map(|load| tiles.position(load.index)));
        }
    }
}
