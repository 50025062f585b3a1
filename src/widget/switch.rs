//! A switch: each completed press toggles it.
//!
//! ```text
//!  1  press                              -> Pressed
//!  2  release on itself                  -> Released, Changed (turned over)
//!  3  slide off, a step, loss            -> Cancelled (not turned over)
//!  4  an app sets it                     -> no event
//! ```

use super::moment::{BehaviourInput, BehaviourMachine};
use super::press::PressOutcome;
use super::{Emitted, EventKind, SetError, Thresholds, Value};
use underfoot_format::{Flag, Flat, record};

record! {
    /// A switch: each completed press toggles it.
    pub struct SwitchSpec = "Switch", Copy;
    /// The thresholds of its press.
    pub thresholds: Thresholds = "", Flat;
    /// Whether it is on initially.
    pub initial: bool = "initial", Flag => false;
}

/// The state of a switch.
#[derive(Clone, Debug)]
pub(super) struct Switch {
    on: bool,
}

impl Switch {
    pub(super) fn new(spec: SwitchSpec) -> Self {
        Self { on: spec.initial }
    }
}

impl BehaviourMachine for Switch {
    fn act(&mut self, moment: &BehaviourInput, emitted: &mut Emitted) {
        match moment.outcome {
            Some(PressOutcome::Pressed) => emitted.push(EventKind::Pressed),
            Some(PressOutcome::Released) => {
                self.on = !self.on;
                emitted.extend([EventKind::Released, EventKind::Changed(Value::Switch(self.on))]);
            }
            Some(PressOutcome::Cancelled) => emitted.push(EventKind::Cancelled),
            None => {}
        }
    }

    fn value(&self) -> Option<Value> {
        Some(Value::Switch(self.on))
    }

    fn set(&mut self, value: Value) -> Result<(), SetError> {
        let Value::Switch(on) = value else { return Err(SetError::WrongType) };
        self.on = on;
        Ok(())
    }

    fn pending(&self) -> Option<Value> {
        Some(Value::Switch(!self.on))
    }
}
