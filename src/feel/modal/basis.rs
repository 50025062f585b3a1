//! The polynomial terms by which a mode is computed for many samples at once.

// Loops over lanes stay plain indexed loops: those are the ones that become vector instructions.
#![allow(clippy::needless_range_loop)]

use super::multiply_add;

/// Samples that one set of terms describes.
pub(crate) const SPAN: usize = 64;

/// Terms that describe a span.
///
/// With 16, a mode of 1000 Hz at 44.1 kHz is off by less than -140 dB, a slower one or a higher
/// rate by less.
pub(crate) const TERMS: usize = 16;

/// Terms that describe a span of a smooth mode.
pub(crate) const FEW: usize = TERMS / 2;

/// Maximum turn and decay of a smooth mode in half a span, in radians.
///
/// The first eight terms of `exp(x t)`, t from -1 to 1, leave out a share of about `sqrt(17) |x|^8 / 17!!`: -140 dB.
/// At 96 kHz that makes modes up to 460 Hz smooth, at 48 kHz up to 230 Hz.
const SMOOTH: f64 = 0.97;

const HALF: usize = SPAN / 2;

/// Shapes that add up to every span of every mode.
///
/// A span lasts 1.5 ms at most, so that the slow modes of a floor draw little more than a parabola in it: for every
/// mode, the 64 samples are a sum of the same few polynomials. A bank adds up its modes polynomial by polynomial, and
/// draws the sum once: 64 modes cost far less than 64 sines.
///
/// # Source
/// Discrete Legendre polynomials, which are orthonormal on the samples of a span, by the recurrence
/// of Gram and Chebyshev.
#[derive(Debug)]
pub(crate) struct Basis {
    /// For each sample, its share in each term: decomposes samples into terms.
    shares: [[f64; TERMS]; SPAN],
    /// The later half of each polynomial; the earlier is its mirror image, negative for odd numbers.
    later: [[f32; HALF]; TERMS],
    /// The same values, sample by sample.
    by_sample: [[f32; TERMS]; HALF],
}

#[expect(
    clippy::disallowed_types,
    reason = "made by each bank's `new`: the callback finds it there and never waits"
)]
static BASIS: std::sync::LazyLock<Basis> = std::sync::LazyLock::new(Basis::build);

