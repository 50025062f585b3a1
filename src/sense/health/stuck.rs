//! Does a sensor follow the load of its plate?
//!
//! A stuck sensor reads the same while a load that moves its neighbours requires another reading of it.

use super::plate;

/// Time for which a sensor must be still although its plate requires otherwise to be stuck (s): half a step.
const STUCK_S: f32 = 0.3;

/// A sensor is still if its averages stay within this force and this share of its reading: its converter's noise (2
/// mV are 0.3 % of the force) with ample margin.
pub(super) const STILL_N: f32 = 1.0;
const STILL_SHARE: f32 = 0.02;

/// Ratio of the maximum range of a still sensor's readings to that of its averages, including noise and hum.
const STIRRED: f32 = 10.0;

/// Change of the required load of a corner, besides the plate estimate's error, that a working sensor must follow
/// (N).
const CHANGE_N: f32 = 10.0;

/// Least change of a neighbour of a stuck sensor, as a share of the change of the required load: a load moves at least
/// two of the other three, so if one alone has moved, that one may be at fault (our choice).
const WITH_NEIGHBOUR: f32 = 0.35;

/// The other sensors of a tile, as far as they show the load of one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Demands {
    /// Least and greatest reading that the plate allows (N).
    pub(super) least: f32,
    pub(super) most: f32,
    /// Readings of its two neighbours (N).
    pub(super) neighbours: [f32; 2],
    /// Load on all other corners (N).
    pub(super) load: f32,
}

/// Extremes of a sensor and of its neighbours since the sensor last moved.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Extremes {
    begun: bool,
    own: (f32, f32),
    expected: (f32, f32),
    /// Of its two neighbours.
    neighbours: [(f32, f32); 2],
    /// Largest load on the other corners.
    load: f32,
    /// Time since it should have moved (s).
    overdue: f32,
}

impl Extremes {
    /// Adds a block in which the other sensors show these demands; returns true if the sensor is stuck.
    pub(super) fn follow(&mut self, own: f32, spread: f32, demands: Demands, seconds: f32) -> bool {
        let Demands { least, most, neighbours, load } = demands;
        let widened = |range: (f32, f32), value: f32| (range.0.min(value), range.1.max(value));
        let reach = widened(self.own, own);
        let still = STILL_N + STILL_SHARE * own.abs();
        // A reading that moved and returned within the block was not still.
        if !self.begun || reach.1 - reach.0 > still || spread > STIRRED * still {
            let here = |value: f32| (value, value);
            *self = Self {
                begun: true,
                own: here(own),
                expected: here(least),
                neighbours: neighbours.map(here),
                load,
                overdue: 0.0,
            };
            return false;
        }
        self.own = reach;
        self.expected = widened(self.expected, least);
        for (range, now) in self.neighbours.iter_mut().zip(neighbours) {
            *range = widened(*range, now);
        }
        self.load = self.load.max(load);
        let slack = CHANGE_N + plate::SLACK * self.load;
        let change = self.expected.1 - self.expected.0;
        let by_load = self.neighbours.iter().any(|range| range.1 - range.0 > WITH_NEIGHBOUR * change);
        // The sensor has not only failed to move before: its present reading is wrong.
        let amiss = (least - own).max(own - most);
        if change > slack && by_load && amiss > 0.5 * slack {
            self.overdue += seconds;
        }
        self.overdue >= STUCK_S
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_corner_that_bears_more_with_its_diagonal_in_the_air_is_not_stuck() {
        // As for a person who steps off a tile over its edge: in half a second the requirement falls from 130 to 72
        // N.
        let is_stuck = |most: fn(f32) -> f32| {
            let mut extremes = Extremes::default();
            let mut demands = (0..8_u8).map(|block| (130.0 - 12.0 * f32::from(block)).max(72.0));
            demands.any(|least| {
                let demands = Demands { least, most: most(least), neighbours: [least, 0.0], load: 90.0 };
                extremes.follow(164.5, 1.0, demands, 0.064)
            })
        };
        assert!(is_stuck(|least| least));
        assert!(!is_stuck(|_| f32::INFINITY));
    }
}
