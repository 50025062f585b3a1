//! The checks of one tile that precede a press: broken sensors, found in the same frame.

use super::plate::{self, Twist};
use super::trouble::{Sensor, Trouble};
use super::{RangeEnd, is_connected};
use crate::sense::Quality;

/// Maximum increase of a sensor's load by a foot within a millisecond (N): the hardest heel strike takes five to
/// apply its weight (our choice).
const SUDDEN_N: f32 = 30.0;

/// Maximum decrease of a sensor's load within a millisecond when its corner lifts (N): the load on a corner of an
/// empty plate (our choice).
const FELL_N: f32 = 8.0;

/// The readings of one tile in a frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct TileReadings {
    pub(super) forces: [f32; 4],
    /// Readings in the frame before.
    pub(super) before: [f32; 4],
    pub(super) ends: [RangeEnd; 4],
    /// Time between two samples of its board, in milliseconds.
    pub(super) interval_ms: f32,
    /// Whether the laws of its sensors are known, so that the plate checks apply.
    pub(super) is_measured: bool,
    /// Whether its four sensors form a parallelogram, so that a load on one of them has a response of the others.
    pub(super) is_coupled: bool,
}

/// The result of an examination.
#[derive(Clone, Copy, Debug)]
pub(super) struct Examined {
    /// Whether a load on the tile may start a press.
    pub(super) may_start: bool,
    /// Whether a sensor is faulty.
    in_trouble: bool,
    /// Number of faults found.
    pub(super) found: u32,
}

impl Examined {
    /// Whether the next frame must examine the tile again.
    pub(super) const fn is_open(&self) -> bool {
        self.in_trouble || !self.may_start
    }
}

impl TileReadings {
    /// Finds broken sensors, and lowers the `quality` of faulty ones.
    pub(super) fn examine(
        &self,
        sensors: &mut [Sensor; 4],
        quality: &mut [Quality; 4],
        twist: &Twist,
    ) -> Examined {
        let mut examined = Examined { may_start: true, in_trouble: false, found: 0 };
        if is_connected(quality, sensors) {
            self.find(sensors, twist, &mut examined);
        }
        for (corner, sensor) in sensors.iter().enumerate() {
            quality[corner] = quality[corner].max(sensor.quality());
            examined.may_start &=
                !sensor.forbids_start() && (self.ends[corner] != RangeEnd::High || sensor.is_out());
            examined.in_trouble |= sensor.trouble().is_some();
        }
        examined
    }

    /// Finds broken sensors by the other sensors of the plate.
    fn find(&self, sensors: &mut [Sensor; 4], twist: &Twist, examined: &mut Examined) {
        let Self { forces, before, ends, interval_ms, is_measured, is_coupled } = *self;
        if !is_coupled {
            return;
        }
        let out = sensors.map(|sensor| sensor.is_out());
        let alone = plate::unanswered(forces, out);
        for (corner, sensor) in sensors.iter_mut().enumerate() {
            let is_sudden = (forces[corner] - before[corner]).abs() > SUDDEN_N * interval_ms;
            let fell = before[corner] - forces[corner] > FELL_N * interval_ms;
            let found = match ends[corner] {
                RangeEnd::High if alone == Some(corner) => Some(Trouble::Short),
                RangeEnd::Low
                    if is_measured
                        && plate::should_bear_more(forces, ends, out, corner, fell, twist.range()) =>
                {
                    Some(Trouble::Open)
                }
                _ if is_measured && alone == Some(corner) => {
                    // On a limp plate the other sensors do not respond to a foot on one sensor either; but a foot
                    // pushes, and not from one millisecond to the next.
                    let is_none = is_sudden || forces[corner] < 0.0 || !twist.may_be_limp();
                    examined.may_start &= is_none;
                    is_none.then_some(Trouble::Offset)
                }
                _ => None,
            };
            if let Some(found) = found {
                examined.found += u32::from(sensor.find(found, forces[corner]));
                if is_sudden {
                    sensor.struck();
                }
            }
        }
    }
}
