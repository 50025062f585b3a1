//! Resonances of single events.

use arrayvec::ArrayVec;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use crate::feel::{Click, MAX_MODES, Mode};
use crate::units::Newtons;
use underfoot_format::{Num, num, record};

/// Range of the frequencies of modes.
const HZ: Num = num(20.0..=1000.0);

/// Range of the decay times of modes.
const DECAY: Num = num(1.0..=2000.0).milli();

record! {
    /// The resonances of single events.
    pub struct Ring = "Ring", Copy => |it, faults| {
        faults.not_below(&["high_hz", "low_hz"], [it.high_hz, it.low_hz]);
        let millis = [it.longest_s, it.shortest_s].map(|seconds| seconds * 1000.0);
        faults.not_below(&["longest_ms", "shortest_ms"], millis);
    };
    /// Force at the plate of the strongest event.
    pub level: Newtons = "level_n", num(0.0..=200.0);
    /// Number of modes that ring together, 1 to `MAX_MODES`.
    pub modes: u8 = "modes", num(1.0..=MAX_MODES as f64);
    /// Lowest frequency, in hertz; 20 to 1000.
    pub low_hz: f32 = "low_hz", HZ;
    /// Highest frequency, in hertz; `low_hz` to 1000.
    pub high_hz: f32 = "high_hz", HZ;
    /// Shortest time to 1/e, in seconds; 0.001 to 2.
    pub shortest_s: f32 = "shortest_ms", DECAY;
    /// Longest time to 1/e, in seconds; `shortest_s` to 2.
    pub longest_s: f32 = "longest_ms", DECAY;
}

/// The modes of one place, excited by every event there.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaceModes {
    /// Frequency in hertz and time to 1/e in seconds, low modes first.
    modes: ArrayVec<(f32, f32), MAX_MODES>,
}

impl PlaceModes {
    /// Modes drawn from `ring`: one in each of equal parts (in octaves) of the band, so that no place has only high
    /// or only low ones; low modes ring longer, as those of every plate do.
    ///
    /// # Source
    /// `s(t) = sum a_i exp(-b_i t) sin(2 pi f_i t)`, a bank that represents the resonant response of the sheet
    /// (paper, section 4.1.1). The paper does not give the choice of its numbers.
    #[must_use]
    pub fn draw(ring: &Ring, rng: &mut Pcg64Mcg) -> Self {
        let count = usize::from(ring.modes).clamp(1, MAX_MODES);
        let octaves = (ring.high_hz / ring.low_hz).max(1.0).log2();
        let spread = (ring.longest_s / ring.shortest_s).max(1.0).ln();
        let modes = (0..count).map(|k| {
            let within = |rng: &mut Pcg64Mcg| (k as f32 + rng.random::<f32>()) / count as f32;
            let hz = ring.low_hz * (octaves * within(rng)).exp2();
            let decay_s = ring.longest_s * (-spread * within(rng)).exp();
            (hz.clamp(ring.low_hz, ring.high_hz), decay_s.clamp(ring.shortest_s, ring.longest_s))
        });
        Self { modes: modes.collect() }
    }

    /// The click of an event with `share` (0 to 1) of the maximum energy.
    ///
    /// Energy is proportional to the square of the level. Strong events excite the low modes more, weak ones the high
    /// ones; the share of each mode is random, because no two events strike the sheet in the same place. `pitch` (a
    /// factor on all frequencies) below 1 is for a sheet that has become thinner.
    #[must_use]
    pub fn strike(&self, ring: &Ring, share: f32, pitch: f32, rng: &mut Pcg64Mcg) -> Click {
        let share = share.clamp(0.0, 1.0);
        let tilt = 1.2 * share - 0.35;
        let mut sum = 0.0;
        let mut amplitudes = ArrayVec::<f32, MAX_MODES>::new();
        for (hz, _) in &self.modes {
            let sign = if rng.random::<bool>() { 1.0 } else { -1.0 };
            let amplitude = sign * (0.25 + 0.75 * rng.random::<f32>()) * (ring.low_hz / hz).powf(tilt);
            sum += amplitude.abs();
            amplitudes.push(amplitude);
        }
        let modes = self.modes.iter().zip(&amplitudes).map(|((hz, decay_s), amplitude)| Mode {
            frequency_hz: (hz * pitch).clamp(ring.low_hz, ring.high_hz),
            decay_s: *decay_s,
            // Together at most 1: the level is the maximum force at the plate.
            amplitude: (amplitude / sum.max(f32::MIN_POSITIVE)).clamp(-1.0, 1.0),
        });
        Click { modes: modes.collect(), level: ring.level * share.sqrt(), ..Click::default() }
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;

    use super::*;

    const RING: Ring = Ring {
        level: Newtons(14.0),
        modes: 6,
        low_hz: 70.0,
        high_hz: 700.0,
        shortest_s: 0.003,
        longest_s: 0.06,
    };

    #[test]
    fn modes_keep_to_their_band_and_spread_over_it() {
        for seed in 0..200 {
            let mut rng = Pcg64Mcg::seed_from_u64(seed);
            let resonance = PlaceModes::draw(&RING, &mut rng);
            let click = resonance.strike(&RING, 1.0, 1.0, &mut rng);
            assert_eq!(click.modes.len(), 6);
            assert!(click.modes.iter().all(|mode| (70.0..=700.0).contains(&mode.frequency_hz)));
            assert!(click.modes.iter().all(|mode| (0.003..=0.06).contains(&mode.decay_s)));
            assert!(click.modes.windows(2).all(|pair| pair[0].frequency_hz < pair[1].frequency_hz));
            let sum: f32 = click.modes.iter().map(|mode| mode.amplitude.abs()).sum();
            assert!((sum - 1.0).abs() < 1e-4, "{sum}");
        }
    }

    #[test]
    fn four_times_the_energy_is_twice_the_force_and_darker() {
        let mut rng = Pcg64Mcg::seed_from_u64(1);
        let resonance = PlaceModes::draw(&RING, &mut rng);
        let mut tone = |share: f32| {
            let mut centre = 0.0;
            let mut level = 0.0;
            for _ in 0..500 {
                let click = resonance.strike(&RING, share, 1.0, &mut rng);
                centre +=
                    click.modes.iter().map(|mode| mode.amplitude.abs() * mode.frequency_hz).sum::<f32>();
                level = click.level.0;
            }
            (centre / 500.0, level)
        };
        let (weak, strong) = (tone(0.25), tone(1.0));
        assert!((strong.1 / weak.1 - 2.0).abs() < 1e-4);
        assert!(strong.0 < 0.8 * weak.0, "{} Hz and {} Hz", strong.0, weak.0);
    }
}
