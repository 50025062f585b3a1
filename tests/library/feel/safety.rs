//! The rack stays gentle under a standing person: limits, silence, loss.

use proptest::prelude::*;
use underfoot::feel::{
    Click, Cue, CueSender, Friction, Mode, RendererConfig, Spot, SustainedCue, SustainedCues, renderer,
};
use underfoot::floor::{Floor, Loudspeaker, Response};
use underfoot::glam::Vec2;
use underfoot::sink::{ActuatorSink, ManualSink};
use underfoot::units::{Instant, Newtons};

use super::strike;

fn millis(millis: u64) -> Instant {
    Instant::from_millis(millis)
}

fn floor() -> (CueSender, ManualSink) {
    let (sender, renderer) = renderer(RendererConfig::of(&Floor::default(), 48_000));
    (sender, ManualSink::new(renderer, Instant::START))
}

/// A floor with all features: measured plates, and loudspeakers.
fn whole_floor() -> (CueSender, ManualSink) {
    let mut floor = Floor::default();
    floor.responses[3] = Response::of(vec![(40.0, -3.0), (300.0, 3.0), (800.0, -9.0)]);
    floor.loudspeakers = vec![
        Loudspeaker { at: Vec2::ZERO, channel: 36, gain_db: 0.0 },
        Loudspeaker { at: Vec2::splat(2.0), channel: 38, gain_db: 24.0 },
    ];
    let (sender, renderer) = renderer(RendererConfig::of(&floor, 48_000));
    (sender, ManualSink::new(renderer, Instant::START))
}

fn click(level: f32, decay_s: f32) -> Click {
    let modes = [60.0, 150.0, 320.0].map(|frequency_hz| Mode { frequency_hz, decay_s, amplitude: 1.0 });
    Click { modes: modes.into_iter().collect(), level: Newtons(level), ..Click::default() }
}

fn sustained_cue(speed_m_s: f32, force: f32) -> SustainedCue {
    let friction = Friction {
        level: Newtons(3.0),
        low_hz: 90.0,
        high_hz: 400.0,
        full_speed_m_s: 0.5,
        full_force: Newtons(400.0),
    };
    let spots = [Spot { tile: 3, weight: 1.0 }].into_iter().collect();
    SustainedCue {
        key: 1,
        spots,
        effect: friction.into(),
        speed_m_s,
        force: Newtons(force),
        ..SustainedCue::default()
    }
}

#[test]
fn stop_fades_out_in_5_ms_to_exact_zero_and_forgets_what_was_to_come() {
    let (mut sender, mut sink) = floor();
    sender.send(&strike(millis(10), 0, click(20.0, 1.0)));
    sender.send(&strike(millis(70), 0, click(20.0, 1.0)));
    sender.sustain(&[sustained_cue(0.3, 300.0)].into_iter().collect());
    sink.advance(millis(50)).unwrap();
    sender.silence();
    assert!(!sender.send(&strike(millis(60), 1, click(20.0, 1.0))));
    sink.advance(millis(100)).unwrap();
    for tile in [0, 3] {
        let samples = sink.channel(tile);
        assert!(samples[50 * 48 - 20..50 * 48].iter().any(|x| x.abs() > 0.001), "tile {tile} moved before");
        assert!(
            samples[50 * 48..52 * 48].iter().any(|x| *x != 0.0),
            "tile {tile} fades, it does not break off"
        );
        assert!(samples[55 * 48 + 1..].iter().all(|x| *x == 0.0), "tile {tile} is silent after 5 ms");
    }
    assert_eq!(sender.counters().muted, 2);

    sender.resume();
    sender.send(&strike(millis(110), 1, click(20.0, 0.05)));
    sink.advance(millis(200)).unwrap();
    assert!(sink.channel(0)[100 * 48..].iter().all(|x| *x == 0.0), "what rang before does not come back");
    assert_eq!(sink.channel(1).iter().position(|x| *x != 0.0), Some(110 * 48));
}

#[test]
fn a_stop_that_is_soon_lifted_is_not_missed() {
    let (mut sender, mut sink) = floor();
    sender.send(&strike(millis(10), 0, click(20.0, 1.0)));
    sink.advance(millis(50)).unwrap();
    sender.silence();
    sender.resume();
    sink.advance(millis(100)).unwrap();
    assert!(sink.channel(0)[55 * 48 + 1..].iter().all(|x| *x == 0.0));
}

