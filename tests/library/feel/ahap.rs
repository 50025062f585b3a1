//! Apple's haptic patterns, in and out.

use std::sync::Arc;

use proptest::prelude::*;
use underfoot::feel::{
    Click, Effect, EffectKind, Gesture, Impulse, Manner, Mode, Part, PartKind, Sequence, Tone, TonePoint,
    analyse, audition,
};
use underfoot::schema::{AhapError, Effects, read_ahap, write_ahap};
use underfoot::units::Newtons;

/// A spring: a tap, then a hum that becomes weaker and duller by two curves, as in Apple's own samples.
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
    assert!(matches!(error("{ \"Pattern\": [] }"), AhapError::Empty { .. }));
    assert!(matches!(error(&" ".repeat(5_000_000)), AhapError::TooLarge(_)));
    for name in ["wood", "rubber", "detent", "end_stop", "smooth"] {
        let effect = Arc::clone(&Effects::builtin().get(name).unwrap().effect);
        assert!(matches!(write_ahap(&effect, name), Err(AhapError::Driven(_))), "{name}");
    }
}

fn pattern(entries: &[String]) -> String {
    format!("{{ \"Version\": 1.0, \"Pattern\": [{}] }}", entries.join(","))
}

fn tap(time: impl std::fmt::Display) -> String {
    format!("{{ \"Event\": {{ \"Time\": {time}, \"EventType\": \"HapticTransient\" }} }}")
}

fn hum(time: f32, duration: f32, parameters: &str) -> String {
    format!(
        "{{ \"Event\": {{ \"Time\": {time}, \"EventType\": \"HapticContinuous\", \"EventDuration\": {duration}, \
         \"EventParameters\": [{parameters}] }} }}"
    )
}

/// A curve of a control through these points, starting at time 0.
fn curve(id: &str, points: &[(f32, f32)]) -> String {
    let points: Vec<String> =
        points.iter().map(|(t, value)| format!("{{ \"Time\": {t}, \"ParameterValue\": {value} }}")).collect();
    format!(
        "{{ \"ParameterCurve\": {{ \"ParameterID\": \"{id}\", \"Time\": 0, \"ParameterCurveControlPoints\": [{}] }} }}",
        points.join(",")
    )
}

#[test]
fn commas_may_trail_and_comments_may_stand_anywhere() {
    let (plain, _) = read_ahap(BOING, "plain").unwrap();
    let trailing = BOING.replace(" }", ", }").replace(" ]", ", ]").replace("}\n  ]", "},\n  ]");
    let spaced = BOING.replace(" }", " ,\n }").replace(" ]", ",\t ]");
    let commented = BOING
        .replace("\"Metadata\"", "// an example, of \"course\"\n  \"Metadata\"")
        .replace(" ] }", " , /* the last, } ] */ ] }")
        .replace("a spring", "a // spring, /* not a comment */ ,}");
    let marked = format!("\u{feff} {BOING}");
    for text in [trailing, spaced, commented, marked] {
        let (effect, warnings) =
            read_ahap(&text, "lenient").unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert_eq!((&effect, warnings), (&plain, Vec::new()), "{text}");
    }
}

#[test]
fn text_that_is_not_json_is_refused_with_its_place() {
    for (text, place) in [
        ("{ \"Pattern\": [ { } { } ] }", "x.ahap:1:"),
        ("{ \"Pattern\": [\n / ] }", "x.ahap:2:2"),
        ("{ \"Pattern\": [\n /* never closed ] }", "x.ahap:2:"),
        ("{ \"Pattern\": [\n \"never closed ] }", "x.ahap:2:"),
        ("", "x.ahap:1:0"),
    ] {
        let error = read_ahap(text, "x.ahap").unwrap_err();
        assert!(error.to_string().starts_with(place), "{text}: {error}");
    }
}

#[test]
fn events_after_a_minute_are_left_out_and_never_moved() {
    for late in [&[61.0, 62.5, 600.0][..], &[60.01], &[86_400.0]] {
        let entries: Vec<String> = [0.0, 30.0, 60.0].iter().chain(late).map(tap).collect();
        let (effect, warnings) = read_ahap(&pattern(&entries), "taps").unwrap();
        let times: Vec<f32> = parts(&effect).iter().map(|part| part.at_s).collect();
        assert_eq!(times, [0.0, 30.0, 60.0]);
        let [warning] = &warnings[..] else { panic!("{warnings:?}") };
        let number = format!("left out, {} of them", late.len());
        assert!(warning.contains("after 60 s") && warning.contains(&number), "{warning}");
        assert!(warning.contains(&format!("{:.3} s", late.last().unwrap())), "{warning}");
    }
    let error = read_ahap(&pattern(&[tap(61), tap(62)]), "late").unwrap_err().to_string();
    assert!(error.contains("that can be played") && error.contains("after 60 s"), "{error}");
}

