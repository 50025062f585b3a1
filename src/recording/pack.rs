//! Writes the records of an MCAP file with chunks compressed by lz4.
//!
//! The crate `mcap` compresses by libraries in C only. Chunks have no message indexes: these take 16 bytes for each
//! message, which do not compress, and readers find a moment by the indexes of the chunks.
//!
//! # Source
//! The MCAP format specification, "File structure", "Records" and "Compression formats".

use std::collections::BTreeMap;
use std::io::{self, Write};

use lz4_flex::frame::{BlockMode, BlockSize, FrameEncoder, FrameInfo};
use mcap::records::{MessageHeader, op};

/// Length of the uncompressed records above which a chunk is written, in bytes.
const CHUNK_LENGTH: usize = 1 << 20;

/// Compression of the chunks, as MCAP names it.
const COMPRESSION: &str = "lz4";

/// An MCAP file that grows by whole records only.
pub(super) struct PackedFile<W> {
    out: W,
    /// Offset of the next record.
    at: u64,
    checksum: crc32fast::Hasher,
    chunk: Chunk,
    summary: Summary,
}

/// The records of the next chunk.
#[derive(Default)]
struct Chunk {
    bytes: Vec<u8>,
    /// First and last log time of its messages, in nanoseconds.
    span: Option<(u64, u64)>,
}

/// Records of the summary, collected while the file grows.
#[derive(Default)]
struct Summary {
    schemas: Vec<u8>,
    channels: Vec<u8>,
    chunks: Vec<u8>,
    attachments: Vec<u8>,
    metadata: Vec<u8>,
    counts: Counts,
}

/// Numbers of the statistics record.
#[derive(Default)]
struct Counts {
    schemas: u16,
    channels: u16,
    attachments: u32,
    metadata: u32,
    chunks: u32,
    span: Option<(u64, u64)>,
    messages: BTreeMap<u16, u64>,
}

impl<W: Write> PackedFile<W> {
    /// Begins a file with its header.
    pub(super) fn begin(out: W, profile: &str, library: &str) -> io::Result<Self> {
        let checksum = crc32fast::Hasher::new();
        let mut file = Self { out, at: 0, checksum, chunk: Chunk::default(), summary: Summary::default() };
        file.put(mcap::MAGIC)?;
        file.put(&record(op::HEADER, &[&text(profile), &text(library)]))?;
        Ok(file)
    }

    /// Writes a metadata record, behind the messages so far.
    pub(super) fn metadata(&mut self, name: &str, entries: &[(&str, &str)]) -> io::Result<()> {
        self.end_chunk()?;
        let bytes = record(op::METADATA, &[&text(name), &map(entries)]);
        let (at, length) = (self.at.to_le_bytes(), (bytes.len() as u64).to_le_bytes());
        self.put(&bytes)?;
        self.summary.metadata.extend(record(op::METADATA_INDEX, &[&at, &length, &text(name)]));
        self.summary.counts.metadata += 1;
        Ok(())
    }

    /// Writes an attachment of plain text without times, behind the messages so far.
    pub(super) fn attach(&mut self, name: &str, data: &[u8]) -> io::Result<()> {
        self.end_chunk()?;
        let (times, names) = ([0; 16], [text(name), text("text/plain")].concat());
        let size = (data.len() as u64).to_le_bytes();
        let checksum = crc32fast::hash(&[&times[..], &names, &size, data].concat()).to_le_bytes();
        let bytes = record(op::ATTACHMENT, &[&times, &names, &size, data, &checksum]);
        let (at, length) = (self.at.to_le_bytes(), (bytes.len() as u64).to_le_bytes());
        self.put(&bytes)?;
        let index = record(op::ATTACHMENT_INDEX, &[&at, &length, &times, &size, &names]);
        self.summary.attachments.extend(index);
        self.summary.counts.attachments += 1;
        Ok(())
    }

    /// Adds a schema and returns its number.
    pub(super) fn schema(&mut self, name: &str, encoding: &str, data: &[u8]) -> u16 {
        self.summary.counts.schemas += 1;
        let number = self.summary.counts.schemas;
        let length = (data.len() as u32).to_le_bytes();
        let head = [&number.to_le_bytes()[..], &text(name), &text(encoding), &length].concat();
        let bytes = record(op::SCHEMA, &[&head, data]);
        self.chunk.bytes.extend(&bytes);
        self.summary.schemas.extend(bytes);
        number
    }

    /// Adds a channel and returns its number; `schema` 0 is none.
    pub(super) fn channel(&mut self, schema: u16, topic: &str, encoding: &str) -> u16 {
        let number = self.summary.counts.channels;
        self.summary.counts.channels += 1;
        let numbers = [number.to_le_bytes(), schema.to_le_bytes()].concat();
        let bytes = record(op::CHANNEL, &[&numbers, &text(topic), &text(encoding), &map(&[])]);
        self.chunk.bytes.extend(&bytes);
        self.summary.channels.extend(bytes);
        number
    }

    /// Adds a message to the chunk; a full chunk is written before.
    pub(super) fn message(&mut self, header: &MessageHeader, data: &[u8]) -> io::Result<()> {
        if self.chunk.bytes.len() > CHUNK_LENGTH {
            self.end_chunk()?;
        }
        let (channel, time) = (header.channel_id, header.log_time);
        self.chunk.span = Some(around(self.chunk.span, time));
        let numbers = [&channel.to_le_bytes()[..], &header.sequence.to_le_bytes()].concat();
        let times = [time.to_le_bytes(), header.publish_time.to_le_bytes()].concat();
        self.chunk.bytes.extend(record(op::MESSAGE, &[&numbers, &times, data]));
        let counts = &mut self.summary.counts;
        counts.span = Some(around(counts.span, time));
        *counts.messages.entry(channel).or_default() += 1;
        Ok(())
    }

