//! Protection of coils from heat.

// Loops over lanes stay plain indexed loops: those are the ones that become vector instructions.
#![allow(clippy::needless_range_loop)]

use crate::feel::mix::LANES;
use crate::feel::modal::multiply_add;
use crate::floor::Drive;

/// Time constant of a coil's warming and cooling; our choice, of the order of a voice coil's, not measured.
const COIL_S: f32 = 3.0;

/// Time constant of the power measurement: some periods of the lowest mode.
const POWER_S: f32 = 0.03;

/// Additional power above the ceiling for each watt by which the coil is colder.
const CREDIT: f32 = 4.0;

/// Below this share of its ceiling, an attenuated coil has recovered.
const COOL: f32 = 0.7;

/// Below this share of its ceiling, a coil is cold.
const COLD: f32 = 1e-4;

/// Protects the coils of a group of channels from overheating.
///
/// The heat in a coil is the power put into it, averaged over some seconds. A cold coil takes any burst; the warmer
/// it is, the smaller the allowed power, down to the ceiling for continuous power. The ceiling lies a little below
/// the rating, so that no minute's mean exceeds it, not even for a minute that begins cold.
///
/// # Source
/// First-order thermal model `h' = (p - h) / tau`; then the energy of any time `t` is at most
/// `h_max (t + tau)`.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(super) struct Heat {
    /// Power of a steady full scale, in watts.
    watts: [f32; LANES],
    /// Maximum continuous power, in watts.
    ceiling: [f32; LANES],
    coil_samples: f32,
    power_samples: f32,
    /// Mean power over the long and the short time.
    heat: [f32; LANES],
    power: [f32; LANES],
    gain: [f32; LANES],
    /// Whether a channel is attenuated.
    down: [bool; LANES],
    /// Whether any coil is warm.
    warm: bool,
}

impl Heat {
    /// Cold coils without power.
    pub(super) fn new(sample_rate: f32) -> Self {
        Self {
            watts: [0.0; LANES],
            ceiling: [f32::INFINITY; LANES],
            coil_samples: COIL_S * sample_rate,
            power_samples: POWER_S * sample_rate,
            heat: [0.0; LANES],
            power: [0.0; LANES],
            gain: [1.0; LANES],
            down: [false; LANES],
            warm: false,
        }
    }

    /// Sets the drive of one channel's coil.
    pub(super) fn set(&mut self, lane: usize, drive: &Drive) {
        self.watts[lane] = drive.full_scale_w();
        self.ceiling[lane] = drive.long_term_w * 0.99 * 60.0 / (60.0 + COIL_S);
    }

    /// Attenuates channels with too much power, in place; returns the number of channels newly attenuated.
    ///
    /// `energy` is the sum of the samples' squares. The samples are within full scale already, and no later stage
    /// amplifies them.
    #[inline(always)]
    pub(super) fn run<const FUSED: bool>(
        &mut self,
        columns: &mut [[f32; LANES]],
        energy: &[f32; LANES],
    ) -> u32 {
        let samples = columns.len() as f32;
        let (short, long) =
            (samples / (samples + self.power_samples), samples / (samples + self.coil_samples));
        let (mut power, mut allowed, mut calm) = ([0.0; LANES], [0.0; LANES], true);
        for lane in 0..LANES {
            power[lane] = energy[lane] / samples * self.watts[lane];
            self.power[lane] += (power[lane] - self.power[lane]) * short;
            allowed[lane] = self.ceiling[lane] + CREDIT * (self.ceiling[lane] - self.heat[lane]);
            calm &= (self.power[lane] <= allowed[lane]) & (self.gain[lane] == 1.0);
        }
        let wanted = if calm { [1.0; LANES] } else { self.wanted(&allowed) };
        for lane in 0..LANES {
            let mean_gain = 0.5 * (self.gain[lane] + wanted[lane]);
            self.heat[lane] += (power[lane] * mean_gain * mean_gain - self.heat[lane]) * long;
            // Interruptions while the coil stays hot belong to one and the same fault.
            self.down[lane] &= (wanted[lane] < 1.0) | (self.heat[lane] > COOL * self.ceiling[lane]);
        }
        self.warm = true;
        if calm { 0 } else { self.turn::<FUSED>(columns, &wanted) }
    }

