//! Feet that land where others already stand.

use glam::DVec2;
use smallvec::SmallVec;

use super::foot::{FORCE, Foot, LANDS_S};
use super::landing::Landing;
use super::lines::Whole;
use super::{STRIDE_M, Tracker, first_of_least};
use crate::sense::loaded::LoadedTiles;
use crate::sense::tile::LoadedTile;

/// Least distance between the centres of pressure of two feet: side by side, touching.
pub(super) const APART_M: f64 = 0.08;

/// Load that a tile must gain to show a newcomer, in newtons.
const ADDED_N: f64 = 10.0;

/// How far, in metres, and how fast, in metres per second, weight that is shifted to another foot moves the
/// common centre of pressure at least.
const SHIFT_M: f64 = 0.03;
const SHIFT_M_S: f64 = 0.25;

/// How much of what saturated sensors leave open changes while weight goes over: mostly the same ones stay at the end
/// of their range (our choice).
const SLOWLY: f64 = 0.5;

/// Least force, in newtons, that shows by where it acts that a newcomer has part in it.
const LEAST_N: f64 = 120.0;

/// Share of the most it has pressed with below which a foot is leaving: its centre of pressure runs to the tip of its
/// toes, faster than any newcomer draws it.
const LEAVING: f64 = 0.3;

/// Least leap of the common centre of pressure that shows a newcomer, in metres, and how long a foot must have been
/// down for it, in seconds: its heel has struck.
const LEAP_M: f64 = 0.02;
const ROLLS_ON_S: f64 = 0.12;

/// How well the place of a newcomer is guessed that no tile shows by itself, as a standard deviation in metres.
const GUESSED_M: f64 = 0.08;

/// How far from the foot a newcomer may lie that is seen by its leap alone, in metres: as far as the tiles that both
/// press allow.
const LEAPS_M: [f64; 3] = [0.45, 0.35, 0.25];

/// How far beside those tiles its centre may be guessed to lie, in metres.
const BESIDE_TILE_M: f64 = 0.05;

/// Distance between two feet that stand, before anything is known of it, in metres.
const STANCE_M: f64 = 0.2;

/// A foot that has just landed among another's tiles.
#[derive(Clone, Debug, Default)]
struct Newcomer {
    force: f64,
    place: DVec2,
    deviation: f64,
    /// Positions of the tiles on which it was noticed, in the list of loaded tiles.
    tiles: SmallVec<[u32; 4]>,
}

impl Tracker {
    /// Lets feet land on tiles that others already press.
    pub(super) fn find_newcomers(&mut self, tiles: &LoadedTiles) {
        let list = tiles.list();
        for which in 0..self.feet.len() {
            let foot = &self.feet[which];
            if foot.age <= LANDS_S || foot.shared {
                continue;
            }
            // A sensor that is no longer believed moves what its tile says: that is nobody's doing.
            let quality = foot.tiles.iter().map(|&position| list[position as usize].quality).max();
            if quality.is_some_and(|quality| quality != foot.quality) {
                // A sensor that is lost or found goes over to what the others say little by little.
                let lasts = foot.tiles.iter().any(|&position| !list[position as usize].is_settled());
                self.feet[which].startle(quality.unwrap_or_default(), lasts);
                continue;
            }
            let Some(newcomer) = self.newcomer(foot, list) else { continue };
            // Whose foot it may be more of has its centre of pressure within a stride.
            let others = self.near.around(newcomer.place).filter(|&other| other != which);
            let nearest = others
                .map(|other| (self.feet[other].centre().distance(newcomer.place), other))
                .filter(|&(distance, other)| {
                    let foot = &self.feet[other];
                    let beyond = foot.beyond(newcomer.place).min(foot.lands_about(newcomer.place));
                    beyond < 0.0 || distance < APART_M
                })
                .min_by(first_of_least);
            if let Some((_, other)) = nearest {
                // Not a newcomer, but more of a foot that is already there.
                let known = &mut self.feet[other];
                for &position in &newcomer.tiles {
                    if !known.tiles.contains(&position) {
                        known.tiles.push(position);
                    }
                }
                continue;
            }
            if foot.centre().distance(newcomer.place) < APART_M {
                continue;
            }
            let landing = foot.lingers().then_some(Landing { host: foot.id, from: foot.home });
            let mut newborn = Foot::new(self.name(), newcomer.force, newcomer.place, newcomer.deviation);
            newborn.covariance[FORCE][FORCE] = (0.3 * newcomer.force + 5.0).powi(2);
            newborn.covariance[FORCE + 1][FORCE + 1] = 8000.0_f64.powi(2);
            newborn.landing = landing;
            newborn.reach(tiles, self.cells.pitch);
            for &position in &newcomer.tiles {
                if !newborn.tiles.contains(&position) {
                    newborn.tiles.push(position);
                }
            }
            if !newborn.tiles.is_empty() {
                self.feet[which].step_back();
                self.near.moved(which, self.feet[which].centre());
                self.near.add(newborn.centre());
                self.feet.push(newborn);
            }
        }
    }

