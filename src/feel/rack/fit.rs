//! Filters fitted to the measured response of an actuator.

use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::{DMatrix, DVector, Dyn, Owned};

use super::section::Filter;
use crate::floor::Response;

/// Band in which the plate is worth moving, in hertz (paper, section 2: plates measured from 50 to 750 Hz).
pub(super) const BAND_HZ: [f64; 2] = [50.0, 750.0];

/// Corner of the high-pass below the band: lower frequencies only heat the coil and drive the plate to its stops.
const LOW_CORNER_HZ: f64 = 40.0;

/// Corner of the low-pass above the band.
const HIGH_CORNER_HZ: f64 = 950.0;

/// Sharpnesses of the two halves of a fourth-order Butterworth filter.
const BUTTERWORTH: [f64; 2] = [0.541_196, 1.306_563];

/// Maximum gain and attenuation of the equaliser: a frequency that the actuator hardly moves is not worth all of its
/// power.
const MOST_DB: f64 = 15.0;

/// Maximum number of bells in an equaliser.
const MOST_BELLS: usize = 8;

/// Maximum error, at every point, of an equaliser that needs no further bell.
const GOOD_ENOUGH_DB: f64 = 0.4;

/// Number of points at which the error of the fit is computed, evenly spread over the band's octaves.
const POINTS: usize = 64;

/// The filters that make an actuator of this `response` flat within the band, and remove frequencies outside of it.
///
/// The equaliser is a row of bells, each placed where the response is furthest from flat, and all of them tuned
/// together. Every bell is a filter with positive damping, so it is stable for every measured response.
///
/// # Source
/// Levenberg-Marquardt on the error in decibels.
pub(super) fn filters(response: &Response, sample_rate: f64) -> Vec<Filter> {
    let mut shapes: Vec<Filter> =
        BUTTERWORTH.iter().map(|q| Filter::high_pass(LOW_CORNER_HZ, *q, sample_rate)).collect();
    shapes.extend(BUTTERWORTH.iter().map(|q| Filter::low_pass(HIGH_CORNER_HZ, *q, sample_rate)));

    let octaves = (BAND_HZ[1] / BAND_HZ[0]).log2();
    let hertz: Vec<f64> =
        (0..POINTS).map(|n| BAND_HZ[0] * (octaves * n as f64 / (POINTS - 1) as f64).exp2()).collect();
    let wanted = hertz.iter().map(|hz| {
        let known: f64 = shapes.iter().map(|shape| shape.gain_db(*hz, sample_rate)).sum();
        (-response.gain_db(*hz)).clamp(-MOST_DB, MOST_DB) - known
    });
    let mut fit =
        Fit { wanted: wanted.collect(), hertz, sample_rate, parameters: DVector::from_element(1, 0.0) };
    fit.tune();
    while fit.worst().1.abs() > GOOD_ENOUGH_DB && fit.bells() < MOST_BELLS {
        let before = fit.clone();
        fit.add_bell();
        fit.tune();
        if fit.cost() >= before.cost() {
            fit = before;
            break;
        }
    }
    let loudness = 10_f64.powf(fit.parameters[0] / 20.0);
    if let Some(first) = shapes.first_mut() {
        *first = first.louder(loudness);
    }
    shapes.extend((0..fit.bells()).map(|bell| fit.bell(bell)));
    shapes
}

/// A row of bells that approximates `wanted`.
///
/// The parameters are a gain in decibels, and then, for each bell, the
/// logarithms of its centre and its sharpness, and its height in decibels.
#[derive(Clone, Debug)]
struct Fit {
    hertz: Vec<f64>,
    wanted: Vec<f64>,
    sample_rate: f64,
    parameters: DVector<f64>,
}

impl Fit {
    fn bells(&self) -> usize {
        self.parameters.len() / 3
    }

    fn bell(&self, number: usize) -> Filter {
        let [hz, sharpness, db] = [1, 2, 3].map(|part| self.parameters[3 * number + part]);
        Filter::bell(
            hz.exp().clamp(30.0, 1200.0),
            sharpness.exp().clamp(0.3, 12.0),
            db.clamp(-1.5 * MOST_DB, 1.5 * MOST_DB),
            self.sample_rate,
        )
    }

