//! How a replay is led while it goes on: pauses, speed, haste.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use super::Speed;
use crate::units::Instant;

/// Leads a replay from elsewhere; shared with its [`super::ReplaySource`].
///
/// A pause holds the recording's time still. It changes nothing of what follows: the events are the same, to the bit.
#[derive(Debug)]
pub struct Transport {
    is_paused: AtomicBool,
    /// The bits of a number; infinite for as fast as can be.
    speed: AtomicU64,
    hurries_to_us: AtomicU64,
    stays: AtomicBool,
    /// Counts what was asked for.
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

    /// Holds the replay still, or lets it go on.
    pub fn set_paused(&self, is_paused: bool) {
        self.is_paused.store(is_paused, Ordering::Relaxed);
        self.note();
    }

    /// Whether it is held still.
    #[must_use]
    pub fn is_paused(&self) -> bool {
        self.is_paused.load(Ordering::Relaxed)
    }

    /// Plays so fast from now on.
    pub fn set_speed(&self, speed: Speed) {
        let times = match speed {
            Speed::Times(times) if times > 0.0 => times,
            Speed::Times(_) | Speed::Max => f64::INFINITY,
        };
        self.speed.store(times.to_bits(), Ordering::Relaxed);
        self.note();
    }

    /// How fast it is played.
    #[must_use]
    pub fn speed(&self) -> Speed {
        let times = f64::from_bits(self.speed.load(Ordering::Relaxed));
        if times.is_finite() { Speed::Times(times) } else { Speed::Max }
    }

    /// Goes as fast as can be until the recording's time is `to`, paused or not; a time that is past changes nothing.
    pub fn hurry_to(&self, to: Instant) {
        self.hurries_to_us.store(to.micros(), Ordering::Relaxed);
        self.note();
    }

    /// Stays at the last moment of the recording, as if it were paused there, instead of ending; for whoever wants to
    /// look at it for longer.
    pub fn stay_at_the_end(&self) {
        self.stays.store(true, Ordering::Relaxed);
    }

    pub(super) fn stays(&self) -> bool {
        self.stays.load(Ordering::Relaxed)
    }

    /// Whether it must be at `to` without waiting.
    pub(super) fn hurries(&self, to: Instant) -> bool {
        to.micros() < self.hurries_to_us.load(Ordering::Relaxed)
    }

    /// A number that changes whenever somebody asks for something else.
    pub(super) fn changes(&self) -> u64 {
        self.changes.load(Ordering::Acquire)
    }

    fn note(&self) {
        self.changes.fetch_add(1, Ordering::Release);
    }
}
