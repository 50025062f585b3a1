//! A foot that is put down beside a standing one.
//!
//! While weight shifts to the new foot, the common centre of pressure c moves from the standing foot's place a
//! straight towards the new foot's. The product of force and distance is known at once, `F_b d = F |c - a|`, but
//! neither the new foot's force F_b nor its distance d. The division of the load over the tiles separates the two,
//! because the standing foot's share of each tile is known from its time alone. A Kalman filter cannot follow that:
//! its linearisation holds near one estimate, and here the estimate may be tens of centimetres off. Every possible
//! distance is therefore tried and weighted by its likelihood.

use super::params::state::{HALF_REST, SHOE_M};
use super::params::stillness::SWAY_LEAST_M;
use super::params::touchdown::{
    HALF_SPREAD_M, HALVES, LEAST_MOMENT, LEAST_WAY_M, MISREAD_N, MOSTLY, NEAREST_M, NOT_ITS_OWN,
    OUT_OF_QUESTION, PLACE_M, SIDE_BY_SIDE_M, STEP_M, SWAY_M, TAKEN_OVER, TIGHT_M, TRIED, UNLIKE,
    UNLIKE_LEAST, USUAL_M, USUAL_SPREAD, WIDEST_M,
};
use arrayvec::ArrayVec;
use glam::DVec2;

use super::state::{EAST, FORCE, NORTH, Track};
use super::strips::{MOST_STRIPS, Strip, StripAxis, Strips};
use super::{Cells, number_of};
use crate::sense::centroid::tile::LoadedTile;
use crate::sense::contact::ContactId;

/// The standing foot beside which a foot has landed, and the place of the standing foot before.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touchdown {
    pub existing: ContactId,
    pub from: DVec2,
}

/// A hypothesis about two feet: their forces, and the place of the new one.
struct Pair {
    existing_force: f64,
    place: DVec2,
    stepping_force: f64,
}

/// Whether tiles that `existing`, standing at `from`, does not press explain nearly all of the moment of `stepping`
/// in `strips`.
pub(super) fn is_seen_alone(
    existing: &Track,
    stepping: &Track,
    from: DVec2,
    strips: &Strips,
    sigma: f64,
    list: &[LoadedTile],
    cells: &Cells,
) -> bool {
    let tiles = stepping.tiles.iter().map(|&position| &list[position as usize]);
    let own = tiles.filter(|tile| existing.at(from, cells.of(tile)).share() < NOT_ITS_OWN);
    let own: DVec2 = own.map(|tile| (tile.centroid.as_dvec2() - from) * f64::from(tile.wrench.force)).sum();
    let all = (strips.middle - from) * strips.force;
    (all - own).length() < (1.0 - MOSTLY) * all.length() + (SWAY_LEAST_M + sigma) * strips.force
}

