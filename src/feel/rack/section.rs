//! Filters of second order, several channels side by side.

// Loops over lanes stay plain indexed loops: those are the ones that become vector instructions.
#![allow(clippy::needless_range_loop)]

use std::f64::consts::PI;

use crate::feel::mix::LANES;
use crate::feel::modal::multiply_add;

/// The coefficients of a second-order filter.
///
/// # Source
/// Trapezoidal state-variable filter, written out as a matrix: A. Simper, "Linear Trapezoidal Integrated
/// State Variable Filter", 2013. In single precision it keeps a corner of 40 Hz at 96 kHz, where the
/// coefficients of a direct form don't.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Filter {
    /// Corner or centre, as the tangent of half its angle per sample.
    g: f64,
    /// Damping, 1 over the sharpness.
    k: f64,
    /// Shares of the input, the band-pass and the low-pass in the output.
    mix: [f64; 3],
}

impl Filter {
    /// A high-pass: passes frequencies above `hz`.
    pub(super) fn high_pass(hz: f64, sharpness: f64, sample_rate: f64) -> Self {
        let k = sharpness.recip();
        Self { g: (PI * hz / sample_rate).tan(), k, mix: [1.0, -k, -1.0] }
    }

    /// A low-pass: passes frequencies below `hz`.
    pub(super) fn low_pass(hz: f64, sharpness: f64, sample_rate: f64) -> Self {
        Self { g: (PI * hz / sample_rate).tan(), k: sharpness.recip(), mix: [0.0, 0.0, 1.0] }
    }

    /// A bell: raises frequencies around `hz` by `db`.
    pub(super) fn bell(hz: f64, sharpness: f64, db: f64, sample_rate: f64) -> Self {
        let root = 10_f64.powf(db / 40.0);
        let k = (sharpness * root).recip();
        Self { g: (PI * hz / sample_rate).tan(), k, mix: [1.0, k * (root * root - 1.0), 0.0] }
    }

    /// This filter with its output times `factor`.
    pub(super) fn louder(self, factor: f64) -> Self {
        Self { mix: self.mix.map(|part| part * factor), ..self }
    }

    /// Gain for a sine of `hz`, in decibels.
    pub(super) fn gain_db(&self, hz: f64, sample_rate: f64) -> f64 {
        // s = j w: real parts in w^0 and w^2, imaginary ones in w.
        let w = (PI * hz / sample_rate).tan() / self.g;
        let [m0, m1, m2] = self.mix;
        let below = (1.0 - w * w).hypot(self.k * w);
        let above = (m0 * (1.0 - w * w) + m2).hypot((m0 * self.k + m1) * w);
        20.0 * (above / below).log10()
    }
}

/// One second-order filter for each of a group's channels.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(super) struct FilterSection {
    /// Coefficients from the two states and the input to the next states: rows of three.
    next: [[f32; LANES]; 6],
    /// Coefficients from the two states and the input to the output.
    out: [[f32; LANES]; 3],
    states: States,
}

type States = [[f32; LANES]; 2];

impl FilterSection {
    /// Filters with an output equal to the input.
    pub(super) fn straight() -> Self {
        let mut section = Self { next: [[0.0; LANES]; 6], out: [[0.0; LANES]; 3], states: [[0.0; LANES]; 2] };
        section.out[2] = [1.0; LANES];
        section
    }

    /// Sets the filter of one channel.
    pub(super) fn set(&mut self, lane: usize, filter: &Filter) {
        let Filter { g, k, mix: [m0, m1, m2] } = *filter;
        let a1 = (1.0 + g * (g + k)).recip();
        let a2 = g * a1;
        let a3 = g * a2;
        let next = [2.0 * a1 - 1.0, -2.0 * a2, 2.0 * a2, 2.0 * a2, 1.0 - 2.0 * a3, 2.0 * a3];
        let out = [m1 * a1 + m2 * a2, m2 * (1.0 - a3) - m1 * a2, m0 + m1 * a2 + m2 * a3];
        for (coefficient, value) in self.next.iter_mut().zip(next) {
            coefficient[lane] = value as f32;
        }
        for (coefficient, value) in self.out.iter_mut().zip(out) {
            coefficient[lane] = value as f32;
        }
    }

