//! Clicks, measured from the samples that reach the actuators.

use std::f64::consts::TAU;
use std::time::Duration;

use underfoot::feel::{Click, Cue, CueSender, Mode, RendererConfig, Spot, renderer};
use underfoot::floor::{Actuator, Floor};
use underfoot::sink::{ActuatorSink, ManualSink};
use underfoot::units::{Instant, Newtons};

fn millis(millis: u64) -> Instant {
    Instant::from_millis(millis)
}

fn floor(rate: u32) -> (CueSender, ManualSink) {
    let (sender, renderer) = renderer(RendererConfig::of(&Floor::default(), rate));
    (sender, ManualSink::new(renderer, Instant::START))
}

/// A click of three modes, of 4 N, that decay slowly enough to be measured.
fn three_modes() -> Click {
    let mode = |frequency_hz, decay_s, amplitude| Mode { frequency_hz, decay_s, amplitude };
    let modes = [mode(80.0, 0.12, 1.0), mode(210.0, 0.08, -0.6), mode(470.0, 0.05, 0.5)];
    Click { modes: modes.into_iter().collect(), level: Newtons(4.0), ..Click::default() }
}

fn cue(at: Instant, spots: &[(u16, f32)], click: &Click) -> Cue {
    let spots = spots.iter().map(|&(tile, weight)| Spot { tile, weight }).collect();
    Cue { at, received: at, spots, click: click.clone(), ..Cue::default() }
}

/// The complex amplitude of `samples` at `frequency` around sample `centre`, under a Hann window of 50 ms.
fn spectrum_at(samples: &[f32], rate: f64, frequency: f64, centre: usize) -> (f64, f64) {
    let half = (0.025 * rate) as usize;
    let mut sum = (0.0, 0.0);
    for (n, sample) in (centre - half..).zip(&samples[centre - half..centre + half]) {
        let window = 0.5 + 0.5 * (TAU * 0.5 * (n as f64 - centre as f64) / half as f64).cos();
        let angle = -TAU * frequency * n as f64 / rate;
        let value = f64::from(*sample) * window;
        sum = (sum.0 + value * angle.cos(), sum.1 + value * angle.sin());
    }
    sum
}

/// The frequency and decay time of the mode near `expected` hertz, from the change of its phase and size within 25
/// ms.
fn measure_mode(samples: &[f32], rate: f64, expected: f64, start: usize) -> (f64, f64) {
    let apart = 0.025;
    let early = start + (0.03 * rate) as usize;
    let late = early + (apart * rate) as usize;
    let (a, b) = (spectrum_at(samples, rate, expected, early), spectrum_at(samples, rate, expected, late));
    let turned = (b.1 * a.0 - b.0 * a.1).atan2(a.0 * b.0 + a.1 * b.1);
    let shrunk = b.0.hypot(b.1) / a.0.hypot(a.1);
    (expected + turned / (TAU * apart), -apart / shrunk.ln())
}

#[test]
fn every_mode_has_its_frequency_within_1_percent_and_its_decay_within_5() {
    for rate in [44_100, 48_000, 96_000] {
        let (mut sender, mut sink) = floor(rate);
        let click = three_modes();
        assert!(sender.send(&cue(millis(100), &[(14, 1.0)], &click)));
        sink.advance(millis(400)).unwrap();
        let rate = f64::from(rate);
        for mode in &click.modes {
            // The start value is 3 % beside the mode, so that the measurement has to find it.
            let (f, d) = measure_mode(
                sink.channel(14),
                rate,
                f64::from(mode.frequency_hz) * 1.03,
                (0.1 * rate) as usize,
            );
            assert!((f / f64::from(mode.frequency_hz) - 1.0).abs() < 0.01, "{mode:?} at {rate}: {f} Hz");
            assert!((d / f64::from(mode.decay_s) - 1.0).abs() < 0.05, "{mode:?} at {rate}: {d} s");
        }
    }
}

#[test]
fn a_cue_moves_the_plate_from_its_own_sample_on_whatever_the_block() {
    let click = three_modes();
    for block_us in [137, 1000, 100_000] {
        let (mut sender, mut sink) = floor(96_000);
        let at: Vec<u64> = (0..20).map(|n| 20_000 + n * 7_777).collect();
        for (tile, at) in at.iter().enumerate() {
            sender.send(&cue(Instant::from_micros(*at), &[(tile as u16, 1.0)], &click));
        }
        for end in (0..400_000).step_by(block_us) {
            sink.advance(Instant::from_micros(end)).unwrap();
        }
        for (tile, at) in at.iter().enumerate() {
            let wanted = (*at as f64 * 0.096).round() as usize;
            let first = sink.channel(tile).iter().position(|sample| *sample != 0.0);
            assert_eq!(first, Some(wanted), "cue at {at} us in blocks of {block_us} us");
        }
        let reported: Vec<u64> = sink.onsets().map(|(frame, _)| frame).collect();
        let wanted: Vec<u64> = at.iter().map(|at| (*at as f64 * 0.096).round() as u64).collect();
        assert_eq!(reported, wanted);
    }
}

#[test]
fn the_onset_does_not_step() {
    let (mut sender, mut sink) = floor(96_000);
    sender.send(&cue(millis(50), &[(0, 1.0)], &three_modes()));
    sink.advance(millis(100)).unwrap();
    let samples = sink.channel(0);
    let peak = samples.iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
    let steepest = samples.windows(2).fold(0.0_f32, |most, pair| most.max((pair[1] - pair[0]).abs()));
    assert!(steepest < 0.05 * peak, "{steepest} of {peak}");
}

