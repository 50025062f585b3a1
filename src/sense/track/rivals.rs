//! Rival explanations of the loads of a group of feet.
//!
//! The joint filter follows one explanation: all feet of the group are still there, and the oldest ones stay. If
//! another foot lands among their tiles, or if it is the oldest foot that rolls, the filter drags the wrong foot away,
//! and its model fits that nearly as well. A foot that has strayed from its rest point therefore has to compete, and
//! so has a track that was split from another foot and has shown no load of its own, and a foot beside which another
//! one was put down if the loads fit both badly:
//!
//! - **Moved**: all feet stand where they stood, but for one that has rolled or turned.
//! - **Together**: all feet have rolled alike, as of a person who leans or pushes off.
//! - **Further**: all feet stand where they stood, and another one has landed.
//! - **Without**: the split track is a part of the foot from which it was split, and that foot has rolled.
//!
//! Every few milliseconds each of them is fitted to the loads without memory ([`StripLoads::fit`]), with the one place
//! that is free on a grid. Its cost is that of the fit, the squared distance of each foot from its rest point in
//! standard deviations of a roll, and the prior odds of each further foot. A rival that stays ahead replaces the
//! filter's explanation. While one is ahead, or while the loads of a touchdown fit badly, the lighter feet may be parts
//! of the heaviest one: they are marked as split until they press a tile of their own.

use super::params::delete::OWN_M;
use super::params::output;
use super::params::reach::AROUND_M;
use super::params::rivals::{
    AHEAD, APART_M, AROUND_STEP_M, CONTESTED_S, EVERY_S, FITS, FURTHER, HALVES, LEAST_SHARE, OVER_STEP_M,
    OVERLAP_M, PAUSE, ROLLED_M, SETTLE_M, SPLIT, STEPS_AROUND, STRAYED_M, TIMES, TOGETHER,
};
use super::params::state::FLAT_S;
use super::params::touchdown::SIDE_BY_SIDE_M;
use arrayvec::ArrayVec;
use glam::DVec2;

use super::Cells;
use super::elapsed::Elapsed;
use super::groups::Group;
use super::rival::{Rival, adopt};
use super::state::{MOST_TILES, Track, tiles_of};
use super::static_fit::{Fit, MOST_PARTS, Part, StripLoads};
use crate::sense::centroid::tile::LoadedTile;

/// Maximum number of feet of a group with rivals: one less than a fit has.
const MOST: usize = MOST_PARTS - 1;

/// The rival that was ahead when they were last compared, and how often in succession.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Lead {
    rival: Option<Rival>,
    times: u8,
    /// Number of comparisons for which no rival may replace the filter's explanation, since one has just done so.
    pause: u8,
    /// Whether its turn has come in a frame that had time for no more comparisons.
    waits: bool,
}

impl Lead {
    /// Whether two soles may replace the filter's explanation now: it has not just changed, and no further foot is ahead.
    pub(super) fn leaves_to_soles(&self) -> bool {
        self.pause == 0 && !matches!(self.rival, Some(Rival::Further(_)))
    }

    /// Begins a pause, since the explanation has just changed.
    pub(super) fn pause(&mut self) {
        *self = Self { pause: PAUSE, ..Self::default() };
    }
}

