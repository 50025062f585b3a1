//! New feet on tiles that other feet already press.

use super::params::associate::NOISE_ARM_M;
use super::params::initiate::{ADDED_N, APART_GUESS_M, APART_M, GUESSED_M, SLIDES_M_S, STANCE_M};
use super::params::state::{FLAT_S, LANDS_S, LEAST_BODY_N};
use super::params::stillness::{SHARED_SPEED_M_S, STANDS_S};
use glam::DVec2;
use smallvec::SmallVec;

use super::elapsed::Elapsed;
use super::explanation::Second;
use super::neighbours::Near;
use super::outline::FanExtents;
use super::pair::{Fitted, Pair};
use super::sole::LoadsAround;
use super::stance::Stance;
use super::state::{FORCE, Track, body_n_of};
use super::strips::Whole;
use super::touchdown::Touchdown;
use super::{Cells, Tracker, first_of_least};
use crate::parallel;
use crate::sense::centroid::tile::LoadedTile;
use crate::sense::loaded::LoadedTiles;

/// A foot that has just landed among another's tiles.
#[derive(Clone, Debug, Default)]
pub(super) struct CandidateTrack {
    force: f64,
    place: DVec2,
    deviation: f64,
    /// Positions in the list of loaded tiles of the tiles on which it was noticed.
    tiles: SmallVec<[u32; 4]>,
    /// The foot that remains for the track from which it is split, if both are new.
    keeps: Option<KeptFoot>,
}

impl CandidateTrack {
    /// A foot of `force` newtons that has landed at `place`, known to `deviation` metres, on these of the loaded tiles.
    pub(super) fn found(force: f64, place: DVec2, deviation: f64, tiles: SmallVec<[u32; 4]>) -> Self {
        Self { force, place, deviation, tiles, keeps: None }
    }
}

/// One of two feet that have landed together.
#[derive(Clone, Copy, Debug)]
struct KeptFoot {
    force: f64,
    place: DVec2,
    deviation: f64,
    /// Whether two soles were fitted to the loads: nothing that the track has learnt from both feet holds for one.
    is_fitted: bool,
}

impl Tracker {
    /// Starts new tracks on tiles that other feet already press.
    pub(super) fn initiate(&mut self, tiles: &LoadedTiles, elapsed: &Elapsed) {
        let (near, cells) = (&self.near, &self.cells);
        parallel::for_each(&mut self.tracks, |which, foot| {
            foot.look_for_second(which, near, tiles, cells, elapsed);
        });
        for which in 0..self.tracks.len() {
            let Some(candidate) = self.tracks[which].arrivals.candidate.take_if(|_| true) else { continue };
            let foot = &self.tracks[which];
            // A track that it may be a part of has its centre of pressure within a stride.
            let others = self.near.around(candidate.place).filter(|&other| other != which);
            let nearest = others
                .map(|other| (self.tracks[other].centre().distance(candidate.place), other))
                .filter(|&(distance, other)| {
                    let foot = &self.tracks[other];
                    let beyond = foot.beyond(candidate.place).min(foot.lands_about(candidate.place));
                    beyond < 0.0 || distance < APART_M
                })
                .min_by(first_of_least);
            if let Some((_, other)) = nearest {
                // No new foot: the load belongs to an existing one.
                let known = &mut self.tracks[other];
                for &position in &candidate.tiles {
                    if !known.tiles.contains(&position) {
                        known.tiles.push(position);
                    }
                }
                continue;
            }
            let kept = candidate.keeps.map_or(foot.centre(), |keeps| keeps.place);
            if kept.distance(candidate.place) < APART_M {
                continue;
            }
            let stood = foot.stillness.anchored_s >= STANDS_S && foot.bears();
            let from = foot.id;
            let touchdown = (stood || foot.is_slow()).then_some(Touchdown {
                existing: from,
                from: if stood { foot.stillness.anchor } else { foot.stillness.rest_point },
            });
            let mut new_track = Track::new(
                self.identity(candidate.place),
                candidate.force,
                candidate.place,
                candidate.deviation,
            );
            new_track.covariance[FORCE][FORCE] = (0.3 * candidate.force + 5.0).powi(2);
            new_track.covariance[FORCE + 1][FORCE + 1] = 8000.0_f64.powi(2);
            new_track.arrivals.touchdown = touchdown;
            new_track.doubt.part_of = Some(from);
            new_track.reach(tiles, &self.cells);
            for &position in &candidate.tiles {
                if !new_track.tiles.contains(&position) {
                    new_track.tiles.push(position);
                }
            }
            if !new_track.tiles.is_empty() {
                if let Some(keeps) = candidate.keeps {
                    let foot = &mut self.tracks[which];
                    foot.stand(keeps.force, keeps.place);
                    foot.reset_covariance(keeps.deviation);
                    foot.covariance[FORCE][FORCE] = (0.3 * keeps.force + 5.0).powi(2);
                    foot.restart_smoothing();
                    if keeps.is_fitted {
                        let body_n = body_n_of(keeps.force + candidate.force);
                        for foot in [&mut **foot, &mut new_track] {
                            foot.step.body_n = foot.step.body_n.min(body_n);
                        }
                        let (places, deviations) =
                            ([candidate.place, keeps.place], [candidate.deviation, keeps.deviation]);
                        new_track.arrivals.stance = Some(Stance::new(from, places, deviations));
                        foot.forget_shape();
                        foot.outline = FanExtents::new(keeps.place);
                    }
                    for foot in [foot, &mut new_track] {
                        foot.company.landed_together = true;
                        foot.stillness.mean_speed = SHARED_SPEED_M_S;
                    }
                } else {
                    self.tracks[which].back_to_prediction();
                }
                self.near.moved(which, self.tracks[which].centre());
                self.near.add(&new_track);
                self.tracks.push(new_track);
            }
        }
    }
}

