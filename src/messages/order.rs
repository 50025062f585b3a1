//! Orders to the sender of messages.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::key::KeyStroke;
use super::sending::MouseButton;
use crate::widget::WidgetId;

/// One order: the sender carries it out at once or not at all.
#[derive(Clone, Debug, PartialEq)]
pub struct MessageOrder {
    /// The index of the target in [`super::MessagePlan::targets`].
    pub target: usize,
    /// The control that gave it.
    pub control: WidgetId,
    /// The action.
    pub act: Act,
}

/// The action of an order.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub enum Act {
    /// Goes down, and stays down until the matching [`Act::Up`].
    Down(Holdable),
    /// Comes up.
    Up(Holdable),
    /// Goes down and comes up at once.
    Stroke(Holdable),
    /// Steps of the mouse wheel, positive away from the user.
    Wheel(i32),
    /// Moves the pointer by these pixels, rightwards and downwards.
    Move([i32; 2]),
    /// An OSC message.
    Osc(String, Vec<OscValue>),
}

/// A thing that can be held down.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Deserialize, Serialize)]
pub enum Holdable {
    /// A key with its modifiers.
    Key(KeyStroke),
    /// A button of the mouse.
    Button(MouseButton),
    /// An OSC address: down sends the integer 1, up sends 0.
    Osc(String),
}

/// One argument of an OSC message.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub enum OscValue {
    /// A 32-bit integer.
    Int(i32),
    /// A 32-bit number; finite.
    Float(f32),
    /// A text.
    Text(String),
}

/// Numbers of messages that did not go out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Unsent {
    /// More came than the rate allows.
    pub limited: u64,
    /// A stroke of something that is held down.
    pub held: u64,
}

impl fmt::Display for Holdable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Key(key) => write!(f, "key {key}"),
            Self::Button(button) => write!(f, "{} button", button.name()),
            Self::Osc(address) => f.write_str(address),
        }
    }
}

impl fmt::Display for OscValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Int(number) => write!(f, "{number}"),
            Self::Float(number) => write!(f, "{number:?}"),
            Self::Text(text) => write!(f, "{text:?}"),
        }
    }
}

impl fmt::Display for Act {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Down(what) => write!(f, "{what} down"),
            Self::Up(what) => write!(f, "{what} up"),
            Self::Stroke(what) => write!(f, "{what}"),
            Self::Wheel(steps) => write!(f, "wheel {steps:+}"),
            Self::Move([right, down]) => write!(f, "pointer {right:+} {down:+}"),
            Self::Osc(address, values) => {
                f.write_str(address)?;
                values.iter().try_for_each(|value| write!(f, " {value}"))
            }
        }
    }
}
