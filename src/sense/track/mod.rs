//! Several feet followed through time, also where they share tiles.
//!
//! A track is one foot: force, centre of pressure, their rates, and the half widths of a patch around that centre.
//! Each frame goes through the same steps:
//!
//! 1. **Predict and associate** ([`associate`]): a tile belongs to the tracks whose patch reaches it, or to one
//!    whose shoe has room for it ([`outline`], [`reach`]). A load that no shoe covers becomes a track once
//!    that is sure.
//! 2. **Initiate** ([`initiate`], [`explanation`]): a track that is alone on its tiles is explained by one foot or
//!    by two; a second track begins when two are likely enough to pay for the risk, and the data say where.
//! 3. **Estimate**: a track that is alone is measured by Eq. 4. Tracks that share tiles are estimated together
//!    by an extended Kalman filter ([`joint`], [`model`]) that predicts the force and both moments of each column and
//!    row of tiles ([`strips`]). A foot put down beside a standing one is placed by the likelihood of each
//!    distance ([`touchdown`]).
//! 4. **Delete or rest** ([`delete`], [`dormant`]): a foot whose place is proven empty is gone; one that carries so
//!    little that the other one explains all of it keeps its identity, marked, until its weight comes back or
//!    it is proven to have left.
//! 5. **Output** ([`output`]): contacts with their ellipses, as wide as what is not known.
//!
//! All numbers stand in [`params`], with their units and sources.

mod associate;
mod delete;
mod dormant;
mod explanation;
mod initiate;
mod joint;
mod model;
mod neighbours;
mod outline;
mod output;
mod params;
mod patch;
mod reach;
mod residual;
mod smoothed;
mod state;
mod stillness;
mod strips;
#[cfg(test)]
mod tests;
mod touchdown;

use self::params::tracker::{
    FIRST_STEP_M, LANDING_S, MOST_MORE_N, MOST_SHARE, NIS_S, SEEN_S, STRIDE_M, THROWN_M,
};
use glam::{DVec2, IVec2};

use self::joint::{Joint, MOST_FEET};
use self::model::{observe, predict};
use self::neighbours::{Groups, Near};
use self::smoothed::kept;
use self::state::{EAST, NORTH, STATES, Track};
use self::strips::{Axis, Strips, centroid_sigma};
use super::contact::ContactId;
use super::loaded::LoadedTiles;
use super::pool::ContactPool;
use super::tile::LoadedTile;
use super::uncertainty::SensorUncertainty;
use crate::floor::{Geometry, TileBlock, TileId};

/// Follows feet over one floor.
#[derive(Clone, Debug)]
pub(super) struct Tracker {
    uncertainty: SensorUncertainty,
    cells: Cells,
    next: u32,
    tracks: Vec<Track>,
    dormant: Vec<dormant::Dormant>,
    links: Vec<Link>,
    new_links: Vec<Link>,
    joint: Box<Joint>,
    /// Per loaded tile: the first foot that reaches it, or `UNASSIGNED`.
    owner: Vec<u32>,
    unassigned: Vec<u32>,
    pending: Vec<associate::Pending>,
    /// Orphans, each with a foot that had it in the last frame.
    previous_owners: Vec<(u32, u32)>,
    members: Vec<u32>,
    near: Near,
    mates: Groups,
}

const UNASSIGNED: u32 = u32::MAX;

/// The covariance between two feet that are estimated together.
#[derive(Clone, Copy, Debug)]
struct Link {
    first: ContactId,
    second: ContactId,
    cross: [[f64; STATES]; STATES],
}

/// The cells of the floor's tiles, without gaps between them.
#[derive(Clone, Copy, Debug)]
struct Cells {
    pitch: f64,
    block: TileBlock,
}

impl Cells {
    /// Whether the floor has a column or row of this number.
    fn have(&self, axis: Axis, number: i32) -> bool {
        let numbers = match axis {
            Axis::East => self.block.column_range(),
            Axis::North => self.block.row_range(),
        };
        (i32::from(numbers.start)..i32::from(numbers.end)).contains(&number)
    }

