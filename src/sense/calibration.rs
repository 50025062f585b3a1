//! Fitting a sensor's law to load-cell measurements.

use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::{DVector, Dyn, Matrix, OMatrix, Owned, U2, Vector2};
use thiserror::Error;

use crate::floor::Calibration;
use crate::units::Newtons;

/// One measurement: the sensor's output in volts and the load cell's force in newtons.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadPoint {
    /// Sensor output.
    pub volts: f32,
    /// Force by the load cell, tare included if the plate rests on the sensor.
    pub force: Newtons,
}

impl LoadPoint {
    /// The measurement of `volts` at `force`.
    #[must_use]
    pub const fn new(volts: f32, force: Newtons) -> Self {
        Self { volts, force }
    }
}

/// A fitted law and how well it follows its points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// The law; both parameters positive and finite.
    pub calibration: Calibration,
    /// Root mean square of the force error, as a share of the greatest force measured.
    ///
    /// About 0.05 for the paper's parts; 0.1 or more speaks of a bad part or a wrong law.
    pub residual: f32,
}

/// Why no law follows the points.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum FitError {
    /// Two parameters need more points than two to leave something to check.
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
    /// The voltages hardly differ, so nothing can be said of the exponent; the sensor may be disconnected.
    #[error("the voltages of all measurements are within {spread_v} V: is the sensor connected?")]
    NoSpread {
        /// Greatest minus least voltage.
        spread_v: f32,
    },
    /// The least-squares search found no minimum.
    #[error("the fit does not converge: do the measurements belong to this sensor?")]
    NoConvergence,
    /// The best law is one that no force sensor has: falling, flat or out of range.
    #[error("the best law, a = {a_n} N and b = {b_per_volt} per volt, is no force sensor's")]
    Unphysical {
        /// Factor found.
        a_n: f32,
        /// Exponent found.
        b_per_volt: f32,
    },
}

impl Fit {
    /// Fewest measurements a fit is made from.
    pub const MIN_POINTS: usize = 3;

    /// Least difference of voltages that tells an exponent, in volts (our choice).
    const MIN_SPREAD_V: f32 = 0.05;

    /// The law that follows `points` best, in any order, repeated loads welcome.
    ///
    /// The squares are those of the force error in newtons, so heavy loads
    /// count most: that is where a foot works. Points with a force of zero or
    /// less take part in the fit but don't count as measurements on their own.
    /// Leave out saturated readings, which follow no law.
    ///
    /// # Errors
    /// [`FitError`] tells a lack of data ([`TooFewPoints`](FitError::TooFewPoints),
    /// [`NoSpread`](FitError::NoSpread): measure more) from data that no law follows.
    ///
    /// # Source
    /// `f = a exp(b v)` by least squares (paper, section 2.2), here by
    /// Levenberg-Marquardt from the straight line through `ln f`.
    pub fn of(points: &[LoadPoint]) -> Result<Self, FitError> {
        let problem = Problem::start(points)?;
        let (problem, report) = LevenbergMarquardt::new().with_patience(100).minimize(problem);
        if !report.termination.was_successful() {
            return Err(FitError::NoConvergence);
        }
        let calibration = problem.calibration();
        let Calibration { a_n, b_per_volt } = calibration;
        let at_full_scale = calibration.force(u16::MAX);
        if !(a_n > 0.0 && b_per_volt > 0.0 && at_full_scale.is_finite()) {
            return Err(FitError::Unphysical { a_n, b_per_volt });
        }
        Ok(Self { calibration, residual: problem.residual_share() })
    }
}

/// The least-squares problem in `(ln a, b)`: a stays positive and both are of order one.
struct Problem {
    volts: DVector<f64>,
    forces: DVector<f64>,
    params: Vector2<f64>,
}

impl Problem {
    fn start(points: &[LoadPoint]) -> Result<Self, FitError> {
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
            params: log_line(points),
        })
    }

    fn modelled(&self) -> DVector<f64> {
        let (ln_a, b) = (self.params.x, self.params.y);
        self.volts.map(|v| (ln_a + b * v).exp())
    }

    fn calibration(&self) -> Calibration {
        Calibration { a_n: self.params.x.exp() as f32, b_per_volt: self.params.y as f32 }
    }

    fn residual_share(&self) -> f32 {
        let errors = self.modelled() - &self.forces;
        let rms = (errors.norm_squared() / errors.len() as f64).sqrt();
        (rms / self.forces.max()) as f32
    }
}

impl LeastSquaresProblem<f64, Dyn, U2> for Problem {
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
        Some(self.modelled() - &self.forces)
    }

    fn jacobian(&self) -> Option<Matrix<f64, Dyn, U2, Self::JacobianStorage>> {
        let modelled = self.modelled();
        Some(OMatrix::<f64, Dyn, U2>::from_fn_generic(Dyn(modelled.len()), U2, |row, column| {
            if column == 0 { modelled[row] } else { modelled[row] * self.volts[row] }
        }))
    }
}

