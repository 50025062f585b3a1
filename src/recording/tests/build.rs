//! Builds MCAP files byte by byte, as other programs write them.

use std::io::{Cursor, Write};
use std::path::Path;

use mcap::records::op;

use super::super::messages::LogPart;
use super::super::reader::Opening;
use super::super::{EVENTS, FLOOR, LAYOUT, METADATA, RecordingError, TOPICS, VERSION};
use crate::floor::{Floor, Geometry};
use crate::schema::{self, Kinds};
use crate::source::log::LogEntry;
use crate::units::Instant;
use crate::wire::{Readings, SensorPacket};

/// Entries with their times, and their numbers in the file.
pub(super) type Taken = Vec<(Instant, u32, LogEntry)>;

/// The way in which a tool writes a file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tool {
    /// Compression of chunks; without it, messages are in the file itself.
    pub(super) chunks: Option<&'static str>,
    /// Number of messages in one chunk.
    pub(super) chunk_of: usize,
    pub(super) chunk_checksums: bool,
    pub(super) data_checksum: bool,
    pub(super) attachments_last: bool,
    pub(super) indexes: bool,
    pub(super) summary: bool,
    /// Whether each chunk repeats the channels.
    pub(super) repeats_channels: bool,
    /// Whether messages, schemas, attachments and metadata of other programs are in between.
    pub(super) strangers: bool,
    /// Number of our first channel.
    pub(super) first_channel: u16,
}

/// The way of our own recorder.
pub(super) const OURS: Tool = Tool {
    chunks: Some(""),
    chunk_of: 40,
    chunk_checksums: true,
    data_checksum: true,
    attachments_last: false,
    indexes: true,
    summary: true,
    repeats_channels: false,
    strangers: false,
    first_channel: 0,
};

/// A floor of one tile, to keep tests fast.
pub(super) fn floor() -> Floor {
    Floor::of(Geometry::of_paper_tiles(1, 1).unwrap())
}

/// A layout for it.
pub(super) const PAGE: &str = "Layout(version: 1, regions: [(id: \"page\", at: (0, 0), size: (1, 1))], widgets: [\
     (id: \"home\", kind: \"button\", at: (0.1, 0.1), size: (0.8, 0.8))])";

/// Some entries of each kind, several of them at the same time.
pub(super) fn entries(packets: u32) -> Taken {
    let mut entries = Vec::new();
    for number in 0..packets {
        let at = Instant::from_millis(1000 + u64::from(number / 3) * 3);
        let counts = [number, 7 * number, 65_535, 0].map(|count| Some(count as u16)).into_iter().collect();
        let packet =
            SensorPacket { board: 0, sequence: number, received: at, readings: Readings::Counts(counts) };
        entries.push((at, LogEntry::Packet(packet)));
        match number % 50 {
            10 => entries.push((at, LogEntry::Silence)),
            20 => entries.push((at, LogEntry::Layout(PAGE.to_owned()))),
            30 => entries.push((at, LogEntry::Gap(3))),
            _ => {}
        }
    }
    entries.push((Instant::from_millis(1000 + u64::from(packets)), LogEntry::End));
    (0..).zip(entries).map(|(number, (at, entry))| (at, number, entry)).collect()
}