    /// South-west and north-east corner of the floor.
    fn bounds(&self) -> (DVec2, DVec2) {
        let TileId { column, row } = self.block.first;
        let corner = DVec2::new(column.into(), row.into());
        let size = DVec2::new(self.block.columns.into(), self.block.rows.into());
        (corner * self.pitch, (corner + size) * self.pitch)
    }

    fn of(&self, tile: &LoadedTile) -> (DVec2, DVec2) {
        let low = DVec2::new(tile.tile.column.into(), tile.tile.row.into()) * self.pitch;
        (low, low + self.pitch)
    }
}

/// Which of the cells of width `pitch` the place `along` is in, along one axis.
fn number_of(along: f64, pitch: f64) -> i32 {
    let number = along / pitch;
    // The floor of it, as every processor can round: a call for each would cost more than all else here.
    let towards_zero = number as i32;
    towards_zero.saturating_sub(i32::from(f64::from(towards_zero) > number))
}

/// The same, along both axes.
fn cell_of(place: DVec2, pitch: f64) -> IVec2 {
    IVec2::new(number_of(place.x, pitch), number_of(place.y, pitch))
}

/// Orders by the first number, and what is equal by who came first.
fn first_of_least(a: &(f64, usize), b: &(f64, usize)) -> std::cmp::Ordering {
    a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
}

impl Tracker {
    pub(super) fn new(geometry: &Geometry, uncertainty: SensorUncertainty) -> Self {
        let room = geometry.tile_count().min(1024);
        let cells = Cells { pitch: geometry.pitch_m().into(), block: geometry.block() };
        Self {
            uncertainty,
            near: Near::new(&cells, room),
            mates: Groups::new(room),
            cells,
            next: 1,
            tracks: Vec::with_capacity(room),
            dormant: Vec::with_capacity(room),
            links: Vec::with_capacity(room),
            new_links: Vec::with_capacity(room),
            joint: Box::new(Joint::new()),
            owner: Vec::with_capacity(room),
            unassigned: Vec::with_capacity(room),
            pending: Vec::with_capacity(room),
            previous_owners: Vec::with_capacity(room),
            members: Vec::with_capacity(room),
        }
    }

    /// Fills `pool` with this frame's contacts; `dt` seconds have passed since the last frame.
    pub(super) fn update(&mut self, tiles: &LoadedTiles, dt: f32, pool: &mut ContactPool) {
        let dt = f64::from(dt);
        for foot in &mut self.tracks {
            foot.predict(dt);
            foot.reach(tiles, self.cells.pitch);
        }
        self.near.renew(self.tracks.iter().map(Track::centre));
        self.associate(tiles, dt);
        self.forget_pending();
        self.wake(tiles, dt);
        self.initiate(tiles, dt);
        self.note_partners();
        self.keep_noticed_tiles(tiles);
        self.tracks.retain(|foot| !foot.tiles.is_empty());
        self.group(tiles.list().len());
        self.estimate(tiles, dt);
        self.delete_empty(tiles, dt);
        self.let_sleep(tiles, dt);
        self.learn(tiles, dt);
        self.describe(tiles, pool);
    }

    /// Lets each foot remember where others near it are.
    fn note_partners(&mut self) {
        for which in 0..self.tracks.len() {
            let here = self.tracks[which].centre();
            let others = self.near.distances(here).filter(|&(distance, other)| {
                distance < STRIDE_M && other != which && self.tracks[other].age > SEEN_S
            });
            let nearest = others.min_by(first_of_least);
            if let Some((_, other)) = nearest {
                if self.tracks[which].age < LANDING_S {
                    self.tracks[which].body_n = self.tracks[other].body_of_owner();
                }
                self.tracks[which].partner = Some((self.tracks[other].centre(), 0.0));
                self.tracks[which].accompanied = true;
            }
        }
    }

    fn name(&mut self) -> ContactId {
        let id = ContactId(self.next);
        self.next = self.next.wrapping_add(1);
        id
    }

