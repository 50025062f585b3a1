//! Fits a sensor's law to load-cell measurements.

use levenberg_marquardt::TerminationReason::NoImprovementPossible;
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::{DVector, Dyn, Matrix, OMatrix, Owned, U2, Vector2};
use thiserror::Error;

use crate::floor::{Calibration, Divider, LawKind};
use crate::units::Newtons;

/// One measurement: the sensor's output in volts and the load cell's force in newtons.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadPoint {
    /// Sensor output.
    pub volts: f32,
    /// Force of the load cell, including the tare if the plate rests on the sensor.
    pub force: Newtons,
}

impl LoadPoint {
    /// The measurement of `volts` at `force`.
    #[must_use]
    pub const fn new(volts: f32, force: Newtons) -> Self {
        Self { volts, force }
    }
}

/// A fitted law and the quality of its fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// The law; a plausible one (`Calibration::is_plausible`).
    pub calibration: Calibration,
    /// Root mean square of the force error, as a share of the greatest force measured.
    ///
    /// About 0.05 for the paper's parts; 0.1 or more indicates a bad part or a wrong law.
    pub residual: f32,
}

/// Reason for which no law fits the points.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum FitError {
    /// Two parameters require more than two points for a check.
    #[error("a fit needs at least {min} measurements with positive force, not {points}", min = Fit::MIN_POINTS)]
    TooFewPoints {
        /// Points with a positive force.
        points: usize,
    },
    /// A measurement is NaN or infinite.
    #[error("measurement {index} is not a finite number")]
    NotFinite {
        /// Position of the measurement, from 0.
        index: usize,
    },
    /// The voltages hardly differ, so the exponent is undetermined; the sensor may be disconnected.
    #[error("the voltages of all measurements are within {spread_v} V: is the sensor connected?")]
    NoSpread {
        /// Greatest minus least voltage.
        spread_v: f32,
    },
    /// The least-squares search found no minimum.
    #[error("the fit does not converge: do the measurements belong to this sensor?")]
    NoConvergence,
    /// The residual of the best curve is no less than that of a constant force.
    #[error("the force does not follow the voltage: do the measurements belong to this sensor?")]
    Unrelated,
    /// No force sensor has the best law: it falls, is flat or out of range.
    #[error("no force sensor has the best {} law, f = {law}", law.kind().name())]
    Unphysical {
        /// Law found.
        law: Calibration,
    },
}

impl Fit {
    /// Minimum number of measurements of a fit.
    pub const MIN_POINTS: usize = 3;

    /// Minimum difference of voltages that determines an exponent, in volts (our choice).
    const MIN_SPREAD_V: f32 = 0.05;

    /// The paper's exponential law that fits `points` best, in any order; repeated loads are useful.
    ///
    /// Minimises the squares of the force error in newtons, so heavy loads have the most weight: a foot works in that
    /// range. Points with a force of zero or less enter the fit but do not count as measurements on their own. Leave
    /// out saturated readings, which follow no law. [`Comparison`](super::Comparison) selects among the laws.
    ///
    /// # Errors
    /// [`FitError`] distinguishes a lack of data ([`TooFewPoints`](FitError::TooFewPoints),
    /// [`NoSpread`](FitError::NoSpread): measure more) from data that do not follow the law.
    ///
    /// # Source
    /// `f = a exp(b v)` by least squares (paper, section 2.2), here by
    /// Levenberg-Marquardt from the straight line through `ln f`; the others alike, the linear one directly.
    pub fn of(points: &[LoadPoint]) -> Result<Self, FitError> {
        Self::of_kind(points, LawKind::Exponential)
    }

    /// As [`Fit::of`], for parts that are known to follow a law of this kind.
    ///
    /// # Errors
    /// As [`Fit::of`].
    pub fn of_kind(points: &[LoadPoint], kind: LawKind) -> Result<Self, FitError> {
        MeasuredLoads::of(points)?.fit(kind)
    }
}

/// The measurements of one sensor, validated.
pub(super) struct MeasuredLoads {
    pub(super) volts: DVector<f64>,
    pub(super) forces: DVector<f64>,
}

