//! Conversion of the sample rate.

#![deny(clippy::disallowed_macros, clippy::disallowed_methods, clippy::disallowed_types)]

use std::f64::consts::PI;

/// Number of neighbours in one output sample, at the slower of the two rates.
const TAPS: usize = 32;

/// Number of positions between two samples with stored weights; weights between them are interpolated.
const PHASES: usize = 256;

/// Pass band as a share of the narrower band: actuators end at 1 kHz, far below, so that their signals pass
/// unchanged.
const PASS: f64 = 0.8;

/// Converts frames from one sample rate to another, continuously.
///
/// Windowed-sinc interpolation; the delay is 16 frames of the slower rate. Frames are interleaved.
///
/// # Real-time
/// Allocates all memory at creation.
#[derive(Debug)]
pub(super) struct Resampler {
    channels: usize,
    /// Output frames per second.
    rate: u32,
    /// Maximum number of output frames per call.
    most: usize,
    /// Input frames per output frame.
    step: f64,
    /// Position of the next output frame's first neighbour, in frames of `kept`.
    position: f64,
    /// Input frames that are still needed.
    kept: Vec<f32>,
    /// Number of neighbours in one output sample; even.
    taps: usize,
    /// Weights of the neighbours, phase after phase.
    weights: Vec<f32>,
}

impl Resampler {
    /// Converts from `from` to `to` samples per second with at most `most` input frames per call.
    pub(super) fn new(channels: usize, from: u32, to: u32, most: usize) -> Self {
        let step = f64::from(from) / f64::from(to.max(1));
        let band = PASS * (1.0 / step).min(1.0);
        let taps = (TAPS as f64 * step.max(1.0) / 2.0).ceil() as usize * 2;
        let weights =
            (0..=PHASES).flat_map(|phase| weights(phase as f64 / PHASES as f64, band, taps)).collect();
        let mut kept = Vec::with_capacity((2 * taps + most + step.ceil() as usize) * channels);
        kept.resize(taps * channels, 0.0);
        // One frame less, since the first one may need another neighbour.
        let most = ((most.saturating_sub(1) as f64 / step.max(1.0)) as usize).max(1);
        Self { channels, rate: to, most, step, position: 0.0, kept, taps, weights }
    }

    /// Returns the output frames per second.
    pub(super) fn rate(&self) -> u32 {
        self.rate
    }

    /// Returns the maximum number of output frames per call.
    pub(super) fn most(&self) -> usize {
        self.most
    }

    /// Returns the number of input frames needed before `frames` output frames.
    pub(super) fn needed(&self, frames: usize) -> usize {
        if frames == 0 {
            return 0;
        }
        let last = self.position + (frames - 1) as f64 * self.step;
        (last.floor() as usize + self.taps + 1).saturating_sub(self.kept_frames())
    }

    /// Returns the time from the next output frame to the next input frame, in input frames; includes the delay.
    pub(super) fn ahead(&self) -> f64 {
        self.kept_frames() as f64 - (self.position + self.taps as f64 / 2.0 - 1.0)
    }

    /// Appends input frames.
    pub(super) fn take(&mut self, frames: &[f32]) {
        self.kept.extend_from_slice(frames);
    }

    /// Fills `out` with output frames; missing input counts as silence.
    pub(super) fn give(&mut self, out: &mut [f32]) {
        let Self { channels, step, position, kept, taps, weights, .. } = self;
        for frame in out.chunks_exact_mut((*channels).max(1)) {
            let whole = position.floor();
            let place = (*position - whole) * PHASES as f64;
            let between = place.fract() as f32;
            let first = whole as usize * *channels;
            let weights = |phase: usize| weights.chunks_exact(*taps).nth(phase).unwrap_or(&[]);
            let (low, high) = (weights(place as usize), weights((place as usize + 1).min(PHASES)));
            for (channel, sample) in frame.iter_mut().enumerate() {
                let neighbours = kept.get(first + channel..).unwrap_or(&[]).iter().step_by(*channels);
                *sample = neighbours
                    .zip(low.iter().zip(high))
                    .map(|(sample, (low, high))| sample * (low + (high - low) * between))
                    .sum();
            }
            *position += *step;
        }
        let done = (position.floor() as usize).min(self.kept.len() / self.channels.max(1));
        self.kept.drain(..done * self.channels);
        self.position -= done as f64;
    }