/// Places `stepping` beside `existing`, which stands still at `from`; `strips` is the load of the tiles of both, and
/// `sigma` the standard deviation of its centroid.
///
/// Returns false if the common centre of pressure has hardly moved, so that no estimate is possible yet.
pub(super) fn place(
    existing: &mut Track,
    stepping: &mut Track,
    from: DVec2,
    mut strips: Strips,
    sigma: f64,
    cells: &Cells,
) -> bool {
    let (force, way) = (strips.force, strips.middle - from);
    let moment = force * way.length();
    if moment < LEAST_MOMENT.max((LEAST_WAY_M + sigma) * force) {
        return false;
    }
    let ahead = way / way.length();
    // Strips without load within reach of the feet are observations too.
    for axis in StripAxis::BOTH {
        for point in [from, from + ahead * 0.3] {
            let number = number_of(axis.along(point), axis.along(cells.pitch));
            if cells.have(axis, number, axis.across(point)) {
                strips.strip(axis, number);
            }
        }
    }
    let standing = standing(existing, from, &strips, cells.pitch);
    let tightness = TIGHT_M.hypot(sigma);
    let mut against = [f64::INFINITY; TRIED];
    let mut least = f64::INFINITY;
    // The likely distances come first: their misfit limits the work for the others.
    let now = stepping.centre().distance(from);
    let likely = (((now - NEAREST_M) / STEP_M).max(0.0) as usize).min(TRIED - 1);
    let (nearer, farther) = against.split_at_mut(likely);
    let nearer = nearer.iter_mut().enumerate().rev();
    let farther = (likely..).zip(farther);
    for (step, misfit) in farther.chain(nearer) {
        let distance = distance(step);
        let stepping_force = moment / distance;
        let place = from + ahead * distance;
        if stepping_force > 1.03 * force || place.distance(stepping.step.landed) > SHOE_M {
            continue;
        }
        let existing_force = (force - stepping_force).max(0.0);
        let pair = Pair { existing_force, place, stepping_force };
        let unusual = (distance / USUAL_M).ln() / USUAL_SPREAD;
        let tight = (SIDE_BY_SIDE_M - distance).max(0.0) / tightness;
        let limit = least + OUT_OF_QUESTION - unusual * unusual - tight * tight;
        *misfit =
            pair.misfit(&standing, strips.middle, cells.pitch, limit) + unusual * unusual + tight * tight;
        least = least.min(*misfit);
    }
    let Some(distance) = Distance::among(&against) else { return false };
    let part = (moment / distance.mean).min(force);
    let place = from + ahead * distance.mean;
    let pair = Pair { existing_force: force - part, place, stepping_force: part };
    let misfit = pair.misfit_per_load(&standing, strips.middle, cells.pitch);
    existing.put(force - part, from, misfit);
    stepping.put(part, place, misfit);
    if part > TAKEN_OVER * force {
        // The earlier guess of its place must not remain its rest point.
        stepping.stillness.rest_point = stepping.centre();
    }
    // The moment is known: a larger distance means a smaller force.
    let force_variance = distance.variance * (part / distance.mean).powi(2) + 9.0;
    existing.covariance[FORCE][FORCE] = force_variance;
    stepping.covariance[FORCE][FORCE] = force_variance;
    let aside = (0.01 * force / part.max(1.0)).min(0.1).powi(2);
    stepping.covariance[EAST][EAST] += distance.variance * ahead.x * ahead.x + aside * ahead.y * ahead.y;
    stepping.covariance[NORTH][NORTH] += distance.variance * ahead.y * ahead.y + aside * ahead.x * ahead.x;
    stepping.covariance[EAST][NORTH] += (distance.variance - aside) * ahead.x * ahead.y;
    stepping.covariance[NORTH][EAST] = stepping.covariance[EAST][NORTH];
    let lean = -distance.variance * part / distance.mean;
    for (state, way) in [(EAST, ahead.x), (NORTH, ahead.y)] {
        stepping.covariance[FORCE][state] = lean * way;
        stepping.covariance[state][FORCE] = lean * way;
    }
    true
}

/// The distance tried at this step.
fn distance(step: usize) -> f64 {
    NEAREST_M + STEP_M * step as f64
}

/// The estimated distance between the two feet.
struct Distance {
    mean: f64,
    variance: f64,
}

impl Distance {
    /// Weights each distance by its likelihood; `None` if none is possible.
    fn among(against: &[f64; TRIED]) -> Option<Self> {
        let least = against.iter().copied().min_by(f64::total_cmp).filter(|least| least.is_finite())?;
        let (mut sum, mut first, mut second) = (0.0, 0.0, 0.0);
        for (misfit, distance) in against.iter().zip((0..TRIED).map(distance)) {
            let weight = (-0.5 * (misfit - least)).exp();
            sum += weight;
            first += weight * distance;
            second += weight * distance * distance;
        }
        let mean = first / sum;
        let between = STEP_M * STEP_M / 12.0;
        Some(Self { mean, variance: (second / sum - mean * mean).max(0.0) + between })
    }
}

impl Track {
    /// Sets force and place of a still foot, and the misfit of its loads.
    fn put(&mut self, force: f64, centre: DVec2, misfit: f64) {
        self.state[FORCE] = force;
        self.state[EAST] = centre.x;
        self.state[NORTH] = centre.y;
        self.state[EAST + 1] = 0.0;
        self.state[NORTH + 1] = 0.0;
        self.reset_covariance(PLACE_M);
        self.doubt.nis = 0.0;
        self.doubt.misfit = misfit;
    }
}

/// The load of one strip, and the standing foot's share and moments on it.
struct Line {
    strip: Strip,
    share: f64,
    moment: f64,
    cross: f64,
}

