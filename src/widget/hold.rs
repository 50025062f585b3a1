//! A control that acts for as long as it is held: momentary, a dead-man's switch.
//!
//! ```text
//!  1  press                                  -> Pressed, Changed (on)
//!  2  the foot lets go                       -> Changed (off), Released
//!  3  slide off, a step, loss, an app stops  -> Changed (off), Cancelled
//!  4  an app sets it                         -> refused: only a foot can hold it
//! ```
//!
//! With the guard `HoldToRun` it is also off as soon as the contact is uncertain, and after a time.

use super::moment::{BehaviourInput, BehaviourMachine};
use super::press::PressOutcome;
use super::{Emitted, EventKind, SetError, Thresholds, Value};
use underfoot_format::{Flat, record};

record! {
    /// A control that is on while a foot holds it.
    pub struct HoldSpec = "Hold", Copy;
    /// The thresholds of its press.
    pub thresholds: Thresholds = "", Flat;
}

/// The state of a momentary control.
#[derive(Clone, Debug, Default)]
pub(super) struct Hold {
    on: bool,
}

impl BehaviourMachine for Hold {
    fn act(&mut self, moment: &BehaviourInput, emitted: &mut Emitted) {
        let (on, kind) = match moment.outcome {
            Some(PressOutcome::Pressed) => (true, EventKind::Pressed),
            Some(PressOutcome::Released) => (false, EventKind::Released),
            Some(PressOutcome::Cancelled) => (false, EventKind::Cancelled),
            None => return,
        };
        self.on = on;
        let changed = EventKind::Changed(Value::Switch(on));
        emitted.extend(if on { [kind, changed] } else { [changed, kind] });
    }

    fn value(&self) -> Option<Value> {
        Some(Value::Switch(self.on))
    }

    fn set(&mut self, _: Value) -> Result<(), SetError> {
        Err(SetError::Momentary)
    }
}
