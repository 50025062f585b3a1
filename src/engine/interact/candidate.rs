//! A foot on a control that does not hold it yet: whether it may press, or the reason why not.

use std::time::Duration;

use super::Moment;
use super::belief::{certainly_presses, is_believed, is_unlearned};
use super::foot::foot_input;
use crate::engine::feet::{FootHistories, FootHistory, PressMode};
use crate::engine::ignored::Ignored;
use crate::engine::rise::Rises;
use crate::layout::Widget;
use crate::sense::Contact;
use crate::units::Newtons;
use crate::widget::{Guard, Input, OffReason, Thresholds};

/// Time after the landing within which a foot may enter a control without sliding on (our choice: a heel-first
/// landing rolls forward for about a quarter of a second).
const LANDING: Duration = Duration::from_millis(300);

/// A foot on a control that does not hold it yet.
pub(super) struct PressCandidate<'a> {
    contact: &'a Contact,
    spec: &'a Widget,
    at: &'a Moment<'a>,
    foot: Option<&'a FootHistory>,
    weight: Option<Newtons>,
    mode: PressMode,
    /// The thresholds for the person of this foot.
    thresholds: Thresholds,
}

/// The conditions of a press besides the foot and the readings below it.
pub(super) struct Conditions<'a> {
    /// Whether the foot was not on the control in the last frame.
    pub(super) is_new: bool,
    /// Whether the control must be seen unloaded first.
    pub(super) needs_lift: bool,
    /// Whether another control that acts while it is held is held already, and this one is such a control too.
    pub(super) rivals: bool,
    pub(super) rises: &'a Rises,
}

/// A foot that may not press: the reason, and the input that it gives the control.
pub(super) struct PressRefusal {
    pub(super) why: Ignored,
    pub(super) input: Input,
}

impl<'a> PressCandidate<'a> {
    pub(super) fn new(
        contact: &'a Contact,
        spec: &'a Widget,
        feet: &'a FootHistories,
        at: &'a Moment<'a>,
    ) -> Self {
        let weight = feet.weight(contact.id);
        Self {
            contact,
            spec,
            at,
            foot: feet.of(contact.id),
            weight,
            mode: PressMode::of(spec),
            thresholds: spec.behaviour.thresholds().for_weight(weight),
        }
    }

    /// The input of the control from this foot.
    ///
    /// A foot below the press threshold is refused only for a step, or for sliding on.
    pub(super) fn input(&self, conditions: &Conditions<'_>) -> Result<Input, PressRefusal> {
        let force = self.contact.force;
        if let Some(Err(why)) = self.foot.map(|foot| foot.may_operate(self.mode, self.at.now())) {
            return Err(PressRefusal { why, input: Input::Stepping { force } });
        }
        let slid_on = conditions.is_new && self.has_slid_on();
        // A foot with unreliable force at the press stays unreliable when it lightens.
        if slid_on || self.presses() && !self.is_believed() && !self.waits() {
            let why = if slid_on { Ignored::SlidOn } else { Ignored::Unbelieved };
            return Err(PressRefusal { why, input: Input::SlidOn { force } });
        }
        let may = self.may_press(conditions);
        let input = foot_input(self.contact, self.spec, self.at.frame, self.weight, may.is_ok());
        match may {
            Err(why) if self.presses() => Err(PressRefusal { why, input }),
            _ => Ok(input),
        }
    }

    /// Whether the force of this foot may start a press, now or once it is high enough.
    fn may_press(&self, conditions: &Conditions<'_>) -> Result<(), Ignored> {
        let Self { contact, thresholds, at, .. } = self;
        if self.presses() {
            if conditions.needs_lift {
                return Err(Ignored::NotSeenUnloaded);
            }
            if !conditions.rises.has_risen(contact) || !certainly_presses(contact, thresholds, at.frame) {
                return Err(Ignored::Unbelieved);
            }
        }
        let meant = self.foot.is_none_or(|foot| foot.is_meant(self.mode, thresholds.guard, at.now()));
        match (meant, conditions.rivals) {
            _ if !self.is_believed() => Err(Ignored::Unbelieved),
            (true, false) => Ok(()),
            // Readings without a noise estimate are the reason until the estimate comes.
            _ if self.waits() => Err(Ignored::Unbelieved),
            (false, _) => Err(Ignored::Guard),
            (true, true) => Err(Ignored::Off(OffReason::OtherHeld)),
        }
    }

    fn presses(&self) -> bool {
        self.contact.force >= self.thresholds.press
    }

    fn is_believed(&self) -> bool {
        is_believed(self.contact, self.thresholds.guard, self.at.frame)
    }

    /// Whether it is loaded, and landed so long ago that it came from beside the control.
    fn has_slid_on(&self) -> bool {
        self.contact.force >= self.thresholds.release
            && self.foot.is_some_and(|foot| self.at.now().since(foot.landed) > LANDING)
    }

    /// Whether its readings lack a noise estimate, which comes soon: the foot may stay.
    fn waits(&self) -> bool {
        matches!(self.thresholds.guard, Guard::HoldToRun { .. }) && is_unlearned(self.contact, self.at.frame)
    }
}
