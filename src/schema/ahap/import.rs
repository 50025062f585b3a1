//! AHAP to effects.

use std::collections::BTreeMap;
use std::sync::Arc;

use arrayvec::ArrayVec;

use super::control::{Control, SAME_S};
use super::file::{Entry, Event, File};
use super::{
    AhapError, CONTINUOUS_HZ, CONTINUOUS_N, TRANSIENT_DECAY_S, TRANSIENT_HZ, TRANSIENT_N, at_sharpness,
};
use crate::feel::{
    Click, Clicks, Effect, EffectKind, Impulse, MAX_PARTS, MAX_POINTS, Manner, Mode, Part, PartKind,
    Sequence, Tone, TonePoint,
};
use crate::units::Newtons;

/// Longest that anything lasts, in seconds; as in our own files.
const LONGEST_S: f64 = 60.0;

/// The effect that an AHAP file describes, and what of it has no counterpart.
///
/// `name` is what messages call the text. A pattern of one click or one tone
/// becomes that, any other a sequence.
///
/// # Errors
/// [`AhapError`]: it is not a pattern, or nothing of it can be felt.
pub fn read_ahap(text: &str, name: &str) -> Result<(Effect, Vec<String>), AhapError> {
    if text.len() > 4_000_000 {
        return Err(AhapError::TooLarge(name.to_owned()));
    }
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let file: File = serde_json::from_str(text).map_err(|error| AhapError::Json {
        name: name.to_owned(),
        line: error.line(),
        column: error.column(),
        reason: error.to_string(),
    })?;
    let mut warnings = Warnings::default();
    let (mut events, mut curves, mut parameters) = (Vec::new(), Vec::new(), Vec::new());
    for Entry { event, parameter, parameter_curve, other } in file.pattern {
        events.extend(event);
        curves.extend(parameter_curve);
        parameters.extend(parameter);
        other.keys().for_each(|key| warnings.note(format!("entries called {key}")));
    }
    let ids = curves.iter().map(|curve| &curve.id).chain(parameters.iter().map(|parameter| &parameter.id));
    for id in ids.filter(|id| !matches!(id.as_str(), "HapticIntensityControl" | "HapticSharpnessControl")) {
        warnings.note(format!("the control {id}"));
    }
    let intensity = Control::of("HapticIntensityControl", 1.0, (0.0, 1.0), &curves, &parameters);
    let sharpness = Control::of("HapticSharpnessControl", 0.0, (-1.0, 1.0), &curves, &parameters);
    let mut parts: Vec<Part> =
        events.iter().filter_map(|event| part(event, &intensity, &sharpness, &mut warnings)).collect();
    if parts.len() > MAX_PARTS {
        return Err(AhapError::TooMany { name: name.to_owned(), events: parts.len(), most: MAX_PARTS });
    }
    parts.sort_by(|a, b| a.at_s.total_cmp(&b.at_s));
    let kind = match parts.as_slice() {
        [] => return Err(AhapError::Empty(name.to_owned())),
        [Part { at_s, kind: PartKind::Click(click) }] if *at_s == 0.0 => {
            EffectKind::Click(Clicks { press: click.clone(), release: None })
        }
        [Part { at_s, kind: PartKind::Tone(tone) }] if *at_s == 0.0 => EffectKind::Continuous(tone.clone()),
        _ => EffectKind::Sequence(Sequence { parts: Arc::from(parts), curve: ArrayVec::new() }),
    };
    Ok((Effect { kind, manner: Manner::PLAIN }, warnings.told()))
}

/// What has no counterpart, each with how often it came.
#[derive(Debug, Default)]
struct Warnings(BTreeMap<String, usize>);

impl Warnings {
    fn note(&mut self, what: String) {
        *self.0.entry(what).or_default() += 1;
    }

    fn told(self) -> Vec<String> {
        let times = |count: usize| if count > 1 { format!(" ({count} times)") } else { String::new() };
        self.0
            .into_iter()
            .map(|(what, count)| format!("{what}{}: no counterpart, left out", times(count)))
            .collect()
    }
}

/// The parameters of one event that have a counterpart.
struct Parameters {
    intensity: f32,
    sharpness: f32,
    attack_s: f32,
    decay_s: f32,
    release_s: f32,
    sustained: bool,
}

