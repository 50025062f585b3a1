//! Tests of goodness of fit: Kolmogorov and Smirnov, chi-square.

use serde::Serialize;

/// Goodness of fit of a sample to its expected distribution.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Goodness {
    /// The test's statistic.
    pub statistic: f64,
    /// Probability of a statistic at least as large if the sample does come from the distribution.
    pub p: f64,
}

impl Goodness {
    /// The test of Kolmogorov and Smirnov for `shares`, the distribution function at each value of the sample, which
    /// is uniform between 0 and 1 if the sample fits. Sorts `shares`.
    ///
    /// # Source
    /// The asymptotic distribution of sqrt(n) D with Stephens' correction for finite n.
    #[must_use]
    pub fn kolmogorov_smirnov(shares: &mut [f64]) -> Self {
        shares.sort_by(f64::total_cmp);
        let n = shares.len() as f64;
        let apart =
            |(index, share): (usize, &f64)| (share - index as f64 / n).max((index + 1) as f64 / n - share);
        let statistic = shares.iter().enumerate().map(apart).fold(0.0, f64::max);
        let scaled = (n.sqrt() + 0.12 + 0.11 / n.sqrt()) * statistic;
        // The alternating series converges at once except for tiny arguments, where p is 1.
        let term =
            |k: i32| f64::from(1 - 2 * ((k + 1) % 2)) * (-2.0 * f64::from(k * k) * scaled * scaled).exp();
        let p = if scaled < 0.3 { 1.0 } else { (2.0 * (1..=40).map(term).sum::<f64>()).clamp(0.0, 1.0) };
        Self { statistic, p }
    }

    /// The chi-squared test of counts against their expected means; `fixed` is the number of parameters taken from
    /// the sample itself (one: the total).
    ///
    /// # Source
    /// Wilson and Hilferty 1931: the cube root of chi-squared over its degrees of freedom is nearly normal.
    #[must_use]
    pub fn chi_squared(counts: &[u64], expected: &[f64], fixed: usize) -> Self {
        let pairs = counts.iter().zip(expected);
        let statistic = pairs.map(|(count, mean)| (*count as f64 - mean).powi(2) / mean).sum::<f64>();
        let freedom = counts.len().saturating_sub(fixed).max(1) as f64;
        let spread = 2.0 / (9.0 * freedom);
        let normal = ((statistic / freedom).cbrt() - (1.0 - spread)) / spread.sqrt();
        Self { statistic, p: 1.0 - normal_share(normal) }
    }
}

/// The standard normal distribution function.
///
/// # Source
/// By the continued fraction of the tail beyond 2.5, by the series of the error function below.
pub(super) fn normal_share(x: f64) -> f64 {
    let density = (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt();
    if x.abs() > 2.5 {
        let fraction = (1..=60).rev().fold(x.abs(), |rest, k| x.abs() + f64::from(k) / rest);
        return if x > 0.0 { 1.0 - density / fraction } else { density / fraction };
    }
    // Phi(x) = 1/2 + phi(x) (x + x^3/3 + x^5/(3 5) + ...)
    let (mut term, mut sum) = (x, x);
    for k in 1..60 {
        term *= x * x / f64::from(2 * k + 1);
        sum += term;
    }
    0.5 + density * sum
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::*;

    #[test]
    fn the_normal_distribution_is_the_textbook_s() {
        for (x, share) in [
            (0.0, 0.5),
            (1.0, 0.841_344_746),
            (-1.96, 0.024_997_895),
            (2.5, 0.993_790_335),
            (3.5, 0.999_767_371),
        ] {
            assert!((normal_share(x) - share).abs() < 1e-8, "{x}: {}", normal_share(x));
        }
    }

    #[test]
    fn even_samples_pass_and_skewed_ones_fail() {
        let mut rng = Pcg64Mcg::seed_from_u64(1);
        let mut ps = Vec::new();
        for _ in 0..200 {
            let mut even: Vec<f64> = (0..2000).map(|_| rng.random()).collect();
            let mut counts = [0_u64; 10];
            even.iter().for_each(|share| counts[(share * 10.0) as usize] += 1);
            ps.push(Goodness::kolmogorov_smirnov(&mut even).p);
            ps.push(Goodness::chi_squared(&counts, &[200.0; 10], 1).p);
            let mut skewed: Vec<f64> = even.iter().map(|share| share.powf(1.3)).collect();
            assert!(Goodness::kolmogorov_smirnov(&mut skewed).p < 0.05);
        }
        // The p values of fitting samples are themselves uniform.
        assert!(Goodness::kolmogorov_smirnov(&mut ps).p > 0.01);
        // The table's 5 % points: 16.92 for nine degrees of freedom.
        let counts = [200 + 58, 200, 200, 200, 200, 200, 200, 200, 200, 200 - 1];
        let found = Goodness::chi_squared(&counts, &[200.0; 10], 1);
        assert!((found.p - 0.05).abs() < 0.01, "{found:?}");
    }
}