    /// Writes the chunk so far and flushes the output.
    pub(super) fn flush(&mut self) -> io::Result<()> {
        self.end_chunk()?;
        self.out.flush()
    }

    /// Writes the rest of the messages, the summary and the end of the file.
    pub(super) fn finish(mut self) -> io::Result<()> {
        self.end_chunk()?;
        let checksum = self.checksum.clone().finalize().to_le_bytes();
        self.put(&record(op::DATA_END, &[&checksum]))?;
        let start = self.at;
        let (mut bytes, mut offsets) = (Vec::new(), Vec::new());
        for (opcode, group) in self.summary.groups() {
            if group.is_empty() {
                continue;
            }
            let place = [start + bytes.len() as u64, group.len() as u64].map(u64::to_le_bytes).concat();
            offsets.extend(record(op::SUMMARY_OFFSET, &[&[opcode], &place]));
            bytes.extend(group);
        }
        let offset_start = start + bytes.len() as u64;
        bytes.extend(offsets);
        // The checksum covers the footer up to itself, with its head.
        let places = [start, offset_start].map(u64::to_le_bytes).concat();
        let footer = record(op::FOOTER, &[&places, &[0; 4]]);
        bytes.extend(footer.get(..footer.len() - 4).unwrap_or_default());
        bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
        bytes.extend(mcap::MAGIC);
        self.put(&bytes)?;
        self.out.flush()
    }

    /// Writes the chunk so far; nothing if it is empty.
    fn end_chunk(&mut self) -> io::Result<()> {
        let chunk = std::mem::take(&mut self.chunk);
        if chunk.bytes.is_empty() {
            return Ok(());
        }
        let packed = compressed(&chunk.bytes)?;
        let (first, last) = chunk.span.unwrap_or_default();
        let times = [first, last].map(u64::to_le_bytes).concat();
        let size = (chunk.bytes.len() as u64).to_le_bytes();
        let checksum = crc32fast::hash(&chunk.bytes).to_le_bytes();
        let packed_size = (packed.len() as u64).to_le_bytes();
        let head = [&times[..], &size, &checksum, &text(COMPRESSION), &packed_size].concat();
        let bytes = record(op::CHUNK, &[&head, &packed]);
        let place = [self.at, bytes.len() as u64].map(u64::to_le_bytes).concat();
        self.put(&bytes)?;
        // The empty map and the length 0 stand for the message indexes.
        let index = [&times[..], &place, &counted(&[]), &[0; 8], &text(COMPRESSION), &packed_size, &size];
        self.summary.chunks.extend(record(op::CHUNK_INDEX, &index));
        self.summary.counts.chunks += 1;
        Ok(())
    }

    fn put(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.out.write_all(bytes)?;
        self.checksum.update(bytes);
        self.at += bytes.len() as u64;
        Ok(())
    }
}

impl Summary {
    /// The groups of the summary's records, in the sequence in which they are written.
    fn groups(&self) -> [(u8, Vec<u8>); 6] {
        [
            (op::SCHEMA, self.schemas.clone()),
            (op::CHANNEL, self.channels.clone()),
            (op::STATISTICS, self.counts.record()),
            (op::CHUNK_INDEX, self.chunks.clone()),
            (op::ATTACHMENT_INDEX, self.attachments.clone()),
            (op::METADATA_INDEX, self.metadata.clone()),
        ]
    }
}

impl Counts {
    fn record(&self) -> Vec<u8> {
        let (first, last) = self.span.unwrap_or_default();
        let messages: Vec<u8> = self
            .messages
            .iter()
            .flat_map(|(channel, count)| [&channel.to_le_bytes()[..], &count.to_le_bytes()].concat())
            .collect();
        let numbers = [u32::from(self.channels), self.attachments, self.metadata, self.chunks];
        record(
            op::STATISTICS,
            &[
                &self.messages.values().sum::<u64>().to_le_bytes(),
                &self.schemas.to_le_bytes(),
                &numbers.map(u32::to_le_bytes).concat(),
                &[first, last].map(u64::to_le_bytes).concat(),
                &counted(&messages),
            ],
        )
    }
}

/// Small blocks, so that a chunk that is cut off loses little; each block refers to those before it.
fn compressed(bytes: &[u8]) -> io::Result<Vec<u8>> {
    let info = FrameInfo::new().block_size(BlockSize::Max64KB).block_mode(BlockMode::Linked);
    let mut encoder = FrameEncoder::with_frame_info(info, Vec::new());
    encoder.write_all(bytes)?;
    encoder.finish().map_err(io::Error::other)
}

/// The span that includes `time` too.
fn around(span: Option<(u64, u64)>, time: u64) -> (u64, u64) {
    span.map_or((time, time), |(first, last)| (first.min(time), last.max(time)))
}

/// A record with these parts as its content.
fn record(opcode: u8, parts: &[&[u8]]) -> Vec<u8> {
    let length = parts.iter().map(|part| part.len() as u64).sum::<u64>();
    let head = [&[opcode][..], &length.to_le_bytes()].concat();
    [&head, &parts.concat()[..]].concat()
}

/// The bytes, with their length before them.
fn counted(bytes: &[u8]) -> Vec<u8> {
    [&(bytes.len() as u32).to_le_bytes()[..], bytes].concat()
}

fn text(text: &str) -> Vec<u8> {
    counted(text.as_bytes())
}

fn map(entries: &[(&str, &str)]) -> Vec<u8> {
    let bytes: Vec<u8> = entries.iter().flat_map(|(key, value)| [text(key), text(value)].concat()).collect();
    counted(&bytes)
}
