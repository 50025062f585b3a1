//! Friction, measured from the samples that reach the actuators.

use std::f64::consts::TAU;

use underfoot::feel::{
    CueSender, Friction, Lasting, RendererConfig, Spot, SustainedCue, SustainedCues, renderer,
};
use underfoot::floor::Floor;
use underfoot::sink::{ActuatorSink, ManualSink};
use underfoot::units::{Instant, Newtons};

const RATE: u32 = 48_000;

fn millis(millis: u64) -> Instant {
    Instant::from_millis(millis)
}

fn floor() -> (CueSender, ManualSink) {
    let (sender, renderer) = renderer(RendererConfig::of(&Floor::default(), RATE));
    (sender, ManualSink::new(renderer, Instant::START))
}

/// A texture of 8 N with a band from 100 to 400 Hz.
fn sustained_cue(speed_m_s: f32, force: f32, spots: &[(u16, f32)]) -> SustainedCue {
    let friction = Friction {
        level: Newtons(8.0),
        low_hz: 100.0,
        high_hz: 400.0,
        full_speed_m_s: 0.5,
        full_force: Newtons(400.0),
    };
    let spots = spots.iter().map(|&(tile, weight)| Spot { tile, weight }).collect();
    SustainedCue {
        key: 7,
        spots,
        effect: friction.into(),
        speed_m_s,
        force: Newtons(force),
        ..SustainedCue::default()
    }
}

/// The samples of tile 0 in two seconds of steady sliding, without the first 100 ms.
fn steady(sustained_cue: &SustainedCue) -> Vec<f32> {
    let (mut sender, mut sink) = floor();
    let sustained: SustainedCues = [sustained_cue.clone()].into_iter().collect();
    for n in 1..=2100 {
        sender.sustain(&sustained);
        assert!(sink.advance(millis(n)).is_ok());
    }
    sink.channel(0)[4800..].to_vec()
}

fn rms(samples: &[f32]) -> f64 {
    (samples.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>() / samples.len() as f64).sqrt()
}

/// Power at each multiple of 20 Hz up to 3 kHz, averaged over windows of 50 ms (Hann), by Goertzel's algorithm.
fn spectrum(samples: &[f32]) -> Vec<(f64, f64)> {
    let length = RATE as usize / 20;
    let window: Vec<f64> = (0..length).map(|n| 0.5 - 0.5 * (TAU * n as f64 / length as f64).cos()).collect();
    (1..150_u32)
        .map(|bin| {
            let frequency = f64::from(bin) * 20.0;
            let turn = 2.0 * (TAU * frequency / f64::from(RATE)).cos();
            let power = |stretch: &[f32]| {
                let (mut a, mut b) = (0.0, 0.0);
                for (sample, window) in stretch.iter().zip(&window) {
                    (a, b) = (f64::from(*sample) * window + turn * a - b, a);
                }
                a * a + b * b - turn * a * b
            };
            (frequency, samples.chunks_exact(length).map(power).sum())
        })
        .collect()
}

fn centroid(spectrum: &[(f64, f64)]) -> f64 {
    let power: f64 = spectrum.iter().map(|(_, power)| power).sum();
    spectrum.iter().map(|(frequency, power)| frequency * power).sum::<f64>() / power
}

#[test]
fn the_level_is_that_of_a_sine_and_rises_with_speed_and_force() {
    let full = rms(&steady(&sustained_cue(0.5, 400.0, &[(0, 1.0)])));
    // 8 N of 40 N at full scale, over the square root of two; tolerance of 10 % for two seconds of noise.
    let sine = 8.0 / 40.0 / 2.0_f64.sqrt();
    assert!((full / sine - 1.0).abs() < 0.1, "{full} instead of {sine}");
    for (speed, force, share) in [(0.5, 200.0, 0.5), (0.25, 400.0, 0.5), (0.125, 100.0, 0.0625)] {
        let level = rms(&steady(&sustained_cue(speed, force, &[(0, 1.0)])));
        assert!((level / (full * share) - 1.0).abs() < 0.15, "{speed} m/s, {force} N: {level}");
    }
    let beyond = rms(&steady(&sustained_cue(3.0, 3000.0, &[(0, 1.0)])));
    assert!((beyond / full - 1.0).abs() < 0.05, "full is full: {beyond}");
    assert_eq!(rms(&steady(&sustained_cue(0.0, 400.0, &[(0, 1.0)]))), 0.0);
    assert_eq!(rms(&steady(&sustained_cue(0.5, 0.0, &[(0, 1.0)]))), 0.0);
}

