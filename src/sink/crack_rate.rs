//! A rate limit on crack reports.

use std::time::Duration;

use crate::ground::GroundEvent;
use crate::units::Instant;

/// Minimum mean time between two messages: 200 a second.
const PERIOD: Duration = Duration::from_millis(5);

/// Maximum number of messages at once after a pause.
const BURST: u32 = 10;

/// Limits crack events to a rate that other programs can follow; a stamp makes hundreds.
#[derive(Debug, Default)]
pub struct CrackRateLimiter {
    /// End of the time that messages have used up; each message uses `PERIOD`.
    paid: Instant,
    /// Events dropped since the last message.
    skipped: u32,
}

/// A crack event, for other programs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrackNews {
    /// Time of the event.
    pub at: Instant,
    /// The seed of its cracks.
    pub seed: u32,
    /// The energy of the event, in joules.
    pub energy_j: f32,
    /// East, in floor metres.
    pub x_m: f32,
    /// North, in floor metres.
    pub y_m: f32,
    /// Number of events dropped since the last message.
    pub skipped: u32,
}

impl CrackRateLimiter {
    /// Returns the report of `event`; `None` if it opened no crack, or if the rate limit drops and counts it.
    pub fn news(&mut self, event: &GroundEvent) -> Option<CrackNews> {
        let seed = event.seed?;
        let earliest = event.at.before(PERIOD * BURST);
        self.paid = self.paid.max(earliest);
        if self.paid + PERIOD > event.at + PERIOD {
            self.skipped = self.skipped.saturating_add(1);
            return None;
        }
        self.paid = self.paid + PERIOD;
        let skipped = std::mem::take(&mut self.skipped);
        let (at, energy_j, [x_m, y_m]) = (event.at, event.energy_j, event.place.to_array());
        Some(CrackNews { at, seed, energy_j, x_m, y_m, skipped })
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::feel::Click;
    use crate::units::Newtons;

    fn event(micros: u64, seed: Option<u32>) -> GroundEvent {
        GroundEvent {
            at: Instant::from_micros(micros),
            ground: 0,
            tile: 7,
            contact: None,
            place: Vec2::new(0.5, 0.75),
            energy_j: 0.5,
            seed,
            click: Click { level: Newtons(1.0), ..Click::default() },
        }
    }

    #[test]
    fn a_stamp_s_first_cracks_are_told_at_once_and_the_others_counted() {
        let mut limiter = CrackRateLimiter::default();
        // 100 cracks within 20 ms, after a second of rest.
        let told: Vec<CrackNews> =
            (0..100).filter_map(|n| limiter.news(&event(1_000_000 + n * 200, Some(3)))).collect();
        assert!((10..=16).contains(&told.len()), "{}", told.len());
        assert_eq!(told[0].at, Instant::from_micros(1_000_000));
        let later = limiter.news(&event(2_000_000, Some(4))).unwrap();
        let skipped: u32 = told.iter().map(|news| news.skipped).sum::<u32>() + later.skipped;
        assert_eq!(skipped as usize + told.len(), 100, "each one is told or counted");
        assert_eq!((later.seed, later.x_m, later.y_m), (4, 0.5, 0.75));
    }

    #[test]
    fn steady_cracking_is_told_200_times_a_second() {
        let mut limiter = CrackRateLimiter::default();
        let told = (0..10_000).filter_map(|n| limiter.news(&event(n * 1000, Some(1)))).count();
        assert!((1990..=2015).contains(&told), "{told} in ten seconds");
        assert_eq!(limiter.news(&event(20_000_000, None)), None, "snow opens no cracks");
    }
}
