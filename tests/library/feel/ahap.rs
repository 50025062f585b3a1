//! Apple's haptic patterns, in and out.

use std::sync::Arc;

use proptest::prelude::*;
use underfoot::feel::{
    Click, Effect, EffectKind, Gesture, Impulse, Manner, Mode, Part, PartKind, Sequence, Tone, TonePoint,
    analyse, audition,
};
use underfoot::schema::{AhapError, Effects, read_ahap, write_ahap};
use underfoot::units::Newtons;

/// A spring: a tap, then a hum that fades and dulls by two curves, as in Apple's own samples.
const BOING: &str = r#"{
  "Version": 1.0,
  "Metadata": { "Description": "a spring" },
  "Pattern": [
    { "Event": { "Time": 0.0, "EventType": "HapticTransient", "EventParameters": [
        { "ParameterID": "HapticIntensity", "ParameterValue": 0.8 },
        { "ParameterID": "HapticSharpness", "ParameterValue": 0.4 } ] } },
    { "Event": { "Time": 0.015, "EventType": "HapticContinuous", "EventDuration": 0.25, "EventParameters": [
        { "ParameterID": "HapticIntensity", "ParameterValue": 0.8 },
        { "ParameterID": "HapticSharpness", "ParameterValue": 0.4 } ] } },
    { "ParameterCurve": { "ParameterID": "HapticIntensityControl", "Time": 0.015, "ParameterCurveControlPoints": [
        { "Time": 0, "ParameterValue": 1 }, { "Time": 0.1, "ParameterValue": 0.5 }, { "Time": 0.25, "ParameterValue": 0.0 } ] } },
    { "ParameterCurve": { "ParameterID": "HapticSharpnessControl", "Time": 0.015, "ParameterCurveControlPoints": [
        { "Time": 0, "ParameterValue": 0.0 }, { "Time": 0.25, "ParameterValue": -0.3 } ] } }
  ]
}"#;

fn parts(effect: &Effect) -> Vec<Part> {
    let EffectKind::Sequence(sequence) = &effect.kind else { panic!("a sequence: {effect:?}") };
    sequence.parts.to_vec()
}

#[test]
fn a_pattern_with_curves_is_felt_as_it_says() {
    let (effect, warnings) = read_ahap(BOING, "boing.ahap").unwrap();
    assert_eq!(warnings, Vec::<String>::new());
    let parts = parts(&effect);
    let (PartKind::Click(click), PartKind::Tone(tone)) = (&parts[0].kind, &parts[1].kind) else {
        panic!("{parts:?}")
    };
    assert_eq!(click.level, Newtons(16.0));
    assert_eq!((tone.length_s, tone.curve.len()), (0.25, 3));
    let levels: Vec<f32> = [0.0, 0.05, 0.1, 0.175].iter().map(|t| tone.at(*t).0).collect();
    for (level, wanted) in levels.iter().zip([1.0, 0.75, 0.5, 0.25]) {
        assert!((level - wanted).abs() < 1e-3, "{levels:?}");
    }
    // From sharpness 0.4 down to 0.1.
    assert!((tone.at(0.0).1 - 70.0 * 4.0_f32.powf(0.4)).abs() < 0.1);
    assert!((tone.at(0.2499).1 - 70.0 * 4.0_f32.powf(0.1)).abs() < 0.2);
    let effect = Arc::new(effect);
    let samples = audition(&effect, &Gesture::usual(&effect), 48_000);
    let analysis = analyse(&samples, 48e3, effect.manner.band).unwrap();
    assert!(analysis.within > 0.95 && analysis.peak > 10.0, "{} N", analysis.peak);
}

