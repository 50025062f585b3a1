//! Contacts by the paper's method (Eq. 4): one per group of connected tiles.

use glam::Vec2;

use super::cluster::Clusters;
use super::uncertainty::SensorUncertainty;
use crate::sense::contact::pool::ContactPool;
use crate::sense::loaded::LoadedTiles;
use crate::sense::{Contact, ContactId, Covariance, Quality, TileLoad};
use crate::units::Newtons;

/// Marks a contact that has ended.
const NONE: u32 = u32::MAX;

/// Maximum movement of a contact in one frame without a common tile with its last position (m).
const JUMP_M: f32 = 0.1;

/// The paper's own method: one contact per group of connected tiles, with identifiers by continuity.
///
/// A group keeps the identifier that most of its force had in the last frame. Where two groups merge, the heavier
/// identifier stays; where one splits, the heavier part keeps it.
///
/// # Source
/// x_c = Σ w_k x_ck, w_k = F_k / F over the group's tiles (paper, Eq. 4), but
/// with [`LoadedTile::weight`] for F_k.
#[derive(Clone, Debug)]
pub(in crate::sense) struct Eq4 {
    uncertainty: SensorUncertainty,
    next: u32,
    /// The contacts of the last frame and of this one, in the order of their clusters.
    last: Vec<Named>,
    now: Vec<Named>,
    /// Load of each tile of this frame's clusters, in the order of their members.
    loads: Vec<TileLoad>,
    /// Clusters of this frame, heaviest first: the bits of its force, inverted, and its number.
    by_force: Vec<u64>,
    /// Clusters of this frame, and of the last one until those of this one are known, by identifier.
    by_name: Vec<u32>,
    /// Clusters with a new identifier, in the order of identifiers.
    new: Vec<u32>,
    /// The last time between two frames, and the smoothing gain for it.
    smoothing: (f32, f32),
}

/// A cluster and its identifier.
#[derive(Clone, Copy, Debug)]
struct Named {
    id: ContactId,
    force: f32,
    centroid: Vec2,
    velocity: Vec2,
    covariance: Covariance,
    quality: Quality,
    /// The clusters of the last frame that contained its tiles.
    before: Before,
    /// The cluster of the next frame that keeps the identifier.
    successor: u32,
    /// Force of the cluster being identified on this one's tiles.
    claim: f32,
}

/// The clusters of the last frame that contained a cluster's tiles.
#[derive(Clone, Copy, Debug)]
enum Before {
    Nothing,
    One(u32),
    Several,
}

impl Eq4 {
    pub(in crate::sense) fn new(tiles: usize, uncertainty: SensorUncertainty) -> Self {
        let room = tiles.min(1024);
        Self {
            uncertainty,
            next: 1,
            last: Vec::with_capacity(room),
            now: Vec::with_capacity(room),
            loads: Vec::with_capacity(tiles.min(4096)),
            by_force: Vec::with_capacity(room),
            by_name: Vec::with_capacity(room),
            new: Vec::with_capacity(room),
            smoothing: (0.0, 0.0),
        }
    }

    /// Fills `pool` with this frame's contacts; `dt` seconds have passed since the last frame.
    pub(in crate::sense) fn update(
        &mut self,
        tiles: &LoadedTiles,
        clusters: &Clusters,
        dt: f32,
        pool: &mut ContactPool,
    ) {
        if self.smoothing.0 != dt {
            self.smoothing = (dt, smoothing(dt));
        }
        std::mem::swap(&mut self.last, &mut self.now);
        self.weigh(tiles, clusters);
        self.name(tiles, clusters, dt);
        self.put_in_order();
        pool.clear();
        for &cluster in &self.by_name {
            let named = &self.now[cluster as usize];
            let loads = clusters.span(cluster as usize).and_then(|span| self.loads.get(span));
            named.describe(loads.unwrap_or_default(), pool.add(named.id));
        }
    }

    /// Applies Eq. 4 to every cluster.
    fn weigh(&mut self, tiles: &LoadedTiles, clusters: &Clusters) {
        self.now.clear();
        self.loads.clear();
        for members in clusters.iter() {
            let members = members.iter().map(|&member| (member, &tiles.list()[member as usize]));
            let (mut force, mut weight) = (0.0, 0.0);
            let mut sum = Vec2::ZERO;
            let mut before = Before::Nothing;
            for (member, tile) in members.clone() {
                before = before.and(clusters.of_last(tiles.before()[member as usize]));
                let weighed = tile.weight();
                force += tile.wrench.force;
                weight += weighed;
                sum += tile.centroid * weighed;
            }
            let centroid = sum / weight;
            let mut covariance = Covariance::default();
            let mut quality = Quality::Live;
            for (_, tile) in members {
                self.loads.push(TileLoad {
                    tile: tile.tile,
                    index: tile.index as usize,
                    force: Newtons(tile.wrench.force),
                    centroid: tile.centroid,
                });
                quality = quality.max(tile.quality);
                covariance += self.uncertainty.covariance(tiles.geometry(), tile, 1.0, centroid, force);
            }
            self.now.push(Named {
                id: ContactId(0),
                force,
                centroid,
                velocity: Vec2::ZERO,
                covariance,
                quality,
                before,
                successor: NONE,
                claim: 0.0,
            });
        }
    }

