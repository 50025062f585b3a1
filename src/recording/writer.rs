//! The thread that writes a recording.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufWriter};
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::RecvTimeoutError;
use std::time::{Duration, Instant as HostInstant};

use mcap::records::MessageHeader;

use super::pack::PackedFile;
use super::reader::known_as;
use super::{
    BEGINS, END, EVENTS, FLOOR, GAPS, LAYOUT, LAYOUTS, LEARNT, METADATA, NOISE, PACKETS, REQUESTS, SILENCE,
    VERSION,
};
use crate::sense::Method;
use crate::sink::{Disk, WaitFreeReceiver};
use crate::source::log::LogEntry;
use crate::units::Instant;

/// Interval at which buffered data is written to the file: the maximum loss in a crash of the program.
const FLUSH_EVERY: Duration = Duration::from_secs(1);

/// JSON schema of `/underfoot/events`; the page about OSC and JSON describes the fields of each event.
const EVENT_SCHEMA: &str = r#"{"title":"underfoot.Event","type":"object","properties":{"t_s":{"type":"number"},"event":{"type":"string"},"id":{"type":"string"},"force_n":{"type":["number","null"]},"x_m":{"type":["number","null"]},"y_m":{"type":["number","null"]},"contact":{"type":["integer","null"]},"state":{"type":"string"},"sequence":{"type":"integer"}},"required":["t_s"]}"#;

/// Input of the writing thread.
#[derive(Debug)]
pub(super) enum Job {
    /// Entries, each with the time at which the server took it.
    Entries(Vec<(Instant, LogEntry)>),
    /// One line of JSON without its line end, and the time of its event.
    Event(Instant, Vec<u8>),
}

impl Job {
    fn count(&self) -> u64 {
        match self {
            Self::Entries(entries) => entries.len() as u64,
            Self::Event(..) => 1,
        }
    }
}

/// The content of a recording before its messages.
#[derive(Clone, Copy, Debug)]
pub(super) struct RecordingHead<'a> {
    /// The floor and the layout, as texts.
    pub(super) floor: &'a str,
    pub(super) layout: &'a str,
    pub(super) method: Method,
    /// Beginning of the part on display; the messages before it only bring the floor into its state.
    pub(super) begins: Option<Instant>,
}

/// A recording file, open for writing.
pub(super) struct RecordingFile {
    writer: PackedFile<BufWriter<File>>,
    disk: Disk,
    channels: BTreeMap<&'static str, u16>,
    bytes: Vec<u8>,
    /// Number of the next entry; it wraps.
    number: u32,
}

impl RecordingFile {
    /// Begins the file with the floor and the layout.
    pub(super) fn begin(file: File, path: &Path, head: RecordingHead<'_>) -> io::Result<Self> {
        let disk = Disk::of(&file, path)?;
        let library = concat!("underfoot ", env!("CARGO_PKG_VERSION"));
        let mut writer = PackedFile::begin(BufWriter::new(file), "underfoot", library)?;
        let begins = head.begins.map(|at| at.micros().to_string());
        let entries = [("method", known_as(head.method)), (NOISE, LEARNT), ("version", VERSION)];
        let begins = begins.as_deref().map(|begins| (BEGINS, begins));
        writer.metadata(METADATA, &begins.into_iter().chain(entries).collect::<Vec<_>>())?;
        for (name, text) in [(FLOOR, head.floor), (LAYOUT, head.layout)] {
            writer.attach(name, text.as_bytes())?;
        }
        let schema = writer.schema("underfoot.Event", "jsonschema", EVENT_SCHEMA.as_bytes());
        let mut channels = BTreeMap::new();
        for (topic, schema, encoding) in [
            (PACKETS, 0, "underfoot.packet"),
            (SILENCE, 0, "underfoot.empty"),
            (REQUESTS, 0, "underfoot.request"),
            (LAYOUTS, 0, "underfoot.ron"),
            (GAPS, 0, "underfoot.count"),
            (END, 0, "underfoot.empty"),
            (EVENTS, schema, "json"),
        ] {
            channels.insert(topic, writer.channel(schema, topic, encoding));
        }
        writer.flush()?;
        Ok(Self { writer, disk, channels, bytes: Vec::new(), number: 0 })
    }

    fn write(&mut self, job: &Job) -> io::Result<()> {
        match job {
            Job::Entries(entries) => entries.iter().try_for_each(|(taken, entry)| self.entry(*taken, entry)),
            Job::Event(at, line) => self.event(*at, line),
        }
    }

    /// Adds an entry that the server took at `taken`, with the next number.
    pub(super) fn entry(&mut self, taken: Instant, entry: &LogEntry) -> io::Result<()> {
        self.bytes.clear();
        entry.write_split(&mut self.bytes);
        self.put(entry.topic(), self.number, taken, entry.came(taken))?;
        self.number = self.number.wrapping_add(1);
        Ok(())
    }

    /// Adds the line of an event.
    pub(super) fn event(&mut self, at: Instant, line: &[u8]) -> io::Result<()> {
        self.bytes.clear();
        self.bytes.extend(line);
        self.put(EVENTS, 0, at, at)
    }

    /// Ends the file.
    pub(super) fn finish(self) -> io::Result<()> {
        self.writer.finish()
    }

    fn put(&mut self, topic: &str, sequence: u32, taken: Instant, came: Instant) -> io::Result<()> {
        let Some(&channel_id) = self.channels.get(topic) else { return Ok(()) };
        let [log_time, publish_time] = [taken, came].map(|at| at.micros().saturating_mul(1000));
        let header = MessageHeader { channel_id, sequence, log_time, publish_time };
        self.writer.message(&header, &self.bytes)
    }

    /// Writes jobs until all senders are dropped. A full or failed disk ends the recording, not sensing: later jobs
    /// are counted as lost.
    pub(super) fn write_all(mut self, jobs: &mut WaitFreeReceiver<Job>, lost: &AtomicU64) {
        let mut flushed = HostInstant::now();
        let written = loop {
            let due = FLUSH_EVERY.saturating_sub(flushed.elapsed());
            let done = match jobs.recv_timeout(due) {
                Ok(job) => self.write(&job).inspect_err(|_| {
                    lost.fetch_add(job.count(), Ordering::Relaxed);
                }),
                Err(RecvTimeoutError::Timeout) => Ok(()),
                Err(RecvTimeoutError::Disconnected) => break self.finish(),
            };
            let done = done.and_then(|()| {
                if flushed.elapsed() < FLUSH_EVERY {
                    return Ok(());
                }
                flushed = HostInstant::now();
                self.writer.flush()?;
                self.disk.tend()
            });
            if done.is_err() {
                break done;
            }
        };
        if let Err(error) = written {
            lost.fetch_add(1, Ordering::Relaxed);
            tracing::warn!("the recording ends here, the floor works on: {error}");
            jobs.iter().for_each(|job| {
                lost.fetch_add(job.count(), Ordering::Relaxed);
            });
        }
    }
}
