//! Joint estimation of the feet that share tiles.

use glam::DVec2;
use multiversion::multiversion;

use super::state::{EAST, FORCE, HALF_EAST, HALF_NORTH, NORTH, STATES, Track};

/// Maximum number of feet in one joint filter.
pub(super) const MOST_FEET: usize = 8;
const MOST: usize = MOST_FEET * STATES;

/// Lower bound of the variance of a state.
const LEAST_VARIANCE: f64 = 1e-9;

/// An extended Kalman filter over the states of up to [`MOST_FEET`] feet.
///
/// Tiles under two feet measure only the sum of both; the covariance between the feet carries their division. A
/// separate filter for each foot would lose it.
#[derive(Clone, Debug)]
pub(super) struct Joint {
    states: usize,
    pub(super) x: [f64; MOST],
    p: [Row; MOST],
}

/// A row of the covariance. The alignment keeps vectors of eight numbers within one cache line.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
struct Row([f64; MOST]);

/// One entry of a Jacobian row: state and derivative.
pub(super) type Derivative = (usize, f64);

/// [`Joint::observe`], compiled for each vector instruction set: the order of summation is the same, so the results
/// are bit-identical.
#[multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn take_in(joint: &mut Joint, innovation: f64, jacobian: &[Derivative], variance: f64) -> f64 {
    // Nearly all groups have two or three feet, and loops of a known length need no counter.
    match joint.states / STATES {
        2 => update(joint, 2, innovation, jacobian, variance),
        3 => update(joint, 3, innovation, jacobian, variance),
        feet => update(joint, feet, innovation, jacobian, variance),
    }
}

#[inline(always)]
fn update(joint: &mut Joint, feet: usize, innovation: f64, jacobian: &[Derivative], variance: f64) -> f64 {
    // The states of one foot fill one vector of the widest kind.
    let mut gain = [[0.0; STATES]; MOST_FEET];
    let gain = &mut gain[..feet];
    for (foot, gain) in gain.iter_mut().enumerate() {
        let mut sum = [0.0; STATES];
        for &(state, derivative) in jacobian {
            add_scaled(&mut sum, derivative, &joint.p[state].0.as_chunks().0[foot]);
        }
        *gain = sum;
    }
    let of = |state: usize| gain[state / STATES][state % STATES];
    let explained: f64 = jacobian.iter().map(|&(state, derivative)| derivative * of(state)).sum();
    let total = explained + variance;
    if total.is_nan() || total <= 0.0 {
        return 0.0;
    }
    let scale = 1.0 / total;
    for row in 0..feet * STATES {
        let step = of(row) * scale;
        // Never true; but the compiler vectorises a loop that may end early along the row and not across the rows,
        // which would gather single numbers.
        if step.is_nan() {
            return 0.0;
        }
        joint.x[row] += step * innovation;
        let row = &mut joint.p[row].0.as_chunks_mut().0[..feet];
        for (p, gain) in row.iter_mut().zip(&*gain) {
            add_scaled(p, -step, gain);
        }
    }
    innovation * innovation * scale
}

/// Adds `factor` times `other` to `sum`.
#[inline(always)]
fn add_scaled(sum: &mut [f64; STATES], factor: f64, other: &[f64; STATES]) {
    for (sum, other) in sum.iter_mut().zip(other) {
        *sum += factor * other;
    }
}

impl Joint {
    pub(super) fn new() -> Self {
        Self { states: 0, x: [0.0; MOST], p: [Row([0.0; MOST]); MOST] }
    }

    /// Removes all feet.
    pub(super) fn clear(&mut self) {
        self.states = 0;
    }

    /// Adds a foot with its own state and covariance, independent of the feet added before.
    pub(super) fn add(&mut self, foot: &Track) {
        let at = self.states;
        if at + STATES > MOST {
            return;
        }
        self.states += STATES;
        self.x[at..at + STATES].copy_from_slice(&foot.state);
        for row in 0..STATES {
            self.p[at + row].0[at..at + STATES].copy_from_slice(&foot.covariance[row]);
            for other in 0..at {
                self.p[at + row].0[other] = 0.0;
                self.p[other].0[at + row] = 0.0;
            }
        }
    }

