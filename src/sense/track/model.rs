//! The joint filter's model: the motion of feet, and the loads that they cause on the tiles.

use super::params::model::{
    FORCE_FADE_S, FORCE_RATE_N_S, HALF_FADE_S, HALF_SPREAD_M, HELD, KNOWN_SHAPE, PLACE_FADE_S,
    SPEED_LEAST_M_S, SPEED_M_S, SPREAD_M, UNKNOWN_SHAPE,
};
use super::params::state::{FLAT_S, HALF_REST};
use arrayvec::ArrayVec;
use glam::DVec2;

use super::elapsed::Elapsed;
use super::joint::{Derivative, Joint, MOST_FEET};
use super::state::{EAST, FORCE, HALF_EAST, HALF_NORTH, NORTH, STATES, Track};
use super::strips::{StripAxis, Strips};
use super::{Cells, number_of};
use crate::sense::centroid::tile::LoadedTile;

/// Predicts the feet of a group over the elapsed time.
pub(super) fn predict(joint: &mut Joint, group: &[&mut Track], elapsed: &Elapsed) {
    let dt = elapsed.dt;
    for (which, foot) in group.iter().enumerate() {
        let at = which * STATES;
        // A foot that has stood still is expected to go on standing still.
        let speed = (2.0 * foot.stillness.mean_speed).clamp(SPEED_LEAST_M_S, SPEED_M_S);
        for (value, fade_s, decay, rate) in [
            (FORCE, FORCE_FADE_S, elapsed.force_rate, FORCE_RATE_N_S),
            (EAST, PLACE_FADE_S, elapsed.velocity, speed),
            (NORTH, PLACE_FADE_S, elapsed.velocity, speed),
        ] {
            joint.drift(at + value, fade_s * (1.0 - decay), decay, rate * rate * (1.0 - decay * decay));
        }
        if foot.age > FLAT_S && dt > 0.0 {
            // A flat foot strays about its rest point, in the long run by no more than `sway_m`.
            let spread = 2.0 * speed * speed * PLACE_FADE_S * dt;
            let away_s =
                DVec2::new(joint.x[at + EAST], joint.x[at + NORTH]).distance(foot.stillness.rest_point);
            let stood = group.iter().all(|other| other.age <= foot.age);
            let held = stood && away_s > HELD * foot.stillness.sway_m;
            let variance =
                if held { foot.stillness.sway_m.powi(2) } else { foot.stillness.sway_m.powi(4) / spread };
            for (place, rest_point) in
                [(EAST, foot.stillness.rest_point.x), (NORTH, foot.stillness.rest_point.y)]
            {
                joint.observe(rest_point - joint.x[at + place], &[(at + place, 1.0)], variance);
            }
        }
        // A foot keeps its known half widths while it stays in place.
        let loose = 1.0 - foot.residual_weight();
        let decay = (-dt * loose / HALF_FADE_S).exp();
        for half in [HALF_EAST, HALF_NORTH] {
            joint.relax(at + half, HALF_REST, decay, HALF_SPREAD_M * HALF_SPREAD_M * (1.0 - decay * decay));
        }
    }
}

