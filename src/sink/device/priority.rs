//! Real-time priority of the device's thread.

#![deny(clippy::disallowed_macros, clippy::disallowed_methods, clippy::disallowed_types)]

use std::time::{Duration, Instant};

use crate::feel::Priority;
use crate::sink::{Rank, claim_priority};

/// Asks the system for real-time priority of the calling thread; returns the result.
pub(super) type Ask = fn() -> Priority;

/// Playing time over which a device must keep time before its thread is promoted.
const PROVEN: Duration = Duration::from_millis(100);

/// Promotes the device's thread, from within, once it has been seen to wait between its calls.
///
/// Some devices (ALSA's `null` and `file`) call as fast as they can: with real-time priority such a thread would
/// block all others.
pub(super) struct Promotion {
    ask: Option<Ask>,
    /// Whether the device is known to wait.
    proven: bool,
    begun: Option<Instant>,
    frames: u64,
}

impl Promotion {
    pub(super) fn new(ask: Option<Ask>, proven: bool) -> Self {
        Self { ask, proven, begun: None, frames: 0 }
    }

    /// Called in every callback with its number of frames; returns the result of the request once it is made.
    ///
    /// # Real-time
    /// Asks the system once, some blocks after the start; before that it reads the clock.
    pub(super) fn proceed(
        &mut self,
        frames: usize,
        sample_rate: u32,
        now: impl Fn() -> Instant,
    ) -> Option<Priority> {
        let ask = self.ask?;
        if self.proven {
            self.ask = None;
            return Some(ask());
        }
        let begun = *self.begun.get_or_insert_with(&now);
        self.frames += frames as u64;
        let played = Duration::from_secs_f64(self.frames as f64 / f64::from(sample_rate.max(1)));
        if played < PROVEN {
            return None;
        }
        if now().saturating_duration_since(begun) < played / 2 {
            // The device does not keep time; perhaps it is only filling its buffers.
            if played > 20 * PROVEN {
                self.ask = None;
            }
            return None;
        }
        self.ask = None;
        Some(ask())
    }
}

/// Asks for real-time priority for the calling thread, unless the thread has it already.
pub(super) fn ask_system() -> Priority {
    claim_priority(Rank::Sound)
}

/// Advice about a denied priority, in a sentence for the person who set up the machine.
pub(super) const FIX: &str = "the sound card's thread may not have real-time priority, so clicks may come late or \
    break up when the machine is busy: on Linux, put `@audio - rtprio 95` into /etc/security/limits.d/audio.conf, \
    join the group `audio` and log in again";

#[cfg(test)]
#[expect(clippy::disallowed_methods, reason = "no callback runs here")]
mod tests {
    use std::cell::Cell;

    use super::*;

    fn asked_after(blocks: u32, real_ms_per_block: f64) -> Option<u32> {
        let start = Instant::now();
        let now = Cell::new(start);
        let mut promotion = Promotion::new(Some(|| Priority::RealTime), false);
        // 64 frames at 64 kHz: one millisecond per block.
        for block in 0..blocks {
            now.set(start + Duration::from_secs_f64(f64::from(block) * real_ms_per_block * 1e-3));
            if promotion.proceed(64, 64_000, || now.get()).is_some() {
                return Some(block);
            }
        }
        None
    }

    #[test]
    fn a_device_that_keeps_time_is_promoted_once_and_soon() {
        assert_eq!(asked_after(1000, 1.0), Some(99));
        // A device that fills a tenth of a second of buffer at first.
        assert!(asked_after(1000, 0.8).is_some());
    }

    #[test]
    fn one_that_is_known_to_wait_is_promoted_at_once() {
        let mut promotion = Promotion::new(Some(|| Priority::Denied), true);
        assert_eq!(promotion.proceed(64, 64_000, Instant::now), Some(Priority::Denied));
        assert_eq!(promotion.proceed(64, 64_000, Instant::now), None);
    }

    #[test]
    fn a_device_that_does_not_wait_is_never_promoted() {
        assert_eq!(asked_after(100_000, 0.001), None);
    }
}
