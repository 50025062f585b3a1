//! Replays a recording as a source.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant as HostInstant};

use super::messages::LogPart;
use super::order::Ordered;
use super::transport::Transport;
use crate::floor::Geometry;
use crate::source::log::{LogEntry, read_layout};
use crate::source::{FloorInput, Incoming, Replay, SensorSource, Shared, SourceError};
use crate::units::{HostClock, Instant};
use crate::wire::{LinkCounters, Request, SensorPacket};

/// Maximum wait for the next entry: a replay skips long gaps.
const LONGEST_WAIT: Duration = Duration::from_secs(1);

/// Maximum length of one sleep: the transport is checked in between.
const A_WHILE: Duration = Duration::from_millis(10);

/// Speed of a replay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Speed {
    /// Seconds of the recording per second; a value that is not above 0 counts as [`Speed::Max`].
    Times(f64),
    /// As fast as possible.
    Max,
}

/// Progress of a replay.
#[derive(Debug, Default)]
pub struct Progress {
    now_us: AtomicU64,
    packets: AtomicU64,
    gaps: AtomicU64,
    foreign: AtomicU64,
    is_over: AtomicBool,
    broken: Mutex<Option<String>>,
}

impl Progress {
    /// The current time of the recording.
    #[must_use]
    pub fn now(&self) -> Instant {
        Instant::from_micros(self.now_us.load(Ordering::Relaxed))
    }

    /// Number of packets replayed.
    #[must_use]
    pub fn packets(&self) -> u64 {
        self.packets.load(Ordering::Relaxed)
    }

    /// Number of entries missing from the recording so far; events after a gap may differ from the original ones.
    #[must_use]
    pub fn left_out(&self) -> u64 {
        self.gaps.load(Ordering::Relaxed)
    }

    /// Number of messages so far on topics of other programs, which the replay ignores.
    #[must_use]
    pub fn foreign(&self) -> u64 {
        self.foreign.load(Ordering::Relaxed)
    }

