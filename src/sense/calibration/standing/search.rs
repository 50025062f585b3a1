//! Search for the laws of all sensors, and what the measurements tell about them.

use std::collections::BTreeMap;

use glam::{DVec2, Vec2};
use nalgebra::DMatrix;

use super::curve::LawCurve;
use super::data::{StandData, is_saturated};
use super::equations::{EquationKind, Equations, P_SPREAD, PLACE_ERROR_M, Q_SPREAD, Used, WEIGHT_ERROR};
use super::fit::{SensorFit, StandFit, StandLaws};
use super::solve::{Minimum, covariance, log_determinant, minimise};
use crate::floor::{LawKind, SensorId};
use crate::units::Newtons;

/// Sums of one, two and three squares of normal errors (chi-square): the median, and what chance exceeds in one of
/// 16,000 cases, as four standard errors of a single one (our choice).
const USUAL: [f64; 3] = [0.455, 1.386, 2.366];
const RARE: [f64; 3] = [16.0, 19.4, 22.1];

/// How much greater the errors of most stands are than expected, at least 1: parts that do not follow a law exactly
/// have greater ones in all stands.
fn scale(errors: &[StandErrors]) -> f64 {
    let mut sizes: Vec<f64> = errors.iter().map(|stand| stand.squares / USUAL[stand.last]).collect();
    sizes.sort_by(f64::total_cmp);
    sizes.get(sizes.len() / 2).copied().unwrap_or(1.0).max(1.0)
}

/// A person of known weight on a floor.
pub(super) struct StandSearch<'a> {
    pub(super) data: &'a StandData,
    /// Place of each sensor, in floor metres.
    pub(super) places: &'a [DVec2],
    pub(super) weight_n: f64,
    /// As [`StandData::silent`].
    pub(super) silent: Vec<bool>,
}

/// Maximum number of steps towards weights of stands; usual ones need five.
const STEPS: usize = 12;

/// Change of a weight below which the steps end.
const SETTLED: f64 = 0.05;

/// The laws of one kind with which most stands agree.
pub(super) struct RobustFit {
    pub(super) kind: LawKind,
    pub(super) found: Minimum,
    /// As [`StandLaws::misfit`].
    pub(super) misfit: f64,
    /// Positions of the stands that disagree.
    pub(super) astray: Vec<usize>,
}

/// The errors of one stand: its position, its number of equations less 1, and the sum of their squares.
struct StandErrors {
    number: usize,
    last: usize,
    squares: f64,
}

