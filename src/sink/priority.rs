//! Real-time priority of threads that a foot waits for.

use crate::feel::Priority;

/// Who goes before whom among the threads that a foot waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rank {
    /// The sound card's callback: it must never wait.
    Sound,
    /// Whoever takes packets and decides what they mean; also whoever stands in for the boards.
    Sensing,
    /// Whoever tells another computer what was sensed, which gives it up for lost otherwise.
    Telling,
}

/// Asks the system to run the calling thread before others; a thread that has real-time priority keeps it.
///
/// On Linux threads that it starts later inherit this, so that it belongs after them, and it takes `rtprio` in the
/// limits of the user. On macOS and Windows no privilege is needed; the sound card's callback is promoted there by the
/// audio host and left alone.
pub fn claim_priority(rank: Rank) -> Priority {
    claim(rank)
}

/// Lets the calling thread go after everybody else's: it works while nobody else has anything to do. Where the system
/// knows no such order (it is asked on Linux only), nothing is done.
pub fn step_back() {
    #[cfg(target_os = "linux")]
    {
        use thread_priority::{
            NormalThreadSchedulePolicy, ThreadPriority, ThreadSchedulePolicy, set_thread_priority_and_policy,
            thread_native_id,
        };
        let idle = ThreadSchedulePolicy::Normal(NormalThreadSchedulePolicy::Idle);
        if let Err(error) = set_thread_priority_and_policy(thread_native_id(), ThreadPriority::Min, idle) {
            tracing::debug!("a thread that should go after others goes beside them: {error:?}");
        }
    }
}

#[cfg(unix)]
fn claim(rank: Rank) -> Priority {
    use RealtimeThreadSchedulePolicy::{Fifo, RoundRobin};
    use thread_priority::{
        RealtimeThreadSchedulePolicy, ThreadPriority, ThreadPriorityValue, ThreadSchedulePolicy,
        set_thread_priority_and_policy, thread_native_id, thread_schedule_policy,
    };
    if matches!(thread_schedule_policy(), Ok(ThreadSchedulePolicy::Realtime(Fifo | RoundRobin))) {
        return Priority::RealTime;
    }
    if cfg!(target_os = "macos") && rank == Rank::Sound {
        return Priority::Hosts;
    }
    // Interrupts of a real-time kernel are at 50: samples go before them, packets come out of them.
    let value: u8 = match rank {
        Rank::Sound => 60,
        Rank::Sensing => 40,
        Rank::Telling => 35,
    };
    let Ok(value) = ThreadPriorityValue::try_from(value) else { return Priority::Denied };
    let policy = ThreadSchedulePolicy::Realtime(Fifo);
    match set_thread_priority_and_policy(thread_native_id(), ThreadPriority::Crossplatform(value), policy) {
        Ok(()) => Priority::RealTime,
        Err(_) => Priority::Denied,
    }
}

#[cfg(windows)]
fn claim(rank: Rank) -> Priority {
    use thread_priority::{ThreadPriority, WinAPIThreadPriority, set_current_thread_priority};
    if rank == Rank::Sound {
        return Priority::Hosts;
    }
    match set_current_thread_priority(ThreadPriority::Os(WinAPIThreadPriority::TimeCritical.into())) {
        Ok(()) => Priority::RealTime,
        Err(_) => Priority::Denied,
    }
}

#[cfg(not(any(unix, windows)))]
fn claim(_: Rank) -> Priority {
    Priority::Hosts
}
