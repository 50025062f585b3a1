use arrayvec::ArrayVec;
use glam::Vec2;
use thiserror::Error;

use super::button::Button;
use super::guard::Guarding;
use super::moment::{Acts, Moment};
use super::press::{Outcome, Press};
use super::slider::Slider;
use super::switch::Switch;
use super::{Behaviour, EventKind, Indicator, Input, Value};
use crate::units::Instant;

/// What one step of a control gave, in order; at most eight events.
pub type Emitted = ArrayVec<EventKind, 8>;

/// One control at work: its press, its guard and its behaviour's state.
#[derive(Clone, Debug)]
pub struct Control {
    press: Press,
    guard: Guarding,
    machine: Machine,
    /// Width and depth, in metres.
    size: Vec2,
    /// Time of the last step.
    now: Instant,
    disabled: bool,
    locked: bool,
    indicator: Indicator,
}

#[derive(Clone, Debug)]
enum Machine {
    Button(Button),
    Switch(Switch),
    Slider(Slider),
}

/// Why a control does not take a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum SetError {
    /// The layout has no control of that name.
    #[error("there is no such control")]
    Unknown,
    /// A button holds nothing, a switch no number, a slider no truth.
    #[error("the control does not hold that type of value")]
    WrongType,
    /// The number is NaN or infinite.
    #[error("the value is not a finite number")]
    NotFinite,
    /// A selector has no option of that number.
    #[error("the selector has no such option")]
    NoSuchChoice,
    /// The control acts only while a foot holds it.
    #[error("only a foot can work this control, for as long as it holds it")]
    Momentary,
    /// The control is locked; whoever locked it can unlock it.
    #[error("the control is locked")]
    Locked,
    /// A foot is on the control; the foot has the say until it lets go.
    #[error("a foot is using the control; try again when it has let go")]
    InUse,
}

impl Control {
    /// A control of `size` metres at rest with its initial value; a foot already on it must lift before it works.
    #[must_use]
    pub fn new(behaviour: &Behaviour, size: Vec2) -> Self {
        let machine = match *behaviour {
            Behaviour::Button(_) => Machine::Button(Button),
            Behaviour::Switch(spec) => Machine::Switch(Switch::new(spec)),
            Behaviour::Slider(spec) => Machine::Slider(Slider::new(spec)),
        };
        let thresholds = behaviour.thresholds();
        Self {
            press: Press::new(thresholds),
            guard: Guarding::new(thresholds.guard),
            machine,
            size,
            now: Instant::START,
            disabled: false,
            locked: false,
            indicator: Indicator::Off,
        }
    }

    /// Takes in one frame and gives back what happened; `now` must not run backwards.
    ///
    /// A disabled control senses nothing. A locked one senses, but all that
    /// comes of a press is [`EventKind::Refused`].
    pub fn step(&mut self, now: Instant, input: Input) -> Emitted {
        let last = std::mem::replace(&mut self.now, now);
        if self.disabled {
            return Emitted::new();
        }
        let outcome = self.press.step(now, input);
        if self.locked {
            return refusal(outcome);
        }
        let mut emitted = Emitted::new();
        let outcome = self.guard.doubt(now, input, &mut self.press, outcome, &mut emitted);
        self.react(last, input, outcome, &mut emitted);
        emitted
    }

    /// Ends a press without committing it, disarms the control and forgets gestures that are not complete.
    pub fn cancel(&mut self) -> Emitted {
        let outcome = self.press.cancel();
        let mut emitted = Emitted::new();
        if !self.locked {
            self.react(self.now, Input::Lost, outcome, &mut emitted);
        }
        emitted
    }

    fn react(&mut self, last: Instant, input: Input, outcome: Option<Outcome>, emitted: &mut Emitted) {
        let moment = Moment::new((last, self.now), input, &self.press, outcome, self.size);
        if self.guard.passes(self.now, outcome, moment.broken, emitted) {
            self.machine.acts_mut().act(&moment, emitted);
            self.guard.after(outcome, emitted);
        }
    }

    /// Switches the control off or on; switching off cancels its press.
    pub fn set_disabled(&mut self, disabled: bool) -> Emitted {
        // Also on the way back: a foot that stands on it must lift first.
        let emitted = self.cancel();
        self.disabled = disabled;
        emitted
    }

    /// Whether an app has switched it off.
    #[must_use]
    pub fn is_disabled(&self) -> bool {
        self.disabled
    }

    /// Locks or unlocks the control; locking cancels its press.
    ///
    /// A locked control keeps its value whatever feet and apps do, and says so when it is pressed.
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

    /// Switches its lamp.
    pub fn set_indicator(&mut self, indicator: Indicator) {
        self.indicator = indicator;
    }

    /// What its lamp shows.
    #[must_use]
    pub fn indicator(&self) -> Indicator {
        self.indicator
    }

