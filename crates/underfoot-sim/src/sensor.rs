//! One force-sensing resistor and its converter: newtons in, volts and counts out.

use std::f32::consts::TAU;

use rand::{Rng, RngExt};
use rand_pcg::Pcg64Mcg;

use underfoot::floor::{Calibration, Divider, LawKind};
use underfoot::units::Newtons;

/// Tolerances of the sensors of a simulated floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartConfig {
    /// The law of an average part.
    pub nominal: Calibration,
    /// Largest deviation of the first number of a part's law from nominal, as a share (0 to 0.9).
    pub a_spread: f32,
    /// Largest deviation of its second number from nominal, as a share (0 to 0.5).
    pub b_spread: f32,
    /// Mean deviation of the parts from their law: root mean square of the force error after the best fit,
    /// averaged over the parts, as a share of full scale (0 to 0.08).
    pub deviation: f32,
    /// Standard deviation of the noise, in volts; counts have noise of at least half a count, as with real
    /// converters.
    pub noise_v: f32,
    /// Standard deviation of further noise in counts, as a share of the force (0 to 0.2).
    pub noise_share: f32,
    /// Width of the hysteresis loop: relative difference between the readings of a falling and a rising force.
    pub hysteresis: f32,
    /// Growth of the reading under a steady force per decade of time from 0.1 to 1000 s, as a share.
    pub creep: f32,
    /// Upper limit of a part's reading, in newtons: a force `f` reads as `f / (1 + (f / limit)^6)^(1/6)`, which is 11
    /// % too little at the limit and 3 % at eight tenths of it. Infinite if only the converter limits the range.
    pub saturation_n: f32,
}

impl Default for PartConfig {
    /// The paper's parts: 25 % and 5 % from part to part, about 5 % error after calibration, 2 mV of noise, no
    /// hysteresis, no creep.
    fn default() -> Self {
        Self {
            nominal: Calibration::NOMINAL,
            a_spread: 0.25,
            b_spread: 0.05,
            deviation: 0.05,
            noise_v: 0.002,
            noise_share: 0.0,
            hysteresis: 0.0,
            creep: 0.0,
            saturation_n: f32::INFINITY,
        }
    }
}

impl PartConfig {
    /// Parts that all follow the nominal law without noise; only the converter limits their range.
    #[must_use]
    pub const fn exact() -> Self {
        Self {
            nominal: Calibration::NOMINAL,
            a_spread: 0.0,
            b_spread: 0.0,
            deviation: 0.0,
            noise_v: 0.0,
            noise_share: 0.0,
            hysteresis: 0.0,
            creep: 0.0,
            saturation_n: f32::INFINITY,
        }
    }

    /// The same parts with the hysteresis and creep of a force-sensing resistor
    /// (10 % and 5 % per decade, the maker's figures).
    #[must_use]
    pub const fn with_memory(self) -> Self {
        Self { hysteresis: 0.1, creep: 0.05, ..self }
    }

    /// True if a reading depends on earlier loads.
    pub(super) const fn has_memory(&self) -> bool {
        self.hysteresis > 0.0 || self.creep > 0.0
    }
}

/// Fault of one sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SensorFault {
    /// The reading stays at its value from the onset of the fault.
    Stuck,
    /// The line is open: no current, 0 counts.
    Open,
    /// The line is short-circuited: full scale.
    Short,
    /// A constant additional force on the sensor, in newtons; may be negative.
    Offset(Newtons),
}

/// One part with its tolerances.
#[derive(Clone, Debug)]
pub(super) struct SensorPart {
    pub(super) law: Calibration,
    deviation: Deviation,
    /// As [`PartConfig::saturation_n`].
    saturation_n: f32,
}

impl SensorPart {
    /// Draws the next part.
    pub(super) fn draw(config: &PartConfig, rng: &mut Pcg64Mcg) -> Self {
        let mut spread = |share: f32| 1.0 + rng.random_range(-1.0f32..=1.0) * share;
        let [a, b] = config.nominal.numbers();
        let a = a * spread(config.a_spread.clamp(0.0, 0.9));
        let law = Calibration::of(config.nominal.kind(), [a, b * spread(config.b_spread.clamp(0.0, 0.5))]);
        let saturation_n =
            if config.saturation_n.is_nan() { f32::INFINITY } else { config.saturation_n.max(LEAST_FORCE) };
        Self { law, deviation: Deviation::draw(law, config.deviation.clamp(0.0, 0.08), rng), saturation_n }
    }

