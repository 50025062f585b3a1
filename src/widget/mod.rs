//! The behaviours of controls: pure state machines fed with one foot's force and place.
//!
//! Each step takes the time and one [`Input`] and gives back what happened.
//! Nothing here knows of floors, layouts or feedback.

mod button;
mod control;
mod event;
mod guard;
mod input;
mod moment;
mod press;
mod slider;
mod switch;
mod thresholds;

pub use button::ButtonSpec;
pub use control::{Control, Emitted, SetError};
pub use event::{Direction, EventKind, Value, WidgetEvent, WidgetId};
pub use guard::Guard;
pub use input::{Indicator, Input};
pub use slider::SliderSpec;
pub use switch::SwitchSpec;
pub use thresholds::{Thresholds, WeightShare};

/// Which way a slider's value grows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Axis {
    /// Eastwards (to the right).
    #[default]
    East,
    /// Northwards (away from the user).
    North,
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
