//! Selection of the law that a sensor follows.

use nalgebra::DVector;

use super::law_fit::{Fit, FitError, LawParameters, LoadPoint, MeasuredLoads};
use crate::floor::LawKind;

/// The fit of each law to a sensor's measurements, and the law selected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// One candidate per law, in [`LawKind::ALL`] order.
    pub candidates: [Candidate; 4],
    /// The selected law; `None` where no law fits.
    pub chosen: Option<LawKind>,
}

/// The fit of one law in comparison with the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// The law.
    pub kind: LawKind,
    /// Its best fit, by least squares of the force error; a law without a fit is not compared.
    pub fit: Result<Fit, FitError>,
    /// Excess of its information criterion over that of the best candidate (see [`Comparison::of`]): 0 for the best,
    /// infinite for a law without a fit or with too few measurements for a comparison.
    pub excess: f32,
}

/// Minimum number of measurements for a comparison of laws with two parameters and a spread; with fewer, the
/// corrected criterion divides by zero.
const LEAST_COMPARED: usize = 5;

/// Maximum excess at which the paper's law is selected: a model within 2 of the best has substantial support.
///
/// # Source
/// Burnham and Anderson, Model Selection and Multimodel Inference, 2002, section 2.6.
const PAPER_KEPT: f64 = 2.0;

/// Maximum excess at which a straight line is preferred to a curve: from 4 on a model has considerably less support
/// (the same source). A power law with an exponent near one and a divider with a distant supply are straight lines
/// except for the noise that they follow: by the least excess alone, 2 % of noise gives one of six synthetic linear
/// parts another law.
const STRAIGHT_KEPT: f64 = 4.0;

/// Voltage up to which a reading shows only that the load is light: 0.5 % of the converter's range, its offset and
/// noise. A part with a law that starts at a force, such as the paper's, reads zero below it.
const NOTHING_V: f32 = 0.025;

/// Error of every load, as a share of the maximum: light loads have no constant relative error.
const LIGHT: f64 = 0.005;

/// Relative error below which laws are indistinguishable: no bench knows its forces better (our choice).
const BENCH: f64 = 1e-3;

impl Comparison {
    /// Fits every law to `points` and selects one.
    ///
    /// The fit of each law is that of [`Fit::of`] for the exponential one. Akaike's information criterion compares
    /// them, with normal errors of one of two spreads, the one with the lower value for the law: constant in newtons,
    /// or in proportion to the load. Every law has two parameters and a spread, so the criterion's terms for their
    /// number, and its correction for few measurements, are the same for all. Errors that resemble their neighbours
    /// (hysteresis, a wave that no law follows) are not independent evidence: the difference is scaled by the share of
    /// measurements that count as independent. Readings of next to nothing are left out of the comparison, like
    /// saturated ones.
    ///
    /// The paper's exponential law is selected if its excess is at most 2, then a straight line if its excess is at
    /// most 4; otherwise the law with the lowest value. Fewer than five measurements permit no comparison: the first
    /// law that fits is selected, in an order that begins with the paper's.
    ///
    /// # Source
    /// `AIC = n ln(RSS / n) + 2 k` (Burnham and Anderson, 2002, section 2.2), with weighted squares for proportional
    /// errors; `n (1 - r) / (1 + r)` independent values of n with a correlation r between neighbours (Bartlett,
    /// 1935).
    #[must_use]
    pub fn of(points: &[LoadPoint]) -> Self {
        let loads = match MeasuredLoads::of(points) {
            Ok(loads) => loads,
            Err(error) => {
                let failed = |kind| Candidate { kind, fit: Err(error), excess: f32::INFINITY };
                return Self { candidates: LawKind::ALL.map(failed), chosen: None };
            }
        };
        let mut candidates =
            LawKind::ALL.map(|kind| Candidate { kind, fit: loads.fit(kind), excess: f32::INFINITY });
        let telling: Vec<_> = points.iter().copied().filter(|point| point.volts > NOTHING_V).collect();
        let telling =
            MeasuredLoads::of(&telling).ok().filter(|telling| telling.volts.len() >= LEAST_COMPARED);
        let Some(telling) = telling else {
            return Self { candidates, chosen: first_that_fits(&candidates) };
        };
        let spreads = [Spread::same(&telling), Spread::proportional(&telling)];
        let criteria = candidates.map(|candidate| match candidate.fit {
            Ok(_) => Criterion::least(candidate.kind, &telling, &spreads),
            Err(_) => None,
        });
        let best = criteria.iter().flatten().min_by(|one, other| one.value.total_cmp(&other.value));
        let Some(best) = best else { return Self { candidates, chosen: first_that_fits(&candidates) } };
        let independent = independent_share(&telling, &best.errors);
        for (candidate, criterion) in candidates.iter_mut().zip(&criteria) {
            if let Some(criterion) = criterion {
                candidate.excess = ((criterion.value - best.value) * independent) as f32;
            }
        }
        let kept = |kind: LawKind, most: f64| {
            let candidate = candidates.iter().find(|candidate| candidate.kind == kind);
            candidate.is_some_and(|candidate| f64::from(candidate.excess) <= most).then_some(kind)
        };
        let chosen = kept(LawKind::Exponential, PAPER_KEPT)
            .or_else(|| kept(LawKind::Linear, STRAIGHT_KEPT))
            .unwrap_or(best.kind);
        Self { candidates, chosen: Some(chosen) }
    }

