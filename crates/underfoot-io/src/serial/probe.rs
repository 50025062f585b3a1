//! Listening to a port before any floor file says what its boards send.

use std::io;

use underfoot::floor::{PortName, SerialWire};
use underfoot::wire::SlipDecoder;

use super::SerialError;
use super::device::{self, Device, PortRead};

/// Maximum length of a line of text, in bytes; longer ones are skipped.
const LONGEST_LINE: usize = 1024;

/// Maximum number of bytes read at once.
const BUFFER: usize = 4096;

/// Bits a second that are tried in turn: those of usual firmware.
const BAUDS: [u32; 6] = [SerialWire::BAUD, 500_000, 9600, 57_600, 250_000, 1_000_000];

/// Number of bytes without any frame or line after which the next rate is tried.
const GARBLED: usize = 600;

/// A part of the bytes of a port.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PortPart<'a> {
    /// A SLIP frame.
    Frame(&'a [u8]),
    /// A line of visible ASCII characters, without its end.
    Line(&'a str),
}

/// An open port whose boards and rate are unknown.
pub struct PortProbe {
    name: PortName,
    device: Device,
    parts: PartSplitter,
    /// Position of the present rate in [`BAUDS`].
    baud: usize,
    /// Number of bytes since the last frame or line.
    garbled: usize,
}

impl PortProbe {
    /// Opens `name`.
    ///
    /// # Errors
    /// [`SerialError`] if it cannot be used; its message gives the remedy.
    pub fn open(name: PortName) -> Result<Self, SerialError> {
        let device = device::open(&name, SerialWire::BAUD)?;
        Ok(Self { name, device, parts: PartSplitter::default(), baud: 0, garbled: 0 })
    }

    /// Returns its name.
    #[must_use]
    pub const fn name(&self) -> &PortName {
        &self.name
    }

    /// Returns the bits a second with which it reads.
    #[must_use]
    pub fn baud(&self) -> u32 {
        BAUDS.get(self.baud).copied().unwrap_or(SerialWire::BAUD)
    }

    /// Whether bytes come, and neither frames nor lines.
    #[must_use]
    pub const fn is_garbled(&self) -> bool {
        self.garbled > GARBLED / 2
    }

    /// Reads the bytes that have arrived, and waits 10 ms for the first; calls `see` with each frame and line that they
    /// complete. After many bytes without any, it reads with another number of bits a second.
    ///
    /// # Errors
    /// The error of a port that is gone.
    pub fn read(&mut self, mut see: impl FnMut(PortPart<'_>)) -> io::Result<()> {
        let mut buffer = [0; BUFFER];
        let count = match self.device.read(&mut buffer) {
            PortRead::Bytes(count) => count,
            PortRead::Nothing => 0,
            PortRead::Gone(error) => return Err(error),
        };
        let mut is_read = false;
        let mut noted = |part: PortPart<'_>| {
            is_read = true;
            see(part);
        };
        buffer.iter().take(count).for_each(|byte| self.parts.push(*byte, &mut noted));
        self.garbled = if is_read { 0 } else { self.garbled + count };
        if self.garbled > GARBLED {
            self.garbled = 0;
            self.baud = (self.baud + 1) % BAUDS.len();
            self.parts = PartSplitter::default();
            // A port that does not take a rate goes on with its own.
            self.device.set_baud(self.baud());
        }
        Ok(())
    }
}

/// Splits bytes into frames and lines. Bytes are never both, because frames contain zeros.
#[derive(Default)]
struct PartSplitter {
    frames: SlipDecoder,
    line: Vec<u8>,
    /// Whether a line end came before the present line, and only text since.
    is_line: bool,
}

impl PartSplitter {
    fn push(&mut self, byte: u8, see: &mut impl FnMut(PortPart<'_>)) {
        if let Ok(Some(frame)) = self.frames.push(byte) {
            see(PortPart::Frame(frame));
        }
        match byte {
            b'\n' | b'\r' => {
                if let Some(line) = std::str::from_utf8(&self.line).ok().filter(|line| !line.is_empty())
                    && self.is_line
                {
                    see(PortPart::Line(line));
                }
                self.line.clear();
                self.is_line = true;
            }
            b' '..=b'~' | b'\t' if self.line.len() < LONGEST_LINE => self.line.push(byte),
            _ => self.is_line = false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parts(bytes: &[u8]) -> Vec<String> {
        let (mut splitter, mut found) = (PartSplitter::default(), Vec::new());
        for byte in bytes {
            splitter.push(*byte, &mut |part| {
                found.push(match part {
                    PortPart::Frame(frame) => format!("frame of {}", frame.len()),
                    PortPart::Line(line) => line.to_owned(),
                });
            });
        }
        found
    }

    #[test]
    fn frames_and_whole_lines_are_told_apart_and_noise_is_neither() {
        assert_eq!(
            parts(b"17 18\r\n1 2 3\r\n4 5 6\n7"),
            ["1 2 3", "4 5 6"],
            "the first line may be half of one"
        );
        let osc = b"\xC0/b\0\0,ii\0\0\0\0\x0A\0\0\0\x0D\xC0";
        assert_eq!(parts(&[&osc[..], &osc[..]].concat()), ["frame of 16", "frame of 16"]);
        assert!(parts(&[0xF8, 0x00, 0x80, b'\n', 0xFF, b'1', b'\n']).is_empty());
        assert!(parts(&[b"\n".as_slice(), &[b'1'; 5000], b"\n"].concat()).is_empty());
    }
}
