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

/// Asks the system to let the calling thread go before everybody else's; a thread that already does keeps its place.
///
/// Threads that it starts later inherit this, so that it belongs after them. On
/// Linux it takes `rtprio` in the limits of whoever runs the program; other
/// systems' audio hosts promote their threads by themselves, and nothing is
/// done there.
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

#[cfg(target_os = "linux")]
fn claim(rank: Rank) -> Priority {
    use RealtimeThreadSchedulePolicy::{Fifo, RoundRobin};
    use thread_priority::{
        RealtimeThreadSchedulePolicy, ThreadPriority, ThreadPriorityValue, ThreadSchedulePolicy,
        set_thread_priority_and_policy, thread_native_id, thread_schedule_policy,
    };
    if matches!(thread_schedule_policy(), Ok(ThreadSchedulePolicy::Realtime(Fifo | RoundRobin))) {
        return Priority::RealTime;
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

#[cfg(not(target_os = "linux"))]
fn claim(_: Rank) -> Priority {
    Priority::Hosts
}
