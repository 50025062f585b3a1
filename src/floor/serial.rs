//! Serial ports of boards, and the lines of text that some boards send.

use std::fmt;
use std::str::FromStr;

use thiserror::Error;

use super::{CountSign, Floor};

use underfoot_format::Named;
use underfoot_format::codec::Spelled;

/// The beginning of a name that gives the serial number of a USB device.
const USB: &str = "usb:";

/// Maximum length of a name, in bytes.
const LONGEST: usize = 255;

/// The name of a serial port.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum PortName {
    /// The system's own name: `/dev/ttyACM0`, `COM3`.
    System(String),
    /// The serial number of the USB device behind it, written as `usb:A9003XYZ`: the same port in any socket.
    Usb(String),
}

/// A text is not the name of a serial port.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("write a serial port like /dev/ttyACM0 or COM3, or usb: and the serial number of its USB device")]
pub struct NotAPort;

impl FromStr for PortName {
    type Err = NotAPort;

    fn from_str(text: &str) -> Result<Self, NotAPort> {
        let is_fit = |name: &str| {
            !name.trim().is_empty() && name.len() <= LONGEST && !name.chars().any(char::is_control)
        };
        match text.strip_prefix(USB) {
            Some(number) if is_fit(number) => Ok(Self::Usb(number.to_owned())),
            None if is_fit(text) => Ok(Self::System(text.to_owned())),
            _ => Err(NotAPort),
        }
    }
}

impl fmt::Display for PortName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::System(name) => f.write_str(name),
            Self::Usb(number) => write!(f, "{USB}{number}"),
        }
    }
}

/// A serial port in files.
pub(crate) const PORT: Spelled<PortName> = Spelled {
    about: "a serial port in quotes, \"/dev/ttyACM0\", or \"usb:\" and the serial number of its USB device",
    parse: |text| text.parse().ok(),
    wrong: |_, text| format!("{text:?} is not the name of a serial port"),
    expected: "expected a serial port",
    help: |_| Some("write \"/dev/ttyACM0\", \"COM3\" or \"usb:A9003XYZ\"".to_owned()),
    stand_in: PortName::System(String::new()),
};

/// A serial port with boards behind it.
#[derive(Clone, Debug, PartialEq)]
pub struct SerialWire {
    /// Its name; `None` if it is named when the floor is served.
    pub port: Option<PortName>,
    /// Bits a second; USB devices without a serial line of their own ignore it.
    pub baud: u32,
    /// The lines of text that its board sends; `None` for OSC in SLIP frames, from any boards of the floor.
    pub lines: Option<TextLines>,
}

impl SerialWire {
    /// Bits a second of a port without a written rate.
    pub const BAUD: u32 = 115_200;

    /// The port `name` with OSC in SLIP frames.
    #[must_use]
    pub const fn slip(name: PortName) -> Self {
        Self { port: Some(name), baud: Self::BAUD, lines: None }
    }
}

impl Floor {
    /// Whether a board sends a line of text only when it is asked for one; false for a board that the floor lacks.
    pub(crate) fn asks(&self, board: usize) -> bool {
        let mut lines = self.serial.iter().filter_map(|wire| wire.lines.as_ref());
        lines.any(|lines| usize::from(lines.board) == board && !lines.request.is_empty())
    }
}

/// The lines of text that a board sends: one sample a line, as numbers in columns.
#[derive(Clone, Debug, PartialEq)]
pub struct TextLines {
    /// The board's number: its place in [`super::Floor::boards`].
    pub board: u16,
    /// Bytes that ask for the next line; empty for a board that sends by itself.
    pub request: Vec<u8>,
    /// ASCII characters that separate columns; a space stands for any number of spaces and tabs.
    pub separators: String,
    /// The column of each channel of the board, from 1, in the order of its channels.
    pub columns: Vec<u8>,
    /// Number of columns of a line; lines with another number are rejected.
    pub width: u8,
    /// The unit of the numbers.
    pub numbers: TextNumbers,
}

/// The unit of the numbers in lines of text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TextNumbers {
    /// Counts of a converter.
    Counts {
        /// The count at its full voltage; positive.
        full_scale: f32,
        /// The sign of the counts.
        sign: CountSign,
    },
    /// Newtons.
    Newtons,
}

/// The bytes that end a request for a line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum RequestEnd {
    /// No byte.
    #[default]
    Nothing,
    /// A line feed.
    Lf,
    /// A carriage return.
    Cr,
    /// A carriage return and a line feed.
    CrLf,
}

impl Named for RequestEnd {
    const ALL: &'static [(&'static str, Self)] =
        &[("Nothing", Self::Nothing), ("Lf", Self::Lf), ("Cr", Self::Cr), ("CrLf", Self::CrLf)];
}

impl RequestEnd {
    /// Returns its bytes.
    pub(crate) const fn bytes(self) -> &'static [u8] {
        match self {
            Self::Nothing => b"",
            Self::Lf => b"\n",
            Self::Cr => b"\r",
            Self::CrLf => b"\r\n",
        }
    }

    /// Splits `request` into its visible text and its end.
    pub(crate) fn split(request: &[u8]) -> (&[u8], Self) {
        let ends = [Self::CrLf, Self::Lf, Self::Cr];
        let found = ends.into_iter().find_map(|end| Some((request.strip_suffix(end.bytes())?, end)));
        found.unwrap_or((request, Self::Nothing))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ports_are_named_by_the_system_or_by_the_number_of_their_device() {
        for text in ["/dev/ttyACM0", "COM3", "usb:A9003XYZ"] {
            assert_eq!(text.parse::<PortName>().map(|name| name.to_string()), Ok(text.into()));
        }
        assert_eq!("usb:7".parse(), Ok(PortName::Usb("7".into())));
        for bad in ["", " ", "usb:", "/dev/tty\n", &"a".repeat(256)] {
            assert_eq!(bad.parse::<PortName>(), Err(NotAPort), "{bad:?}");
        }
    }

    #[test]
    fn a_request_is_a_visible_text_and_its_end() {
        for (request, text, end) in [
            (&b"v"[..], &b"v"[..], RequestEnd::Nothing),
            (b"v\n", b"v", RequestEnd::Lf),
            (b"v\r", b"v", RequestEnd::Cr),
            (b"v\r\n", b"v", RequestEnd::CrLf),
        ] {
            assert_eq!(RequestEnd::split(request), (text, end));
        }
    }
}