    /// The candidate of this law.
    #[must_use]
    pub const fn candidate(&self, kind: LawKind) -> &Candidate {
        let [exponential, power, divider, linear] = &self.candidates;
        match kind {
            LawKind::Exponential => exponential,
            LawKind::Power => power,
            LawKind::Divider => divider,
            LawKind::Linear => linear,
        }
    }

    /// The fit of the selected law.
    ///
    /// # Errors
    /// The error of the exponential law, if no law fits.
    pub fn fit(&self) -> Result<Fit, FitError> {
        self.candidate(self.chosen.unwrap_or(LawKind::Exponential)).fit
    }
}

/// The law selected without a comparison.
fn first_that_fits(candidates: &[Candidate; 4]) -> Option<LawKind> {
    candidates.iter().find(|candidate| candidate.fit.is_ok()).map(|candidate| candidate.kind)
}

/// Assumed spread of the measurement errors.
struct Spread {
    /// Reciprocal of each measurement's standard deviation, to a common factor.
    weights: DVector<f64>,
    /// Least variance of a weighted error.
    least: f64,
    /// Contribution of the weights to the criterion.
    constant: f64,
}

impl Spread {
    /// Constant at every load.
    fn same(loads: &MeasuredLoads) -> Self {
        let least = (BENCH * loads.forces.max()).powi(2);
        Self { weights: DVector::repeat(loads.forces.len(), 1.0), least, constant: 0.0 }
    }

    /// In proportion to the load.
    fn proportional(loads: &MeasuredLoads) -> Self {
        let light = LIGHT * loads.forces.max();
        let weights = loads.forces.map(|force| force.hypot(light).recip());
        let constant = -2.0 * weights.iter().map(|weight| weight.ln()).sum::<f64>();
        Self { weights, least: BENCH * BENCH, constant }
    }
}

/// Akaike's criterion of one law, without the terms that all laws share.
struct Criterion {
    kind: LawKind,
    value: f64,
    /// Weighted errors of the fit.
    errors: DVector<f64>,
}

impl Criterion {
    /// The criterion under the spread with the lower value; `None` if neither permits a fit.
    fn least(kind: LawKind, loads: &MeasuredLoads, spreads: &[Spread]) -> Option<Self> {
        let under = spreads.iter().filter_map(|spread| {
            let errors = LawParameters::through(kind, loads, Some(&spread.weights)).ok()?.errors();
            let count = errors.len() as f64;
            let value = count * (errors.norm_squared() / count + spread.least).ln() + spread.constant;
            value.is_finite().then_some(Self { kind, value, errors })
        });
        under.min_by(|one, other| one.value.total_cmp(&other.value))
    }
}

