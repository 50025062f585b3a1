//! The forces and qualities of all sensors at one instant.

mod calibration_fault;
mod hold_doubt;
mod quality;
mod tile_sample;

use glam::Vec2;

pub use calibration_fault::CalibrationFault;
pub use hold_doubt::HoldDoubt;
pub use quality::Quality;
pub use tile_sample::TileSample;

use crate::floor::Geometry;
use crate::units::{Instant, Newtons};

/// The forces of all sensors at one instant, calibrated and tared.
#[derive(Clone, Debug, PartialEq)]
pub struct ForceFrame {
    /// Time at which the forces acted, on the floor's sample clock.
    pub at: Instant,
    /// Arrival of the packet that completed the frame; equals `at` without a network.
    pub received: Instant,
    /// Newtons per tile (tile-index order), each in [`crate::floor::Corner::ALL`] order. Always finite: a reading
    /// that is not finite keeps the sensor's last good one (0 if there was none) and marks it [`Quality::Faulty`]. A
    /// missing sample also keeps the last one, but marks nothing until the board is silent.
    pub forces: Vec<[f32; 4]>,
    /// Quality of each of `forces`.
    pub quality: Vec<[Quality; 4]>,
    /// Per tile, whether its forces may start an engagement. They may not if a sensor is at the end of its range,
    /// where its force is a lower bound, or reads a load to which the rest of its plate does not respond. They may
    /// always keep and end one.
    pub may_start: Vec<bool>,
    /// Per tile, the reason for which its readings may not hold a control with the guard `HoldToRun`; `None` where
    /// they may.
    pub hold_doubts: Vec<Option<HoldDoubt>>,
    /// Reason for which the newtons may be wrong all over the floor; `None` if they come from this floor's
    /// calibration.
    /// With a fault, controls with the guard `HoldToRun` are off.
    pub calibration_fault: Option<CalibrationFault>,
    /// Per tile, the sample that its forces come from; empty where all boards sample once a frame.
    pub samples: Vec<TileSample>,
    /// Whether any force or quality may be new. Frames between the samples of slow boards are not: they repeat the
    /// last forces.
    pub is_new: bool,
}

impl ForceFrame {
    /// A frame of an empty floor with every sensor live, at the clock's start.
    #[must_use]
    pub fn empty(geometry: &Geometry) -> Self {
        let tiles = geometry.tile_count();
        Self {
            at: Instant::START,
            received: Instant::START,
            forces: vec![[0.0; 4]; tiles],
            quality: vec![[Quality::Live; 4]; tiles],
            may_start: vec![true; tiles],
            hold_doubts: vec![None; tiles],
            calibration_fault: None,
            samples: Vec::new(),
            is_new: true,
        }
    }

    /// Whether the forces of the tile at this index are new in this frame.
    #[must_use]
    pub fn is_new_at(&self, tile: usize) -> bool {
        self.samples.get(tile).map_or(self.is_new, |sample| sample.is_new)
    }

    /// Adds a point load, divided among the tile's sensors as by an ideal rigid plate.
    ///
    /// A load beyond the floor, or one that is not finite, adds nothing. For apps without hardware and for tests;
    /// a simulated floor has plates, feet and sensors with their faults.
    ///
    /// # Source
    /// Eq. 2 of the paper solved for equal springs: [`crate::floor::SensorPlaces::shares`].
    pub fn add_load(&mut self, geometry: &Geometry, at: Vec2, force: Newtons) {
        let Some(tile) = geometry.tile_under(at).filter(|_| force.is_finite()) else { return };
        let shares = geometry.sensor_places(tile).shares(at - geometry.centre(tile));
        let Some(sensors) = geometry.index(tile).and_then(|index| self.forces.get_mut(index)) else { return };
        for (sensor, share) in sensors.iter_mut().zip(shares) {
            *sensor += force.0 * share;
        }
    }
}
