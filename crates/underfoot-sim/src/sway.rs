//! Slow sway of a standing person.

use std::f32::consts::TAU;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::curve::Curve;

/// Sway of one person: a sum of three sines in each direction.
#[derive(Clone, Debug)]
pub(super) struct Sway {
    /// 1 while standing, 0 during other moves.
    pub(super) strength: Curve,
    phases: [f32; 6],
}

impl Sway {
    pub(super) fn new(seed: u64) -> Self {
        let mut rng = Pcg64Mcg::seed_from_u64(seed);
        Self { strength: Curve::default(), phases: std::array::from_fn(|_| rng.random_range(0.0..TAU)) }
    }

    /// Returns the weight shifted to the left foot, in body weights, and the roll added to both feet.
    ///
    /// Together they move the body's centre of pressure by a few millimetres, at 0.1 to 0.7 Hz, as in quiet standing.
    pub(super) fn at(&self, at_s: f64) -> (f32, f32) {
        let strength = self.strength.at(at_s);
        let wave =
            |hertz: f64, phase: usize| ((at_s * hertz).fract() as f32 * TAU + self.phases[phase]).sin();
        let sideways = wave(0.13, 0) + 0.6 * wave(0.31, 1) + 0.3 * wave(0.71, 2);
        let lengthways = wave(0.11, 3) + 0.6 * wave(0.27, 4) + 0.3 * wave(0.67, 5);
        (0.02 * strength * sideways, 0.008 * strength * lengthways)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sways_slowly_and_only_while_standing() {
        let mut sway = Sway::new(1);
        sway.strength.rest(0.0, 1.0);
        let shifts: Vec<f32> = (0..60_000).map(|ms| sway.at(f64::from(ms) * 1e-3).0).collect();
        let (low, high) = shifts.iter().fold((0.0f32, 0.0f32), |(l, h), &s| (l.min(s), h.max(s)));
        assert!((0.02..0.08).contains(&(high - low)), "{low} to {high} of the weight");
        // At most 0.1 body weights per second: faster shifts would be steps.
        assert!(shifts.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 1e-4));
        sway.strength.rest(60.0, 0.0);
        assert_eq!(sway.at(61.0), (0.0, 0.0));
    }
}