/// Updates the joint filter with the loads of the tiles of its feet. Returns the mean NIS and the force of all those
/// tiles.
pub(super) fn observe(
    joint: &mut Joint,
    group: &[&mut Track],
    list: &[LoadedTile],
    cells: &Cells,
    dt: f64,
) -> (f64, f64) {
    let mut seen: ArrayVec<u32, 64> = ArrayVec::new();
    for foot in group {
        for &position in &foot.tiles {
            if !seen.contains(&position) && !seen.is_full() {
                seen.push(position);
            }
        }
    }
    let tiles = seen.iter().map(|&position| &list[position as usize]);
    let mut strips = Strips::of(tiles.clone(), cells.pitch);
    strips.add_noise(tiles);
    let (force, middle) = (strips.force, strips.middle);
    for foot in group {
        // Strips without load within reach of a patch are observations too.
        for axis in StripAxis::BOTH {
            let wide = foot.covariance[axis.half()][axis.half()].sqrt();
            let (c, h) = (axis.along(foot.centre()), axis.along(foot.half()) + wide);
            let (pitch, across) = (axis.along(cells.pitch), axis.across(foot.centre()));
            for number in number_of(c - h, pitch)..=number_of(c + h, pitch) {
                if cells.have(axis, number, across) {
                    strips.strip(axis, number);
                }
            }
        }
    }
    // Force and moments of the whole group, independent of any patch model.
    let mut jacobian = [[(0, 0.0); 2 * MOST_FEET]; 3];
    for which in 0..group.len() {
        let at = which * STATES;
        let state = &joint.x[at..at + STATES];
        jacobian[0][which] = (at + FORCE, 1.0);
        jacobian[1][2 * which] = (at + FORCE, state[EAST] - middle.x);
        jacobian[1][2 * which + 1] = (at + EAST, state[FORCE]);
        jacobian[2][2 * which] = (at + FORCE, state[NORTH] - middle.y);
        jacobian[2][2 * which + 1] = (at + NORTH, state[FORCE]);
    }
    let n = group.len();
    let start = joint.x;
    let now = |joint: &Joint, jacobian: &[Derivative]| -> f64 {
        // The change of the linearised prediction by the observations so far.
        jacobian.iter().map(|&(state, derivative)| derivative * (joint.x[state] - start[state])).sum()
    };
    let whole: f64 = (0..n).map(|which| start[which * STATES + FORCE]).sum();
    let noise = strips.noise();
    joint.observe(force - whole, &jacobian[0][..n], 4.0 + noise.force);
    for (axis, jacobian) in [(EAST, jacobian[1]), (NORTH, jacobian[2])] {
        let middle = if axis == EAST { middle.x } else { middle.y };
        let moment: f64 =
            (0..n).map(|which| start[which * STATES + FORCE] * (start[which * STATES + axis] - middle)).sum();
        let innovation = -moment - now(joint, &jacobian[..2 * n]);
        joint.observe(
            innovation,
            &jacobian[..2 * n],
            0.09 + if axis == EAST { noise.east } else { noise.north },
        );
    }
    // Exponentials: computed once for each foot, not for each of its strips.
    let strengths: ArrayVec<f64, MOST_FEET> = group.iter().map(|foot| foot.residual_weight()).collect();
    let mut nis = 0.0;
    for strip in &strips.strips {
        let axis = strip.axis;
        let (place, half) = (axis.place(), axis.half());
        let aside = EAST + NORTH - place;
        let middle = strip.middle(cells.pitch);
        let mut innovation = [strip.force, strip.moment, strip.cross];
        let mut rows: Rows = Default::default();
        let [force_noise, moment_noise, cross_noise] = strip.noise;
        let mut covariance =
            [[4.0 + force_noise, 0.0, 0.0], [0.0, 0.09 + moment_noise, 0.0], [0.0, 0.0, 0.09 + cross_noise]];
        for (which, (foot, &strength)) in group.iter().zip(&strengths).enumerate() {
            let residual = foot.residual_at(axis, strip.number, strength);
            let place_along = axis.along(foot.centre());
            let width = foot.covariance[half][half].sqrt();
            let slice = strip.slice_with_sigma(cells.pitch, place_along, axis.along(foot.half()), width);
            let share = (slice.share + residual.share).clamp(0.0, 1.0);
            if share <= 0.0 && slice.share <= 0.0 {
                continue;
            }
            let (f, at) = (foot.force(), which * STATES);
            let offset = axis.across(foot.centre() - strips.middle);
            let moment = slice.moment + residual.moment;
            let cross = share * offset + residual.cross;
            innovation[0] -= f * share;
            innovation[1] -= f * moment;
            innovation[2] -= f * cross;
            // Errors of the patch model: force on the other side of the seam through the foot, and the spread of that
            // force along the seam.
            let straddle =
                4.0 * (share * (1.0 - share)).max((1.0 - strength) * slice.share * (1.0 - slice.share));
            let shape_error = KNOWN_SHAPE + UNKNOWN_SHAPE * (1.0 - strength);
            // Errors of the patch model persist while the foot is there: they are correlated over many frames.
            let frames = foot.age.clamp(0.1, 1.0) / dt.max(1e-4);
            let strayed = frames.max(1.0) * (f * shape_error).powi(2) * straddle;
            let lever = [1.0, (0.5 * axis.along(cells.pitch)).copysign(place_along - middle), offset];
            for (row, values) in covariance.iter_mut().enumerate() {
                for (column, value) in values.iter_mut().enumerate() {
                    *value += strayed * lever[row] * lever[column];
                }
            }
            covariance[1][1] += strayed * SPREAD_M * SPREAD_M;
            covariance[2][2] += strayed * SPREAD_M * SPREAD_M;
            for (row, value, along, wider, across) in [
                (0, share, slice.share_by[0], slice.share_by[1], 0.0),
                (1, moment, slice.moment_by[0], slice.moment_by[1], 0.0),
                (2, cross, slice.share_by[0] * offset, slice.share_by[1] * offset, share),
            ] {
                rows[row].push((at + FORCE, value));
                rows[row].push((at + place, f * along));
                rows[row].push((at + half, f * wider));
                rows[row].push((at + aside, f * across));
            }
        }
        let variances = decorrelate(&mut innovation, &mut rows, covariance);
        for row in 0..3 {
            let innovation = innovation[row] - now(joint, &rows[row]);
            nis += joint.observe(innovation, &rows[row], variances[row]);
        }
    }
    (nis / (3.0 * strips.strips.len() as f64), force)
}

/// Jacobian rows of a strip's force, moment and cross moment.
type Rows = [ArrayVec<Derivative, { 4 * MOST_FEET }>; 3];

/// Decorrelates three observations and returns their variances.
///
/// # Source
/// R = L D Lᵀ: multiplication by the inverse of L turns errors of covariance R into errors of the diagonal covariance
/// D.
fn decorrelate(innovation: &mut [f64; 3], rows: &mut Rows, mut covariance: [[f64; 3]; 3]) -> [f64; 3] {
    for pivot in 0..2 {
        for row in pivot + 1..3 {
            let factor = covariance[row][pivot] / covariance[pivot][pivot];
            let above = covariance[pivot];
            for (below, above) in covariance[row].iter_mut().zip(above) {
                *below -= factor * above;
            }
            innovation[row] -= factor * innovation[pivot];
            let (above, below) = rows.split_at_mut(row);
            for (derivative, taken) in below[0].iter_mut().zip(&above[pivot]) {
                derivative.1 -= factor * taken.1;
            }
        }
    }
    [covariance[0][0], covariance[1][1], covariance[2][2]]
}
