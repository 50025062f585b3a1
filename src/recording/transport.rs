//! Control of a running replay: pause, speed, and fast-forward.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use super::Speed;
use crate::units::Instant;

/// Controls a replay from other threads; shared with its [`super::ReplaySource`].
///
/// A pause stops the recording's time. It does not affect the rest: the events are the same, bit for bit.
#[derive(Debug)]
pub struct Transport {
    is_paused: AtomicBool,
    /// The bits of a float; infinite for the maximum speed.
    speed: AtomicU64,
    hurries_to_us: AtomicU64,
    stays: AtomicBool,
    /// Number of changes so far.
    changes: AtomicU64,
}

impl Transport {
    pub(super) fn new(speed: Speed) -> Self {
        let transport = Self {
            is_paused: AtomicBool::new(false),
            speed: AtomicU64::default(),
            hurries_to_us: AtomicU64::new(0),
            stays: AtomicBool::new(false),
            changes: AtomicU64::new(0),
        };
        transport.set_speed(speed);
        transport
    }

    /// Pauses or resumes the replay.
    pub fn set_paused(&self, is_paused: bool) {
        self.is_paused.store(is_paused, Ordering::Relaxed);
        self.note();
    }

    /// Whether the replay is paused.
    #[must_use]
    pub fn is_paused(&self) -> bool {
        self.is_paused.load(Ordering::Relaxed)
    }

    /// Sets the speed from now on.
    pub fn set_speed(&self, speed: Speed) {
        let times = match speed {
            Speed::Times(times) if times > 0.0 => times,
            Speed::Times(_) | Speed::Max => f64::INFINITY,
        };
        self.speed.store(times.to_bits(), Ordering::Relaxed);
        self.note();
    }

    /// The current speed.
    #[must_use]
    pub fn speed(&self) -> Speed {
        let times = f64::from_bits(self.speed.load(Ordering::Relaxed));
        if times.is_finite() { Speed::Times(times) } else { Speed::Max }
    }

    /// Replays at maximum speed up to the recording's time `to`, paused or not; does nothing if that time is past.
    pub fn hurry_to(&self, to: Instant) {
        self.hurries_to_us.store(to.micros(), Ordering::Relaxed);
        self.note();
    }

    /// Stays at the last moment of the recording, as if it were paused there, instead of ending; for viewers that
    /// show it for longer.
    pub fn stay_at_the_end(&self) {
        self.stays.store(true, Ordering::Relaxed);
    }

    pub(super) fn stays(&self) -> bool {
        self.stays.load(Ordering::Relaxed)
    }

    /// Whether to replay up to `to` without waiting.
    pub(super) fn hurries(&self, to: Instant) -> bool {
        to.micros() < self.hurries_to_us.load(Ordering::Relaxed)
    }

    /// A number that increases with every change.
    pub(super) fn changes(&self) -> u64 {
        self.changes.load(Ordering::Acquire)
    }

    fn note(&self) {
        self.changes.fetch_add(1, Ordering::Release);
    }
}
