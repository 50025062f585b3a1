//! Two feet that have landed together and share tiles.
//!
//! No tile has shown either of them alone, so a filter that moves each by itself follows the errors of its model.
//! Their places are those of the likeliest pair of soles ([`pair`](super::pair)). Between two fits, the common centre
//! of pressure divides the load along the line between the feet, and a movement across that line moves both.

use super::params::rivals::CONTESTED_S;
use super::params::stance::{ACROSS_M, FIRST_S, LEAST_SHARE};
use glam::DVec2;

use super::Cells;
use super::elapsed::Elapsed;
use super::pair::Pair;
use super::refits::Refits;
use super::sole::LoadsAround;
use super::state::{EAST, FORCE, NORTH, Track};
use super::strips::Strips;
use crate::sense::contact::ContactId;
use crate::sense::loaded::LoadedTiles;

/// The stance of a foot beside one with which it landed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stance {
    other: ContactId,
    /// Places of this foot and of the other one, and their standard deviations (m).
    places: [DVec2; 2],
    deviations: [f64; 2],
    /// Counts the time since they were first placed.
    refits: Refits,
}

impl Stance {
    /// The stance beside `other`.
    pub(super) fn new(other: ContactId, places: [DVec2; 2], deviations: [f64; 2]) -> Self {
        Self { other, places, deviations, refits: Refits::first_after(FIRST_S) }
    }

    /// Takes the places of `pair`.
    fn fit(&mut self, pair: &Pair) {
        let away = |one: usize, other: usize| {
            pair.places[one].distance_squared(self.places[0])
                + pair.places[other].distance_squared(self.places[1])
        };
        let (mine, others) = if away(0, 1) <= away(1, 0) { (0, 1) } else { (1, 0) };
        self.places = [pair.places[mine], pair.places[others]];
        self.deviations = [pair.deviations[mine], pair.deviations[others]];
    }
}

/// Places the two feet of a group that have landed together; returns false if there are none, or if they no longer
/// stand as they landed.
pub(super) fn place(group: &mut [&mut Track], tiles: &LoadedTiles, cells: &Cells, elapsed: &Elapsed) -> bool {
    let [first, second] = group else {
        group.iter_mut().for_each(|foot| foot.arrivals.stance = None);
        return false;
    };
    let stands =
        |foot: &Track, other: &Track| foot.arrivals.stance.is_some_and(|stance| stance.other == other.id);
    let (foot, other) = if stands(second, first) {
        (second, first)
    } else if stands(first, second) {
        (first, second)
    } else {
        return false;
    };
    let Some(mut stance) = foot.arrivals.stance.take() else { return false };
    let both = foot.tiles_with(other);
    let strips = Strips::of(both.iter().map(|&position| &tiles.list()[position as usize]), cells.pitch);
    if stance.refits.is_due_after(elapsed.dt) {
        let loads = LoadsAround::of(strips.middle, &both, tiles, cells);
        if let Some(pair) = Pair::of(&loads, strips.middle, strips.force) {
            stance.fit(&pair);
        }
    }
    let line = stance.places[0] - stance.places[1];
    let moved = strips.middle - stance.places[1];
    let share = moved.dot(line) / line.length_squared();
    let across = moved - line * share;
    if !(LEAST_SHARE..=1.0 - LEAST_SHARE).contains(&share) || across.length() > ACROSS_M {
        return false;
    }
    for (foot, which, force) in
        [(&mut *foot, 0, share * strips.force), (other, 1, (1.0 - share) * strips.force)]
    {
        foot.stand(force, stance.places[which] + across);
        for rate in [FORCE, EAST, NORTH] {
            foot.state[rate + 1] = 0.0;
        }
        foot.reset_covariance(stance.deviations[which]);
        foot.covariance[FORCE][FORCE] = (0.2 * force + 5.0).powi(2);
        (foot.doubt.nis, foot.doubt.misfit) = (0.0, 0.0);
        // Another division may explain the loads as well: no tile has shown either foot.
        foot.doubt.contested_s = CONTESTED_S;
    }
    foot.arrivals.stance = Some(stance);
    true
}
