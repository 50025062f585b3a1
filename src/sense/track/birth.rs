//! Feet that land where others already stand.

use glam::DVec2;
use smallvec::SmallVec;

use super::explanation::Second;
use super::foot::{FORCE, Foot, LANDS_S};
use super::landing::Landing;
use super::lines::Whole;
use super::rest::{RESTLESS_M_S, STANDS_S};
use super::{STRIDE_M, Tracker, first_of_least};
use crate::sense::loaded::LoadedTiles;
use crate::sense::tile::LoadedTile;

/// Least distance between the centres of pressure of two feet: side by side, touching.
pub(super) const APART_M: f64 = 0.08;

/// Load that a tile must gain to show a newcomer, in newtons.
const ADDED_N: f64 = 10.0;

/// How well the place of a newcomer is guessed that no tile shows by itself, as a standard deviation in metres.
const GUESSED_M: f64 = 0.08;

/// Speed from which on a foot that nobody stands on may slide onto other tiles, in metres per second.
const SLIDES_M_S: f64 = 0.1;

/// How well the places of two feet are known that have landed together, in metres.
const APART_GUESS_M: f64 = 0.06;

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
    /// Force and place that are left to the track it is split from, where both are new.
    keeps: Option<(f64, DVec2)>,
}

impl Tracker {
    /// Lets feet land on tiles that others already press.
    pub(super) fn find_newcomers(&mut self, tiles: &LoadedTiles, dt: f64) {
        let list = tiles.list();
        for which in 0..self.feet.len() {
            let foot = &self.feet[which];
            if foot.shared {
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
            let second = self.second(which, list, dt);
            let foot = &self.feet[which];
            let added = if foot.age > LANDS_S { self.added(foot, list) } else { None };
            let Some(newcomer) = added.or(second) else { continue };
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
            let stood = foot.anchored >= STANDS_S && foot.bears();
            let landing = (stood || foot.lingers())
                .then_some(Landing { host: foot.id, from: if stood { foot.anchor } else { foot.home } });
            let mut newborn =
                Foot::new(self.identity(newcomer.place), newcomer.force, newcomer.place, newcomer.deviation);
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
                if let Some((force, place)) = newcomer.keeps {
                    let foot = &mut self.feet[which];
                    foot.stand(force, place);
                    foot.be_sure(APART_GUESS_M);
                    foot.covariance[FORCE][FORCE] = (0.3 * force + 5.0).powi(2);
                    foot.start_over();
                    for foot in [foot, &mut newborn] {
                        foot.unparted = true;
                        foot.restless = RESTLESS_M_S;
                    }
                } else {
                    self.feet[which].step_back();
                }
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

    /// A newcomer whose load has been added to tiles, where the foot itself cannot have put it.
    fn added(&self, foot: &Foot, list: &[LoadedTile]) -> Option<Newcomer> {
        let mut found = Newcomer::default();
        if !foot.bears() && foot.velocity().length() > SLIDES_M_S {
            return None;
        }
        for &position in &foot.tiles {
            let tile = &list[position as usize];
            let force = f64::from(tile.wrench.force);
            let slow = foot.slow_load(tile.index);
            let centre = tile.centre.as_dvec2();
            let added = force - slow.force;
            let noise = f64::from(tile.noise_n);
            if added < ADDED_N + 8.0 * noise {
                continue;
            }
            let moment = (tile.centroid.as_dvec2() - centre) * force - slow.moment;
            // Moment of what was added about the foot's own centre of pressure.
            let about = moment + (centre - foot.past.centre) * added;
            let place = centre + moment / added;
            let (low, high) = self.cells.of(tile);
            let inside = place.cmpge(low - 0.02).all() && place.cmple(high + 0.02).all();
            // What the foot's own sway may look like, at its own centre of pressure.
            let sway = slow.force * 0.012 + 3.5 * super::adopt::NOISE_ARM_M * noise;
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

    /// A second foot that one track's load tells of: where it would be.
    fn second(&mut self, which: usize, list: &[LoadedTile], dt: f64) -> Option<Newcomer> {
        let foot = &self.feet[which];
        let seen = Whole::of(foot.tiles.iter().map(|&position| &list[position as usize]), self.cells.pitch);
        let alone = self.is_far_from_all(foot);
        let mut explanation = foot.explanation;
        let second = explanation.update(foot, &seen, list, alone, dt);
        self.feet[which].explanation = explanation;
        let foot = &self.feet[which];
        if foot.unsettled > 0.0 {
            return None;
        }
        match second? {
            Second::Shift(shift) => Some(Newcomer {
                force: seen.force * shift.length() / STANCE_M,
                place: foot.anchor + shift.normalize() * STANCE_M,
                deviation: GUESSED_M,
                ..Newcomer::default()
            }),
            Second::Apart(spread) => {
                // The lighter side is the new one.
                let mut sides = [(0.0, DVec2::ZERO); 2];
                for &position in &foot.tiles {
                    let tile = &list[position as usize];
                    let force = f64::from(tile.wrench.force);
                    let at = tile.centroid.as_dvec2();
                    let side = &mut sides[usize::from((at - seen.middle).dot(spread.axis) > 0.0)];
                    side.0 += force;
                    side.1 += at * force;
                }
                let centre = |side: usize| sides[side].1 / sides[side].0;
                let new =
                    if centre(0).distance(foot.landed) > centre(1).distance(foot.landed) { 0 } else { 1 };
                let (keep, place) = (centre(1 - new), centre(new));
                let mut newcomer =
                    Newcomer { force: sides[new].0, place, deviation: APART_GUESS_M, ..Newcomer::default() };
                newcomer.keeps = Some((sides[1 - new].0, keep));
                Some(newcomer)
            }
        }
    }
}
