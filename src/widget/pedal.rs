//! A pedal: the harder it is pressed, the greater its value.
//!
//! ```text
//!  1  press                                  -> Pressed
//!  2  force above the dead band              -> Changed, growing with it
//!  3  force at `full` and beyond             -> Changed (the greatest value)
//!  4  force between release and dead band    -> Changed (the least value), still pressed
//!  5  the foot lets go                       -> Changed (the least value), Released
//!  6  slide off, a step, loss                -> Changed (the least value), Cancelled
//!  7  a force that can't be trusted          -> the value stays (with HoldToRun: 6)
//!  8  an app sets it                         -> refused: only a foot can hold it
//! ```

use super::moment::{BehaviourInput, BehaviourMachine};
use super::press::PressOutcome;
use super::{Emitted, EventKind, Scale, SetError, Thresholds, Value};
use crate::units::Newtons;
use underfoot_format::number::plain;
use underfoot_format::{Flat, Opt, num, record};

record! {
    /// A pedal: force to value. `deadband` and `full` are scaled with the press threshold where that is a share of
    /// the weight.
    pub struct PedalSpec = "Pedal", Copy => |it, faults| {
        if it.gives_from() >= it.full {
            let [deadband, full] = [it.gives_from(), it.full].map(|force| plain(force.0.into()));
            let found = format!("deadband_n is {deadband} N, full_n is {full} N");
            faults.error(&["full_n", "deadband_n", "press_n"], "`full_n` must be above `deadband_n`", found);
        }
    };
    /// The thresholds of its press.
    pub thresholds: Thresholds = "", Flat;
    /// Its values; the least at rest.
    pub scale: Scale = "", Flat;
    /// Force up to which the value is the least; the press threshold by default.
    pub deadband: Option<Newtons> = "deadband_n", Opt(num(0.0..=1000.0)) => None;
    /// Force above which the value is the greatest; more than `deadband`.
    pub full: Newtons = "full_n", num(10.0..=2000.0);
    /// Exponent of the curve in between: 1 is linear, a greater one gives finer control of light presses.
    pub curve: f32 = "curve", num(0.2..=5.0) => 1.0;
}

impl PedalSpec {
    /// Force up to which the value is the least.
    #[must_use]
    pub(crate) fn gives_from(&self) -> Newtons {
        self.deadband.unwrap_or(self.thresholds.press)
    }
}

/// Minimum change for an event, as a part of the range (our choice: a foot's force varies by as much).
const QUANTUM: f32 = 0.01;

/// The state of a pedal.
#[derive(Clone, Debug)]
pub(super) struct Pedal {
    spec: PedalSpec,
    value: f32,
}

impl Pedal {
    pub(super) fn new(spec: PedalSpec) -> Self {
        Self { value: spec.scale.min, spec }
    }

    fn change(&mut self, value: Option<f32>, emitted: &mut Emitted) {
        if let Some(value) = value.filter(|value| *value != self.value) {
            self.value = value;
            emitted.push(EventKind::Changed(Value::Number(value)));
        }
    }
}

impl BehaviourMachine for Pedal {
    fn act(&mut self, moment: &BehaviourInput, emitted: &mut Emitted) {
        let PedalSpec { thresholds, scale, full, curve, .. } = self.spec;
        let deadband = self.spec.gives_from();
        match moment.outcome {
            Some(PressOutcome::Pressed) => emitted.push(EventKind::Pressed),
            Some(PressOutcome::Released) => {
                self.change(Some(scale.min), emitted);
                emitted.push(EventKind::Released);
            }
            Some(PressOutcome::Cancelled) => {
                self.change(Some(scale.min), emitted);
                emitted.push(EventKind::Cancelled);
            }
            None => {}
        }
        if let Some(foot) = moment.foot {
            let grown = moment.at.press / thresholds.press;
            let share = (foot.force - deadband * grown) / ((full - deadband) * grown);
            let wanted = scale.at(share.clamp(0.0, 1.0).powf(curve));
            self.change(scale.follow(self.value, wanted, QUANTUM), emitted);
        }
    }

    fn value(&self) -> Option<Value> {
        Some(Value::Number(self.value))
    }

    fn set(&mut self, _: Value) -> Result<(), SetError> {
        Err(SetError::Momentary)
    }
}
