//! The audible part of cues, transient and sustained: the same synthesis, in the same block, at the place of the
//! haptics.

use underfoot::feel::{
    Click, Cue, CueSender, Hum, Lasting, Mode, RendererConfig, Spot, SustainedCue, SustainedCues, Tone,
    renderer,
};
use underfoot::floor::{Floor, Loudspeaker};
use underfoot::glam::Vec2;
use underfoot::schema::Effects;
use underfoot::sink::{ActuatorSink, ManualSink, WavFormat, WavOptions, WavSink, WhenFull};
use underfoot::units::{Instant, Newtons};

use super::strike;

/// The paper's floor with a loudspeaker at each corner, on channels 36 to 39; the last one is half as loud.
fn floor() -> Floor {
    let corners = [(0.0, 0.0), (1.824, 0.0), (0.0, 1.824), (1.824, 1.824)];
    let loudspeakers = (36..).zip(corners).map(|(channel, (x, y))| {
        let gain_db = if channel == 39 { -6.0206 } else { 0.0 };
        Loudspeaker { at: Vec2::new(x, y), channel, gain_db }
    });
    Floor { loudspeakers: loudspeakers.collect(), ..Floor::default() }
}

fn play(floor: &Floor) -> (CueSender, ManualSink) {
    let (sender, renderer) = renderer(RendererConfig::of(floor, 96_000));
    (sender, ManualSink::new(renderer, Instant::START))
}

fn cue(at: Instant, tile: u16, audio_gain: f32) -> Cue {
    let modes = [(80.0, 0.02, 1.0), (210.0, 0.015, -0.6), (470.0, 0.01, 0.5)]
        .map(|(frequency_hz, decay_s, amplitude)| Mode { frequency_hz, decay_s, amplitude });
    let click = Click { modes: modes.into_iter().collect(), level: Newtons(8.0), ..Click::default() };
    Cue { audio_gain, ..strike(at, tile, click) }
}

fn energy(samples: &[f32]) -> f64 {
    samples.iter().map(|x| f64::from(*x).powi(2)).sum()
}

/// Finds every cue's first sample in the 24-bit file that receives both.
#[test]
fn what_is_felt_and_what_is_heard_begin_within_one_sample_in_one_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("both.wav");
    let (mut sender, renderer) = renderer(RendererConfig::of(&floor(), 96_000));
    let options = WavOptions::default().with_format(WavFormat::Pcm24).with_when_full(WhenFull::Wait);
    let mut file = WavSink::create(&path, renderer, options).unwrap();
    // Half a second apart, so that each begins in silence; at times within blocks.
    let moments: Vec<u64> = (0..6).map(|n| 20_000 + n * 517_313).collect();
    let tiles = [0_u16, 5, 14, 21, 30, 35];
    for (at, tile) in moments.iter().zip(tiles) {
        sender.send(&cue(Instant::from_micros(*at), tile, 1.0));
    }
    for millis in (1..=3200).step_by(7) {
        file.advance(Instant::from_millis(millis)).unwrap();
    }
    file.finish().unwrap();

    let mut reader = hound::WavReader::open(&path).unwrap();
    assert_eq!(reader.spec().channels, 40);
    let samples: Vec<i32> = reader.samples().map(Result::unwrap).collect();
    let first = |channel: usize, from: usize| {
        (from..samples.len() / 40).find(|frame| samples[40 * frame + channel] != 0)
    };
    for (at, tile) in moments.iter().zip(tiles) {
        let due = (*at as f64 * 0.096).round() as usize;
        // From 10 ms before: there all channels are silent.
        let felt = first(tile.into(), due - 960).unwrap();
        let heard = (36..40).filter_map(|channel| first(channel, due - 960)).min().unwrap();
        assert!(felt.abs_diff(due) <= 1, "tile {tile} begins at {felt} instead of {due}");
        assert!(felt.abs_diff(heard) <= 1, "tile {tile} begins at {felt}, its sound at {heard}");
    }
}

