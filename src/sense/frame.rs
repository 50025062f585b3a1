use super::Quality;
use crate::floor::Geometry;
use crate::units::Instant;

/// The forces of all sensors at one instant, calibrated and tared.
#[derive(Clone, Debug, PartialEq)]
pub struct ForceFrame {
    /// When the forces acted, on the floor's sample clock.
    pub at: Instant,
    /// When the packet that completed the frame arrived; equals `at` where no network is involved.
    pub received: Instant,
    /// Newtons per tile (tile-index order), each in [`crate::floor::Corner::ALL`] order.
    /// Always finite: a reading that is not leaves the sensor's last good one in its place (0 if it
    /// never had one) and marks it [`Quality::Faulty`]; so does a sample that never came, which
    /// marks nothing until the board counts as silent.
    pub forces: Vec<[f32; 4]>,
    /// How far each of `forces` can be trusted.
    pub quality: Vec<[Quality; 4]>,
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
        }
    }
}