    /// Numbers the groups of feet that share tiles: each foot's group is its first member's number.
    fn group(&mut self, tiles: usize) {
        self.owner.clear();
        self.owner.resize(tiles, UNASSIGNED);
        self.mates.part(self.tracks.len());
        for which in 0..self.tracks.len() {
            self.tracks[which].group = which as u32;
            self.tracks[which].crowded = false;
            for at in 0..self.tracks[which].tiles.len() {
                let position = self.tracks[which].tiles[at] as usize;
                let owner = self.owner[position];
                if owner == UNASSIGNED {
                    self.owner[position] = which as u32;
                    continue;
                }
                let (mine, theirs) = (self.tracks[which].group, self.tracks[owner as usize].group);
                if mine != theirs {
                    let (keep, drop) = (mine.min(theirs), mine.max(theirs));
                    for mate in self.mates.of(drop) {
                        self.tracks[mate].group = keep;
                    }
                    self.mates.unite(keep, drop);
                    self.tracks[keep as usize].crowded = true;
                }
            }
        }
        self.renew_groups(self.tracks.len());
    }

    /// Takes down who belongs to which group; groups are numbered below `groups`.
    fn renew_groups(&mut self, groups: usize) {
        self.mates.renew(self.tracks.iter().map(|foot| foot.group), groups);
    }

    /// Measures feet that are alone on their tiles, estimates those that are not.
    fn estimate(&mut self, tiles: &LoadedTiles, dt: f64) {
        self.new_links.clear();
        for which in 0..self.tracks.len() {
            if self.tracks[which].group != which as u32 {
                continue;
            }
            if !self.tracks[which].crowded {
                let foot = &mut self.tracks[which];
                let before = foot.centre();
                let until_now = std::mem::replace(&mut foot.shared, false);
                foot.alone(tiles.list(), dt);
                let quality_changed = std::mem::take(&mut foot.quality_changed);
                if until_now || quality_changed {
                    foot.restart_smoothing();
                    (foot.anchor, foot.anchored_s, foot.astray_s) = (foot.centre(), 0.0, 0.0);
                }
                if quality_changed {
                    // Still it stands where it stood, only seen otherwise.
                    foot.rest_point = if foot.suppressed_s > 0.0 {
                        foot.centre()
                    } else {
                        foot.rest_point + foot.centre() - before
                    };
                }
                continue;
            }
            self.members.clear();
            for other in self.mates.of(which as u32) {
                let foot = &mut self.tracks[other];
                if !foot.shared {
                    foot.keep_shape();
                }
                foot.shared = true;
                // More feet than one filter holds: the rest go on as predicted, as guesses.
                foot.beyond_filter = self.members.len() >= MOST_FEET;
                if !foot.beyond_filter {
                    self.members.push(other as u32);
                }
            }
            if !self.place_touchdown(tiles.list()) {
                self.estimate_together(tiles, dt);
            }
        }
        std::mem::swap(&mut self.links, &mut self.new_links);
    }

    /// Places a foot that was put down beside a standing one; false if there is none, or nothing to be said.
    fn place_touchdown(&mut self, list: &[LoadedTile]) -> bool {
        let &[a, b] = self.members.as_slice() else { return false };
        let Some((before, after)) = self.tracks.split_at_mut_checked(b as usize) else { return false };
        let (Some(first), Some(second)) = (before.get_mut(a as usize), after.first_mut()) else {
            return false;
        };
        let (existing, stepping) = if second.has_landed_beside(first) {
            (first, second)
        } else if first.has_landed_beside(second) {
            (second, first)
        } else {
            return false;
        };
        let Some(touchdown) = stepping.touchdown else { return false };
        let both = existing.tiles_with(stepping);
        let strips = Strips::of(both.iter().map(|&position| &list[position as usize]), self.cells.pitch);
        let sigma = centroid_sigma(
            both.iter().map(|&position| &list[position as usize]),
            strips.force,
            self.cells.pitch,
        );
        // Where what the filter says of both has not fitted for some time, they are looked for anew.
        if !existing.ambiguous
            && touchdown::is_seen_alone(existing, stepping, touchdown.from, &strips, sigma, list, &self.cells)
        {
            existing.hold_at(touchdown.from);
            return false;
        }
        touchdown::place(existing, stepping, touchdown.from, strips, sigma, &self.cells)
    }