    /// Whether the replay is complete.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.is_over.load(Ordering::Relaxed)
    }

    /// Place and reason of the first break or damage in the recording, once the replay has reached it.
    #[must_use]
    pub fn broken(&self) -> Option<String> {
        self.broken.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// Returns the packets, requests and layouts of a recording, with the same times.
#[derive(Debug)]
pub struct ReplaySource {
    parts: Ordered,
    geometry: Geometry,
    ahead: Option<(Instant, LogEntry)>,
    now: Instant,
    transport: Arc<Transport>,
    /// The transport's change count, and the recording's time and the host's time since then.
    begun: Option<(u64, Instant, HostInstant)>,
    progress: Arc<Progress>,
}

impl ReplaySource {
    pub(super) fn new(parts: Ordered, geometry: Geometry, speed: Speed) -> Self {
        let (transport, progress) = (Arc::new(Transport::new(speed)), Arc::default());
        let (now, begun) = (Instant::START, None);
        let mut source = Self { parts, geometry, ahead: None, now, transport, begun, progress };
        source.advance();
        source.now = source.ahead.as_ref().map_or(Instant::START, |(taken, _)| *taken);
        source
    }

    /// Progress of the replay, readable from other threads.
    #[must_use]
    pub fn progress(&self) -> Arc<Progress> {
        Arc::clone(&self.progress)
    }

    /// The transport of the replay, for control from other threads.
    #[must_use]
    pub fn transport(&self) -> Arc<Transport> {
        Arc::clone(&self.transport)
    }

    /// The clock of the recording, which stands still between packets.
    #[must_use]
    pub fn clock(&self) -> HostClock {
        let progress = self.progress();
        Arc::new(move || progress.now())
    }

    /// The next packet, or `None` if none was recorded or the next entry is not due yet; waits according to the
    /// speed. Skips requests and layouts that the floor has not taken.
    ///
    /// # Errors
    /// [`SourceError::Ended`] at the end of the recording or at a break, and in every call after.
    fn next_packet(&mut self) -> Result<Option<SensorPacket>, SourceError> {
        loop {
            if !self.wait() {
                return Ok(None);
            }
            match self.advance() {
                Some((_, LogEntry::Packet(packet))) => {
                    self.progress.packets.fetch_add(1, Ordering::Relaxed);
                    return Ok(Some(packet));
                }
                Some((_, LogEntry::Silence)) => return Ok(None),
                Some((_, LogEntry::End)) | None => return Err(SourceError::Ended),
                // Entries that the server did not take.
                Some((_, LogEntry::Request(_) | LogEntry::Layout(_) | LogEntry::Gap(_))) => {}
            }
        }
    }

    /// The present of the recording: the time of the last entry, or of the first one before the start.
    #[must_use]
    pub const fn now(&self) -> Instant {
        self.now
    }

    /// Returns the next entry and reads the one after it.
    fn advance(&mut self) -> Option<(Instant, LogEntry)> {
        let next = self.ahead.take();
        if let Some((taken, _)) = &next {
            self.now = self.now.max(*taken);
            self.progress.now_us.store(self.now.micros(), Ordering::Relaxed);
        }
        while self.ahead.is_none() && !self.progress.is_over() {
            match self.parts.next_part() {
                LogPart::Entry(_, LogEntry::Gap(entries)) => {
                    self.progress.gaps.fetch_add(entries, Ordering::Relaxed);
                }
                LogPart::Entry(taken, entry) => self.ahead = Some((taken, entry)),
                LogPart::Whole => self.progress.is_over.store(true, Ordering::Relaxed),
                LogPart::Broken(why) => {
                    let why = format!("{}: {why}", self.parts.path().display());
                    *self.progress.broken.lock().unwrap_or_else(PoisonError::into_inner) = Some(why);
                    self.progress.is_over.store(true, Ordering::Relaxed);
                }
                LogPart::Event(_) => {}
            }
        }
        self.progress.foreign.store(self.parts.foreign(), Ordering::Relaxed);
        next
    }

    /// Waits until the next entry is due, at most for [`A_WHILE`]; returns whether it is due.
    fn wait(&mut self) -> bool {
        let Some((taken, entry)) = &self.ahead else { return !self.rests_at_the_end() };
        let taken = *taken;
        if matches!(entry, LogEntry::End) && self.rests_at_the_end() {
            return false;
        }
        if self.transport.hurries(taken) {
            self.begun = None;
            return true;
        }
        if self.transport.is_paused() {
            self.begun = None;
            thread::sleep(A_WHILE);
            return false;
        }
        let Speed::Times(speed) = self.transport.speed() else { return true };
        let changes = self.transport.changes();
        let begun = self.begun.filter(|(of, ..)| *of == changes);
        // After a change, the wait for the next entry begins again at the time of the last one.
        let (_, first, host) = *self.begun.insert(begun.unwrap_or((changes, self.now, HostInstant::now())));
        let Ok(due) = Duration::try_from_secs_f64(taken.since(first).as_secs_f64() / speed) else {
            return true;
        };
        let wait = due.saturating_sub(host.elapsed());
        if wait > LONGEST_WAIT {
            // A gap: the replay continues after a second.
            let left_out = (wait - LONGEST_WAIT).mul_f64(speed);
            self.begun = Some((changes, first + left_out, host));
        }
        thread::sleep(wait.min(A_WHILE));
        wait <= A_WHILE
    }

    /// At the end of the recording, sleeps for [`A_WHILE`] if the replay is to stay there; returns whether it is.
    fn rests_at_the_end(&self) -> bool {
        let stays = self.transport.stays();
        if stays {
            self.progress.is_over.store(true, Ordering::Relaxed);
            thread::sleep(A_WHILE);
        }
        stays
    }
}

impl From<ReplaySource> for FloorInput {
    fn from(source: ReplaySource) -> Self {
        let source = Shared::new(source);
        Self { replay: Some(Box::new(source.clone())), ..Self::from(source) }
    }
}

impl SensorSource for Shared<ReplaySource> {
    fn next(&mut self, _patience: Duration) -> Result<Option<SensorPacket>, SourceError> {
        self.lock().next_packet()
    }

    fn now(&self) -> Instant {
        self.lock().now()
    }

    fn counters(&self) -> LinkCounters {
        LinkCounters::default()
    }
}

impl Replay for ReplaySource {
    fn take(&mut self) -> Option<Incoming> {
        self.ahead
            .as_ref()
            .filter(|(_, entry)| matches!(entry, LogEntry::Request(_) | LogEntry::Layout(_)))?;
        match self.advance()? {
            (_, LogEntry::Request(request)) => Some(Incoming::Request(Request { sender: None, ..request })),
            (_, LogEntry::Layout(text)) => read_layout(&text, &self.geometry)
                .inspect_err(|problems| tracing::warn!("a recorded layout can't be read: {problems}"))
                .map(|layout| Incoming::Layout(Box::new(layout)))
                .ok(),
            _ => None,
        }
    }
}