/// Compares the explanations of a group that the filter has just estimated, and changes its feet if a rival has been
/// ahead for some time. Returns whether that took time; without `has_time`, a group whose turn has come waits for the
/// next frame.
pub(super) fn compare(
    group: &mut Group<'_>,
    list: &[LoadedTile],
    cells: &Cells,
    elapsed: &Elapsed,
    has_time: bool,
) -> bool {
    if !may_have_rivals(group) {
        return false;
    }
    let first = &*group[0];
    let turn = |age: f64| (age / EVERY_S).floor();
    if !first.doubt.lead.waits && turn(first.age) == turn(first.age - elapsed.dt) {
        return false;
    }
    if !has_time {
        group[0].doubt.lead.waits = true;
        return false;
    }
    let before = first.doubt.lead;
    let mut lead = Lead { pause: before.pause.saturating_sub(1), ..Lead::default() };
    let mut best = None;
    let has_rivals = lead.pause == 0 && group.iter().any(|foot| foot.is_doubtful());
    if has_rivals {
        // One that leaves every foot where the filter has it is the filter's own.
        best = Explanations::of(group, list, cells).best().filter(|(rival, _)| rival.differs_from(group));
    }
    if best.is_some() || group.iter().any(|foot| foot.doubt.misfit > output::FITS) {
        doubt_light_feet(group);
    }
    if let Some((rival, _)) = &best {
        let again = before.rival.is_some_and(|before| before.is_like(*rival));
        (lead.rival, lead.times) = (Some(*rival), if again { before.times.saturating_add(1) } else { 1 });
        for (which, foot) in group.iter_mut().enumerate() {
            if foot.is_elsewhere_under(*rival, which) {
                foot.doubt.contested_s = CONTESTED_S;
            }
        }
    }
    let wins = lead.times >= TIMES;
    if wins {
        lead.pause();
    }
    group[0].doubt.lead = lead;
    if let Some((rival, fit)) = best.filter(|_| wins) {
        adopt(group, rival, &fit.forces, list);
    }
    has_rivals
}

/// Marks the feet that carry less than another one within a shoe of them: that one alone may explain the loads.
fn doubt_light_feet(group: &mut Group<'_>) {
    let heaviest = group.iter().max_by(|a, b| a.force().total_cmp(&b.force()));
    let Some((heaviest, place)) = heaviest.map(|foot| (foot.id, foot.centre())) else { return };
    for foot in group.iter_mut().filter(|foot| foot.id != heaviest) {
        if foot.centre().distance(place) < OWN_M {
            foot.doubt.part_of.get_or_insert(heaviest);
        }
    }
}

pub(super) fn may_have_rivals(group: &Group<'_>) -> bool {
    let flat = |foot: &&mut Track| {
        foot.age > FLAT_S && !foot.company.beyond_filter && foot.sensors.suppressed_s <= 0.0
    };
    (2..=MOST).contains(&group.len()) && group.iter().all(flat)
}

impl Track {
    /// Whether the explanation of its loads has to compete.
    fn is_doubtful(&self) -> bool {
        self.strayed() > STRAYED_M || self.doubt.part_of.is_some() || self.doubt.misfit > output::FITS
    }

    /// Whether its shoe, where it stood, leaves room for another foot at `place`. The outline of a foot that has
    /// strayed may be that of both.
    fn leaves_free(&self, place: DVec2) -> bool {
        if self.strayed() > STRAYED_M {
            self.stillness.rest_point.distance(place) > AROUND_M
        } else {
            self.beyond(place) > 0.0
        }
    }
}

/// Feet of one explanation.
type Parts<'a> = ArrayVec<&'a Part, MOST_PARTS>;

/// All explanations of the loads of a group.
struct Explanations<'a> {
    feet: ArrayVec<&'a Track, MOST>,
    loads: StripLoads,
    /// South-west and north-east corners of its tiles.
    tiles: ArrayVec<(DVec2, DVec2), MOST_TILES>,
}

/// The likeliest rival so far, and the cost that the next one must stay below.
struct Best {
    limit: f64,
    found: Option<(Rival, Fit)>,
}

impl Best {
    fn consider(&mut self, rival: Rival, fit: Fit) {
        if fit.cost < self.limit {
            self.limit = fit.cost;
            self.found = Some((rival, fit));
        }
    }
}

