//! The entries of a server's source in their order, with the server's time; without threads and clocks.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use super::Greeting;
use crate::floor::Geometry;
use crate::source::log::{Entries, LogEntry, read_layout};
use crate::source::{Incoming, Replay};
use crate::units::Instant;
use crate::wire::{LinkCounters, Request, SensorPacket};

/// Maximum delay of a frame before time advances without it: shorter than the time after which a board counts as
/// lost, and longer than the delays in the network of one building.
pub(super) const LATE: Duration = Duration::from_millis(40);

/// Numbers that other threads read.
#[derive(Debug, Default)]
pub(super) struct Counters {
    /// The server's time in microseconds.
    pub(super) now_us: AtomicU64,
    /// Number of invalid frames.
    pub(super) bad: AtomicU64,
    /// Number of entries missing from the stream.
    pub(super) left_out: AtomicU64,
}

/// The entries that have arrived and are not taken yet.
#[derive(Debug)]
pub(super) struct MirrorStream {
    ahead: VecDeque<(Instant, LogEntry)>,
    now: Instant,
    geometry: Geometry,
    /// The text of the current layout.
    layout: String,
    pub(super) counters: Arc<Counters>,
}

impl MirrorStream {
    /// A stream that begins at the time of the greeting.
    pub(super) fn new(greeting: &Greeting) -> Self {
        let (now, geometry, layout) = (greeting.now, greeting.floor.geometry, greeting.layout_text.clone());
        let counters = Arc::<Counters>::default();
        counters.now_us.store(now.micros(), Ordering::Relaxed);
        Self { ahead: VecDeque::new(), now, geometry, layout, counters }
    }

    /// Appends entries; returns the server's time at their end.
    pub(super) fn add(&mut self, entries: Entries) -> Instant {
        let until = entries.last().map_or(self.now, |(taken, _)| self.now.max(*taken));
        self.ahead.extend(entries);
        until
    }

    /// Whether all entries have been taken.
    pub(super) fn is_empty(&self) -> bool {
        self.ahead.is_empty()
    }

    /// The present on the server's clock, as known here.
    pub(super) const fn now(&self) -> Instant {
        self.now
    }

    /// Advances the time; it never goes back.
    pub(super) fn set_now(&mut self, to: Instant) {
        self.now = self.now.max(to);
        self.counters.now_us.store(self.now.micros(), Ordering::Relaxed);
    }

    /// Number of invalid frames, as malformed.
    pub(super) fn link_counters(&self) -> LinkCounters {
        LinkCounters { malformed: self.counters.bad.load(Ordering::Relaxed), ..LinkCounters::default() }
    }

    /// The next packet; `None` if the server got none, or takes a request or a layout before it. It never ends by
    /// itself, since a server may come back.
    pub(super) fn next(&mut self) -> Option<SensorPacket> {
        loop {
            match self.advance() {
                Some(LogEntry::Packet(packet)) => return Some(packet),
                Some(LogEntry::Silence | LogEntry::End) | None => return None,
                Some(LogEntry::Gap(entries)) => {
                    self.counters.left_out.fetch_add(entries, Ordering::Relaxed);
                }
                Some(entry @ (LogEntry::Request(_) | LogEntry::Layout(_))) => {
                    // The server takes these before the next packet.
                    self.ahead.push_front((self.now, entry));
                    return None;
                }
            }
        }
    }

    /// The next entry.
    fn advance(&mut self) -> Option<LogEntry> {
        let (taken, entry) = self.ahead.pop_front()?;
        self.set_now(taken);
        Some(entry)
    }
}

impl Replay for MirrorStream {
    fn take(&mut self) -> Option<Incoming> {
        self.ahead
            .front()
            .filter(|(_, entry)| matches!(entry, LogEntry::Request(_) | LogEntry::Layout(_)))?;
        match self.advance()? {
            // The server has answered the sender of the request.
            LogEntry::Request(request) => Some(Incoming::Request(Request { sender: None, ..request })),
            LogEntry::Layout(text) if text != self.layout => {
                let layout = read_layout(&text, &self.geometry)
                    .inspect_err(|problems| tracing::warn!("the server's layout can't be read: {problems}"))
                    .ok()?;
                self.layout = text;
                Some(Incoming::Layout(Box::new(layout)))
            }
            _ => None,
        }
    }
}
