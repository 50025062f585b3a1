//! Following the zero of sensors that drift.
//!
//! Whether a tile is empty is not read off the drifting value alone:
//!
//! - every sensor must be near its zero (3 N), and so must their sum (4 N): less than
//!   what counts as load, so whatever stands there operates nothing anyway;
//! - none of the eight tiles around may carry anything, for a foot's edge may reach over;
//! - all of this must have been so, and quiet, for two seconds on end: a person sways.
//!   For the first newton, a fifth of a second is enough; see below.
//!
//! A foot that stands is never near zero, so no standing foot is taken off, however long
//! it stands and creeps. The worst that can be zeroed away is a resting touch of 4 N.
//!
//! A zero that is off by less than a newton is within what any tare leaves, and costs light
//! feet half a centimetre: that much, about where the zero has been followed to slowly, is
//! followed at once.

use super::slow::Block;
use super::trouble::{Sensor, Trouble};

/// The fastest the zero follows beyond [`SMALL_N`], in newtons per second: one newton a minute.
const RATE: f32 = 1.0 / 60.0;

/// How far from where it has been followed to so slowly a zero is followed at once, in newtons, after how long, and how
/// soon, in seconds.
const SMALL_N: f32 = 1.0;
const MOMENT_S: f32 = 0.2;
const SOON_S: f32 = 0.15;

/// How far the zero is followed, as a share of the sensor's range.
pub(super) const LIMIT: f32 = 0.2;

/// How far from zero a sensor, and the sum of a tile's, may be on an empty tile.
const EMPTY_N: f32 = 3.0;
const EMPTY_SUM_N: f32 = 4.0;

/// How much averages may differ while quiet, in newtons.
const QUIET_N: f32 = 0.5;

/// How far readings may scatter within a block on a sensor that is not noisy, in newtons.
const SCATTER_N: f32 = 4.0;

/// For how long a tile must be empty and quiet before its zeros are followed slowly, in seconds.
const PATIENCE_S: f32 = 2.0;

/// For how long a sensor scatters on the empty tile before it is noisy, in seconds: less than two steps.
const NOISY_S: f32 = 1.0;

/// One tile's state as far as drift is concerned.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::sense) struct Drift {
    /// The averages when it became quiet.
    since: [f32; 4],
    /// How far each zero has been followed slowly, in newtons.
    slowly: [f32; 4],
    quiet_for: f32,
    /// Seconds for which each sensor has scattered on the empty tile, or has not.
    noisy_for: [f32; 4],
}

impl Drift {
    /// Forgets what it has seen of the tile, for frames are missing, but not how far its zeros have been followed.
    pub(super) fn interrupt(&mut self) {
        *self = Self { slowly: self.slowly, ..Self::default() };
    }

    /// Adds a block, and moves the `zeros` if the tile is empty and quiet; `alone`
    /// says that no tile around it carries anything.
    pub(super) fn follow(
        &mut self,
        block: &Block,
        alone: bool,
        limits: &[f32; 4],
        zeros: &mut [f32; 4],
        sensors: &mut [Sensor; 4],
    ) {
        let sound = |corner: &usize| !sensors[*corner].is_out();
        let known = || (0..4).filter(sound);
        let sum: f32 = known().map(|corner| block.means[corner]).sum();
        let near = known().all(|corner| block.means[corner].abs() <= EMPTY_N);
        let empty = alone && near && sum.abs() <= EMPTY_SUM_N;
        if empty {
            self.note_noise(block, sensors);
        }
        let known = (0..4).filter(|&corner| !sensors[corner].is_out());
        let quiet = known.clone().all(|corner| {
            (block.means[corner] - self.since[corner]).abs() <= QUIET_N && block.spreads[corner] <= SCATTER_N
        });
        if !(empty && quiet) {
            (self.since, self.quiet_for) = (block.means, 0.0);
            return;
        }
        self.quiet_for += block.seconds;
        if self.quiet_for < MOMENT_S {
            return;
        }
        // What it follows must not in the end look like unrest.
        self.since = block.means;
        let most = if self.quiet_for < PATIENCE_S { 0.0 } else { RATE * block.seconds };
        let soon = 1.0 - (-block.seconds / SOON_S).exp();
        for corner in known.collect::<arrayvec::ArrayVec<usize, 4>>() {
            let (sensor, limit, zero) = (&mut sensors[corner], limits[corner], &mut zeros[corner]);
            let slowly = &mut self.slowly[corner];
            *slowly += (*zero + block.means[corner] - *slowly).clamp(-most, most);
            let moved = *slowly + (*zero + soon * block.means[corner] - *slowly).clamp(-SMALL_N, SMALL_N);
            *zero = moved.clamp(-limit, limit);
            if moved.abs() > limit {
                sensor.find(Trouble::Drifted, block.means[corner]);
            } else if sensor.trouble() == Some(Trouble::Drifted) {
                sensor.review(block.means[corner], zero.abs() < 0.95 * limit, true, block.seconds);
            }
        }
    }

    /// Finds sensors that scatter on an empty tile.
    fn note_noise(&mut self, block: &Block, sensors: &mut [Sensor; 4]) {
        for (corner, sensor) in sensors.iter_mut().enumerate() {
            let scatters = block.spreads[corner] > SCATTER_N;
            let for_s = &mut self.noisy_for[corner];
            *for_s = if scatters { *for_s + block.seconds } else { 0.0 };
            if *for_s >= NOISY_S {
                sensor.find(Trouble::Noisy, block.means[corner]);
            }
            if sensor.trouble() == Some(Trouble::Noisy) {
                sensor.review(block.means[corner], !scatters, true, block.seconds);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_in_the_frames_undoes_nothing_of_what_was_followed() {
        let (mut drift, mut zeros, mut sensors) = (Drift::default(), [0.0; 4], [Sensor::default(); 4]);
        let mut empty = |drift: &mut Drift, zeros: &mut [f32; 4], offset: f32, blocks: u32| {
            for _ in 0..blocks {
                let means = zeros.map(|zero| offset - zero);
                let block = Block { means, lows: means, seconds: 0.064, ..Block::default() };
                drift.follow(&block, true, &[100.0; 4], zeros, &mut sensors);
            }
        };
        // Eight newtons in ten minutes, as fast as a zero may drift to be followed.
        for tenth in 0..80_u8 {
            empty(&mut drift, &mut zeros, f32::from(tenth) / 10.0, 117);
        }
        assert!(zeros.iter().all(|zero| (zero - 7.9).abs() < 0.1), "{zeros:?}");
        drift.interrupt();
        empty(&mut drift, &mut zeros, 7.9, 100);
        assert!(zeros.iter().all(|zero| (zero - 7.9).abs() < 0.1), "{zeros:?}");
    }
}
