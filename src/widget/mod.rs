//! The behaviours of controls: pure state machines fed with one foot's force and place.
//!
//! Each step takes the time and one [`Input`] and gives back what happened.
//! Nothing here knows of floors, layouts or feedback.

mod button;
mod control;
mod event;
mod press;
mod slider;
mod switch;

pub use control::{Control, Emitted, Input, SetError};
pub use event::{EventKind, Value, WidgetEvent, WidgetId};

use std::time::Duration;

use crate::units::Newtons;

/// When a foot's force counts as a press.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thresholds {
    /// Force from which on the control engages.
    pub press: Newtons,
    /// Force below which it lets go; less than `press`.
    pub release: Newtons,
    /// How long the force must hold before the press counts.
    pub dwell: Duration,
    /// How long after a release no new press counts.
    pub lockout: Duration,
}

/// A push button: `Pressed`, then `Released` and `Clicked`, or `Cancelled`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ButtonSpec {
    /// When it engages.
    pub thresholds: Thresholds,
}

/// A switch: each completed press turns it over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SwitchSpec {
    /// When it engages.
    pub thresholds: Thresholds,
    /// Whether it is on to begin with.
    pub initial: bool,
}

/// Which way a slider's value grows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Axis {
    /// Eastwards (to the right).
    #[default]
    East,
    /// Northwards (away from the user).
    North,
}

/// A slider: the foot's place along its axis is its value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderSpec {
    /// When it engages.
    pub thresholds: Thresholds,
    /// Which way the value grows.
    pub axis: Axis,
    /// Value at the low end.
    pub min: f32,
    /// Value at the high end; greater than `min`.
    pub max: f32,
    /// Distance between the values it may take; 0 for any value.
    pub step: f32,
    /// Value to begin with, within the range.
    pub initial: f32,
}

/// What a control does, with its settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Behaviour {
    /// A push button.
    Button(ButtonSpec),
    /// A switch.
    Switch(SwitchSpec),
    /// A slider.
    Slider(SliderSpec),
}

impl Behaviour {
    /// When it engages.
    #[must_use]
    pub const fn thresholds(&self) -> Thresholds {
        match self {
            Self::Button(spec) => spec.thresholds,
            Self::Switch(spec) => spec.thresholds,
            Self::Slider(spec) => spec.thresholds,
        }
    }

    /// The word for it in messages: `button`, `switch` or `slider`.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Button(_) => "button",
            Self::Switch(_) => "switch",
            Self::Slider(_) => "slider",
        }
    }
}