    /// What it holds; `None` for a button.
    #[must_use]
    pub fn value(&self) -> Option<Value> {
        self.machine.acts().value()
    }

    /// What its value would become if the foot let go now, where that is another one.
    #[must_use]
    pub fn pending(&self) -> Option<Value> {
        if self.is_engaged() { self.machine.acts().pending() } else { None }
    }

    /// Gives it a value, without an event; a number is brought to the control's range and steps.
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
        self.machine.acts_mut().set(value)
    }

    /// Whether a foot has it pressed.
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
        self.machine.acts().captures()
    }

    /// Whether a step with [`Input::Clear`] would change nothing.
    #[must_use]
    pub fn is_at_rest(&self) -> bool {
        self.disabled
            || (self.press.is_at_rest() && self.guard.is_at_rest() && self.machine.acts().is_at_rest())
    }

    /// Whether a foot on it must lift before it works.
    #[must_use]
    pub fn needs_lift(&self) -> bool {
        self.press.needs_lift()
    }

    /// Force of the foot on it as a share of its press threshold; 0 with no foot on it.
    #[must_use]
    pub fn press_share(&self) -> f32 {
        if self.disabled { 0.0 } else { self.press.share() }
    }
}

fn refusal(outcome: Option<Outcome>) -> Emitted {
    let pressed = outcome == Some(Outcome::Pressed);
    pressed.then_some(EventKind::Refused).into_iter().collect()
}

impl Machine {
    fn acts(&self) -> &dyn Acts {
        match self {
            Self::Button(button) => button,
            Self::Switch(switch) => switch,
            Self::Slider(slider) => slider,
        }
    }