impl MeasuredLoads {
    pub(super) fn of(points: &[LoadPoint]) -> Result<Self, FitError> {
        if let Some(index) = points.iter().position(|p| !(p.volts.is_finite() && p.force.is_finite())) {
            return Err(FitError::NotFinite { index });
        }
        let loaded = points.iter().filter(|p| p.force > Newtons::ZERO).count();
        if loaded < Fit::MIN_POINTS {
            return Err(FitError::TooFewPoints { points: loaded });
        }
        let (least, greatest) = points
            .iter()
            .filter(|p| p.force > Newtons::ZERO)
            .fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), p| (low.min(p.volts), high.max(p.volts)));
        let spread_v = greatest - least;
        if spread_v < Fit::MIN_SPREAD_V {
            return Err(FitError::NoSpread { spread_v });
        }
        Ok(Self {
            volts: DVector::from_iterator(points.len(), points.iter().map(|p| f64::from(p.volts))),
            forces: DVector::from_iterator(points.len(), points.iter().map(|p| f64::from(p.force.0))),
        })
    }

    /// Fits the law of this kind by least squares of the force error.
    pub(super) fn fit(&self, kind: LawKind) -> Result<Fit, FitError> {
        let best = LawParameters::through(kind, self, None)?;
        let errors = best.modelled() - &self.forces;
        let mean = self.forces.mean();
        let around_mean: f64 = self.forces.iter().map(|force| (force - mean).powi(2)).sum();
        let law = best.calibration();
        // A divider with a diverging supply: the force does not rise with the voltage like that of a divider.
        if !law.numbers().into_iter().all(f32::is_finite) {
            return Err(FitError::NoConvergence);
        }
        if !law.is_plausible() {
            return Err(FitError::Unphysical { law });
        }
        let squares = errors.norm_squared();
        if squares.is_nan() || squares >= around_mean {
            return Err(FitError::Unrelated);
        }
        let rms = (squares / errors.len() as f64).sqrt();
        Ok(Fit { calibration: law, residual: (rms / self.forces.max()) as f32 })
    }
}

/// A law during the least-squares search, in parameters that keep it rising and are of order one: `(ln a, b)` of the
/// exponential and the power law, `(ln a, ln (s - end))` of the divider, `(a, a z)` of the straight line.
pub(super) struct LawParameters<'a> {
    kind: LawKind,
    loads: &'a MeasuredLoads,
    /// Weight of each error; `None` leaves newtons.
    weights: Option<&'a DVector<f64>>,
    /// Minimum supply of a divider: its end lies above all measurements.
    end: f64,
    params: Vector2<f64>,
}

impl<'a> LawParameters<'a> {
    /// The curve of this kind with the least squares of weighted errors.
    pub(super) fn through(
        kind: LawKind,
        loads: &'a MeasuredLoads,
        weights: Option<&'a DVector<f64>>,
    ) -> Result<Self, FitError> {
        let end = loads.volts.max() / f64::from(Divider::END);
        let mut curve = Self { kind, loads, weights, end, params: Vector2::zeros() };
        curve.params = curve.start()?;
        if kind == LawKind::Linear {
            return Ok(curve);
        }
        let (curve, report) = LevenbergMarquardt::new().with_patience(100).minimize(curve);
        match report.termination {
            // The steps became smaller than single bits: the minimum.
            NoImprovementPossible(_) => Ok(curve),
            reason if reason.was_successful() => Ok(curve),
            _ => Err(FitError::NoConvergence),
        }
    }

    /// Start of the search; for a straight line, its result.
    fn start(&self) -> Result<Vector2<f64>, FitError> {
        let start = match self.kind {
            LawKind::Exponential => self.log_line(|volts| volts),
            LawKind::Power => self.log_line(f64::ln),
            LawKind::Divider => self.nearest_divider(),
            LawKind::Linear => self.line(),
        };
        if start.iter().all(|parameter| parameter.is_finite()) {
            Ok(start)
        } else {
            Err(FitError::NoConvergence)
        }
    }

    /// `(ln a, b)` of the straight line through `ln f` over `scale(v)`, by positive forces only.
    fn log_line(&self, scale: impl Fn(f64) -> f64) -> Vector2<f64> {
        let loaded = || {
            let pairs = self.loads.volts.iter().zip(self.loads.forces.iter());
            pairs.filter(|(_, f)| **f > 0.0).map(|(v, f)| (scale(*v), f.ln())).filter(|(v, _)| v.is_finite())
        };
        let count = loaded().count() as f64;
        let (mean_v, mean_f) =
            loaded().fold((0.0, 0.0), |(v, f), point| (v + point.0 / count, f + point.1 / count));
        let (vv, vf) = loaded().fold((0.0, 0.0), |(vv, vf), (v, f)| {
            (vv + (v - mean_v).powi(2), vf + (v - mean_v) * (f - mean_f))
        });
        let b = vf / vv;
        Vector2::new(mean_f - b * mean_v, b)
    }

