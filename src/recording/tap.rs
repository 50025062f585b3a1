//! A tap: passes the results of a source on to a second receiver.

use std::fmt;
use std::net::SocketAddr;
use std::time::Duration;

use super::entry::Entry;
use super::recorder::as_kept;
use crate::floor::Geometry;
use crate::layout::Layout;
use crate::source::{SensorSource, SourceError};
use crate::units::Instant;
use crate::wire::{LinkCause, LinkCounters, Request, SensorPacket};

/// Entries, each with the time at which the server took it.
pub(crate) type Entries = Vec<(Instant, Entry)>;

/// Receives the results of a source: a recording, or remote windows that show the same floor.
pub(crate) trait EntrySink: Send {
    /// Whether a receiver wants entries now; if not, none are collected.
    fn is_wanted(&self) -> bool;

    /// Span of the floor's time in one batch.
    fn batch(&self) -> Duration;

    /// Whether the replay must be identical bit for bit: the source's time then stands still between packets, so that
    /// every query returns the same time, and the floor gets each layout as it is stored.
    fn is_exact(&self) -> bool;

    /// Passes `entries` on; returns them if there is no room.
    fn hand(&self, entries: Entries) -> Option<Entries>;

    /// Counts entries that could not be passed on.
    fn count_lost(&self, entries: u64);
}

/// A source whose results are also passed on.
pub struct TappedSource {
    inner: Box<dyn SensorSource>,
    entries_to: Box<dyn EntrySink>,
    geometry: Geometry,
    now: Instant,
    batch: Entries,
    /// Number of entries dropped since the last ones that fitted.
    left_out: u64,
}

impl TappedSource {
    pub(crate) fn new(
        inner: Box<dyn SensorSource>,
        entries_to: Box<dyn EntrySink>,
        geometry: Geometry,
    ) -> Self {
        let now = inner.now();
        Self { inner, entries_to, geometry, now, batch: Vec::new(), left_out: 0 }
    }

    fn put(&mut self, entry: impl FnOnce() -> Entry) {
        if !self.entries_to.is_wanted() {
            self.batch.clear();
            self.left_out = 0;
            return;
        }
        self.batch.push((self.now, entry()));
        if self.batch.first().is_some_and(|(first, _)| self.now.since(*first) >= self.entries_to.batch()) {
            self.hand_on();
        }
    }

    fn hand_on(&mut self) {
        let mut entries = std::mem::take(&mut self.batch);
        if let Some((at, _)) = entries.first().filter(|_| self.left_out > 0) {
            entries.insert(0, (*at, Entry::Gap(self.left_out)));
        }
        let room = entries.len();
        match self.entries_to.hand(entries) {
            None => self.left_out = 0,
            Some(entries) => {
                let kept_out = entries.iter().filter(|(_, entry)| !matches!(entry, Entry::Gap(_))).count();
                self.left_out += kept_out as u64;
                self.entries_to.count_lost(kept_out as u64);
            }
        }
        self.batch.reserve(room);
    }
}

impl SensorSource for TappedSource {
    fn next(&mut self, patience: Duration) -> Result<Option<SensorPacket>, SourceError> {
        let given = self.inner.next(patience);
        self.now = self.now.max(self.inner.now());
        match &given {
            Ok(Some(packet)) => self.put(|| Entry::Packet(packet.clone())),
            Ok(None) => self.put(|| Entry::Silence),
            Err(SourceError::Ended) => self.put(|| Entry::End),
            Err(_) => {}
        }
        given
    }

    fn now(&self) -> Instant {
        if self.entries_to.is_exact() { self.now } else { self.inner.now() }
    }

    fn take_request(&mut self) -> Option<Request> {
        let request = self.inner.take_request()?;
        self.put(|| Entry::Request(request.clone()));
        Some(request)
    }

    fn take_layout(&mut self) -> Option<Layout> {
        let layout = self.inner.take_layout()?;
        // The layout was read from text of a recording or another server, so it can be written again.
        self.put(|| Entry::Layout(crate::schema::write_layout(&layout)));
        Some(layout)
    }

    fn note_request(&mut self, request: &Request) {
        self.inner.note_request(request);
        self.put(|| Entry::Request(request.clone()));
    }

    fn note_layout(&mut self, layout: &mut Layout) {
        self.inner.note_layout(layout);
        if !self.entries_to.is_wanted() {
            return;
        }
        match as_kept(layout, &self.geometry) {
            Ok((text, kept)) => {
                if self.entries_to.is_exact() {
                    *layout = kept;
                }
                self.put(|| Entry::Layout(text));
            }
            Err(problems) => {
                self.entries_to.count_lost(1);
                tracing::warn!("a layout could not be handed on, what is made of it will differ: {problems}");
            }
        }
    }

    fn local_addr(&self) -> Option<SocketAddr> {
        self.inner.local_addr()
    }

    fn answer(&mut self, to: SocketAddr, datagram: &[u8]) {
        self.inner.answer(to, datagram);
    }

    fn counters(&self) -> LinkCounters {
        self.inner.counters()
    }

    fn last_refused(&self) -> Option<LinkCause> {
        self.inner.last_refused()
    }
}

impl Drop for TappedSource {
    fn drop(&mut self) {
        self.hand_on();
    }
}

impl fmt::Debug for TappedSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("TappedSource").field("now", &self.now).finish_non_exhaustive()
    }
}
