//! The programs and devices that messages go to, by name.

use serde::{Deserialize, Serialize};
use underfoot_format::{Named, Opt, Text, record};

use super::dmx::{ArtNetTarget, SacnTarget};
use super::mqtt::MqttTarget;

/// Maximum number of targets of one layout (our choice: a desk has a handful of programs).
pub const MAX_TARGETS: usize = 16;

/// A receiver of messages, under the name that controls use.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct SendTarget {
    /// Its name, unique in the layout.
    pub name: String,
    /// The receiver.
    pub to: Destination,
}

/// The receiver of messages.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub enum Destination {
    /// Keyboard and pointer of the desktop.
    Keyboard(KeyboardTarget),
    /// A program that receives OSC.
    Osc(OscTarget),
    /// A port of MIDI.
    Midi(MidiTarget),
    /// A universe of DMX behind Art-Net.
    ArtNet(ArtNetTarget),
    /// A universe of DMX behind sACN.
    Sacn(SacnTarget),
    /// A broker of MQTT.
    Mqtt(MqttTarget),
    /// A program that messages start.
    Run(ProgramTarget),
}

/// The sort of a receiver: each takes messages of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TargetSort {
    /// Keyboard and pointer.
    Keyboard,
    /// A program that receives OSC.
    Osc,
    /// A port of MIDI.
    Midi,
    /// A universe of DMX.
    Dmx,
    /// A broker of MQTT.
    Mqtt,
    /// A program that messages start.
    Program,
}

record! {
    /// Which windows may receive keys and clicks.
    pub struct KeyboardTarget = "Keyboard", Eq, Deserialize, Serialize;
    /// Part of the title or class of the window that may receive; any window without it.
    pub window: Option<String> = "window", Opt(Text(200)) => None;
    /// The X display; that of the program without it.
    pub display: Option<String> = "display", Opt(Text(200)) => None;
}

/// A program that receives OSC.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct OscTarget {
    /// Host and port, such as `127.0.0.1:53000`.
    pub address: String,
    /// The protocol below OSC.
    pub over: OscTransport,
}

/// An output port of MIDI, which synthesizers and programs connect to.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct MidiTarget {
    /// The name of the port that this program opens; on Windows, part of the name of a port that is there.
    pub port: String,
    /// Part of the name of a port that it connects to by itself.
    pub into: Option<String>,
}

/// A program that messages start, each time anew.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct ProgramTarget {
    /// Its path, or its name in the folders of `PATH`.
    pub program: String,
    /// Whether the operator allows layouts to start programs; layouts cannot say so themselves.
    pub is_allowed: bool,
}

impl MidiTarget {
    /// Whether `text` can be the name of a port: 1 to 48 bytes that can be seen, without a colon.
    #[must_use]
    pub fn is_port(text: &str) -> bool {
        (1..=48).contains(&text.len())
            && !text.trim().is_empty()
            && !text.contains(|c: char| c == ':' || c.is_control())
    }
}

impl OscTarget {
    /// Whether `text` is a host and a port other than 0, such as `localhost:53000`; the host may be unknown.
    #[must_use]
    pub fn is_address(text: &str) -> bool {
        text.rsplit_once(':')
            .is_some_and(|(host, port)| !host.is_empty() && port.parse::<u16>().is_ok_and(|port| port > 0))
    }
}

/// The protocol below OSC.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
pub enum OscTransport {
    /// A datagram for each message.
    #[default]
    Udp,
    /// One stream; SLIP frames the messages (OSC 1.1).
    Tcp,
}

impl Named for OscTransport {
    const ALL: &'static [(&'static str, Self)] = &[("Udp", Self::Udp), ("Tcp", Self::Tcp)];
}

impl Destination {
    /// Its sort.
    #[must_use]
    pub const fn sort(&self) -> TargetSort {
        match self {
            Self::Keyboard(_) => TargetSort::Keyboard,
            Self::Osc(_) => TargetSort::Osc,
            Self::Midi(_) => TargetSort::Midi,
            Self::ArtNet(_) | Self::Sacn(_) => TargetSort::Dmx,
            Self::Mqtt(_) => TargetSort::Mqtt,
            Self::Run(_) => TargetSort::Program,
        }
    }
}

impl TargetSort {
    /// All sorts.
    pub const ALL: [Self; 6] = [Self::Keyboard, Self::Osc, Self::Midi, Self::Dmx, Self::Mqtt, Self::Program];

    /// Its name in messages for people.
    #[must_use]
    pub const fn noun(self) -> &'static str {
        match self {
            Self::Keyboard => "a keyboard",
            Self::Osc => "a receiver of OSC",
            Self::Midi => "a MIDI port",
            Self::Dmx => "a DMX universe",
            Self::Mqtt => "an MQTT broker",
            Self::Program => "a program to start",
        }
    }

    /// A receiver of this sort as layouts write it.
    #[must_use]
    pub const fn example(self) -> &'static str {
        match self {
            Self::Keyboard => "Keyboard",
            Self::Osc => "Osc(\"127.0.0.1:53000\")",
            Self::Midi => "Midi(\"underfoot\")",
            Self::Dmx => "ArtNet(\"127.0.0.1\")",
            Self::Mqtt => "Mqtt(\"127.0.0.1:1883\")",
            Self::Program => "Run(\"notify-send\")",
        }
    }
}
