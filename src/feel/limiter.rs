//! The limiter of a group of channels, and the ramp of the whole output.

// Loops over lanes stay plain indexed loops: those are the ones that become vector instructions.
#![allow(clippy::needless_range_loop)]

use std::f32::consts::TAU;

use super::mix::{LANES, settled};
use super::modal::multiply_add;

/// Below this share of full scale the limiter changes nothing; our choice.
const KNEE: f32 = 0.8;

/// Time constant of the decay of a held peak; our choice, several periods of a 50 Hz mode.
const RELEASE_S: f32 = 0.08;

/// Corner of the high-pass against direct current: far enough below the 50 Hz where actuators begin.
const DC_BLOCK_HZ: f32 = 5.0;

/// Keeps a group of channels within full scale, for every finite input.
///
/// A peak limiter without look-ahead, for minimum latency: it follows a rising peak in the very sample (a soft
/// ceiling from 0.8 of full scale on), and releases slowly, so that a ringing mode keeps its shape. A high-pass then
/// blocks direct current, and the sample is clamped to -1..=1.
///
/// # Real-time
/// No allocation.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(super) struct Limiter {
    /// The held peak.
    envelope: [f32; LANES],
    /// The estimate of direct current.
    mean: [f32; LANES],
    release: f32,
    /// Share of the mean that remains from one sample to the next: `exp(-2 pi DC_BLOCK_HZ / sample_rate)`.
    keep: f32,
    /// Whether any held peak is above [`KNEE`]; if neither a held peak nor a sample is, the limiter is idle.
    holding: bool,
}

impl Limiter {
    pub(super) fn new(sample_rate: f32) -> Self {
        Self {
            envelope: [0.0; LANES],
            mean: [0.0; LANES],
            release: (-1.0 / (RELEASE_S * sample_rate)).exp(),
            keep: (-TAU * DC_BLOCK_HZ / sample_rate).exp(),
            holding: false,
        }
    }

    /// Resets the state at once.
    pub(super) fn clear(&mut self) {
        self.envelope = [0.0; LANES];
        self.mean = [0.0; LANES];
        self.holding = false;
    }

    /// Limits a stretch of samples, with the maximum `loudest`, to below full scale, along a smooth curve from
    /// [`KNEE`] on: with `e = (peak - KNEE) / (1 - KNEE)`, a peak becomes `(KNEE + e) / (1 + e)`. Returns whether any
    /// sample may have changed.
    #[inline(always)]
    pub(super) fn hold_down(&mut self, columns: &mut [[f32; LANES]], loudest: f32) -> bool {
        if !(loudest > KNEE || self.holding) {
            return false;
        }
        let mut envelope = self.envelope;
        for column in columns {
            for lane in 0..LANES {
                let peak = larger(column[lane].abs(), envelope[lane] * self.release);
                envelope[lane] = peak;
                let excess = larger(peak - KNEE, 0.0) * (1.0 / (1.0 - KNEE));
                let reach = KNEE + (1.0 - KNEE) * excess;
                column[lane] *= (KNEE + excess) / (reach * (1.0 + excess));
            }
        }
        self.envelope = envelope;
        self.holding = false;
        for lane in 0..LANES {
            self.holding |= envelope[lane] > KNEE;
        }
        true
    }

    /// Removes direct current from up to four samples of each channel: `y = (x - mean) * gain`, with `x - mean`
    /// clamped to full scale, then `mean = keep * mean + (1 - keep) * x`.
    ///
    /// Four together: the mean of a sample depends on the one before it, but the contribution of four samples to a
    /// mean does not.
    #[inline(always)]
    pub(super) fn finish<const FUSED: bool>(&mut self, columns: &mut [[f32; LANES]], gains: &[f32]) {
        let keep = self.keep;
        let before = self.mean;
        let (mut mean, mut added, mut kept) = (before, [0.0; LANES], 1.0);
        for (column, gain) in columns.iter_mut().zip(gains) {
            kept *= keep;
            for lane in 0..LANES {
                let sample = column[lane];
                column[lane] = within_full_scale(sample - mean[lane]) * gain;
                added[lane] = multiply_add::<FUSED>(keep, added[lane], (1.0 - keep) * sample);
                mean[lane] = multiply_add::<FUSED>(kept, before[lane], added[lane]);
            }
        }
        self.mean = mean;
    }

    /// Sets tiny values to zero; returns the largest value that is still audible.
    ///
    /// The held peak does not count: with silence as the input it only decays.
    #[inline(always)]
    pub(super) fn settle(&mut self) -> f32 {
        settled(std::slice::from_mut(&mut self.envelope));
        settled(std::slice::from_mut(&mut self.mean))
    }
}

#[inline(always)]
fn within_full_scale(sample: f32) -> f32 {
    smaller(larger(sample, -1.0), 1.0)
}

/// The smaller of two numbers, in one instruction.
#[inline(always)]
fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The larger of two numbers, in one instruction; [`f32::max`] takes three because it handles NaN, which never occurs
/// here.
#[inline(always)]
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// A gain that rises and falls in 5 ms, for starting, stopping and muting.
#[derive(Clone, Debug)]
pub(super) struct Ramp {
    level: f32,
    step: f32,
    up: bool,
}