impl Parameters {
    fn of(event: &Event, warnings: &mut Warnings) -> Self {
        // Apple's defaults, where a file says nothing.
        let mut parameters = Self {
            intensity: 1.0,
            sharpness: 0.5,
            attack_s: 0.0,
            decay_s: 0.0,
            release_s: 0.0,
            sustained: true,
        };
        let transient = event.event_type == "HapticTransient";
        for parameter in &event.event_parameters {
            let value = parameter.value.value() as f32;
            let share = if value >= 0.0 { value.min(1.0) } else { 0.0 };
            match parameter.id.as_str() {
                "HapticIntensity" => parameters.intensity = share,
                "HapticSharpness" => parameters.sharpness = share,
                "AttackTime" if !transient => parameters.attack_s = share,
                "DecayTime" if !transient => parameters.decay_s = share,
                "ReleaseTime" if !transient => parameters.release_s = share,
                "Sustained" if !transient => parameters.sustained = value != 0.0,
                other => warnings.note(format!("{other} of a {}", event.event_type)),
            }
        }
        event.other.keys().for_each(|key| warnings.note(format!("{key} of a {}", event.event_type)));
        parameters
    }
}

fn part(event: &Event, intensity: &Control, sharpness: &Control, warnings: &mut Warnings) -> Option<Part> {
    let seconds = |seconds: f64| if seconds >= 0.0 { seconds.min(LONGEST_S) as f32 } else { 0.0 };
    let at_s = seconds(event.time);
    let parameters = match event.event_type.as_str() {
        "HapticTransient" | "HapticContinuous" => Parameters::of(event, warnings),
        other => {
            warnings.note(format!("events of the type {other}"));
            return None;
        }
    };
    let sharp = |t: f32| (parameters.sharpness + sharpness.at(t)).clamp(0.0, 1.0);
    let kind = if event.event_type == "HapticTransient" {
        let sharpness = sharp(at_s);
        let mode = Mode {
            frequency_hz: at_sharpness(TRANSIENT_HZ, sharpness),
            decay_s: at_sharpness(TRANSIENT_DECAY_S, sharpness),
            amplitude: 1.0,
        };
        PartKind::Click(Click {
            modes: [mode].into_iter().collect(),
            level: Newtons(TRANSIENT_N * parameters.intensity * intensity.at(at_s)),
            impulse: Impulse::default(),
        })
    } else {
        let length_s = seconds(event.event_duration.unwrap_or(0.0)).max(0.001);
        let end = at_s + length_s + parameters.release_s;
        let mut times: Vec<f32> = intensity.bends(at_s, end).chain(sharpness.bends(at_s, end)).collect();
        let mut curve = ArrayVec::<TonePoint, MAX_POINTS>::new();
        let differs = |control: &Control| (control.at(at_s) - control.until(end)).abs() > 1e-4;
        if !times.is_empty() || differs(intensity) || differs(sharpness) {
            times.extend([at_s, end]);
            times.sort_by(f32::total_cmp);
            times.dedup_by(|later, earlier| *later - *earlier < SAME_S);
            if times.len() > MAX_POINTS {
                warnings.note(format!("points of control curves beyond {MAX_POINTS} for one event"));
                times.drain(MAX_POINTS - 1..times.len() - 1);
            }
            let last = times.len() - 1;
            curve.extend(times.iter().enumerate().map(|(number, &t)| {
                // What begins where the event ends concerns it no more.
                let (level, sharpness) = if number == last {
                    (intensity.until(t), (parameters.sharpness + sharpness.until(t)).clamp(0.0, 1.0))
                } else {
                    (intensity.at(t), sharp(t))
                };
                TonePoint { at_s: t - at_s, level, hz: Some(at_sharpness(CONTINUOUS_HZ, sharpness)) }
            }));
        }
        // Without bends the controls are the same all along.
        let steady = if curve.is_empty() { intensity.at(at_s) } else { 1.0 };
        PartKind::Tone(Tone {
            level: Newtons(CONTINUOUS_N * parameters.intensity * steady),
            hz: at_sharpness(
                CONTINUOUS_HZ,
                if curve.is_empty() { sharp(at_s) } else { parameters.sharpness },
            ),
            noise: 0.0,
            length_s,
            attack_s: parameters.attack_s,
            // What is not sustained dies away over its duration, if its decay says nothing.
            decay_s: if parameters.sustained || parameters.decay_s > 0.0 {
                parameters.decay_s
            } else {
                length_s
            },
            sustain: if parameters.sustained { 1.0 } else { 0.0 },
            release_s: parameters.release_s,
            curve,
        })
    };
    Some(Part { at_s, kind })
}
