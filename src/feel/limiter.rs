// Loops over lanes stay plain indexed loops: those are the ones that become vector instructions.
#![allow(clippy::needless_range_loop)]

use std::f32::consts::TAU;

use glam::{Mat4, Vec4};
use multiversion::multiversion;

use super::mix::{LANES, Mix};

/// Below this share of full scale the limiter changes nothing; our choice.
const KNEE: f32 = 0.8;

/// Samples beyond this many full scales are a fault, not a loud cue: they are cut off there and counted.
const OVERLOAD: f32 = 8.0;

/// Time in which the limiter's hold on a past peak decays to 1/e; our choice, several periods of a 50 Hz mode.
const RELEASE_S: f32 = 0.08;

/// Corner of the direct-current block: far enough below the 50 Hz where actuators begin.
const DC_BLOCK_HZ: f32 = 5.0;

/// Below this (-140 dB of full scale) what is left of a sound is dropped.
const SILENCE: f32 = 1e-7;

/// Below this a number is as good as zero, and far above the denormal numbers, which are slow to compute with.
const TRIFLE: f32 = 1e-12;

/// Keeps a group of channels within full scale, whatever comes in.
///
/// A peak limiter without look-ahead, since a person stands on the actuator
/// and waits: it follows a rising peak in the very sample (a soft ceiling from
/// 0.8 of full scale on), and lets go slowly, so that what rings on keeps its
/// shape. Then direct current is blocked and the sample held to -1..=1.
/// Samples that are not finite become silence; they and samples beyond eight
/// full scales are counted.
///
/// # Real-time
/// No allocation.
#[derive(Clone, Debug)]
pub(super) struct Limiter {
    release: f32,
    dc_pole: f32,
    lanes: Lanes,
    idle: bool,
}

#[derive(Clone, Debug, Default)]
#[repr(align(64))]
struct Lanes {
    /// The peak that is being held down.
    envelope: [f32; LANES],
    /// Whether any of them is above [`KNEE`]; if none is, and no sample either, there is nothing to limit.
    holding: bool,
    /// Last input and output of the direct-current block.
    dc_in: [f32; LANES],
    dc_out: [f32; LANES],
}

/// Samples that were faults, not sound.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Faults {
    pub(super) not_finite: u32,
    pub(super) overloaded: u32,
}

impl Limiter {
    pub(super) fn new(sample_rate: f32) -> Self {
        Self {
            release: (-1.0 / (RELEASE_S * sample_rate)).exp(),
            dc_pole: (-TAU * DC_BLOCK_HZ / sample_rate).exp(),
            lanes: Lanes::default(),
            idle: true,
        }
    }

    /// Whether silence in gives silence out.
    pub(super) fn is_idle(&self) -> bool {
        self.idle
    }

    /// Forgets all that was, at once.
    pub(super) fn clear(&mut self) {
        self.lanes = Lanes::default();
        self.idle = true;
    }

    /// Writes the samples of one of the mix's groups into `out`.
    ///
    /// `gains` is one factor per sample for all of the group's channels. `out`
    /// is interleaved, `channels` wide; only this group's samples are written.
    pub(super) fn process(
        &mut self,
        mix: &mut Mix,
        group: usize,
        gains: &[f32],
        out: &mut [f32],
        channels: usize,
    ) -> Faults {
        let first = group * LANES;
        let width = LANES.min(channels - first);
        let fed = mix.is_open(group);
        mix.open(group);
        let filters = [self.release, self.dc_pole];
        let faults = limit(&mut self.lanes, filters, mix, group, gains, &mut out[first..], [channels, width]);
        // The peak that is held alone moves nothing: with silence coming in it only decays.
        self.idle = !self.lanes.settle() && !fed;
        if self.idle {
            self.clear();
        }
        faults
    }
}