/// Share of `errors` that count as independent, in the order of the voltages: (1 − r) / (1 + r) with the correlation
/// r of neighbours, 1 if they are uncorrelated.
fn independent_share(loads: &MeasuredLoads, errors: &DVector<f64>) -> f64 {
    let mut order: Vec<usize> = (0..errors.len()).collect();
    order.sort_by(|one, other| loads.volts[*one].total_cmp(&loads.volts[*other]));
    let neighbours: f64 = order.windows(2).map(|pair| errors[pair[0]] * errors[pair[1]]).sum();
    let correlation = (neighbours / errors.norm_squared()).clamp(0.0, 1.0);
    if correlation.is_nan() { 1.0 } else { (1.0 - correlation) / (1.0 + correlation) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::floor::Calibration;

    /// `count` loads at even steps of voltage up to 4.8 V, each with the relative error `error`.
    fn bench(law: Calibration, count: usize, error: impl Fn(usize) -> f32) -> Vec<LoadPoint> {
        let volts = |step: usize| 4.8 * (step + 1) as f32 / count as f32;
        (0..count)
            .map(|step| LoadPoint::new(volts(step), law.force_at(volts(step)) * (1.0 + error(step))))
            .collect()
    }

    /// Two per cent up and down in an order that no curve follows.
    fn jagged(step: usize) -> f32 {
        [0.02, -0.02, -0.02, 0.02, -0.02, 0.02, 0.02, -0.02][step % 8]
    }

    #[test]
    fn each_law_is_chosen_where_the_part_follows_it_and_the_others_fall_behind() {
        for law in [
            Calibration::NOMINAL,
            Calibration::of(LawKind::Power, [1.1, 3.0]),
            Calibration::of(LawKind::Divider, [40.0, 5.0]),
            Calibration::of(LawKind::Linear, [80.0, 0.2]),
        ] {
            let compared = Comparison::of(&bench(law, 24, jagged));
            assert_eq!(compared.chosen, Some(law.kind()), "{compared:?}");
            let behind = compared.candidates.iter().filter(|other| other.kind != law.kind());
            assert!(behind.into_iter().all(|other| other.excess > 10.0), "{compared:?}");
            assert_eq!(compared.fit(), compared.candidate(law.kind()).fit);
        }
    }

    #[test]
    fn a_straight_line_is_not_called_a_power_of_one() {
        // The error grows with the load as if the line were slightly bent.
        let bent = |step: usize| jagged(step) + 2e-4 * step as f32;
        let compared = Comparison::of(&bench(Calibration::of(LawKind::Linear, [80.0, 0.0]), 24, bent));
        assert_eq!(compared.chosen, Some(LawKind::Linear), "{compared:?}");
    }

    #[test]
    fn a_wave_that_no_law_follows_is_one_departure_and_not_many() {
        let wave = |step: usize| 0.15 * (0.05 * step as f32).sin();
        let independent = |points: &[LoadPoint]| {
            let loads = MeasuredLoads::of(points).unwrap();
            let errors = LawParameters::through(LawKind::Exponential, &loads, None).unwrap().errors();
            independent_share(&loads, &errors)
        };
        assert!(independent(&bench(Calibration::NOMINAL, 400, wave)) < 0.02);
        assert!(independent(&bench(Calibration::NOMINAL, 400, jagged)) > 0.8);
    }

    #[test]
    fn too_few_loads_compare_nothing_and_the_first_law_that_fits_is_taken() {
        let power = bench(Calibration::of(LawKind::Power, [1.1, 3.0]), 4, |_| 0.0);
        let compared = Comparison::of(&power);
        assert_eq!(compared.chosen, Some(LawKind::Exponential));
        assert!(compared.candidates.iter().all(|candidate| candidate.excess.is_infinite()));
        let none = Comparison::of(&power[..2]);
        assert_eq!((none.chosen, none.fit()), (None, Err(FitError::TooFewPoints { points: 2 })));
    }

    #[test]
    fn what_no_law_follows_has_none() {
        let falling: Vec<_> = bench(Calibration::NOMINAL, 20, jagged)
            .into_iter()
            .map(|point| LoadPoint::new(5.0 - point.volts, point.force))
            .collect();
        let compared = Comparison::of(&falling);
        assert_eq!(compared.chosen, None, "{compared:?}");
        assert!(compared.candidates.iter().all(|candidate| candidate.fit.is_err()), "{compared:?}");
    }
}