    fn acts_mut(&mut self) -> &mut dyn Acts {
        match self {
            Self::Button(button) => button,
            Self::Switch(switch) => switch,
            Self::Slider(slider) => slider,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use proptest::prelude::*;

    use super::*;
    use crate::units::Newtons;
    use crate::widget::{Axis, ButtonSpec, SliderSpec, SwitchSpec, Thresholds};

    const AT: Thresholds =
        Thresholds { dwell: Duration::from_millis(5), ..Thresholds::new(Newtons(60.0), Newtons(40.0)) };

    fn control(behaviour: &Behaviour) -> Control {
        Control::new(behaviour, Vec2::splat(0.3))
    }

    fn button() -> Control {
        control(&Behaviour::Button(ButtonSpec { thresholds: AT }))
    }

    fn switch() -> Control {
        control(&Behaviour::Switch(SwitchSpec { thresholds: AT, initial: false }))
    }

    fn slider(step: f32) -> Control {
        let spec = SliderSpec { thresholds: AT, axis: Axis::East, min: 0.0, max: 10.0, step, initial: 5.0 };
        control(&Behaviour::Slider(spec))
    }

    fn foot(newtons: f32, share: f32) -> Input {
        Input::Foot { force: Newtons(newtons), trusted: true, place: Vec2::new(share, 0.5), weight: None }
    }

    /// Gives each input for so many milliseconds, after the control has been seen unloaded.
    fn play(control: &mut Control, inputs: &[(Input, u64)]) -> Vec<EventKind> {
        let mut now = Instant::START;
        for millis in 0..25 {
            now = Instant::from_millis(millis);
            control.step(now, Input::Clear);
        }
        let mut events = Vec::new();
        for &(input, millis) in inputs {
            for _ in 0..millis {
                now = now + Duration::from_millis(1);
                events.extend(control.step(now, input));
            }
        }
        events
    }

    #[test]
    fn a_button_clicks_on_release_and_never_after_a_cancel() {
        use EventKind::{Cancelled, Clicked, Pressed, Released};
        let pressed = (foot(80.0, 0.5), 50);
        assert_eq!(play(&mut button(), &[pressed, (foot(0.0, 0.5), 10)]), [Pressed, Released, Clicked]);
        assert_eq!(play(&mut button(), &[pressed, (Input::SlidOff, 1)]), [Pressed, Cancelled]);
        assert_eq!(play(&mut button(), &[pressed, (Input::Lost, 200)]), [Pressed, Cancelled]);
    }

    #[test]
    fn a_switch_turns_over_on_release_only() {
        use EventKind::{Cancelled, Changed, Pressed, Released};
        let mut light = switch();
        let pressed = (foot(80.0, 0.5), 50);
        let on = Changed(Value::Switch(true));
        let pause = (Input::Clear, 100);
        let inputs = [pressed, (foot(0.0, 0.5), 10), pause, pressed, (Input::Lost, 1)];
        assert_eq!(play(&mut light, &inputs), [Pressed, Released, on, Pressed, Cancelled]);
        assert_eq!(light.value(), Some(Value::Switch(true)));
    }

    #[test]
    fn a_slider_follows_its_foot_and_a_cancel_puts_it_back() {
        let mut zoom = slider(0.0);
        let events = play(&mut zoom, &[(foot(80.0, 0.5), 20), (foot(80.0, 0.7), 1), (foot(80.0, 1.4), 1)]);
        let changed = |value| EventKind::Changed(Value::Number(value));
        assert_eq!(events[0], EventKind::Pressed);
        assert!(matches!(events[1], EventKind::Changed(Value::Number(value)) if (value - 7.0).abs() < 1e-4));
        assert_eq!(events[2..], [changed(10.0)]);
        let mut now = Instant::from_millis(1000);
        assert_eq!(zoom.step(now, Input::Lost)[..], [changed(5.0), EventKind::Cancelled]);
        now = now + Duration::from_millis(1);
        zoom.step(now, Input::Clear);
        assert_eq!(zoom.value(), Some(Value::Number(5.0)));
    }

    #[test]
    fn a_lifting_foot_does_not_drag_the_slider() {
        let mut zoom = slider(0.0);
        // 45 N is below the middle of press and release: the foot is on its way up and rolls to its toes.
        play(&mut zoom, &[(foot(80.0, 0.7), 20), (foot(45.0, 0.95), 10), (foot(0.0, 1.0), 10)]);
        assert!(matches!(zoom.value(), Some(Value::Number(value)) if (value - 7.0).abs() < 1e-4));
    }

    #[test]
    fn steps_are_kept() {
        let mut level = slider(2.5);
        play(&mut level, &[(foot(80.0, 0.69), 20), (foot(0.0, 0.69), 10)]);
        assert_eq!(level.value(), Some(Value::Number(7.5)));
        assert_eq!(level.set_value(Value::Number(99.0)), Ok(()));
        assert_eq!(level.value(), Some(Value::Number(10.0)));
    }

    #[test]
    fn an_app_sets_what_the_control_holds_and_only_that() {
        assert_eq!(button().set_value(Value::Switch(true)), Err(SetError::WrongType));
        assert_eq!(switch().set_value(Value::Number(1.0)), Err(SetError::WrongType));
        assert_eq!(slider(0.0).set_value(Value::Number(f32::NAN)), Err(SetError::NotFinite));
        let mut zoom = slider(0.0);
        play(&mut zoom, &[(foot(80.0, 0.5), 20)]);
        assert_eq!(zoom.set_value(Value::Number(1.0)), Err(SetError::InUse));
    }

    #[test]
    fn switching_a_control_off_cancels_and_silences_it() {
        let mut home = button();
        play(&mut home, &[(foot(80.0, 0.5), 20)]);
        assert_eq!(home.set_disabled(true)[..], [EventKind::Cancelled]);
        assert!(home.step(Instant::from_millis(500), foot(80.0, 0.5)).is_empty());
        home.set_disabled(false);
        assert!(home.needs_lift());
    }

    fn any_input() -> impl Strategy<Value = Input> {
        prop_oneof![
            6 => (0.0f32..200.0, -0.5f32..1.5, any::<bool>()).prop_map(|(newtons, share, trusted)| {
                Input::Foot { force: Newtons(newtons), trusted, place: Vec2::new(share, 0.5), weight: None }
            }),
            1 => Just(Input::Clear),
            1 => Just(Input::SlidOff),
            1 => Just(Input::Lost),
            1 => (0.0f32..200.0).prop_map(|newtons| Input::SlidOn { force: Newtons(newtons) }),
            1 => (0.0f32..200.0).prop_map(|newtons| Input::Stepping { force: Newtons(newtons) }),
        ]
    }

    proptest! {
        /// Whatever feet do: each press ends exactly once, nothing commits on a cancel, values stay in range.
        #[test]
        fn every_press_ends_once(
            inputs in prop::collection::vec((any_input(), 1u64..40), 1..60),
            which in 0usize..3,
        ) {
            let mut control = [button(), switch(), slider(0.0)][which].clone();
            let mut down = false;
            let events = play(&mut control, &inputs);
            for (index, event) in events.iter().enumerate() {
                match event {
                    EventKind::Pressed => {
                        prop_assert!(!down);
                        down = true;
                    }
                    EventKind::Released | EventKind::Cancelled => {
                        prop_assert!(down);
                        down = false;
                    }
                    EventKind::Clicked | EventKind::Changed(Value::Switch(_)) => {
                        prop_assert_eq!(events[index - 1], EventKind::Released);
                    }
                    EventKind::Changed(Value::Number(value)) => {
                        prop_assert!(down && (0.0..=10.0).contains(value));
                    }
                    other => prop_assert!(false, "{other:?}"),
                }
            }
            prop_assert_eq!(down, control.is_engaged());
        }
    }
}