impl StandSearch<'_> {
    fn equations<'a>(&'a self, curve: &LawCurve, used: &'a Used, start: [f64; 2]) -> Equations<'a> {
        let (data, places, weight_n) = (self.data, self.places, self.weight_n);
        Equations { curve: *curve, data, places, silent: &self.silent, weight_n, used, start }
    }

    /// The laws of this kind with the least squares, from earlier ones or from the best common law.
    pub(super) fn solve(
        &self,
        kind: LawKind,
        used: &Used,
        earlier: Option<&Minimum>,
    ) -> Option<(LawCurve, Minimum)> {
        let curve = self.curve(kind, used)?;
        let start = self.common(&curve, used)?;
        let equations = self.equations(&curve, used, start);
        let first = earlier.map_or_else(|| equations.first(), |earlier| earlier.unknowns.clone());
        Some((curve, minimise(&equations, first)?))
    }

    /// The curve over all outputs under load. It stays the same if stands are left out.
    fn curve(&self, kind: LawKind, used: &Used) -> Option<LawCurve> {
        let loads = self.data.stands.iter().flat_map(|stand| &stand.loaded);
        let loads = loads.filter(|(_, volts)| *volts > 0.0 && !is_saturated(*volts));
        let mut outputs: Vec<f64> = loads.map(|(_, volts)| f64::from(*volts)).collect();
        outputs.sort_by(f64::total_cmp);
        let at_v = *outputs.get(outputs.len() / 2)?;
        let crossings = self.data.crossings.iter().zip(&used.crossings).filter(|(_, used)| **used);
        let crossed = crossings.flat_map(|(crossing, _)| crossing.loaded.values());
        let most = crossed.flat_map(|moments| moments.outputs().map(|(volts, _)| volts));
        let most_v = most.fold(outputs.last().copied()?, f64::max);
        Some(LawCurve { kind, at_v, most_v })
    }

    /// The one law for all sensors with the least squares of the stands' sums. If all stands are saturated, their sums
    /// are only lower bounds, but good enough to start from.
    fn common(&self, curve: &LawCurve, used: &Used) -> Option<[f64; 2]> {
        let stands = || self.data.stands.iter().zip(&used.stands).filter(|(_, used)| **used > 0.0);
        let is_whole = stands().any(|(stand, _)| stand.saturated() == 0);
        let stands = || stands().filter(move |(stand, _)| !is_whole || stand.saturated() == 0);
        let tried = curve.starts().into_iter().filter(|q| curve.holds(*q)).filter_map(|q| {
            let force = |volts: f32| curve.slope(volts.into(), [0.0, q]).force;
            let rest: Vec<f64> = self.data.empty.iter().map(|rest| force(rest.volts)).collect();
            let sums = stands().map(|(stand, _)| {
                let loads = stand.loaded.iter();
                loads
                    .map(|&(sensor, volts)| force(volts) - rest.get(sensor).copied().unwrap_or(0.0))
                    .sum::<f64>()
            });
            let (sum, squares) =
                sums.fold((0.0, 0.0), |(sum, squares), one| (sum + one, squares + one * one));
            let gain = sum / squares;
            let left = 1.0 - gain * sum / stands().count() as f64;
            (gain > 0.0 && left.is_finite()).then(|| (left, [(gain * self.weight_n).ln(), q]))
        });
        tried.min_by(|one, other| one.0.total_cmp(&other.0)).map(|(_, start)| start)
    }

    /// The weighted errors of all measurements.
    fn errors(&self, curve: &LawCurve, used: &Used, found: &Minimum) -> Vec<(EquationKind, f64)> {
        let mut errors = Vec::new();
        let equations = self.equations(curve, used, [0.0; 2]);
        equations.visit(&found.unknowns, |kind, error, _| {
            if kind != EquationKind::Prior {
                errors.push((kind, error));
            }
        });
        errors
    }

    /// The laws of this kind with which most stands agree. A stand that disagrees would distort the laws for all
    /// others, so its weight falls with its error.
    ///
    /// # Source
    /// Cauchy's weights, iterated (Holland and Welsch, Robust regression using iteratively reweighted least squares,
    /// 1977); Laplace's approximation of the evidence for each kind (Bishop, Pattern Recognition and Machine Learning,
    /// section 4.4).
    pub(super) fn robust(&self, kind: LawKind, used: &Used) -> Option<RobustFit> {
        let (curve, mut found) = self.solve(kind, used, None)?;
        let mut weighted = used.clone();
        let mut errors = self.stand_errors(&curve, used, &found);
        for _ in 0..STEPS {
            let (scale, mut change) = (scale(&errors), 0.0_f64);
            for stand in &errors {
                let usual = 2.0 * (stand.last + 1) as f64 * scale;
                let weight = (1.0 + stand.squares / usual).recip();
                if let Some(own) = weighted.stands.get_mut(stand.number) {
                    change = change.max((weight - *own).abs());
                    *own = weight;
                }
            }
            (_, found) = self.solve(kind, &weighted, Some(&found))?;
            errors = self.stand_errors(&curve, used, &found);
            if change < SETTLED {
                break;
            }
        }
        let equations = self.equations(&curve, &weighted, self.common(&curve, used)?);
        let mut misfit = log_determinant(&equations, &found)?;
        equations.visit(&found.unknowns, |kind, error, _| {
            if matches!(kind, EquationKind::Crossing(_) | EquationKind::Prior) {
                misfit += error * error;
            }
        });
        misfit += errors.iter().map(|stand| stand.squares.min(RARE[stand.last])).sum::<f64>();
        let rare = scale(&errors);
        let astray = errors.iter().filter(|stand| stand.squares > rare * RARE[stand.last]);
        let astray = astray.map(|stand| stand.number).collect();
        misfit.is_finite().then_some(RobustFit { kind, found, misfit, astray })
    }

    /// The errors of all stands that count, without their weights.
    fn stand_errors(&self, curve: &LawCurve, used: &Used, found: &Minimum) -> Vec<StandErrors> {
        let mut all: BTreeMap<usize, (usize, f64)> = BTreeMap::new();
        for (kind, error) in self.errors(curve, used, found) {
            if let EquationKind::Sum(stand) | EquationKind::Place(stand) | EquationKind::Moment(stand) = kind
            {
                let (count, squares) = all.entry(stand).or_default();
                *count += 1;
                *squares += error * error;
            }
        }
        all.into_iter()
            .map(|(number, (count, squares))| StandErrors { number, last: (count - 1).min(2), squares })
            .collect()
    }

    pub(super) fn conclude(
        &self,
        curve: &LawCurve,
        used: &Used,
        found: &Minimum,
        (laws, astray): (Vec<StandLaws>, Vec<usize>),
    ) -> StandFit {
        let errors = self.errors(curve, used, found);
        let mean = |squares: f64, count: usize| squares / count.max(1) as f64;
        let of = |wanted: fn(&EquationKind) -> bool| {
            let squares = errors.iter().filter(|(kind, _)| wanted(kind)).map(|(_, error)| error * error);
            (squares.clone().sum::<f64>(), squares.count())
        };
        let (sums, sum_count) = of(|kind| matches!(kind, EquationKind::Sum(_)));
        let (places, place_count) = of(|kind| matches!(kind, EquationKind::Place(_)));
        let (all, all_count) = of(|_| true);
        let lean = 2 * self.places.len();
        let number = |index: usize| found.unknowns.get(index).copied().unwrap_or_default();
        let covariance =
            covariance(&self.equations(curve, used, [number(lean + 2), number(lean + 3)]), found);
        let scale = covariance.as_ref().map_or(1.0, |covariance| {
            // Each unknown that the measurements determine better than the prior takes an error away.
            let spreads = [P_SPREAD * P_SPREAD, Q_SPREAD * Q_SPREAD];
            let taken = |index: usize| (1.0 - covariance[(index, index)] / spreads[index % 2]).max(0.0);
            let free = all_count as f64 - (0..lean).map(taken).sum::<f64>();
            all / free.max(1.0)
        });
        let ids = self.data.empty.iter().map(|rest| rest.sensor).enumerate();
        let saturated = self.data.stands.iter().enumerate().filter(|(_, stand)| stand.saturated() > 0);
        StandFit {
            kind: curve.kind,
            laws,
            sensors: ids
                .map(|(index, sensor)| {
                    let at = [number(2 * index), number(2 * index + 1)];
                    self.sensor((index, sensor), curve, used, at, covariance.as_ref(), scale)
                })
                .collect(),
            weight_residual: (mean(sums, sum_count).sqrt() * WEIGHT_ERROR) as f32,
            place_residual_m: (mean(2.0 * places, place_count).sqrt() * PLACE_ERROR_M) as f32,
            lean_m: Vec2::new(number(lean) as f32, number(lean + 1) as f32),
            stands: used.stands(),
            astray,
            saturated: saturated.map(|(number, _)| number).collect(),
            crossings: used.crossings.iter().filter(|used| **used).count(),
        }
    }

    fn sensor(
        &self,
        (index, sensor): (usize, SensorId),
        curve: &LawCurve,
        used: &Used,
        at: [f64; 2],
        covariance: Option<&DMatrix<f64>>,
        scale: f64,
    ) -> SensorFit {
        let empty_v = self.data.empty.get(index).map_or(0.0, |rest| f64::from(rest.volts));
        let law = curve.law(at, empty_v);
        let tared = |volts: f64| curve.slope(volts, at) - curve.slope(empty_v, at);
        let stands = self.data.stands.iter().zip(&used.stands).filter(|(_, used)| **used > 0.0);
        let loads = stands.flat_map(|(stand, _)| stand.loaded.iter().filter(|(sensor, _)| *sensor == index));
        let most = loads.map(|(_, volts)| tared(f64::from(*volts)).force).fold(0.0, f64::max);
        let tare = law.force_at(empty_v as f32);
        let block = covariance.map(|all| {
            let (p, q) = (2 * index, 2 * index + 1);
            [scale * all[(p, p)], scale * all[(p, q)], scale * all[(q, q)]]
        });
        let share = |load: f64| {
            let volts = f64::from(law.volts_at(Newtons(load as f32) + tare)).min(curve.most_v);
            let slope = tared(volts);
            let [pp, pq, qq] = block?;
            let variance =
                slope.by_p.powi(2) * pp + 2.0 * slope.by_p * slope.by_q * pq + slope.by_q.powi(2) * qq;
            Some(variance.max(0.0).sqrt() / slope.force)
        };
        let shares = [self.weight_n / 8.0, self.weight_n / 4.0].map(|load| share(load).unwrap_or(f64::NAN));
        let determined = block.map_or(0, |block| determined(curve.kind, block));
        let is_known = most > 0.0 && law.is_plausible();
        SensorFit {
            sensor,
            law,
            tare,
            most: Newtons(most as f32),
            uncertainty: shares[0].max(shares[1]) as f32,
            determined: if is_known { determined } else { 0 },
            sure_to: Newtons(f32::INFINITY),
        }
    }
}

/// How many combinations of a law's two numbers with this covariance (pp, pq, qq) are known twice as well as those of
/// a typical part: the eigenvalues of the covariance in units of the parts' spread. Both numbers of a curve trade off
/// against each other, so one combination may be known well although neither number is.
fn determined(kind: LawKind, [pp, pq, qq]: [f64; 3]) -> u8 {
    let is_found = |variance: f64| variance.max(0.0).sqrt() < 0.5;
    let (pp, qq) = (pp / (P_SPREAD * P_SPREAD), qq / (Q_SPREAD * Q_SPREAD));
    if kind == LawKind::Linear {
        return 2 * u8::from(is_found(pp));
    }
    let (mean, half) = (0.5 * (pp + qq), 0.5 * (pp - qq));
    let root = half.hypot(pq / (P_SPREAD * Q_SPREAD));
    u8::from(is_found(mean - root)) + u8::from(is_found(mean + root))
}