/// The shares of `existing`, standing at `from`, on each strip: the same for every hypothesis about the other foot.
fn standing(existing: &Track, from: DVec2, strips: &Strips, pitch: DVec2) -> ArrayVec<Line, MOST_STRIPS> {
    let lines = strips.strips.iter().map(|&strip| {
        let axis = strip.axis;
        let patch = strip.slice(pitch, axis.along(from), axis.along(existing.half()));
        let residual = existing.residual_at(axis, strip.number, 1.0);
        let share = (patch.share + residual.share).clamp(0.0, 1.0);
        Line {
            strip,
            share,
            moment: patch.moment + residual.moment,
            cross: share * axis.across(from - strips.middle) + residual.cross,
        }
    });
    lines.collect()
}

impl Pair {
    /// Misfit of all strips, with the best half widths of the new foot; infinite from `limit` on.
    fn misfit(&self, lines: &[Line], middle: DVec2, pitch: DVec2, limit: f64) -> f64 {
        let mut all = 0.0;
        for axis in StripAxis::BOTH {
            let mut best = f64::INFINITY;
            // Misfit of strips that the patch covers or misses at any width; NaN until computed.
            let mut same = [f64::NAN; MOST_STRIPS];
            for half in HALVES {
                let unusual = (half - HALF_REST) / HALF_SPREAD_M;
                let mut misfit = 0.0;
                let lines = lines.iter().zip(&mut same).filter(|(line, _)| line.strip.axis == axis);
                for (line, same) in lines {
                    if !same.is_nan() {
                        misfit += *same;
                        continue;
                    }
                    let (square, variances) = self.misfit_on(line, half, middle, pitch);
                    // No term is negative: a sum above the best so far can stop here.
                    if unusual * unusual + (misfit + square) >= best.min(limit - all) {
                        misfit = f64::INFINITY;
                        break;
                    }
                    let all = square + variances[0].ln() + 2.0 * variances[1].ln();
                    misfit += all;
                    if line.strip.is_divided_by_none(pitch, axis.along(self.place), WIDEST_M) {
                        *same = all;
                    }
                }
                best = best.min(unusual * unusual + misfit);
            }
            if best.is_infinite() {
                return best;
            }
            all += best;
        }
        all
    }

    /// Mean squared normalised deviation of the strips' forces and moments from those of the pair, with the best half
    /// widths of the new foot.
    fn misfit_per_load(&self, lines: &[Line], middle: DVec2, pitch: DVec2) -> f64 {
        let along = |axis: StripAxis| {
            let fits = HALVES.map(|half| {
                let unusual = (half - HALF_REST) / HALF_SPREAD_M;
                let lines = lines.iter().filter(|line| line.strip.axis == axis);
                let squares = lines.map(|line| self.misfit_on(line, half, middle, pitch).0);
                unusual * unusual + squares.sum::<f64>()
            });
            fits.into_iter().fold(f64::INFINITY, f64::min)
        };
        StripAxis::BOTH.into_iter().map(along).sum::<f64>() / (3 * lines.len()) as f64
    }

    /// Twice the negative log likelihood of one strip's load, up to a constant: the squares, and the variances of
    /// force and moments; the caller adds the logarithm of the first once and of the second twice.
    ///
    /// The logarithms are the determinant term: a hypothesis with small expected errors must fit, and one with large
    /// expected errors gains nothing. They are most of the work, so only callers that need them compute them.
    #[inline]
    fn misfit_on(&self, line: &Line, half: f64, middle: DVec2, pitch: DVec2) -> (f64, [f64; 2]) {
        const { assert!(MISREAD_N >= 1.0, "logarithms of variances are never negative") };
        let (strip, share) = (&line.strip, line.share);
        let axis = strip.axis;
        let new = strip.slice(pitch, axis.along(self.place), half);
        let innovation = [
            strip.force - self.existing_force * share - self.stepping_force * new.share,
            strip.moment - self.existing_force * line.moment - self.stepping_force * new.moment,
            strip.cross
                - self.existing_force * line.cross
                - self.stepping_force * new.share * axis.across(self.place - middle),
        ];
        let unlike = |force: f64, straddle: f64| (UNLIKE * force).powi(2) * (straddle + UNLIKE_LEAST);
        let unsure = MISREAD_N * MISREAD_N
            + unlike(self.existing_force, share * (1.0 - share))
            + unlike(self.stepping_force, 4.0 * new.share * (1.0 - new.share));
        let lever = 0.5 * axis.along(pitch);
        let swaying = unsure + (SWAY_M * self.existing_force * share / lever).powi(2);
        let moments = (innovation[1] * innovation[1] + innovation[2] * innovation[2]) / (lever * lever);
        (innovation[0] * innovation[0] / unsure + moments / swaying, [unsure, swaying])
    }
}
