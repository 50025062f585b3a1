use std::time::{Duration, Instant};

use crate::feel::Priority;

/// Asks the system to let the calling thread go before everybody else's; what came of it.
pub(super) type Ask = fn() -> Priority;

/// How long a device must be seen to keep time before its thread is promoted.
const PROVEN: Duration = Duration::from_millis(100);

/// Promotes the device's thread, from within, once it has proven that it waits between its calls.
///
/// Some devices (ALSA's `null` and `file`) call as fast as they can: with
/// real-time priority such a thread would take the machine from everybody.
pub(super) struct Promotion {
    ask: Option<Ask>,
    begun: Option<Instant>,
    frames: u64,
}

impl Promotion {
    pub(super) fn new(ask: Option<Ask>) -> Self {
        Self { ask, begun: None, frames: 0 }
    }

    /// To be called in every callback, with the frames it is asked for; gives the answer when there is one.
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
        let begun = *self.begun.get_or_insert_with(&now);
        self.frames += frames as u64;
        let played = Duration::from_secs_f64(self.frames as f64 / f64::from(sample_rate.max(1)));
        if played < PROVEN {
            return None;
        }
        if now().saturating_duration_since(begun) < played / 2 {
            // It does not keep time. Perhaps it was only filling its buffers.
            if played > 20 * PROVEN {
                self.ask = None;
            }
            return None;
        }
        self.ask = None;
        Some(ask())
    }
}

/// Above the sensing thread, below what JACK and the kernel reserve for themselves.
#[cfg(target_os = "linux")]
const AUDIO_PRIORITY: u8 = 60;

/// Asks for real-time priority for the calling thread, unless it has it already.
///
/// Other systems' hosts promote their threads by themselves.
#[cfg(target_os = "linux")]
pub(super) fn ask_system() -> Priority {
    ask_for(AUDIO_PRIORITY)
}

#[cfg(target_os = "linux")]
fn ask_for(priority: u8) -> Priority {
    use thread_priority::{
        RealtimeThreadSchedulePolicy, ThreadPriority, ThreadPriorityValue, ThreadSchedulePolicy,
        set_thread_priority_and_policy, thread_native_id, thread_schedule_policy,
    };
    let realtime = |policy| {
        matches!(
            policy,
            ThreadSchedulePolicy::Realtime(
                RealtimeThreadSchedulePolicy::Fifo | RealtimeThreadSchedulePolicy::RoundRobin
            )
        )
    };
    if thread_schedule_policy().is_ok_and(realtime) {
        return Priority::RealTime;
    }
    let Ok(value) = ThreadPriorityValue::try_from(priority) else { return Priority::Denied };
    let policy = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo);
    match set_thread_priority_and_policy(thread_native_id(), ThreadPriority::Crossplatform(value), policy) {
        Ok(()) => Priority::RealTime,
        Err(_) => Priority::Denied,
    }
}

/// Other systems' hosts promote their threads by themselves.
#[cfg(not(target_os = "linux"))]
pub(super) fn ask_system() -> Priority {
    Priority::Hosts
}

/// What to do about a denied priority, in a sentence for whoever set the machine up.
pub(super) const FIX: &str = "the sound card's thread may not have real-time priority, so clicks may come late or \
    break up when the machine is busy: on Linux, put `@audio - rtprio 95` into /etc/security/limits.d/audio.conf, \
    join the group `audio` and log in again";

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    fn asked_after(blocks: u32, real_ms_per_block: f64) -> Option<u32> {
        let start = Instant::now();
        let now = Cell::new(start);
        let mut promotion = Promotion::new(Some(|| Priority::RealTime));
        // 64 frames at 64 kHz: a millisecond a block.
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
        // One that fills a tenth of a second of buffer at first.
        assert!(asked_after(1000, 0.8).is_some());
    }

    #[test]
    fn a_device_that_does_not_wait_is_never_promoted() {
        assert_eq!(asked_after(100_000, 0.001), None);
    }
}
