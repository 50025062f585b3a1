//! The input of a behaviour in one frame, and the interface of all behaviours.

use std::time::Duration;

use glam::Vec2;

use super::press::{PressOutcome, PressState};
use super::rest::RestingPlace;
use super::{Emitted, Input, SetError, Thresholds, Value};
use crate::units::{Instant, Newtons};

/// The input of a behaviour in one frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct BehaviourInput {
    pub(super) now: Instant,
    /// Time since the last frame.
    pub(super) elapsed: Duration,
    /// The outcome of the press in this frame.
    pub(super) outcome: Option<PressOutcome>,
    /// The foot that presses, if its force is reliable.
    pub(super) foot: Option<FootOnControl>,
    /// Whether that foot presses firmly: a lifting foot rolls, and its place is of no use.
    pub(super) firm: bool,
    /// Whether pending actions must be dropped: sensing was lost, the foot steps, or an app stopped the control.
    pub(super) broken: bool,
    /// Width and depth of the control, in metres.
    pub(super) size: Vec2,
    /// The thresholds for this person.
    pub(super) at: Thresholds,
}

/// A foot on a control.
#[derive(Clone, Copy, Debug)]
pub(super) struct FootOnControl {
    pub(super) force: Newtons,
    /// 0 to 1 across the control, beyond that outside.
    pub(super) place: Vec2,
}

impl BehaviourInput {
    /// The moment for `input` and the `outcome` of `press`, at `elapsed` after the last frame.
    pub(super) fn new(
        now: Instant,
        elapsed: Duration,
        input: Input,
        press: &PressState,
        outcome: Option<PressOutcome>,
        size: Vec2,
    ) -> Self {
        let foot = match input {
            Input::Foot { force, trusted: true, place, .. } if press.is_engaged() && place.is_finite() => {
                Some(FootOnControl { force, place })
            }
            _ => None,
        };
        let broken = matches!(input, Input::Lost | Input::Stepping { .. } | Input::SlidOn { .. });
        Self { now, elapsed, outcome, foot, firm: press.is_firm(), broken, size, at: press.thresholds() }
    }

    /// The foot, if it presses firmly: only then may its place change a value.
    pub(super) fn firm_foot(&self) -> Option<FootOnControl> {
        self.foot.filter(|_| self.firm)
    }

    /// The place of that foot, 0 to 1 across the control, which stays while the foot rests: `rest` has its state.
    pub(super) fn settled(&self, rest: &mut RestingPlace) -> Option<Vec2> {
        if self.is(PressOutcome::Pressed) {
            rest.forget();
        }
        let foot = self.firm_foot()?;
        Some(rest.settle(foot.place, self.size, self.now))
    }

    /// Place of that foot, in metres from the control's middle.
    pub(super) fn offset(&self) -> Option<Vec2> {
        self.firm_foot().map(|foot| (foot.place - 0.5) * self.size)
    }

    pub(super) fn is(&self, outcome: PressOutcome) -> bool {
        self.outcome == Some(outcome)
    }
}

/// The interface of behaviours.
pub(super) trait BehaviourMachine: std::fmt::Debug + Send {
    /// Processes one frame and appends its events.
    fn act(&mut self, moment: &BehaviourInput, emitted: &mut Emitted);

    /// Its value; `None` if it has none.
    fn value(&self) -> Option<Value> {
        None
    }

    /// Sets the value for an app.
    fn set(&mut self, _: Value) -> Result<(), SetError> {
        Err(SetError::WrongType)
    }

    /// The value after a release, if different from [`BehaviourMachine::value`].
    fn pending(&self) -> Option<Value> {
        None
    }

    /// Whether it keeps its foot wherever that slides.
    fn captures(&self) -> bool {
        false
    }

    /// Whether time alone changes nothing while no foot is on it.
    fn is_at_rest(&self) -> bool {
        true
    }
}
