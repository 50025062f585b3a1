//! A source that is recorded.

use std::fmt;
use std::net::SocketAddr;
use std::time::Duration;

use super::entry::Entry;
use super::recorder::{Recorder, as_kept};
use super::writer::Job;
use crate::floor::Geometry;
use crate::layout::Layout;
use crate::source::{SensorSource, SourceError};
use crate::units::Instant;
use crate::wire::{LinkCounters, Request, SensorPacket};

/// How much of the floor's time is handed to the writing thread at once: its queue has room for 20 s of it.
const BATCH: Duration = Duration::from_millis(20);

/// A source, with all that it gives recorded.
///
/// Its time stands still from one packet to the next, so that a replay can tell the same time whenever it is asked.
pub struct RecordedSource {
    inner: Box<dyn SensorSource>,
    recorder: Recorder,
    geometry: Geometry,
    now: Instant,
    batch: Vec<(Instant, Entry)>,
    /// Entries that did not fit since the last that did.
    left_out: u64,
}

impl RecordedSource {
    pub(super) fn new(inner: Box<dyn SensorSource>, recorder: Recorder) -> Self {
        let (now, geometry) = (inner.now(), recorder.floor().geometry);
        Self { inner, recorder, geometry, now, batch: Vec::new(), left_out: 0 }
    }

    fn put(&mut self, entry: Entry) {
        self.batch.push((self.now, entry));
        if self.batch.first().is_some_and(|(first, _)| self.now.since(*first) >= BATCH) {
            self.hand_on();
        }
    }

    fn hand_on(&mut self) {
        let mut entries = std::mem::take(&mut self.batch);
        if let Some((at, _)) = entries.first().filter(|_| self.left_out > 0) {
            entries.insert(0, (*at, Entry::Gap(self.left_out)));
        }
        let room = entries.len();
        match self.recorder.hand(Job::Entries(entries)) {
            None => self.left_out = 0,
            Some(Job::Entries(entries)) => {
                let kept_out = entries.iter().filter(|(_, entry)| !matches!(entry, Entry::Gap(_))).count();
                self.left_out += kept_out as u64;
                self.recorder.count_lost(kept_out as u64);
            }
            Some(Job::Event(..)) => {}
        }
        self.batch.reserve(room);
    }
}

impl SensorSource for RecordedSource {
    fn next(&mut self, patience: Duration) -> Result<Option<SensorPacket>, SourceError> {
        let given = self.inner.next(patience);
        self.now = self.now.max(self.inner.now());
        match &given {
            Ok(Some(packet)) => self.put(Entry::Packet(packet.clone())),
            Ok(None) => self.put(Entry::Silence),
            Err(SourceError::Ended) => self.put(Entry::End),
            Err(_) => {}
        }
        given
    }

    fn now(&self) -> Instant {
        self.now
    }

    fn take_request(&mut self) -> Option<Request> {
        let request = self.inner.take_request()?;
        self.put(Entry::Request(request.clone()));
        Some(request)
    }

    fn note_request(&mut self, request: &Request) {
        self.put(Entry::Request(request.clone()));
    }

    fn note_layout(&mut self, layout: &mut Layout) {
        match as_kept(layout, &self.geometry) {
            Ok((text, kept)) => {
                *layout = kept;
                self.put(Entry::Layout(text));
            }
            Err(problems) => {
                self.recorder.count_lost(1);
                tracing::warn!("a layout could not be recorded, its replay will differ: {problems}");
            }
        }
    }

    fn answer(&mut self, to: SocketAddr, datagram: &[u8]) {
        self.inner.answer(to, datagram);
    }

    fn counters(&self) -> LinkCounters {
        self.inner.counters()
    }
}

impl Drop for RecordedSource {
    fn drop(&mut self) {
        self.hand_on();
    }
}

impl fmt::Debug for RecordedSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("RecordedSource").field("now", &self.now).finish_non_exhaustive()
    }
}