    fn errors(&self) -> DVector<f64> {
        let bells: Vec<Filter> = (0..self.bells()).map(|bell| self.bell(bell)).collect();
        let errors = self.hertz.iter().zip(&self.wanted).map(|(hz, wanted)| {
            let got: f64 = bells.iter().map(|bell| bell.gain_db(*hz, self.sample_rate)).sum();
            self.parameters[0] + got - wanted
        });
        DVector::from_iterator(self.hertz.len(), errors)
    }

    fn cost(&self) -> f64 {
        self.errors().norm_squared()
    }

    /// Place and size of the largest error, in hertz and decibels.
    fn worst(&self) -> (f64, f64) {
        let errors = self.errors();
        let worst = errors.iamax();
        (self.hertz[worst], errors[worst])
    }

    fn add_bell(&mut self) {
        let (hz, error) = self.worst();
        let known = self.parameters.len();
        self.parameters = self.parameters.clone().resize_vertically(known + 3, 0.0);
        self.parameters[known] = hz.ln();
        self.parameters[known + 1] = 2_f64.ln();
        self.parameters[known + 2] = -error;
    }

    fn tune(&mut self) {
        let (tuned, _) = LevenbergMarquardt::new().with_patience(2).minimize(self.clone());
        if tuned.cost() < self.cost() {
            *self = tuned;
        }
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Fit {
    type ParameterStorage = Owned<f64, Dyn>;
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;

    fn set_params(&mut self, parameters: &DVector<f64>) {
        self.parameters.copy_from(parameters);
    }

    fn params(&self) -> DVector<f64> {
        self.parameters.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        Some(self.errors())
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        const STEP: f64 = 1e-5;
        let mut jacobian = DMatrix::zeros(self.hertz.len(), self.parameters.len());
        let mut moved = self.clone();
        for parameter in 0..self.parameters.len() {
            let here = self.parameters[parameter];
            moved.parameters[parameter] = here + STEP;
            let above = moved.errors();
            moved.parameters[parameter] = here - STEP;
            jacobian.set_column(parameter, &((above - moved.errors()) / (2.0 * STEP)));
            moved.parameters[parameter] = here;
        }
        Some(jacobian)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f64 = 96_000.0;

    /// A plate on springs: two resonances, one of them sharp, over a gentle slope.
    fn plate(hz: f64) -> f64 {
        let resonance =
            |centre, sharpness, db| Filter::bell(centre, sharpness, db, 192_000.0).gain_db(hz, 192_000.0);
        resonance(68.0, 2.5, 9.0) + resonance(310.0, 4.0, -7.0) + resonance(520.0, 3.0, 5.0)
            - 1.5 * (hz / 200.0).log2()
    }

    fn response(gain_db: impl Fn(f64) -> f64) -> Response {
        // A twelfth of an octave apart, from 30 Hz to 1.2 kHz.
        let points =
            (0..64).map(|n| 30.0 * (f64::from(n) / 12.0).exp2()).map(|hz| (hz as f32, gain_db(hz) as f32));
        Response::of(points.collect()).unwrap()
    }

    #[test]
    fn a_measured_plate_becomes_flat_within_1_db_in_the_band() {
        let response = response(plate);
        let shapes = filters(&response, RATE);
        assert!(shapes.len() <= 4 + MOST_BELLS);
        for n in 0..=100 {
            let hz = BAND_HZ[0] * (BAND_HZ[1] / BAND_HZ[0]).powf(f64::from(n) / 100.0);
            let flat: f64 = shapes.iter().map(|shape| shape.gain_db(hz, RATE)).sum::<f64>() + plate(hz);
            assert!(flat.abs() < 1.0, "{hz:.0} Hz: {flat:.2} dB");
        }
    }

    #[test]
    fn what_is_outside_of_the_band_is_taken_away_and_a_hole_is_not_filled_at_any_price() {
        let response = response(|hz| if hz < 55.0 { -60.0 } else { 0.0 });
        let shapes = filters(&response, RATE);
        let gain = |hz| shapes.iter().map(|shape| shape.gain_db(hz, RATE)).sum::<f64>();
        for hz in [5.0, 15.0, 3000.0, 10_000.0] {
            assert!(gain(hz) < -20.0, "{hz} Hz: {:.1} dB", gain(hz));
        }
        for n in 0..200 {
            let hz = 20.0 * 1.03_f64.powi(n);
            // The bells round off a cliff, and overshoot a little.
            assert!(gain(hz) < MOST_DB + 3.0, "{hz:.0} Hz: {:.1} dB", gain(hz));
        }
    }
}