fn text(text: &str) -> Vec<u8> {
    [&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat()
}

fn map(entries: &[(&str, &str)]) -> Vec<u8> {
    let bytes: Vec<u8> = entries.iter().flat_map(|(key, value)| [text(key), text(value)].concat()).collect();
    [&(bytes.len() as u32).to_le_bytes()[..], &bytes].concat()
}

pub(super) fn record(opcode: u8, bytes: &[u8]) -> Vec<u8> {
    [&[opcode][..], &(bytes.len() as u64).to_le_bytes(), bytes].concat()
}

pub(super) fn attachment(name: &str, data: &[u8]) -> Vec<u8> {
    let mut bytes = [0; 16].to_vec();
    bytes.extend([text(name), text("text/plain")].concat());
    bytes.extend((data.len() as u64).to_le_bytes());
    bytes.extend(data);
    bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
    record(op::ATTACHMENT, &bytes)
}

pub(super) fn channel(number: u16, topic: &str) -> Vec<u8> {
    let bytes =
        [&number.to_le_bytes()[..], &0_u16.to_le_bytes(), &text(topic), &text("x"), &map(&[])].concat();
    record(op::CHANNEL, &bytes)
}

pub(super) fn message(channel: u16, sequence: u32, log_ns: u64, publish_ns: u64, data: &[u8]) -> Vec<u8> {
    let head = [&channel.to_le_bytes()[..], &sequence.to_le_bytes()].concat();
    let times = [log_ns.to_le_bytes(), publish_ns.to_le_bytes()].concat();
    record(op::MESSAGE, &[head, times, data.to_vec()].concat())
}

/// A chunk with these records.
pub(super) fn chunk(compression: &str, with_checksum: bool, records: &[u8]) -> Vec<u8> {
    let packed = match compression {
        "zstd" => ruzstd::encoding::compress_to_vec(records, ruzstd::encoding::CompressionLevel::Fastest),
        "lz4" => {
            let mut encoder = lz4_flex::frame::FrameEncoder::new(Vec::new());
            encoder.write_all(records).unwrap();
            encoder.finish().unwrap()
        }
        _ => records.to_vec(),
    };
    let checksum = if with_checksum { crc32fast::hash(records) } else { 0 };
    let mut bytes = [0; 16].to_vec();
    bytes.extend((records.len() as u64).to_le_bytes());
    bytes.extend(checksum.to_le_bytes());
    bytes.extend(text(compression));
    bytes.extend((packed.len() as u64).to_le_bytes());
    record(op::CHUNK, &[bytes, packed].concat())
}

/// The floor, the layout and the metadata.
pub(super) fn opening() -> Vec<u8> {
    let floor = schema::write_floor(&floor());
    let kinds = Kinds::builtin();
    let layout = schema::parse_layout(PAGE, "page", &kinds, &self::floor().geometry).unwrap().layout;
    let metadata = [text(METADATA), map(&[("version", VERSION), ("method", "tracker")])].concat();
    [
        record(op::METADATA, &metadata),
        attachment(FLOOR, floor.as_bytes()),
        attachment(LAYOUT, schema::write_layout(&layout).as_bytes()),
    ]
    .concat()
}

fn strangers(number: u64) -> [Vec<u8>; 3] {
    let schema = [&1_u16.to_le_bytes()[..], &text("Image"), &text("protobuf"), &4_u32.to_le_bytes(), b"abcd"];
    [
        record(op::SCHEMA, &schema.concat()),
        channel(900, "/camera"),
        message(900, 0, number, number, &[7; 300]),
    ]
}

impl Tool {
    /// Writes a file with these entries.
    pub(super) fn write(&self, entries: &Taken) -> Vec<u8> {
        let channels: Vec<u8> =
            (self.first_channel..).zip(TOPICS).flat_map(|(number, topic)| channel(number, topic)).collect();
        let number_of =
            |topic: &str| self.first_channel + TOPICS.iter().position(|own| *own == topic).unwrap() as u16;
        let mut data = record(op::HEADER, &[text("underfoot"), text("a tool")].concat());
        if !self.attachments_last {
            data.extend(opening());
        }
        let (mut messages, mut chunks) = (0_u64, 0_u32);
        let mut first = true;
        for batch in entries.chunks(self.chunk_of) {
            let mut records = if first || self.repeats_channels { channels.clone() } else { Vec::new() };
            first = false;
            for (at, number, entry) in batch {
                let mut bytes = Vec::new();
                entry.write(&mut bytes);
                let [log, publish] = [*at, entry.came(*at)].map(|at| at.micros() * 1000);
                records.extend(message(number_of(entry.topic()), *number, log, publish, &bytes));
                messages += 1;
            }
            let (at, ..) = batch[0];
            records.extend(message(
                number_of(EVENTS),
                0,
                at.micros() * 1000,
                0,
                b"{\"t_s\":1.0,\"event\":\"link\"}",
            ));
            messages += 1;
            if self.strangers {
                records.extend(strangers(at.micros()).concat());
                messages += 1;
            }
            match self.chunks {
                Some(compression) => {
                    data.extend(chunk(compression, self.chunk_checksums, &records));
                    chunks += 1;
                    if self.indexes {
                        data.extend(record(op::MESSAGE_INDEX, &[0; 6]));
                    }
                }
                None => data.extend(records),
            }
            if self.strangers {
                data.extend(attachment("photo.jpg", &[9; 500]));
                data.extend(record(op::METADATA, &[text("weather"), map(&[("sky", "grey")])].concat()));
                data.extend(record(0x91, b"private"));
            }
        }
        if self.attachments_last {
            data.extend(opening());
        }
        let mut file = [mcap::MAGIC, &data].concat();
        let checksum = if self.data_checksum { crc32fast::hash(&file) } else { 0 };
        file.extend(record(op::DATA_END, &checksum.to_le_bytes()));
        if self.summary {
            let mut statistics = messages.to_le_bytes().to_vec();
            statistics.extend([0; 14]);
            statistics.extend(chunks.to_le_bytes());
            statistics.extend([0; 20]);
            file.extend(channels);
            file.extend(record(op::STATISTICS, &statistics));
        }
        file.extend(record(op::FOOTER, &[0; 20]));
        file.extend(mcap::MAGIC);
        file
    }
}

/// The content of a file as read.
#[derive(Debug, PartialEq)]
pub(super) struct Given {
    pub(super) entries: Vec<(Instant, LogEntry)>,
    pub(super) events: usize,
    pub(super) foreign: u64,
    /// Place and reason of a truncation or damage.
    pub(super) broken: Option<String>,
}

/// Reads all of a file except the texts of its floor and its layout, to keep tests fast.
pub(super) fn read(file: Vec<u8>) -> Result<Given, RecordingError> {
    let (_, mut parts) = Opening::read(Box::new(Cursor::new(file)), Path::new("visit.mcap"))?;
    let mut given = Given { entries: Vec::new(), events: 0, foreign: 0, broken: None };
    loop {
        match parts.next_part() {
            LogPart::Entry(at, entry) => given.entries.push((at, entry)),
            LogPart::Event(_) => given.events += 1,
            LogPart::Whole => break,
            LogPart::Broken(why) => {
                given.broken = Some(why);
                break;
            }
        }
    }
    given.foreign = parts.foreign();
    Ok(given)
}

/// Entries without their numbers in the file.
pub(super) fn plain(entries: &Taken) -> Vec<(Instant, LogEntry)> {
    entries.iter().map(|(at, _, entry)| (*at, entry.clone())).collect()
}
