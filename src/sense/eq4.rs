//! Contacts by the paper's method (Eq. 4): one per group of connected tiles.

use glam::Vec2;

use super::cluster::Clusters;
use super::contact::{Contact, ContactId, Covariance, TileLoad};
use super::loaded::LoadedTiles;
use super::pool::ContactPool;
use super::tile::LoadedTile;
use super::uncertainty::SensorUncertainty;
use crate::units::Newtons;

/// Marks a tile that no contact owned in the last frame.
const NOBODY: u32 = u32::MAX;

/// How far a contact may have come in one frame without sharing a tile with its old self, in metres.
const JUMP_M: f32 = 0.1;

/// The paper's own method: one contact per group of connected tiles, named by continuity.
///
/// A group goes on under the name that most of its force had in the last frame.
/// Where two groups meet, the heavier name stays; where one falls apart, the
/// heavier part keeps the name.
///
/// # Source
/// x_c = Σ w_k x_ck, w_k = F_k / F over the group's tiles (paper, Eq. 4), but
/// with [`LoadedTile::weight`] for F_k.
#[derive(Clone, Debug)]
pub(super) struct Eq4 {
    uncertainty: SensorUncertainty,
    next: u32,
    /// Per tile of the floor, which entry of `last` it carried.
    owner: Vec<u32>,
    /// The contacts of the last frame.
    last: Vec<PreviousContact>,
    now: Vec<PreviousContact>,
    /// The clusters of this frame, heaviest first.
    found: Vec<Found>,
    owned: Vec<u32>,
    /// Places in `found`, ordered by name.
    order: Vec<u32>,
    /// The last time between two frames, and the smoothing that goes with it.
    smoothing: (f32, f32),
}

#[derive(Clone, Copy, Debug)]
struct PreviousContact {
    id: ContactId,
    centroid: Vec2,
    velocity: Vec2,
    taken: bool,
    /// Force of the cluster being named that lies on this contact's old tiles.
    claim: f32,
}

#[derive(Clone, Copy, Debug)]
struct Found {
    cluster: u32,
    force: f32,
    centroid: Vec2,
}

impl Eq4 {
    pub(super) fn new(tiles: usize, uncertainty: SensorUncertainty) -> Self {
        let room = tiles.min(1024);
        Self {
            uncertainty,
            next: 1,
            owner: vec![NOBODY; tiles],
            last: Vec::with_capacity(room),
            now: Vec::with_capacity(room),
            found: Vec::with_capacity(room),
            owned: Vec::with_capacity(room),
            order: Vec::with_capacity(room),
            smoothing: (0.0, 0.0),
        }
    }

    /// Fills `pool` with this frame's contacts; `dt` seconds have passed since the last frame.
    pub(super) fn update(
        &mut self,
        tiles: &LoadedTiles,
        clusters: &Clusters,
        dt: f32,
        pool: &mut ContactPool,
    ) {
        self.weigh(tiles, clusters);
        pool.clear();
        if self.smoothing.0 != dt {
            self.smoothing = (dt, smoothing(dt));
        }
        self.now.clear();
        for position in 0..self.found.len() {
            let found = self.found[position];
            let members = clusters.get(found.cluster as usize).unwrap_or_default();
            let past = self.recognise(tiles.list(), members, &found);
            let (id, velocity) = match past {
                Some(past) => {
                    let moved = (found.centroid - past.centroid) / dt.max(1e-6);
                    let velocity = past.velocity + (moved - past.velocity) * self.smoothing.1;
                    (past.id, if dt > 0.0 { velocity } else { past.velocity })
                }
                None => (self.name(), Vec2::ZERO),
            };
            self.now.push(PreviousContact {
                id,
                centroid: found.centroid,
                velocity,
                taken: false,
                claim: 0.0,
            });
        }
        // Names are small, contacts are not: these are made in their order rather than put into it.
        self.order.clear();
        self.order.extend(0..self.now.len() as u32);
        self.order.sort_unstable_by_key(|&position| self.now[position as usize].id);
        for &position in &self.order {
            let (found, now) = (&self.found[position as usize], &self.now[position as usize]);
            let members = clusters.get(found.cluster as usize).unwrap_or_default();
            self.describe(tiles, members, found, pool.add(now.id), now.velocity);
        }
        self.remember(tiles.list(), clusters);
    }

