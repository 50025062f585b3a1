//! The messages of one control, as its layout writes them.

use std::fmt;

use serde::{Deserialize, Serialize};
use underfoot_format::Named;

use super::dmx::DmxSettings;
use super::key::KeyStroke;
use super::midi::{
    BendSettings, ControllerSettings, MidiNote, NoteSettings, PressureSettings, ProgramSettings,
};
use super::mqtt::MqttSettings;
use super::target::TargetSort;
use super::trigger::Trigger;

/// Maximum number of messages of one control (our choice).
pub const MAX_MESSAGES: usize = 16;

/// Maximum number of arguments of one message (our choice).
pub const MAX_ARGUMENTS: usize = 16;

/// One message of a control: its time, its target and its content.
#[derive(Clone, Debug, PartialEq)]
pub struct Sending {
    /// When it goes out.
    pub when: When,
    /// The name of its target.
    pub target: String,
    /// Its content.
    pub payload: Payload,
}

/// When a message goes out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum When {
    /// At once, at each such event.
    On(Trigger),
    /// It goes down when a foot presses the control and comes up when the hold ends, under the rules of `HoldToRun`.
    While,
    /// It follows the value of the control.
    Value,
}

/// The content of a message.
#[derive(Clone, Debug, PartialEq)]
pub enum Payload {
    /// A key with its modifiers.
    Key(KeyStroke),
    /// A button of the mouse.
    Button(MouseButton),
    /// Steps of the mouse wheel, positive away from the user: at an event, or over the whole range of a value.
    Wheel(i32),
    /// The pointer, at this speed (pixels per second) at full deflection; north is up.
    Pointer(f32),
    /// An OSC message.
    Osc(String, OscSettings),
    /// A note with this key.
    Note(u8, NoteSettings),
    /// A MIDI controller.
    Controller(ControllerSettings),
    /// A MIDI program with this number, from 0.
    Program(u8, ProgramSettings),
    /// Pitch bend.
    Bend(BendSettings),
    /// Pressure of a MIDI channel or key.
    Pressure(PressureSettings),
    /// The level of a DMX channel.
    Dmx(DmxSettings),
    /// A message to this topic of MQTT.
    Mqtt(String, MqttSettings),
    /// The start of the target's program with these arguments.
    Run(Vec<String>),
}

/// The arguments of an OSC message.
#[derive(Clone, Debug, PartialEq)]
pub struct OscSettings {
    /// The ends that the range of the control's value is scaled to; `None` sends the value as it is.
    pub range: Option<[f32; 2]>,
    /// The arguments; `None` sends the value where the message follows one, 1 and 0 for a hold, nothing at an event.
    pub arguments: Option<Vec<OscArgument>>,
}

/// One argument of an OSC message.
#[derive(Clone, Debug, PartialEq)]
pub enum OscArgument {
    /// A constant integer.
    Int(i32),
    /// A constant number.
    Float(f32),
    /// A constant text.
    Text(String),
    /// The value of the control: one number, or two for a pad.
    Value,
    /// The force of the foot in newtons.
    Force,
    /// The place of the foot eastwards, in floor metres.
    X,
    /// The place of the foot northwards, in floor metres.
    Y,
    /// The number of the foot within its region, from 0; a number that is free goes to the next foot.
    Foot,
}

/// A button of the mouse.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Deserialize, Serialize)]
pub enum MouseButton {
    /// The left one.
    Left,
    /// The wheel as a button.
    Middle,
    /// The right one.
    Right,
}

impl MouseButton {
    /// Its name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, button)| *button == self).map_or("", |(name, _)| name)
    }
}

impl Named for MouseButton {
    const ALL: &'static [(&'static str, Self)] =
        &[("left", Self::Left), ("middle", Self::Middle), ("right", Self::Right)];
}

impl fmt::Display for When {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::On(trigger) => write!(f, "at each event {}", trigger.name()),
            Self::While => f.write_str("while a foot holds it"),
            Self::Value => f.write_str("as its value changes"),
        }
    }
}

impl fmt::Display for Payload {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Key(key) => write!(f, "key {key}"),
            Self::Button(button) => write!(f, "{} button", button.name()),
            Self::Wheel(steps) => write!(f, "wheel {steps:+}"),
            Self::Pointer(speed) => write!(f, "pointer at {speed} pixels/s"),
            Self::Osc(address, OscSettings { range: Some([from, to]), .. }) => {
                write!(f, "{address} {from} to {to}")
            }
            Self::Osc(address, _) => f.write_str(address),
            Self::Note(key, NoteSettings { channel, .. }) => MidiNote { channel: *channel, key: *key }.fmt(f),
            Self::Controller(ControllerSettings { channel, number, .. }) => {
                write!(f, "controller {number} on channel {channel}")
            }
            Self::Program(number, ProgramSettings { channel }) => {
                write!(f, "program {number} on channel {channel}")
            }
            Self::Bend(BendSettings { channel, .. }) => write!(f, "bend on channel {channel}"),
            Self::Pressure(PressureSettings { channel, key: None, .. }) => {
                write!(f, "pressure on channel {channel}")
            }
            Self::Pressure(PressureSettings { channel, key: Some(key), .. }) => {
                write!(f, "pressure of {}", MidiNote { channel: *channel, key: *key })
            }
            Self::Dmx(settings) => settings.fmt(f),
            Self::Mqtt(topic, _) => f.write_str(topic),
            Self::Run(arguments) => write!(f, "start with {arguments:?}"),
        }
    }
}

impl OscSettings {
    /// No range and the usual arguments.
    pub const PLAIN: Self = Self { range: None, arguments: None };
}

impl Payload {
    /// Its name in files.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Key(_) => "Key",
            Self::Button(_) => "Button",
            Self::Wheel(_) => "Wheel",
            Self::Pointer(_) => "Pointer",
            Self::Osc(..) => "Osc",
            Self::Note(..) => "Note",
            Self::Controller(_) => "Cc",
            Self::Program(..) => "Program",
            Self::Bend(_) => "Bend",
            Self::Pressure(_) => "Pressure",
            Self::Dmx(_) => "Dmx",
            Self::Mqtt(..) => "Mqtt",
            Self::Run(_) => "Run",
        }
    }

    /// The sort of target that receives it.
    #[must_use]
    pub const fn sort(&self) -> TargetSort {
        match self {
            Self::Key(_) | Self::Button(_) | Self::Wheel(_) | Self::Pointer(_) => TargetSort::Keyboard,
            Self::Osc(..) => TargetSort::Osc,
            Self::Note(..) | Self::Controller(_) | Self::Program(..) | Self::Bend(_) | Self::Pressure(_) => {
                TargetSort::Midi
            }
            Self::Dmx(_) => TargetSort::Dmx,
            Self::Mqtt(..) => TargetSort::Mqtt,
            Self::Run(_) => TargetSort::Program,
        }
    }

    /// Whether it can go out at that time.
    #[must_use]
    pub const fn suits(&self, when: When) -> bool {
        matches!(
            (self, when),
            (Self::Osc(..) | Self::Controller(_) | Self::Dmx(_) | Self::Mqtt(..), _)
                | (Self::Key(_) | Self::Button(_) | Self::Note(..), When::On(_) | When::While)
                | (Self::Wheel(_), When::On(_) | When::Value)
                | (Self::Program(..) | Self::Run(_), When::On(_))
                | (Self::Pointer(_) | Self::Bend(_) | Self::Pressure(_), When::Value)
        )
    }
}
