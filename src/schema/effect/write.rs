use std::fmt::Write;

use super::NamedEffect;
use crate::feel::{
    Beat, Click, Detents, Effect, EffectKind, EndStop, Impulse, Manner, Material, Resonance, Sequence, Tone,
};

/// The file that describes `effect`; [`super::parse_effect`] reads the same effect from it.
#[must_use]
pub fn write_named_effect(effect: &NamedEffect) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = writeln!(text, "Effect(\n    name: {:?},", effect.name);
    if !effect.about.is_empty() {
        let _ = writeln!(text, "    about: {:?},", effect.about);
    }
    let _ = writeln!(text, "    plays: {},\n)", write_effect(&effect.effect, 1));
    text
}

/// The effect as it is written where it is played, its lines indented by so many steps.
#[must_use]
pub fn write_effect(effect: &Effect, indent: usize) -> String {
    let mut fields = Fields { indent, lines: Vec::new() };
    match &effect.kind {
        EffectKind::Click { press, release } => {
            fields.click(press);
            if let Some(release) = release {
                let mut inner = Fields { indent: indent + 1, lines: Vec::new() };
                inner.click(release);
                fields.push("release", inner.closed(""));
            }
        }
        EffectKind::Continuous(tone) => fields.tone(tone),
        EffectKind::Sequence(sequence) => fields.sequence(sequence),
        EffectKind::Friction(friction) => {
            fields.number("level_n", friction.level.0);
            fields.number("low_hz", friction.low_hz);
            fields.number("high_hz", friction.high_hz);
            fields.number("full_speed_m_s", friction.full_speed_m_s);
            fields.number("full_force_n", friction.full_force.0);
        }
        EffectKind::StickSlip(stick) => {
            fields.material(&stick.material);
            fields.number("grip", stick.grip);
            fields.number("glide", stick.glide);
            fields.number("let_go_m_s", stick.let_go_m_s);
            fields.number("stretch_m", stick.stretch_m);
            fields.number("sole_hz", stick.sole_hz);
            fields.number("rough", stick.rough);
        }
        EffectKind::Texture(texture) => {
            fields.material(&texture.material);
            fields.number("spacing_m", texture.spacing_m);
            fields.millis("width_ms", texture.width_s);
            fields.number("uneven", texture.uneven);
        }
        EffectKind::Grains(grains) => {
            fields.material(&grains.material);
            fields.number("spacing_m", grains.spacing_m);
            fields.millis("width_ms", grains.width_s);
            fields.number("spread", grains.spread);
        }
        EffectKind::Detents(detents) => fields.detents(detents),
        EffectKind::EndStop(end) => fields.end(end),
    }
    fields.manner(&effect.manner);
    fields.closed(effect.kind.name())
}

/// The fields of one `Name(...)` as lines.
struct Fields {
    indent: usize,
    lines: Vec<String>,
}

impl Fields {
    fn push(&mut self, name: &str, value: impl std::fmt::Display) {
        self.lines.push(format!("{name}: {value}"));
    }

    fn number(&mut self, name: &str, value: f32) {
        self.push(name, number(value));
    }

    fn millis(&mut self, name: &str, seconds: f32) {
        self.push(name, millis(seconds));
    }

    fn closed(&self, name: &str) -> String {
        let pad = "    ".repeat(self.indent);
        let lines: String = self.lines.iter().map(|line| format!("{pad}    {line},\n")).collect();
        format!("{name}(\n{lines}{pad})")
    }

    /// A list with an entry on each line.
    fn list(&mut self, name: &str, entries: &[String]) {
        let pad = "    ".repeat(self.indent + 1);
        let lines: String = entries.iter().map(|entry| format!("{pad}    {entry},\n")).collect();
        self.push(name, format!("[\n{lines}{pad}]"));
    }

    fn manner(&mut self, manner: &Manner) {
        if manner.band != Manner::PLAIN.band {
            self.push(
                "band_hz",
                format!("({}, {})", number(manner.band.low_hz), number(manner.band.high_hz)),
            );
        }
        if manner.duck_db != Manner::PLAIN.duck_db {
            self.number("duck_db", manner.duck_db);
        }
        if manner.priority != Manner::PLAIN.priority {
            self.push("priority", manner.priority);
        }
    }

    fn click(&mut self, click: &Click) {
        self.number("level_n", click.level.0);
        if click.impulse != Impulse::default() {
            let Impulse { width_s, round } = click.impulse;
            self.push("impulse", format!("(width_ms: {}, round: {})", millis(width_s), number(round)));
        }
        let mode = |mode: &crate::feel::Mode| {
            let (hz, decay) = (number(mode.frequency_hz), millis(mode.decay_s));
            format!("(hz: {hz}, decay_ms: {decay}, amplitude: {})", number(mode.amplitude))
        };
        self.list("modes", &click.modes.iter().map(mode).collect::<Vec<_>>());
    }