    /// One step of the joint filter over the feet in `members`.
    fn estimate_together(&mut self, tiles: &LoadedTiles, dt: f64) {
        let members = &self.members;
        let list = tiles.list();
        let joint = &mut self.joint;
        joint.clear();
        for &member in members {
            joint.add(&self.tracks[member as usize]);
        }
        for (first, &a) in members.iter().enumerate() {
            for (second, &b) in members.iter().enumerate().skip(first + 1) {
                let (a, b) = (&self.tracks[a as usize], &self.tracks[b as usize]);
                let links = self.links.get(a.links_from..).unwrap_or_default();
                let mut links = links.iter().take_while(|link| link.first == a.id);
                if let Some(link) = links.find(|link| link.second == b.id) {
                    joint.link(first, second, &link.cross);
                }
            }
        }
        predict(joint, members, &self.tracks, dt);
        joint.confine(self.cells.bounds());
        for (which, &member) in members.iter().enumerate() {
            joint.take(which, &mut self.tracks[member as usize]);
        }
        let (nis, force) = observe(joint, members, &self.tracks, list, &self.cells, dt);
        joint.confine(self.cells.bounds());
        let centre = |at: usize| DVec2::new(joint.x[at * STATES + EAST], joint.x[at * STATES + NORTH]);
        let mut new_track =
            members.iter().enumerate().map(|(which, &member)| (which, &self.tracks[member as usize]));
        let leaps =
            new_track.any(|(at, foot)| foot.age == 0.0 && centre(at).distance(foot.centre()) > FIRST_STEP_M);
        if leaps || !joint.forces().all(|part| part < MOST_SHARE * force + MOST_MORE_N) {
            // A step so large that derivatives mean nothing: all stay where they were predicted, with a wide
            // covariance.
            for &member in members {
                self.tracks[member as usize].reset_covariance(THROWN_M);
            }
            return;
        }
        let weight = 1.0 - (-dt / NIS_S).exp();
        for (which, &member) in members.iter().enumerate() {
            let foot = &mut self.tracks[member as usize];
            joint.take(which, foot);
            foot.nis += weight * (nis - foot.nis);
        }
        for (first, &a) in members.iter().enumerate() {
            self.tracks[a as usize].links_from = self.new_links.len();
            for (second, &b) in members.iter().enumerate().skip(first + 1) {
                self.new_links.push(Link {
                    first: self.tracks[a as usize].id,
                    second: self.tracks[b as usize].id,
                    cross: joint.cross(first, second),
                });
            }
        }
    }

    /// Lets each foot's slow past learn from this frame.
    fn learn(&mut self, tiles: &LoadedTiles, dt: f64) {
        let list = tiles.list();
        let keep = kept(dt);
        for foot in &mut self.tracks {
            foot.smooth(dt, keep);
            foot.roll(dt);
            foot.note_outline(list, dt);
            if !foot.shared {
                foot.learn_residuals(list, self.cells.pitch, dt);
            }
            // A foot that has just come to stand alone starts from what is measured.
            let fresh = !foot.shared && foot.smoothed.loads.is_empty();
            let weight = if fresh && foot.age > 0.0 { 1.0 } else { 1.0 - keep };
            for at in 0..foot.tiles.len() {
                let tile = &list[foot.tiles[at] as usize];
                let (force, moment) = if foot.shared {
                    let on = foot.on(self.cells.of(tile));
                    (on.share() * foot.force(), on.moment() * foot.force())
                } else {
                    let force = f64::from(tile.wrench.force);
                    (force, (tile.centroid - tile.centre).as_dvec2() * force)
                };
                foot.learn_load(tile.index, force, moment, weight);
            }
            foot.forget_loads();
        }
    }
}
