use super::press::{Outcome, Press};
use super::{Emitted, EventKind, Input, SwitchSpec, Value};
use crate::units::Instant;

/// A switch at work.
///
/// ```text
/// press              -> Pressed
/// release on itself  -> Released, Changed (turned over)
/// slide off, loss    -> Cancelled (not turned over)
/// ```
#[derive(Clone, Debug)]
pub(super) struct Switch {
    pub(super) press: Press,
    pub(super) on: bool,
}

impl Switch {
    pub(super) fn new(spec: SwitchSpec) -> Self {
        Self { press: Press::new(spec.thresholds), on: spec.initial }
    }

    pub(super) fn step(&mut self, now: Instant, input: Input) -> Emitted {
        let outcome = self.press.step(now, input);
        self.emit(outcome)
    }

    pub(super) fn cancel(&mut self) -> Emitted {
        let outcome = self.press.cancel();
        self.emit(outcome)
    }

    fn emit(&mut self, outcome: Option<Outcome>) -> Emitted {
        match outcome {
            Some(Outcome::Pressed) => Emitted::from_iter([EventKind::Pressed]),
            Some(Outcome::Released) => {
                self.on = !self.on;
                Emitted::from_iter([EventKind::Released, EventKind::Changed(Value::Switch(self.on))])
            }
            Some(Outcome::Cancelled) => Emitted::from_iter([EventKind::Cancelled]),
            None => Emitted::new(),
        }
    }
}
