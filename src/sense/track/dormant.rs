//! Feet that have lost their load but may still be there.
//!
//! The heavier of two close feet explains all of the load as soon as the other one carries little. The lighter one
//! then becomes dormant: it keeps its identity and its place as an ambiguous contact, and leaves the estimation. It
//! becomes active again when the common centre of pressure moves towards it. It ends when that centre moves
//! elsewhere, when another foot lands, or after [`MOST_S`].

use super::params::dormant::{ASIDE_M, AWAY_M, ENOUGH_S, MOST_S, OPEN, SAME_M, SLEEPS, WAKES};
use super::params::tracker::STRIDE_M;
use glam::DVec2;

use super::Tracker;
use super::explanation::Spread;
use super::state::{FORCE, Track};
use super::strips::Strips;
use super::touchdown::Touchdown;
use crate::sense::contact::ContactId;
use crate::sense::loaded::LoadedTiles;

/// A foot that has lost its load to another one.
#[derive(Clone, Debug)]
pub(super) struct Dormant {
    pub foot: Track,
    /// The foot that carries its load, and the place of that foot before.
    pub existing: ContactId,
    from: DVec2,
    age: f64,
}

impl Tracker {
    /// Makes feet dormant that are not needed to explain the loads of their tiles.
    pub(super) fn let_sleep(&mut self, tiles: &LoadedTiles, dt: f64) {
        for which in 0..self.tracks.len() {
            let foot = &self.tracks[which];
            let Some((existing, strips)) = self.enough_without(foot, tiles) else {
                if foot.doubt.enough_s != 0.0 {
                    self.tracks[which].doubt.enough_s = 0.0;
                }
                continue;
            };
            let foot = &mut self.tracks[which];
            foot.doubt.enough_s += dt;
            if foot.doubt.enough_s < ENOUGH_S {
                continue;
            }
            let mut foot = Track::clone(&self.tracks[which]);
            let existing = &mut self.tracks[existing];
            foot.doubt.enough_s = 0.0;
            let from = existing.centre();
            existing.inherit(&std::mem::take(&mut foot.tiles));
            existing.stand(strips.force, strips.middle);
            existing.suppress_births();
            existing.company.shared = false;
            existing.restart_smoothing();
            (existing.stillness.anchor, existing.stillness.anchored_s, existing.stillness.astray_s) =
                (existing.centre(), 0.0, 0.0);
            self.dormant.push(Dormant { existing: existing.id, from, foot, age: 0.0 });
            self.tracks.remove(which);
            break;
        }
    }

    /// The single foot that explains the tiles it shares with `foot`, if `foot` carries little.
    fn enough_without(&self, foot: &Track, tiles: &LoadedTiles) -> Option<(usize, Strips)> {
        if !foot.company.shared {
            return None;
        }
        let mut mates = self.mates.of(foot.company.group).filter(|&mate| self.tracks[mate].id != foot.id);
        let (Some(existing), None) = (mates.next(), mates.next()) else { return None };
        let other = &self.tracks[existing];
        if foot.force() > SLEEPS * (foot.force() + other.force())
            || foot.age < other.age && foot.step.peak < 2.0 * foot.force()
        {
            return None;
        }
        let both = foot.tiles_with(other);
        let list = tiles.list();
        let strips = Strips::of(both.iter().map(|&position| &list[position as usize]), self.cells.pitch);
        let spread = Spread::of(both.iter().map(|&position| &list[position as usize]), strips.middle);
        (spread.evidence() < OPEN).then_some((existing, strips))
    }

    /// Reactivates feet that carry load again, and removes those that have left.
    pub(super) fn wake(&mut self, tiles: &LoadedTiles, dt: f64) {
        let mut at = 0;
        while at < self.dormant.len() {
            let dormant = &mut self.dormant[at];
            dormant.age += dt;
            let existing = self.tracks.iter().position(|foot| foot.id == dormant.existing);
            let Some(existing) =
                existing.filter(|&existing| !self.tracks[existing].company.shared && dormant.age < MOST_S)
            else {
                self.dormant.swap_remove(at);
                continue;
            };
            let all = self.tracks[existing].force();
            if self.stands_on_nothing(&self.dormant[at].foot, tiles, all) {
                self.dormant.swap_remove(at);
                continue;
            }
            let dormant = &self.dormant[at];
            let side = dormant.foot.centre() - dormant.from;
            let moved = self.tracks[existing].centre() - dormant.from;
            let share = moved.dot(side) / side.length_squared();
            let aside = side.perp_dot(moved).abs() / side.length();
            if aside > ASIDE_M || share * side.length() < -AWAY_M {
                self.dormant.swap_remove(at);
                continue;
            }
            if share < WAKES {
                at += 1;
                continue;
            }
            let Dormant { mut foot, from, .. } = self.dormant.swap_remove(at);
            let all = self.tracks[existing].force();
            foot.rest_again(share * all);
            foot.arrivals.touchdown = Some(Touchdown { existing: self.tracks[existing].id, from });
            foot.age = 0.0;
            let other = &mut self.tracks[existing];
            other.rest_at((1.0 - share) * all, from);
            foot.reach(tiles, &self.cells);
            if foot.tiles.is_empty() {
                foot.tiles.extend_from_slice(&self.tracks[existing].tiles);
            }
            self.near.moved(existing, from);
            self.near.add(&foot);
            self.tracks.push(foot);
        }
    }

    /// The identity of a foot that lands at `place`: that of a dormant foot there, or a new one. Removes other
    /// dormant feet within a stride, since a person has two feet.
    pub(super) fn identity(&mut self, place: DVec2) -> ContactId {
        let mut found = None;
        self.dormant.retain(|dormant| {
            let distance = dormant.foot.centre().distance(place);
            if found.is_none() && distance < SAME_M {
                found = Some(dormant.foot.id);
            }
            distance > STRIDE_M
        });
        found.unwrap_or_else(|| self.name())
    }
}

impl Track {
    /// Carries load again in its old place.
    fn rest_again(&mut self, force: f64) {
        let place = self.centre();
        self.rest_at(force, place);
        self.covariance[FORCE][FORCE] = (0.3 * force + 5.0).powi(2);
        self.restart_smoothing();
        self.empty_s = 0.0;
    }

    /// Sets the foot to `place`, beside another foot.
    pub(super) fn rest_at(&mut self, force: f64, place: DVec2) {
        self.stand(force, place);
        self.reset_covariance(0.02);
        self.covariance[FORCE][FORCE] = (0.2 * force + 5.0).powi(2);
    }
}