#[test]
fn the_pitch_rises_with_the_speed_from_low_to_high() {
    let mut last = 0.0;
    for (speed, wanted) in [(0.05, 130.0), (0.15, 190.0), (0.25, 250.0), (0.4, 340.0), (0.5, 400.0)] {
        let pitch = centroid(&spectrum(&steady(&sustained_cue(speed, 400.0, &[(0, 1.0)]))));
        // The band leans towards high frequencies, with a centroid up to a fifth above its centre.
        assert!((0.95..1.25).contains(&(pitch / wanted)), "{speed} m/s: {pitch} Hz");
        assert!(pitch > last);
        last = pitch;
    }
}

#[test]
fn even_the_widest_texture_stays_between_50_and_750_hz() {
    for (low_hz, high_hz, speed) in [(20.0, 20.0, 0.5), (1000.0, 1000.0, 0.5), (100.0, 400.0, 0.25)] {
        let mut sustained_cue = sustained_cue(speed, 400.0, &[(0, 1.0)]);
        let Lasting::Friction(friction) = &mut sustained_cue.effect else { unreachable!("a friction") };
        friction.low_hz = low_hz;
        friction.high_hz = high_hz;
        let spectrum = spectrum(&steady(&sustained_cue));
        let all: f64 = spectrum.iter().map(|(_, power)| power).sum();
        let inside: f64 =
            spectrum.iter().filter(|(f, _)| (50.0..=750.0).contains(f)).map(|(_, power)| power).sum();
        assert!(inside / all > 0.94, "{low_hz} to {high_hz} Hz: {:.1} %", 100.0 * inside / all);
    }
}

#[test]
fn a_sustained_cue_that_is_over_is_gone_after_15_ms() {
    let (mut sender, mut sink) = floor();
    for n in 1..=400 {
        let sustained: SustainedCues =
            (n <= 300).then(|| sustained_cue(0.4, 400.0, &[(0, 0.5), (1, 0.5)])).into_iter().collect();
        sender.sustain(&sustained);
        sink.advance(millis(n)).unwrap();
    }
    for tile in [0, 1] {
        let samples = sink.channel(tile);
        let level = rms(&samples[200 * 48..300 * 48]);
        assert!(level > 0.02);
        assert!(rms(&samples[301 * 48..305 * 48]) > 0.2 * level, "it fades, it does not break off");
        let steepest = samples.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max);
        assert!(f64::from(steepest) < 0.5 * level, "no step anywhere: {steepest}");
        // The rest is the settling of the DC blocker.
        assert!(rms(&samples[318 * 48..]) < 0.02 * level);
    }
}

#[test]
fn a_foot_that_slides_over_a_seam_takes_its_texture_along() {
    let (mut sender, mut sink) = floor();
    for n in 1..=1000_u64 {
        let share = (n as f32 - 300.0).clamp(0.0, 400.0) / 400.0;
        let sustained_cue = sustained_cue(0.4, 400.0, &[(0, 1.0 - share), (1, share)]);
        sender.sustain(&[sustained_cue].into_iter().collect());
        sink.advance(millis(n)).unwrap();
    }
    // The same foot, the same noise: at any time the two tiles add up to the whole.
    let sum: Vec<f32> = sink.channel(0).iter().zip(sink.channel(1)).map(|(a, b)| a + b).collect();
    let level = rms(&sum[100 * 48..]);
    for hundred in 1..10 {
        let now = rms(&sum[hundred * 4800..(hundred + 1) * 4800]);
        assert!((now / level - 1.0).abs() < 0.35, "at {hundred}00 ms: {now} instead of {level}");
    }
    assert!(rms(&sink.channel(0)[800 * 48..]) < 1e-4);
    for tile in 2..36 {
        assert!(sink.channel(tile).iter().all(|sample| *sample == 0.0), "tile {tile}");
    }
}

#[test]
fn the_same_steps_give_the_same_samples() {
    let sustained_cue = sustained_cue(0.4, 400.0, &[(0, 1.0)]);
    assert_eq!(steady(&sustained_cue), steady(&sustained_cue));
}
