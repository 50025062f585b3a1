//! What a behaviour is told of one frame, and what every behaviour can do.

use std::time::Duration;

use glam::Vec2;

use super::press::{Outcome, Press};
use super::{Emitted, Input, SetError, Thresholds, Value};
use crate::units::{Instant, Newtons};

/// What a behaviour is told of one frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment {
    pub(super) now: Instant,
    /// Time since the last frame.
    pub(super) elapsed: Duration,
    /// What became of the press in this frame.
    pub(super) outcome: Option<Outcome>,
    /// The foot that presses, if it can be believed.
    pub(super) foot: Option<FootInput>,
    /// Whether that foot means to stay: a lifting foot rolls, and its place means nothing.
    pub(super) firm: bool,
    /// Whether what waits to be done must be forgotten: sensing was lost, the foot steps, an app stopped the control.
    pub(super) broken: bool,
    /// Width and depth of the control, in metres.
    pub(super) size: Vec2,
    /// The thresholds for this person.
    pub(super) at: Thresholds,
}

/// A foot on a control.
#[derive(Clone, Copy, Debug)]
pub(super) struct FootInput {
    pub(super) force: Newtons,
    /// 0 to 1 across the control, beyond that outside.
    pub(super) place: Vec2,
}

impl Moment {
    /// What `press` makes of `input`, its `outcome` being known, a time `elapsed` after the last frame.
    pub(super) fn new(
        now: Instant,
        elapsed: Duration,
        input: Input,
        press: &Press,
        outcome: Option<Outcome>,
        size: Vec2,
    ) -> Self {
        let foot = match input {
            Input::Foot { force, trusted: true, place, .. } if press.is_engaged() && place.is_finite() => {
                Some(FootInput { force, place })
            }
            _ => None,
        };
        let broken = matches!(input, Input::Lost | Input::Stepping { .. } | Input::SlidOn { .. });
        Self { now, elapsed, outcome, foot, firm: press.is_firm(), broken, size, at: press.thresholds() }
    }

    /// The foot, if it means to stay: only it may change a value by its place.
    pub(super) fn firm_foot(&self) -> Option<FootInput> {
        self.foot.filter(|_| self.firm)
    }

    /// Where that foot is, in metres from the control's middle.
    pub(super) fn offset(&self) -> Option<Vec2> {
        self.firm_foot().map(|foot| (foot.place - 0.5) * self.size)
    }

    pub(super) fn is(&self, outcome: Outcome) -> bool {
        self.outcome == Some(outcome)
    }
}

/// What a behaviour does with the press that it is given.
pub(super) trait Machine: std::fmt::Debug + Send {
    /// Takes in one frame and appends what happened.
    fn act(&mut self, moment: &Moment, emitted: &mut Emitted);

    /// What it holds; `None` if nothing.
    fn value(&self) -> Option<Value> {
        None
    }

    /// Takes a value from an app.
    fn set(&mut self, _: Value) -> Result<(), SetError> {
        Err(SetError::WrongType)
    }

    /// What a release would make of [`Machine::value`], if something else.
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
