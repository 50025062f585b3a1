// Loops over lanes stay plain indexed loops: those are the ones that become vector instructions.
#![allow(clippy::needless_range_loop)]

use std::f32::consts::TAU;

use multiversion::multiversion;

use super::mix::LANES;

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
    /// Last input and output of the direct-current block.
    dc_in: [f32; LANES],
    dc_out: [f32; LANES],
    not_finite: [u32; LANES],
    overloaded: [u32; LANES],
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

    /// Writes one block of the group's samples into `out`.
    ///
    /// `rows` are the channels' samples, `gains` one factor per sample for
    /// all of them. `out` is interleaved, `channels` wide, and starts at the
    /// group's first channel; a group at the end may be narrower than [`LANES`].
    pub(super) fn process(
        &mut self,
        rows: &[&[f32]; LANES],
        gains: &[f32],
        out: &mut [f32],
        channels: usize,
    ) -> Faults {
        limit(&mut self.lanes, [self.release, self.dc_pole], rows, gains, out, channels);
        let faults = Faults {
            not_finite: self.lanes.not_finite.iter().sum(),
            overloaded: self.lanes.overloaded.iter().sum(),
        };
        self.lanes.not_finite = [0; LANES];
        self.lanes.overloaded = [0; LANES];
        // The envelope alone moves nothing: with silence coming in it only decays.
        let left = self.lanes.dc_out.iter().chain(&self.lanes.dc_in).fold(0.0_f32, |a, b| a.max(b.abs()));
        self.idle = left < SILENCE;
        if self.idle {
            self.clear();
        }
        faults
    }
}

#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx2+fma", "x86_64+avx2+fma", "aarch64+neon"))]
fn limit(
    lanes: &mut Lanes,
    [release, dc_pole]: [f32; 2],
    rows: &[&[f32]; LANES],
    gains: &[f32],
    out: &mut [f32],
    channels: usize,
) {
    let width = channels.min(LANES);
    for ((n, gain), frame) in gains.iter().enumerate().zip(out.chunks_mut(channels)) {
        let mut samples = [0.0; LANES];
        for lane in 0..LANES {
            samples[lane] = rows[lane][n];
        }
        for lane in 0..LANES {
            let raw = samples[lane];
            let finite = raw.abs() < f32::INFINITY;
            let sound = if finite { raw } else { 0.0 };
            let over = sound.abs() > OVERLOAD;
            lanes.not_finite[lane] += u32::from(!finite);
            lanes.overloaded[lane] += u32::from(over);
            let sound = if over { OVERLOAD.copysign(sound) } else { sound };

            // A floor far below audibility keeps the envelope from becoming a denormal number.
            let peak = sound.abs().max(lanes.envelope[lane] * release).max(1e-12);
            lanes.envelope[lane] = peak;
            let excess = (peak - KNEE).max(0.0) / (1.0 - KNEE);
            let reach = KNEE + (1.0 - KNEE) * excess;
            let limited = sound * ((KNEE + excess) / (reach * (1.0 + excess)));

            let blocked = limited - lanes.dc_in[lane] + dc_pole * lanes.dc_out[lane];
            let blocked = if blocked.abs() < 1e-12 { 0.0 } else { blocked };
            lanes.dc_in[lane] = limited;
            lanes.dc_out[lane] = blocked;
            samples[lane] = blocked.clamp(-1.0, 1.0) * gain;
        }
        let width = width.min(frame.len());
        frame[..width].copy_from_slice(&samples[..width]);
    }
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

    const RATE: f32 = 48_000.0;

    /// One channel's way through the limiter.
    fn through(limiter: &mut Limiter, input: &[f32]) -> (Vec<f32>, Faults) {
        let silence = vec![0.0; input.len()];
        let mut rows = [silence.as_slice(); LANES];
        rows[0] = input;
        let mut out = vec![f32::NAN; input.len()];
        let gains = vec![1.0; input.len()];
        let faults = limiter.process(&rows, &gains, &mut out, 1);
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
