//! Passes lines of events to a recording.

use std::io::{self, Write};

use super::recorder::Recorder;
use super::writer::Job;
use crate::outgoing::json::Head;
use crate::units::Instant;

/// Receives JSON lines, each as a message of its own.
#[derive(Debug)]
pub(super) struct EventLines {
    recorder: Recorder,
    line: Vec<u8>,
}

impl EventLines {
    pub(super) const fn new(recorder: Recorder) -> Self {
        Self { recorder, line: Vec::new() }
    }

    fn put(&mut self) -> io::Result<()> {
        let line = std::mem::take(&mut self.line);
        if line.is_empty() {
            return Ok(());
        }
        let at = Head::read(&line).ok().and_then(|head| head.at()).unwrap_or(Instant::START);
        if self.recorder.hand_job(Job::Event(at, line)).is_some() {
            self.recorder.note_lost(1);
            return Err(io::Error::other("the recording does not keep up"));
        }
        Ok(())
    }
}

impl Write for EventLines {
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
