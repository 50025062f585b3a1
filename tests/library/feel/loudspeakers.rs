//! Cues that are also heard: the same synthesis, in the same block, from where they are felt.

use underfoot::feel::{Click, Cue, CueSender, Mode, RendererConfig, Spot, renderer};
use underfoot::floor::{Floor, Loudspeaker};
use underfoot::glam::Vec2;
use underfoot::sink::{ActuatorSink, ManualSink, WavFormat, WavOptions, WavSink, WhenFull};
use underfoot::units::{Instant, Newtons};

/// The paper's floor with a loudspeaker at each corner, on channels 36 to 39; the last is half as loud.
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

fn cue(at: Instant, tile: u16, to_air: f32) -> Cue {
    let modes = [(80.0, 0.02, 1.0), (210.0, 0.015, -0.6), (470.0, 0.01, 0.5)]
        .map(|(frequency_hz, decay_s, amplitude)| Mode { frequency_hz, decay_s, amplitude });
    let click = Click { modes: modes.into_iter().collect(), level: Newtons(8.0), ..Click::default() };
    Cue {
        at,
        received: at,
        spots: [Spot { tile, weight: 1.0 }].into_iter().collect(),
        click,
        to_air,
        ..Cue::default()
    }
}

fn energy(samples: &[f32]) -> f64 {
    samples.iter().map(|x| f64::from(*x).powi(2)).sum()
}

/// Every cue's first sample, found in the 24-bit file that both are written to.
#[test]
fn what_is_felt_and_what_is_heard_begin_within_one_sample_in_one_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("both.wav");
    let (mut sender, renderer) = renderer(RendererConfig::of(&floor(), 96_000));
    let options = WavOptions { format: WavFormat::Pcm24, when_full: WhenFull::Wait, ..WavOptions::default() };
    let mut file = WavSink::create(&path, renderer, options).unwrap();
    // Half a second apart, so that each begins in silence; at moments that fall into the middle of blocks.
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
        // From 10 ms before: there everything is at rest.
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
        // Sample by sample the same.
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
    let heard = |to_air: f32| {
        let (mut sender, mut sink) = play(&floor());
        sender.send(&cue(Instant::from_millis(10), 0, to_air));
        sink.advance(Instant::from_millis(200)).unwrap();
        assert!(energy(sink.channel(0)) > 0.0);
        energy(sink.channel(36)).sqrt()
    };
    assert_eq!((heard(0.0), heard(f32::NAN)), (0.0, 0.0));
    assert!((heard(0.5) / heard(1.0) - 0.5).abs() < 1e-3);
    assert!((heard(9.0) / heard(1.0) - 1.0).abs() < 1e-6);
}
