//! The behaviours of controls: pure state machines fed with one foot's force and place.
//!
//! Each step takes the time and one `Input`, and returns the events. Nothing here depends on floors, layouts or
//! feedback. There are three layers, each with its timeline at the top of its file:
//!
//! ```text
//! Input -press-> pressed, released, cancelled -guard-> may it act? -behaviour-> events
//! ```

mod behaviour;
mod button;
mod control;
mod dial;
mod event;
mod guard;
mod guarding;
mod hold;
mod input;
mod lean;
mod moment;
mod number;
mod off_reason;
mod pad;
mod pedal;
mod possible;
mod press;
#[cfg(test)]
mod random;
mod rest;
mod scale;
mod selector;
mod set_error;
mod slider;
mod stage;
mod stepper;
mod switch;
#[cfg(test)]
mod tests;
mod thresholds;
mod track;

pub use behaviour::Behaviour;
pub use button::{ActsOn, ButtonSpec, Gestures, HardStage};
pub use dial::DialSpec;
pub use event::{Detail, Direction, EventKind, Value, WidgetEvent, WidgetId};
pub use guard::{Confirm, Guard, HoldToRun};
pub use hold::HoldSpec;
pub use input::Indicator;
pub use lean::LeanSpec;
pub use off_reason::OffReason;
pub use pad::PadSpec;
pub use pedal::PedalSpec;
pub use scale::Scale;
pub use selector::SelectorSpec;
pub use set_error::SetError;
pub use slider::{Mapping, Rate, Relative, SliderSpec};
pub use stepper::{Repeat, StepperSpec};
pub use switch::SwitchSpec;
pub use thresholds::{Thresholds, WeightShare};
pub use track::SliderTrack;

pub use control::Control;
pub use event::Emitted;
pub use input::Input;
pub(crate) use possible::possible_events;

use underfoot_format::Named;

/// An axis of the floor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Axis {
    /// Eastwards (to the right).
    #[default]
    East,
    /// Northwards (away from the user).
    North,
}

impl Named for Axis {
    const ALL: &'static [(&'static str, Self)] = &[("East", Self::East), ("North", Self::North)];
}
