//! Mean and scatter of all outputs on the empty floor.

use crate::sense::Scatter;
use crate::serve::rest::REST;

/// Standard deviation of an output on the empty floor above which somebody walks on it (V).
const RESTLESS_V: f64 = 0.1;

/// The outputs of all sensors since the floor has been empty.
#[derive(Clone, Debug)]
pub(super) struct RestMeter {
    sensors: Vec<Scatter>,
    moments: u32,
}

impl RestMeter {
    pub(super) fn new(sensors: usize) -> Self {
        Self { sensors: vec![Scatter::default(); sensors], moments: 0 }
    }

    /// Adds the outputs (V) of one moment.
    pub(super) fn add(&mut self, volts: &[f32]) {
        self.moments += 1;
        for (rest, volts) in self.sensors.iter_mut().zip(volts) {
            rest.add(f64::from(*volts));
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

    /// Mean and standard deviation of each output (V); zero before the first moment.
    pub(super) fn outputs(&self) -> impl Iterator<Item = (f32, f32)> {
        self.sensors.iter().map(|rest| (rest.mean() as f32, rest.deviation() as f32))
    }
}
