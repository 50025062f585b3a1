//! Figures measured from rendered samples: peak, level, share of energy in a band.

use std::f64::consts::TAU;

use super::Band;

/// Figures of a stretch of rendered samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Analysis {
    /// Maximum absolute sample.
    pub peak: f32,
    /// Root mean square of all samples.
    pub rms: f32,
    /// Share of the energy that lies within the band, 0 to 1.
    pub within: f32,
    /// Mean frequency, weighted by power, in hertz.
    pub centroid_hz: f32,
    /// Frequency of the strongest bin of the spectrum, in hertz.
    pub loudest_hz: f32,
    /// Time from the loudest 5 ms until the level stays below a tenth of theirs, in seconds.
    pub decay_s: f32,
    /// Power of each frequency, in bins of equal width from 0 Hz to half the sample rate, all of them together 1.
    pub spectrum: Vec<f32>,
    /// Width of a bin, in hertz.
    pub bin_hz: f32,
}

/// Measures `samples` at `sample_rate` hertz; `None` for silence or for samples that are not finite.
#[must_use]
pub fn analyse(samples: &[f32], sample_rate: f32, band: Band) -> Option<Analysis> {
    let peak = samples.iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
    if peak <= 0.0 || !samples.iter().all(|sample| sample.is_finite()) {
        return None;
    }
    let square: f64 = samples.iter().map(|sample| f64::from(*sample).powi(2)).sum();
    let (spectrum, bin_hz) = spectrum(samples, sample_rate);
    let hz = |bin: usize| bin as f32 * bin_hz;
    let sum = |keep: &dyn Fn(f32) -> bool| -> f64 {
        spectrum.iter().enumerate().filter(|(bin, _)| keep(hz(*bin))).map(|(_, power)| power).sum()
    };
    let all = sum(&|_| true);
    let weighted: f64 = spectrum.iter().enumerate().map(|(bin, power)| f64::from(hz(bin)) * power).sum();
    let loudest = (0..spectrum.len()).max_by(|a, b| spectrum[*a].total_cmp(&spectrum[*b])).unwrap_or(0);
    Some(Analysis {
        peak,
        rms: (square / samples.len() as f64).sqrt() as f32,
        within: (sum(&|hz| band.contains(hz)) / all) as f32,
        centroid_hz: (weighted / all) as f32,
        loudest_hz: hz(loudest),
        decay_s: decay(samples, sample_rate),
        spectrum: spectrum.iter().map(|power| (power / all) as f32).collect(),
        bin_hz,
    })
}

/// Length of the stretches whose levels give the decay, in seconds.
const STRETCH_S: f32 = 0.005;

fn decay(samples: &[f32], sample_rate: f32) -> f32 {
    let stretch = ((STRETCH_S * sample_rate) as usize).max(1);
    let loud = |part: &[f32]| part.iter().map(|sample| sample * sample).sum::<f32>().sqrt();
    let levels: Vec<f32> = samples.chunks(stretch).map(loud).collect();
    let Some(loudest) = (0..levels.len()).max_by(|a, b| levels[*a].total_cmp(&levels[*b])) else {
        return 0.0;
    };
    let last = levels.iter().rposition(|level| *level > 0.1 * levels[loudest]).unwrap_or(loudest);
    (last + 1 - loudest.min(last)) as f32 * STRETCH_S
}

/// Power per bin up to half the sample rate, and the width of a bin; pads the samples with silence to a power of two.
fn spectrum(samples: &[f32], sample_rate: f32) -> (Vec<f64>, f32) {
    let size = samples.len().next_power_of_two().max(2);
    let mut values: Vec<(f64, f64)> = samples.iter().map(|sample| (f64::from(*sample), 0.0)).collect();
    values.resize(size, (0.0, 0.0));
    transform(&mut values);
    let power = values.iter().take(size / 2 + 1).map(|(re, im)| re * re + im * im).collect();
    (power, sample_rate / size as f32)
}

/// The discrete Fourier transform of a power of two of complex numbers, in place.
///
/// # Source
/// J. W. Cooley, J. W. Tukey, "An algorithm for the machine calculation of complex Fourier series", 1965.
fn transform(values: &mut [(f64, f64)]) {
    let size = values.len();
    let bits = size.trailing_zeros();
    if bits == 0 {
        return;
    }
    for index in 0..size {
        let mirror = index.reverse_bits() >> (usize::BITS - bits);
        if mirror > index {
            values.swap(index, mirror);
        }
    }
    let mut half = 1;
    while half < size {
        let turns: Vec<(f64, f64)> = (0..half)
            .map(|n| {
                let (s, c) = (-TAU * n as f64 / (2 * half) as f64).sin_cos();
                (c, s)
            })
            .collect();
        for part in values.chunks_exact_mut(2 * half) {
            let (low, high) = part.split_at_mut(half);
            for ((low, high), (c, s)) in low.iter_mut().zip(high).zip(&turns) {
                let turned = (high.0 * c - high.1 * s, high.0 * s + high.1 * c);
                *high = (low.0 - turned.0, low.1 - turned.1);
                *low = (low.0 + turned.0, low.1 + turned.1);
            }
        }
        half *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_is_found_where_it_is() {
        let sine: Vec<f32> =
            (0..4800).map(|n| 3.0 * (TAU * 200.0 * f64::from(n) / 48e3).sin() as f32).collect();
        let found = analyse(&sine, 48e3, Band::USEFUL).unwrap();
        assert!((found.peak - 3.0).abs() < 0.01 && (found.rms - 2.121).abs() < 0.01);
        assert!((found.loudest_hz - 200.0).abs() < 6.0, "{}", found.loudest_hz);
        assert!(found.within > 0.98);
        let above: Vec<f32> = (0..4800).map(|n| (TAU * 2000.0 * f64::from(n) / 48e3).sin() as f32).collect();
        assert!(super::analyse(&above, 48e3, Band::USEFUL).unwrap().within < 0.02);
        assert_eq!(super::analyse(&[0.0; 100], 48e3, Band::USEFUL), None);
        assert_eq!(super::analyse(&[f32::NAN; 100], 48e3, Band::USEFUL), None);
    }

    #[test]
    fn a_decay_is_the_time_to_a_tenth() {
        let fading: Vec<f32> = (0..48_000)
            .map(|n| ((-f64::from(n) / 48e3 / 0.05).exp() * (TAU * 200.0 * f64::from(n) / 48e3).sin()) as f32)
            .collect();
        // 0.05 s times the natural logarithm of ten.
        let found = analyse(&fading, 48e3, Band::USEFUL).unwrap();
        assert!((found.decay_s - 0.115).abs() < 0.011, "{}", found.decay_s);
    }
}
