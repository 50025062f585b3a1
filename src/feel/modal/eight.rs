//! Eight modes side by side: their output, and the advance of their state.

// Loops over lanes stay plain indexed loops: those are the ones that become vector instructions.
#![allow(clippy::needless_range_loop)]

use multiversion::multiversion;

use super::basis::{Basis, FEW, SPAN, TERMS};
use super::{Key, multiply_add};

/// Modes that advance together: as many double-precision numbers as the widest register holds.
pub(super) const EIGHT: usize = 8;

/// Separate sums, so that no addition has to wait for the one before.
pub(super) const SUMS: usize = 4;

/// Eight modes side by side.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Eight {
    /// The state one sample before the next one to be rendered.
    pub(super) state: Complexes,
    /// The pole `r`.
    pub(super) turn: Complexes,
    /// `r` to the power of [`SPAN`].
    pole_power: Complexes,
    /// The first [`FEW`] terms of each mode, then the others, which smooth modes do not use.
    pub(super) power_terms: [[PowerTerms; EIGHT]; 2],
    /// The states rounded to the precision of the terms: real part, imaginary part.
    rounded: [[f32; 2]; EIGHT],
}

/// Terms of `r` to the power of 1 to [`SPAN`]: of the imaginary part, of the real one, and so on.
///
/// In the order of their factors, the state's real and its imaginary part, since a pair of numbers is spread over a
/// vector as it is read.
pub(super) type PowerTerms = [f32; 2 * FEW];

/// One complex number per mode.
#[derive(Clone, Copy, Debug)]
pub(super) struct Complexes {
    pub(super) re: [f64; EIGHT],
    pub(super) im: [f64; EIGHT],
}

impl Eight {
    pub(super) const SILENT: Self = Self {
        state: Complexes::ZERO,
        turn: Complexes::ZERO,
        pole_power: Complexes::ZERO,
        power_terms: [[[0.0; 2 * FEW]; EIGHT]; 2],
        rounded: [[0.0; 2]; EIGHT],
    };

    /// Copies into `lane` the mode from another lane of `from`.
    pub(super) fn copy(&mut self, lane: usize, from: &Self, other: usize) {
        for (terms, from) in self.power_terms.iter_mut().zip(&from.power_terms) {
            terms[lane] = from[other];
        }
        self.turn.set(lane, from.turn.get(other));
        self.pole_power.set(lane, from.pole_power.get(other));
        self.set_state(lane, from.state.get(other));
    }

    /// Adds the first or the other terms of its modes, each in two parts; an empty lane adds nothing.
    #[inline(always)]
    pub(super) fn add_terms<const FUSED: bool>(&self, part: usize, sums: &mut [PowerTerms; SUMS]) {
        for lane in 0..EIGHT {
            let (terms, sums) = (&self.power_terms[part][lane], &mut sums[lane % SUMS]);
            let state = self.rounded[lane];
            for n in 0..2 * FEW {
                sums[n] = multiply_add::<FUSED>(state[n % 2], terms[n], sums[n]);
            }
        }
    }

    /// Advances by up to a span.
    #[inline(always)]
    pub(super) fn advance(&mut self, samples: usize) {
        if samples == SPAN {
            self.state = self.state.times(&self.pole_power);
        } else {
            let mut power = self.turn;
            for exponent in 0..SPAN.ilog2() {
                if samples & (1 << exponent) != 0 {
                    self.state = self.state.times(&power);
                }
                power = power.times(&power);
            }
        }
        for lane in 0..EIGHT {
            self.rounded[lane] = [self.state.re[lane] as f32, self.state.im[lane] as f32];
        }
    }

    pub(super) fn set_state(&mut self, lane: usize, state: (f64, f64)) {
        self.state.set(lane, state);
        self.rounded[lane] = [state.0 as f32, state.1 as f32];
    }
}

/// Sets `lane` to a silent mode of this frequency and decay.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx2+fma", "x86_64+avx2+fma", "aarch64+neon"))]
pub(super) fn tune(eight: &mut Eight, lane: usize, key: Key, sample_rate: f64, basis: &Basis) {
    let (angle, fade) = key.per_sample(sample_rate);
    let shrink = (-fade).exp();
    let turn = (shrink * angle.cos(), shrink * angle.sin());

    // r; then r^2; then r^3 and r^4 as r^2 times both, and so on.
    let (mut re, mut im) = ([turn.0; SPAN], [turn.1; SPAN]);
    let mut known = 1;
    while known < SPAN {
        let power = (re[known - 1], im[known - 1]);
        for n in known..2 * known {
            (re[n], im[n]) = product((re[n - known], im[n - known]), power);
        }
        known *= 2;
    }
    // Tiny terms are set to zero, so that faint modes do not become denormal.
    let rounded = |x: f64| if x.abs() < 1e-11 { 0.0 } else { x as f32 };
    let [of_re, of_im] = basis.terms_of(&re, &im);
    for term in 0..TERMS {
        let pairs = eight.power_terms[term / FEW][lane].as_chunks_mut::<2>().0;
        pairs[term % FEW] = [rounded(of_im[term]), rounded(of_re[term])];
    }
    eight.turn.set(lane, turn);
    eight.pole_power.set(lane, (re[SPAN - 1], im[SPAN - 1]));
    eight.set_state(lane, (0.0, 0.0));
}

impl Complexes {
    const ZERO: Self = Self { re: [0.0; EIGHT], im: [0.0; EIGHT] };

    pub(super) fn get(&self, lane: usize) -> (f64, f64) {
        (self.re[lane], self.im[lane])
    }

    fn set(&mut self, lane: usize, (re, im): (f64, f64)) {
        self.re[lane] = re;
        self.im[lane] = im;
    }

    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        let mut result = Self::ZERO;
        for lane in 0..EIGHT {
            result.re[lane] = self.re[lane] * other.re[lane] - self.im[lane] * other.im[lane];
            result.im[lane] = self.re[lane] * other.im[lane] + self.im[lane] * other.re[lane];
        }
        result
    }
}

#[inline(always)]
pub(super) fn product(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}
