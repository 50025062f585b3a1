//! Estimates a person's weight from the load on the floor while they stand quietly.

use std::time::Duration;

use crate::units::{Instant, Newtons};

/// Range of a body's weight, 30 to 200 kg in newtons; less is a bag or half a person, more is two.
const LEAST: f32 = 30.0 * 9.81;
const MOST: f32 = 200.0 * 9.81;

/// Time for which the sum must stay within the band to count as a weight (our choice: longer than two slow steps).
const QUIET: Duration = Duration::from_secs(2);

/// Width of the band as a share of the sum.
///
/// # Source
/// A standing person, on both feet or on one, changes the sum by the acceleration of the body: by 1 to 2 %; walking
/// changes it by 20 % even at 0.6 m/s (Perry 1992).
const BAND: f32 = 0.10;

/// Gain of the smoothing of weights: `weight += NEW_SHARE * (mean - weight)`.
const NEW_SHARE: f32 = 0.3;

/// Below this share of the known weight a foot probably stands beside the floor.
const LIGHTER: f32 = 0.85;

/// Number of quiet spans of less weight in a row after which it counts: the person has put down a load.
const BELIEVED: u8 = 3;

/// One person's scale: its input is the sum of the person's contacts, frame by frame.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct WeighingScale {
    weight: Option<f32>,
    lighter: u8,
    since: Instant,
    low: f32,
    high: f32,
    sum: f64,
    count: u32,
}

impl WeighingScale {
    /// The person's weight; `None` until they have stood quietly for two seconds.
    pub(super) fn weight(&self) -> Option<Newtons> {
        self.weight.map(Newtons)
    }

    /// Processes the sum of the person's contacts.
    pub(super) fn weigh(&mut self, sum: f32, now: Instant) {
        let (low, high) = (self.low.min(sum), self.high.max(sum));
        if self.count == 0 || sum < LEAST || high - low > BAND * high {
            *self = Self { since: now, low: sum, high: sum, sum: 0.0, count: 0, ..*self };
        } else {
            (self.low, self.high) = (low, high);
        }
        self.sum += f64::from(sum);
        self.count += 1;
        if now.since(self.since) >= QUIET {
            self.settle((self.sum / f64::from(self.count)) as f32);
            self.count = 0;
        }
    }

    fn settle(&mut self, mean: f32) {
        if !(LEAST..=MOST).contains(&mean) {
            return;
        }
        match self.weight {
            Some(known) if mean < LIGHTER * known && self.lighter + 1 < BELIEVED => self.lighter += 1,
            Some(known) if (LIGHTER * known..known / LIGHTER).contains(&mean) => {
                self.weight = Some(known + NEW_SHARE * (mean - known));
                self.lighter = 0;
            }
            _ => {
                self.weight = Some(mean);
                self.lighter = 0;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The weight after so many seconds; `sum` gives the sum at a time in seconds.
    fn weighed(
        scale: &mut WeighingScale,
        from_s: u64,
        seconds: u64,
        sum: impl Fn(f32) -> f32,
    ) -> Option<f32> {
        for ms in from_s * 1000..(from_s + seconds) * 1000 {
            scale.weigh(sum(ms as f32 * 1e-3), Instant::from_millis(ms));
        }
        scale.weight
    }

    #[test]
    fn quiet_standing_gives_the_weight_and_walking_gives_none() {
        let mut scale = WeighingScale::default();
        let walking = |s: f32| 700.0 * (1.0 + 0.18 * (s * 11.0).sin());
        assert_eq!(weighed(&mut scale, 0, 20, walking), None);
        let swaying = |s: f32| 700.0 * (1.0 + 0.01 * (s * 1.3).sin());
        let weight = weighed(&mut scale, 20, 3, swaying).unwrap();
        assert!((weight - 700.0).abs() < 7.0, "{weight}");
        assert_eq!(weighed(&mut scale, 23, 20, walking), Some(weight), "and stays");
    }

    #[test]
    fn a_foot_beside_the_floor_is_no_diet_unless_it_stays_there() {
        let mut scale = WeighingScale::default();
        weighed(&mut scale, 0, 3, |_| 700.0);
        assert_eq!(weighed(&mut scale, 3, 5, |_| 350.0), Some(700.0));
        assert_eq!(weighed(&mut scale, 8, 4, |_| 350.0), Some(350.0));
        // A second foot back on it counts at once.
        assert_eq!(weighed(&mut scale, 12, 3, |_| 700.0), Some(700.0));
    }

    #[test]
    fn bags_and_crowds_are_nobody() {
        let mut scale = WeighingScale::default();
        assert_eq!(weighed(&mut scale, 0, 10, |_| 120.0), None);
        assert_eq!(weighed(&mut scale, 10, 10, |_| 2400.0), None);
    }
}