    /// Returns the output under a steady force, before noise and converter: 0 volts below the part's threshold, more
    /// than full scale if the converter saturates.
    pub(super) fn volts(&self, force: f32) -> f32 {
        let force = self.bounded(force);
        let apparent = force * self.deviation.at(force);
        // Below the threshold of its law the voltage is negative or not a number, and `max` returns zero.
        self.law.volts_at(Newtons(apparent)).max(0.0)
    }

    /// The output `volts` with an error of its force, as a share of that force; an output of zero has none.
    pub(super) fn with_force_error(&self, volts: f32, error: f32) -> f32 {
        let noisy = self.law.volts_at(self.law.force_at(volts) * (1.0 + error));
        if volts > 0.0 && noisy.is_finite() { noisy } else { volts }
    }

    /// Effective force with soft saturation: `f / (1 + (f / limit)^6)^(1/6)`.
    fn bounded(&self, force: f32) -> f32 {
        if self.saturation_n.is_infinite() || force <= 0.0 {
            return force;
        }
        force / (1.0 + (force / self.saturation_n).powi(6)).powf(1.0 / 6.0)
    }

    /// Force at which the converter reaches full scale, or at which the part itself saturates.
    pub(super) fn capacity(&self) -> f32 {
        // The apparent force grows with the force, so bisection finds the crossing.
        let end = end_of_range(&self.law);
        let (mut low, mut high) = (0.0, 4.0 * self.law.force_at(end).0);
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if self.volts(middle) < end { low = middle } else { high = middle }
        }
        high.min(self.saturation_n)
    }
}

/// Share of a divider's supply at which its range ends: beyond it a newton changes the voltage by less than a
/// thousandth of what it does at the light end.
const DIVIDER_END: f32 = 0.95;

/// Voltage at the end of a part's range: the converter's full scale, less for a divider.
fn end_of_range(law: &Calibration) -> f32 {
    match law {
        Calibration::Divider(Divider { supply_v, .. }) => {
            (DIVIDER_END * supply_v).min(Calibration::FULL_SCALE_VOLTS)
        }
        _ => Calibration::volts(u16::MAX),
    }
}

/// The converter's reading of `volts`, clamped to 0 and full scale.
pub(super) fn counts(volts: f32) -> u16 {
    // The cast saturates.
    (volts * (f32::from(u16::MAX) / Calibration::FULL_SCALE_VOLTS)).round() as u16
}

/// Smooth deviation of one part from its law: a factor `exp(A cos(w s^(3/4) + phase))` at the share `s`
/// of the full range.
///
/// About two waves over the range, a little denser at the light end. With this shape the error after the best fit is
/// about the same for light and for heavy loads.
#[derive(Clone, Copy, Debug)]
struct Deviation {
    /// Inverse of the force at full scale.
    per_full: f32,
    /// Amplitude `A` of the logarithm of the force.
    amplitude: f32,
    /// `w`: radians over the whole range. The fit's two parameters would follow a lower value.
    wave: f32,
    phase: f32,
}

impl Deviation {
    /// Draws a curve that leaves an error of about `residual` after the best fit, varying by a fifth from part to
    /// part.
    fn draw(law: Calibration, residual: f32, rng: &mut Pcg64Mcg) -> Self {
        let full = law.force_at(end_of_range(&law)).0;
        let mut deviation = Self { per_full: 1.0 / full, amplitude: 0.0, wave: 0.0, phase: 0.0 };
        if residual <= 0.0 {
            return deviation;
        }
        let target = residual * rng.random_range(0.8..=1.2);
        // For some phases, so large an error would need a reading that falls while the force grows. Draw again.
        for _ in 0..32 {
            deviation.wave = rng.random_range(10.0..13.0);
            deviation.phase = rng.random_range(0.0..TAU);
            deviation.amplitude = 0.85 / deviation.steepest();
            let left = deviation.left_after_fit(law, full);
            if left >= target {
                deviation.amplitude *= target / left;
                break;
            }
        }
        deviation
    }

