//! The stream as a source of packets.

use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant as HostInstant};

use super::Greeting;
use super::frame::{self, BadFrame};
use super::stream::{Counters, LATE, MirrorStream};
use crate::source::log::{Entries, LogEntry, decoder};
use crate::source::{FloorInput, Incoming, Replay, SensorSource, Shared, SourceError};
use crate::units::{HostClock, Instant};
use crate::wire::{Decoder, LinkCounters, SensorPacket};

/// Maximum number of waiting frames, four seconds of them, and maximum size of their content: four seconds of a
/// stadium's boards. A sender with more blocks.
const WAITING: usize = 1024;
const MOST_WAITING_BYTES: usize = 64 << 20;

/// Size of an entry without a layout's text.
const ENTRY_BYTES: usize = size_of::<(Instant, LogEntry)>();

/// Interval between two checks for room.
const LOOK_EVERY: Duration = Duration::from_millis(2);

/// Input for frames of the stream.
#[derive(Debug)]
pub struct MirrorInput {
    frames: SyncSender<Entries>,
    waiting: Waiting,
    decoder: Decoder,
    counters: Arc<Counters>,
}

impl MirrorInput {
    /// Takes a frame; blocks while four seconds of frames wait. Drops frames for a source that is gone.
    ///
    /// # Errors
    /// [`BadFrame`] if the frame is invalid; it is counted, and none of it is used.
    pub fn put(&self, bytes: &[u8]) -> Result<(), BadFrame> {
        let entries = frame::read(bytes, &self.decoder).inspect_err(|_| {
            self.counters.bad.fetch_add(1, Ordering::Relaxed);
        })?;
        self.hand(entries);
        Ok(())
    }

    fn hand(&self, entries: Entries) {
        let bytes = size_of_all(&entries);
        while self.waiting.is_full(bytes) {
            thread::sleep(LOOK_EVERY);
        }
        self.waiting.add(bytes);
        // A floor that has ended needs no more packets.
        let _ = self.frames.send(entries);
    }
}

/// Bytes of waiting frames; `None` once the source is gone.
#[derive(Clone, Debug, Default)]
struct Waiting(Arc<Mutex<Option<usize>>>);

impl Waiting {
    fn lock(&self) -> MutexGuard<'_, Option<usize>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether there is no room for `more` bytes.
    fn is_full(&self, more: usize) -> bool {
        self.lock().is_some_and(|bytes| bytes > 0 && bytes + more > MOST_WAITING_BYTES)
    }

    fn add(&self, more: usize) {
        if let Some(bytes) = &mut *self.lock() {
            *bytes += more;
        }
    }

    fn take(&self, less: usize) {
        if let Some(bytes) = &mut *self.lock() {
            *bytes = bytes.saturating_sub(less);
        }
    }
}

/// Size of these entries in memory.
fn size_of_all(entries: &Entries) -> usize {
    let text =
        |(_, entry): &(Instant, LogEntry)| if let LogEntry::Layout(text) = entry { text.len() } else { 0 };
    entries.iter().map(|entry| ENTRY_BYTES + text(entry)).sum()
}

#[cfg(any(feature = "web", test))]
impl MirrorInput {
    /// Sets the layout of the server; the same one again changes nothing.
    pub(super) fn put_layout(&self, text: String) {
        let at = Instant::from_micros(self.counters.now_us.load(Ordering::Relaxed));
        self.hand(vec![(at, LogEntry::Layout(text))]);
    }
}

/// Returns the results of the server's source, in the same order and with the same times.
///
/// Its time is the server's time at the last frame, and advances with this machine's clock while none arrives: a
/// silence is detected here as it is there, whatever the network delay is.
#[derive(Debug)]
pub struct MirrorSource {
    frames: Receiver<Entries>,
    waiting: Waiting,
    stream: MirrorStream,
    /// The server's time at the end of the last frame, and the time of its arrival here.
    arrived: (Instant, HostInstant),
}

impl MirrorSource {
    /// Returns a source for the floor of this greeting, and the input for its frames.
    #[must_use]
    pub fn new(greeting: &Greeting) -> (MirrorInput, Self) {
        let stream = MirrorStream::new(greeting);
        let (sender, frames) = sync_channel(WAITING);
        let waiting = Waiting::default();
        *waiting.lock() = Some(0);
        let input = MirrorInput {
            frames: sender,
            waiting: waiting.clone(),
            decoder: decoder(),
            counters: Arc::clone(&stream.counters),
        };
        let arrived = (stream.now(), HostInstant::now());
        (input, Self { frames, waiting, stream, arrived })
    }

    /// The server's clock, as known here.
    #[must_use]
    pub fn clock(&self) -> HostClock {
        let counters = Arc::clone(&self.stream.counters);
        Arc::new(move || Instant::from_micros(counters.now_us.load(Ordering::Relaxed)))
    }

    /// Returns a counter of the entries missing from the stream, readable from other threads.
    pub fn left_out(&self) -> impl Fn() -> u64 + Send + 'static {
        let counters = Arc::clone(&self.stream.counters);
        move || counters.left_out.load(Ordering::Relaxed)
    }

    /// The next packet; waits for it at most `patience` and returns `None` if none arrived. It never ends by itself,
    /// since a server may come back.
    pub(super) fn next(&mut self, patience: Duration) -> Option<SensorPacket> {
        if self.stream.is_empty() {
            self.wait(patience);
        }
        self.stream.next()
    }

    /// The present on the server's clock, as known here.
    pub(super) const fn now(&self) -> Instant {
        self.stream.now()
    }

    /// Number of invalid frames, as malformed.
    pub(super) fn counters(&self) -> LinkCounters {
        self.stream.link_counters()
    }

    /// Waits for a frame for at most `patience`; without one, advances the time.
    fn wait(&mut self, patience: Duration) {
        match self.frames.recv_timeout(patience) {
            Ok(entries) => {
                self.waiting.take(size_of_all(&entries));
                self.arrived = (self.stream.add(entries), HostInstant::now());
            }
            Err(gone) => {
                if gone == RecvTimeoutError::Disconnected {
                    thread::sleep(patience);
                }
                let (until, at) = self.arrived;
                let silent = at.elapsed();
                if silent > LATE {
                    self.stream.set_now(until + silent);
                }
            }
        }
    }
}

impl Drop for MirrorSource {
    /// Unblocks a sender that waits for room.
    fn drop(&mut self) {
        *self.waiting.lock() = None;
    }
}

impl From<MirrorSource> for FloorInput {
    fn from(source: MirrorSource) -> Self {
        let source = Shared::new(source);
        Self { replay: Some(Box::new(source.clone())), ..Self::from(source) }
    }
}

impl SensorSource for Shared<MirrorSource> {
    fn next(&mut self, patience: Duration) -> Result<Option<SensorPacket>, SourceError> {
        Ok(self.lock().next(patience))
    }

    fn now(&self) -> Instant {
        self.lock().now()
    }

    fn counters(&self) -> LinkCounters {
        self.lock().counters()
    }
}

impl Replay for MirrorSource {
    fn take(&mut self) -> Option<Incoming> {
        self.stream.take()
    }
}