#[test]
fn dynamic_parameters_change_at_once_and_concern_what_comes_later() {
    let text = r#"{ "Pattern": [
        { "Event": { "Time": 0, "EventType": "HapticTransient", "EventParameters": [] } },
        { "Parameter": { "ParameterID": "HapticIntensityControl", "ParameterValue": 0.5, "Time": 0.1 } },
        { "Event": { "Time": 0.2, "EventType": "HapticTransient", "EventParameters": [] } },
        { "Event": { "Time": 0.05, "EventType": "HapticContinuous", "EventDuration": 0.1, "EventParameters": [
            { "ParameterID": "Sustained", "ParameterValue": true } ] } } ] }"#;
    let (effect, warnings) = read_ahap(text, "steps.ahap").unwrap();
    assert!(warnings.is_empty());
    let parts = parts(&effect);
    let level = |part: &Part| match &part.kind {
        PartKind::Click(click) => click.level.0,
        PartKind::Tone(tone) => tone.level.0,
    };
    assert_eq!((level(&parts[0]), level(&parts[2])), (20.0, 10.0));
    let PartKind::Tone(tone) = &parts[1].kind else { panic!("a tone") };
    assert_eq!((tone.at(0.04).0, tone.at(0.06).0), (1.0, 0.5));
}

#[test]
fn what_has_no_counterpart_is_named() {
    let text = r#"{ "Version": 1, "Pattern": [
        { "Event": { "Time": 0, "EventType": "AudioCustom", "EventWaveformPath": "bell.wav" } },
        { "Event": { "Time": 0, "EventType": "HapticTransient", "EventParameters": [
            { "ParameterID": "AttackTime", "ParameterValue": 0.1 } ], "EventName": "tap" } },
        { "Event": { "Time": 1, "EventType": "HapticContinuous", "EventDuration": 1, "EventParameters": [
            { "ParameterID": "AudioPitch", "ParameterValue": 0.1 }, { "ParameterID": "AudioPitch", "ParameterValue": 0.1 } ] } },
        { "ParameterCurve": { "ParameterID": "HapticAttackTimeControl", "Time": 0, "ParameterCurveControlPoints": [] } },
        { "Loop": 3 } ] }"#;
    let (_, warnings) = read_ahap(text, "odd.ahap").unwrap();
    let told = warnings.join("\n");
    for what in [
        "events of the type AudioCustom",
        "AttackTime of a HapticTransient",
        "EventName of a HapticTransient",
        "AudioPitch of a HapticContinuous (2 times)",
        "the control HapticAttackTimeControl",
        "entries called Loop",
    ] {
        assert!(told.contains(what), "{what} is not in:\n{told}");
    }
    assert_eq!(warnings.len(), 6, "{told}");

    let (_, lost) = write_ahap(&Effects::builtin().get("heavy_click").unwrap().effect, "heavy").unwrap();
    let lost = lost.join("\n");
    for what in
        ["all but the strongest mode", "the impulse", "felt for a release", "ducking", "20 N", "how long"]
    {
        assert!(lost.contains(what), "{what} is not in:\n{lost}");
    }
}

#[test]
fn what_is_no_pattern_is_refused_with_its_place() {
    let error = |text: &str| read_ahap(text, "x.ahap").unwrap_err();
    assert!(error("{\n  \"Pattern\": 3 }").to_string().starts_with("x.ahap:2:"));
    assert!(matches!(error("{ \"Pattern\": [] }"), AhapError::Empty(_)));
    assert!(matches!(error(&" ".repeat(5_000_000)), AhapError::TooLarge(_)));
    let event = r#"{ "Event": { "Time": 0, "EventType": "HapticTransient" } }"#;
    let many = format!("{{ \"Pattern\": [{}] }}", vec![event; 200].join(","));
    assert!(matches!(error(&many), AhapError::TooMany { events: 200, .. }));
    for name in ["wood", "rubber", "detent", "end_stop", "smooth"] {
        let effect = Arc::clone(&Effects::builtin().get(name).unwrap().effect);
        assert!(matches!(write_ahap(&effect, name), Err(AhapError::Driven(_))), "{name}");
    }
}

#[test]
fn every_shipped_effect_that_is_played_once_goes_out_and_can_come_back() {
    for named in Effects::builtin().iter() {
        let Ok((text, _)) = write_ahap(&named.effect, &named.about) else { continue };
        let (back, warnings) =
            read_ahap(&text, &named.name).unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert!(warnings.is_empty(), "{warnings:?}");
        let samples = audition(&Arc::new(back), &Gesture::usual(&named.effect), 48_000);
        assert!(samples.iter().any(|sample| sample.abs() > 1.0), "{}", named.name);
    }
}