    /// Apparent force divided by force.
    fn at(&self, force: f32) -> f32 {
        (self.amplitude * self.angle(force * self.per_full).cos()).exp()
    }

    /// Angle of the wave at a share of the full range.
    fn angle(&self, share: f32) -> f32 {
        let root = share.max(0.0).sqrt();
        self.wave * root * root.sqrt() + self.phase
    }

    /// Maximum downward slope of the wave over the logarithm of the force, per unit of amplitude; at least 1.
    fn steepest(&self) -> f32 {
        (1..=64)
            .map(|step| step as f32 / 64.0)
            .map(|share| self.angle(share).sin() * 0.75 * self.wave * share.powf(0.75))
            .fold(1.0, f32::max)
    }

    /// Root mean square of the deviation after the best change of the law's two numbers (to first order), as a share of
    /// full scale, evenly over force.
    fn left_after_fit(&self, law: Calibration, full: f32) -> f32 {
        const STEPS: usize = 64;
        // For each force: effect of a change of ln a, effect of a change of the second number, and the deviation.
        let rows: [[f64; 3]; STEPS] = std::array::from_fn(|step| {
            let share = (step as f64 + 0.5) / STEPS as f64;
            let force = full * share as f32;
            let volts = law.volts_at(Newtons(force)).max(0.0);
            [
                share,
                share * f64::from(second_effect(&law, volts, force)),
                share * f64::from(self.at(force) - 1.0),
            ]
        });
        let dot = |i: usize, j: usize| rows.iter().map(|row| row[i] * row[j]).sum::<f64>();
        let (aa, ab, bb, ad, bd, dd) = (dot(0, 0), dot(0, 1), dot(1, 1), dot(0, 2), dot(1, 2), dot(2, 2));
        let followed = (ad * ad * bb - 2.0 * ad * bd * ab + bd * bd * aa) / (aa * bb - ab * ab);
        ((dd - followed).max(0.0) / STEPS as f64).sqrt() as f32
    }
}

/// Relative change of the force per change of the law's second number, to a constant factor.
fn second_effect(law: &Calibration, volts: f32, force: f32) -> f32 {
    match (law.kind(), law.numbers()) {
        (LawKind::Exponential, _) => volts,
        (LawKind::Power, _) => volts.max(f32::MIN_POSITIVE).ln(),
        (LawKind::Divider, [_, supply]) => 1.0 / (supply - volts).max(f32::MIN_POSITIVE),
        (LawKind::Linear, _) => 1.0 / force,
    }
}

/// Memory of one sensor.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SensorMemory {
    /// Logarithm of the force at the lagging part of the hysteresis loop.
    lag: Option<f32>,
    /// Force, low-pass filtered over 0.1, 1, 10, 100 and 1000 seconds.
    crept: [f64; 5],
}

/// Time constants of creep, in milliseconds.
const CREEP_MS: [f64; 5] = [1e2, 1e3, 1e4, 1e5, 1e6];

impl SensorMemory {
    /// Memory of a sensor after an infinite time under `force`.
    pub(super) fn settled(force: f32) -> Self {
        Self { lag: Some(force.max(LEAST_FORCE).ln()), crept: [f64::from(force.max(0.0)); 5] }
    }

    /// Returns the effective force after `elapsed_ms` (fewer than 100 ms) under `force`.
    ///
    /// # Source
    /// Hysteresis: half of the logarithm of the force follows with a play, the elementary operator of the
    /// Prandtl-Ishlinskii model. Creep: five first-order low-pass filters a decade apart sum to a straight line over
    /// log time.
    pub(super) fn felt(&mut self, force: f32, elapsed_ms: u32, config: &PartConfig) -> f32 {
        let pressed = force.max(0.0);
        let mut crept = 0.0;
        for (follower, time_ms) in self.crept.iter_mut().zip(CREEP_MS) {
            *follower += (f64::from(pressed) - *follower) * f64::from(elapsed_ms) / time_ms;
            crept += *follower;
        }
        let grown = pressed + config.creep * crept as f32;
        let log = grown.max(LEAST_FORCE).ln();
        // Half of the reading lags by `play` in either direction, so the loop is `play` wide.
        let play = config.hysteresis;
        let lag = self.lag.map_or(log, |lag| lag.clamp(log - play, log + play));
        self.lag = Some(lag);
        (0.5 * (log + lag)).exp()
    }
}

