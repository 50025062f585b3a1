//! The stream as a source for a program that may not wait, such as a page in a browser.

use std::sync::atomic::Ordering;
use std::time::Duration;

use super::Greeting;
use super::frame::{self, BadFrame};
use super::stream::{LATE, MirrorStream};
use crate::source::log::{LogEntry, decoder};
use crate::source::{FloorInput, Incoming, Replay, SensorSource, Shared, SourceError};
use crate::units::Instant;
use crate::wire::{Decoder, LinkCounters, SensorPacket};

/// Time that passes at once when the connection ends: longer than that after which a board of any rate counts as lost.
const GONE: Duration = Duration::from_secs(1);

/// The stream of a server, put in and taken out on one thread, with the time of the caller's clock. Clones are handles
/// to the same stream.
///
/// Turn the server on its [`FloorInput`] until [`PolledMirror::has_more`] is false after each frame, and once after
/// [`PolledMirror::pass`] or [`PolledMirror::end`].
#[derive(Clone, Debug)]
pub struct PolledMirror {
    shared: Shared<PolledStream>,
}

#[derive(Debug)]
struct PolledStream {
    stream: MirrorStream,
    decoder: Decoder,
    /// The server's time at the end of the last frame, and the caller's time of its arrival.
    arrived: (Instant, Duration),
}

impl PolledMirror {
    /// Returns the input for a server on the floor of this greeting, which arrived at `now` on the caller's clock.
    #[must_use]
    pub fn new(greeting: &Greeting, now: Duration) -> (Self, FloorInput) {
        let stream = MirrorStream::new(greeting);
        let arrived = (stream.now(), now);
        let shared = Shared::new(PolledStream { stream, decoder: decoder(), arrived });
        let input = FloorInput { replay: Some(Box::new(shared.clone())), ..FloorInput::from(shared.clone()) };
        (Self { shared }, input)
    }

    /// Takes a frame that arrived at `now`.
    ///
    /// # Errors
    /// [`BadFrame`] if the frame is invalid; it is counted, and none of it is used.
    pub fn put(&self, bytes: &[u8], now: Duration) -> Result<(), BadFrame> {
        let polled = &mut *self.shared.lock();
        let entries = frame::read(bytes, &polled.decoder).inspect_err(|_| {
            polled.stream.counters.bad.fetch_add(1, Ordering::Relaxed);
        })?;
        polled.arrived = (polled.stream.add(entries), now);
        Ok(())
    }

    /// Sets the layout of the server; the same one again changes nothing.
    pub fn put_layout(&self, text: String) {
        let stream = &mut self.shared.lock().stream;
        stream.add(vec![(stream.now(), LogEntry::Layout(text))]);
    }

    /// Lets the time pass up to `now` if no frame has arrived for 40 ms, so that a silence is detected here as it is
    /// there, at any delay of the network.
    pub fn pass(&self, now: Duration) {
        self.advance(now, Duration::ZERO);
    }

    /// Ends the stream at `now`: no more frames follow, so that all boards count as lost.
    pub fn end(&self, now: Duration) {
        self.advance(now, GONE);
    }

    fn advance(&self, now: Duration, at_least: Duration) {
        let PolledStream { stream, arrived: (until, at), .. } = &mut *self.shared.lock();
        let silent = now.saturating_sub(*at).max(at_least);
        if silent > LATE && stream.is_empty() {
            stream.set_now(*until + silent);
        }
    }

    /// Whether entries wait for a turn of the server.
    #[must_use]
    pub fn has_more(&self) -> bool {
        !self.shared.lock().stream.is_empty()
    }

    /// The present on the server's clock, as known here.
    #[must_use]
    pub fn now(&self) -> Instant {
        self.shared.lock().stream.now()
    }

    /// The server's time at the end of the last frame.
    #[must_use]
    pub fn arrived(&self) -> Instant {
        self.shared.lock().arrived.0
    }

    /// Number of entries missing from the stream so far.
    #[must_use]
    pub fn left_out(&self) -> u64 {
        self.shared.lock().stream.counters.left_out.load(Ordering::Relaxed)
    }
}

impl SensorSource for Shared<PolledStream> {
    /// Never waits: the next packet that has arrived.
    fn next(&mut self, _patience: Duration) -> Result<Option<SensorPacket>, SourceError> {
        Ok(self.lock().stream.next())
    }

    fn now(&self) -> Instant {
        self.lock().stream.now()
    }

    fn counters(&self) -> LinkCounters {
        self.lock().stream.link_counters()
    }
}

impl Replay for PolledStream {
    fn take(&mut self) -> Option<Incoming> {
        self.stream.take()
    }
}