    fn name(&mut self) -> ContactId {
        let id = ContactId(self.next);
        self.next = self.next.wrapping_add(1);
        id
    }

    /// Eq. 4 of every cluster.
    fn weigh(&mut self, tiles: &LoadedTiles, clusters: &Clusters) {
        self.found.clear();
        for (cluster, members) in clusters.iter().enumerate() {
            let (mut force, mut weight) = (0.0, 0.0);
            let mut sum = Vec2::ZERO;
            for &member in members {
                let tile = &tiles.list()[member as usize];
                let weighed = tile.weight();
                force += tile.wrench.force;
                weight += weighed;
                sum += tile.centroid * weighed;
            }
            self.found.push(Found { cluster: cluster as u32, force, centroid: sum / weight });
        }
        self.found.sort_unstable_by(|a, b| b.force.total_cmp(&a.force).then(a.cluster.cmp(&b.cluster)));
    }

    /// The contact of the last frame that goes on as this cluster.
    fn recognise(&mut self, list: &[LoadedTile], members: &[u32], found: &Found) -> Option<PreviousContact> {
        let mut best: Option<usize> = None;
        for &member in members {
            let tile = &list[member as usize];
            let owner = self.owner[tile.index as usize] as usize;
            if let Some(past) = self.last.get_mut(owner)
                && !past.taken
            {
                past.claim += tile.wrench.force;
                let claim = past.claim;
                if best.is_none_or(|best| claim > self.last[best].claim) {
                    best = Some(owner);
                }
            }
        }
        if best.is_none() {
            // A point load may leave one tile for the next between two frames.
            best = (0..self.last.len())
                .filter(|&past| !self.last[past].taken)
                .map(|past| (past, self.last[past].centroid.distance(found.centroid)))
                .filter(|&(_, distance)| distance <= JUMP_M)
                .min_by(|a, b| a.1.total_cmp(&b.1))
                .map(|(past, _)| past);
        }
        for &member in members {
            let owner = self.owner[list[member as usize].index as usize] as usize;
            if let Some(past) = self.last.get_mut(owner) {
                past.claim = 0.0;
            }
        }
        let past = self.last.get_mut(best?)?;
        past.taken = true;
        Some(*past)
    }

    fn describe(
        &self,
        tiles: &LoadedTiles,
        members: &[u32],
        found: &Found,
        contact: &mut Contact,
        velocity: Vec2,
    ) {
        contact.centroid = found.centroid;
        contact.force = Newtons(found.force);
        contact.velocity = velocity;
        let mut covariance = Covariance::default();
        for &member in members {
            let tile = &tiles.list()[member as usize];
            contact.tiles.push(TileLoad {
                tile: tile.tile,
                index: tile.index as usize,
                force: Newtons(tile.wrench.force),
                centroid: tile.centroid,
            });
            contact.quality = contact.quality.max(tile.quality);
            covariance +=
                self.uncertainty.covariance(tiles.geometry(), tile, 1.0, found.centroid, found.force);
        }
        contact.covariance = covariance;
        contact.finish();
    }

    fn remember(&mut self, list: &[LoadedTile], clusters: &Clusters) {
        for &index in &self.owned {
            self.owner[index as usize] = NOBODY;
        }
        self.owned.clear();
        for (slot, found) in self.found.iter().enumerate() {
            for &member in clusters.get(found.cluster as usize).unwrap_or_default() {
                let index = list[member as usize].index;
                self.owner[index as usize] = slot as u32;
                self.owned.push(index);
            }
        }
        std::mem::swap(&mut self.last, &mut self.now);
    }
}

/// Weight of a new velocity against the old one: a first-order low-pass of 25 ms.
pub(super) fn smoothing(dt: f32) -> f32 {
    1.0 - (-dt / 0.025).exp()
}
