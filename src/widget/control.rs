//! One control: press, guard and behaviour.

use std::time::Duration;

use glam::Vec2;

use super::button::Button;
use super::dial::Dial;
use super::guarding::Guarding;
use super::hold::Hold;
use super::lean::Lean;
use super::moment::{BehaviourInput, BehaviourMachine};
use super::pad::Pad;
use super::pedal::Pedal;
use super::press::{PressOutcome, PressState};
use super::selector::Selector;
use super::slider::Slider;
use super::stepper::Stepper;
use super::switch::Switch;
use super::{Behaviour, Emitted, EventKind, Indicator, Input, OffReason, SetError, Value};
use crate::units::Instant;

/// One control: its press, its guard and the state of its behaviour.
#[derive(Debug)]
pub struct Control {
    press: PressState,
    guard: Guarding,
    machine: Box<dyn BehaviourMachine>,
    /// Width and depth, in metres.
    size: Vec2,
    /// Time of the last step.
    now: Instant,
    disabled: bool,
    inhibited: Option<OffReason>,
    locked: bool,
    indicator: Indicator,
}

impl Control {
    /// A control of `size` metres at rest with its initial value; a foot already on it must lift before it works.
    #[must_use]
    pub fn new(behaviour: &Behaviour, size: Vec2) -> Self {
        let thresholds = behaviour.thresholds();
        Self {
            press: PressState::new(thresholds),
            guard: Guarding::new(thresholds.guard),
            machine: machine(behaviour),
            size,
            now: Instant::START,
            disabled: false,
            inhibited: None,
            locked: false,
            indicator: Indicator::Off,
        }
    }

    /// Processes one frame and returns the events; `now` must not decrease.
    ///
    /// A disabled or inhibited control ignores its input. A locked one responds to a press only with
    /// [`EventKind::Refused`].
    pub fn step(&mut self, now: Instant, input: Input) -> Emitted {
        let last = std::mem::replace(&mut self.now, now);
        if self.disabled || self.inhibited.is_some() {
            return Emitted::new();
        }
        let outcome = self.press.step(now, input);
        if self.locked {
            return refusal(outcome);
        }
        let mut emitted = Emitted::new();
        let outcome = self.guard.end_untrusted(now, input, &mut self.press, outcome, &mut emitted);
        self.react(now.since(last), input, outcome, &mut emitted);
        emitted
    }

    /// Ends a press without committing it, disarms the control and drops incomplete gestures.
    pub fn cancel(&mut self) -> Emitted {
        let outcome = self.press.cancel();
        let mut emitted = Emitted::new();
        if !self.locked {
            self.react(Duration::ZERO, Input::Lost, outcome, &mut emitted);
        }
        emitted
    }

    fn react(
        &mut self,
        elapsed: Duration,
        input: Input,
        outcome: Option<PressOutcome>,
        emitted: &mut Emitted,
    ) {
        let moment = BehaviourInput::new(self.now, elapsed, input, &self.press, outcome, self.size);
        if self.guard.passes(self.now, outcome, moment.broken, emitted) {
            self.machine.act(&moment, emitted);
            self.guard.after(self.press.is_engaged(), !self.machine.is_at_rest(), emitted);
        }
    }

    /// Disables or enables the control; disabling cancels its press.
    pub fn set_disabled(&mut self, disabled: bool) -> Emitted {
        // Enabling cancels too: a foot that stands on it must lift first.
        let emitted = self.cancel();
        self.disabled = disabled;
        emitted
    }

    /// Whether an app has switched it off.
    #[must_use]
    pub fn is_disabled(&self) -> bool {
        self.disabled
    }

    /// Inhibits the control for a reason of its floor, independent of apps; `None` ends that. Both cancel its press.
    pub fn set_inhibited(&mut self, inhibited: Option<OffReason>) -> Emitted {
        let emitted = self.cancel();
        self.inhibited = inhibited;
        emitted
    }

    /// The reason for which its floor inhibits it; `None` if it does not.
    #[must_use]
    pub fn inhibited(&self) -> Option<OffReason> {
        self.inhibited
    }

    /// Locks or unlocks the control; locking cancels its press.
    ///
    /// Neither feet nor apps change the value of a locked control; a press on it emits a refusal.
    pub fn set_locked(&mut self, locked: bool) -> Emitted {
        let emitted = self.cancel();
        self.locked = locked;
        emitted
    }