    /// Assigns an identifier to every cluster, heavier ones first.
    fn name(&mut self, tiles: &LoadedTiles, clusters: &Clusters, dt: f32) {
        self.new.clear();
        self.by_force.clear();
        // Positive forces sort like their bits.
        let key =
            |(cluster, named): (u32, &Named)| u64::from(!named.force.to_bits()) << 32 | u64::from(cluster);
        self.by_force.extend((0..).zip(&self.now).map(key));
        self.by_force.sort_unstable();
        for rank in 0..self.by_force.len() {
            let cluster = self.by_force[rank] as u32;
            let past = self.recognise(tiles, clusters, cluster);
            let named = &mut self.now[cluster as usize];
            let Some(past) = past else {
                named.id = ContactId(self.next);
                self.next = self.next.wrapping_add(1);
                self.new.push(cluster);
                continue;
            };
            let past = &mut self.last[past as usize];
            past.successor = cluster;
            named.id = past.id;
            named.velocity = past.velocity;
            if dt > 0.0 {
                let moved = (named.centroid - past.centroid) / dt.max(1e-6);
                named.velocity += (moved - past.velocity) * self.smoothing.1;
            }
        }
    }

    /// The contact of the last frame that continues as this cluster.
    fn recognise(&mut self, tiles: &LoadedTiles, clusters: &Clusters, cluster: u32) -> Option<u32> {
        let Named { before, centroid, .. } = self.now[cluster as usize];
        let best = match before {
            Before::Nothing => None,
            Before::One(past) => (self.last[past as usize].successor == NONE).then_some(past),
            Before::Several => self.strongest_claim(tiles, clusters, cluster),
        };
        best.or_else(|| self.nearest(centroid))
    }

    /// The contact with most of this cluster's force among those that share tiles with it.
    #[cold]
    fn strongest_claim(&mut self, tiles: &LoadedTiles, clusters: &Clusters, cluster: u32) -> Option<u32> {
        let members = clusters.get(cluster as usize).unwrap_or_default();
        let past = |member: u32| clusters.of_last(tiles.before()[member as usize]);
        let mut best: Option<u32> = None;
        for &member in members {
            let Some(past) = past(member) else { continue };
            if self.last[past as usize].successor != NONE {
                continue;
            }
            self.last[past as usize].claim += tiles.list()[member as usize].wrench.force;
            let claim = self.last[past as usize].claim;
            if best.is_none_or(|best| claim > self.last[best as usize].claim) {
                best = Some(past);
            }
        }
        for past in members.iter().filter_map(|&member| past(member)) {
            self.last[past as usize].claim = 0.0;
        }
        best
    }

    /// The contact nearest to a point, if it is near: a point load may move from one tile to the next between two
    /// frames.
    #[cold]
    fn nearest(&self, point: Vec2) -> Option<u32> {
        let away = |past: &Named| past.centroid.distance(point);
        let left = (0..).zip(&self.last).filter(|(_, past)| past.successor == NONE && away(past) <= JUMP_M);
        // At equal distance, the heavier one.
        let nearer = |a: &Named, b: &Named| away(a).total_cmp(&away(b)).then(b.force.total_cmp(&a.force));
        left.min_by(|(_, a), (_, b)| nearer(a, b)).map(|(past, _)| past)
    }

    /// Orders clusters by identifier: continuing ones are in order, new identifiers are higher.
    fn put_in_order(&mut self) {
        let Self { last, now, by_name, new, .. } = self;
        by_name.retain_mut(|cluster| {
            *cluster = last[*cluster as usize].successor;
            *cluster != NONE
        });
        by_name.extend_from_slice(new);
        // Identifiers wrap after four billion. Sorting an ordered list takes a single pass.
        by_name.sort_unstable_by_key(|&cluster| now[cluster as usize].id);
    }
}

impl Named {
    /// Fills `contact`; `loads` are those of its tiles.
    fn describe(&self, loads: &[TileLoad], contact: &mut Contact) {
        contact.centroid = self.centroid;
        contact.force = Newtons(self.force);
        contact.velocity = self.velocity;
        contact.covariance = self.covariance;
        contact.quality = self.quality;
        contact.tiles.extend_from_slice(loads);
        contact.finish();
    }
}

impl Before {
    /// Adds one tile, which belonged to `cluster`.
    fn and(self, cluster: Option<u32>) -> Self {
        match (self, cluster) {
            (_, None) => self,
            (Self::Nothing, Some(cluster)) => Self::One(cluster),
            (Self::One(one), Some(cluster)) if one == cluster => self,
            _ => Self::Several,
        }
    }
}

/// Gain of a new velocity, 1 − exp(−dt/τ): a first-order low-pass with τ = 25 ms.
pub(in crate::sense) fn smoothing(dt: f32) -> f32 {
    1.0 - (-dt / 0.025).exp()
}
