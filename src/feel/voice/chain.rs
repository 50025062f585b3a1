//! The resonances and band filters of eight voices.

// Loops over lanes stay plain indexed loops: those are the ones that become vector instructions.
#![allow(clippy::needless_range_loop)]

use std::f32::consts::PI;

use super::{LANES, Row, tangent, within};
use crate::feel::{Band, Resonance};

/// Number of parallel resonances, and of filters in series that limit the band.
const RINGS: usize = 2;
const STAGES: usize = 4;

/// Number of filters in series that make a narrow band.
const NARROW: usize = 2;

/// Corners of the band's filters as factors of its ends: inside the band, so that little power is left outside.
const INSET: (f32, f32) = (1.12, 0.86);

/// Shapes the exciting force of eight voices: two resonances beside the bare force, then four filters in a row.
///
/// # Source
/// Trapezoidal state-variable filter, stable under every change of tuning: A. Simper, "Linear Trapezoidal Integrated
/// State Variable Filter", 2013.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(super) struct Chain {
    rings: [Filter; RINGS],
    bare: Row,
    stages: [Filter; STAGES],
}

/// The same filter in every lane, each with its own tuning.
#[derive(Clone, Debug)]
struct Filter {
    a: [Row; 3],
    /// Shares of the input, the band-pass and the low-pass in the output.
    mix: [Row; 3],
    state: [Row; 2],
}

/// The pass band of a filter.
#[derive(Clone, Copy, Debug)]
enum Pass {
    Band,
    Low,
    High,
}

/// Sharpnesses of the two halves of a fourth-order Butterworth filter.
const BUTTERWORTH: [f32; 2] = [0.541_2, 1.306_6];

impl Chain {
    pub(super) const SILENT: Self =
        Self { rings: [Filter::SILENT; RINGS], bare: [0.0; LANES], stages: [Filter::SILENT; STAGES] };

    /// Resets the state of one lane.
    pub(super) fn rest(&mut self, lane: usize) {
        for filter in self.rings.iter_mut().chain(&mut self.stages) {
            filter.state[0][lane] = 0.0;
            filter.state[1][lane] = 0.0;
        }
    }

    /// Sets one lane to a material within `band`; `bare` is the factor of the bare force.
    pub(super) fn material(
        &mut self,
        lane: usize,
        resonances: &[Resonance; RINGS],
        bare: f32,
        band: Band,
        rate: f32,
    ) {
        for (filter, resonance) in self.rings.iter_mut().zip(resonances) {
            let hz = within(resonance.hz, 20.0, 1000.0);
            let sharpness = (PI * hz * within(resonance.decay_s, 0.001, 0.2)).max(0.5);
            // An impulse of one sample makes it ring with this amplitude, for every frequency and decay.
            let share = within(resonance.amplitude, 0.0, 1.0) * rate / (2.0 * PI * hz);
            filter.tune(lane, hz, sharpness, rate);
            filter.mix_in(lane, [0.0, share, 0.0]);
        }
        self.bare[lane] = within(bare, 0.0, 1e3);
        let corners = [INSET.0 * band.low_hz, INSET.1 * band.high_hz];
        for (pair, (hz, pass)) in corners.into_iter().zip([Pass::High, Pass::Low]).enumerate() {
            for (half, sharpness) in BUTTERWORTH.into_iter().enumerate() {
                self.stages[2 * pair + half].set(lane, hz, sharpness, pass, rate);
            }
        }
    }

    /// Sets one lane to a narrow band around `hz`, for [`Chain::step_narrow`].
    pub(super) fn narrow(&mut self, lane: usize, hz: f32, sharpness: f32, rate: f32) {
        for filter in &mut self.stages[..NARROW] {
            filter.set(lane, hz, sharpness, Pass::Band, rate);
        }
    }

    /// The next sample of lanes with a narrow band.
    #[inline(always)]
    pub(super) fn step_narrow(&mut self, force: Row) -> Row {
        let mut sum = force;
        for stage in 0..NARROW {
            sum = self.stages[stage].step(sum);
        }
        sum
    }

    /// The next sample of lanes with materials: `force` strikes the two resonances, `bare` bypasses them.
    #[inline(always)]
    pub(super) fn step(&mut self, force: [Row; RINGS], bare: Row) -> Row {
        let mut sum = [0.0; LANES];
        for lane in 0..LANES {
            sum[lane] = bare[lane] * self.bare[lane];
        }
        for ring in 0..RINGS {
            let rung = self.rings[ring].step(force[ring]);
            for lane in 0..LANES {
                sum[lane] += rung[lane];
            }
        }
        for stage in 0..STAGES {
            sum = self.stages[stage].step(sum);
        }
        sum
    }

