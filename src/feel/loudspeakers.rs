//! Panning of cues to loudspeakers.

use arrayvec::ArrayVec;
use glam::Vec2;

use super::Spot;
use super::mix::{CueOutput, FAINT};
use crate::floor::{Actuator, Loudspeaker};

/// Maximum number of loudspeakers that play one cue.
pub(super) const NEAREST: usize = 3;

/// Full scales per newton of a loudspeaker without a gain of its own: the same as for a nominal actuator.
pub(super) const PER_NEWTON: f32 = 1.0 / Actuator::nominal(0).full_scale.0;

/// Minimum distance to a loudspeaker, in metres: bounds the gain at its place.
const NEAR_M: f32 = 0.1;

/// The loudspeakers that play one cue, with the gain of each.
pub(super) type Panned = ArrayVec<CueOutput, NEAREST>;

/// The loudspeakers around the floor.
#[derive(Clone, Debug)]
pub(super) struct Loudspeakers {
    /// Place of each, and its output at full gain.
    all: ArrayVec<(Vec2, CueOutput), { Loudspeaker::MOST }>,
    /// Centres of the tiles.
    centres: Box<[Vec2]>,
}

impl Loudspeakers {
    /// The loudspeakers of `all` within the channels of the device, for a floor with these centres of tiles.
    pub(super) fn new(all: &[Loudspeaker], centres: Vec<Vec2>, channels: usize) -> Self {
        let playable = all.iter().filter(|one| {
            usize::from(one.channel) < channels && one.at.is_finite() && one.gain_db.is_finite()
        });
        let all = playable.take(Loudspeaker::MOST).map(|one| {
            let per_newton = 10_f32.powf(one.gain_db / 20.0) * PER_NEWTON;
            (one.at, CueOutput { channel: one.channel.into(), per_newton })
        });
        Self { all: all.collect(), centres: centres.into() }
    }