#[test]
fn the_end_of_a_tone_beyond_a_minute_is_left_out_and_named() {
    let (effect, warnings) = read_ahap(&pattern(&[hum(0.0, 95.0, "")]), "tone").unwrap();
    let EffectKind::Continuous(tone) = &effect.kind else { panic!("{effect:?}") };
    assert_eq!(tone.length_s, 60.0);
    assert!(warnings[0].contains("its last 35.000 s are left out"), "{warnings:?}");
}

#[test]
fn times_that_are_none_are_refused() {
    let event = |time: &str, duration: &str| {
        format!(
            "{{ \"Event\": {{ \"Time\": {time}, \"EventType\": \"HapticContinuous\", \"EventDuration\": {duration} }} }}"
        )
    };
    let control = |time: &str| {
        format!(
            "{{ \"Parameter\": {{ \"ParameterID\": \"HapticIntensityControl\", \"ParameterValue\": 1, \"Time\": {time} }} }}"
        )
    };
    let points = |begin: &str, point: &str| {
        format!(
            "{{ \"ParameterCurve\": {{ \"ParameterID\": \"HapticIntensityControl\", \"Time\": {begin}, \
             \"ParameterCurveControlPoints\": [{{ \"Time\": {point}, \"ParameterValue\": 1 }}] }} }}"
        )
    };
    for time in ["1e300", "-1", "-1e-3", "86401", "1.7976931348623157e308"] {
        for (entry, field) in [
            (event(time, "1"), "Time"),
            (event("0", time), "EventDuration"),
            (control(time), "Time"),
            (points(time, "0"), "Time"),
            (points("0", time), "Time of a control point"),
        ] {
            let error = read_ahap(&pattern(&[tap(0), entry]), "x.ahap").unwrap_err();
            assert!(matches!(error, AhapError::Time { entry: 2, .. }), "{time}: {error}");
            assert!(error.to_string().contains(&format!("{field} is")), "{time}: {error}");
        }
    }
    for time in ["NaN", "Infinity", "1e999", "\"soon\"", "null"] {
        let error = read_ahap(&pattern(&[event(time, "1")]), "x.ahap").unwrap_err();
        assert!(matches!(error, AhapError::Json { .. }), "{time}: {error}");
    }
}

#[test]
fn as_many_taps_as_apples_longest_patterns_have_are_kept() {
    let taps: Vec<String> = (0..300).map(|n| tap(0.02 * f64::from(n))).collect();
    let (effect, warnings) = read_ahap(&pattern(&taps[..200]), "gravel").unwrap();
    assert_eq!((parts(&effect).len(), warnings), (200, Vec::new()));
    let (effect, warnings) = read_ahap(&pattern(&taps), "gravel").unwrap();
    assert_eq!(parts(&effect).len(), 240);
    assert!(warnings[0].contains("events from 4.800 s on: left out, 60 of them"), "{warnings:?}");
    // In any order in the file.
    let reversed: Vec<String> = taps.into_iter().rev().collect();
    assert_eq!(read_ahap(&pattern(&reversed), "gravel").unwrap(), (effect, warnings));
}

/// Sum of the levels of all tones at `t`, relative to full intensity.
fn level_at(effect: &Effect, t: f32) -> f32 {
    let of = |at_s: f32, tone: &Tone| tone.level.0 / 12.0 * tone.at(t - at_s).0;
    match &effect.kind {
        EffectKind::Continuous(tone) => of(0.0, tone),
        EffectKind::Sequence(sequence) => sequence
            .parts
            .iter()
            .map(|part| match &part.kind {
                PartKind::Tone(tone) => of(part.at_s, tone),
                PartKind::Click(_) => 0.0,
            })
            .sum(),
        other => panic!("{other:?}"),
    }
}

/// The value of the polyline through `points` at `t`.
fn line_at(points: &[(f32, f32)], t: f32) -> f32 {
    let after = points.iter().position(|point| point.0 > t).unwrap_or(points.len() - 1).max(1);
    let (a, b) = (points[after - 1], points[after]);
    a.1 + (b.1 - a.1) * (t - a.0) / (b.0 - a.0)
}

/// The greatest difference in level of a hum of two seconds under this curve, the warnings, and the number of parts.
fn difference(points: &[(f32, f32)], parameters: &str) -> (f32, Vec<String>, usize) {
    let text = pattern(&[hum(0.0, 2.0, parameters), curve("HapticIntensityControl", points)]);
    let (effect, warnings) = read_ahap(&text, "long").unwrap();
    let seams: Vec<f32> = match &effect.kind {
        EffectKind::Sequence(sequence) => sequence.parts.iter().skip(1).map(|part| part.at_s).collect(),
        _ => Vec::new(),
    };
    let near_seam = |t: f32| seams.iter().any(|seam| (t - seam).abs() < 0.012);
    let worst = (1..1999)
        .map(|n| n as f32 / 1000.0)
        .filter(|t| !near_seam(*t))
        .map(|t| (level_at(&effect, t) - line_at(points, t)).abs())
        .fold(0.0, f32::max);
    (worst, warnings, seams.len() + 1)
}