    /// Sets tiny states to zero before they become denormal numbers, which are slow to compute with.
    pub(super) fn settle(&mut self) {
        for filter in self.rings.iter_mut().chain(&mut self.stages) {
            for row in &mut filter.state {
                for value in row {
                    if value.abs() < 1e-15 {
                        *value = 0.0;
                    }
                }
            }
        }
    }
}

impl Filter {
    const SILENT: Self = Self { a: [[0.0; LANES]; 3], mix: [[0.0; LANES]; 3], state: [[0.0; LANES]; 2] };

    fn set(&mut self, lane: usize, hz: f32, sharpness: f32, pass: Pass, rate: f32) {
        self.tune(lane, hz, sharpness, rate);
        let k = sharpness.recip();
        let mix = match pass {
            Pass::Band => [0.0, k, 0.0],
            Pass::Low => [0.0, 0.0, 1.0],
            Pass::High => [1.0, -k, -1.0],
        };
        self.mix_in(lane, mix);
    }

    fn tune(&mut self, lane: usize, hz: f32, sharpness: f32, rate: f32) {
        let g = tangent(PI * hz.min(0.12 * rate) / rate);
        let a1 = 1.0 / (1.0 + g * (g + sharpness.recip()));
        self.a[0][lane] = a1;
        self.a[1][lane] = g * a1;
        self.a[2][lane] = g * g * a1;
    }

    fn mix_in(&mut self, lane: usize, mix: [f32; 3]) {
        for (row, share) in self.mix.iter_mut().zip(mix) {
            row[lane] = share;
        }
    }

    #[inline(always)]
    fn step(&mut self, input: Row) -> Row {
        let mut out = [0.0; LANES];
        for lane in 0..LANES {
            let (s1, s2) = (self.state[0][lane], self.state[1][lane]);
            let v3 = input[lane] - s2;
            let v1 = self.a[0][lane] * s1 + self.a[1][lane] * v3;
            let v2 = s2 + self.a[1][lane] * s1 + self.a[2][lane] * v3;
            self.state[0][lane] = 2.0 * v1 - s1;
            self.state[1][lane] = 2.0 * v2 - s2;
            out[lane] = self.mix[0][lane] * input[lane] + self.mix[1][lane] * v1 + self.mix[2][lane] * v2;
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f32 = 12_000.0;

    fn response(chain: &mut Chain, seconds: f32) -> Vec<f32> {
        (0..(seconds * RATE) as usize)
            .map(|n| {
                let mut row = [0.0; LANES];
                row[3] = if n == 0 { 1.0 } else { 0.0 };
                chain.step([row, [0.0; LANES]], row)[3]
            })
            .collect()
    }

    fn power_at(samples: &[f32], hz: f32) -> f32 {
        let (mut re, mut im) = (0.0, 0.0);
        for (n, sample) in samples.iter().enumerate() {
            let angle = std::f32::consts::TAU * hz * n as f32 / RATE;
            re += sample * angle.cos();
            im += sample * angle.sin();
        }
        re * re + im * im
    }

    #[test]
    fn a_resonance_rings_at_its_frequency_and_decays_in_its_time() {
        let mut chain = Chain::SILENT;
        let ring = Resonance { hz: 230.0, decay_s: 0.02, amplitude: 1.0 };
        chain.material(3, &[ring, Resonance::NONE], 0.0, Band::USEFUL, RATE);
        let samples = response(&mut chain, 0.2);
        let peak = |from: usize| samples[from..from + 60].iter().fold(0.0_f32, |peak, x| peak.max(x.abs()));
        // 40 ms apart: two decay times.
        let fallen = peak(840) / peak(360);
        assert!((fallen.ln() + 2.0).abs() < 0.1, "{fallen}");
        assert!((0.7..1.1).contains(&peak(10)), "{}", peak(10));
        assert!(power_at(&samples, 230.0) > 20.0 * power_at(&samples, 330.0));
    }

    #[test]
    fn the_band_is_kept_on_both_sides() {
        let mut chain = Chain::SILENT;
        chain.material(3, &[Resonance::NONE; 2], 1.0, Band::USEFUL, RATE);
        let samples = response(&mut chain, 0.5);
        let middle = power_at(&samples, 200.0);
        assert!((middle - 1.0).abs() < 0.1, "{middle}");
        assert!(power_at(&samples, 25.0) < 0.01 * middle && power_at(&samples, 1300.0) < 0.01 * middle);
    }
}
