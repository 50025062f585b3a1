//! Loads up to which kinds of laws that fit about as well agree about a sensor.

use super::fit::{SensorFit, StandFit};
use crate::units::Newtons;

/// Share of the least misfit within which another kind fits about as well: errors of the feet decide between them.
const ALIKE: f64 = 0.15;

/// Share of the force by which laws that agree differ at most.
const AGREED: f32 = 0.1;

/// Least and greatest load at which two laws are compared (N), and the ratio of two neighbours among the loads.
const LOADS_N: [f32; 2] = [20.0, 2000.0];
const RATIO: f32 = 1.1;

/// Whether a kind of laws with this misfit fits about as well as the one with the least.
pub(super) fn is_alike(misfit: f64, least: f64) -> bool {
    misfit <= least + ALIKE * least.abs()
}

impl StandFit {
    /// Lowers the load up to which each sensor's law is sure to that at which a rival, of the same sensors, departs
    /// from it.
    pub(super) fn note_rival(&mut self, rival: &Self) {
        for (own, other) in self.sensors.iter_mut().zip(&rival.sensors) {
            own.sure_to = Newtons(own.sure_to.0.min(parting(own, other)));
        }
    }
}

/// The least load (N) at which the two laws of a sensor differ by more than a tenth; infinite if they agree at all loads.
fn parting(own: &SensorFit, other: &SensorFit) -> f32 {
    let force = |load: f32| {
        let volts = own.law.volts_at(Newtons(load) + own.tare);
        (other.law.force_at(volts) - other.tare).0
    };
    // Laws that give no number there do not agree.
    let agrees = |load: &f32| (force(*load) - load).abs() <= AGREED * load;
    let loads = std::iter::successors(Some(LOADS_N[0]), |load| Some(load * RATIO));
    loads.take_while(|load| *load < LOADS_N[1]).find(|load| !agrees(load)).unwrap_or(f32::INFINITY)
}
