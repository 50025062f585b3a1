//! The place of a foot that rests: it stays while the foot keeps still, whatever its noise and its sway.
//!
//! ```text
//! Following --within the band for REST_TIME--> Resting
//! Following: the output is the foot's place
//! Resting:   the output stays; after LEAVE_TIME beyond the band it goes to the foot's place
//! Moved:     as Resting for REST_TIME, but --beyond the band--> Following
//! ```
//!
//! The band is `DEVIATIONS * noise`, within [`BAND_M`]. The noise is the mean absolute second difference of the places of
//! three samples, divided by that of white noise with standard deviation 1; a steady slide has no second difference.

use std::ops::RangeInclusive;
use std::time::Duration;

use glam::Vec2;

use crate::units::Instant;

/// Range of the distance that a foot moves on purpose, in metres (our choice): from half of the least step of a slider that
/// a foot can hold, which is more than the sway of a foot at rest (some millimetres), to the accuracy of a floor; a foot
/// that lands is no noise.
const BAND_M: RangeInclusive<f32> = 0.005..=0.01;

/// Time within the band after which a foot rests (our choice: a foot that slides at 2 cm/s leaves it sooner).
const REST_TIME: Duration = Duration::from_millis(250);

/// Time beyond the band after which the output moves (our choice: ten places in a row that are all noise are rarer than a
/// step of the floor; half of the dwell of a press).
const LEAVE_TIME: Duration = Duration::from_millis(10);

/// Interval between two samples of the noise, and the number of samples in its average: half a second.
const SAMPLE_TIME: Duration = Duration::from_millis(16);
const MEMORY: f32 = 30.0;

/// Clipping limit of the second differences, in means, and its minimum in metres (M-estimate of scale): the start of a
/// slide is no noise.
const CLIP: f32 = 3.5;
const CLIP_LEAST_M: f32 = 0.001;

/// Mean absolute second difference of white noise with standard deviation 1: sqrt(6) sqrt(2 / pi).
const SECOND_DIFFERENCE: f32 = 1.954;

/// Width of the band in standard deviations of the noise: two places differ by sqrt(2) of them (normal distribution: one
/// of 2,000 independent differences is beyond 3.5 of its deviations).
const DEVIATIONS: f32 = 5.0;

/// The place of one foot on one control.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RestingPlace {
    state: Option<State>,
    noise: PlaceNoise,
}

#[derive(Clone, Copy, Debug)]
enum State {
    /// Within the band around `anchor` since `since`.
    Following { anchor: Vec2, since: Instant },
    /// The output is `held`; the foot has been beyond the band since `left`.
    Resting { held: Vec2, left: Option<Instant> },
    /// The output is `held`, where it went at `moved`.
    Moved { held: Vec2, moved: Instant },
}

impl RestingPlace {
    /// Forgets the foot: the next place is that of another press.
    pub(super) fn forget(&mut self) {
        *self = Self::default();
    }

    /// Returns the place to act on for a foot at `place`; both are 0 to 1 across a control of `size` metres.
    pub(super) fn settle(&mut self, place: Vec2, size: Vec2, now: Instant) -> Vec2 {
        self.noise.note(place * size, now);
        let band = (DEVIATIONS * self.noise.deviation_m()).clamp(*BAND_M.start(), *BAND_M.end());
        let is_beyond = |from: Vec2| ((place - from) * size).length() > band;
        let follows = State::Following { anchor: place, since: now };
        let (state, out) = match self.state.unwrap_or(follows) {
            State::Following { anchor, .. } if is_beyond(anchor) => (follows, place),
            State::Following { since, .. } if now.since(since) >= REST_TIME => {
                (State::Resting { held: place, left: None }, place)
            }
            following @ State::Following { .. } => (following, place),
            State::Moved { held, moved } if now.since(moved) > REST_TIME => {
                (State::Resting { held, left: None }, held)
            }
            State::Moved { held, .. } if is_beyond(held) => (follows, place),
            moved @ State::Moved { held, .. } => (moved, held),
            State::Resting { held, .. } if !is_beyond(held) => (State::Resting { held, left: None }, held),
            State::Resting { held, left: None } => (State::Resting { held, left: Some(now) }, held),
            State::Resting { left: Some(left), .. } if now.since(left) >= LEAVE_TIME => {
                (State::Moved { held: place, moved: now }, place)
            }
            resting @ State::Resting { held, .. } => (resting, held),
        };
        self.state = Some(state);
        out
    }
}

