//! How far the page is behind a server: frames that wait in the browser make feet appear late.

use std::time::Duration;

use underfoot::units::Instant;

/// Greatest lag: a page that is further behind joins again, which drops all that waits.
const LONGEST: Duration = Duration::from_secs(1);

/// Rate at which the least difference between both clocks may grow: far more than that of two crystals, and far less
/// than that of a page which keeps up with nine tenths of a floor.
const DRIFT: f64 = 1e-3;

/// The lag of the frames of one connection: the difference between both clocks at a frame, less the least of all.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Lag {
    /// The least difference so far in seconds, and the time of the last frame.
    least: Option<(f64, Duration)>,
}

impl Lag {
    /// The lag of a frame that ends at `ends` on the server's clock and is sensed at `now` of the page.
    pub(crate) fn note(&mut self, ends: Instant, now: Duration) -> Duration {
        let difference = now.as_secs_f64() - ends.secs();
        let least = self.least.map_or(difference, |(least, before)| {
            difference.min(least + DRIFT * now.saturating_sub(before).as_secs_f64())
        });
        self.least = Some((least, now));
        Duration::try_from_secs_f64(difference - least).unwrap_or_default()
    }

    /// Whether a page with this lag joins again.
    pub(crate) fn is_too_long(lag: Duration) -> bool {
        lag > LONGEST
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lag after `seconds` of frames, whose page advances at `pace` of the floor's time.
    fn lag_after(seconds: u64, pace: f64) -> Duration {
        let mut lag = Lag::default();
        (0..seconds * 250).fold(Duration::ZERO, |_, frame| {
            let ends = Instant::from_micros(5_000_000 + 4000 * frame);
            lag.note(ends, Duration::from_secs_f64(0.004 * frame as f64 / pace))
        })
    }

    #[test]
    fn a_page_that_keeps_up_never_lags_whatever_its_clock_does_in_a_day() {
        assert!(lag_after(24 * 3600, 1.0 - 1e-4) < Duration::from_millis(1));
        assert!(lag_after(24 * 3600, 1.0 + 1e-4) < Duration::from_millis(1));
    }

    #[test]
    fn a_page_that_is_slower_than_the_floor_is_too_late_within_seconds() {
        assert!(!Lag::is_too_long(lag_after(5, 0.9)));
        assert!(Lag::is_too_long(lag_after(12, 0.9)));
    }

    #[test]
    fn one_late_frame_is_no_lag_of_the_next() {
        let mut lag = Lag::default();
        let at = Duration::from_millis;
        lag.note(Instant::from_millis(1000), at(0));
        assert_eq!(lag.note(Instant::from_millis(1004), at(304)).as_millis(), 299);
        assert!(lag.note(Instant::from_millis(1308), at(308)) < at(1));
    }
}
