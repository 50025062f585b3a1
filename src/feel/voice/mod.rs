//! Voices for lasting effects: frictions, textures, grains, tones.
//!
//! No voice moves anything above 1 kHz, so that all are computed at about 12 kHz and interpolated: an eighth of the
//! work at 96 kHz. Eight voices of one model are computed side by side.
//!
//! ```text
//! SustainedCues, tones -> Voices -> Group of eight: Hiss | Impacts | Stick -> Chain (resonances, band) -> mix
//! ```

mod chain;
mod duck;
mod group;
mod hiss;
mod impacts;
mod pool;
mod single;
mod stick;
mod trim;

pub(super) use pool::{Started, Voices};

/// Voices that are computed side by side.
const LANES: usize = 8;

/// One sample of each of the voices side by side.
type Row = [f32; LANES];

/// The rate near which voices are computed, in hertz: a dozen times their highest frequency.
const LOW_HZ: f32 = 12_000.0;

/// Number of device samples per sample of the voices, and the sample rate of the voices.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LowRate {
    divisor: usize,
    hz: f32,
}

impl LowRate {
    fn of(sample_rate: f32) -> Self {
        let divisor = (sample_rate / LOW_HZ).round().max(1.0);
        Self { divisor: divisor as usize, hz: sample_rate / divisor }
    }
}

/// A random number from 0 to below 1 (Marsaglia's xorshift: cheap, and good enough for skin and ear).
#[inline(always)]
fn random(bits: &mut u32) -> f32 {
    *bits ^= *bits << 13;
    *bits ^= *bits >> 17;
    *bits ^= *bits << 5;
    (*bits >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// `tan(x)` for 0 to 0.4, an eighth of the low rate: off by less than 3e-5.
#[inline(always)]
fn tangent(x: f32) -> f32 {
    let square = x * x;
    x * (1.0 + square * (1.0 / 3.0 + square * (2.0 / 15.0 + square * (17.0 / 315.0))))
}

/// Random seeds, all different and none of them zero.
fn seeds(group: usize) -> [u32; LANES] {
    std::array::from_fn(|lane| 0x9E37_79B9_u32.wrapping_mul((group * LANES + lane) as u32 * 2 + 1))
}

/// `value` clamped to `low..=high`; `low` for NaN.
#[inline(always)]
fn within(value: f32, low: f32, high: f32) -> f32 {
    if value >= low { value.min(high) } else { low }
}
