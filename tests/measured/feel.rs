//! The audio callback allocates no memory.

use assert_no_alloc::{assert_no_alloc, violation_count};
use underfoot::feel::{
    Click, Cue, Hum, Impulse, Lasting, Manner, Mode, RendererConfig, Spot, SustainedCue, SustainedCues, Tone,
    renderer,
};
use underfoot::floor::{Floor, Loudspeaker, Response};
use underfoot::glam::Vec2;
use underfoot::schema::Effects;
use underfoot::units::{Instant, Newtons};

/// Ten seconds of forty sustained cues of every model, of clicks of eight modes struck by soft pushes and of tones, a
/// new one every 2 ms, on four tiles each and most of them on loudspeakers.
#[test]
fn the_busiest_ten_seconds_do_not_allocate() {
    let (mut sender, mut renderer) = renderer(RendererConfig::of(&whole_floor(), 48_000));
    let mut scope = renderer.scope().unwrap();
    let effects = Effects::builtin();
    let frames = 48; // one millisecond
    let mut out = vec![0.0; frames * renderer.channels()];
    let mut moved = 0_usize;
    for n in 0..10_000_u64 {
        let now = Instant::from_millis(n);
        let sustained: SustainedCues = (0..40).map(|foot| sustained_cue(&effects, foot, n)).collect();
        let cue = cue(n, now);
        assert_no_alloc(|| {
            sender.sustain(&sustained);
            if n % 2 == 0 {
                sender.send(&cue);
            }
            if n % 3000 == 2500 {
                sender.silence();
            }
            if n % 3000 == 2600 {
                sender.resume();
            }
            sender.mute((n % 36) as u16, n % 5 == 0);
            renderer.render(&mut out, now);
            scope.update();
        });
        moved += out.iter().filter(|sample| **sample != 0.0).count();
    }
    assert_eq!(violation_count(), 0);
    assert!(moved > 10_000_000, "only {moved} samples moved: not busy at all");
    assert!(renderer.counters().stolen > 0, "voices were never stolen: not busy at all");
}

/// A floor with all features: measured plates, and eight loudspeakers.
fn whole_floor() -> Floor {
    let mut floor = Floor::default();
    let response = Response::of(vec![(40.0, -12.0), (70.0, 9.0), (300.0, -6.0), (800.0, -15.0)]);
    floor.responses.fill(response);
    let around = (36..44).map(|channel| {
        let at = Vec2::splat(0.9) + 1.5 * Vec2::from_angle(f32::from(channel) * 0.785);
        Loudspeaker { at, channel, gain_db: 0.0 }
    });
    floor.loudspeakers = around.collect();
    floor
}

fn spots(first: u64) -> impl Iterator<Item = Spot> {
    (0..4).map(move |spot| Spot { tile: ((first * 5 + spot) % 36) as u16, weight: 0.25 })
}

fn cue(n: u64, at: Instant) -> Cue {
    // Always other frequencies, so that every click needs slots of its own.
    let modes = (0..8_u64)
        .map(|mode| Mode {
            frequency_hz: 50.0 + ((n * 8 + mode) * 7 % 900) as f32,
            decay_s: 0.5,
            amplitude: 0.1,
        })
        .collect();
    Cue {
        at,
        received: at,
        spots: spots(n).collect(),
        click: Click { modes, level: Newtons(10.0), impulse: Impulse { width_s: 0.002, round: 1.0 } },
        tone: n.is_multiple_of(40).then(|| Tone {
            level: Newtons(2.0),
            hz: 80.0,
            length_s: 0.2,
            ..Tone::default()
        }),
        manner: Manner { duck_db: 6.0, ..Manner::PLAIN },
        audio_gain: 0.5,
        // Every third one sounds at a place of its own, like a ground event.
        heard_at: n.is_multiple_of(3).then(|| Vec2::new((n % 18) as f32 * 0.1, 0.9)),
    }
}

/// Every model in turn: noise, stick-slip, ridges, grains, a hum.
fn lasting(effects: &Effects, n: u64) -> Lasting {
    let names = ["smooth", "rubber", "grating", "gravel", "leather"];
    let named = effects.get(names[n as usize % names.len()]).unwrap();
    let hum = Hum { level: Newtons(2.0), hz: 90.0, noise: 0.3 };
    if n % 6 == 5 { Lasting::Hum(hum) } else { named.effect.kind.lasting().unwrap() }
}

fn sustained_cue(effects: &Effects, foot: u32, n: u64) -> SustainedCue {
    SustainedCue {
        // Sometimes a foot lifts and another lands.
        key: foot + 40 * (n / 100 % 3) as u32,
        spots: spots(u64::from(foot) + n / 50).collect(),
        effect: lasting(effects, u64::from(foot) + n / 100 % 3),
        manner: Manner { duck_db: (n % 7) as f32, priority: (foot % 10) as u8, ..Manner::PLAIN },
        speed_m_s: (n % 100) as f32 * 0.01,
        force: Newtons(300.0),
        audio_gain: (n % 3) as f32 * 0.4,
    }
}
