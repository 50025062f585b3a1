//! The time of a floor that nobody waits for.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use underfoot_sim::Host;

/// The host of a simulated floor in a page, where no thread may sleep: a wait moves this clock on at once, and the
/// caller advances the floor only while this clock is behind the time of the page.
#[derive(Debug, Default)]
pub struct PageClock(AtomicU64);

impl PageClock {
    /// Sets the time, unless it is later already.
    pub fn set(&self, to: Duration) {
        self.0.fetch_max(micros(to), Ordering::Relaxed);
    }
}

impl Host for PageClock {
    fn elapsed(&self) -> Duration {
        Duration::from_micros(self.0.load(Ordering::Relaxed))
    }

    fn sleep(&self, length: Duration) {
        self.0.fetch_add(micros(length), Ordering::Relaxed);
    }
}

fn micros(length: Duration) -> u64 {
    u64::try_from(length.as_micros()).unwrap_or(u64::MAX)
}
