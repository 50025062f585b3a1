//! Entries read from the bytes of messages.

use std::net::SocketAddr;

use arrayvec::ArrayVec;

use super::{
    COUNTS, END, GAPS, LAYOUTS, LogEntry, NEWTONS, PACKETS, REQUESTS, SCALED, SILENCE, SPLIT_COUNTS,
    SPLIT_NEWTONS, SPLIT_SCALED,
};
use crate::units::Instant;
use crate::wire::{Batch, Decoder, MAX_CHANNELS, Readings, Request, SensorPacket};

impl LogEntry {
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

fn read_request(bytes: &[u8], decoder: &Decoder) -> Option<Request> {
    let (sender, datagram) = bytes.split_at(bytes.iter().position(|&byte| byte == 0)?);
    let sender: Option<SocketAddr> = std::str::from_utf8(sender).ok()?.parse().ok();
    let mut batch = Batch::default();
    decoder.decode(datagram.get(1..)?, Instant::START, &mut batch).ok()?;
    Some(Request { message: batch.controls.pop()?, sender })
}