#[test]
fn a_delay_moves_every_cue_by_the_same_time() {
    let mut config = RendererConfig::of(&Floor::default(), 48_000);
    config.delay = Duration::from_millis(5);
    let (mut sender, renderer) = renderer(config);
    let mut sink = ManualSink::new(renderer, Instant::START);
    sender.send(&cue(millis(20), &[(3, 1.0)], &three_modes()));
    sink.advance(millis(50)).unwrap();
    assert_eq!(sink.channel(3).iter().position(|sample| *sample != 0.0), Some(25 * 48));
}

#[test]
fn spots_share_a_click_by_weight_and_other_tiles_stay_silent() {
    let (mut sender, mut sink) = floor(48_000);
    sender.send(&cue(millis(10), &[(7, 0.5), (8, 0.25), (13, 0.2), (14, 0.05)], &three_modes()));
    sink.advance(millis(200)).unwrap();
    let energy = |tile: usize| sink.channel(tile).iter().map(|x| f64::from(x * x)).sum::<f64>().sqrt();
    for (tile, share) in [(8, 0.5), (13, 0.4), (14, 0.1)] {
        assert!((energy(tile) / energy(7) - share).abs() < 1e-3, "tile {tile}");
    }
    for tile in (0..36).filter(|tile| ![7, 8, 13, 14].contains(tile)) {
        assert!(sink.channel(tile).iter().all(|sample| *sample == 0.0), "tile {tile}");
    }
}

/// 36 channels are two groups of sixteen and a rest: no group may overwrite another.
#[test]
fn every_tile_gets_its_own_click() {
    let (mut sender, mut sink) = floor(48_000);
    for tile in 0..36_u16 {
        let mode = Mode { frequency_hz: 100.0 + 10.0 * f32::from(tile), decay_s: 0.1, amplitude: 1.0 };
        let click = Click { modes: [mode].into_iter().collect(), level: Newtons(4.0), ..Click::default() };
        sender.send(&cue(millis(20), &[(tile, 1.0)], &click));
    }
    sink.advance(millis(200)).unwrap();
    for tile in 0..36 {
        let wanted = 100.0 + 10.0 * tile as f64;
        let (f, _) = measure_mode(sink.channel(tile), 48e3, wanted * 1.03, 960);
        assert!((f / wanted - 1.0).abs() < 0.01, "tile {tile}: {f} Hz");
    }
}

#[test]
fn newtons_become_full_scales_by_each_actuators_own_measure() {
    let mut floor = Floor::default();
    floor.actuators[1] = Some(Actuator { channel: 30, full_scale: Newtons(10.0) });
    let (mut sender, renderer) = renderer(RendererConfig::of(&floor, 48_000));
    let mut sink = ManualSink::new(renderer, Instant::START);
    let slow = Mode { frequency_hz: 100.0, decay_s: 2.0, amplitude: 1.0 };
    let click = Click { modes: [slow].into_iter().collect(), level: Newtons(4.0), ..Click::default() };
    sender.send(&cue(millis(10), &[(0, 1.0), (1, 1.0)], &click));
    sink.advance(millis(30)).unwrap();
    let peak = |channel: usize| sink.channel(channel).iter().fold(0.0_f32, |a, b| a.max(b.abs()));
    // 4 N are a tenth of 40 N and four tenths of 10 N; the DC blocker takes a few percent.
    assert!((peak(0) - 0.1).abs() < 0.005, "{}", peak(0));
    assert!((peak(30) - 0.4).abs() < 0.02, "{}", peak(30));
    assert_eq!(peak(1), 0.0);
}

#[test]
fn a_late_cue_starts_with_the_block_and_is_counted_and_one_without_an_actuator_too() {
    let mut floor = Floor::default();
    floor.actuators[5] = None;
    let (mut sender, renderer) = renderer(RendererConfig::of(&floor, 48_000));
    let mut sink = ManualSink::new(renderer, Instant::START);
    sink.advance(millis(20)).unwrap();
    sender.send(&cue(millis(19), &[(0, 0.5), (5, 0.5)], &three_modes()));
    sink.advance(millis(40)).unwrap();
    assert_eq!(sink.channel(0).iter().position(|sample| *sample != 0.0), Some(960));
    assert_eq!((sender.counters().late, sender.counters().unfelt), (1, 1));
}

#[test]
fn a_device_with_its_own_clock_plays_at_once_whatever_the_stamp() {
    let (mut sender, mut renderer) = renderer(RendererConfig::of(&Floor::default(), 48_000));
    let mut out = vec![0.0; 36 * 64];
    for _ in 0..10 {
        renderer.render_now(&mut out);
    }
    sender.send(&cue(Instant::from_millis(3_600_000), &[(2, 1.0)], &three_modes()));
    renderer.render_now(&mut out);
    assert_ne!(out[2], 0.0);
    assert_eq!(renderer.onsets().len(), 1);
    assert_eq!(renderer.counters().late, 0);
    renderer.render_now(&mut out);
    assert!(renderer.onsets().is_empty());
}

#[test]
fn a_full_ring_gives_up_its_oldest_cues_and_counts_them() {
    let (mut sender, mut sink) = floor(48_000);
    let sent = (0..300).filter(|_| sender.send(&cue(millis(1), &[(0, 1.0)], &three_modes()))).count();
    assert_eq!(sent, 300);
    sink.advance(millis(10)).unwrap();
    assert_eq!(sender.counters().dropped, 44);
    assert!(sender.send(&cue(millis(10), &[(0, 1.0)], &three_modes())));
}
