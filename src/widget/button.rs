use super::press::{Outcome, Press};
use super::{ButtonSpec, Emitted, EventKind, Input};
use crate::units::Instant;

/// A push button at work.
///
/// ```text
/// press              -> Pressed
/// release on itself  -> Released, Clicked
/// slide off, loss    -> Cancelled
/// ```
#[derive(Clone, Debug)]
pub(super) struct Button {
    pub(super) press: Press,
}

impl Button {
    pub(super) fn new(spec: ButtonSpec) -> Self {
        Self { press: Press::new(spec.thresholds) }
    }

    pub(super) fn step(&mut self, now: Instant, input: Input) -> Emitted {
        let outcome = self.press.step(now, input);
        Self::emit(outcome)
    }

    pub(super) fn cancel(&mut self) -> Emitted {
        Self::emit(self.press.cancel())
    }

    fn emit(outcome: Option<Outcome>) -> Emitted {
        match outcome {
            Some(Outcome::Pressed) => Emitted::from_iter([EventKind::Pressed]),
            Some(Outcome::Released) => Emitted::from_iter([EventKind::Released, EventKind::Clicked]),
            Some(Outcome::Cancelled) => Emitted::from_iter([EventKind::Cancelled]),
            None => Emitted::new(),
        }
    }
}
