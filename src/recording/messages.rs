//! The messages of a recording, in the order of the file.

use std::collections::HashMap;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use mcap::records::op;

use super::chunk::Chunk;
use super::parts::{Attachment, McapMessage, channel, metadata, statistics};
use super::records::{RawRecord, ReadState, Records};
use super::{EVENTS, FLOOR, LAYOUT, METADATA, TOPICS};
use crate::source::log::{self, LogEntry};
use crate::units::Instant;
use crate::wire::{Decoder, Readings};

/// The parts of a file in sequence.
#[expect(
    clippy::large_enum_variant,
    reason = "nearly all are packets, and packets are not allocated one by one"
)]
pub(super) enum LogPart {
    /// An entry, with the time at which the server took it.
    Entry(Instant, LogEntry),
    /// A line of an event.
    Event(Vec<u8>),
    /// The end of the recording.
    Whole,
    /// The file is truncated, or damaged from here on: place and reason.
    Broken(String),
}

/// An entry with its number among those of the same time.
pub(super) enum Numbered {
    Entry(Instant, u32, LogEntry),
    Part(LogPart),
}

/// Reader of the messages of a file.
pub(super) struct MessageReader {
    records: Records,
    path: PathBuf,
    /// Checksums of the attachments and the metadata read on opening the file, by their names.
    opened: HashMap<&'static str, u32>,
    chunk: Option<(u64, Chunk)>,
    /// Topics of channels by their numbers; `None` for topics of other programs.
    topics: HashMap<u16, Option<&'static str>>,
    decoder: Decoder,
    counts: Counts,
    /// Whether the data section, which contains all messages, is over.
    is_past_data: bool,
    end: Option<End>,
}

/// Numbers of records so far.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    messages: u64,
    chunks: u32,
    /// Messages on topics of other programs.
    foreign: u64,
}

/// The end of a file, which every further call reports again.
#[derive(Clone, Debug)]
enum End {
    Whole,
    Broken(String),
}

impl MessageReader {
    pub(super) fn new(records: Records, path: &Path, opened: HashMap<&'static str, u32>) -> Self {
        Self {
            records,
            path: path.into(),
            opened,
            chunk: None,
            topics: HashMap::new(),
            decoder: log::decoder(),
            counts: Counts::default(),
            is_past_data: false,
            end: None,
        }
    }

