//! The construction of a simulated floor.

use arrayvec::ArrayVec;

use crate::plate::PlateConfig;
use crate::seam::SeamConfig;
use crate::sensor::PartConfig;
use underfoot::wire::Readings;

/// Construction of a simulated floor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SimConfig {
    /// The plates and their mounting.
    pub plate: PlateConfig,
    /// The seams between plates.
    pub seam: SeamConfig,
    /// The boards' sensors and readings.
    pub sensing: SimulatedSensors,
}

impl SimConfig {
    /// A floor without error for first tests: plates screwed to exact sensors, boards that send newtons, no noise, no
    /// saturation, no tare.
    #[must_use]
    pub const fn ideal() -> Self {
        Self { plate: PlateConfig::ideal(), seam: SeamConfig::even(), sensing: SimulatedSensors::Exact }
    }
}

/// Sensors of a simulated floor, and the readings that its boards send.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SimulatedSensors {
    /// Raw counts of parts with these tolerances.
    Counts(PartConfig),
    /// Newtons from boards that know the law of each part and have tared themselves on the empty floor.
    /// The parts' deviation from the law, noise and saturation remain.
    Newtons(PartConfig),
    /// Newtons without error: the force on each sensor minus its force on the empty floor.
    Exact,
}

impl Default for SimulatedSensors {
    /// Raw counts of the paper's parts.
    fn default() -> Self {
        Self::Counts(PartConfig::default())
    }
}

impl SimulatedSensors {
    /// The tolerances of the parts; `None` with exact sensing.
    pub(super) const fn parts(&self) -> Option<&PartConfig> {
        match self {
            Self::Counts(config) | Self::Newtons(config) => Some(config),
            Self::Exact => None,
        }
    }

    /// Readings of a board without channels.
    pub(super) const fn no_readings(&self) -> Readings {
        match self {
            Self::Counts(_) => Readings::Counts(ArrayVec::new_const()),
            Self::Newtons(_) | Self::Exact => Readings::Newtons(ArrayVec::new_const()),
        }
    }

    /// Standard deviation of the noise (V).
    pub(super) const fn noise_v(&self) -> f32 {
        match self.parts() {
            Some(config) => config.noise_v,
            None => 0.0,
        }
    }

    /// Standard deviation of the noise of counts in proportion to the force, as a share of it.
    pub(super) const fn noise_share(&self) -> f32 {
        match self {
            Self::Counts(config) => config.noise_share,
            Self::Newtons(_) | Self::Exact => 0.0,
        }
    }
}