/// `(ln a, b)` of the straight line through `ln f` over v, by positive forces only.
fn log_line(points: &[LoadPoint]) -> Vector2<f64> {
    let loaded = || {
        points
            .iter()
            .filter(|p| p.force > Newtons::ZERO)
            .map(|p| (f64::from(p.volts), f64::from(p.force.0).ln()))
    };
    let count = loaded().count() as f64;
    let (mean_v, mean_f) =
        loaded().fold((0.0, 0.0), |(v, f), point| (v + point.0 / count, f + point.1 / count));
    let (vv, vf) = loaded()
        .fold((0.0, 0.0), |(vv, vf), (v, f)| (vv + (v - mean_v).powi(2), vf + (v - mean_v) * (f - mean_f)));
    let b = vf / vv;
    Vector2::new(mean_f - b * mean_v, b)
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_distr::{Distribution, Normal};
    use rand_pcg::Pcg64Mcg;

    use super::*;

    fn ramp(law: Calibration, points: usize) -> Vec<LoadPoint> {
        (0..points)
            .map(|step| {
                let volts = 5.0 * (step as f32 + 0.5) / points as f32;
                LoadPoint::new(volts, Newtons(law.a_n * (law.b_per_volt * volts).exp()))
            })
            .collect()
    }

    #[test]
    fn parameters_come_back_within_one_percent_through_two_percent_of_noise() {
        let mut rng = Pcg64Mcg::seed_from_u64(7);
        let noise = Normal::new(1.0, 0.02).unwrap();
        // Parts at both ends of the spread underfoot simulates.
        for law in [
            Calibration::NOMINAL,
            Calibration { a_n: 0.625, b_per_volt: 1.41 },
            Calibration { a_n: 0.375, b_per_volt: 1.27 },
        ] {
            // Eight seconds of a slow press at 1 kHz: the heavy end pins the curve, so a, far from it, needs many.
            let mut points = ramp(law, 8000);
            for point in &mut points {
                point.force = point.force * noise.sample(&mut rng);
            }
            let fit = Fit::of(&points).unwrap();
            let (a, b) = (fit.calibration.a_n / law.a_n, fit.calibration.b_per_volt / law.b_per_volt);
            assert!((a - 1.0).abs() < 0.01 && (b - 1.0).abs() < 0.01, "a {a}, b {b}");
            assert!(fit.residual < 0.01, "{}", fit.residual);
        }
    }

    #[test]
    fn squares_are_of_force_and_not_of_its_logarithm() {
        // A part that reads a factor 2 too low when light: the heavy end must still be right.
        let mut points = ramp(Calibration::NOMINAL, 50);
        for point in points.iter_mut().filter(|p| p.force.0 < 5.0) {
            point.force = point.force * 0.5;
        }
        let law = Fit::of(&points).unwrap().calibration;
        let heavy = points.last().unwrap();
        let modelled = law.a_n * (law.b_per_volt * heavy.volts).exp();
        assert!((modelled / heavy.force.0 - 1.0).abs() < 0.01, "{modelled}");
    }

    #[test]
    fn residual_is_a_share_of_the_greatest_force() {
        let mut points = ramp(Calibration::NOMINAL, 51);
        let full = points.last().unwrap().force;
        // Alternating errors of 5 % of full scale can't be fitted away.
        for (index, point) in points.iter_mut().enumerate() {
            point.force += full * if index % 2 == 0 { 0.05 } else { -0.05 };
        }
        let residual = Fit::of(&points).unwrap().residual;
        assert!((0.045..0.052).contains(&residual), "{residual}");
    }

    #[test]
    fn each_lack_of_data_has_its_name() {
        let good = ramp(Calibration::NOMINAL, 20);
        assert_eq!(Fit::of(&[]), Err(FitError::TooFewPoints { points: 0 }));
        assert_eq!(Fit::of(&good[..2]), Err(FitError::TooFewPoints { points: 2 }));

        let mut broken = good.clone();
        broken[4].volts = f32::NAN;
        assert_eq!(Fit::of(&broken), Err(FitError::NotFinite { index: 4 }));

        let unplugged = vec![LoadPoint::new(0.0, Newtons(20.0)); 10];
        assert_eq!(Fit::of(&unplugged), Err(FitError::NoSpread { spread_v: 0.0 }));

        // The wires are swapped: volts fall as the load grows.
        let falling: Vec<_> = good.iter().map(|p| LoadPoint::new(5.0 - p.volts, p.force)).collect();
        assert!(matches!(Fit::of(&falling), Err(FitError::Unphysical { .. })), "{:?}", Fit::of(&falling));
    }

    #[test]
    fn forces_that_no_law_can_reach_do_not_converge_or_are_unphysical() {
        let absurd: Vec<_> = (0..10).map(|k| LoadPoint::new(k as f32 * 1e20, Newtons(1e30))).collect();
        assert!(Fit::of(&absurd).is_err());
    }
}