    /// Name of the file.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    pub(super) fn into_records(self) -> Records {
        self.records
    }

    /// Whether the first packet holds newtons; false if there is no packet.
    pub(super) fn begin_with_newtons(&mut self) -> bool {
        loop {
            match self.next() {
                Numbered::Entry(_, _, LogEntry::Packet(packet)) => {
                    return matches!(packet.readings, Readings::Newtons(_));
                }
                Numbered::Part(LogPart::Whole | LogPart::Broken(_)) => return false,
                Numbered::Entry(..) | Numbered::Part(_) => {}
            }
        }
    }

    /// Number of messages so far on topics of other programs.
    pub(super) const fn foreign(&self) -> u64 {
        self.counts.foreign
    }

    /// The next part; after the end or a fault, the same part again.
    pub(super) fn next(&mut self) -> Numbered {
        loop {
            if let Some(end) = &self.end {
                return Numbered::Part(match end {
                    End::Whole => LogPart::Whole,
                    End::Broken(why) => LogPart::Broken(why.clone()),
                });
            }
            match self.advance() {
                Ok(Some(part)) => return part,
                Ok(None) => {}
                Err(end) => self.end = Some(end),
            }
        }
    }

    /// Reads one record.
    fn advance(&mut self) -> Result<Option<Numbered>, End> {
        let Some((at, chunk)) = &mut self.chunk else { return self.next_record() };
        let at = *at;
        match chunk.next() {
            Some(Ok((opcode, record))) => {
                // The fields are borrowed separately, so that the chunk stays in place.
                let read = read(opcode, record, &mut self.topics, &mut self.counts, &self.decoder);
                read.map_err(|fault| End::Broken(format!("the chunk at byte {at} has {fault}")))
            }
            Some(Err(fault)) => Err(End::Broken(format!("the chunk at byte {at} {fault}"))),
            None => {
                self.chunk = None;
                Ok(None)
            }
        }
    }

    fn next_record(&mut self) -> Result<Option<Numbered>, End> {
        let record = match self.records.next() {
            Ok(Some(record)) => record,
            Ok(None) if self.is_past_data => return Err(End::Whole),
            Ok(None) => {
                return Err(End::Broken(format!("it ends at byte {}, before its end", self.records.at())));
            }
            Err(error) => return Err(End::Broken(unreadable(self.records.at(), &error))),
        };
        let RawRecord { opcode, at, length, state } = record;
        if self.is_past_data {
            return self.check_summary(&record);
        }
        match (opcode, state) {
            (op::CHUNK, ReadState::Whole | ReadState::Cut) => {
                self.counts.chunks += 1;
                let chunk = Chunk::unpack(self.records.data(), state == ReadState::Cut)
                    .map_err(|fault| End::Broken(format!("the chunk at byte {at} is damaged: {fault}")))?;
                self.chunk = Some((at, chunk));
                Ok(None)
            }
            (op::CHUNK, ReadState::Long) => {
                Err(End::Broken(format!("the chunk at byte {at} claims {length} bytes")))
            }
            (_, ReadState::Cut) => Err(End::Broken(format!(
                "it ends in the middle of the record at byte {at}, of {length} bytes"
            ))),
            (op::DATA_END, ReadState::Whole) => self.end_data(at).map(|()| None),
            (op::ATTACHMENT | op::METADATA, _) => self.check_opened(&record).map(|()| None),
            (op::MESSAGE, ReadState::Long) => self.pass_over_message(&record).map(|()| None),
            (_, ReadState::Long) => Ok(None),
            (_, ReadState::Whole) => {
                let data = self.records.data();
                let read = read(opcode, data, &mut self.topics, &mut self.counts, &self.decoder);
                read.map_err(|fault| End::Broken(format!("at byte {at} there is {fault}")))
            }
        }
    }

    /// Counts a message that is too long for our topics.
    fn pass_over_message(&mut self, record: &RawRecord) -> Result<(), End> {
        self.counts.messages += 1;
        match McapMessage::read(self.records.data()).map(|message| self.topics.get(&message.channel)) {
            Some(Some(None)) => {
                self.counts.foreign += 1;
                Ok(())
            }
            _ => {
                Err(End::Broken(format!("the message at byte {} claims {} bytes", record.at, record.length)))
            }
        }
    }

    /// Compares one of our attachments or metadata records with those read on opening the file.
    fn check_opened(&self, record: &RawRecord) -> Result<(), End> {
        let RawRecord { opcode, at, state, .. } = *record;
        let data = self.records.data();
        let broken = |fault: &str| Err(End::Broken(format!("at byte {at} there is {fault}")));
        if opcode == op::METADATA {
            let Some((name, _)) = metadata(data) else { return broken("metadata that makes no sense") };
            let is_other = name == METADATA && self.opened.get(METADATA) != Some(&crc32fast::hash(data));
            return if is_other { broken("metadata of another recording") } else { Ok(()) };
        }
        let ours =
            Attachment::name(data).and_then(|name| [FLOOR, LAYOUT].into_iter().find(|own| *own == name));
        if state == ReadState::Long && ours.is_none() {
            return Ok(());
        }
        match (Attachment::read(data), ours) {
            (None, _) => broken("an attachment that makes no sense"),
            (Some(attachment), _) if !attachment.is_sound => {
                broken("an attachment that does not fit its checksum")
            }
            (Some(attachment), Some(name))
                if self.opened.get(name) != Some(&crc32fast::hash(attachment.data)) =>
            {
                broken(&format!("a second {name}: the file has two recordings in it"))
            }
            _ => Ok(()),
        }
    }

    /// Ends the data section: verifies it against its checksum, if it has one.
    fn end_data(&mut self, at: u64) -> Result<(), End> {
        self.is_past_data = true;
        let written = super::bytes::ByteReader(self.records.data()).u32();
        let found = self.records.end_checksum();
        match written {
            Some(0) => Ok(()),
            written if written == found => Ok(()),
            _ => Err(End::Broken(format!(
                "the data up to byte {at} do not fit their checksum, although each chunk fits its own: what lies between \
                 chunks is damaged"
            ))),
        }
    }

    /// Compares the counts of messages and chunks with the summary.
    fn check_summary(&self, record: &RawRecord) -> Result<Option<Numbered>, End> {
        if record.state != ReadState::Whole || record.opcode == op::FOOTER {
            return Err(End::Whole);
        }
        if record.opcode == op::STATISTICS
            && let Some((messages, chunks)) = statistics(self.records.data())
            && (messages, chunks) != (self.counts.messages, self.counts.chunks)
        {
            let Counts { messages: found, chunks: found_chunks, .. } = self.counts;
            return Err(End::Broken(format!(
                "its summary counts {messages} messages in {chunks} chunks, and it has {found} in {found_chunks}"
            )));
        }
        Ok(None)
    }
}

/// Reads one record of the data section; the error names the faulty part of the file.
fn read(
    opcode: u8,
    record: &[u8],
    topics: &mut HashMap<u16, Option<&'static str>>,
    counts: &mut Counts,
    decoder: &Decoder,
) -> Result<Option<Numbered>, String> {
    match opcode {
        op::CHANNEL => {
            let (number, topic) = channel(record).ok_or("a channel that makes no sense")?;
            let topic = TOPICS.into_iter().find(|own| *own == topic);
            match topics.insert(number, topic) {
                Some(before) if before != topic => {
                    Err(format!("a second channel {number}, of another topic"))
                }
                _ => Ok(None),
            }
        }
        op::MESSAGE => {
            counts.messages += 1;
            let message = McapMessage::read(record).ok_or("a message that is too short")?;
            let topic = topics.get(&message.channel);
            match topic
                .ok_or_else(|| format!("a message of channel {}, which is not defined", message.channel))?
            {
                Some(topic) => ours(topic, &message, decoder).map(Some),
                None => {
                    counts.foreign += 1;
                    Ok(None)
                }
            }
        }
        _ => Ok(None),
    }
}

/// A message on one of our topics.
fn ours(topic: &'static str, message: &McapMessage<'_>, decoder: &Decoder) -> Result<Numbered, String> {
    if topic == EVENTS {
        return Ok(Numbered::Part(LogPart::Event(message.data.to_vec())));
    }
    let [taken, came] = [message.log_ns, message.publish_ns].map(|ns| Instant::from_micros(ns / 1000));
    let entry = LogEntry::read(topic, message.data, came, decoder)
        .ok_or_else(|| format!("a message of {topic}, at {:.3} s, that makes no sense", taken.secs()))?;
    Ok(Numbered::Entry(taken, message.sequence, entry))
}

fn unreadable(at: u64, error: &io::Error) -> String {
    format!("it cannot be read beyond byte {at}: {error}")
}

impl fmt::Debug for MessageReader {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Messages").field("path", &self.path).finish_non_exhaustive()
    }
}