    /// Whether nobody else is within a stride: no partner that is down already, however lately.
    fn is_far_from_all(&self, foot: &Foot) -> bool {
        let place = foot.centre();
        let mut others =
            self.near.around(place).map(|other| &self.feet[other]).filter(|other| other.id != foot.id);
        others.all(|other| other.centre().distance(place) > STRIDE_M)
    }

    /// The foot that has landed among the tiles of `foot`, if one has.
    fn newcomer(&self, foot: &Foot, list: &[LoadedTile]) -> Option<Newcomer> {
        let tiles = foot.tiles.iter().map(|&position| &list[position as usize]);
        let seen = Whole::of(tiles, self.cells.pitch);
        self.added(foot, list).or_else(|| self.shifted(foot, &seen)).or_else(|| self.leapt(foot, list, &seen))
    }

    /// A newcomer whose load has been added to tiles, where the foot itself cannot have put it.
    fn added(&self, foot: &Foot, list: &[LoadedTile]) -> Option<Newcomer> {
        let mut found = Newcomer::default();
        for &position in &foot.tiles {
            let tile = &list[position as usize];
            let force = f64::from(tile.wrench.force);
            let slow = foot.slow_load(tile.index);
            let centre = tile.centre.as_dvec2();
            let added = force - slow.force;
            if added < ADDED_N {
                continue;
            }
            let moment = (tile.centroid.as_dvec2() - centre) * force - slow.moment;
            // Moment of what was added about the foot's own centre of pressure.
            let about = moment + (centre - foot.past.centre) * added;
            let place = centre + moment / added;
            let (low, high) = self.cells.of(tile);
            let inside = place.cmpge(low - 0.02).all() && place.cmple(high + 0.02).all();
            // What the foot's own sway may look like, at its own centre of pressure.
            let sway = slow.force * 0.012;
            if inside && about.length() > added * 0.08 + sway && foot.beyond(place) > sway / added {
                found.place =
                    (found.place * found.force + place.clamp(low, high) * added) / (found.force + added);
                found.force += added;
                found.deviation = found.deviation.max(0.02 + (slow.force * 0.006 / added).min(0.1));
                found.tiles.push(position);
            }
        }
        (found.force > 0.0).then_some(found)
    }

    /// A newcomer to whom weight is shifted little by little: a foot that stood still does not begin to roll as fast,
    /// nor to the side, and none that bears its weight moves as fast as weight goes over.
    fn shifted(&self, foot: &Foot, seen: &Whole) -> Option<Newcomer> {
        let shift = seen.middle - foot.home;
        if foot.unsettled > 0.0
            || seen.force < LEAST_N
            || shift.length() < SHIFT_M + SLOWLY * seen.doubt
            || !(foot.stands() || foot.is_rushed())
        {
            return None;
        }
        let drawn = foot.is_drawn(shift, SHIFT_M) && self.is_far_from_all(foot);
        let hasty = foot.may_have_partner_towards(shift) && shift.length() > SHIFT_M_S * foot.away;
        (foot.is_rushed() || drawn || hasty).then(|| Newcomer {
            force: seen.force * shift.length() / STANCE_M,
            place: foot.home + shift.normalize() * STANCE_M,
            deviation: GUESSED_M,
            ..Newcomer::default()
        })
    }

    /// A newcomer that makes the common centre of pressure leap.
    fn leapt(&self, foot: &Foot, list: &[LoadedTile], seen: &Whole) -> Option<Newcomer> {
        let leap = seen.middle - foot.past.centre;
        if foot.age < ROLLS_ON_S
            || foot.calm > 0.0
            || seen.force < LEAST_N.max(LEAVING * foot.peak)
            || leap.length() < LEAP_M + seen.doubt
        {
            return None;
        }
        let moment = leap * seen.force;
        LEAPS_M.into_iter().find_map(|away| {
            let force = (seen.force - foot.past.force).max(moment.length() / away);
            let place = foot.past.centre + moment / force;
            let is_on = |tile: &LoadedTile| {
                let (low, high) = self.cells.of(tile);
                place.cmpge(low - BESIDE_TILE_M).all() && place.cmple(high + BESIDE_TILE_M).all()
            };
            let is_seen = foot.tiles.iter().any(|&position| is_on(&list[position as usize]));
            (force < seen.force && is_seen).then(|| Newcomer {
                force,
                place,
                deviation: GUESSED_M,
                ..Newcomer::default()
            })
        })
    }
}
