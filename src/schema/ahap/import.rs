//! AHAP to effects.

use std::sync::Arc;

use arrayvec::ArrayVec;

use super::control::ControlCurve;
use super::file::{File, ParameterCurve, PatternEntry, PatternEvent};
use super::long_tone::{self, Course};
use super::warnings::ImportNotes;
use super::{AhapError, CONTINUOUS_HZ, TRANSIENT_DECAY_S, TRANSIENT_HZ, TRANSIENT_N, at_sharpness};
use crate::feel::{
    Click, Clicks, Effect, EffectKind, Impulse, MAX_PARTS, Manner, Mode, Part, PartKind, Sequence,
};
use crate::units::Newtons;

/// Latest begin and maximum duration of an event, in seconds, as in this program's own files.
const LONGEST_S: f32 = 60.0;

/// Duration of a tone without a duration, in seconds: the minimum in this program's own files.
pub(super) const SHORTEST_S: f32 = 0.001;

/// Reads the effect that an AHAP file describes, and lists everything that is dropped or differs.
///
/// `name` is the name of the text in messages. A pattern of one click or one tone becomes that, any other a sequence.
/// Events that begin after 60 s, and those beyond the maximum parts of a sequence, are dropped; control curves with
/// more points than a tone can hold are simplified or split. Trailing commas and comments are allowed.
///
/// # Errors
/// [`AhapError`]: the text is not a pattern, one of its times is negative or beyond a day, or no event can be played.
pub fn read_ahap(text: &str, name: &str) -> Result<(Effect, Vec<String>), AhapError> {
    let file = File::parse(text, name)?;
    let mut warnings = ImportNotes::default();
    let (mut events, mut curves, mut parameters) = (Vec::new(), Vec::new(), Vec::new());
    for PatternEntry { event, parameter, parameter_curve, other } in file.pattern {
        events.extend(event);
        curves.extend(parameter_curve);
        parameters.extend(parameter);
        other.keys().for_each(|key| warnings.lost(format!("entries called {}", shown(key))));
    }
    let ids = curves.iter().map(|curve| &curve.id).chain(parameters.iter().map(|parameter| &parameter.id));
    for id in ids.filter(|id| !matches!(id.as_str(), INTENSITY | SHARPNESS)) {
        warnings.lost(format!("the control {}", shown(id)));
    }
    let controls = Controls {
        intensity: ControlCurve::of(INTENSITY, 1.0, (0.0, 1.0), &curves, &parameters),
        sharpness: ControlCurve::of(SHARPNESS, 0.0, (-1.0, 1.0), &curves, &parameters),
    };
    warn_of_values(&controls, &curves, &mut warnings);
    let events = felt(events, &mut warnings);
    let mut course = Course::new(&controls);
    let mut parts: Vec<Part> =
        events.iter().flat_map(|event| parts(event, &controls, &mut course, &mut warnings)).collect();
    parts.sort_by(|a, b| a.at_s.total_cmp(&b.at_s));
    limit_split(&mut parts, &mut warnings);
    let kind = match parts.as_slice() {
        [] => return Err(AhapError::Empty { name: name.to_owned(), left_out: warnings.into_lines() }),
        [Part { at_s, kind: PartKind::Click(click) }] if *at_s == 0.0 => {
            EffectKind::Click(Clicks { press: click.clone(), release: None })
        }
        [Part { at_s, kind: PartKind::Tone(tone) }] if *at_s == 0.0 => EffectKind::Continuous(tone.clone()),
        _ => EffectKind::Sequence(Sequence { parts: Arc::from(parts), curve: ArrayVec::new() }),
    };
    Ok((Effect { kind, manner: Manner::PLAIN }, warnings.into_lines()))
}

const INTENSITY: &str = "HapticIntensityControl";
const SHARPNESS: &str = "HapticSharpnessControl";

/// The controls over time for all events.
pub(super) struct Controls {
    pub(super) intensity: ControlCurve,
    pub(super) sharpness: ControlCurve,
}

/// Prepares a name from the file for messages: bounded length, no control characters.
fn shown(name: &str) -> String {
    let mut shown: String = name.chars().take(64).map(|c| if c.is_control() { '?' } else { c }).collect();
    if name.chars().nth(64).is_some() {
        shown.push_str("...");
    }
    shown
}

fn warn_of_values(controls: &Controls, curves: &[ParameterCurve], warnings: &mut ImportNotes) {
    for (id, control) in [(INTENSITY, &controls.intensity), (SHARPNESS, &controls.sharpness)] {
        if control.limited() > 0 {
            warnings.note(format!(
                "{id}: {} values were out of range and are brought into it",
                control.limited()
            ));
        }
    }
    let is_known = |curve: &ParameterCurve| matches!(curve.id.as_str(), INTENSITY | SHARPNESS);
    if curves.iter().any(|curve| curve.points.is_empty() && is_known(curve)) {
        warnings.lost("curves without points".to_owned());
    }
}