#[test]
fn a_sustained_cue_that_nobody_renews_fades_out() {
    let (mut sender, mut sink) = floor();
    sender.sustain(&[sustained_cue(0.4, 300.0)].into_iter().collect());
    sink.advance(millis(200)).unwrap();
    let samples = sink.channel(3);
    assert!(samples[30 * 48..50 * 48].iter().any(|x| x.abs() > 0.001));
    // 50 ms until the time-out, 15 ms of fading, and the DC blocker settles.
    assert!(samples[75 * 48..].iter().all(|x| x.abs() < 0.001));
    sink.advance(millis(600)).unwrap();
    assert!(sink.channel(3)[550 * 48..].iter().all(|x| *x == 0.0));
}

#[test]
fn everybody_stamping_at_once_stays_within_full_scale() {
    let (mut sender, mut sink) = floor();
    for n in 0..200 {
        sender.send(&strike(millis(20 + n / 4), (n % 3) as u16, click(300.0, 1.0)));
        sink.advance(millis(20 + n / 4)).unwrap();
    }
    sink.advance(millis(300)).unwrap();
    for tile in 0..3 {
        let peak = sink.channel(tile).iter().fold(0.0_f32, |peak, x| peak.max(x.abs()));
        assert!((0.8..=1.0).contains(&peak), "tile {tile}: {peak}");
    }
    assert!(sender.counters().overloaded > 0);
}

fn any_number() -> impl Strategy<Value = f32> {
    prop_oneof![
        any::<f32>(),
        Just(f32::NAN),
        Just(f32::INFINITY),
        Just(1e9),
        Just(-1e9),
        Just(0.0),
        -1.0..1.0_f32,
        20.0..1000.0_f32,
    ]
}

prop_compose! {
    fn any_spots()(spots in prop::collection::vec((any::<u8>(), any_number()), 0..4)) -> Vec<Spot> {
        spots.into_iter().map(|(tile, weight)| Spot { tile: u16::from(tile) % 40, weight }).collect()
    }
}

prop_compose! {
    fn any_cue()(
        at in any::<u32>(),
        spots in any_spots(),
        modes in prop::collection::vec((any_number(), any_number(), any_number()), 0..8),
        level in any_number(),
        audio_gain in any_number(),
    ) -> Cue {
        let modes = modes
            .into_iter()
            .map(|(frequency_hz, decay_s, amplitude)| Mode { frequency_hz, decay_s, amplitude })
            .collect();
        let at = Instant::from_micros(u64::from(at) % 50_000);
        let spots = spots.into_iter().collect();
        let click = Click { modes, level: Newtons(level), ..Click::default() };
        Cue { at, received: at, spots, click, audio_gain, ..Cue::default() }
    }
}

prop_compose! {
    fn any_sustained()(
        key in 0..4_u32,
        spots in any_spots(),
        numbers in prop::array::uniform8(any_number()),
    ) -> SustainedCue {
        let [level, low_hz, high_hz, full_speed_m_s, full_force, speed_m_s, force, audio_gain] = numbers;
        let friction = Friction {
            level: Newtons(level),
            low_hz,
            high_hz,
            full_speed_m_s,
            full_force: Newtons(full_force),
        };
        SustainedCue {
            key,
            spots: spots.into_iter().collect(),
            effect: friction.into(),
            speed_m_s,
            force: Newtons(force),
            audio_gain,
            ..SustainedCue::default()
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn whatever_comes_in_the_output_is_finite_and_limited(
        cues in prop::collection::vec(any_cue(), 0..12),
        sustained in prop::collection::vec(prop::collection::vec(any_sustained(), 0..16), 1..4),
    ) {
        let (mut sender, mut sink) = whole_floor();
        for cue in &cues {
            sender.send(cue);
        }
        for (n, sustained) in sustained.into_iter().enumerate() {
            sender.sustain(&sustained.into_iter().collect::<SustainedCues>());
            sink.advance(millis(20 * (n as u64 + 1))).unwrap();
        }
        for channel in 0..sink.channels() {
            prop_assert!(sink.channel(channel).iter().all(|x| x.is_finite() && x.abs() <= 1.0));
            prop_assert!(!sink.channel(channel).iter().any(|x| x.is_subnormal()));
        }
    }
}
