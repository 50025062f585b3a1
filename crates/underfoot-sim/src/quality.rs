//! Test floors of several qualities, from an ideal one to a badly worn one.

use std::fmt;
use std::str::FromStr;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use thiserror::Error;

use super::floor::{SimConfig, SimulatedSensors};
use super::plate::PlateConfig;
use super::seam::SeamConfig;
use super::sensor::{PartConfig, SensorFault};
use underfoot::floor::{Geometry, SensorId};

/// Quality of a simulated floor.
///
/// | | `Ideal` | `Paper` | `Slight` | `Moderate` | `Severe` |
/// |---|---|---|---|---|---|
/// | plate | rigid, screwed down | rigid, 20 mm | 20 mm on soft feet | 12 mm on soft feet | 12 mm on stiffer feet |
/// | its twist ([`PlateConfig::twist`]), give or take | 0 | 0 | 0.2, 20 % | 0.5, 20 % | 0.8, 20 % |
/// | stiffness of supports, give or take | 0 | 10 % | 10 % | 15 % | 25 % |
/// | uneven seams ([`SeamConfig::unevenness`]) | 0 | 0 | 2 % | 5 % | 10 % |
/// | crosstalk to each adjacent corner | 0 | 0 | 0.3 % | 1 % | 2 % |
/// | error after calibration, of full scale | 0 | 5 % | 2 % | 5 % | 5 % |
/// | noise | 0 | 2 mV | 2 mV | 5 mV | 10 mV |
/// | in newtons at rest, under 200 N | 0 | 0.03, 0.5 | 0.03, 0.5 | 0.08, 1.3 | 0.15, 2.7 |
/// | soft saturation | none | none | none | 350 N | 300 N |
/// | hysteresis | 0 | 0 | 2 % | 5 % | 10 % |
/// | creep per decade | 0 | 0 | 1 % | 3 % | 5 % |
/// | zero drift since the tare, standard deviation | 0 | 0.5 N | 0.3 N | 0.5 N | 1 N |
/// | broken sensors | none | none | none | none | one in 72, open or stuck |
///
/// # Source
/// - Hysteresis of 10 % and creep of 5 % per decade are a maker's figures for force-sensing resistors, as upper limits;
///   the better floors have a fifth and a half of them (our choice).
/// - 5 % after calibration and 2 mV are the paper's. 2 % is our choice: the bench's load cell alone leaves 0.5 %. 5 mV
///   is a converter with 9 effective bits of 5 V, as in microcontrollers (a step of 10 mV, over the root of 12, and the
///   part's own 2 mV), 10 mV such a converter beside a motor (our choice).
/// - Zero drift is our choice: 1 N is a sixth of the load of a tile that counts as loaded, and costs 1 cm at 40 N.
/// - Twist as at [`PlateConfig::twist`]; seams and crosstalk as at [`SeamConfig`]. Crosstalk of 1 % is a corner's share
///   that a common strip of rubber carries over; both other levels are a third and twice of it (our choice).
/// - Soft saturation ends below the 400 N of the converter (our choice), and one broken sensor in 72 makes two on the
///   paper's floor (our choice).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum FloorQuality {
    /// No error at all ([`SimConfig::ideal`]), for tests that need exact readings.
    Ideal,
    /// The paper's plates and parts ([`SimConfig::default`]): rigid plates, sensors without memory.
    Paper,
    /// New and well built: the floor of simulations that name no other.
    #[default]
    Slight,
    /// Built by hand from plywood and force-sensing resistors, as most floors are.
    Moderate,
    /// Thin plates, cheap parts near their limits, some of them broken.
    Severe,
}

impl FloorQuality {
    /// All qualities, from best to worst.
    pub const ALL: [Self; 5] = [Self::Ideal, Self::Paper, Self::Slight, Self::Moderate, Self::Severe];

    /// The three qualities with the errors of real floors.
    pub const REAL: [Self; 3] = [Self::Slight, Self::Moderate, Self::Severe];

    /// Returns true for the qualities with the errors of real floors ([`FloorQuality::REAL`]).
    #[must_use]
    pub fn is_real(self) -> bool {
        Self::REAL.contains(&self)
    }

