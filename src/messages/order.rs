//! Orders to the sender of messages.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::dmx::{DmxLevel, DmxSettings};
use super::key::KeyStroke;
use super::midi::{ControllerSettings, MidiMessage, MidiNote};
use super::mqtt::{MqttMessage, MqttSwitch};
use super::sending::MouseButton;
use crate::widget::WidgetId;

/// One order: the sender carries it out at once or not at all.
#[derive(Clone, Debug, PartialEq)]
pub struct MessageOrder {
    /// The index of the target in [`super::MessagePlan::targets`].
    pub target: usize,
    /// The control, or the region of the foot, that gave it.
    pub control: WidgetId,
    /// The action.
    pub act: Act,
}

/// The action of an order.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub enum Act {
    /// Goes down, and stays down until the matching [`Act::Up`]; with a velocity from 1 to 127, which only notes use.
    Down(Holdable, u8),
    /// Comes up.
    Up(Holdable),
    /// Goes down and comes up at once.
    Stroke(Holdable),
    /// Steps of the mouse wheel, positive away from the user.
    Wheel(i32),
    /// Moves the pointer by these pixels, rightwards and downwards.
    Move([i32; 2]),
    /// Moves the pointer to this place of the screen, in shares of its width and height from the upper left corner.
    Place([f32; 2]),
    /// An OSC message.
    Osc(String, Vec<OscValue>),
    /// A MIDI message.
    Midi(MidiMessage),
    /// The level of a DMX channel.
    Dmx(DmxLevel),
    /// An MQTT message.
    Mqtt(MqttMessage),
    /// Starts the target's program with these arguments.
    Run(Vec<String>),
}

/// A state that lasts at its target until another one replaces it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum StandingState {
    /// The level of this DMX channel.
    Level(u16),
    /// The text that this topic retains.
    Topic(String),
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
    /// A note.
    Note(MidiNote),
    /// A MIDI controller, such as a sustain pedal: down sends its upper value, up its lower one.
    Controller(ControllerSettings),
    /// All notes of a MIDI channel, 1 to 16; they are only released.
    Notes(u8),
    /// A DMX channel: down is its upper level, up its lower one.
    Dmx(DmxSettings),
    /// A topic of MQTT that is on or off.
    Mqtt(MqttSwitch),
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
    /// Feet that arrived where the most feet were already.
    pub crowded: u64,
}

impl Act {
    /// The state that it sets; `None` for an act that leaves none, and for those that go down and come up.
    #[must_use]
    pub fn standing(&self) -> Option<StandingState> {
        match self {
            Self::Dmx(level) => Some(StandingState::Level(level.channel)),
            Self::Mqtt(message) if message.retained => Some(StandingState::Topic(message.topic.clone())),
            _ => None,
        }
    }
}

impl std::ops::Add for Unsent {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            limited: self.limited + other.limited,
            held: self.held + other.held,
            crowded: self.crowded + other.crowded,
        }
    }
}

impl fmt::Display for Holdable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Key(key) => write!(f, "key {key}"),
            Self::Button(button) => write!(f, "{} button", button.name()),
            Self::Osc(address) => f.write_str(address),
            Self::Note(note) => note.fmt(f),
            Self::Controller(ControllerSettings { channel, number, .. }) => {
                write!(f, "controller {number} on channel {channel}")
            }
            Self::Notes(channel) => write!(f, "all notes on channel {channel}"),
            Self::Dmx(settings) => settings.fmt(f),
            Self::Mqtt(switch) => f.write_str(&switch.topic),
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
            Self::Down(what @ Holdable::Note(_), velocity) => write!(f, "{what} down, velocity {velocity}"),
            Self::Down(what, _) => write!(f, "{what} down"),
            Self::Up(what) => write!(f, "{what} up"),
            Self::Stroke(what) => write!(f, "{what}"),
            Self::Wheel(steps) => write!(f, "wheel {steps:+}"),
            Self::Move([right, down]) => write!(f, "pointer {right:+} {down:+}"),
            Self::Place([x, y]) => write!(f, "pointer at {x:.3} {y:.3}"),
            Self::Midi(message) => message.fmt(f),
            Self::Dmx(level) => level.fmt(f),
            Self::Mqtt(message) => message.fmt(f),
            Self::Run(arguments) => write!(f, "start with {arguments:?}"),
            Self::Osc(address, values) => {
                f.write_str(address)?;
                values.iter().try_for_each(|value| write!(f, " {value}"))
            }
        }
    }
}
