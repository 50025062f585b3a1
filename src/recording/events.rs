//! Passes lines of events to a recording.

use std::io::{self, Write};

use super::writer::Job;
use crate::outgoing::json::Head;
use crate::source::log::Entries;
use crate::units::Instant;

/// Receives the jobs of a recording.
pub(super) trait JobSink {
    /// Queues `job`; returns it if it does not fit.
    fn hand_job(&self, job: Job) -> Option<Job>;

    /// Counts entries or lines that could not be queued.
    fn note_lost(&self, count: u64);

    /// Queues `entries`; returns them if they do not fit.
    fn hand_entries(&self, entries: Entries) -> Option<Entries> {
        match self.hand_job(Job::Entries(entries))? {
            Job::Entries(entries) => Some(entries),
            Job::Event(..) => None,
        }
    }
}

/// Receives JSON lines, each as a message of its own.
#[derive(Debug)]
pub(super) struct EventLines<R> {
    recorder: R,
    line: Vec<u8>,
}

/// The time of an event, by its line; the start of the floor's clock if it has none.
pub(super) fn time_of(line: &[u8]) -> Instant {
    Head::read(line).ok().and_then(|head| head.at()).unwrap_or(Instant::START)
}

impl<R: JobSink> EventLines<R> {
    pub(super) const fn new(recorder: R) -> Self {
        Self { recorder, line: Vec::new() }
    }

    fn put(&mut self) -> io::Result<()> {
        let line = std::mem::take(&mut self.line);
        if line.is_empty() {
            return Ok(());
        }
        if self.recorder.hand_job(Job::Event(time_of(&line), line)).is_some() {
            self.recorder.note_lost(1);
            return Err(io::Error::other("the recording does not keep up"));
        }
        Ok(())
    }
}

impl<R: JobSink> Write for EventLines<R> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        for part in bytes.split_inclusive(|&byte| byte == b'\n') {
            match part.split_last() {
                Some((b'\n', rest)) => {
                    self.line.extend(rest);
                    self.put()?;
                }
                _ => self.line.extend(part),
            }
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