    /// Returns the name in tables and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ideal => "ideal",
            Self::Paper => "paper",
            Self::Slight => "slight",
            Self::Moderate => "moderate",
            Self::Severe => "severe",
        }
    }

    /// Returns the construction of such a floor.
    #[must_use]
    pub fn config(self) -> SimConfig {
        let paper = (PlateConfig::default(), PartConfig::default());
        let (plate, seam, parts) = match self {
            Self::Ideal => return SimConfig::ideal(),
            Self::Paper => return SimConfig::default(),
            Self::Slight => (
                PlateConfig { twist: 0.2, twist_spread: 0.2, ..paper.0 },
                SeamConfig { unevenness: 0.02, crosstalk: 0.003 },
                PartConfig { deviation: 0.02, hysteresis: 0.02, creep: 0.01, ..paper.1 },
            ),
            // Birch plywood of 12 mm and an actuator: 0.76 + 1.0 kg.
            Self::Moderate => (
                PlateConfig {
                    mass_kg: 1.8,
                    twist: 0.5,
                    twist_spread: 0.2,
                    stiffness_spread: 0.15,
                    ..paper.0
                },
                SeamConfig { unevenness: 0.05, crosstalk: 0.01 },
                PartConfig { noise_v: 0.005, saturation_n: 350.0, hysteresis: 0.05, creep: 0.03, ..paper.1 },
            ),
            Self::Severe => (
                PlateConfig {
                    mass_kg: 1.8,
                    twist: 0.8,
                    twist_spread: 0.2,
                    stiffness_spread: 0.25,
                    ..paper.0
                },
                SeamConfig { unevenness: 0.1, crosstalk: 0.02 },
                PartConfig { noise_v: 0.01, saturation_n: 300.0, ..paper.1.with_memory() },
            ),
        };
        SimConfig { plate, seam, sensing: SimulatedSensors::Counts(parts) }
    }

    /// Returns the standard deviation of a sensor's zero drift since the tare (N).
    #[must_use]
    pub const fn offset_n(self) -> f32 {
        match self {
            Self::Ideal => 0.0,
            Self::Slight => 0.3,
            Self::Paper | Self::Moderate => 0.5,
            Self::Severe => 1.0,
        }
    }

    /// Returns the broken sensors of a floor and their faults; the same `seed` breaks the same sensors.
    #[must_use]
    pub fn broken(self, geometry: &Geometry, seed: u64) -> Vec<(SensorId, SensorFault)> {
        if self != Self::Severe {
            return Vec::new();
        }
        let mut rng = Pcg64Mcg::seed_from_u64(seed ^ 0x0b80_1ce5);
        let tiles: Vec<_> = geometry.tiles().filter(|tile| geometry.has(*tile)).collect();
        let count = (4 * tiles.len()).div_ceil(SENSORS_PER_BROKEN);
        (0..count)
            .filter_map(|number| {
                let tile = *tiles.get(rng.random_range(0..tiles.len()))?;
                let sensors = geometry.sensors(tile);
                let corner = *sensors.get(rng.random_range(0..sensors.len()))?;
                let fault = if number % 2 == 0 { SensorFault::Open } else { SensorFault::Stuck };
                Some((SensorId { tile, corner }, fault))
            })
            .collect()
    }
}

/// Number of sensors per broken one on a floor of the worst quality: two are broken on 6 x 6 tiles.
const SENSORS_PER_BROKEN: usize = 72;

/// Error: no quality has this name.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("no floor is called \"{0}\": there are ideal, paper, slight, moderate and severe")]
pub struct UnknownQuality(String);

impl fmt::Display for FloorQuality {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for FloorQuality {
    type Err = UnknownQuality;

    fn from_str(name: &str) -> Result<Self, UnknownQuality> {
        Self::ALL
            .into_iter()
            .find(|quality| quality.name() == name)
            .ok_or_else(|| UnknownQuality(name.into()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{SimFloor, calibrated, mapped};
    use underfoot::floor::Floor;

    #[test]
    fn every_floor_but_the_ideal_can_be_calibrated_and_mapped_and_names_lead_back() {
        let nominal = Floor::of(Geometry::of_paper_tiles(2, 2).unwrap());
        for quality in FloorQuality::ALL {
            assert_eq!(quality.name().parse(), Ok(quality));
            for seed in 0..4 {
                let sim = SimFloor::new(&nominal, quality.config(), seed);
                let floor = calibrated(&nominal, &sim, seed).unwrap();
                mapped(&floor, &sim, seed).unwrap();
            }
        }
        assert!("good".parse::<FloorQuality>().is_err());
    }

    #[test]
    fn only_the_worst_floor_has_broken_sensors_and_always_the_same() {
        let geometry = Geometry::default();
        for quality in FloorQuality::ALL {
            let broken = quality.broken(&geometry, 7);
            assert_eq!(broken.len(), if quality == FloorQuality::Severe { 2 } else { 0 });
            assert_eq!(broken, quality.broken(&geometry, 7));
        }
    }
}