/// Limits a group of rows into `out`, `width` samples into each frame, with the widest registers this processor has.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx2+fma", "x86_64+avx2+fma", "aarch64+neon"))]
fn limit(
    lanes: &mut Lanes,
    [release, dc_pole]: [f32; 2],
    mix: &Mix,
    group: usize,
    gains: &[f32],
    out: &mut [f32],
    [channels, width]: [usize; 2],
) -> Faults {
    let mut faults = Faults::default();
    for (span, (gains, out)) in gains.chunks(LANES).zip(out.chunks_mut(LANES * channels)).enumerate() {
        let square = mix.square(group, span);
        let calm = square.iter().all(|row| row.iter().fold(true, |calm, x| calm & (x.abs() <= KNEE)));
        let mut columns = transposed(&square);
        let columns = &mut columns[..gains.len()];
        if !calm || lanes.holding {
            faults.mend(columns.as_flattened_mut());
            for column in columns.iter_mut() {
                lanes.hold_down(column, release);
            }
            lanes.holding = lanes.envelope.iter().any(|peak| *peak > KNEE);
        }
        for (column, gain) in columns.iter_mut().zip(gains) {
            lanes.block_direct_current(column, dc_pole, *gain);
        }
        for (frame, column) in out.chunks_mut(channels).zip(columns) {
            let (fours, rest) = frame[..width].as_chunks_mut::<4>();
            let (from_fours, from_rest) = column[..width].as_chunks::<4>();
            for (four, from) in fours.iter_mut().zip(from_fours) {
                *four = *from;
            }
            for (sample, from) in rest.iter_mut().zip(from_rest) {
                *sample = *from;
            }
        }
    }
    faults
}

/// Makes columns of rows, in squares of four by four.
#[inline(always)]
fn transposed(rows: &[&[f32; LANES]; LANES]) -> [[f32; LANES]; LANES] {
    let mut columns = [[0.0; LANES]; LANES];
    for lane in (0..LANES).step_by(4) {
        for n in (0..LANES).step_by(4) {
            let corner = |row: usize| Vec4::from_slice(&rows[lane + row][n..]);
            let square = Mat4::from_cols(corner(0), corner(1), corner(2), corner(3)).transpose();
            square.x_axis.write_to_slice(&mut columns[n][lane..]);
            square.y_axis.write_to_slice(&mut columns[n + 1][lane..]);
            square.z_axis.write_to_slice(&mut columns[n + 2][lane..]);
            square.w_axis.write_to_slice(&mut columns[n + 3][lane..]);
        }
    }
    columns
}

impl Lanes {
    /// Holds one frame below full scale, in a smooth curve from [`KNEE`] on.
    #[inline(always)]
    fn hold_down(&mut self, frame: &mut [f32; LANES], release: f32) {
        for lane in 0..LANES {
            let peak = larger(frame[lane].abs(), self.envelope[lane] * release);
            self.envelope[lane] = peak;
            let excess = larger(peak - KNEE, 0.0) * (1.0 / (1.0 - KNEE));
            let reach = KNEE + (1.0 - KNEE) * excess;
            frame[lane] *= (KNEE + excess) / (reach * (1.0 + excess));
        }
    }

    #[inline(always)]
    fn block_direct_current(&mut self, frame: &mut [f32; LANES], pole: f32, gain: f32) {
        for lane in 0..LANES {
            let blocked = frame[lane] - self.dc_in[lane] + pole * self.dc_out[lane];
            self.dc_in[lane] = frame[lane];
            self.dc_out[lane] = blocked;
            frame[lane] = -larger(-1.0, -larger(-1.0, blocked)) * gain;
        }
    }

    /// Makes exact zeros of what has become too small to matter, long before it would become a denormal number.
    ///
    /// The answer is whether anything is left that can still be heard.
    fn settle(&mut self) -> bool {
        let mut left = 0.0;
        for lane in 0..LANES {
            let settled = |value: f32| if value.abs() < TRIFLE { 0.0 } else { value };
            self.envelope[lane] = settled(self.envelope[lane]);
            self.dc_in[lane] = settled(self.dc_in[lane]);
            self.dc_out[lane] = settled(self.dc_out[lane]);
            left = larger(left, larger(self.dc_in[lane].abs(), self.dc_out[lane].abs()));
        }
        left >= SILENCE
    }
}

impl Faults {
    /// Silences samples that are not finite, cuts off those that are too loud, and counts both.
    fn mend(&mut self, samples: &mut [f32]) {
        for sample in samples {
            if !sample.is_finite() {
                self.not_finite += 1;
                *sample = 0.0;
            } else if sample.abs() > OVERLOAD {
                self.overloaded += 1;
                *sample = OVERLOAD.copysign(*sample);
            }
        }
    }
}

