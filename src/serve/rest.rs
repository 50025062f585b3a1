//! A channel's readings on the empty floor, from packets before the tare.

use crate::floor::Calibration;
use crate::wire::Readings;

/// Number of packets of a board in the mean of the empty floor.
pub(super) const REST: u32 = 300;

/// The readings of one channel on the empty floor.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Rest {
    /// Sum of the readings (N).
    sum: f32,
    /// Number of readings in the sum.
    read: u32,
}

impl Rest {
    /// Adds a reading; a missing one does not count.
    pub(super) fn add(&mut self, force: Option<f32>) {
        self.sum += force.unwrap_or(0.0);
        self.read += u32::from(force.is_some());
    }

    /// The mean of the readings (N); 0 without any.
    pub(super) fn mean(&self) -> f32 {
        self.sum / self.read.max(1) as f32
    }
}

/// The reading of a channel (N), by this law if it is in counts; `None` if it is missing or not a number.
pub(super) fn reading(readings: &Readings, channel: usize, law: &Calibration) -> Option<f32> {
    match readings {
        Readings::Counts(counts) => counts.get(channel).copied().flatten().map(|count| law.force(count).0),
        Readings::Scaled(values) => {
            let value = values.get(channel).copied().filter(|value| value.is_finite());
            value.map(|value| law.force_at(Calibration::volts_of(value)).0)
        }
        Readings::Newtons(forces) => forces.get(channel).copied().filter(|force| force.is_finite()),
    }
}