    /// Whether an app has locked it.
    #[must_use]
    pub fn is_locked(&self) -> bool {
        self.locked
    }

    /// Sets its lamp.
    pub fn set_indicator(&mut self, indicator: Indicator) {
        self.indicator = indicator;
    }

    /// The state of its lamp.
    #[must_use]
    pub fn indicator(&self) -> Indicator {
        self.indicator
    }

    /// Its value; `None` for a button.
    #[must_use]
    pub fn value(&self) -> Option<Value> {
        self.machine.value()
    }

    /// The value that it would take if the foot let go now, if different.
    #[must_use]
    pub fn pending(&self) -> Option<Value> {
        if self.is_engaged() { self.machine.pending() } else { None }
    }

    /// Sets its value, without an event; a number is brought to the control's range and steps.
    ///
    /// # Errors
    /// [`SetError`]; the value stays as it was.
    pub fn set_value(&mut self, value: Value) -> Result<(), SetError> {
        if self.is_engaged() {
            return Err(SetError::InUse);
        }
        if self.locked {
            return Err(SetError::Locked);
        }
        self.machine.set(value)
    }

    /// Changes the behaviour to one of the same kind with another range; brings its number into it.
    ///
    /// # Errors
    /// [`SetError::InUse`] and [`SetError::Locked`]; it stays as it was.
    pub(crate) fn set_behaviour(&mut self, behaviour: &Behaviour) -> Result<(), SetError> {
        if self.is_engaged() {
            return Err(SetError::InUse);
        }
        if self.locked {
            return Err(SetError::Locked);
        }
        let value = self.value();
        self.machine = machine(behaviour);
        value.map_or(Ok(()), |value| self.machine.set(value))
    }

    /// Whether a foot presses it.
    #[must_use]
    pub fn is_engaged(&self) -> bool {
        !self.locked && self.press.is_engaged()
    }

    /// Whether a first press has armed it, so that the next one acts.
    #[must_use]
    pub fn is_armed(&self) -> bool {
        self.guard.is_armed()
    }

    /// Whether it will soon stop by itself although a foot holds it.
    #[must_use]
    pub fn has_warned(&self) -> bool {
        self.guard.has_warned()
    }

    /// Whether it keeps its foot wherever that slides.
    #[must_use]
    pub fn captures(&self) -> bool {
        self.machine.captures() && !self.guard.is_arming()
    }

    /// Whether a step with [`Input::Clear`] would change nothing.
    #[must_use]
    pub fn is_at_rest(&self) -> bool {
        self.disabled
            || self.inhibited.is_some()
            || (self.press.is_at_rest() && self.guard.is_at_rest() && self.machine.is_at_rest())
    }

    /// Whether a foot on it must lift before it works.
    #[must_use]
    pub fn needs_lift(&self) -> bool {
        self.press.needs_lift()
    }

    /// Force of the foot on it as a share of its press threshold; 0 with no foot on it.
    #[must_use]
    pub fn press_share(&self) -> f32 {
        if self.disabled || self.inhibited.is_some() { 0.0 } else { self.press.share() }
    }
}

fn refusal(outcome: Option<PressOutcome>) -> Emitted {
    let pressed = outcome == Some(PressOutcome::Pressed);
    pressed.then_some(EventKind::Refused).into_iter().collect()
}

/// The initial state of a control with this behaviour.
fn machine(behaviour: &Behaviour) -> Box<dyn BehaviourMachine> {
    match behaviour {
        Behaviour::Button(spec) => Box::new(Button::new(*spec)),
        Behaviour::Hold(_) => Box::new(Hold::default()),
        Behaviour::Switch(spec) => Box::new(Switch::new(*spec)),
        Behaviour::Selector(spec) => Box::new(Selector::new(spec)),
        Behaviour::Slider(spec) => Box::new(Slider::new(*spec)),
        Behaviour::Pedal(spec) => Box::new(Pedal::new(*spec)),
        Behaviour::Pad(spec) => Box::new(Pad::new(*spec)),
        Behaviour::Dial(spec) => Box::new(Dial::new(*spec)),
        Behaviour::Stepper(spec) => Box::new(Stepper::new(*spec)),
        Behaviour::Lean(spec) => Box::new(Lean::new(*spec)),
    }
}