impl Track {
    /// Notes a foot that may have landed among the tiles of this foot, number `which` of those on the floor.
    fn look_for_second(
        &mut self,
        which: usize,
        near: &Near,
        tiles: &LoadedTiles,
        cells: &Cells,
        elapsed: &Elapsed,
    ) {
        if self.company.shared {
            return;
        }
        let list = tiles.list();
        // A sensor whose quality changes moves the tile's reading without any foot.
        let own = self.tiles.as_slice();
        let quality = own.iter().map(|&position| list[position as usize].quality).max();
        if quality.is_some_and(|quality| quality != self.sensors.quality) {
            // The estimate for a sensor that is lost or returns is blended in gradually.
            let lasts = own.iter().any(|&position| !list[position as usize].is_settled());
            self.on_quality_change(quality.unwrap_or_default(), lasts);
            return;
        }
        let alone = || !near.is_beside_any(which);
        let second = self.second(alone, tiles, cells, elapsed);
        let added = if self.age > LANDS_S { self.added(list, cells) } else { None };
        // Taken out in every frame, so an absent candidate needs no write: most feet have none.
        if let Some(candidate) = added.or(second) {
            self.arrivals.candidate = Some(candidate);
        }
    }

    /// A foot that added load to tiles where this track cannot have put it.
    fn added(&self, list: &[LoadedTile], cells: &Cells) -> Option<CandidateTrack> {
        if !self.bears() && self.velocity().length() > SLIDES_M_S {
            return None;
        }
        let mut found: Option<CandidateTrack> = None;
        for (at, &position) in self.tiles.as_slice().iter().enumerate() {
            let tile = &list[position as usize];
            let force = f64::from(tile.wrench.force);
            let slow = self.smoothed_load(at, tile.index);
            let added = force - slow.force;
            // Too little load for a look at the noise.
            if added < ADDED_N {
                continue;
            }
            let noise = tile.loaded_noise_n();
            if added < ADDED_N + 8.0 * noise {
                continue;
            }
            let centre = tile.centre.as_dvec2();
            let moment = (tile.centroid.as_dvec2() - centre) * force - slow.moment;
            // Moment of the added load about the foot's own centre of pressure.
            let about = moment + (centre - self.smoothed.centre) * added;
            let place = centre + moment / added;
            let (low, high) = cells.of(tile);
            let inside = place.cmpge(low - 0.02).all() && place.cmple(high + 0.02).all();
            // The change that the foot's own sway may cause, at its own centre of pressure.
            let sway = slow.force * 0.012 + 3.5 * NOISE_ARM_M * noise;
            if inside && about.length() > added * 0.08 + sway && self.beyond(place) > sway / added {
                let found = found.get_or_insert_default();
                found.place =
                    (found.place * found.force + place.clamp(low, high) * added) / (found.force + added);
                found.force += added;
                found.deviation = found.deviation.max(0.02 + (slow.force * 0.006 / added).min(0.1));
                found.tiles.push(position);
            }
        }
        found
    }

