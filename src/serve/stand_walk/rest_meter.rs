//! Mean and scatter of all outputs on the empty floor.

use crate::serve::rest::REST;

/// Standard deviation of an output on the empty floor above which somebody walks on it (V).
const RESTLESS_V: f64 = 0.1;

/// The outputs of all sensors since the floor has been empty.
#[derive(Clone, Debug)]
pub(super) struct RestMeter {
    sensors: Vec<RestVolts>,
    moments: u32,
}

/// Mean and sum of squared deviations of one output, by Welford's recurrence.
#[derive(Clone, Copy, Debug, Default)]
struct RestVolts {
    mean: f64,
    squares: f64,
}

impl RestMeter {
    pub(super) fn new(sensors: usize) -> Self {
        Self { sensors: vec![RestVolts::default(); sensors], moments: 0 }
    }

    /// Adds the outputs (V) of one moment.
    pub(super) fn add(&mut self, volts: &[f32]) {
        self.moments += 1;
        let count = f64::from(self.moments);
        for (rest, volts) in self.sensors.iter_mut().zip(volts) {
            let off = f64::from(*volts) - rest.mean;
            rest.mean += off / count;
            rest.squares += off * (f64::from(*volts) - rest.mean);
        }
    }

    /// Forgets all moments.
    pub(super) fn clear(&mut self) {
        *self = Self::new(self.sensors.len());
    }

    /// Whether there are enough moments.
    pub(super) const fn is_done(&self) -> bool {
        self.moments >= REST
    }

    /// Whether somebody walks on the floor.
    pub(super) fn is_walked_on(&self) -> bool {
        self.outputs().any(|(_, deviation)| f64::from(deviation) > RESTLESS_V)
    }

    /// Mean and standard deviation of each output (V); NaN before the first moment.
    pub(super) fn outputs(&self) -> impl Iterator<Item = (f32, f32)> {
        let count = f64::from(self.moments);
        self.sensors.iter().map(move |rest| (rest.mean as f32, (rest.squares / count).sqrt() as f32))
    }
}
