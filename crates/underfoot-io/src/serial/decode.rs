//! Bytes of one port to packets, and to reasons for refusing them.

use underfoot::floor::{Floor, SerialWire};
use underfoot::units::Instant;
use underfoot::wire::{
    Batch, Decoder, LineDecoder, LineFault, LinkCounters, SensorPacket, SlipDecoder, WireError,
};

use super::sequence::LineSequence;

/// The content of some bytes.
#[derive(Debug, Default)]
pub(super) struct PortContent {
    pub(super) packets: Vec<SensorPacket>,
    pub(super) counters: LinkCounters,
    /// The last fault, in one clause.
    pub(super) fault: Option<String>,
}

impl PortContent {
    fn refuse(&mut self, fault: String) {
        self.fault = Some(fault);
    }
}

/// Decodes the bytes of one port.
#[derive(Debug)]
pub(super) enum PortDecoder {
    /// OSC in SLIP frames.
    Slip(Box<SlipPort>),
    /// Lines of text.
    Lines(Box<LinePort>),
}

impl PortDecoder {
    pub(super) fn new(wire: &SerialWire, floor: &Floor) -> Self {
        match &wire.lines {
            Some(lines) => Self::Lines(Box::new(LinePort {
                decoder: LineDecoder::new(lines.clone()),
                sequence: LineSequence::default(),
            })),
            None => Self::Slip(Box::new(SlipPort {
                frames: SlipDecoder::default(),
                decoder: Decoder::new(floor),
                batch: Batch::default(),
            })),
        }
    }

    /// Starts anew: the port has been opened.
    pub(super) fn restart(&mut self) {
        match self {
            Self::Slip(port) => port.frames = SlipDecoder::default(),
            Self::Lines(port) => {
                port.decoder.reset();
                port.sequence.restart();
            }
        }
    }

    /// The bytes that ask for a line; empty for a board that sends by itself.
    pub(super) fn request(&self) -> &[u8] {
        match self {
            Self::Slip(_) => &[],
            Self::Lines(port) => &port.decoder.format().request,
        }
    }

    /// Adds the content of `bytes`, which were read at `now`; returns the number of lines or frames that end in them.
    pub(super) fn take(&mut self, bytes: &[u8], now: Instant, content: &mut PortContent) -> u64 {
        let before = content.counters.datagrams;
        for byte in bytes {
            match self {
                Self::Slip(port) => port.take(*byte, now, content),
                Self::Lines(port) => port.take(*byte, now, content),
            }
        }
        if let Some(fault) = &mut content.fault
            && let Some(guess) = self.guess(bytes)
        {
            fault.push_str(guess);
        }
        content.counters.datagrams - before
    }

    /// The likely format of `bytes` if it is the other one.
    fn guess(&self, bytes: &[u8]) -> Option<&'static str> {
        let has = |part: &[u8]| bytes.windows(part.len()).any(|window| window == part);
        let is_text = |byte: &u8| byte.is_ascii_graphic() || byte.is_ascii_whitespace();
        match self {
            Self::Slip(_) if bytes.iter().all(is_text) => {
                Some("; it looks like lines of text, which `lines` in the floor file describes")
            }
            Self::Lines(_) if has(b"\xC0/") || has(b"\xC0#") => {
                Some("; it looks like OSC in SLIP frames, which need no `lines` in the floor file")
            }
            _ => None,
        }
    }
}

/// A port of OSC in SLIP frames.
#[derive(Debug)]
pub(super) struct SlipPort {
    frames: SlipDecoder,
    decoder: Decoder,
    batch: Batch,
}

impl SlipPort {
    fn take(&mut self, byte: u8, now: Instant, content: &mut PortContent) {
        let Self { frames, decoder, batch } = self;
        let counters = &mut content.counters;
        let frame = match frames.push(byte) {
            Ok(None) => return,
            Ok(Some(frame)) => frame,
            Err(fault) => {
                counters.datagrams += 1;
                counters.malformed += 1;
                return content.refuse(fault.to_string());
            }
        };
        counters.datagrams += 1;
        if let Err(error) = decoder.decode(frame, now, batch) {
            error.count(counters);
            return content.refuse(error.to_string());
        }
        content.packets.append(&mut batch.packets);
        if !batch.controls.is_empty() {
            content.counters.foreign += batch.controls.len() as u64;
            content.refuse("requests are taken from the network only".to_owned());
        }
        for error in batch.refused.drain(..) {
            // Other messages of the bundle are used.
            if let WireError::UnknownAddress { .. } = error {
                content.counters.skipped += 1;
            } else {
                error.count(&mut content.counters);
                content.refuse(error.to_string());
            }
        }
    }
}

/// A port of lines of text.
#[derive(Debug)]
pub(super) struct LinePort {
    decoder: LineDecoder,
    sequence: LineSequence,
}

impl LinePort {
    fn take(&mut self, byte: u8, now: Instant, content: &mut PortContent) {
        let Some(line) = self.decoder.push(byte) else { return };
        content.counters.datagrams += 1;
        let sequence = self.sequence.number(now);
        match line {
            Ok(readings) => {
                let board = self.decoder.format().board;
                content.packets.push(SensorPacket { board, sequence, received: now, readings });
            }
            Err(LineFault::Unconfirmed) => content.counters.malformed += 1,
            Err(fault) => {
                match fault {
                    LineFault::Columns { .. } => content.counters.wrong_shape += 1,
                    _ => content.counters.malformed += 1,
                }
                content.refuse(fault.to_string());
            }
        }
    }
}