#[test]
fn what_is_heard_is_what_is_felt_from_where_it_is_felt() {
    let floor = floor();
    for tile in [0_u16, 3, 14, 20, 35] {
        let (mut sender, mut sink) = play(&floor);
        sender.send(&cue(Instant::from_millis(10), tile, 1.0));
        sink.advance(Instant::from_millis(300)).unwrap();
        let felt = sink.channel(tile.into());
        let place = floor.geometry.centre(floor.geometry.tile_at_index(tile.into()));
        let gains: Vec<f64> =
            (36..40).map(|channel| (energy(sink.channel(channel)) / energy(felt)).sqrt()).collect();
        let power: f64 = gains.iter().zip([1.0, 1.0, 1.0, 2.0]).map(|(gain, own)| (gain * own).powi(2)).sum();
        assert!((power - 1.0).abs() < 0.02, "tile {tile}: {power}");
        let nearest = (0..4).min_by(|a, b| {
            let distance = |n: &usize| floor.loudspeakers[*n].at.distance(place);
            distance(a).total_cmp(&distance(b))
        });
        let loudest = (0..3).max_by(|a, b| gains[*a].total_cmp(&gains[*b]));
        assert!(nearest == Some(3) || loudest == nearest, "tile {tile}: {gains:?}");
        // Equal, sample by sample.
        for (channel, gain) in (36..40).zip(&gains) {
            let worst = sink.channel(channel).iter().zip(felt).fold(0.0_f64, |worst, (heard, felt)| {
                worst.max((f64::from(*heard) - gain * f64::from(*felt)).abs())
            });
            assert!(worst < 1e-5, "tile {tile}, loudspeaker {channel}: {worst}");
        }
    }
}

#[test]
fn a_layout_that_does_not_ask_is_not_heard_and_half_is_half() {
    let heard = |audio_gain: f32| {
        let (mut sender, mut sink) = play(&floor());
        sender.send(&cue(Instant::from_millis(10), 0, audio_gain));
        sink.advance(Instant::from_millis(200)).unwrap();
        assert!(energy(sink.channel(0)) > 0.0);
        energy(sink.channel(36)).sqrt()
    };
    assert_eq!((heard(0.0), heard(f32::NAN)), (0.0, 0.0));
    assert!((heard(0.5) / heard(1.0) - 0.5).abs() < 1e-3);
    assert!((heard(9.0) / heard(1.0) - 1.0).abs() < 1e-6);
}

/// The sustained effects, one of every model.
fn lasting() -> Vec<(&'static str, Lasting)> {
    let effects = Effects::builtin();
    let named = |name| (name, effects.get(name).unwrap().effect.kind.lasting().unwrap());
    let hum = Lasting::Hum(Hum { level: Newtons(4.0), hz: 90.0, noise: 0.0 });
    let mut all = ["smooth", "rubber", "grating", "gravel"].map(named).to_vec();
    all.push(("a hum", hum));
    all
}

fn sustained_cue(effect: Lasting, tile: u16, audio_gain: f32) -> SustainedCues {
    let spots = [Spot { tile, weight: 1.0 }].into_iter().collect();
    let force = Newtons(200.0);
    [SustainedCue { key: 1, spots, effect, speed_m_s: 0.2, force, audio_gain, ..SustainedCue::default() }]
        .into_iter()
        .collect()
}

/// Renders millisecond by millisecond, with the sustained cues of each.
fn slide(floor: &Floor, millis: u64, sustained: impl Fn(u64) -> SustainedCues) -> ManualSink {
    let (mut sender, mut sink) = play(floor);
    for ms in 0..millis {
        sender.sustain(&sustained(ms));
        sink.advance(Instant::from_millis(ms + 1)).unwrap();
    }
    sink
}

fn onset(samples: &[f32]) -> Option<usize> {
    samples.iter().position(|sample| *sample != 0.0)
}

#[test]
fn what_lasts_is_heard_as_it_is_felt_and_begins_within_one_sample() {
    let floor = floor();
    for (name, effect) in lasting() {
        // After 20 ms of silence; between three loudspeakers, so that each has a share.
        let sink =
            slide(
                &floor,
                300,
                |ms| if ms < 20 { SustainedCues::new() } else { sustained_cue(effect, 8, 1.0) },
            );
        let felt = sink.channel(8);
        let begins = onset(felt).unwrap();
        assert!(begins >= 20 * 96, "{name}: {begins}");
        let heard = (36..40).filter_map(|channel| onset(sink.channel(channel))).min().unwrap();
        assert!(begins.abs_diff(heard) <= 1, "{name} is felt from {begins} on and heard from {heard} on");
        let gains: Vec<f64> =
            (36..40).map(|channel| (energy(sink.channel(channel)) / energy(felt)).sqrt()).collect();
        let power: f64 = gains.iter().zip([1.0, 1.0, 1.0, 2.0]).map(|(gain, own)| (gain * own).powi(2)).sum();
        assert!((power - 1.0).abs() < 0.02, "{name}: {power}");
        for (channel, gain) in (36..40).zip(&gains) {
            let worst = sink.channel(channel).iter().zip(felt).fold(0.0_f64, |worst, (heard, felt)| {
                worst.max((f64::from(*heard) - gain * f64::from(*felt)).abs())
            });
            // Sustained cues may come near the limiter, which works on each channel separately.
            assert!(worst < 1e-3, "{name}, loudspeaker {channel}: {worst}");
        }
    }
}

