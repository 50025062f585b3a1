//! The clock of a floor that is simulated in real time.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::Duration;

use underfoot::units::{HostClock, Instant};

/// Maximum delay that the floor catches up; the rest of a longer delay does not pass on the floor. It is well within
/// the 100 ms after which a silent board counts as lost, and a press that is 50 ms late does not feel late.
pub(super) const CATCH_UP: Duration = Duration::from_millis(50);

/// The host of a simulated floor: its elapsed time, and a way to wait. Tests bring their own and set its time.
pub trait Host: Send + Sync {
    /// Time since some fixed moment; never goes back.
    fn elapsed(&self) -> Duration;

    /// Waits at least this long.
    fn sleep(&self, length: Duration);
}

/// The monotonic clock of this machine.
#[derive(Debug)]
pub(super) struct MachineClock(pub(super) std::time::Instant);

impl Host for MachineClock {
    fn elapsed(&self) -> Duration {
        self.0.elapsed()
    }

    fn sleep(&self, length: Duration) {
        thread::sleep(length);
    }
}

/// A clock that runs with the host's clock and stands still while the simulation does.
///
/// It is never more than [`CATCH_UP`] ahead of the last simulated millisecond: a thread that gets no processor for a
/// second does not make the floor silent for a second, since no time passes on the floor. Clones share the same
/// clock. Reading it takes no lock.
#[derive(Clone)]
pub(super) struct FloorClock {
    host: Arc<dyn Host>,
    state: Arc<State>,
}

#[derive(Debug, Default)]
struct State {
    /// The host's microseconds in which the floor's time stood still; before the first packet, the maximum.
    paused_us: AtomicU64,
    /// Microseconds by which the simulation has overtaken the host's clock.
    ahead_us: AtomicU64,
    /// The floor's time at the end of the simulation so far, in microseconds.
    simulated_us: AtomicU64,
}

impl FloorClock {
    pub(super) fn new(host: Arc<dyn Host>) -> Self {
        let state = State { paused_us: AtomicU64::new(u64::MAX), ..State::default() };
        Self { host, state: Arc::new(state) }
    }

    /// Starts the clock at the first request for a packet.
    pub(super) fn start(&self) {
        let now = micros(self.host.elapsed());
        let _ = self.state.paused_us.compare_exchange(u64::MAX, now, Ordering::Release, Ordering::Relaxed);
    }

    /// The present moment of the floor.
    pub(super) fn now(&self) -> Instant {
        // In this order: a reader that sees the later of two simulated moments also sees the pause before it.
        let simulated = self.state.simulated_us.load(Ordering::Acquire);
        let paused = self.state.paused_us.load(Ordering::Acquire);
        let ahead = self.state.ahead_us.load(Ordering::Acquire);
        let running = micros(self.host.elapsed()).saturating_sub(paused).saturating_add(ahead);
        Instant::from_micros(running.min(simulated.saturating_add(micros(CATCH_UP))))
    }

    /// Records that the floor is simulated up to `at`; the part of the host's lead beyond [`CATCH_UP`] becomes a
    /// pause. A floor that is simulated ahead of the clock moves the clock on.
    pub(super) fn simulated(&self, at: Instant) {
        let paused = self.state.paused_us.load(Ordering::Relaxed);
        let ahead = self.state.ahead_us.load(Ordering::Relaxed);
        let running = micros(self.host.elapsed()).saturating_sub(paused).saturating_add(ahead);
        let excess = running.saturating_sub(at.micros().saturating_add(micros(CATCH_UP)));
        self.state.paused_us.store(paused.saturating_add(excess), Ordering::Release);
        let lead = at.micros().saturating_sub(running);
        self.state.ahead_us.store(ahead.saturating_add(lead), Ordering::Release);
        self.state.simulated_us.store(at.micros(), Ordering::Release);
    }

    pub(super) fn sleep(&self, length: Duration) {
        self.host.sleep(length);
    }

    /// A handle to the same clock, for other threads.
    pub(super) fn shared(&self) -> HostClock {
        let clock = self.clone();
        Arc::new(move || clock.now())
    }
}

fn micros(length: Duration) -> u64 {
    u64::try_from(length.as_micros()).unwrap_or(u64::MAX)
}

#[cfg(test)]
pub(crate) mod tests {
    use std::sync::Mutex;

    use super::*;

    /// A host whose time tests set; `sleep` advances it.
    #[derive(Clone, Debug, Default)]
    pub(crate) struct ByHand(Arc<Mutex<Duration>>);

    impl ByHand {
        pub(crate) fn pass(&self, length: Duration) {
            *self.0.lock().unwrap() += length;
        }
    }

    impl Host for ByHand {
        fn elapsed(&self) -> Duration {
            *self.0.lock().unwrap()
        }

        fn sleep(&self, length: Duration) {
            self.pass(length);
        }
    }

    #[test]
    fn no_time_passes_on_a_floor_that_nobody_simulates() {
        let host = ByHand::default();
        let clock = FloorClock::new(Arc::new(host.clone()));
        host.pass(Duration::from_secs(9));
        assert_eq!(clock.now(), Instant::START, "it stands still until it is started");
        clock.start();
        host.pass(Duration::from_millis(40));
        assert_eq!(clock.now(), Instant::from_millis(40));
        clock.simulated(Instant::from_millis(40));
        host.pass(Duration::from_secs(5));
        assert_eq!(clock.now(), Instant::from_millis(90));
        clock.simulated(Instant::from_millis(41));
        assert_eq!(clock.now(), Instant::from_millis(91), "what could not be caught up has never been");
        (42..=90).for_each(|ms| clock.simulated(Instant::from_millis(ms)));
        host.pass(Duration::from_millis(10));
        assert_eq!(clock.now(), Instant::from_millis(101), "it runs on with the host");
    }

    #[test]
    fn a_floor_that_is_simulated_ahead_moves_the_clock_on() {
        let host = ByHand::default();
        let clock = FloorClock::new(Arc::new(host.clone()));
        clock.start();
        host.pass(Duration::from_millis(10));
        clock.simulated(Instant::from_millis(9000));
        assert_eq!(clock.now(), Instant::from_millis(9000));
        host.pass(Duration::from_millis(7));
        assert_eq!(clock.now(), Instant::from_millis(9007), "it runs on from there");
    }

    #[test]
    fn it_never_goes_back() {
        let host = ByHand::default();
        let clock = FloorClock::new(Arc::new(host.clone()));
        clock.start();
        let (mut last, mut simulated) = (clock.now(), Instant::START);
        for step in 0..2000_u64 {
            host.pass(Duration::from_micros(step * step * 7919 % 130_000));
            for is_asked in [false, true] {
                if is_asked {
                    simulated = simulated.max(last.before(Duration::from_micros(step * 31 % 60_000)));
                    clock.simulated(simulated);
                }
                assert!(clock.now() >= last, "{step}");
                last = clock.now();
            }
        }
    }
}