    /// The best of several dividers with supplies from just above the measurements to far beyond.
    fn nearest_divider(&self) -> Vector2<f64> {
        let tried = (-7..=7).filter_map(|step| {
            let above = f64::from(step) * 0.7 + self.end.max(1e-3).ln();
            let unit = Self { params: Vector2::new(0.0, above), ..*self };
            let shape = unit.weighted(unit.modelled());
            let forces = self.weighted(self.loads.forces.clone());
            let a = shape.dot(&forces) / shape.norm_squared();
            let left = (shape * a - forces).norm_squared();
            (a > 0.0 && left.is_finite()).then(|| (left, Vector2::new(a.ln(), above)))
        });
        let best = tried.min_by(|(one, _), (other, _)| one.total_cmp(other));
        best.map_or(Vector2::new(f64::NAN, 0.0), |(_, params)| params)
    }

    /// `(a, a z)` of the straight line with the least squares.
    fn line(&self) -> Vector2<f64> {
        let share = |index: usize| self.weights.map_or(1.0, |weights| weights[index].powi(2));
        let all: f64 = (0..self.loads.volts.len()).map(share).sum();
        let mean = |values: &DVector<f64>| -> f64 {
            values.iter().enumerate().map(|(index, value)| share(index) * value).sum::<f64>() / all
        };
        let (mean_v, mean_f) = (mean(&self.loads.volts), mean(&self.loads.forces));
        let pairs = self.loads.volts.iter().zip(self.loads.forces.iter()).enumerate();
        let (vv, vf) = pairs.fold((0.0, 0.0), |(vv, vf), (index, (v, f))| {
            (vv + share(index) * (v - mean_v).powi(2), vf + share(index) * (v - mean_v) * (f - mean_f))
        });
        let a = vf / vv;
        Vector2::new(a, a * mean_v - mean_f)
    }

    fn modelled(&self) -> DVector<f64> {
        let (p, q) = (self.params.x, self.params.y);
        let volts = &self.loads.volts;
        match self.kind {
            LawKind::Exponential => volts.map(|v| (p + q * v).exp()),
            LawKind::Power => volts.map(|v| if v > 0.0 { (p + q * v.ln()).exp() } else { 0.0 }),
            LawKind::Divider => {
                let (a, supply) = (p.exp(), self.end + q.exp());
                volts.map(|v| a * v / (supply - v))
            }
            LawKind::Linear => volts.map(|v| p * v - q),
        }
    }

    /// Derivative of the modelled force with respect to the second parameter, at measurement `index` with the value
    /// `modelled`.
    fn slope(&self, index: usize, modelled: f64) -> f64 {
        let v = self.loads.volts[index];
        match self.kind {
            LawKind::Exponential => modelled * v,
            LawKind::Power => {
                if v > 0.0 {
                    modelled * v.ln()
                } else {
                    0.0
                }
            }
            LawKind::Divider => {
                let above = self.params.y.exp();
                -modelled * above / (self.end + above - v)
            }
            LawKind::Linear => -1.0,
        }
    }

    fn weighted(&self, values: DVector<f64>) -> DVector<f64> {
        match self.weights {
            Some(weights) => values.component_mul(weights),
            None => values,
        }
    }

    /// Weighted error of each measurement.
    pub(super) fn errors(&self) -> DVector<f64> {
        self.weighted(self.modelled() - &self.loads.forces)
    }

    fn calibration(&self) -> Calibration {
        let (p, q) = (self.params.x, self.params.y);
        let numbers = match self.kind {
            LawKind::Exponential | LawKind::Power => [p.exp(), q],
            LawKind::Divider => [p.exp(), self.end + q.exp()],
            LawKind::Linear => [p, q / p],
        };
        Calibration::of(self.kind, numbers.map(|number| number as f32))
    }
}

impl LeastSquaresProblem<f64, Dyn, U2> for LawParameters<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, U2>;
    type ParameterStorage = Owned<f64, U2>;

    fn set_params(&mut self, params: &Vector2<f64>) {
        self.params = *params;
    }

    fn params(&self) -> Vector2<f64> {
        self.params
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        Some(self.errors())
    }

    fn jacobian(&self) -> Option<Matrix<f64, Dyn, U2, Self::JacobianStorage>> {
        let modelled = self.modelled();
        Some(OMatrix::<f64, Dyn, U2>::from_fn_generic(Dyn(modelled.len()), U2, |row, column| {
            let change = match (column, self.kind) {
                (0, LawKind::Linear) => self.loads.volts[row],
                (0, _) => modelled[row],
                _ => self.slope(row, modelled[row]),
            };
            self.weights.map_or(change, |weights| weights[row] * change)
        }))
    }
}

#[cfg(test)]
mod tests;
