//! One result of a source, as the bytes of a message.

use std::net::SocketAddr;

use arrayvec::ArrayVec;
use rosc::{OscMessage, OscPacket};

use super::{END, GAPS, LAYOUTS, PACKETS, REQUESTS, SILENCE};
use crate::floor::Floor;
use crate::units::Instant;
use crate::wire::{Batch, Decoder, Prefix, Readings, Request, SensorPacket};

/// One result of a source, in the order in which the server took it.
#[derive(Clone, Debug, PartialEq)]
#[expect(
    clippy::large_enum_variant,
    reason = "nearly all are packets, and packets are not allocated one by one"
)]
pub(crate) enum Entry {
    /// A packet arrived.
    Packet(SensorPacket),
    /// No packet arrived while the server waited.
    Silence,
    /// An app sent a request.
    Request(Request),
    /// The floor got another layout, in this text.
    Layout(String),
    /// This many entries were lost.
    Gap(u64),
    /// The source ended.
    End,
}

/// Marks of the form of readings: converter counts with a bit for each that is present, or newtons.
const COUNTS: u8 = 0;
const NEWTONS: u8 = 1;

impl Entry {
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
        match self {
            Self::Packet(packet) => write_packet(packet, bytes),
            Self::Request(request) => write_request(request, bytes),
            Self::Layout(text) => bytes.extend(text.as_bytes()),
            Self::Gap(entries) => bytes.extend(entries.to_le_bytes()),
            Self::Silence | Self::End => {}
        }
    }

    /// Parses an entry with the time `came`; `None` if the topic is unknown or the bytes are incomplete.
    pub(crate) fn read(topic: &str, bytes: &[u8], came: Instant, decoder: &Decoder) -> Option<Self> {
        Some(match topic {
            PACKETS => Self::Packet(read_packet(bytes, came)?),
            SILENCE => Self::Silence,
            REQUESTS => Self::Request(read_request(bytes, decoder)?),
            LAYOUTS => Self::Layout(String::from_utf8(bytes.to_vec()).ok()?),
            GAPS => Self::Gap(u64::from_le_bytes(bytes.try_into().ok()?)),
            END => Self::End,
            _ => return None,
        })
    }
}

fn write_packet(packet: &SensorPacket, bytes: &mut Vec<u8>) {
    bytes.extend(packet.board.to_le_bytes());
    bytes.extend(packet.sequence.to_le_bytes());
    match &packet.readings {
        Readings::Counts(counts) => {
            bytes.push(COUNTS);
            let there = counts.iter().rev().fold(0_u64, |bits, count| bits << 1 | u64::from(count.is_some()));
            bytes.extend(there.to_le_bytes());
            counts.iter().for_each(|count| bytes.extend(count.unwrap_or_default().to_le_bytes()));
        }
        Readings::Newtons(forces) => {
            bytes.push(NEWTONS);
            forces.iter().for_each(|force| bytes.extend(force.to_le_bytes()));
        }
    }
}

fn read_packet(bytes: &[u8], received: Instant) -> Option<SensorPacket> {
    let (board, bytes) = bytes.split_first_chunk()?;
    let (sequence, bytes) = bytes.split_first_chunk()?;
    let (&kind, bytes) = bytes.split_first()?;
    let readings = match kind {
        COUNTS => {
            let (there, bytes) = bytes.split_first_chunk()?;
            let there = u64::from_le_bytes(*there);
            let mut counts = ArrayVec::new();
            for (channel, count) in bytes.chunks(2).enumerate() {
                let count = u16::from_le_bytes(count.try_into().ok()?);
                let is_there = there.checked_shr(u32::try_from(channel).ok()?)? & 1 == 1;
                counts.try_push(is_there.then_some(count)).ok()?;
            }
            Readings::Counts(counts)
        }
        NEWTONS => {
            let mut forces = ArrayVec::new();
            for force in bytes.chunks(4) {
                forces.try_push(f32::from_le_bytes(force.try_into().ok()?)).ok()?;
            }
            Readings::Newtons(forces)
        }
        _ => return None,
    };
    let (board, sequence) = (u16::from_le_bytes(*board), u32::from_le_bytes(*sequence));
    Some(SensorPacket { board, sequence, received, readings })
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

fn read_request(bytes: &[u8], decoder: &Decoder) -> Option<Request> {
    let (sender, datagram) = bytes.split_at(bytes.iter().position(|&byte| byte == 0)?);
    let sender: Option<SocketAddr> = std::str::from_utf8(sender).ok()?.parse().ok();
    let mut batch = Batch::default();
    decoder.decode(datagram.get(1..)?, Instant::START, &mut batch).ok()?;
    Some(Request { message: batch.controls.pop()?, sender })
}

/// The decoder for requests: recordings always use the default prefix, whatever the floor's prefix is.
pub(crate) fn decoder() -> Decoder {
    Decoder::new(&Floor::default())
}