    fn tone(&mut self, tone: &Tone) {
        self.number("level_n", tone.level.0);
        self.number("hz", tone.hz);
        self.number("noise", tone.noise);
        self.millis("length_ms", tone.length_s);
        self.millis("attack_ms", tone.attack_s);
        self.millis("decay_ms", tone.decay_s);
        self.number("sustain", tone.sustain);
        self.millis("release_ms", tone.release_s);
        if !tone.curve.is_empty() {
            let points = tone.curve.iter().map(|point| {
                let (at, level, hz) = (millis(point.at_s), number(point.level), number(point.hz));
                format!("(at_ms: {at}, level: {level}, hz: {hz})")
            });
            self.list("curve", &points.collect::<Vec<_>>());
        }
    }

    fn sequence(&mut self, sequence: &Sequence) {
        let parts = sequence.parts.iter().map(|part| {
            let mut inner = Fields { indent: self.indent + 2, lines: Vec::new() };
            let name = match &part.beat {
                Beat::Click(click) => {
                    inner.click(click);
                    "Click"
                }
                Beat::Tone(tone) => {
                    inner.tone(tone);
                    "Continuous"
                }
            };
            format!("(at_ms: {}, plays: {})", millis(part.at_s), inner.closed(name))
        });
        let parts: Vec<String> = parts.collect();
        self.list("parts", &parts);
        if !sequence.curve.is_empty() {
            let point = |point: &crate::feel::CurvePoint| {
                format!("(at_ms: {}, level: {})", millis(point.at_s), number(point.level))
            };
            self.list("curve", &sequence.curve.iter().map(point).collect::<Vec<_>>());
        }
    }

    fn material(&mut self, material: &Material) {
        self.number("level_n", material.level.0);
        let struck = |resonance: &&Resonance| resonance.amplitude > 0.0;
        let mut heard: Vec<&Resonance> = material.resonances.iter().filter(struck).collect();
        if heard.is_empty() {
            heard.push(&material.resonances[0]);
        }
        let resonance = |resonance: &Resonance| {
            let (hz, decay) = (number(resonance.hz), millis(resonance.decay_s));
            format!("(hz: {hz}, decay_ms: {decay}, amplitude: {})", number(resonance.amplitude))
        };
        self.list("resonances", &heard.into_iter().map(resonance).collect::<Vec<_>>());
        self.number("bare", material.bare);
        self.number("full_speed_m_s", material.full_speed_m_s);
        self.number("full_force_n", material.full_force.0);
    }

    fn detents(&mut self, detents: &Detents) {
        self.click(&detents.click);
        self.number("every", detents.every);
        self.number("falling", detents.falling);
        self.push("pitch", pair(detents.pitch));
        if !detents.marks.is_empty() {
            let marks: Vec<String> = detents.marks.iter().map(|mark| number(*mark)).collect();
            self.push("marks", format!("[{}]", marks.join(", ")));
        }
        self.number("mark", detents.mark);
    }

    fn end(&mut self, end: &EndStop) {
        self.click(&end.click);
        self.push("pitch", pair(end.pitch));
        if let Some(push) = &end.push {
            let (level, hz) = (number(push.hum.level.0), number(push.hum.hz));
            let (noise, full) = (number(push.hum.noise), number(push.full_m));
            self.push("push", format!("(level_n: {level}, hz: {hz}, noise: {noise}, full_m: {full})"));
        }
    }
}

fn pair([low, high]: [f32; 2]) -> String {
    format!("({}, {})", number(low), number(high))
}

/// The shortest text that reads back as the same number, without a point where none is needed.
fn number(value: f32) -> String {
    let text = format!("{value}");
    if value.is_finite() { text } else { "0".to_owned() }
}

/// Seconds in milliseconds, such that they read back as the same seconds.
fn millis(seconds: f32) -> String {
    // Most are whole hundredths of a millisecond; those that are not need all digits, found by trying.
    (2..=9)
        .map(|digits| format!("{:.digits$}", f64::from(seconds) * 1000.0))
        .map(|text| text.trim_end_matches('0').trim_end_matches('.').to_owned())
        .find(|text| text.parse::<f32>().is_ok_and(|ms| ms / 1000.0 == seconds))
        .unwrap_or_else(|| number(seconds * 1000.0))
}
