//! Groups of feet that share tiles, each estimated separately.
//!
//! Two groups have no tile in common, so any order and any thread gives the same result.

use arrayvec::ArrayVec;
use glam::DVec2;

use super::elapsed::Elapsed;
use super::joint::{Joint, MOST_FEET};
use super::model::{observe, predict};
use super::params::tracker::{FIRST_STEP_M, MOST_MORE_N, MOST_SHARE, STRIDE_M, THROWN_M};
use super::state::{EAST, NORTH, STATES, Track};
use super::strips::{Strips, centroid_sigma};
use super::{Cells, Tracker, rivals, soles, stance, touchdown};
use crate::parallel;
use crate::sense::centroid::tile::LoadedTile;
use crate::sense::contact::ContactId;
use crate::sense::loaded::LoadedTiles;

/// Maximum number of batches of groups estimated in parallel: several for each of a few threads.
pub(super) const BATCHES: usize = 16;

/// Maximum number of groups divided into batches at once, which bounds the stack space.
const MOST_GROUPS: usize = 256;

/// Maximum number of groups of each batch whose rivals are compared in one frame (our choice): a comparison takes
/// as long as many steps of the filter. A group whose turn comes in a full frame waits for the next one.
const MOST_COMPARISONS: usize = 1;

/// The feet of a group, up to the capacity of one filter.
pub(super) type Group<'a> = ArrayVec<&'a mut Track, MOST_FEET>;

/// The joint filter for one batch of groups, and the covariances that it keeps for the next frame.
#[derive(Clone, Debug)]
pub(super) struct GroupEstimator {
    number: usize,
    joint: Box<Joint>,
    links: Vec<Link>,
}

/// The covariance between two feet that are estimated together.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link {
    first: ContactId,
    second: ContactId,
    cross: [[f64; STATES]; STATES],
}

impl Tracker {
    /// Estimates the feet of each group with several feet.
    pub(super) fn estimate_groups(&mut self, tiles: &LoadedTiles, elapsed: &Elapsed) {
        for estimator in &mut self.estimators {
            estimator.links.clear();
        }
        let count = self.number_groups();
        let feet = self.tracks.len();
        for first in (0..count).step_by(MOST_GROUPS) {
            let mut groups = ArrayVec::<Group<'_>, MOST_GROUPS>::new();
            groups.extend((first..count).take(MOST_GROUPS).map(|_| Group::new()));
            let (mut tracks, mut passed) = (self.tracks.iter_mut(), 0);
            for (&which, number) in self.members.iter().zip(&self.group_numbers) {
                let Some(foot) = tracks.nth((which - passed) as usize) else { break };
                passed = which + 1;
                let Some(group) = groups.get_mut(number.wrapping_sub(first) as usize) else { continue };
                if let Err(full) = group.try_push(foot) {
                    // More feet than one filter holds: the rest keep their predictions and become ambiguous.
                    full.element().join(true);
                }
            }
            let size = groups.len().div_ceil(BATCHES);
            let mut batches: ArrayVec<_, BATCHES> =
                self.estimators.iter_mut().zip(groups.chunks_mut(size)).collect();
            let (links, cells, near) = (&self.links, &self.cells, &self.near);
            let is_third =
                |place| near.distances(place).filter(|&(away, _)| away < STRIDE_M).take(3).count() > 2;
            parallel::for_each_batch(&mut batches, feet, |_, (estimator, groups)| {
                let mut comparisons = 0;
                for group in groups.iter_mut() {
                    group.iter_mut().for_each(|foot| foot.join(false));
                    if stance::place(group, tiles, cells, elapsed) {
                        continue;
                    }
                    if !place_touchdown(group, tiles.list(), cells) {
                        estimator.estimate(group, links, tiles.list(), cells, elapsed);
                    }
                    let has_time = comparisons < MOST_COMPARISONS;
                    let took_time = rivals::compare(group, tiles.list(), cells, elapsed, has_time)
                        | (has_time && soles::compare(group, tiles, cells, elapsed, is_third));
                    comparisons += usize::from(took_time);
                }
            });
        }
        for (estimator, links) in self.estimators.iter_mut().zip(&mut self.links) {
            std::mem::swap(&mut estimator.links, links);
        }
    }