/// The noise of a place.
#[derive(Clone, Copy, Debug, Default)]
struct PlaceNoise {
    /// The last two samples, the latest first, and the time of the latest.
    samples: [Option<Vec2>; 2],
    sampled: Option<Instant>,
    /// Mean absolute second difference (m), and the number of differences in it.
    mean_m: f32,
    count: f32,
}

impl PlaceNoise {
    /// `mean += (min(|place − 2 last + before|, clip) − mean) / count`.
    fn note(&mut self, place: Vec2, now: Instant) {
        if self.sampled.is_some_and(|sampled| now.since(sampled) < SAMPLE_TIME) {
            return;
        }
        self.sampled = Some(now);
        if let [Some(last), Some(before)] = self.samples {
            self.count = (self.count + 1.0).min(MEMORY);
            let difference = (place - 2.0 * last + before).abs().max_element();
            let clipped = difference.min((CLIP * self.mean_m).max(CLIP_LEAST_M));
            self.mean_m += (clipped - self.mean_m) / self.count;
        }
        self.samples = [Some(place), self.samples[0]];
    }

    /// Standard deviation of the place along the noisier axis (m).
    fn deviation_m(&self) -> f32 {
        self.mean_m / SECOND_DIFFERENCE
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_distr::StandardNormal;
    use rand_pcg::Pcg64Mcg;

    use super::*;

    /// The outputs for the places at each millisecond.
    fn settled(millis: u64, place: impl Fn(u64) -> f32, noise_m: f32) -> Vec<f32> {
        let (mut rest, mut rng) = (RestingPlace::default(), Pcg64Mcg::seed_from_u64(3));
        (0..millis)
            .map(|ms| {
                let off = noise_m * rng.sample::<f32, _>(StandardNormal);
                rest.settle(Vec2::new(place(ms) + off, 0.1), Vec2::ONE, Instant::from_millis(ms)).x
            })
            .collect()
    }

    fn changes(places: &[f32]) -> usize {
        places.windows(2).filter(|pair| pair[0] != pair[1]).count()
    }

    #[test]
    fn a_foot_at_rest_stays_at_its_place_with_little_noise_and_with_much() {
        for noise_m in [0.0003, 0.001, 0.002] {
            let places = settled(21_000, |_| 0.2, noise_m);
            assert!(changes(&places[1000..]) <= 10, "{noise_m} m: {} in 20 s", changes(&places[1000..]));
        }
        let sway = |ms: u64| 0.2 + 0.002 * (ms as f32 * 1e-3).sin();
        assert_eq!(changes(&settled(21_000, sway, 0.0)[1000..]), 0);
    }

    #[test]
    fn a_sliding_foot_is_followed_exactly_from_its_first_centimetre_on() {
        let slide = |ms: u64| 0.2 + 0.0001 * ms.saturating_sub(1000) as f32;
        let places = settled(2000, slide, 0.0);
        for (ms, place) in places.iter().enumerate().skip(1115) {
            assert_eq!(*place, slide(ms as u64), "at {ms} ms");
        }
        assert!((1000..1050).all(|ms| places[ms] == 0.2), "half a centimetre is rest");
    }

    #[test]
    fn a_slow_push_arrives_within_the_band() {
        let slow = |ms: u64| 0.2 + 0.000_005 * ms as f32;
        let places = settled(10_000, slow, 0.0);
        assert!((0..10_000).all(|ms| (places[ms] - slow(ms as u64)).abs() <= BAND_M.start() + 1.2e-4));
    }
}
