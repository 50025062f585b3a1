//! Real-time priority of the threads in the signal path.

use crate::feel::Priority;

/// Priority order of the threads in the signal path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rank {
    /// The sound card's callback: it must never wait.
    Sound,
    /// The thread that reads and evaluates packets; also a thread that simulates boards.
    Sensing,
    /// The thread that reports to another computer, which would otherwise count this one as lost.
    Telling,
}

/// Asks the system for real-time priority of the calling thread; a thread that has it keeps it.
///
/// On Linux, threads that it starts later inherit the priority, so start them first; `rtprio` in the limits of the
/// user is required. On macOS and Windows no privilege is needed; there the audio host promotes the sound card's
/// callback, and this function leaves it alone.
pub fn claim_priority(rank: Rank) -> Priority {
    claim(rank)
}

/// Gives the calling thread the lowest priority: it runs while no other thread is ready. It does nothing on systems
/// without such a priority (supported on Linux only).
pub fn step_back() {
    #[cfg(target_os = "linux")]
    set_ordinary(thread_priority::NormalThreadSchedulePolicy::Idle, thread_priority::ThreadPriority::Min);
}

/// Gives the calling thread the priority of ordinary threads again (Linux only).
pub(super) fn leave_priority() {
    #[cfg(target_os = "linux")]
    if let Ok(niceness_0) = thread_priority::ThreadPriorityValue::try_from(49) {
        let priority = thread_priority::ThreadPriority::Crossplatform(niceness_0);
        set_ordinary(thread_priority::NormalThreadSchedulePolicy::Other, priority);
    }
}

#[cfg(target_os = "linux")]
fn set_ordinary(
    policy: thread_priority::NormalThreadSchedulePolicy,
    priority: thread_priority::ThreadPriority,
) {
    use thread_priority::{ThreadSchedulePolicy, set_thread_priority_and_policy, thread_native_id};
    let policy = ThreadSchedulePolicy::Normal(policy);
    if let Err(error) = set_thread_priority_and_policy(thread_native_id(), priority, policy) {
        tracing::debug!("the system refuses {policy:?} to a thread: {error:?}");
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
    // Interrupts of a real-time kernel run at 50: the audio thread runs above them, and sensing below, since
    // interrupts deliver its packets.
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
