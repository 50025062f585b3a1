//! The thread that writes a recording.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant as HostInstant};

use mcap::records::{MessageHeader, Metadata};
use mcap::{Attachment, McapResult, WriteOptions, Writer};

use super::entry::Entry;
use super::reader::known_as;
use super::{
    END, EVENTS, FLOOR, GAPS, LAYOUT, LAYOUTS, LEARNT, METADATA, NOISE, PACKETS, REQUESTS, SILENCE, VERSION,
};
use crate::sense::Method;
use crate::sink::Disk;
use crate::units::Instant;

/// Interval at which buffered data is written to the file: the maximum loss in a crash of the program.
const FLUSH_EVERY: Duration = Duration::from_secs(1);

/// JSON schema of `/underfoot/events`; the page about OSC and JSON describes the fields of each event.
const EVENT_SCHEMA: &str = r#"{"title":"underfoot.Event","type":"object","properties":{"t_s":{"type":"number"},"event":{"type":"string"},"id":{"type":"string"},"force_n":{"type":["number","null"]},"x_m":{"type":["number","null"]},"y_m":{"type":["number","null"]},"contact":{"type":["integer","null"]},"state":{"type":"string"},"sequence":{"type":"integer"}},"required":["t_s"]}"#;

/// Input of the writing thread.
#[derive(Debug)]
pub(super) enum Job {
    /// Entries, each with the time at which the server took it.
    Entries(Vec<(Instant, Entry)>),
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

/// A recording file, open for writing.
pub(super) struct RecordingFile {
    writer: Writer<BufWriter<File>>,
    disk: Disk,
    channels: BTreeMap<&'static str, u16>,
    bytes: Vec<u8>,
    /// Number of the next entry; it wraps.
    number: u32,
}

impl RecordingFile {
    /// Begins the file with the floor and the layout.
    pub(super) fn begin(
        file: File,
        path: &Path,
        floor: &str,
        layout: &str,
        method: Method,
    ) -> McapResult<Self> {
        let disk = Disk::of(&file, path)?;
        // Chunks are assembled in memory: the file grows by whole chunks only and is never patched.
        let options = WriteOptions::new()
            .compression(None)
            .disable_seeking(true)
            .profile("underfoot")
            .library(concat!("underfoot ", env!("CARGO_PKG_VERSION")));
        let mut writer = options.create(BufWriter::new(file))?;
        let metadata = [("version", VERSION), ("method", known_as(method)), (NOISE, LEARNT)]
            .map(|(key, value)| (key.into(), value.into()));
        writer.write_metadata(&Metadata { name: METADATA.into(), metadata: metadata.into() })?;
        for (name, text) in [(FLOOR, floor), (LAYOUT, layout)] {
            let data = text.as_bytes().into();
            let media_type = "text/plain".into();
            writer.attach(&Attachment {
                log_time: 0,
                create_time: 0,
                name: name.into(),
                media_type,
                data,
            })?;
        }
        let schema = writer.add_schema("underfoot.Event", "jsonschema", EVENT_SCHEMA.as_bytes())?;
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
            channels.insert(topic, writer.add_channel(schema, topic, encoding, &BTreeMap::new())?);
        }
        writer.flush()?;
        Ok(Self { writer, disk, channels, bytes: Vec::new(), number: 0 })
    }

    fn write(&mut self, job: &Job) -> McapResult<()> {
        match job {
            Job::Entries(entries) => {
                for (taken, entry) in entries {
                    self.bytes.clear();
                    entry.write(&mut self.bytes);
                    self.put(entry.topic(), self.number, *taken, entry.came(*taken))?;
                    self.number = self.number.wrapping_add(1);
                }
            }
            Job::Event(at, line) => {
                self.bytes.clone_from(line);
                self.put(EVENTS, 0, *at, *at)?;
            }
        }
        Ok(())
    }

    fn put(&mut self, topic: &str, sequence: u32, taken: Instant, came: Instant) -> McapResult<()> {
        let Some(&channel_id) = self.channels.get(topic) else { return Ok(()) };
        let [log_time, publish_time] = [taken, came].map(|at| at.micros().saturating_mul(1000));
        let header = MessageHeader { channel_id, sequence, log_time, publish_time };
        self.writer.write_to_known_channel(&header, &self.bytes)
    }

    /// Writes jobs until all senders are dropped. A full or failed disk ends the recording, not sensing: later jobs
    /// are counted as lost.
    pub(super) fn write_all(mut self, jobs: &Receiver<Job>, lost: &AtomicU64) {
        let mut flushed = HostInstant::now();
        let written = loop {
            let due = FLUSH_EVERY.saturating_sub(flushed.elapsed());
            let done = match jobs.recv_timeout(due) {
                Ok(job) => self.write(&job).inspect_err(|_| {
                    lost.fetch_add(job.count(), Ordering::Relaxed);
                }),
                Err(RecvTimeoutError::Timeout) => Ok(()),
                Err(RecvTimeoutError::Disconnected) => break self.writer.finish().map(drop),
            };
            let done = done.and_then(|()| {
                if flushed.elapsed() < FLUSH_EVERY {
                    return Ok(());
                }
                flushed = HostInstant::now();
                self.writer.flush()?;
                Ok(self.disk.tend()?)
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
