//! A direction pad worked by leaning: how far the foot's pressure has moved from where it settled.
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

use super::moment::{Machine, Moment};
use super::press::Outcome;
use super::{Emitted, EventKind, SetError, Thresholds, Value};
use crate::format::number::plain;
use crate::format::{Flat, num, record};
use crate::units::Instant;

record! {
    /// A direction pad worked by leaning.
    ///
    /// A foot's pressure wanders by half a centimetre while it stands, and by about four when it leans.
    pub struct LeanSpec = "Lean", Copy => |it, faults| {
        if it.deadband_m >= it.full_m {
            let [deadband, full] = [it.deadband_m, it.full_m].map(|metres| plain(metres.into()));
            let found = format!("deadband_m is {deadband} m, full_m is {full} m");
            faults.error(&["full_m", "deadband_m"], "`full_m` must be above `deadband_m`", found);
        }
    };
    /// When it engages.
    pub thresholds: Thresholds = "", Flat;
    /// How long a foot takes to settle: its heel lands first and it rolls on.
    pub settle: Duration = "settle_ms", num(0.0..=2000.0).milli() => Duration::from_millis(250);
    /// How far the pressure must move before it counts, in metres.
    pub deadband_m: f32 = "deadband_m", num(0.0..=0.5) => 0.008;
    /// How far it must move for a length of 1, in metres; more than `deadband_m`.
    pub full_m: f32 = "full_m", num(0.001..=0.5) => 0.03;
}

/// Smallest change of the length worth an event (our choice: standing still sways by as much).
const QUANTUM: f32 = 0.02;

/// Over how much of the last time the origin is averaged, so that a foot that rolled there is not half-way.
const MEMORY: Duration = Duration::from_millis(30);

/// A direction pad at work.
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
    /// The mean of the last places since the press.
    Settling { since: Instant, mean: Option<Vec2> },
    /// Known, in metres from the control's middle.
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

impl Machine for Lean {
    fn act(&mut self, moment: &Moment, emitted: &mut Emitted) {
        match moment.outcome {
            Some(Outcome::Pressed) => {
                self.origin = Origin::Settling { since: moment.now, mean: None };
                emitted.push(EventKind::Pressed);
            }
            Some(Outcome::Released) => {
                self.origin = Origin::None;
                self.change(Vec2::ZERO, emitted);
                emitted.push(EventKind::Released);
            }
            Some(Outcome::Cancelled) => {
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