#[test]
fn a_tone_of_a_cue_is_heard_as_well() {
    let (mut sender, mut sink) = play(&floor());
    let tone = Tone { level: Newtons(4.0), hz: 90.0, length_s: 0.1, sustain: 1.0, ..Tone::default() };
    let cue = Cue { click: Click::default(), tone: Some(tone), ..cue(Instant::from_micros(20_130), 0, 1.0) };
    sender.send(&cue);
    sink.advance(Instant::from_millis(300)).unwrap();
    let (felt, heard) = (onset(sink.channel(0)).unwrap(), onset(sink.channel(36)).unwrap());
    assert!(felt.abs_diff(heard) <= 1, "felt from {felt}, heard from {heard}");
    assert!(energy(sink.channel(36)) > 0.8 * energy(sink.channel(0)));
}

/// A hum of 4 N that moves from the south-west corner to the north-east one, tile by tile.
#[test]
fn what_lasts_is_heard_from_where_the_foot_is_and_never_jumps() {
    let effect = Lasting::Hum(Hum { level: Newtons(4.0), hz: 90.0, noise: 0.0 });
    let sink = slide(&floor(), 1800, |ms| sustained_cue(effect, (ms / 300 * 7) as u16, 1.0));
    // 200 ms of each tile, once the sound has arrived there; the fourth loudspeaker has half the gain.
    let loud = |channel: usize, step: usize| {
        let own = if channel == 39 { 2.0 } else { 1.0 };
        own * energy(&sink.channel(channel)[(300 * step + 90) * 96..(300 * step + 290) * 96]).sqrt()
    };
    let (west, east): (Vec<f64>, Vec<f64>) = (0..6).map(|step| (loud(36, step), loud(39, step))).unzip();
    // The farthest of the four is silent: three share the sound.
    assert!(west.windows(2).all(|pair| pair[1] <= pair[0]), "{west:?}");
    assert!(east.windows(2).all(|pair| pair[1] >= pair[0]), "{east:?}");
    assert!(west[0] > 5.0 && east[0] == 0.0 && east[5] > 5.0 && west[5] == 0.0, "{west:?} {east:?}");
    for channel in 36..40 {
        let steps = sink.channel(channel).windows(2).map(|pair| (pair[1] - pair[0]).abs());
        let steepest = steps.fold(0.0_f32, f32::max);
        // A sine of 90 Hz and a tenth of full scale: 0.0006 a sample; moving it within 4 ms adds 0.0003.
        assert!(steepest < 0.0012, "loudspeaker {channel}: {steepest}");
    }
}

#[test]
fn what_lasts_and_does_not_ask_is_exactly_silent_on_every_loudspeaker() {
    for (name, effect) in lasting() {
        for audio_gain in [0.0, -1.0, f32::NAN] {
            let sink = slide(&floor(), 100, |_| sustained_cue(effect, 8, audio_gain));
            assert!(energy(sink.channel(8)) > 0.0, "{name}");
            assert!((36..40).all(|channel| onset(sink.channel(channel)).is_none()), "{name}: {audio_gain}");
        }
        let half = slide(&floor(), 100, |_| sustained_cue(effect, 0, 0.5));
        let whole = slide(&floor(), 100, |_| sustained_cue(effect, 0, 1.0));
        let share = (energy(half.channel(36)) / energy(whole.channel(36))).sqrt();
        assert!((share - 0.5).abs() < 0.01, "{name}: {share}");
        // It ends with the foot, except for the decay of the DC blocker.
        let lifted =
            slide(
                &floor(),
                150,
                |ms| if ms < 100 { sustained_cue(effect, 0, 1.0) } else { SustainedCues::new() },
            );
        let (during, after) = lifted.channel(36).split_at(120 * 96);
        assert!(energy(after) < 1e-4 * energy(during), "{name}: {} {}", energy(after), energy(during));
    }
}