    /// A second foot indicated by the track's load, with its place. `alone` returns whether no other foot is within a
    /// stride.
    fn second(
        &mut self,
        alone: impl FnOnce() -> bool,
        tiles: &LoadedTiles,
        cells: &Cells,
        elapsed: &Elapsed,
    ) -> Option<CandidateTrack> {
        let list = tiles.list();
        let seen = Whole::of(self.tiles.as_slice().iter().map(|&position| &list[position as usize]));
        // Both feet of a child can carry less than one that operates a control: only their soles tell them apart.
        let lone = self.stillness.anchored_s > 0.0 && seen.force > LEAST_BODY_N && alone();
        let alone = lone && seen.force > self.step.body_n;
        // A foot of an adult that has had another one near it is one foot.
        let is_known_as_one = alone && self.company.accompanied;
        let lands = !self.company.accompanied && self.age < FLAT_S;
        if !lone || is_known_as_one || !lands && self.stillness.anchored_s < STANDS_S {
            self.arrivals.fitted = Fitted::default();
        } else if self.arrivals.fitted.refits.is_due_after(elapsed.dt) {
            let loads = LoadsAround::of(seen.middle, &self.tiles, tiles, cells);
            self.arrivals.fitted.pair = Pair::of(&loads, seen.middle, seen.force);
        }
        let mut explanation = self.arrivals.explanation;
        let second = explanation.update(self, &seen, list, cells.side(), alone, elapsed);
        self.arrivals.explanation = explanation;
        if self.sensors.suppressed_s > 0.0 {
            return None;
        }
        let second = match second? {
            // One that has stood by itself keeps its place.
            Second::Apart(spread) if lands => {
                let loads = LoadsAround::of(seen.middle, &self.tiles, tiles, cells);
                let pair = Pair::of(&loads, seen.middle, seen.force).filter(Pair::is_placed);
                pair.map_or(Second::Apart(spread), Second::Pair)
            }
            other => other,
        };
        match second {
            Second::Shift(shift) => Some(CandidateTrack {
                force: seen.force * shift.length() / STANCE_M,
                place: self.stillness.anchor + shift.normalize() * STANCE_M,
                deviation: GUESSED_M,
                ..CandidateTrack::default()
            }),
            Second::Apart(spread) => {
                let axis = spread.axis();
                // The lighter side is the new one.
                let mut sides = [(0.0, DVec2::ZERO); 2];
                for &position in &self.tiles {
                    let tile = &list[position as usize];
                    let force = f64::from(tile.wrench.force);
                    let at = tile.centroid.as_dvec2();
                    let side = &mut sides[usize::from((at - seen.middle).dot(axis) > 0.0)];
                    side.0 += force;
                    side.1 += at * force;
                }
                let centre = |side: usize| sides[side].1 / sides[side].0;
                let new = if centre(0).distance(self.step.landed) > centre(1).distance(self.step.landed) {
                    0
                } else {
                    1
                };
                let (keep, place) = (centre(1 - new), centre(new));
                let mut candidate = CandidateTrack {
                    force: sides[new].0,
                    place,
                    deviation: APART_GUESS_M,
                    ..CandidateTrack::default()
                };
                candidate.keeps = Some(KeptFoot {
                    force: sides[1 - new].0,
                    place: keep,
                    deviation: APART_GUESS_M,
                    is_fitted: false,
                });
                Some(candidate)
            }
            Second::Pair(pair) => {
                let away = pair.places.map(|place| place.distance_squared(self.step.landed));
                let (keep, new) = if away[0] < away[1] { (0, 1) } else { (1, 0) };
                Some(CandidateTrack {
                    force: pair.forces[new],
                    place: pair.places[new],
                    deviation: pair.deviations[new],
                    keeps: Some(KeptFoot {
                        force: pair.forces[keep],
                        place: pair.places[keep],
                        deviation: pair.deviations[keep],
                        is_fitted: true,
                    }),
                    ..CandidateTrack::default()
                })
            }
        }
    }
}