#[test]
fn long_curves_are_simplified_within_the_error_that_is_stated() {
    let smooth = |f: fn(f32) -> f32| -> Vec<(f32, f32)> {
        (0..=250).map(|n| 0.008 * n as f32).map(|t| (t, f(t))).collect()
    };
    for (name, f) in [
        ("fades", (|t| (-2.0 * t).exp()) as fn(f32) -> f32),
        ("swells", |t| (t * std::f32::consts::FRAC_PI_2).sin().abs()),
        ("rests, rises, rests", |t| ((t - 0.5).clamp(0.0, 0.3) / 0.3).clamp(0.0, 1.0)),
    ] {
        let (worst, warnings, tones) = difference(&smooth(f), "");
        assert_eq!(tones, 1, "{name}");
        let stated = if warnings.is_empty() { 0.0 } else { stated(&warnings) };
        assert!(worst <= stated + 2e-3, "{name}: {worst}, {warnings:?}");
    }
}

/// The error that a warning states, as a share.
fn stated(warnings: &[String]) -> f32 {
    let warning = warnings.iter().find(|warning| warning.contains("within")).unwrap();
    warning.split("within ").nth(1).unwrap().split(' ').next().unwrap().parse::<f32>().unwrap() / 100.0
}

#[test]
fn curves_that_cannot_be_simplified_are_split_and_never_cut() {
    // A saw of 100 teeth: no point can be left out.
    let saw: Vec<(f32, f32)> =
        (0..=200).map(|n| (0.01 * n as f32, if n % 2 == 0 { 0.1 } else { 0.9 })).collect();
    let (worst, warnings, tones) = difference(&saw, "");
    assert!(tones > 10 && warnings[0].contains(&format!("split among {tones} tones")), "{warnings:?}");
    assert!(worst <= stated(&warnings) + 2e-3, "{worst}, {warnings:?}");
}

#[test]
fn a_split_tone_keeps_its_attack_and_its_release() {
    let saw: Vec<(f32, f32)> =
        (0..=240).map(|n| (0.01 * n as f32, if n % 2 == 0 { 0.6 } else { 1.0 })).collect();
    let envelope = r#"{ "ParameterID": "AttackTime", "ParameterValue": 0.4 },
        { "ParameterID": "ReleaseTime", "ParameterValue": 0.3 }"#;
    let text = pattern(&[hum(0.0, 2.0, envelope), curve("HapticIntensityControl", &saw)]);
    let (effect, _) = read_ahap(&text, "long").unwrap();
    let envelope = |t: f32| (t / 0.4).min(1.0) * (1.0 - ((t - 2.0) / 0.3).max(0.0));
    for t in [0.1_f32, 0.2, 0.3, 1.0, 2.15] {
        // A seam lies near at most one of three times.
        let off =
            [t, t + 0.001, t + 0.03].map(|t| (level_at(&effect, t) - envelope(t) * line_at(&saw, t)).abs());
        let least = off.into_iter().fold(f32::INFINITY, f32::min);
        assert!(least < 0.08, "at {t}: off by {off:?}");
    }
    assert_eq!(level_at(&effect, 2.31), 0.0);
}

/// A minute of a control that jumps every millisecond, under many tones: reading it ends in any case.
#[test]
fn no_number_of_control_points_takes_for_ever() {
    let step = |n: u32| {
        format!(
            "{{\"Parameter\":{{\"ParameterID\":\"HapticIntensityControl\",\"ParameterValue\":0.{},\"Time\":{}}}}}",
            n % 10,
            f64::from(n) * 0.0015
        )
    };
    let entries: Vec<String> =
        (0..50).map(|n| hum(n as f32, 50.0, "")).chain((0..40_000).map(step)).collect();
    let (effect, warnings) = read_ahap(&pattern(&entries), "jumps").unwrap();
    assert_eq!(parts(&effect).len(), 240);
    assert!(warnings.iter().any(|warning| warning.contains("tones of split events")), "{warnings:?}");
}

#[test]
fn values_beyond_their_range_are_named() {
    let loud = r#"{ "ParameterID": "HapticIntensity", "ParameterValue": 1e300 }"#;
    let text = pattern(&[hum(0.0, 1.0, loud), curve("HapticSharpnessControl", &[(0.0, -7.0), (1.0, 0.0)])]);
    let (effect, warnings) = read_ahap(&text, "loud").unwrap();
    let EffectKind::Continuous(tone) = &effect.kind else { panic!("{effect:?}") };
    assert_eq!(tone.level, Newtons(12.0));
    let told = warnings.join("\n");
    assert!(told.contains("HapticIntensity of a HapticContinuous: out of range"), "{told}");
    assert!(told.contains("HapticSharpnessControl: 1 values were out of range"), "{told}");
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

    /// Parts half a second apart, so that no curve affects a neighbour.
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
        // A second export is equal to the first.
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