impl Ramp {
    /// Length of a full rise or fall, in seconds.
    const LENGTH_S: f32 = 0.005;

    /// A ramp that starts at zero and rises.
    pub(super) fn new(sample_rate: f32) -> Self {
        Self { level: 0.0, step: 1.0 / (Self::LENGTH_S * sample_rate), up: true }
    }

    /// Starts to rise to full level.
    pub(super) fn fade_in(&mut self) {
        self.up = true;
    }

    /// Starts to fall to silence.
    pub(super) fn fade_out(&mut self) {
        self.up = false;
    }

    /// Whether it falls, or is silent.
    pub(super) fn is_falling(&self) -> bool {
        !self.up
    }

    /// Whether it is at exactly zero and stays there.
    pub(super) fn is_down(&self) -> bool {
        !self.up && self.level == 0.0
    }

    /// The gain of each of the next samples.
    pub(super) fn fill(&mut self, gains: &mut [f32]) {
        if self.up && self.level == 1.0 {
            return gains.fill(1.0);
        }
        let step = if self.up { self.step } else { -self.step };
        for gain in gains {
            self.level = (self.level + step).clamp(0.0, 1.0);
            *gain = self.level;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f32 = 48_000.0;

    /// The output of one channel of the limiter.
    fn through(limiter: &mut Limiter, input: &[f32]) -> Vec<f32> {
        let mut columns: Vec<[f32; LANES]> = vec![[0.0; LANES]; input.len()];
        for (column, sample) in columns.iter_mut().zip(input) {
            column[5] = *sample;
        }
        for columns in columns.chunks_mut(64) {
            let loudest = columns.iter().fold(0.0_f32, |most, column| most.max(column[5].abs()));
            limiter.hold_down(columns, loudest);
            for columns in columns.chunks_mut(4) {
                limiter.finish::<false>(columns, &[1.0; 4]);
            }
            limiter.settle();
        }
        columns.into_iter().map(|column| column[5]).collect()
    }

    fn sine(amplitude: f32, samples: usize) -> Vec<f32> {
        (0..samples).map(|n| amplitude * (TAU * 200.0 * n as f32 / RATE).sin()).collect()
    }

    #[test]
    fn a_quiet_signal_passes_as_it_is() {
        let input = sine(0.7, 4800);
        let out = through(&mut Limiter::new(RATE), &input);
        // The high-pass shifts a 200 Hz sine by 1.4 degrees, and removes a little of its sudden start.
        let worst = input.iter().zip(&out).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(worst < 0.7 * 0.06, "{worst}");
    }

    #[test]
    fn a_loud_signal_stays_below_full_scale_from_the_first_sample_on() {
        let out = through(&mut Limiter::new(RATE), &sine(5.0, 4800));
        let peak = out.iter().fold(0.0_f32, |a, b| a.max(b.abs()));
        assert!((0.9..=1.0).contains(&peak), "{peak}");
        // From the second period on it is a sine again, without clipped peaks.
        let later = &out[480..];
        let rms = (later.iter().map(|x| x * x).sum::<f32>() / later.len() as f32).sqrt();
        let peak = later.iter().fold(0.0_f32, |a, b| a.max(b.abs()));
        assert!((rms / peak - 0.707).abs() < 0.03, "{rms} of {peak}");
        // It recovers: half a second later a quiet signal passes nearly whole.
        let mut limiter = Limiter::new(RATE);
        through(&mut limiter, &sine(5.0, 4800));
        through(&mut limiter, &[0.0; 24_000]);
        assert!(through(&mut limiter, &sine(0.3, 480)).iter().fold(0.0_f32, |a, b| a.max(b.abs())) > 0.29);
    }

    #[test]
    fn direct_current_dies_away_and_the_limiter_comes_to_rest() {
        let mut limiter = Limiter::new(RATE);
        let out = through(&mut limiter, &[0.5; 48_000]);
        // Zero within single precision: -90 dB.
        assert!(out[47_999].abs() < 3e-5, "{}", out[47_999]);
        assert!(limiter.settle() > 0.4);
        through(&mut limiter, &[0.0; 96_000]);
        assert_eq!((limiter.settle(), limiter.mean), (0.0, [0.0; LANES]));
    }

    #[test]
    fn a_ramp_takes_5_ms_and_ends_exactly() {
        let mut ramp = Ramp::new(RATE);
        let mut gains = [0.0; 240];
        ramp.fill(&mut gains);
        assert!(gains[0] > 0.0 && gains[0] < 0.01 && gains[239] > 0.999);
        assert!(gains.is_sorted());
        ramp.fill(&mut gains);
        ramp.fade_out();
        assert!(!ramp.is_down());
        ramp.fill(&mut [0.0; 245]);
        assert!(ramp.is_down());
        ramp.fill(&mut gains);
        assert_eq!(gains, [0.0; 240]);
    }
}