    /// Numbers the groups with several feet in the order of their first members; returns their count.
    fn number_groups(&mut self) -> u32 {
        let mut count = 0;
        self.group_numbers.clear();
        for &which in &self.members {
            let first = self.tracks[which as usize].company.group;
            let known = if first == which { None } else { self.members.binary_search(&first).ok() };
            let number = known.map_or(count, |at| self.group_numbers[at]);
            count = count.max(number + 1);
            self.group_numbers.push(number);
        }
        count
    }
}

impl Track {
    /// Notes that it shares tiles with other feet.
    fn join(&mut self, beyond_filter: bool) {
        if !self.company.shared {
            self.keep_shape();
        }
        self.company.shared = true;
        self.company.beyond_filter = beyond_filter;
    }
}

/// Places a foot that was put down beside a standing one; returns false if there is none, or no estimate yet.
fn place_touchdown(group: &mut Group<'_>, list: &[LoadedTile], cells: &Cells) -> bool {
    let [first, second] = group.as_mut_slice() else { return false };
    let (existing, stepping) = if second.has_landed_beside(first) {
        (first, second)
    } else if first.has_landed_beside(second) {
        (second, first)
    } else {
        return false;
    };
    let Some(touchdown) = stepping.arrivals.touchdown else { return false };
    let both = existing.tiles_with(stepping);
    let tiles = both.iter().map(|&position| &list[position as usize]);
    let strips = Strips::of(tiles.clone(), cells.pitch);
    let sigma = centroid_sigma(tiles, strips.force, cells.side());
    // If the filter's estimate of both feet has not fitted for some time, the touchdown is estimated again.
    if !existing.doubt.ambiguous
        && touchdown::is_seen_alone(existing, stepping, touchdown.from, &strips, sigma, list, cells)
    {
        existing.hold_at(touchdown.from);
        return false;
    }
    touchdown::place(existing, stepping, touchdown.from, strips, sigma, cells)
}

impl GroupEstimator {
    pub(super) fn new(number: usize, room: usize) -> Self {
        Self { number, joint: Box::new(Joint::new()), links: Vec::with_capacity(room) }
    }

    /// Runs one step of the joint filter over the feet of `group`; `links` are the covariances of the last frame, one
    /// list per estimator.
    fn estimate(
        &mut self,
        group: &mut Group<'_>,
        links: &[Vec<Link>],
        list: &[LoadedTile],
        cells: &Cells,
        elapsed: &Elapsed,
    ) {
        let joint = &mut *self.joint;
        joint.clear();
        group.iter().for_each(|foot| joint.add(foot));
        for (first, a) in group.iter().enumerate() {
            let (estimator, from) = a.company.links_from;
            let links = links.get(estimator).and_then(|links| links.get(from..)).unwrap_or_default();
            for (second, b) in group.iter().enumerate().skip(first + 1) {
                let mut links = links.iter().take_while(|link| link.first == a.id);
                if let Some(link) = links.find(|link| link.second == b.id) {
                    joint.link(first, second, &link.cross);
                }
            }
        }
        predict(joint, group, elapsed);
        joint.confine(cells.bounds());
        for (which, foot) in group.iter_mut().enumerate() {
            joint.take(which, foot);
        }
        let (nis, force) = observe(joint, group, list, cells, elapsed.dt);
        joint.confine(cells.bounds());
        let centre = |at: usize| DVec2::new(joint.x[at * STATES + EAST], joint.x[at * STATES + NORTH]);
        let leaps = group
            .iter()
            .enumerate()
            .any(|(at, foot)| foot.age == 0.0 && centre(at).distance(foot.centre()) > FIRST_STEP_M);
        if leaps || !joint.forces().all(|part| part < MOST_SHARE * force + MOST_MORE_N) {
            // The step is too large for the linearisation: all feet keep their predictions, with a wide covariance.
            group.iter_mut().for_each(|foot| foot.reset_covariance(THROWN_M));
            return;
        }
        let weight = 1.0 - elapsed.nis;
        for (which, foot) in group.iter_mut().enumerate() {
            joint.take(which, foot);
            foot.doubt.nis += weight * (nis - foot.doubt.nis);
        }
        for first in 0..group.len() {
            group[first].company.links_from = (self.number, self.links.len());
            for second in first + 1..group.len() {
                self.links.push(Link {
                    first: group[first].id,
                    second: group[second].id,
                    cross: joint.cross(first, second),
                });
            }
        }
    }
}
