//! The programs and devices that messages go to, by name.

use serde::{Deserialize, Serialize};
use underfoot_format::{Named, Opt, Text, record};

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
    /// The sort of the receiver in messages for people.
    #[must_use]
    pub const fn noun(&self) -> &'static str {
        match self {
            Self::Keyboard(_) => "a keyboard",
            Self::Osc(_) => "a receiver of OSC",
        }
    }
}