    fn kept_frames(&self) -> usize {
        self.kept.len() / self.channels.max(1)
    }
}

/// Returns the weight of each neighbour for a sample at the fraction `between` of the interval between the middle
/// two.
fn weights(between: f64, band: f64, taps: usize) -> Vec<f32> {
    let half = taps as f64 / 2.0;
    let weight = |tap: usize| {
        let x = tap as f64 - (half - 1.0) - between;
        let sinc = if x == 0.0 { band } else { (PI * band * x).sin() / (PI * x) };
        // Blackman-Harris window: side lobes are 92 dB down.
        let phase = PI * (x / half + 1.0);
        let window = 0.358_75 - 0.488_29 * phase.cos() + 0.141_28 * (2.0 * phase).cos()
            - 0.011_68 * (3.0 * phase).cos();
        sinc * window
    };
    // Normalised, so that a constant signal is unchanged.
    let sum: f64 = (0..taps).map(weight).sum();
    (0..taps).map(|tap| (weight(tap) / sum) as f32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the ratio of error to signal in decibels, for a sine on the second of two channels.
    fn error_db(from: u32, to: u32, hz: f64) -> f64 {
        let mut resampler = Resampler::new(2, from, to, 64);
        let sine = |n: f64, rate: u32| (n / f64::from(rate) * hz * 2.0 * PI).sin();
        let (mut taken, mut given) = (0, 0);
        let (mut signal, mut error) = (0.0, 0.0);
        // Time of the first output frame, in input frames.
        let delay = resampler.ahead();
        while given < to as usize / 4 {
            // Blocks of uneven length.
            let frames = 40 + given % 24;
            let needed = resampler.needed(frames);
            let block: Vec<f32> =
                (taken..taken + needed).flat_map(|n| [0.0, sine(n as f64, from) as f32]).collect();
            resampler.take(&block);
            taken += needed;
            let mut out = vec![9.0; frames * 2];
            resampler.give(&mut out);
            for (n, frame) in out.chunks(2).enumerate() {
                assert_eq!(frame[0], 0.0);
                let at = (given + n) as f64 * f64::from(from) / f64::from(to) - delay;
                if at > resampler.taps as f64 {
                    let truth = sine(at, from);
                    signal += truth * truth;
                    error += (f64::from(frame[1]) - truth).powi(2);
                }
            }
            given += frames;
        }
        10.0 * (error / signal).log10()
    }

    #[test]
    fn what_actuators_play_passes_unchanged_between_all_rates() {
        let rates = [8_000, 44_100, 48_000, 96_000, 192_000];
        for from in rates {
            for to in rates {
                for hz in [50.0, 200.0, 1000.0] {
                    let error = error_db(from, to, hz);
                    assert!(error < -75.0, "{from} to {to}, {hz} Hz: {error:.1} dB");
                }
            }
        }
    }

    #[test]
    fn what_the_slower_rate_cannot_carry_is_taken_away() {
        // Aliasing would turn 30 kHz at 96 kHz into 14 kHz at 44.1 kHz.
        let mut resampler = Resampler::new(1, 96_000, 44_100, 4410);
        let block: Vec<f32> = (0..resampler.needed(4410))
            .map(|n| (n as f64 / 96_000.0 * 30_000.0 * 2.0 * PI).sin() as f32)
            .collect();
        resampler.take(&block);
        let mut out = vec![0.0; 4410];
        resampler.give(&mut out);
        let loudest = out[TAPS..].iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
        assert!(loudest < 0.003, "{loudest}");
    }
}
