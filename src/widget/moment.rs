#![allow(dead_code)]

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
    /// The foot that presses firmly and can be believed: only it may change a value.
    pub(super) firm: Option<Foot>,
    /// Whether the press is down.
    pub(super) down: bool,
    /// Whether anything not yet committed is off: sensing was lost, the foot steps, an app stopped the control.
    pub(super) broken: bool,
    /// Width and depth of the control, in metres.
    pub(super) size: Vec2,
    /// The thresholds for this person.
    pub(super) at: Thresholds,
}

/// A foot on a control.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foot {
    pub(super) force: Newtons,
    /// 0 to 1 across the control, beyond that outside.
    pub(super) place: Vec2,
}

impl Moment {
    /// What `press` makes of `input`, its `outcome` being known.
    pub(super) fn new(
        (last, now): (Instant, Instant),
        input: Input,
        press: &Press,
        outcome: Option<Outcome>,
        size: Vec2,
    ) -> Self {
        let firm = match input {
            Input::Foot { force, trusted: true, place, .. } if press.is_firm() && place.is_finite() => {
                Some(Foot { force, place })
            }
            _ => None,
        };
        let broken = matches!(input, Input::Lost | Input::Stepping { .. } | Input::SlidOn { .. });
        let (elapsed, down, at) = (now.since(last), press.is_engaged(), press.thresholds());
        Self { now, elapsed, outcome, firm, down, broken, size, at }
    }

    /// Where the firm foot is, in metres from the control's middle.
    pub(super) fn offset(&self) -> Option<Vec2> {
        self.firm.map(|foot| (foot.place - 0.5) * self.size)
    }

    pub(super) fn is(&self, outcome: Outcome) -> bool {
        self.outcome == Some(outcome)
    }
}

/// What every behaviour does with the press that it is given.
pub(super) trait Acts {
    /// Takes in one frame and appends what happened.
    fn act(&mut self, moment: &Moment, emitted: &mut Emitted);

    /// What it holds; `None` if nothing.
    fn value(&self) -> Option<Value> {
        None
    }

    /// Takes a value from an app.
    fn set(&mut self, value: Value) -> Result<(), SetError> {
        let _ = value;
        Err(SetError::WrongType)
    }

    /// What a release would make of [`Acts::value`], where that is something else.
    fn pending(&self) -> Option<Value> {
        None
    }

    /// Whether it keeps its foot wherever that slides.
    fn captures(&self) -> bool {
        false
    }

    /// Whether time alone changes nothing.
    fn is_at_rest(&self) -> bool {
        true
    }
}
