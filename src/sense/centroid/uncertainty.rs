//! Uncertainty of a centroid due to the uncertainty of the sensors.

use glam::{Vec2, Vec4};

use super::tile::LoadedTile;
use crate::floor::{Geometry, SensorPlaces};
use crate::sense::Covariance;

/// The uncertainty that remains after calibration of the sensors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorUncertainty {
    /// Standard deviation of a sensor's zero, in newtons.
    pub offset_n: f32,
    /// Standard deviation of a sensor's gain after calibration under light loads, as a share of the reading; one and
    /// a half times as much from 60 N on, where parts deviate farther from their laws. Beyond 180 N it stays constant
    /// in newtons.
    pub gain: f32,
    /// Standard deviation due to hysteresis and creep, as a share of the reading; no calibration removes it.
    pub memory: f32,
    /// Standard deviation of each sensor of a tile due to plates that bend, seams that touch and crosstalk, as a
    /// share of the tile's load.
    pub misplaced: f32,
}

/// Arm that converts a map's remaining position error into an error of each sensor (m): about a sensor's distance
/// from the load (by the coverage of points and feet of 50 to 400 N on simulated floors, as the next two).
const ARM_M: f32 = 0.125;

/// Error of a sensor that carries next to nothing, in units of that error.
const LIGHT: f32 = 0.25;

/// Load at which one more unit of error remains (N); it grows with the square, up to the gain of a tile without a
/// map: few presses calibrate a sensor near the end of its range.
const HEAVY_N: f32 = 102.0;

/// Load above which the gain of a tile without a map has its maximum uncertainty (N).
const STRAYS_N: f32 = 60.0;

/// Additional uncertainty there relative to that under a light load (both by the same coverage).
const STRAYS: f32 = 0.55;

/// Load above which the uncertainty is constant in newtons and not as a share, because the fit of a law minimises
/// newtons.
const FITTED_N: f32 = 180.0;

/// Load above which a part may compress towards its end (N), and growth of its standard deviation per further newton.
///
/// A part that ends smoothly at 300 N, `r = f (1 + (f / 300)^6)^(-1/6)`, hides 2 N at a reading of 200 N, 17 N at 250
/// N and 55 N at 280 N: the factor is the mean of these, and half of the simulated parts end later.
const COMPRESSES_N: f32 = 200.0;
const COMPRESSES: f32 = 0.4;

/// Minimum force over which the sensors' uncertainty is spread (N): lighter contacts have no position at all.
const LEAST_N: f32 = 2.0;

/// Standard deviation of the uncounted load on each sensor of a surrounding tile with a part of the load (N) (by the
/// same coverage, of feet of 50 N).
const UNSEEN_N: f32 = 0.27;

impl Default for SensorUncertainty {
    /// A ninth of a newton of offset, 10.7 % of gain: the remainder with tracked zeros of an empty floor, and after a
    /// calibration.
    ///
    /// The paper's 5 % (section 2.2) are of full scale. Of a reading it is more, and with this value the ellipses
    /// cover 95 % of the true places on simulated parts like the paper's. Force-sensing resistors have memory: a
    /// hysteresis of 10 % from lowest to highest (uniform, 2.9 %) and a creep of 5 % a decade, of which the time
    /// under load leaves a decade open (2.9 %), are a maker's figures, together 4 %. A plate of 12 mm plywood on soft
    /// feet puts about 2 % of its load on the wrong corners (by the coverage of all scenes on such floors).
    fn default() -> Self {
        Self { offset_n: 0.11, gain: 0.107, memory: 0.04, misplaced: 0.02 }
    }
}

impl SensorUncertainty {
    /// The uncertainty of sensors without lag and creep, such as load cells, under rigid plates that touch nothing.
    #[must_use]
    pub fn without_memory() -> Self {
        Self { memory: 0.0, misplaced: 0.0, ..Self::default() }
    }

