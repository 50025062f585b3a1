//! A direction pad for leaning: the value is the shift of the foot's pressure from its settled place.
//!
//! ```text
//!  1  press                                -> Pressed; the value is zero while the foot settles
//!  2  settled                              -> where the pressure is now is the origin
//!  3  lean less than the dead band         -> zero
//!  4  lean farther                         -> Changed: a direction, and a length that grows to 1 at `full_m`
//!  5  lean back                            -> Changed, down to zero
//!  6  lifting, a force not to be trusted   -> the value stays
//!  7  the foot lets go                     -> Changed (zero), Released
//!  8  slide off, a step, loss              -> Changed (zero), Cancelled
//!  9  an app sets it                       -> refused: only a foot can lean
//! ```

use std::time::Duration;

use glam::Vec2;

use super::moment::{BehaviourInput, BehaviourMachine};
use super::press::PressOutcome;
use super::{Emitted, EventKind, SetError, Thresholds, Value};
use crate::units::Instant;
use underfoot_format::number::plain;
use underfoot_format::{Flat, num, record};

record! {
    /// A direction pad for leaning.
    ///
    /// The pressure of a standing foot wanders by half a centimetre, that of a leaning one by about four.
    pub struct LeanSpec = "Lean", Copy => |it, faults| {
        if it.deadband_m >= it.full_m {
            let [deadband, full] = [it.deadband_m, it.full_m].map(|metres| plain(metres.into()));
            let found = format!("deadband_m is {deadband} m, full_m is {full} m");
            faults.error(&["full_m", "deadband_m"], "`full_m` must be above `deadband_m`", found);
        }
    };
    /// The thresholds of its press.
    pub thresholds: Thresholds = "", Flat;
    /// Time in which a foot settles: its heel lands first and it rolls on.
    pub settle: Duration = "settle_ms", num(0.0..=2000.0).milli() => Duration::from_millis(250);
    /// Minimum shift of the pressure that counts, in metres.
    pub deadband_m: f32 = "deadband_m", num(0.0..=0.5) => 0.008;
    /// Shift of the pressure for a length of 1, in metres; more than `deadband_m`.
    pub full_m: f32 = "full_m", num(0.001..=0.5) => 0.03;
}

/// Minimum change of the length for an event (our choice: quiet standing sways by as much).
const QUANTUM: f32 = 0.02;

/// Time constant T of the origin's smoothing, `mean += (1 - exp(-dt / T)) * (x - mean)`: short, so that the start of
/// a roll does not count.
const MEMORY: Duration = Duration::from_millis(30);

/// The state of a direction pad.
#[derive(Clone, Debug)]
pub(super) struct Lean {
    spec: LeanSpec,
    value: Vec2,
    origin: Origin,
}

#[derive(Clone, Copy, Debug)]
enum Origin {
    /// Not pressed.
    None,
    /// Smoothed place since the press.
    Settling { since: Instant, mean: Option<Vec2> },
    /// The origin, in metres from the control's middle.
    At(Vec2),
}

impl Lean {
    pub(super) fn new(spec: LeanSpec) -> Self {
        Self { spec, value: Vec2::ZERO, origin: Origin::None }
    }

    fn change(&mut self, value: Vec2, emitted: &mut Emitted) {
        let little = value.distance(self.value) < QUANTUM && value != Vec2::ZERO;
        if value != self.value && !little {
            self.value = value;
            emitted.push(EventKind::Changed(Value::Pair(value)));
        }
    }

    fn leaning(&self, way: Vec2) -> Vec2 {
        let LeanSpec { deadband_m, full_m, .. } = self.spec;
        let length = ((way.length() - deadband_m) / (full_m - deadband_m)).clamp(0.0, 1.0);
        way.normalize_or_zero() * length
    }
}

impl BehaviourMachine for Lean {
    fn act(&mut self, moment: &BehaviourInput, emitted: &mut Emitted) {
        match moment.outcome {
            Some(PressOutcome::Pressed) => {
                self.origin = Origin::Settling { since: moment.now, mean: None };
                emitted.push(EventKind::Pressed);
            }
            Some(PressOutcome::Released) => {
                self.origin = Origin::None;
                self.change(Vec2::ZERO, emitted);
                emitted.push(EventKind::Released);
            }
            Some(PressOutcome::Cancelled) => {
                self.origin = Origin::None;
                self.change(Vec2::ZERO, emitted);
                emitted.push(EventKind::Cancelled);
            }
            None => {}
        }
        let Some(at) = moment.offset() else { return };
        match self.origin {
            Origin::None => {}
            Origin::Settling { since, mean } => {
                let forget = 1.0 - (-moment.elapsed.div_duration_f32(MEMORY)).exp();
                let mean = mean.map_or(at, |mean| mean.lerp(at, forget));
                self.origin = if moment.now.since(since) >= self.spec.settle {
                    Origin::At(mean)
                } else {
                    Origin::Settling { since, mean: Some(mean) }
                };
            }
            Origin::At(origin) => self.change(self.leaning(at - origin), emitted),
        }
    }

    fn value(&self) -> Option<Value> {
        Some(Value::Pair(self.value))
    }

    fn set(&mut self, _: Value) -> Result<(), SetError> {
        Err(SetError::Momentary)
    }
}
