//! The time of a floor that nobody waits for.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use underfoot::units::Instant;
use underfoot_sim::{Foot, FootDriver, Host};

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

/// The time of a floor that runs from millisecond to millisecond: the end of the millisecond that its driver was asked
/// for last.
#[derive(Clone, Debug, Default)]
pub(crate) struct Ticks(Arc<AtomicU64>);

impl Ticks {
    /// Wraps `driver` unchanged, and returns the time of its floor.
    pub(crate) fn of(driver: Box<dyn FootDriver>) -> (Self, Box<dyn FootDriver>) {
        let ticks = Self::default();
        (ticks.clone(), Box::new(Ticked { driver, ticks }))
    }

    /// The time simulated so far.
    pub(crate) fn done(&self) -> Duration {
        Duration::from_micros(self.0.load(Ordering::Relaxed))
    }
}

struct Ticked {
    driver: Box<dyn FootDriver>,
    ticks: Ticks,
}

impl FootDriver for Ticked {
    fn feet(&mut self, at: Instant, feet: &mut Vec<Foot>) -> bool {
        self.ticks.0.store(at.micros() + 1000, Ordering::Relaxed);
        self.driver.feet(at, feet)
    }
}

fn micros(length: Duration) -> u64 {
    u64::try_from(length.as_micros()).unwrap_or(u64::MAX)
}
