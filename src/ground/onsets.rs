//! Times of events: a Poisson process with a rate that follows a signal.

use rand_distr::{Distribution, Exp1};
use rand_pcg::Pcg64Mcg;

/// Maximum rate of one process, in events per second.
const MOST_PER_S: f64 = 16_000.0;

/// Times of events: a Poisson process with a rate that follows a signal.
///
/// The time to the next event is drawn in units of the expected number of events; each step uses some of it up, and
/// the event lies where it runs out within a step. So events have times of their own within the millisecond, and no
/// rate is too small or too large for the step.
///
/// # Source
/// Time rescaling: the integral of the rate between two events is exponentially
/// distributed with mean 1.
#[derive(Clone, Copy, Debug)]
pub struct Onsets {
    /// Remaining integral of the rate up to the next event.
    left: f64,
}

impl Onsets {
    /// A process that has just had an event.
    #[must_use]
    pub fn new(rng: &mut Pcg64Mcg) -> Self {
        Self { left: Exp1.sample(rng) }
    }

    /// Advances by `step_s` seconds, in which the rate changes linearly from the first to the second of `rates` (per
    /// second); passes to `event` the place of each event within the step, 0 to 1.
    ///
    /// Rates below zero or NaN count as zero, rates above 16,000 as that.
    pub fn advance(
        &mut self,
        rates: [f64; 2],
        step_s: f64,
        rng: &mut Pcg64Mcg,
        mut event: impl FnMut(f64, &mut Pcg64Mcg),
    ) {
        let [first, last] = rates.map(|rate| if rate > 0.0 { rate.min(MOST_PER_S) } else { 0.0 });
        let whole = 0.5 * (first + last) * step_s;
        let mut reached = 0.0;
        while reached + self.left <= whole && whole > 0.0 {
            reached += self.left;
            self.left = Exp1.sample(rng);
            // Where first s + (last - first) s^2 / 2 equals `reached / step_s`, in the form that also works for equal
            // rates.
            let c = reached / step_s;
            let root = (first * first + 2.0 * (last - first) * c).max(0.0).sqrt();
            event((2.0 * c / (first + root).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0), rng);
        }
        self.left -= whole - reached;
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;

    use super::*;

    #[test]
    fn a_rate_that_rises_within_the_step_gives_later_events() {
        let mut rng = Pcg64Mcg::seed_from_u64(3);
        let mut onsets = Onsets::new(&mut rng);
        let (mut sum, mut count) = (0.0, 0.0);
        for _ in 0..20_000 {
            onsets.advance([0.0, 2000.0], 1e-3, &mut rng, |share, _| {
                assert!((0.0..=1.0).contains(&share));
                sum += share;
                count += 1.0;
            });
        }
        // One event a step on average; with density 2 s on 0..1 their mean is 2/3.
        assert!((count - 20_000.0_f64).abs() < 5.0 * 20_000.0_f64.sqrt(), "{count}");
        assert!((sum / count - 2.0 / 3.0_f64).abs() < 0.01, "{}", sum / count);
    }

    #[test]
    fn no_rate_is_too_absurd() {
        let mut rng = Pcg64Mcg::seed_from_u64(3);
        let mut onsets = Onsets::new(&mut rng);
        let mut count = 0;
        for rates in [[f64::NAN, f64::NAN], [-5.0, -1.0], [0.0, 0.0], [f64::INFINITY, 1e300]] {
            onsets.advance(rates, 1e-3, &mut rng, |_, _| count += 1);
        }
        assert!(count < 60, "{count}");
    }
}
