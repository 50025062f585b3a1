//! The audible part of the ground: the same events and modes as in the haptics, at their places.

use underfoot::feel::{Cue, RendererConfig, renderer};
use underfoot::floor::{Floor, Loudspeaker};
use underfoot::glam::Vec2;
use underfoot::sink::{ActuatorSink, ManualSink};
use underfoot::units::{Instant, Newtons};

use crate::support::{Walker, layout, page};

/// The channels of the loudspeakers, behind those of the tiles.
const HEARD: std::ops::Range<usize> = 36..44;

/// The paper's floor with its eight loudspeakers: one at each corner and one at the middle of each side.
fn floor() -> Floor {
    let [low, middle, high] = [-0.3, 0.912, 2.124];
    let at = [
        (low, low),
        (middle, low),
        (high, low),
        (high, middle),
        (high, high),
        (middle, high),
        (low, high),
        (low, middle),
    ];
    let loudspeakers =
        (36..).zip(at).map(|(channel, at)| Loudspeaker { at: at.into(), channel, gain_db: 0.0 });
    Floor { loudspeakers: loudspeakers.collect(), ..Floor::default() }
}

/// The cues of some steps over a page, from each side to the other.
fn walk(walker: &mut Walker) -> Vec<Cue> {
    walker.take_cues();
    for step in 0..10_u8 {
        let along = 0.2 + 0.15 * f32::from(step);
        walker.step_at(Vec2::new(along, 1.7 - 0.9 * along + 0.12 * f32::from(step % 2)), Newtons(1000.0));
        walker.wait(150);
        walker.lift();
        walker.wait(100);
    }
    walker.take_cues()
}

/// All channels, with these cues played at their times.
fn play(cues: &[Cue]) -> ManualSink {
    let (mut sender, renderer) = renderer(RendererConfig::of(&floor(), 48_000));
    let mut sink = ManualSink::new(renderer, Instant::START);
    let end = cues.last().map_or(0, |cue| cue.at.micros() / 1000) + 200;
    let mut waiting = cues.iter().peekable();
    for ms in 0..end {
        while let Some(cue) = waiting.next_if(|cue| cue.at.micros() / 1000 <= ms + 1) {
            sender.send(cue);
        }
        sink.advance(Instant::from_millis(ms + 1)).unwrap();
    }
    sink
}

fn energy(samples: &[f32]) -> f64 {
    samples.iter().map(|sample| f64::from(*sample).powi(2)).sum()
}

/// One cue alone, soon after the start.
fn alone(cue: &Cue) -> ManualSink {
    play(&[Cue { at: Instant::from_millis(10), ..cue.clone() }])
}

#[test]
fn each_crack_of_the_pond_is_heard_most_from_the_loudspeaker_nearest_to_it() {
    let cues = walk(&mut Walker::on(layout("pond")));
    assert!(cues.len() > 50, "{}", cues.len());
    let loudspeakers = floor().loudspeakers;
    let mut loudest_ones = std::collections::BTreeSet::new();
    for cue in cues.iter().step_by(7) {
        let place = cue.heard_at.unwrap();
        let played = alone(cue);
        let [loudest, second] = {
            let mut by_energy: Vec<usize> = HEARD.collect();
            by_energy.sort_by(|a, b| energy(played.channel(*b)).total_cmp(&energy(played.channel(*a))));
            [by_energy[0], by_energy[1]]
        };
        let distance = |channel: usize| loudspeakers[channel - 36].at.distance(place);
        let nearest = HEARD.min_by(|a, b| distance(*a).total_cmp(&distance(*b))).unwrap();
        // Of two equally distant ones, either may be the loudest.
        let is_nearest = loudest == nearest || (distance(loudest) - distance(nearest)).abs() < 1e-3;
        assert!(is_nearest, "{place}: {loudest} before {second}, and not {nearest}");
        loudest_ones.insert(loudest);
    }
    assert!(loudest_ones.len() >= 3, "the walk goes along several of them: {loudest_ones:?}");
}

#[test]
fn a_crack_is_as_strong_to_the_ear_as_to_the_foot() {
    let cues = walk(&mut Walker::on(layout("pond")));
    for cue in cues.iter().step_by(7) {
        let played = alone(cue);
        let felt: f64 = (0..36).map(|channel| energy(played.channel(channel))).sum();
        let heard: f64 = HEARD.map(|channel| energy(played.channel(channel))).sum();
        // The haptic shares on several tiles add up like forces.
        let shares: f64 = cue.spots.iter().map(|spot| f64::from(spot.weight).powi(2)).sum();
        let ratio = heard / (felt / shares);
        assert!((ratio - 1.0).abs() < 0.02, "{ratio} at {:?}", cue.heard_at);
    }
}

#[test]
fn what_is_felt_of_the_ground_is_the_same_whether_it_is_heard_or_not() {
    let cues = walk(&mut Walker::on(layout("winter_walk")));
    let silent: Vec<Cue> = cues.iter().map(|cue| Cue { audio_gain: 0.0, ..cue.clone() }).collect();
    let (heard, felt) = (play(&cues), play(&silent));
    // The walk passes six of the eight loudspeakers.
    assert!(HEARD.filter(|channel| energy(heard.channel(*channel)) > 0.0).count() >= 5);
    for channel in 0..36 {
        assert_eq!(heard.channel(channel), felt.channel(channel), "tile {channel}, to the sample");
    }
    assert!(HEARD.into_iter().all(|channel| energy(felt.channel(channel)) == 0.0));
}

#[test]
fn every_material_is_heard_as_much_as_it_says() {
    for material in ["Ice", "Snow", "Gravel", "Sand", "Wood"] {
        for (says, sound) in [("", 0.0), ("sound: 0.25", 0.25), ("sound: 1", 1.0)] {
            let text = format!("Layout(version: 1, grounds: [{material}({says})])");
            let cues = walk(&mut Walker::on(page(&text)));
            assert!(!cues.is_empty(), "{material}");
            assert!(cues.iter().all(|cue| cue.audio_gain == sound), "{material} {says}");
        }
    }
}