    /// The gains that reduce the power to the allowed one: `sqrt(allowed / power)`.
    fn wanted(&self, allowed: &[f32; LANES]) -> [f32; LANES] {
        let mut wanted = [1.0; LANES];
        for lane in 0..LANES {
            let share = if allowed[lane] > 0.0 { allowed[lane] / self.power[lane] } else { 0.0 };
            wanted[lane] = if self.power[lane] > allowed[lane] { share.sqrt() } else { 1.0 };
        }
        wanted
    }

    /// Applies the wanted gains, in a straight line from the last ones.
    #[inline(always)]
    fn turn<const FUSED: bool>(&mut self, columns: &mut [[f32; LANES]], wanted: &[f32; LANES]) -> u32 {
        let samples = columns.len() as f32;
        let mut slope = [0.0; LANES];
        for lane in 0..LANES {
            slope[lane] = (wanted[lane] - self.gain[lane]) / samples;
        }
        for (n, column) in (1_u16..).zip(columns) {
            for lane in 0..LANES {
                column[lane] *= multiply_add::<FUSED>(slope[lane], f32::from(n), self.gain[lane]);
            }
        }
        let mut begun = 0;
        for lane in 0..LANES {
            begun += u32::from(wanted[lane] < 1.0 && !self.down[lane]);
            self.down[lane] |= wanted[lane] < 1.0;
        }
        self.gain = *wanted;
        begun
    }

    /// Cools the coils for so many silent samples.
    pub(super) fn rest(&mut self, samples: usize) {
        if !self.warm {
            return;
        }
        let left = |time: f32| (-(samples as f32) / time).exp();
        let (short, long) = (left(self.power_samples), left(self.coil_samples));
        self.warm = false;
        for lane in 0..LANES {
            self.power[lane] *= short;
            self.heat[lane] *= long;
            self.gain[lane] = 1.0;
            self.down[lane] = false;
            let cold = self.heat[lane].max(self.power[lane]) <= COLD * self.watts[lane];
            if cold {
                (self.heat[lane], self.power[lane]) = (0.0, 0.0);
            }
            self.warm |= !cold;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f32 = 48_000.0;

    /// Mean power, in watts, of a steady square wave of full scale on channel 2 in each second, and the count of
    /// attenuations.
    fn driven(heat: &mut Heat, seconds: usize) -> (Vec<f32>, u32) {
        let (mut watts, mut begun) = (Vec::new(), 0);
        for _ in 0..seconds {
            let mut energy = 0.0;
            for _ in 0..750 {
                let mut columns = [[0.0; LANES]; 64];
                for (n, column) in columns.iter_mut().enumerate() {
                    column[2] = if n < 32 { 1.0 } else { -1.0 };
                }
                let mut squares = [0.0; LANES];
                squares[2] = 64.0;
                begun += heat.run::<false>(&mut columns, &squares);
                energy += columns.iter().map(|column| column[2] * column[2]).sum::<f32>();
            }
            watts.push(energy / RATE * Drive::default().full_scale_w());
        }
        (watts, begun)
    }

    fn paper() -> Heat {
        let mut heat = Heat::new(RATE);
        heat.set(2, &Drive::default());
        heat
    }

    // A9
    #[test]
    fn no_minute_takes_more_than_the_rating_not_even_one_that_begins_cold() {
        let (watts, begun) = driven(&mut paper(), 120);
        assert!(watts[0] > 200.0, "a cold coil takes a burst: {} W", watts[0]);
        for minute in watts.windows(60) {
            let mean = minute.iter().sum::<f32>() / 60.0;
            assert!((70.0..=80.0).contains(&mean), "{mean} W");
        }
        assert_eq!(begun, 1, "one long stretch of too much counts once");
    }

    #[test]
    fn a_coil_that_has_rested_takes_a_burst_again() {
        let mut heat = paper();
        driven(&mut heat, 10);
        for _ in 0..20 * 750 {
            heat.rest(64);
        }
        assert!(driven(&mut heat, 1).0[0] > 200.0);
        for _ in 0..60 * 750 {
            heat.rest(64);
        }
        assert!(!heat.warm && heat.heat == [0.0; LANES], "what has cooled down costs nothing");
    }

    #[test]
    fn gains_change_without_a_step() {
        let mut heat = paper();
        let mut last = 1.0;
        for _ in 0..750 * 5 {
            let mut columns = [[1.0; LANES]; 64];
            heat.run::<false>(&mut columns, &[64.0; LANES]);
            for column in columns {
                assert!((column[2] - last).abs() < 0.01);
                last = column[2];
            }
        }
        assert!(last < 0.6, "turned down by now: {last}");
    }
}
