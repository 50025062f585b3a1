//! Effects to AHAP.

use std::collections::BTreeSet;

use serde_json::json;

use super::file::{
    ControlPoint, DynamicParameter, EventParameter, File, JsonNumber, ParameterCurve, PatternEntry,
    PatternEvent,
};
use super::{
    AhapError, CONTINUOUS_HZ, CONTINUOUS_N, TRANSIENT_DECAY_S, TRANSIENT_HZ, TRANSIENT_N, at_sharpness,
    sharpness_of,
};
use crate::feel::{Click, Clicks, Effect, EffectKind, Impulse, Manner, Mode, Part, PartKind, Tone};

/// Writes the AHAP file of an effect that plays once, and lists the parts without a counterpart in AHAP.
///
/// `name` becomes the file's description.
///
/// # Errors
/// [`AhapError::Driven`] for an effect driven by a foot or a value.
pub fn write_ahap(effect: &Effect, name: &str) -> Result<(String, Vec<String>), AhapError> {
    let mut lost = Lost::default();
    let timeline = effect.kind.timeline().ok_or(AhapError::Driven(effect.kind.name()))?;
    let parts: Vec<Part> = timeline.parts().collect();
    if let EffectKind::Click(Clicks { release, .. }) = &effect.kind {
        lost.note(release.is_some(), "what is felt for a release");
    }
    let Manner { band, duck_db, priority } = effect.manner;
    lost.note(band != Manner::PLAIN.band, "the band");
    lost.note(duck_db != Manner::PLAIN.duck_db, "ducking");
    lost.note(priority != Manner::PLAIN.priority, "the priority");
    let mut pattern = Vec::new();
    for (number, part) in parts.iter().enumerate() {
        match &part.kind {
            PartKind::Click(click) => pattern.push(transient(part.at_s, click, &mut lost)),
            PartKind::Tone(tone) => {
                let end = part.at_s + tone.whole_s();
                let overlaps = |other: &Part| other.at_s < end && ends(other) > part.at_s;
                let others = parts.iter().enumerate().filter(|(other, _)| *other != number);
                let overlaps_other = others.clone().any(|(_, other)| overlaps(other));
                lost.note(
                    overlaps_other && !tone.curve.is_empty(),
                    "that a curve concerns one of several at a time",
                );
                let follows = others.clone().any(|(_, other)| other.at_s >= end);
                continuous(part.at_s, tone, follows, &mut pattern, &mut lost);
            }
        }
    }
    let file = File {
        version: json!(1.0),
        metadata: Some(json!({ "Description": name, "Created": "underfoot" })),
        pattern,
    };
    let text = serde_json::to_string_pretty(&file).unwrap_or_default();
    Ok((
        text + "\n",
        lost.0.into_iter().map(|what| format!("{what}: no counterpart in AHAP, left out")).collect(),
    ))
}

fn ends(part: &Part) -> f32 {
    match &part.kind {
        PartKind::Click(_) => part.at_s,
        PartKind::Tone(tone) => part.at_s + tone.whole_s(),
    }
}

