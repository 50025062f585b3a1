//! Entries written as the bytes of messages.

use rosc::{OscMessage, OscPacket};

use super::{
    COUNTS, END, GAPS, LAYOUTS, LogEntry, NEWTONS, PACKETS, REQUESTS, SCALED, SILENCE, SPLIT_COUNTS,
    SPLIT_NEWTONS, SPLIT_SCALED,
};
use crate::units::Instant;
use crate::wire::{Prefix, Readings, Request};

impl LogEntry {
    pub(crate) const fn topic(&self) -> &'static str {
        match self {
            Self::Packet(_) => PACKETS,
            Self::Silence => SILENCE,
            Self::Request(_) => REQUESTS,
            Self::Layout(_) => LAYOUTS,
            Self::Gap(_) => GAPS,
            Self::End => END,
        }
    }

    /// Time on the floor's clock: the arrival of a packet, `taken` for all other entries.
    pub(crate) const fn came(&self, taken: Instant) -> Instant {
        match self {
            Self::Packet(packet) => packet.received,
            _ => taken,
        }
    }

    /// Appends its bytes to `bytes`.
    pub(crate) fn write(&self, bytes: &mut Vec<u8>) {
        self.write_with(bytes, plain);
    }

    /// As [`Self::write`], in the form that compresses best.
    pub(crate) fn write_split(&self, bytes: &mut Vec<u8>) {
        self.write_with(bytes, split);
    }

    fn write_with(&self, bytes: &mut Vec<u8>, form: fn(&Readings, &mut Vec<u8>)) {
        match self {
            Self::Packet(packet) => {
                bytes.extend(packet.board.to_le_bytes());
                bytes.extend(packet.sequence.to_le_bytes());
                form(&packet.readings, bytes);
            }
            Self::Request(request) => write_request(request, bytes),
            Self::Layout(text) => bytes.extend(text.as_bytes()),
            Self::Gap(entries) => bytes.extend(entries.to_le_bytes()),
            Self::Silence | Self::End => {}
        }
    }
}

/// Appends the kind and the readings, one after the other.
fn plain(readings: &Readings, bytes: &mut Vec<u8>) {
    match readings {
        Readings::Counts(counts) => {
            bytes.push(COUNTS);
            bytes.extend(present(counts).to_le_bytes());
            counts.iter().for_each(|count| bytes.extend(count.unwrap_or_default().to_le_bytes()));
        }
        Readings::Scaled(values) | Readings::Newtons(values) => {
            bytes.push(if matches!(readings, Readings::Newtons(_)) { NEWTONS } else { SCALED });
            values.iter().for_each(|value| bytes.extend(value.to_le_bytes()));
        }
    }
}

/// Appends the kind and the readings, byte by byte of all.
fn split(readings: &Readings, bytes: &mut Vec<u8>) {
    match readings {
        Readings::Counts(counts) => {
            bytes.push(SPLIT_COUNTS);
            bytes.extend(present(counts).to_le_bytes());
            for shift in [0, 8] {
                bytes.extend(counts.iter().map(|count| (count.unwrap_or_default() >> shift) as u8));
            }
        }
        Readings::Scaled(values) | Readings::Newtons(values) => {
            bytes.push(if matches!(readings, Readings::Newtons(_)) { SPLIT_NEWTONS } else { SPLIT_SCALED });
            for shift in [0, 8, 16, 24] {
                bytes.extend(values.iter().map(|value| (value.to_bits() >> shift) as u8));
            }
        }
    }
}

/// A bit for each count that is present, the lowest for the first channel.
fn present(counts: &[Option<u16>]) -> u64 {
    counts.iter().rev().fold(0, |bits, count| bits << 1 | u64::from(count.is_some()))
}

/// Writes the sender with a zero byte behind it, and the request as an OSC message.
fn write_request(request: &Request, bytes: &mut Vec<u8>) {
    let sender = request.sender.map(|sender| sender.to_string()).unwrap_or_default();
    bytes.extend(sender.as_bytes());
    bytes.push(0);
    let addr = Prefix::default().address(&request.message.path());
    let message = OscPacket::Message(OscMessage { addr, args: request.message.arguments() });
    // Encoding fails only for an oversized bundle.
    bytes.extend(rosc::encoder::encode(&message).unwrap_or_default());
}
