//! Simulated floors as their users get them: built, measured in a laboratory, and in use since.

use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;
use thiserror::Error;

use super::floor::{SimConfig, SimFloor, SimulatedSensors};
use super::loadcell::{CalibrationError, calibrated};
use super::mapping::{MappingError, mapped};
use super::quality::FloorQuality;
use underfoot::floor::Floor;
use underfoot::units::Newtons;

/// Error: the laboratory cannot measure a simulated floor.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum BuildError {
    /// No law fits a sensor.
    #[error("the simulated floor can't be calibrated: {0}")]
    Calibration(#[from] CalibrationError),
    /// No map fits a tile.
    #[error("the simulated floor can't be mapped: {0}")]
    Mapping(#[from] MappingError),
}

/// The way to a simulated floor and its floor file; the same values give the same floor to the bit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct FloorBuild {
    /// Quality of plates and sensors.
    pub quality: FloorQuality,
    /// Seed of the parts, of their calibration, of their drift and of the broken sensors.
    pub seed: u64,
    /// Whether the laboratory also presses known points on every tile and fits position maps.
    pub is_mapped: bool,
    /// Whether the boards convert their readings and send newtons; those of an ideal floor always do.
    pub sends_newtons: bool,
}

impl FloorBuild {
    /// The usual floor of this quality: boards that send counts, no position maps.
    #[must_use]
    pub const fn of(quality: FloorQuality, seed: u64) -> Self {
        Self { quality, seed, is_mapped: false, sends_newtons: false }
    }

    /// Returns the simulation of a floor with the geometry and boards of `wired`, and the floor file that a
    /// laboratory writes for it: calibrated, tared and perhaps mapped.
    ///
    /// # Errors
    /// [`BuildError`] names the first sensor or tile that the laboratory cannot measure.
    pub fn measured(&self, wired: &Floor) -> Result<(SimFloor, Floor), BuildError> {
        let sim = SimFloor::new(wired, self.config(), self.seed);
        let floor = calibrated(wired, &sim, self.seed)?;
        let floor = if self.is_mapped { mapped(&floor, &sim, self.seed)? } else { floor };
        Ok((sim, floor))
    }

    /// Returns the same pair in use: since the tare, the zero of each sensor has drifted
    /// ([`FloorQuality::offset_n`]), and sensors have broken ([`FloorQuality::broken`]). Boards that send newtons
    /// tare themselves when they start, so their zeros have not drifted.
    ///
    /// # Errors
    /// The same as [`FloorBuild::measured`].
    pub fn in_use(&self, wired: &Floor) -> Result<(SimFloor, Floor), BuildError> {
        let (mut sim, mut floor) = self.measured(wired)?;
        if !matches!(sim.sensing(), SimulatedSensors::Newtons(_)) {
            drift_zeros(&mut floor, self.quality.offset_n(), self.seed);
        }
        for (sensor, fault) in self.quality.broken(&floor.geometry, self.seed) {
            sim.set_fault(sensor, Some(fault));
        }
        Ok((sim, floor))
    }

    fn config(&self) -> SimConfig {
        let config = self.quality.config();
        match config.sensing {
            SimulatedSensors::Counts(parts) if self.sends_newtons => {
                SimConfig { sensing: SimulatedSensors::Newtons(parts), ..config }
            }
            _ => config,
        }
    }
}

/// Shifts the tare of each sensor of `floor` by a normal random force with the standard deviation `offset_n` (N), as if
/// the zeros had drifted since the tare; the same `seed` gives the same forces.
pub fn drift_zeros(floor: &mut Floor, offset_n: f32, seed: u64) {
    if offset_n == 0.0 {
        return;
    }
    let mut rng = Pcg64Mcg::seed_from_u64(seed ^ 0x00ff_5e75);
    for tare in floor.tare.iter_mut().flatten() {
        let normal: f32 = StandardNormal.sample(&mut rng);
        *tare += Newtons(offset_n * normal);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_floor_in_use_is_the_measured_one_with_drifted_zeros() {
        let wired = Floor::default();
        let spread = |build: FloorBuild| {
            let [(_, measured), (_, used)] = [build.measured(&wired).unwrap(), build.in_use(&wired).unwrap()];
            assert_eq!(measured.calibration, used.calibration);
            let zeros = measured.tare.iter().zip(&used.tare).flat_map(|(was, is)| was.iter().zip(is));
            let squares: Vec<f32> = zeros.map(|(was, is)| (was.0 - is.0).powi(2)).collect();
            (squares.iter().sum::<f32>() / squares.len() as f32).sqrt()
        };
        for quality in FloorQuality::ALL {
            let build = FloorBuild::of(quality, 4);
            let offset = quality.offset_n();
            assert!((spread(build) - offset).abs() <= 0.2 * offset, "{quality}");
            assert_eq!(spread(FloorBuild { sends_newtons: true, ..build }), 0.0, "{quality}");
        }
    }
}