impl<'a> Explanations<'a> {
    fn of(group: &'a Group<'_>, list: &[LoadedTile], cells: &Cells) -> Self {
        let feet: ArrayVec<&Track, MOST> = group.iter().map(|foot| &**foot).take(MOST).collect();
        let positions = tiles_of(feet.iter().copied());
        let tiles = positions.iter().map(|&position| &list[position as usize]);
        let loads = StripLoads::of(tiles.clone(), cells.pitch);
        Self { feet, loads, tiles: tiles.map(|tile| cells.of(tile)).collect() }
    }

    /// The likeliest rival, if it is ahead of the filter's explanation.
    fn best(&self) -> Option<(Rival, Fit)> {
        let mut best = Best { limit: self.settled()? - AHEAD, found: None };
        let home: ArrayVec<Part, MOST_PARTS> =
            self.feet.iter().map(|foot| self.part(foot, foot.stillness.rest_point, 0.0)).collect();
        let home: Parts<'_> = home.iter().collect();
        let have_room = self.have_room();
        for way in ways(STEPS_AROUND).map(|steps| steps * AROUND_STEP_M) {
            self.drop_splits(&home, way, &mut best);
            if have_room {
                self.move_feet(&home, way, &mut best);
            }
        }
        if have_room {
            self.add_feet(&home, &mut best);
        }
        best.found
    }

    /// Whether the shoes of all feet have room at their rest points. If not, they stand elsewhere, and these points are no
    /// ground for an explanation.
    fn have_room(&self) -> bool {
        self.feet.iter().enumerate().all(|(which, foot)| {
            self.feet[..which]
                .iter()
                .all(|other| other.stillness.rest_point.distance(foot.stillness.rest_point) > APART_M)
        })
    }

    /// Considers explanations in which one foot, or all of them, have moved `way` from their rest points.
    fn move_feet(&self, home: &Parts<'_>, way: DVec2, best: &mut Best) {
        let all: ArrayVec<Part, MOST_PARTS> = self
            .feet
            .iter()
            .map(|foot| self.part(foot, foot.stillness.rest_point + way, AROUND_STEP_M))
            .collect();
        let all: Parts<'_> = all.iter().collect();
        for (which, moved) in all.iter().enumerate() {
            let mut parts = home.clone();
            parts[which] = moved;
            if let Some(fit) = self.loads.fit(&parts) {
                let place = moved.place + self.loads.off(&parts, &fit, fit.forces[which], AROUND_STEP_M);
                best.consider(Rival::Moved(which, place), fit.and(rolled(way)));
            }
        }
        if let Some(fit) = self.loads.fit(&all) {
            let together = way + self.loads.off(&all, &fit, self.loads.force(), AROUND_STEP_M);
            best.consider(Rival::Together(together), fit.and(rolled(way) + TOGETHER));
        }
    }

    /// Considers explanations in which a split track is a part of the other foot, which has moved `way`.
    fn drop_splits(&self, home: &Parts<'_>, way: DVec2, best: &mut Best) {
        for (gone, from, apart) in self.splits() {
            let rest_point = self.feet[from].stillness.rest_point;
            let moved = self.part(self.feet[from], rest_point + way, AROUND_STEP_M);
            let absent = home[gone].clone().absent();
            let mut parts = home.clone();
            (parts[from], parts[gone]) = (&moved, &absent);
            if let Some(fit) = self.loads.fit(&parts) {
                let off = self.loads.off(&parts, &fit, fit.forces[from], AROUND_STEP_M);
                best.consider(
                    Rival::Without(gone, from, moved.place + off),
                    fit.and(rolled(way) - overlap(apart)),
                );
            }
        }
    }

    /// Considers explanations with a further foot anywhere on the tiles.
    fn add_feet(&self, home: &Parts<'_>, best: &mut Best) {
        for &(low, high) in &self.tiles {
            let steps = ((high - low) / OVER_STEP_M).floor();
            for (east, north) in (0..steps.x as i32).flat_map(|x| (0..steps.y as i32).map(move |y| (x, y))) {
                let place = low + (DVec2::new(east.into(), north.into()) + 0.5) * OVER_STEP_M;
                if self.feet.iter().all(|foot| foot.leaves_free(place)) {
                    self.add_foot(home, place, best);
                }
            }
        }
    }