    /// Covariance, in square metres, of a centroid at `point` that carries `force` newtons in all, due to the sensors
    /// of `tile`; the covariances of all its tiles add up.
    ///
    /// `share` of the tile's load is the contact's own: the gain errors of that part count.
    ///
    /// # Source
    /// First-order propagation through c = Σ fᵢ xᵢ / Σ fᵢ: ∂c/∂fᵢ = (xᵢ − c) / F, var fᵢ = offset² + (gain fᵢ)² +
    /// (memory fᵢ)² + (misplaced Σ f)² + noise² + extra², the last for a sensor that is estimated, not calibrated or
    /// at the end of its range. The gain is that of [`SensorUncertainty::gain`] under the sensor's load; on a tile
    /// with a position map it follows from the map's residual ([`crate::floor::PositionMap::residual_m`]).
    #[must_use]
    #[inline]
    pub fn covariance(
        &self,
        geometry: &Geometry,
        tile: &LoadedTile,
        share: f32,
        point: Vec2,
        force: f32,
    ) -> Covariance {
        let scale = 1.0 / (force * force).max(LEAST_N * LEAST_N);
        let strayed = UNSEEN_N * UNSEEN_N * tile.strayed_m2() * scale;
        let places = geometry.sensor_places(tile.tile);
        let (x, y) = match places.rectangle() {
            Some(reach) => {
                // In the order of `Corner::ALL`: those in the south first, of each two the western one.
                let (low, high) = (tile.centre - reach - point, tile.centre + reach - point);
                (Vec4::new(low.x, high.x, low.x, high.x), Vec4::new(low.y, low.y, high.y, high.y))
            }
            None => levers(places, point - tile.centre),
        };
        let misread = share * self.misread_n(Vec4::from_array(tile.corners), tile.mapped_m());
        let extra = share * Vec4::from_array(tile.extra_sigma);
        let misplaced = share * self.misplaced * tile.wrench.force;
        let noise = self.offset_n.powi(2) + misplaced.powi(2) + tile.noise_n.powi(2);
        let memory = share * self.memory * Vec4::from_array(tile.corners);
        let variance = (misread * misread + memory * memory + extra * extra + noise) * scale;
        Covariance {
            xx: strayed + (x * x).dot(variance),
            xy: (x * y).dot(variance),
            yy: strayed + (y * y).dot(variance),
        }
    }

    /// Standard deviation of four sensors with `loads` due to their gains (N), on a tile with a residual of
    /// `mapped_m` along each axis after its map.
    fn misread_n(&self, loads: Vec4, mapped_m: Option<f32>) -> Vec4 {
        let strays = Vec4::ONE + STRAYS * (loads / STRAYS_N).clamp(Vec4::ZERO, Vec4::ONE);
        let hidden = COMPRESSES * (loads - COMPRESSES_N).max(Vec4::ZERO);
        let unmapped = self.gain * strays * loads.min(Vec4::splat(FITTED_N)) + hidden;
        let Some(left) = mapped_m else { return unmapped };
        let heavy = loads / HEAVY_N;
        let mapped = left / ARM_M * (Vec4::splat(LIGHT) + heavy * heavy) * loads;
        mapped.abs().min(unmapped.abs())
    }
}

/// The sensors' levers about `point`, relative to the tile's centre, eastwards and northwards (m); zero for a sensor
/// that the plate does not have, so that it adds no error.
#[inline(never)]
fn levers(places: &SensorPlaces, point: Vec2) -> (Vec4, Vec4) {
    let (mut x, mut y) = ([0.0; 4], [0.0; 4]);
    for (sensor, place) in places.as_slice().iter().enumerate() {
        [x[sensor], y[sensor]] = (*place - point).to_array();
    }
    (x.into(), y.into())
}

impl std::ops::AddAssign for Covariance {
    fn add_assign(&mut self, other: Self) {
        self.xx += other.xx;
        self.xy += other.xy;
        self.yy += other.yy;
    }
}