impl Basis {
    /// The shared basis; the first call takes memory and time.
    pub(crate) fn get() -> &'static Self {
        &BASIS
    }

    fn build() -> Self {
        let place = |n: usize| (n as f64 - (SPAN - 1) as f64 / 2.0) / HALF as f64;
        let mut shares = [[0.0; TERMS]; SPAN];
        for term in 0..TERMS {
            // Orthogonal to all but the last but one already, by symmetry.
            let overlap: f64 = match term {
                0 | 1 => 0.0,
                _ => (0..SPAN).map(|n| place(n) * shares[n][term - 1] * shares[n][term - 2]).sum(),
            };
            for n in 0..SPAN {
                shares[n][term] = match term {
                    0 => 1.0,
                    1 => place(n) * shares[n][0],
                    _ => place(n) * shares[n][term - 1] - overlap * shares[n][term - 2],
                };
            }
            let length = shares.iter().map(|share| share[term] * share[term]).sum::<f64>().sqrt();
            shares.iter_mut().for_each(|share| share[term] /= length);
        }
        // Products with ever smaller numbers must not become denormal.
        let rounded = |x: f64| if x.abs() < 1e-9 { 0.0 } else { x as f32 };
        Self {
            later: std::array::from_fn(|term| std::array::from_fn(|n| rounded(shares[HALF + n][term]))),
            by_sample: std::array::from_fn(|n| shares[HALF + n].map(rounded)),
            shares,
        }
    }

    /// Whether the first [`FEW`] terms describe a mode that turns by `angle` and shrinks by the factor `exp(-fade)`
    /// per sample.
    pub(super) fn is_smooth(angle: f64, fade: f64) -> bool {
        angle.hypot(fade) * HALF as f64 <= SMOOTH
    }

    /// The terms of a span of samples given as (real, imaginary) pairs, both parts.
    #[inline(always)]
    pub(super) fn terms_of(&self, re: &[f64; SPAN], im: &[f64; SPAN]) -> [[f64; TERMS]; 2] {
        let mut terms = [[0.0; TERMS]; 2];
        for n in 0..SPAN {
            for term in 0..TERMS {
                terms[0][term] += self.shares[n][term] * re[n];
                terms[1][term] += self.shares[n][term] * im[n];
            }
        }
        terms
    }

    /// Adds the span that the first terms describe to `out`.
    #[inline(always)]
    pub(super) fn draw<const FUSED: bool>(&self, terms: &[f32], out: &mut [f32; SPAN]) {
        let (mut even, mut odd) = ([0.0; HALF], [0.0; HALF]);
        for (shapes, terms) in self.later.as_chunks::<2>().0.iter().zip(terms.as_chunks::<2>().0) {
            for n in 0..HALF {
                even[n] = multiply_add::<FUSED>(terms[0], shapes[0][n], even[n]);
                odd[n] = multiply_add::<FUSED>(terms[1], shapes[1][n], odd[n]);
            }
        }
        for n in 0..HALF {
            out[HALF + n] += even[n] + odd[n];
            out[HALF - 1 - n] += even[n] - odd[n];
        }
    }

    /// Writes the spans that the first terms describe, one per lane, to the columns of `out`.
    #[inline(always)]
    pub(super) fn draw_side_by_side<const FUSED: bool, const LANES: usize, const FIRST: usize>(
        &self,
        terms: &[[f32; LANES]; FIRST],
        out: &mut [[f32; LANES]; SPAN],
    ) {
        /// Samples that are computed together, so that none has to wait for another's sum.
        const TOGETHER: usize = 4;
        for first in (0..HALF).step_by(TOGETHER) {
            let (mut even, mut odd) = ([[0.0; LANES]; TOGETHER], [[0.0; LANES]; TOGETHER]);
            for pair in 0..FIRST / 2 {
                for n in 0..TOGETHER {
                    let share = &self.by_sample[first + n];
                    for lane in 0..LANES {
                        even[n][lane] =
                            multiply_add::<FUSED>(share[2 * pair], terms[2 * pair][lane], even[n][lane]);
                        odd[n][lane] = multiply_add::<FUSED>(
                            share[2 * pair + 1],
                            terms[2 * pair + 1][lane],
                            odd[n][lane],
                        );
                    }
                }
            }
            for n in 0..TOGETHER {
                for lane in 0..LANES {
                    out[HALF + first + n][lane] = even[n][lane] + odd[n][lane];
                    out[HALF - 1 - first - n][lane] = even[n][lane] - odd[n][lane];
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shapes_are_orthonormal() {
        let basis = Basis::build();
        for a in 0..TERMS {
            for b in 0..TERMS {
                let product: f64 = basis.shares.iter().map(|share| share[a] * share[b]).sum();
                assert!((product - f64::from(u8::from(a == b))).abs() < 1e-12, "{a} and {b}: {product}");
            }
        }
    }

    #[test]
    fn drawing_one_span_and_many_side_by_side_is_the_same() {
        let basis = Basis::build();
        let terms: [[f32; 4]; TERMS] =
            std::array::from_fn(|term| std::array::from_fn(|lane| ((term * 7 + lane * 5) % 11) as f32 - 5.0));
        let mut columns = [[f32::NAN; 4]; SPAN];
        basis.draw_side_by_side::<false, 4, TERMS>(&terms, &mut columns);
        for lane in 0..4 {
            let mut row = [0.0; SPAN];
            basis.draw::<false>(&terms.map(|term| term[lane]), &mut row);
            for n in 0..SPAN {
                assert!((row[n] - columns[n][lane]).abs() < 1e-4, "sample {n} of lane {lane}");
            }
        }
    }
}
