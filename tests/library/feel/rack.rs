//! The rack, measured from the samples that leave it.

use std::f64::consts::TAU;

use underfoot::feel::{Click, Cue, CueSender, Mode, RendererConfig, renderer};
use underfoot::floor::{Drive, Floor, Geometry, Response};
use underfoot::sink::{ActuatorSink, ManualSink};
use underfoot::units::{Instant, Newtons};

use super::strike;

const RATE: u32 = 48_000;

fn millis(millis: u64) -> Instant {
    Instant::from_millis(millis)
}

fn play(floor: &Floor) -> (CueSender, ManualSink) {
    let (sender, renderer) = renderer(RendererConfig::of(floor, RATE));
    (sender, ManualSink::new(renderer, Instant::START))
}

/// Two tiles side by side.
fn two_tiles() -> Floor {
    Floor::of(Geometry::of_paper_tiles(2, 1).unwrap())
}

/// A mode with little decay, on one tile.
fn ringing(at: Instant, tile: u16, frequency_hz: f32, level: f32) -> Cue {
    let mode = Mode { frequency_hz, decay_s: 2.0, amplitude: 1.0 };
    let click = Click { modes: [mode].into_iter().collect(), level: Newtons(level), ..Click::default() };
    strike(at, tile, click)
}

/// Amplitude of `samples` at `hz` over whole periods.
fn amplitude_at(samples: &[f32], hz: f64) -> f64 {
    let period = f64::from(RATE) / hz;
    let length = ((samples.len() as f64 / period).floor() * period).round() as usize;
    let (mut re, mut im) = (0.0, 0.0);
    for (n, sample) in samples[..length].iter().enumerate() {
        let angle = TAU * hz * n as f64 / f64::from(RATE);
        re += f64::from(*sample) * angle.cos();
        im += f64::from(*sample) * angle.sin();
    }
    2.0 * re.hypot(im) / length as f64
}

/// The amplitude of a mode of `hz` on a tile of this floor, after its onset.
fn settled(floor: &Floor, hz: f32) -> f64 {
    let (mut sender, mut sink) = play(floor);
    sender.send(&ringing(millis(10), 0, hz, 2.0));
    sink.advance(millis(800)).unwrap();
    amplitude_at(&sink.channel(0)[400 * 48..], f64::from(hz))
}

/// A plate with a resonance at 70 Hz, a dip at 300 and a slope: hertz and decibels.
fn plate() -> Response {
    let bump =
        |hz: f32, centre: f32, octaves: f32, db: f32| db / (1.0 + ((hz / centre).log2() / octaves).powi(2));
    let gain = |hz: f32| bump(hz, 70.0, 0.25, 8.0) + bump(hz, 300.0, 0.2, -6.0) - 1.5 * (hz / 200.0).log2();
    // A tenth of an octave apart, from 30 Hz to 1.2 kHz.
    let hertz = (0..54_u8).map(|n| 30.0 * (f32::from(n) / 10.0).exp2());
    Response::of(hertz.map(|hz| (hz, gain(hz))).collect()).unwrap()
}

#[test]
fn a_measured_plate_is_made_flat_within_1_db_in_the_band() {
    let (plain, mut equalised) = (two_tiles(), two_tiles());
    equalised.responses[0] = Some(plate());
    for hz in [52.0, 60.0, 70.0, 85.0, 130.0, 200.0, 260.0, 300.0, 340.0, 450.0, 600.0, 740.0] {
        let rack_db = 20.0 * (settled(&equalised, hz) / settled(&plain, hz)).log10();
        let plate_db = rack_db + plate().gain_db(f64::from(hz));
        assert!(plate_db.abs() < 1.0, "{hz} Hz leaves the plate at {plate_db:.2} dB");
    }
}

#[test]
fn what_is_below_the_band_is_taken_away_from_a_measured_plate_only() {
    let (plain, mut equalised) = (two_tiles(), two_tiles());
    equalised.responses[0] = Some(plate());
    let kept_db = 20.0 * (settled(&equalised, 20.0) / settled(&plain, 20.0)).log10();
    assert!(kept_db < -20.0, "{kept_db}");
    assert!(
        (settled(&plain, 20.0) / 0.05 - 0.77).abs() < 0.1,
        "2 N of 40 N, a quarter of a time constant later"
    );
}

/// A person leans on a control that never stops ringing, for a minute.
// A9
#[test]
fn no_coil_gets_more_than_80_w_over_a_minute() {
    let floor = two_tiles();
    let (mut sender, mut sink) = play(&floor);
    let mut watts = Vec::new();
    let mut heard = 0;
    for tenth in 0..600_u64 {
        // 20 N twice a second, ringing for 2 s, add up to some 90 N on a 40 N actuator.
        if tenth.is_multiple_of(5) {
            sender.send(&ringing(millis(100 * tenth), 0, 60.0, 20.0));
        }
        sink.advance(millis(100 * (tenth + 1))).unwrap();
        let new = &sink.channel(0)[heard..];
        heard += new.len();
        let square = new.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>() / new.len() as f64;
        watts.push(square * f64::from(Drive::default().full_scale_w()));
        assert!(new.iter().all(|sample| sample.abs() <= 1.0));
    }
    let mean = |watts: &[f64]| watts.iter().sum::<f64>() / watts.len() as f64;
    assert!(mean(&watts[10..15]) > 90.0, "a cold coil takes more: {:.0} W", mean(&watts[10..15]));
    assert!((65.0..=80.0).contains(&mean(&watts)), "over the minute: {:.1} W", mean(&watts));
    assert!((65.0..=80.0).contains(&mean(&watts[300..])), "in the end: {:.1} W", mean(&watts[300..]));
    let counters = sender.counters();
    assert_eq!((counters.heated, counters.silenced), (1, 0));
}

