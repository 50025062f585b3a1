//! Real-time priority that a thread gives up while it takes a whole processor.
//!
//! Threads of real-time priority go before all others. One that cannot keep up with its input never sleeps, and takes
//! its processor from the window, the network and the programs of others; Linux leaves those 50 ms of each second.

use std::time::{Duration, Instant};

use super::priority::{Rank, claim_priority, leave_priority};
use crate::feel::Priority;
use crate::parallel::on_each_thread;

/// Time between two looks at the load.
const LOOK_EVERY: Duration = Duration::from_millis(250);

/// Least part of the time for which a thread that keeps up sleeps.
const SLEEPS: f64 = 0.05;

/// Part of the time for which a thread sleeps that may have its priority back.
const RESTED: f64 = 0.25;

/// Number of looks in a row at which it is rested, until it gets its priority back: 5 s.
const RESTED_LOOKS: u32 = 20;

/// The real-time priority of one thread, which looks at its own load several times a second.
///
/// Where the system does not report the load of a thread (other than Linux), the thread keeps its priority.
#[derive(Debug)]
pub struct RealTime {
    rank: Rank,
    /// Whether the thread has the priority now; `None` if the system never gave it.
    is_held: Option<bool>,
    last: Option<(Instant, Duration)>,
    rested: u32,
    given_up: u64,
}

impl RealTime {
    /// Asks for real-time priority of the calling thread, as [`claim_priority`] does, and of the threads of its pool, if
    /// it is on one.
    #[must_use]
    pub fn claim(rank: Rank) -> Self {
        on_each_thread(|| _ = claim_priority(rank));
        let is_held = (claim_priority(rank) == Priority::RealTime).then_some(true);
        Self { rank, is_held, last: None, rested: 0, given_up: 0 }
    }

    /// Gives the priority up if the calling thread, which must be the one that claimed it, has hardly slept since the
    /// last look; claims it again after the thread has had spare time for 5 s. The threads of its pool, if it is on
    /// one, follow. Does nothing for 250 ms after a look, so it may be called at any rate.
    pub fn look(&mut self) {
        let now = Instant::now();
        let is_due = self.last.is_none_or(|(last, _)| now.duration_since(last) >= LOOK_EVERY);
        if self.is_held.is_none() || !is_due {
            return;
        }
        let Some(awake) = awake() else { return };
        if let Some((last, awake_before)) = self.last.replace((now, awake)) {
            let part =
                awake.saturating_sub(awake_before).as_secs_f64() / now.duration_since(last).as_secs_f64();
            match self.judge(1.0 - part) {
                Some(true) => {
                    on_each_thread(|| _ = claim_priority(self.rank));
                    tracing::info!("a thread that keeps up again has its real-time priority back");
                }
                Some(false) => {
                    on_each_thread(leave_priority);
                    tracing::warn!(
                        "the machine is too slow for this floor: a thread that takes a whole processor gives up its \
                         real-time priority, so that other programs run; `underfoot capacity` measures the limit"
                    );
                }
                None => {}
            }
        }
    }

    /// Returns how often the thread has given up its priority.
    #[must_use]
    pub fn given_up(&self) -> u64 {
        self.given_up
    }

    /// Returns whether the priority changes, and whether the thread has it then, after it slept for this part of the
    /// time.
    fn judge(&mut self, asleep: f64) -> Option<bool> {
        match self.is_held? {
            true if asleep < SLEEPS => {
                self.given_up += 1;
                self.rested = 0;
                self.is_held = Some(false);
            }
            true => return None,
            false => {
                self.rested = if asleep >= RESTED { self.rested + 1 } else { 0 };
                if self.rested < RESTED_LOOKS {
                    return None;
                }
                self.is_held = Some(true);
            }
        }
        self.is_held
    }
}

/// Time for which the calling thread ran or was ready to run, `None` where the system does not report it.
///
/// # Source
/// Documentation/scheduler/sched-stats.rst of Linux: `/proc/<pid>/schedstat` holds the time on the processor, the time
/// of waiting for it, both in nanoseconds, and a number of time slices.
fn awake() -> Option<Duration> {
    if !cfg!(target_os = "linux") {
        return None;
    }
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let mut numbers = text.split_ascii_whitespace().map_while(|number| number.parse::<u64>().ok());
    let (ran, waited) = (numbers.next()?, numbers.next()?);
    Some(Duration::from_nanos(ran.saturating_add(waited)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn held() -> RealTime {
        RealTime { rank: Rank::Sensing, is_held: Some(true), last: None, rested: 0, given_up: 0 }
    }

    #[test]
    fn a_thread_that_never_sleeps_gives_its_priority_up_and_gets_it_back_when_it_keeps_up() {
        let mut realtime = held();
        assert_eq!(realtime.judge(0.3), None, "it keeps up");
        assert_eq!(realtime.judge(0.01), Some(false));
        assert_eq!(realtime.judge(0.01), None, "it has none to give up");
        // Nearly 5 s of rest, and one breathless moment: the time starts again.
        (1..RESTED_LOOKS).for_each(|_| assert_eq!(realtime.judge(0.5), None));
        assert_eq!(realtime.judge(0.1), None);
        (1..RESTED_LOOKS).for_each(|_| assert_eq!(realtime.judge(0.5), None));
        assert_eq!(realtime.judge(0.5), Some(true));
        assert_eq!(realtime.given_up(), 1);
        assert_eq!(realtime.judge(0.0), Some(false), "again");
        assert_eq!(realtime.given_up(), 2);
    }

    #[test]
    fn a_thread_that_was_denied_the_priority_has_none_to_give_up() {
        let mut realtime = RealTime { is_held: None, ..held() };
        assert_eq!(realtime.judge(0.0), None);
        assert_eq!(realtime.given_up(), 0);
    }

    // R11
    #[cfg(target_os = "linux")]
    #[test]
    fn a_thread_that_takes_a_whole_processor_runs_as_others_do_after_a_look_or_two() {
        use thread_priority::{ThreadSchedulePolicy, thread_schedule_policy};
        // A thread of its own, so that the priority ends with it.
        let thread = std::thread::spawn(|| {
            let mut realtime = RealTime::claim(Rank::Sensing);
            let is_granted = realtime.is_held.is_some();
            let start = Instant::now();
            while realtime.given_up() == 0 && start.elapsed() < Duration::from_secs(5) {
                realtime.look();
            }
            (is_granted, realtime.given_up(), thread_schedule_policy().unwrap())
        });
        let (is_granted, given_up, policy) = thread.join().unwrap();
        // Without the right to the priority there is none to give up.
        assert_eq!(given_up, u64::from(is_granted && awake().is_some()));
        assert!(matches!(policy, ThreadSchedulePolicy::Normal(_)), "{policy:?}");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn the_system_tells_sleep_from_work() {
        let Some(before) = awake() else { return };
        let start = Instant::now();
        std::thread::sleep(Duration::from_millis(200));
        let asleep = awake().unwrap() - before;
        assert!(asleep < Duration::from_millis(100), "asleep: {asleep:?} of {:?}", start.elapsed());
        let before = awake().unwrap();
        let start = Instant::now();
        while start.elapsed() < Duration::from_millis(200) {
            std::hint::spin_loop();
        }
        let at_work = awake().unwrap() - before;
        assert!(at_work > Duration::from_millis(150), "at work: {at_work:?} of {:?}", start.elapsed());
    }
}