    /// Considers explanations with a further foot at `place`.
    fn add_foot(&self, home: &Parts<'_>, place: DVec2, best: &mut Best) {
        for half in HALVES {
            let further = self.loads.part(place, DVec2::splat(half), OVER_STEP_M, 0.0, |_, _| [0.0; 3]);
            let mut parts = home.clone();
            parts.push(&further);
            let Some(fit) = self.loads.fit(&parts) else { continue };
            let force = fit.forces[parts.len() - 1];
            if force > LEAST_SHARE * self.loads.force() && fit.misfit < FITS {
                let off = self.loads.off(&parts, &fit, force, OVER_STEP_M);
                best.consider(Rival::Further(place + off), fit.and(FURTHER));
            }
        }
    }

    /// Cost of the filter's explanation, with each foot where it fits best near the filter's place: rivals choose
    /// their places, too. `None` if no forces fit.
    fn settled(&self) -> Option<f64> {
        let mut parts: ArrayVec<Part, MOST_PARTS> =
            self.feet.iter().map(|foot| self.part(foot, foot.centre(), AROUND_STEP_M)).collect();
        let strayed =
            |foot: &Track, place: DVec2| (foot.stillness.rest_point.distance(place) / ROLLED_M).powi(2);
        let total = |parts: &[Part]| {
            let strayed = self.feet.iter().zip(parts).map(|(foot, part)| strayed(foot, part.place));
            self.loads.fit(&parts.iter().collect::<Parts<'_>>()).map(|fit| fit.cost + strayed.sum::<f64>())
        };
        let mut least = total(&parts)?;
        for (which, foot) in self.feet.iter().enumerate() {
            let mut best = parts[which].clone();
            for way in ways(1) {
                parts[which] = self.part(foot, foot.centre() + way * SETTLE_M, AROUND_STEP_M);
                if let Some(cost) = total(&parts).filter(|cost| *cost < least) {
                    (least, best) = (cost, parts[which].clone());
                }
            }
            parts[which] = best;
        }
        Some(least)
    }

    /// Tracks that may be parts of the feet from which they were split: the numbers of both, and their distance (m).
    fn splits(&self) -> impl Iterator<Item = (usize, usize, f64)> {
        let split = self.feet.iter().enumerate().filter_map(|(which, foot)| {
            let from = self.feet.iter().position(|other| Some(other.id) == foot.doubt.part_of)?;
            Some((which, from, foot.centre().distance(self.feet[from].centre())))
        });
        split.filter(|&(_, _, apart)| apart < OWN_M)
    }

    /// The loads of one newton of `foot` with its centre of pressure at `place`.
    fn part(&self, foot: &Track, place: DVec2, step: f64) -> Part {
        let strength = foot.residual_weight_at(place);
        self.loads.part(place, foot.half(), step, strength, |axis, number| {
            let residual = foot.residual_at(axis, number, strength);
            [residual.share, residual.moment, residual.cross]
        })
    }
}

/// All ways of whole steps, at most so many eastwards, westwards, northwards and southwards.
fn ways(most: i32) -> impl Iterator<Item = DVec2> {
    (-most..=most)
        .flat_map(move |east| (-most..=most).map(move |north| DVec2::new(east.into(), north.into())))
}

/// Cost of a foot that has rolled this `way`.
fn rolled(way: DVec2) -> f64 {
    way.length_squared() / (ROLLED_M * ROLLED_M)
}

/// Cost of a split track at this distance from its other foot (m): a further foot, and shoes that would overlap.
fn overlap(apart: f64) -> f64 {
    SPLIT + ((SIDE_BY_SIDE_M - apart).max(0.0) / OVERLAP_M).powi(2)
}