    /// Sets the covariance between two feet of the filter.
    pub(super) fn link(&mut self, first: usize, second: usize, cross: &[[f64; STATES]; STATES]) {
        for (row, values) in cross.iter().enumerate() {
            for (column, &value) in values.iter().enumerate() {
                self.p[first * STATES + row].0[second * STATES + column] = value;
                self.p[second * STATES + column].0[first * STATES + row] = value;
            }
        }
    }

    /// The covariance between two feet of the filter.
    pub(super) fn cross(&self, first: usize, second: usize) -> [[f64; STATES]; STATES] {
        std::array::from_fn(|row| {
            std::array::from_fn(|column| self.p[first * STATES + row].0[second * STATES + column])
        })
    }

    /// Copies the state and covariance of one foot to its track.
    pub(super) fn take(&self, which: usize, foot: &mut Track) {
        let at = which * STATES;
        foot.state.copy_from_slice(&self.x[at..at + STATES]);
        foot.has_lone_covariance = false;
        for row in 0..STATES {
            foot.covariance[row].copy_from_slice(&self.p[at + row].0[at..at + STATES]);
        }
    }

    /// Predicts one pair (value, rate): value += `reach` · rate, rate *= `decay`; the rate's variance grows by
    /// `process_noise`.
    pub(super) fn drift(&mut self, value: usize, reach: f64, decay: f64, process_noise: f64) {
        let rate = value + 1;
        let n = self.states;
        self.x[value] += reach * self.x[rate];
        self.x[rate] *= decay;
        for column in 0..n {
            self.p[value].0[column] += reach * self.p[rate].0[column];
            self.p[rate].0[column] *= decay;
        }
        for row in 0..n {
            self.p[row].0[value] += reach * self.p[row].0[rate];
            self.p[row].0[rate] *= decay;
        }
        self.p[rate].0[rate] += process_noise;
    }

    /// Predicts one state that relaxes towards `rest`: x = rest + `decay` (x − rest); its variance grows by
    /// `process_noise`.
    pub(super) fn relax(&mut self, state: usize, rest: f64, decay: f64, process_noise: f64) {
        let n = self.states;
        self.x[state] = rest + decay * (self.x[state] - rest);
        for column in 0..n {
            self.p[state].0[column] *= decay;
        }
        for row in 0..n {
            self.p[row].0[state] *= decay;
        }
        self.p[state].0[state] += process_noise;
    }

    /// Updates the filter with one scalar observation: its innovation, its Jacobian row and its variance R.
    ///
    /// Returns the normalised innovation squared, innovation² / (H P Hᵀ + R).
    pub(super) fn observe(&mut self, innovation: f64, jacobian: &[Derivative], variance: f64) -> f64 {
        take_in(self, innovation, jacobian, variance)
    }

    /// The force of each foot in the filter.
    pub(super) fn forces(&self) -> impl Iterator<Item = f64> {
        self.x[..self.states].iter().skip(FORCE).step_by(STATES).copied()
    }

    /// Limits every state to its possible range.
    pub(super) fn confine(&mut self, (low, high): (DVec2, DVec2)) {
        for at in (0..self.states).step_by(STATES) {
            let state = &mut self.x[at..at + STATES];
            state[FORCE] = state[FORCE].max(0.0);
            // Without force, rounding alone determines the place.
            state[EAST] = state[EAST].clamp(low.x, high.x);
            state[NORTH] = state[NORTH].clamp(low.y, high.y);
            state[EAST + 1] = state[EAST + 1].clamp(-2.0, 2.0);
            state[NORTH + 1] = state[NORTH + 1].clamp(-2.0, 2.0);
            for half in [HALF_EAST, HALF_NORTH] {
                state[half] =
                    state[half].clamp(super::params::state::HALF_LEAST, super::params::state::HALF_MOST);
            }
        }
        let n = self.states;
        for state in 0..n {
            if self.p[state].0[state] < LEAST_VARIANCE {
                // The remainder is rounding error and has no correlation with other states.
                for other in 0..n {
                    self.p[state].0[other] = 0.0;
                    self.p[other].0[state] = 0.0;
                }
                self.p[state].0[state] = LEAST_VARIANCE;
            }
        }
    }
}