#[test]
fn weaker_coils_in_the_floor_file_are_held_to_less() {
    let mut floor = two_tiles();
    floor.drive.long_term_w = 10.0;
    let (mut sender, mut sink) = play(&floor);
    for second in 0..20_u64 {
        for strike in 0..2 {
            sender.send(&ringing(millis(1000 * second + 500 * strike), 0, 60.0, 20.0));
        }
        sink.advance(millis(1000 * (second + 1))).unwrap();
    }
    let last = &sink.channel(0)[10 * 48_000..];
    let square = last.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>() / last.len() as f64;
    let watts = square * f64::from(floor.drive.full_scale_w());
    assert!((8.0..=10.0).contains(&watts), "{watts} W");
}

#[test]
fn a_muted_tile_fades_without_a_step_and_the_others_play_on() {
    let (mut sender, mut sink) = play(&two_tiles());
    for tile in 0..2 {
        sender.send(&ringing(millis(5), tile, 100.0, 20.0));
    }
    sink.advance(millis(100)).unwrap();
    assert!(sender.mute(0, true));
    assert!(!sender.mute(7, true), "there is no such tile");
    sink.advance(millis(150)).unwrap();
    assert!(sender.mutes(0) && !sender.mutes(1) && !sender.mutes(7));
    sender.send(&ringing(millis(140), 1, 100.0, 20.0));
    assert_eq!(sender.counters().muted, 0, "the other tile is felt");
    sender.send(&ringing(millis(140), 0, 100.0, 0.0));
    assert_eq!(sender.counters().muted, 1);
    assert!(sender.mute(0, false));
    sink.advance(millis(200)).unwrap();

    let (muted, other) = (sink.channel(0), sink.channel(1));
    let peak = |samples: &[f32]| samples.iter().fold(0.0_f32, |peak, x| peak.max(x.abs()));
    assert!(peak(&muted[90 * 48..100 * 48]) > 0.4);
    assert!(muted[100 * 48..104 * 48].iter().any(|x| *x != 0.0), "it fades, it does not break off");
    assert_eq!(peak(&muted[105 * 48 + 1..150 * 48]), 0.0);
    assert!(peak(&muted[170 * 48..]) > 0.4, "it has rung on unfelt");
    assert!(peak(&other[110 * 48..120 * 48]) > 0.4);
    // A 100 Hz sine of half a full scale rises by 0.0065 a sample at most; a ramp of 5 ms adds 0.002.
    let steepest = muted.windows(2).fold(0.0_f32, |most, pair| most.max((pair[1] - pair[0]).abs()));
    assert!(steepest < 0.0095, "{steepest}");
}

#[test]
fn a_voice_that_is_far_too_loud_is_silenced_and_counted_and_the_next_is_felt() {
    let (mut sender, mut sink) = play(&two_tiles());
    sender.send(&ringing(millis(5), 1, 200.0, 2.0));
    sender.send(&ringing(millis(20), 0, 200.0, 1e9));
    sink.advance(millis(100)).unwrap();
    let absurd = sink.channel(0);
    assert!(absurd.iter().all(|x| x.is_finite() && x.abs() <= 1.0));
    assert!(absurd[20 * 48..25 * 48].iter().any(|x| x.abs() > 0.1), "it began");
    // After 5 ms of fading only the DC blocker settles.
    assert!(absurd[40 * 48..].iter().all(|x| x.abs() < 0.3), "it does not ring on for its 2 s");
    let counters = sender.counters();
    assert!(counters.overloaded > 0);
    assert_eq!(counters.silenced, 1);

    sender.send(&ringing(millis(600), 0, 200.0, 8.0));
    sink.advance(millis(700)).unwrap();
    assert!(sink.channel(0)[400 * 48..600 * 48].iter().all(|x| x.abs() < 1e-3));
    let peak = sink.channel(0)[620 * 48..].iter().fold(0.0_f32, |peak, x| peak.max(x.abs()));
    assert!((0.15..0.25).contains(&peak), "8 of 40 N: {peak}");
    assert!(sink.channel(1)[690 * 48..].iter().any(|x| x.abs() > 0.02), "the neighbour was never disturbed");
    assert_eq!(sender.counters().silenced, 1);
}

#[test]
fn what_dies_away_ends_in_exact_silence_without_denormal_numbers() {
    // Computing with denormal numbers takes up to a hundred times as long; ringing filters create them.
    for response in [None, Some(plate())] {
        let mut floor = two_tiles();
        floor.responses[0] = response;
        let (mut sender, mut sink) = play(&floor);
        let mut cue = ringing(millis(10), 0, 150.0, 5.0);
        cue.click.modes[0].decay_s = 0.1;
        sender.send(&cue);
        // Far below the faintest audible level after 2 s: 20 decay times are -174 dB.
        sink.advance(millis(4000)).unwrap();
        let samples = sink.channel(0);
        assert!(samples[..48_000].iter().any(|sample| sample.abs() > 0.05));
        let denormal = samples.iter().position(|sample| sample.is_subnormal());
        assert_eq!(denormal, None, "of {} samples", samples.len());
        assert!(samples[3 * 48_000..].iter().all(|sample| *sample == 0.0), "silent after 3 s");
    }
}