/// The larger of two numbers, in one instruction; [`f32::max`] takes three to do right by NaN, which never comes here.
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

    /// Turns towards full level.
    pub(super) fn fade_in(&mut self) {
        self.up = true;
    }

    /// Turns towards silence.
    pub(super) fn fade_out(&mut self) {
        self.up = false;
    }

    /// Whether it is on the way to silence, or there.
    pub(super) fn is_falling(&self) -> bool {
        !self.up
    }

    /// Whether it has come down to exactly zero and stays there.
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
    use crate::feel::mix::Mix;

    const RATE: f32 = 48_000.0;

    /// One channel's way through the limiter.
    fn through(limiter: &mut Limiter, input: &[f32]) -> (Vec<f32>, Faults) {
        let mut mix = Mix::new(1, input.len());
        mix.begin(input.len());
        if input.iter().any(|sample| *sample != 0.0) {
            mix.row(0).copy_from_slice(input);
        }
        let mut out = vec![f32::NAN; input.len()];
        let gains = vec![1.0; input.len()];
        let faults = limiter.process(&mut mix, 0, &gains, &mut out, 1);
        (out, faults)
    }

    fn sine(amplitude: f32, samples: usize) -> Vec<f32> {
        (0..samples).map(|n| amplitude * (TAU * 200.0 * n as f32 / RATE).sin()).collect()
    }

    #[test]
    fn a_quiet_signal_passes_as_it_is() {
        let input = sine(0.7, 4800);
        let (out, faults) = through(&mut Limiter::new(RATE), &input);
        // The block of direct current turns a 200 Hz sine by 1.4 degrees and takes its sudden start for a little of it.
        let worst = input.iter().zip(&out).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(worst < 0.7 * 0.06, "{worst}");
        assert_eq!(faults, Faults::default());
    }

    #[test]
    fn a_loud_signal_stays_below_full_scale_from_the_first_sample_on() {
        let (out, faults) = through(&mut Limiter::new(RATE), &sine(5.0, 4800));
        let peak = out.iter().fold(0.0_f32, |a, b| a.max(b.abs()));
        assert!((0.9..=1.0).contains(&peak), "{peak}");
        assert_eq!(faults, Faults::default());
        // From the second period on it is a sine again, not one with its tops cut off.
        let later = &out[480..];
        let rms = (later.iter().map(|x| x * x).sum::<f32>() / later.len() as f32).sqrt();
        let peak = later.iter().fold(0.0_f32, |a, b| a.max(b.abs()));
        assert!((rms / peak - 0.707).abs() < 0.03, "{rms} of {peak}");
    }

    #[test]
    fn what_is_not_a_number_is_silence_and_what_is_too_loud_is_cut_and_both_are_counted() {
        let mut limiter = Limiter::new(RATE);
        let input = [f32::NAN, f32::INFINITY, -f32::INFINITY, 1e9, -1e9, f32::MAX, 0.0, 0.1];
        let (out, faults) = through(&mut limiter, &input);
        assert!(out.iter().all(|x| x.is_finite() && x.abs() <= 1.0), "{out:?}");
        assert_eq!(out[..3], [0.0; 3]);
        assert_eq!(faults, Faults { not_finite: 3, overloaded: 3 });
        // And it recovers: half a second later a quiet signal passes nearly whole.
        through(&mut limiter, &[0.0; 24_000]);
        let (out, _) = through(&mut limiter, &sine(0.3, 480));
        assert!(out.iter().fold(0.0_f32, |a, b| a.max(b.abs())) > 0.29);
    }

    #[test]
    fn direct_current_dies_away_and_the_limiter_comes_to_rest() {
        let mut limiter = Limiter::new(RATE);
        let (out, _) = through(&mut limiter, &[0.5; 48_000]);
        assert!(out[47_999].abs() < 1e-6, "{}", out[47_999]);
        assert!(!limiter.is_idle());
        through(&mut limiter, &[0.0; 48_000]);
        assert!(limiter.is_idle());
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
