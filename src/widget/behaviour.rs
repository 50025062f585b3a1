//! The function of a control: one of ten behaviours with its settings.

use super::scale::ENDS;
use super::{
    ButtonSpec, DialSpec, HoldSpec, LeanSpec, PadSpec, PedalSpec, Scale, SelectorSpec, SliderSpec,
    StepperSpec, SwitchSpec, Thresholds, Value,
};
use underfoot_format::choices;

choices! {
    /// The function of a control, with its settings.
    pub enum Behaviour;
    /// A push button.
    Button(ButtonSpec),
    /// On while it is held.
    Hold(HoldSpec),
    /// A switch.
    Switch(SwitchSpec),
    /// One of several.
    Selector(SelectorSpec),
    /// A slider.
    Slider(SliderSpec),
    /// A pedal: force to value.
    Pedal(PedalSpec),
    /// A pair of numbers.
    Pad(PadSpec),
    /// A rotary dial.
    Dial(DialSpec),
    /// A stepper: up and down by steps.
    Stepper(StepperSpec),
    /// A direction by leaning.
    Lean(LeanSpec),
}

impl Behaviour {
    /// The thresholds of its press.
    #[must_use]
    pub const fn thresholds(&self) -> Thresholds {
        match self {
            Self::Button(spec) => spec.thresholds,
            Self::Hold(spec) => spec.thresholds,
            Self::Switch(spec) => spec.thresholds,
            Self::Selector(spec) => spec.thresholds,
            Self::Slider(spec) => spec.thresholds,
            Self::Pedal(spec) => spec.thresholds,
            Self::Pad(spec) => spec.thresholds,
            Self::Dial(spec) => spec.thresholds,
            Self::Stepper(spec) => spec.thresholds,
            Self::Lean(spec) => spec.thresholds,
        }
    }

    /// Its name in messages, such as `button` or `slider`.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Button(_) => "button",
            Self::Hold(_) => "hold",
            Self::Switch(_) => "switch",
            Self::Selector(_) => "selector",
            Self::Slider(_) => "slider",
            Self::Pedal(_) => "pedal",
            Self::Pad(_) => "pad",
            Self::Dial(_) => "dial",
            Self::Stepper(_) => "stepper",
            Self::Lean(_) => "lean",
        }
    }

    /// Whether `value` is a step or a detent, to be felt.
    #[must_use]
    pub(crate) fn is_stop(&self, value: Value) -> bool {
        match (self, value) {
            (Self::Slider(spec), Value::Number(number)) => spec.scale.is_stop(number),
            (Self::Pedal(spec), Value::Number(number)) => spec.scale.is_stop(number),
            (Self::Dial(spec), Value::Number(number)) => spec.scale.is_stop(number),
            (Self::Stepper(_), Value::Number(_)) => true,
            // With one axis free, the other's stops would be felt all the time.
            (Self::Pad(spec), Value::Pair(pair)) => spec.x().is_stop(pair.x) && spec.y().is_stop(pair.y),
            _ => false,
        }
    }

    /// The values of a control that holds one number and accepts one from an app; `None` for others.
    #[must_use]
    pub const fn scale(&self) -> Option<&Scale> {
        match self {
            Self::Slider(spec) => Some(&spec.scale),
            Self::Dial(spec) => Some(&spec.scale),
            Self::Stepper(spec) => Some(&spec.scale),
            _ => None,
        }
    }

    /// This control with another range, its initial value clamped to it; `None` if the range is not possible.
    ///
    /// Possible for controls that accept one number from an app: a finite range, at most a million, and no narrower
    /// than the step.
    #[must_use]
    pub fn with_range(&self, least: f32, greatest: f32) -> Option<Self> {
        let mut other = self.clone();
        let (scale, initial) = match &mut other {
            Self::Slider(spec) => (&mut spec.scale, &mut spec.initial),
            Self::Dial(spec) => (&mut spec.scale, &mut spec.initial),
            Self::Stepper(spec) => (&mut spec.scale, &mut spec.initial),
            _ => return None,
        };
        let fits = [least, greatest].into_iter().all(|end| ENDS.contains(&end))
            && least < greatest
            && scale.step <= greatest - least;
        (scale.min, scale.max) = (least, greatest);
        *initial = scale.limited(*initial);
        fits.then_some(other)
    }

    /// The value before the first touch; `None` for a button.
    #[must_use]
    pub fn initial(&self) -> Option<Value> {
        super::Control::new(self, glam::Vec2::ONE).value()
    }
}