#[derive(Debug, Default)]
struct Lost(BTreeSet<&'static str>);

impl Lost {
    fn note(&mut self, is: bool, what: &'static str) {
        if is {
            self.0.insert(what);
        }
    }
}

/// Clamps `share` to 0 to 1, and notes it as lost if it is outside.
fn within(share: f32, lost: &mut Lost, what: &'static str) -> f32 {
    lost.note(!(-0.001..=1.001).contains(&share), what);
    if share >= 0.0 { share.min(1.0) } else { 0.0 }
}

fn parameter(id: &str, value: f32) -> EventParameter {
    EventParameter { id: id.to_owned(), value: JsonNumber::Number(rounded(value)) }
}

/// Rounds to six decimals, finer than perception and than a float of this size.
fn rounded(value: f32) -> f64 {
    (f64::from(value) * 1e6).round() / 1e6
}

fn transient(at_s: f32, click: &Click, lost: &mut Lost) -> PatternEntry {
    let strongest = click.modes.iter().max_by(|a, b| a.amplitude.abs().total_cmp(&b.amplitude.abs()));
    let mode = strongest.copied().unwrap_or(Mode { frequency_hz: 0.0, decay_s: 0.01, amplitude: 0.0 });
    lost.note(click.modes.len() > 1, "all but the strongest mode of a click");
    lost.note(click.impulse != Impulse::default(), "the impulse of a click");
    let sharpness =
        within(sharpness_of(TRANSIENT_HZ, mode.frequency_hz), lost, "a click's pitch beyond 90 to 324 Hz");
    let usual = at_sharpness(TRANSIENT_DECAY_S, sharpness);
    lost.note((mode.decay_s / usual - 1.0).abs() > 0.01, "how long a click rings");
    let level = click.level.0 * mode.amplitude.abs() / TRANSIENT_N;
    let intensity = within(level, lost, "what a click is stronger than 20 N");
    PatternEntry {
        event: Some(PatternEvent {
            time: rounded(at_s),
            event_type: "HapticTransient".to_owned(),
            event_duration: None,
            event_parameters: vec![
                parameter("HapticIntensity", intensity),
                parameter("HapticSharpness", sharpness),
            ],
            other: serde_json::Map::new(),
        }),
        ..PatternEntry::default()
    }
}

fn continuous(at_s: f32, tone: &Tone, follows: bool, pattern: &mut Vec<PatternEntry>, lost: &mut Lost) {
    const BEYOND: &str = "a tone's pitch beyond 70 to 280 Hz";
    lost.note(tone.noise > 0.0, "noise");
    lost.note(tone.sustain > 0.0 && tone.sustain < 1.0 && tone.decay_s > 0.0, "a decay to part of the level");
    let intensity = within(tone.level.0 / CONTINUOUS_N, lost, "what a tone is stronger than 12 N");
    let sharpness = within(sharpness_of(CONTINUOUS_HZ, tone.hz), lost, BEYOND);
    let time = |seconds: f32, lost: &mut Lost| {
        within(seconds, lost, "attacks, decays and releases of more than 1 s")
    };
    let mut parameters =
        vec![parameter("HapticIntensity", intensity), parameter("HapticSharpness", sharpness)];
    let sustained = tone.sustain >= 0.5 || tone.decay_s == 0.0;
    for (id, seconds) in [("AttackTime", tone.attack_s), ("ReleaseTime", tone.release_s)] {
        if seconds > 0.0 {
            parameters.push(parameter(id, time(seconds, lost)));
        }
    }
    // A decay over the whole length is the default of a tone that is not sustained.
    if tone.decay_s > 0.0 && (sustained || (tone.decay_s - tone.length_s).abs() > 1e-6) {
        parameters.push(parameter("DecayTime", time(tone.decay_s, lost)));
    }
    parameters.push(parameter("Sustained", f32::from(u8::from(sustained))));
    pattern.push(PatternEntry {
        event: Some(PatternEvent {
            time: rounded(at_s),
            event_type: "HapticContinuous".to_owned(),
            event_duration: Some(rounded(tone.length_s)),
            event_parameters: parameters,
            other: serde_json::Map::new(),
        }),
        ..PatternEntry::default()
    });
    if tone.curve.is_empty() {
        return;
    }
    let louder = "what a curve strengthens";
    let levels =
        tone.curve.iter().map(|point| (point.at_s, within(point.level, lost, louder))).collect::<Vec<_>>();
    let pitches: Vec<(f32, f32)> = tone
        .curve
        .iter()
        .map(|point| {
            (point.at_s, within(sharpness_of(CONTINUOUS_HZ, tone.hz_at(point)), lost, BEYOND) - sharpness)
        })
        .collect();
    for (id, points, neutral) in
        [("HapticIntensityControl", levels, 1.0), ("HapticSharpnessControl", pitches, 0.0)]
    {
        let points = points
            .iter()
            .map(|&(time, value)| ControlPoint { time: rounded(time), parameter_value: rounded(value) });
        let curve = ParameterCurve { id: id.to_owned(), time: rounded(at_s), points: points.collect() };
        pattern.push(PatternEntry { parameter_curve: Some(curve), ..PatternEntry::default() });
        // Controls affect all later events, so the level of the following parts is restored.
        if follows {
            let time = rounded(at_s + tone.whole_s());
            let back = DynamicParameter { id: id.to_owned(), value: neutral, time };
            pattern.push(PatternEntry { parameter: Some(back), ..PatternEntry::default() });
        }
    }
}
