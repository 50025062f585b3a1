//! One result of a source, as the bytes of a message.

use std::net::SocketAddr;

use arrayvec::ArrayVec;
use rosc::{OscMessage, OscPacket};

use super::{END, GAPS, LAYOUTS, PACKETS, REQUESTS, SILENCE};
use crate::floor::Floor;
use crate::units::Instant;
use crate::wire::{Batch, Decoder, MAX_CHANNELS, Prefix, Readings, Request, SensorPacket};

/// One result of a source, in the order in which the server took it.
#[derive(Clone, Debug, PartialEq)]
#[expect(
    clippy::large_enum_variant,
    reason = "nearly all are packets, and packets are not allocated one by one"
)]
pub(crate) enum LogEntry {
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

/// The same with the bytes of the readings split: the lowest bytes of all, then the next, up to the highest. The
/// high bytes are nearly the same in each packet of a board, so that they compress.
const SPLIT_COUNTS: u8 = 2;
const SPLIT_NEWTONS: u8 = 3;

/// Counts with fractions, in both forms.
const SCALED: u8 = 4;
const SPLIT_SCALED: u8 = 5;

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
    pub(super) fn write_split(&self, bytes: &mut Vec<u8>) {
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

/// The readings of `N` bytes each in the order of their channels; `is_split` tells their form.
fn values<const N: usize>(bytes: &[u8], is_split: bool) -> Option<ArrayVec<[u8; N], MAX_CHANNELS>> {
    if !bytes.len().is_multiple_of(N) {
        return None;
    }
    let channels = bytes.len() / N;
    let (channel_step, byte_step) = if is_split { (1, channels) } else { (N, 1) };
    let mut values = ArrayVec::new();
    for channel in 0..channels {
        let mut value = [0; N];
        for (number, byte) in value.iter_mut().enumerate() {
            *byte = *bytes.get(channel * channel_step + number * byte_step)?;
        }
        values.try_push(value).ok()?;
    }
    Some(values)
}

fn read_packet(bytes: &[u8], received: Instant) -> Option<SensorPacket> {
    let (board, bytes) = bytes.split_first_chunk()?;
    let (sequence, bytes) = bytes.split_first_chunk()?;
    let (&kind, bytes) = bytes.split_first()?;
    let readings = match kind {
        COUNTS | SPLIT_COUNTS => {
            let (there, bytes) = bytes.split_first_chunk()?;
            let there = u64::from_le_bytes(*there);
            let counts = values(bytes, kind == SPLIT_COUNTS)?;
            let count = |(channel, count)| (there >> channel & 1 == 1).then_some(u16::from_le_bytes(count));
            Readings::Counts((0_u32..).zip(counts).map(count).collect())
        }
        NEWTONS | SPLIT_NEWTONS => {
            let forces = values(bytes, kind == SPLIT_NEWTONS)?;
            Readings::Newtons(forces.into_iter().map(f32::from_le_bytes).collect())
        }
        SCALED | SPLIT_SCALED => {
            let scaled = values(bytes, kind == SPLIT_SCALED)?;
            Readings::Scaled(scaled.into_iter().map(f32::from_le_bytes).collect())
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
