//! Rate limits for repeated notices and for the requests of one sender.

use std::time::Duration;

use crate::units::Instant;

/// A token bucket: a burst at once, then one token per interval.
///
/// Turner's leaky bucket as a virtual schedule (ITU-T I.371, generic cell rate algorithm): a request of `n` tokens
/// passes if `full_at - now <= every * (burst - n)`, and then sets `full_at = max(full_at, now) + every * n`. A
/// limiter stores two numbers and needs no clock.
#[derive(Clone, Copy, Debug)]
pub struct RateLimit {
    every: Duration,
    burst: u32,
    /// Time at which the bucket is full again.
    full_at: Instant,
    /// Number of requests rejected since the last one that passed.
    held_back: u64,
}

impl RateLimit {
    /// At most `burst` (0 counts as 1) at once, and one per `every` in the long run.
    #[must_use]
    pub const fn new(burst: u32, every: Duration) -> Self {
        Self { every, burst, full_at: Instant::START, held_back: 0 }
    }

    /// Takes one token at `now`; returns the number of requests rejected since the last success, or `None` for a
    /// rejection.
    ///
    /// A clock that goes back adds no tokens.
    pub fn take(&mut self, now: Instant) -> Option<u64> {
        self.take_many(now, 1)
    }

    /// Takes `count` tokens at once. More than the burst may be taken when the bucket is full.
    pub fn take_many(&mut self, now: Instant, count: u32) -> Option<u64> {
        let spent = self.full_at.since(now);
        if spent > self.every * self.burst.saturating_sub(count) {
            self.held_back += 1;
            return None;
        }
        self.full_at = self.full_at.max(now) + self.every * count;
        Some(std::mem::take(&mut self.held_back))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_burst_passes_and_then_one_each_so_often_with_the_number_in_between() {
        let mut limit = RateLimit::new(3, Duration::from_secs(10));
        let now = Instant::from_millis(500);
        assert_eq!([(); 5].map(|()| limit.take(now)), [Some(0), Some(0), Some(0), None, None]);
        assert_eq!(limit.take(Instant::from_millis(10_499)), None);
        assert_eq!(limit.take(Instant::from_millis(10_500)), Some(3));
        assert_eq!(limit.take(Instant::from_millis(10_501)), None);
    }

    #[test]
    fn what_costs_more_may_happen_less_often() {
        let mut limit = RateLimit::new(100, Duration::from_millis(1));
        let passed = |limit: &mut RateLimit, ms| limit.take_many(Instant::from_millis(ms), 40).is_some();
        assert_eq!([(); 3].map(|()| passed(&mut limit, 500)), [true, true, false]);
        assert!(!passed(&mut limit, 519) && passed(&mut limit, 520));
        let mut large = RateLimit::new(10, Duration::from_millis(1));
        assert!(large.take_many(Instant::from_millis(500), 1000).is_some());
        assert!(large.take_many(Instant::from_millis(1499), 1000).is_none());
        assert!(large.take_many(Instant::from_millis(1500), 1000).is_some());
    }

    #[test]
    fn in_the_long_run_no_more_pass_than_one_each_so_often() {
        let mut limit = RateLimit::new(10, Duration::from_millis(5));
        let passed = (0..10_000).filter(|&us| limit.take(Instant::from_micros(us * 100)).is_some()).count();
        assert_eq!(passed, 10 + 1_000_000 / 5_000 - 1);
    }

    #[test]
    fn a_limit_of_nothing_at_once_lets_one_pass() {
        let mut limit = RateLimit::new(0, Duration::from_secs(1));
        assert_eq!([limit.take(Instant::START), limit.take(Instant::START)], [Some(0), None]);
    }
}
