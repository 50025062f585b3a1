//! Code on the device's own thread: it must not allocate, lock, log or wait (clippy.toml).

#![deny(clippy::disallowed_macros, clippy::disallowed_methods, clippy::disallowed_types)]

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, AtomicU32, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use cpal::{Error, ErrorKind, FromSample, SizedSample};
use rtrb::{Consumer, Producer, RingBuffer};

use super::choice::DeviceConfig;
use super::player::DevicePlayer;
use super::priority::Promotion;
use crate::feel::Priority;

/// Maximum number of errors in the queue; those after the first ones are consequences.
const REPORTS: usize = 16;

/// Counts of the callbacks, for the supervisor.
#[derive(Debug, Default)]
pub(super) struct CallbackStats {
    pub(super) blocks: AtomicU64,
    pub(super) underruns: AtomicU64,
    /// Frames of the last block.
    pub(super) frames: AtomicU32,
    priority: AtomicU8,
}

impl CallbackStats {
    pub(super) fn priority(&self) -> Priority {
        match self.priority.load(Ordering::Relaxed) {
            1 => Priority::RealTime,
            2 => Priority::Denied,
            _ => Priority::Hosts,
        }
    }

    pub(super) fn set_priority(&self, priority: Priority) {
        let number = match priority {
            Priority::Hosts => 0,
            Priority::RealTime => 1,
            Priority::Denied => 2,
        };
        self.priority.store(number, Ordering::Relaxed);
    }
}

/// Returns the player to the supervisor.
#[expect(clippy::disallowed_types, reason = "gone only when the device has let go")]
type Home = std::sync::mpsc::Sender<DevicePlayer>;

/// The callback that a device calls for samples.
///
/// When the device drops it, it returns the player to the supervisor for another stream.
pub(super) struct Callback {
    /// `None` only while being dropped.
    player: Option<DevicePlayer>,
    home: Home,
    stats: Arc<CallbackStats>,
    promotion: Promotion,
    channels: usize,
    sample_rate: u32,
    /// Whether cues that waited for the first block are too old to be played.
    forgets: bool,
}

impl Callback {
    pub(super) fn new(
        player: DevicePlayer,
        choice: DeviceConfig,
        home: Home,
        stats: Arc<CallbackStats>,
        promotion: Promotion,
    ) -> Self {
        Self {
            player: Some(player),
            home,
            stats,
            promotion,
            channels: usize::from(choice.channels).max(1),
            sample_rate: choice.sample_rate,
            forgets: false,
        }
    }

    /// Discards the cues that wait for the first block: a device that was away may take seconds to open and to ask
    /// for its first block.
    pub(super) fn forgetting(mut self) -> Self {
        self.forgets = true;
        self
    }

    /// Fills a block whose first sample sounds after `sounds_in`, which is zero if unknown.
    ///
    /// # Real-time
    /// Asks the system for priority once, soon after the start; otherwise no allocation, lock or system call.
    #[expect(
        clippy::disallowed_methods,
        reason = "the clock is read, without a lock, until priority is settled"
    )]
    pub(super) fn run<T: SizedSample + FromSample<f32>>(&mut self, out: &mut [T], sounds_in: Duration) {
        let frames = out.len() / self.channels;
        if let Some(player) = &mut self.player {
            if std::mem::take(&mut self.forgets) {
                player.restart();
            }
            player.fill(out, sounds_in);
        }
        self.stats.frames.store(frames as u32, Ordering::Relaxed);
        self.stats.blocks.fetch_add(1, Ordering::Relaxed);
        if let Some(priority) = self.promotion.proceed(frames, self.sample_rate, Instant::now) {
            self.stats.set_priority(priority);
        }
    }
}

impl Drop for Callback {
    fn drop(&mut self) {
        if let Some(player) = self.player.take() {
            // At the end of the program there is no receiver.
            #[expect(
                clippy::disallowed_methods,
                reason = "the device has let go: it asks for no more samples"
            )]
            let _ = self.home.send(player);
        }
    }
}

/// The error callback of a device; it may run where locks and allocation are forbidden.
pub(super) struct ErrorForwarder {
    stats: Arc<CallbackStats>,
    reports: Producer<Error>,
}

impl ErrorForwarder {
    /// A forwarder, and the receiver of the errors that are more than a late sample.
    pub(super) fn new(stats: Arc<CallbackStats>) -> (Self, Consumer<Error>) {
        let (reports, heard) = RingBuffer::new(REPORTS);
        (Self { stats, reports }, heard)
    }

    pub(super) fn hear(&mut self, error: Error) {
        match error.kind() {
            ErrorKind::Xrun => {
                self.stats.underruns.fetch_add(1, Ordering::Relaxed);
            }
            ErrorKind::RealtimeDenied => self.stats.set_priority(Priority::Denied),
            // If there are too many, the first ones show the cause.
            _ => drop(self.reports.push(error)),
        }
    }
}
