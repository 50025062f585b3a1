//! A tap: passes the results of a source on to a second receiver.

use std::time::Duration;

use super::kept::as_kept;
use crate::floor::Geometry;
use crate::layout::Layout;
use crate::source::log::{Entries, LogEntry};
use crate::source::{FloorInput, Journal, SensorSource, Shared, SourceError};
use crate::units::Instant;
use crate::wire::{LinkCounters, Request, SensorPacket};

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

/// A source whose packets are also passed on.
struct TappedSource {
    inner: Box<dyn SensorSource>,
    tap: Shared<Tap>,
}

/// Passes on the packets of a source, and between them the requests and layouts of its floor.
struct Tap {
    entries_to: Box<dyn EntrySink>,
    geometry: Geometry,
    now: Instant,
    /// Latest answer to a query of the time: it stands still from there if the receiver becomes exact.
    answered: Instant,
    batch: Entries,
    /// Number of entries dropped since the last ones that fitted.
    left_out: u64,
}

/// Wraps `input`, on a floor of this geometry, so that its results are also passed to `entries_to`.
pub(crate) fn tapped(
    input: FloorInput,
    entries_to: impl EntrySink + 'static,
    geometry: Geometry,
) -> FloorInput {
    let FloorInput { source: inner, port, replay, mut journals } = input;
    let (now, entries_to) = (inner.now(), Box::new(entries_to));
    let tap = Shared::new(Tap { entries_to, geometry, now, answered: now, batch: Vec::new(), left_out: 0 });
    journals.push(Box::new(tap.clone()));
    FloorInput { source: Box::new(TappedSource { inner, tap }), port, replay, journals }
}

impl Tap {
    fn put(&mut self, entry: impl FnOnce() -> LogEntry) {
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
            entries.insert(0, (*at, LogEntry::Gap(self.left_out)));
        }
        let room = entries.len();
        match self.entries_to.hand(entries) {
            None => self.left_out = 0,
            Some(entries) => {
                let kept_out = entries.iter().filter(|(_, entry)| !matches!(entry, LogEntry::Gap(_))).count();
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
        let mut tap = self.tap.lock();
        tap.now = tap.now.max(self.inner.now());
        match &given {
            Ok(Some(packet)) => tap.put(|| LogEntry::Packet(packet.clone())),
            Ok(None) => tap.put(|| LogEntry::Silence),
            Err(SourceError::Ended) => tap.put(|| LogEntry::End),
            Err(_) => {}
        }
        given
    }

    fn now(&self) -> Instant {
        let mut tap = self.tap.lock();
        let now = if tap.entries_to.is_exact() { tap.now } else { self.inner.now() };
        tap.answered = tap.answered.max(now);
        tap.answered
    }

    fn counters(&self) -> LinkCounters {
        self.inner.counters()
    }
}

impl Journal for Tap {
    fn note_request(&mut self, request: &Request) {
        self.put(|| LogEntry::Request(request.clone()));
    }

    fn note_layout(&mut self, layout: &mut Layout) {
        if !self.entries_to.is_wanted() {
            return;
        }
        match as_kept(layout, &self.geometry) {
            Ok((text, kept)) => {
                if self.entries_to.is_exact() {
                    *layout = kept;
                }
                self.put(|| LogEntry::Layout(text));
            }
            Err(problems) => {
                self.entries_to.count_lost(1);
                tracing::warn!("a layout could not be handed on, what is made of it will differ: {problems}");
            }
        }
    }
}

impl Drop for Tap {
    fn drop(&mut self) {
        self.hand_on();
    }
}
