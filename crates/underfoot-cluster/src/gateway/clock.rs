//! The offset between a node's clock and the gateway's.
//!
//! ```text
//! gateway  g0 ........................ g3      node = gateway + offset
//!            \                        /        offset within half a round trip of ((n1 - g0) + (n2 - g3)) / 2,
//! node        n1 ................. n2          round trip = (g3 - g0) - (n2 - n1), however it divides
//! ```

use std::collections::VecDeque;
use std::time::Duration;

use underfoot::units::Instant;

use crate::auth::Echo;

/// Time for which a round trip counts. A longer one finds faster round trips; clocks drift by at most 0.5 ms in this
/// time.
const WINDOW: Duration = Duration::from_secs(5);

/// Greatest relative rate between two clocks: quartz oscillators are off by 50 ppm each at most.
const DRIFT: f64 = 1e-4;

/// Greatest number of round trips kept: one gateway makes twenty a second.
const KEPT: usize = 128;

/// The estimate from one round trip.
#[derive(Clone, Copy, Debug)]
struct RoundTrip {
    /// Time at which it ended, on the gateway's clock.
    at: Instant,
    /// The node's time minus the gateway's, in microseconds.
    offset: i64,
    /// Bound on the error of the offset, in microseconds.
    uncertainty: i64,
}

impl RoundTrip {
    /// Bound on the error at `now`: `uncertainty + DRIFT * age`.
    fn uncertainty_at(&self, now: Instant) -> i64 {
        let drift = DRIFT * now.since(self.at).as_micros() as f64;
        self.uncertainty.saturating_add(drift as i64)
    }
}

/// The gateway's estimate of a node's clock.
#[derive(Clone, Debug, Default)]
pub struct NodeClock {
    trips: VecDeque<RoundTrip>,
    /// The gateway's time of sending of the message that the last echo answered, so that each echo counts once.
    last: Option<u64>,
    /// The round trip with the smallest uncertainty.
    best: Option<RoundTrip>,
}

impl NodeClock {
    /// Adds an echo from a message that the node sent at `sent` and the gateway received at `now`. Returns whether
    /// the clock was set in between.
    pub fn note(&mut self, echo: &Echo, sent: u64, now: Instant) -> bool {
        if self.last.is_some_and(|last| echo.sent <= last) {
            return false;
        }
        let [g0, n1, n2, g3] = [echo.sent, echo.received, sent, now.micros()].map(signed);
        if g3 < g0 || n2 < n1 {
            return false;
        }
        self.last = Some(echo.sent);
        let uncertainty = (((g3 - g0) - (n2 - n1)) / 2).max(0);
        let offset = (n1 - g0) / 2 + (n2 - g3) / 2;
        let trip = RoundTrip { at: now, offset, uncertainty };
        let was_set = self.best.is_some_and(|best| {
            let apart = best.offset.saturating_sub(offset).saturating_abs();
            apart > best.uncertainty_at(now).saturating_add(uncertainty).saturating_add(1)
        });
        if was_set {
            self.trips.clear();
        }
        self.trips.retain(|trip| now.since(trip.at) < WINDOW);
        if self.trips.len() == KEPT {
            self.trips.pop_front();
        }
        self.trips.push_back(trip);
        self.best = self.trips.iter().copied().min_by_key(|trip| trip.uncertainty_at(now));
        was_set
    }

    /// Whether an estimate exists.
    #[must_use]
    pub const fn is_known(&self) -> bool {
        self.best.is_some()
    }

    /// The gateway's time at which the node's clock showed `micros`; `None` without an estimate.
    #[must_use]
    pub fn here(&self, micros: u64) -> Option<Instant> {
        let here = signed(micros).saturating_sub(self.best?.offset);
        // Times before the gateway's start are clamped to its start.
        Some(Instant::from_micros(u64::try_from(here).unwrap_or(0)))
    }

    /// The node's clock reading at the gateway's time `here`; `None` without an estimate.
    #[must_use]
    pub fn there(&self, here: Instant) -> Option<u64> {
        let there = signed(here.micros()).saturating_add(self.best?.offset);
        Some(u64::try_from(there).unwrap_or(0))
    }

    /// Bound on the error of [`NodeClock::here`] at `now`.
    #[must_use]
    pub fn uncertainty(&self, now: Instant) -> Option<Duration> {
        let micros = self.best?.uncertainty_at(now);
        Some(Duration::from_micros(u64::try_from(micros).unwrap_or(0)))
    }
}

/// Limits microseconds so that two of them can be subtracted; the limit is 73,000 years.
fn signed(micros: u64) -> i64 {
    micros.min(1 << 61).cast_signed()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A round trip with a node clock that is `offset` ahead; messages take `there` and `back`, in microseconds.
    fn trip(clock: &mut NodeClock, at: u64, offset: u64, there: u64, back: u64) -> bool {
        let (received, sent) = (at + there + offset, at + there + offset + 500);
        let echo = Echo { sent: at, received };
        clock.note(&echo, sent, Instant::from_micros(at + there + 500 + back))
    }

    #[test]
    fn the_quickest_of_uneven_round_trips_says_the_offset_within_its_uncertainty() {
        let mut clock = NodeClock::default();
        for (number, (there, back)) in
            [(9000, 200), (300, 20_000), (150, 250), (4000, 4000)].into_iter().enumerate()
        {
            trip(&mut clock, 1_000_000 + 50_000 * number as u64, 77_000_000, there, back);
        }
        let now = Instant::from_micros(1_200_000);
        let uncertainty = clock.uncertainty(now).unwrap().as_micros() as i64;
        let error = clock.here(77_000_000 + 1_100_000).unwrap().micros() as i64 - 1_100_000;
        // Half of 400 us, plus the drift in 0.1 s.
        assert!((200..=220).contains(&uncertainty), "{uncertainty}");
        assert!(error.abs() <= uncertainty, "{error}");
    }

    #[test]
    fn a_clock_that_is_set_is_noticed_and_followed_at_once() {
        let mut clock = NodeClock::default();
        assert!(!trip(&mut clock, 1_000_000, 5_000_000, 200, 200));
        assert!(!trip(&mut clock, 1_050_000, 5_000_000, 20_000, 200), "jitter is no step");
        assert!(trip(&mut clock, 1_100_000, 6_000_000, 200, 200));
        assert_eq!(clock.here(7_200_000), Some(Instant::from_micros(1_200_000)));
    }

    #[test]
    fn drift_is_followed_and_an_echo_counts_once() {
        let mut clock = NodeClock::default();
        for tick in 0..400_u64 {
            let at = 1_000_000 + tick * 50_000;
            // The node's clock runs 50 ppm fast.
            trip(&mut clock, at, 3_000_000 + tick * 50_000 / 20_000, 300, 300);
        }
        let now = 1_000_000 + 400 * 50_000;
        let there = 3_000_000 + 400 * 50_000 / 20_000 + now;
        let error = clock.here(there).unwrap().micros().abs_diff(now);
        assert!(error < 300, "{error}");
        let before = clock.clone();
        let old = Echo { sent: 1_000_000, received: 0 };
        assert!(!clock.note(&old, 1, Instant::from_micros(now)));
        assert_eq!(clock.here(5), before.here(5));
    }
}