    /// Pans a cue on these spots with the level `audio_gain` (0 to 1). It comes from `at`, in floor metres, or from
    /// the middle of the spots.
    ///
    /// The three nearest loudspeakers share it, the nearer the more, with constant total power at every place. The
    /// share of the third falls to zero where a fourth becomes as near, so that nothing jumps when a foot moves.
    ///
    /// # Real-time
    /// No allocation.
    pub(super) fn pan(&self, spots: &[Spot], audio_gain: f32, at: Option<Vec2>) -> Panned {
        let mut heard = Panned::new();
        if audio_gain.is_nan() || audio_gain <= 0.0 || self.all.is_empty() {
            return heard;
        }
        let (mut sum, mut place) = (0.0, Vec2::ZERO);
        for spot in spots {
            if let Some(centre) = self.centres.get(usize::from(spot.tile))
                && spot.weight > 0.0
                && spot.weight.is_finite()
            {
                sum += spot.weight;
                place += *centre * spot.weight;
            }
        }
        let level = audio_gain.min(1.0) * sum.min(1.0);
        if level < FAINT || !sum.is_finite() {
            return heard;
        }
        let place = at.filter(|at| at.is_finite()).unwrap_or(place / sum);
        let mut near: ArrayVec<(f32, CueOutput), { Loudspeaker::MOST }> =
            self.all.iter().map(|(at, output)| (at.distance(place).max(NEAR_M), *output)).collect();
        near.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let beyond = near.get(NEAREST).map_or(0.0, |(distance, _)| distance.recip());
        // A fourth as near as the first gets no share, but then the first must not become silent.
        let share = |distance: f32| distance.recip() - beyond + 1e-4;
        let power: f32 = near.iter().take(NEAREST).map(|(distance, _)| share(*distance).powi(2)).sum();
        let loudness = level / power.sqrt();
        for (distance, output) in near.into_iter().take(NEAREST) {
            let per_newton = output.per_newton * loudness * share(distance);
            heard.push(CueOutput { per_newton, ..output });
        }
        heard
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Four loudspeakers at the corners of a floor of 2 m, and tiles along its diagonal.
    fn corners() -> Loudspeakers {
        let at = [(0.0, 0.0), (2.0, 0.0), (0.0, 2.0), (2.0, 2.0)];
        let all: Vec<Loudspeaker> = (36..)
            .zip(at)
            .map(|(channel, at)| Loudspeaker { at: at.into(), channel, gain_db: 0.0 })
            .collect();
        let centres = (0..200).map(|n| Vec2::new(0.01 * n as f32, 0.008 * n as f32)).collect();
        Loudspeakers::new(&all, centres, 40)
    }

    fn gains(heard: &Panned) -> [f32; 4] {
        let mut gains = [0.0; 4];
        for output in heard {
            gains[output.channel - 36] = output.per_newton * 40.0;
        }
        gains
    }

    #[test]
    fn power_is_the_same_everywhere_and_nothing_jumps() {
        let speakers = corners();
        let mut last: Option<[f32; 4]> = None;
        for tile in 0..200 {
            let gains = gains(&speakers.pan(&[Spot { tile, weight: 1.0 }], 1.0, None));
            let power: f32 = gains.iter().map(|gain| gain * gain).sum();
            assert!((power - 1.0).abs() < 1e-4, "tile {tile}: {power}");
            if let Some(last) = last {
                let jump = gains.iter().zip(last).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
                assert!(jump < 0.2, "tile {tile}: {jump}");
            }
            last = Some(gains);
        }
    }

    #[test]
    fn the_nearest_is_the_loudest_and_a_cue_on_two_tiles_lies_between_them() {
        let speakers = corners();
        let west = gains(&speakers.pan(&[Spot { tile: 0, weight: 1.0 }], 0.5, None));
        assert!(west[0] > 0.49 && west[0] <= 0.5, "{west:?}");
        let two = [Spot { tile: 20, weight: 0.5 }, Spot { tile: 60, weight: 0.5 }];
        let between = speakers.pan(&two, 1.0, None);
        let middle = speakers.pan(&[Spot { tile: 40, weight: 1.0 }], 1.0, None);
        for (a, b) in gains(&between).iter().zip(gains(&middle)) {
            assert!((a - b).abs() < 1e-4);
        }
    }

    #[test]
    fn what_has_a_place_is_heard_from_there_and_as_loudly() {
        let speakers = corners();
        let east = Some(Vec2::new(1.9, 0.1));
        let heard = gains(&speakers.pan(&[Spot { tile: 0, weight: 1.0 }], 1.0, east));
        assert!(heard[1] > 0.9, "the south-east loudspeaker is the nearest: {heard:?}");
        let power: f32 = heard.iter().map(|gain| gain * gain).sum();
        assert!((power - 1.0).abs() < 1e-4, "{power}");
        let nowhere = Some(Vec2::new(f32::NAN, 0.0));
        let west = gains(&speakers.pan(&[Spot { tile: 0, weight: 1.0 }], 1.0, nowhere));
        assert!(west[0] > 0.9, "{west:?}");
    }

    #[test]
    fn nothing_is_heard_that_is_not_meant_to_be_or_makes_no_sense() {
        let speakers = corners();
        // The last one is below `FAINT`: it would be played in denormal numbers.
        for (tile, weight, audio_gain) in [
            (0, 1.0, 0.0),
            (0, 1.0, f32::NAN),
            (0, f32::NAN, 1.0),
            (0, f32::INFINITY, 1.0),
            (999, 1.0, 1.0),
            (0, 1e-35, 1.0),
        ] {
            assert!(speakers.pan(&[Spot { tile, weight }], audio_gain, None).is_empty());
        }
        assert!(
            Loudspeakers::new(&[], vec![Vec2::ZERO], 4)
                .pan(&[Spot { tile: 0, weight: 1.0 }], 1.0, None)
                .is_empty()
        );
        let far = Loudspeaker { at: Vec2::ZERO, channel: 4, gain_db: 0.0 };
        assert!(Loudspeakers::new(&[far], vec![Vec2::ZERO], 4).all.is_empty());
    }
}