    /// Filters a stretch of samples in place, by each of `sections` in turn.
    #[inline(always)]
    pub(super) fn run_all<const FUSED: bool>(sections: &mut [Self], columns: &mut [[f32; LANES]]) {
        // In pairs: one processes a sample while the other waits for its own last result.
        let (pairs, rest) = sections.as_chunks_mut::<2>();
        for [first, second] in pairs {
            let (mut one, mut two) = (first.states, second.states);
            for column in &mut *columns {
                first.step::<FUSED>(&mut one, column);
                second.step::<FUSED>(&mut two, column);
            }
            (first.states, second.states) = (one, two);
        }
        for section in rest {
            let mut states = section.states;
            for column in &mut *columns {
                section.step::<FUSED>(&mut states, column);
            }
            section.states = states;
        }
    }

    #[inline(always)]
    fn step<const FUSED: bool>(&self, states: &mut States, column: &mut [f32; LANES]) {
        let [m11, m12, b1, m21, m22, b2] = &self.next;
        let [c1, c2, d] = &self.out;
        for lane in 0..LANES {
            let (x, s1, s2) = (column[lane], states[0][lane], states[1][lane]);
            let y = multiply_add::<FUSED>(c1[lane], s1, d[lane] * x);
            column[lane] = multiply_add::<FUSED>(c2[lane], s2, y);
            let t1 = multiply_add::<FUSED>(m11[lane], s1, b1[lane] * x);
            let t2 = multiply_add::<FUSED>(m21[lane], s1, b2[lane] * x);
            states[0][lane] = multiply_add::<FUSED>(m12[lane], s2, t1);
            states[1][lane] = multiply_add::<FUSED>(m22[lane], s2, t2);
        }
    }

    /// The states, for the removal of tiny values.
    pub(super) fn states(&mut self) -> &mut [[f32; LANES]] {
        &mut self.states
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    const RATE: f64 = 96_000.0;

    /// The measured gain of a filter for a sine, after it has settled.
    fn measured_db(filter: &Filter, hz: f64) -> f64 {
        let mut section = FilterSection::straight();
        section.set(3, filter);
        let mut columns = vec![[0.0; LANES]; 96_000];
        for (n, column) in columns.iter_mut().enumerate() {
            column[3] = (TAU * hz * n as f64 / RATE).sin() as f32;
        }
        FilterSection::run_all::<false>(std::slice::from_mut(&mut section), &mut columns);
        let (mut re, mut im) = (0.0, 0.0);
        for (n, column) in columns.iter().enumerate().skip(48_000) {
            let angle = TAU * hz * n as f64 / RATE;
            re += f64::from(column[3]) * angle.cos();
            im += f64::from(column[3]) * angle.sin();
        }
        20.0 * (re.hypot(im) / 24_000.0).log10()
    }

    #[test]
    fn a_filter_does_what_its_shape_says() {
        for filter in [
            Filter::high_pass(40.0, 1.307, RATE),
            Filter::low_pass(950.0, 0.541, RATE),
            Filter::bell(120.0, 2.0, 9.0, RATE),
            Filter::bell(300.0, 4.0, -12.0, RATE).louder(2.0),
        ] {
            for hz in [30.0, 60.0, 120.0, 300.0, 750.0, 2000.0] {
                let (wanted, got) = (filter.gain_db(hz, RATE), measured_db(&filter, hz));
                assert!((wanted - got).abs() < 0.02, "{filter:?} at {hz} Hz: {got} instead of {wanted} dB");
            }
        }
        assert!((Filter::bell(120.0, 2.0, 9.0, RATE).gain_db(120.0, RATE) - 9.0).abs() < 1e-9);
        assert!((Filter::high_pass(40.0, 0.5_f64.sqrt(), RATE).gain_db(40.0, RATE) + 3.01).abs() < 0.01);
    }

    #[test]
    fn a_straight_section_changes_nothing() {
        let mut columns = vec![[0.3; LANES]; 10];
        FilterSection::run_all::<false>(
            &mut [FilterSection::straight(), FilterSection::straight(), FilterSection::straight()],
            &mut columns,
        );
        assert_eq!(columns, vec![[0.3; LANES]; 10]);
    }
}