/// Returns the playable events in order of time.
fn felt(events: Vec<PatternEvent>, warnings: &mut ImportNotes) -> Vec<PatternEvent> {
    let (mut felt, mut late) = (Vec::new(), Vec::new());
    for event in events {
        if !matches!(event.event_type.as_str(), TRANSIENT | CONTINUOUS) {
            warnings.lost(format!("events of the type {}", shown(&event.event_type)));
        } else if event.time > f64::from(LONGEST_S) {
            late.push(event.time);
        } else {
            felt.push(event);
        }
    }
    if !late.is_empty() {
        let (first, last) =
            late.iter().fold((f64::INFINITY, 0.0_f64), |(first, last), t| (first.min(*t), last.max(*t)));
        let times =
            if late.len() == 1 { format!("at {first:.3} s") } else { format!("{first:.3} to {last:.3} s") };
        let number = late.len();
        warnings
            .note(format!("events that begin after {LONGEST_S:.0} s: left out, {number} of them ({times})"));
    }
    felt.sort_by(|a, b| a.time.total_cmp(&b.time));
    if let Some(first) = felt.get(MAX_PARTS) {
        let (more, from) = (felt.len() - MAX_PARTS, first.time);
        warnings.note(format!(
            "events from {from:.3} s on: left out, {more} of them (there is room for {MAX_PARTS})"
        ));
        felt.truncate(MAX_PARTS);
    }
    felt
}

/// Drops parts of split events beyond the maximum parts of a sequence.
fn limit_split(parts: &mut Vec<Part>, warnings: &mut ImportNotes) {
    let in_time = parts.iter().filter(|part| part.at_s <= LONGEST_S).count();
    let room = in_time.min(MAX_PARTS);
    if let Some(first) = parts.get(room) {
        let from = first.at_s;
        warnings.note(format!(
            "tones of split events from {from:.3} s on: left out (there is room for {MAX_PARTS})"
        ));
        parts.truncate(room);
    }
}

const TRANSIENT: &str = "HapticTransient";
const CONTINUOUS: &str = "HapticContinuous";

/// The parameters of one event that have a counterpart.
pub(super) struct Parameters {
    pub(super) intensity: f32,
    pub(super) sharpness: f32,
    pub(super) attack_s: f32,
    pub(super) decay_s: f32,
    pub(super) release_s: f32,
    pub(super) sustained: bool,
}

impl Parameters {
    fn of(event: &PatternEvent, warnings: &mut ImportNotes) -> Self {
        // Apple's defaults for parameters that are not written.
        let mut parameters = Self {
            intensity: 1.0,
            sharpness: 0.5,
            attack_s: 0.0,
            decay_s: 0.0,
            release_s: 0.0,
            sustained: true,
        };
        let kind = event.event_type.as_str();
        for parameter in &event.event_parameters {
            let value = parameter.value.value() as f32;
            let share = if value >= 0.0 { value.min(1.0) } else { 0.0 };
            let target = match parameter.id.as_str() {
                "HapticIntensity" => &mut parameters.intensity,
                "HapticSharpness" => &mut parameters.sharpness,
                "AttackTime" if kind == CONTINUOUS => &mut parameters.attack_s,
                "DecayTime" if kind == CONTINUOUS => &mut parameters.decay_s,
                "ReleaseTime" if kind == CONTINUOUS => &mut parameters.release_s,
                "Sustained" if kind == CONTINUOUS => {
                    parameters.sustained = value != 0.0;
                    continue;
                }
                other => {
                    warnings.lost(format!("{} of a {kind}", shown(other)));
                    continue;
                }
            };
            *target = share;
            if share != value {
                warnings.note(format!("{} of a {kind}: out of range, brought into 0 to 1", parameter.id));
            }
        }
        event.other.keys().for_each(|key| warnings.lost(format!("{} of a {kind}", shown(key))));
        parameters
    }
}

/// Makes the click or the tones of one event.
fn parts(
    event: &PatternEvent,
    controls: &Controls,
    course: &mut Course<'_>,
    warnings: &mut ImportNotes,
) -> Vec<Part> {
    let at_s = event.time as f32;
    let parameters = Parameters::of(event, warnings);
    if event.event_type == TRANSIENT {
        return vec![Part { at_s, kind: PartKind::Click(click(&parameters, at_s, controls)) }];
    }
    let duration_s = event.event_duration.unwrap_or_default() as f32;
    if event.event_duration.is_none() {
        warnings.note(format!("a {CONTINUOUS} without EventDuration: lasts 1 ms"));
    }
    if duration_s > LONGEST_S {
        let rest = duration_s - LONGEST_S;
        warnings
            .note(format!("a {CONTINUOUS} longer than {LONGEST_S:.0} s: its last {rest:.3} s are left out"));
    }
    let length_s = duration_s.clamp(SHORTEST_S, LONGEST_S);
    long_tone::tones(at_s, length_s, &parameters, course, warnings)
}

fn click(parameters: &Parameters, at_s: f32, controls: &Controls) -> Click {
    let sharpness = (parameters.sharpness + controls.sharpness.at(at_s)).clamp(0.0, 1.0);
    let mode = Mode {
        frequency_hz: at_sharpness(TRANSIENT_HZ, sharpness),
        decay_s: at_sharpness(TRANSIENT_DECAY_S, sharpness),
        amplitude: 1.0,
    };
    Click {
        modes: [mode].into_iter().collect(),
        level: Newtons(TRANSIENT_N * parameters.intensity * controls.intensity.at(at_s)),
        impulse: Impulse::default(),
    }
}

/// Returns the pitch of a tone in hertz; the sharpness is clamped to 0 to 1.
pub(super) fn pitch_hz(sharpness: f32) -> f32 {
    at_sharpness(CONTINUOUS_HZ, sharpness.clamp(0.0, 1.0))
}
