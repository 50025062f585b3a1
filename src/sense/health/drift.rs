//! Tracks the zero of sensors that drift.
//!
//! The drifting value alone does not decide whether a tile is empty:
//!
//! - every sensor must be near its zero (3 N), and so must their sum (4 N): less than a load, so nothing that stands
//!   there operates a control;
//! - none of the eight tiles around may carry a load, since a foot's edge may reach over;
//! - all of this must have been so, without motion, for two seconds: a person sways. For the first newton, a fifth of
//!   a second is enough; see below.
//!
//! A standing foot is never near zero, so its load is never subtracted, for any duration of standing and creep. The
//! largest load that can be zeroed is a resting touch of 4 N.
//!
//! An offset of less than a newton is within the error of any tare, and displaces light feet by half a centimetre:
//! the zero follows that much, about its slowly tracked value, at once.

use super::slow::Block;
use super::trouble::{Sensor, Trouble};

/// Maximum rate of the zero beyond [`SMALL_N`] (N/s): one newton a minute.
const RATE: f32 = 1.0 / 60.0;

/// Range about the slowly tracked zero within which the zero follows at once (N), the delay, and the time constant
/// (s).
const SMALL_N: f32 = 1.0;
const MOMENT_S: f32 = 0.2;
const SOON_S: f32 = 0.15;

/// Maximum tracked offset, as a share of the sensor's range.
pub(super) const LIMIT: f32 = 0.2;

/// Maximum reading of a sensor, and of the sum of a tile's sensors, on an empty tile (N).
const EMPTY_N: f32 = 3.0;
const EMPTY_SUM_N: f32 = 4.0;

/// Maximum difference of averages in a quiet period (N).
const QUIET_N: f32 = 0.5;

/// Maximum spread of readings within a block of a sensor that is not noisy (N).
const SCATTER_N: f32 = 4.0;

/// Time for which a tile must be empty and quiet before its zeros move slowly (s).
const PATIENCE_S: f32 = 2.0;

/// Time of excessive spread on the empty tile after which a sensor is noisy (s): less than two steps.
const NOISY_S: f32 = 1.0;

/// Drift state of one tile.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::sense) struct Drift {
    /// The averages at the start of the quiet period.
    since: [f32; 4],
    /// Slowly tracked offset of each zero (N).
    slowly: [f32; 4],
    quiet_for: f32,
    /// Time for which each sensor has spread excessively on the empty tile (s).
    noisy_for: [f32; 4],
}

impl Drift {
    /// Resets the state after missing frames, except the slowly tracked offsets.
    pub(super) fn interrupt(&mut self) {
        *self = Self { slowly: self.slowly, ..Self::default() };
    }

    /// Adds a block, and moves the `zeros` if the tile is empty and quiet; `alone` means that no tile around it
    /// carries a load.
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
        // The tracked drift itself must not count as motion.
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

    /// Finds sensors with excessive spread on an empty tile.
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
        // Eight newtons in ten minutes, just below the maximum rate of tracking.
        for tenth in 0..80_u8 {
            empty(&mut drift, &mut zeros, f32::from(tenth) / 10.0, 117);
        }
        assert!(zeros.iter().all(|zero| (zero - 7.9).abs() < 0.1), "{zeros:?}");
        drift.interrupt();
        empty(&mut drift, &mut zeros, 7.9, 100);
        assert!(zeros.iter().all(|zero| (zero - 7.9).abs() < 0.1), "{zeros:?}");
    }
}
