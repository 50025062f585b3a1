//! A number moved by feet and reverted by a cancel.

use super::press::PressOutcome;
use super::{Emitted, EventKind, Scale, SetError, Value};

/// A number moved by feet; a cancelled press reverts it.
#[derive(Clone, Debug)]
pub(super) struct ControlNumber {
    scale: Scale,
    value: f32,
    /// The value before the press.
    before: f32,
    /// The value before steps and detents.
    raw: f32,
}

impl ControlNumber {
    pub(super) fn new(scale: Scale, initial: f32) -> Self {
        let value = scale.settle(initial);
        Self { scale, value, before: value, raw: value }
    }

    pub(super) fn value(&self) -> f32 {
        self.value
    }

    /// Emits the outcome of the press, and reverts a cancelled one.
    pub(super) fn follow_press(&mut self, outcome: Option<PressOutcome>, emitted: &mut Emitted) {
        match outcome {
            Some(PressOutcome::Pressed) => {
                self.before = self.value;
                self.raw = self.value;
                emitted.push(EventKind::Pressed);
            }
            Some(PressOutcome::Released) => emitted.push(EventKind::Released),
            Some(PressOutcome::Cancelled) => {
                if self.value != self.before {
                    self.value = self.before;
                    emitted.push(EventKind::Changed(Value::Number(self.value)));
                }
                emitted.push(EventKind::Cancelled);
            }
            None => {}
        }
    }

    /// Sets the value to `wanted`, subject to steps and detents.
    pub(super) fn follow(&mut self, wanted: f32, quantum: f32, emitted: &mut Emitted) {
        if let Some(value) = self.scale.follow(self.value, wanted, quantum) {
            self.value = value;
            emitted.push(EventKind::Changed(Value::Number(value)));
        }
    }

    /// Moves by `way`; keeps the rest between two steps for later, drops the part beyond an end.
    pub(super) fn move_by(&mut self, way: f32, emitted: &mut Emitted) {
        if way.is_finite() {
            self.raw = self.scale.limited(self.raw + way);
            self.follow(self.raw, super::scale::QUANTUM, emitted);
        }
    }

    /// Sets the value for an app.
    pub(super) fn set(&mut self, value: Value) -> Result<(), SetError> {
        let Value::Number(number) = value else { return Err(SetError::WrongType) };
        if !number.is_finite() {
            return Err(SetError::NotFinite);
        }
        self.value = self.scale.settle(number);
        Ok(())
    }
}