/// Minimum force in logarithms (N); no part has a reading below it.
const LEAST_FORCE: f32 = 1e-3;

/// Draws approximately from the standard normal distribution: the sum of four uniform values, never beyond 3.5.
pub(super) fn normal(rng: &mut Pcg64Mcg) -> f32 {
    let bits = rng.next_u64();
    let sum = (bits & 0xffff) + (bits >> 16 & 0xffff) + (bits >> 32 & 0xffff) + (bits >> 48);
    // Mean 2 x 65535; each term's variance is 65536^2 / 12.
    (sum as f32 - 131_070.0) * (1.0 / 37_837.2)
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;

    use super::*;
    use underfoot::sense::{Fit, LoadPoint};

    fn parts(config: &PartConfig) -> Vec<SensorPart> {
        let mut rng = Pcg64Mcg::seed_from_u64(11);
        (0..400).map(|_| SensorPart::draw(config, &mut rng)).collect()
    }

    #[test]
    fn parts_spread_by_a_quarter_in_a_and_a_twentieth_in_b() {
        let config = PartConfig::default();
        let (mut a, mut b): (Vec<f32>, Vec<f32>) = parts(&config)
            .iter()
            .map(|part| (part.law.numbers()[0] / 0.5, part.law.numbers()[1] / 1.34))
            .unzip();
        for (values, spread) in [(&mut a, 0.25), (&mut b, 0.05)] {
            values.sort_by(f32::total_cmp);
            let mean = values.iter().sum::<f32>() / 400.0;
            assert!((mean - 1.0).abs() < 0.1 * spread, "{mean}");
            assert!(values[0] >= 1.0 - spread && values[0] < 1.0 - 0.95 * spread);
            assert!(values[399] <= 1.0 + spread && values[399] > 1.0 + 0.95 * spread);
        }
    }

    #[test]
    fn about_five_percent_of_full_scale_is_left_after_the_best_fit() {
        let residuals: Vec<f32> = parts(&PartConfig::default())
            .iter()
            .map(|part| {
                let top = 0.98 * part.capacity();
                let points: Vec<_> = (1..=60)
                    .map(|step| top * step as f32 / 60.0)
                    .map(|force| LoadPoint::new(part.volts(force), Newtons(force)))
                    .collect();
                Fit::of(&points).unwrap().residual
            })
            .collect();
        let mean = residuals.iter().sum::<f32>() / 400.0;
        let worst = residuals.iter().copied().fold(0.0, f32::max);
        assert!((0.042..0.058).contains(&mean), "{mean}");
        assert!(worst < 0.09, "{worst}");
    }

    #[test]
    fn a_heavier_load_always_reads_more() {
        for part in parts(&PartConfig { deviation: 0.08, ..PartConfig::default() }) {
            let top = part.capacity();
            let volts: Vec<f32> = (0..=500).map(|k| part.volts(top * k as f32 / 500.0)).collect();
            let rising = volts.windows(2).all(|pair| pair[1] > pair[0] || pair[1] == 0.0);
            assert!(rising && volts[500] > 4.999, "{part:?}");
        }
    }

    #[test]
    fn an_exact_part_reads_back_what_pressed_it_until_it_saturates() {
        let part = &parts(&PartConfig::exact())[0];
        for force in [1.0, 20.0, 175.0, 400.0] {
            let read = part.law.force(counts(part.volts(force))).0;
            assert!((read - force).abs() < 1e-4 * force + 1e-3, "{read} for {force}");
        }
        assert_eq!(counts(part.volts(407.0)), u16::MAX);
        assert_eq!(counts(part.volts(5000.0)), u16::MAX);
        for nothing in [0.4, 0.0, -30.0, f32::NAN] {
            assert_eq!(counts(part.volts(nothing)), 0, "{nothing}");
        }
    }

    #[test]
    fn parts_of_every_law_read_back_what_pressed_them_and_end_within_their_range() {
        for (kind, numbers) in [
            (LawKind::Exponential, [0.5, 1.34]),
            (LawKind::Power, [2.2, 3.1]),
            (LawKind::Divider, [45.0, 5.0]),
            (LawKind::Linear, [82.0, 0.4]),
        ] {
            let nominal = Calibration::of(kind, numbers);
            let config = PartConfig { nominal, a_spread: 0.25, b_spread: 0.05, ..PartConfig::exact() };
            for part in parts(&config) {
                for share in [0.1, 0.5, 0.97] {
                    let force = share * part.capacity();
                    let read = part.law.force(counts(part.volts(force))).0;
                    assert!((read / force - 1.0).abs() < 2e-3, "{:?}: {read} for {force}", part.law);
                    let heavier = part.law.force_at(part.with_force_error(part.volts(force), 0.02)).0;
                    assert!((heavier / force - 1.02).abs() < 1e-3, "{:?}: {heavier} for {force}", part.law);
                }
            }
            let (mut left, deviating) = (0.0, PartConfig { deviation: 0.03, ..config });
            for part in parts(&deviating) {
                let forces = (1..=50).map(|step| part.capacity() * step as f32 / 50.0);
                let points: Vec<_> =
                    forces.map(|force| LoadPoint::new(part.volts(force), Newtons(force))).collect();
                left += Fit::of_kind(&points, kind).unwrap().residual / 400.0;
            }
            assert!((0.02..0.04).contains(&left), "{kind:?}: {left}");
        }
    }

    #[test]
    fn a_soft_part_reads_ever_less_of_a_force_near_its_limit() {
        let part = &parts(&PartConfig { saturation_n: 300.0, ..PartConfig::exact() })[0];
        let read = |force: f32| part.law.force(counts(part.volts(force))).0;
        for (force, expected) in [(100.0, 99.98), (240.0, 230.5), (300.0, 267.3), (600.0, 299.2)] {
            assert!((read(force) - expected).abs() < 0.5, "{} for {force}", read(force));
        }
        assert_eq!(part.capacity(), 300.0);
    }

    #[test]
    fn noise_is_centred_and_has_unit_spread() {
        let mut rng = Pcg64Mcg::seed_from_u64(5);
        let draws: Vec<f32> = (0..100_000).map(|_| normal(&mut rng)).collect();
        let mean = draws.iter().sum::<f32>() / 1e5;
        let variance = draws.iter().map(|draw| draw * draw).sum::<f32>() / 1e5;
        assert!(mean.abs() < 0.02 && (variance - 1.0).abs() < 0.02, "{mean}, {variance}");
    }

    #[test]
    fn a_falling_force_reads_more_than_a_rising_one_by_the_loop_s_width() {
        let config = PartConfig { hysteresis: 0.1, ..PartConfig::exact() };
        let mut memory = SensorMemory::settled(1.0);
        let mut run = |from: f32, to: f32| {
            let mut felt = 0.0;
            for step in 0..=1000 {
                felt = memory.felt(from + (to - from) * step as f32 / 1000.0, 1, &config);
            }
            felt
        };
        let rising = run(1.0, 100.0);
        run(100.0, 200.0);
        let falling = run(200.0, 100.0);
        assert!((falling / rising - 1.1).abs() < 0.01, "{rising} up, {falling} down");
    }

    #[test]
    fn a_standing_load_creeps_by_five_percent_per_decade_and_leaves_again() {
        let config = PartConfig { creep: 0.05, ..PartConfig::exact() };
        let mut memory = SensorMemory::settled(0.0);
        let mut after = |from_ms: usize, to_ms: usize, force: f32| {
            (from_ms..to_ms).map(|_| memory.felt(force, 1, &config)).last().unwrap()
        };
        let (second, ten, hundred) =
            (after(0, 1000, 100.0), after(1000, 10_000, 100.0), after(10_000, 100_000, 100.0));
        for (early, late) in [(second, ten), (ten, hundred)] {
            let growth = (late - early) / 100.0;
            assert!((0.045..0.055).contains(&growth), "{growth}");
        }
        assert!(after(0, 1, 0.0) > 5.0, "what crept in stays at first");
        assert!(after(0, 200_000, 0.0) < 6.0);
    }
}
