//! Passes lines of events to a recording.

use std::io::{self, Write};

use serde::Deserialize;

use super::recorder::Recorder;
use super::writer::Job;
use crate::units::Instant;

/// Receives JSON lines, each as a message of its own.
#[derive(Debug)]
pub(super) struct EventLines {
    recorder: Recorder,
    line: Vec<u8>,
}

/// The one field that all lines have.
#[derive(Deserialize)]
struct Timed {
    t_s: f64,
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
        let at = serde_json::from_slice(&line).map_or(Instant::START, |Timed { t_s }| {
            // The cast saturates.
            Instant::from_micros((t_s * 1e6).round() as u64)
        });
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
