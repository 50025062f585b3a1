//! SLIP frames (RFC 1055), as OSC 1.1 uses them on serial lines.

use thiserror::Error;
use underfoot_packet::{END, ESC, ESC_END, ESC_ESC};

use super::DatagramLimits;

/// Maximum number of bytes that pass for the rest of a frame: longer than any single board's.
const SKIPPED: usize = 2048;

/// Reason for which a SLIP frame is rejected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SlipFault {
    /// The frame exceeds [`DatagramLimits::SENSORS`].
    #[error("a SLIP frame does not end within {} bytes", DatagramLimits::SENSORS.bytes)]
    TooLong,
    /// No frame ends within 2048 bytes of the stream.
    #[error("no SLIP frame ends within {SKIPPED} bytes: is its baud rate the one of the board?")]
    NoEnd,
    /// An escape byte precedes a byte that SLIP does not escape.
    #[error("a SLIP frame holds an escape that does not exist")]
    Escape,
}

/// Finds SLIP frames in a stream of bytes.
///
/// States: *skipping* until the next END, at first and after a fault; *within* a frame; *escaped* behind an ESC. The
/// bytes before the first END are the rest of a frame that began before the stream, and count as no frame. Empty
/// frames between two ENDs, which OSC 1.1 sends before each packet, are skipped.
///
/// ```
/// use underfoot::wire::{SlipDecoder, write_slip};
///
/// let mut sent = b"the rest of an earlier frame".to_vec();
/// write_slip(b"/a\0\0,\0\0\0", &mut sent);
/// let mut decoder = SlipDecoder::default();
/// let mut frames = Vec::new();
/// for byte in sent {
///     frames.extend(decoder.push(byte).unwrap().map(<[u8]>::to_vec));
/// }
/// assert_eq!(frames, [b"/a\0\0,\0\0\0"]);
/// ```
#[derive(Clone, Debug, Default)]
pub struct SlipDecoder {
    frame: Vec<u8>,
    /// Number of bytes skipped since the last END.
    skipped: usize,
    state: SlipState,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum SlipState {
    #[default]
    Skipping,
    Begun,
    Within,
    Escaped,
}

impl SlipDecoder {
    /// Takes the next byte; returns the frame that it completes, without its escapes.
    ///
    /// # Errors
    /// [`SlipFault`] once per faulty frame; the bytes up to the next END are skipped.
    pub fn push(&mut self, byte: u8) -> Result<Option<&[u8]>, SlipFault> {
        if byte == END {
            self.skipped = 0;
        }
        if self.state == SlipState::Begun {
            self.frame.clear();
        }
        self.state = match (self.state, byte) {
            (SlipState::Within, END) => {
                self.state = SlipState::Begun;
                return Ok(Some(&self.frame));
            }
            (SlipState::Escaped, END) => {
                self.state = SlipState::Begun;
                return Err(SlipFault::Escape);
            }
            (_, END) => SlipState::Begun,
            (SlipState::Skipping, _) => self.skip()?,
            (SlipState::Begun | SlipState::Within, ESC) => SlipState::Escaped,
            (SlipState::Escaped, ESC_END) => self.add(END)?,
            (SlipState::Escaped, ESC_ESC) => self.add(ESC)?,
            (SlipState::Escaped, _) => {
                self.state = SlipState::Skipping;
                return Err(SlipFault::Escape);
            }
            (SlipState::Begun | SlipState::Within, byte) => self.add(byte)?,
        };
        Ok(None)
    }

    /// Bytes without any END are no frames.
    fn skip(&mut self) -> Result<SlipState, SlipFault> {
        self.skipped += 1;
        if self.skipped < SKIPPED {
            return Ok(SlipState::Skipping);
        }
        self.skipped = 0;
        Err(SlipFault::NoEnd)
    }

    fn add(&mut self, byte: u8) -> Result<SlipState, SlipFault> {
        if self.frame.len() >= DatagramLimits::SENSORS.bytes {
            self.state = SlipState::Skipping;
            return Err(SlipFault::TooLong);
        }
        self.frame.push(byte);
        Ok(SlipState::Within)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use underfoot_packet::write_slip;

    use super::*;

    /// Frames and faults among `bytes`.
    fn decoded(decoder: &mut SlipDecoder, bytes: &[u8]) -> Vec<Result<Vec<u8>, SlipFault>> {
        let mut push = |byte: &u8| decoder.push(*byte).map(|frame| frame.map(<[u8]>::to_vec)).transpose();
        bytes.iter().filter_map(&mut push).collect()
    }

    #[test]
    fn a_faulty_frame_costs_only_itself() {
        let mut good = Vec::new();
        write_slip(b"foot", &mut good);
        for (bad, fault) in [
            ([END, b'a', ESC, b'a', b'b'].to_vec(), SlipFault::Escape),
            ([END, b'a', ESC].to_vec(), SlipFault::Escape),
            ([vec![END], vec![b'a'; DatagramLimits::SENSORS.bytes + 9]].concat(), SlipFault::TooLong),
        ] {
            let mut decoder = SlipDecoder::default();
            let stream = [good.clone(), bad, good.clone()].concat();
            let frame = Ok(b"foot".to_vec());
            assert_eq!(decoded(&mut decoder, &stream), [frame.clone(), Err(fault), frame]);
        }
    }

    proptest! {
        #[test]
        fn frames_arrive_as_they_were_sent_after_any_beginning(
            before in proptest::collection::vec(any::<u8>(), 0..64),
            frames in proptest::collection::vec(proptest::collection::vec(any::<u8>(), 1..64), 1..5),
        ) {
            let mut decoder = SlipDecoder::default();
            decoded(&mut decoder, &before);
            let mut bytes = Vec::new();
            frames.iter().for_each(|frame| write_slip(frame, &mut bytes));
            let mut found = decoded(&mut decoder, &bytes);
            // The END of the first frame may complete what the earlier bytes began.
            found.drain(..found.len().saturating_sub(frames.len()));
            prop_assert_eq!(found, frames.into_iter().map(Ok).collect::<Vec<_>>());
        }
    }
}