fn click() -> impl Strategy<Value = PartKind> {
    (0.05_f32..1.0, 0.0_f32..1.0).prop_map(|(intensity, sharpness)| {
        let mode = Mode {
            frequency_hz: 90.0 * 3.6_f32.powf(sharpness),
            decay_s: 0.03 * 0.25_f32.powf(sharpness),
            amplitude: 1.0,
        };
        let modes = [mode].into_iter().collect();
        PartKind::Click(Click { modes, level: Newtons(20.0 * intensity), impulse: Impulse::default() })
    })
}

fn tone() -> impl Strategy<Value = PartKind> {
    let curve = prop::collection::vec((0.0_f32..1.0, 0.0_f32..1.0), 0..8);
    (0.05_f32..1.0, 0.0_f32..1.0, 0.05_f32..0.4, 0.0_f32..0.1, any::<bool>(), 0.0_f32..0.1, curve).prop_map(
        |(intensity, sharpness, length_s, attack_s, sustained, release_s, points)| {
            let hz = |sharpness: f32| 70.0 * 4.0_f32.powf(sharpness);
            let whole = length_s + release_s;
            let last = points.len().saturating_sub(1).max(1) as f32;
            let curve = points.iter().enumerate().map(|(n, &(level, sharp))| TonePoint {
                at_s: whole * n as f32 / last,
                level,
                hz: Some(hz(sharp)),
            });
            let curve = if points.len() > 1 { curve.collect() } else { Default::default() };
            PartKind::Tone(Tone {
                level: Newtons(12.0 * intensity),
                hz: hz(sharpness),
                noise: 0.0,
                length_s,
                attack_s,
                decay_s: if sustained { 0.0 } else { length_s },
                sustain: if sustained { 1.0 } else { 0.0 },
                release_s,
                curve,
            })
        },
    )
}

/// Level and pitch of a part over its time.
fn course(part: &Part) -> Vec<(f32, f32)> {
    match &part.kind {
        PartKind::Click(click) => {
            vec![(click.level.0, click.modes[0].frequency_hz), (0.0, click.modes[0].decay_s)]
        }
        PartKind::Tone(tone) => (0..50)
            .map(|n| {
                let (level, hz) = tone.at(tone.whole_s() * (n as f32 + 0.5) / 50.0);
                (level * tone.level.0, hz)
            })
            .collect(),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Parts half a second apart, so that no curve concerns a neighbour.
    #[test]
    fn whatever_ahap_can_say_goes_out_and_comes_back(kinds in prop::collection::vec(prop_oneof![click(), tone()], 2..12)) {
        let parts: Vec<Part> =
            kinds.into_iter().enumerate().map(|(n, kind)| Part { at_s: 0.6 * n as f32, kind }).collect();
        let kind = EffectKind::Sequence(Sequence { parts: parts.clone().into(), curve: Default::default() });
        let (text, lost) = write_ahap(&Effect { kind, manner: Manner::PLAIN }, "made up").unwrap();
        prop_assert!(lost.is_empty(), "{lost:?}");
        let (back, warnings) = read_ahap(&text, "made_up.ahap").unwrap();
        prop_assert!(warnings.is_empty(), "{warnings:?}");
        let back = self::parts(&back);
        prop_assert_eq!(back.len(), parts.len());
        for (back, part) in back.iter().zip(&parts) {
            prop_assert!((back.at_s - part.at_s).abs() < 1e-4);
            for (a, b) in course(back).into_iter().zip(course(part)) {
                prop_assert!((a.0 - b.0).abs() < 0.02 && (a.1 / b.1 - 1.0).abs() < 0.01, "{a:?} {b:?}\n{text}");
            }
        }
        // What came back goes out the same.
        let kind = EffectKind::Sequence(Sequence { parts: back.into(), curve: Default::default() });
        let (again, _) = write_ahap(&Effect { kind, manner: Manner::PLAIN }, "made up").unwrap();
        let (back, _) = read_ahap(&again, "again.ahap").unwrap();
        prop_assert_eq!(self::parts(&back).len(), parts.len());
    }

    #[test]
    fn no_text_makes_it_panic(text in "\\PC*", cut in 0_usize..1200) {
        let _ = read_ahap(&text, "random");
        let _ = read_ahap(BOING.get(..cut.min(BOING.len())).unwrap_or(""), "cut");
    }
}
