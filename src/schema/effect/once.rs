//! Clicks, tones and sequences.

use arrayvec::ArrayVec;

use super::super::behaviour::single;
use super::super::fields::Fields;
use super::super::node::Node;
use super::super::problem::Problem;
use super::{Form, HERTZ, LEVEL_N, curves, millis, named, share, within, written};
use crate::feel::{Band, Beat, Click, EffectKind, Impulse, MAX_MODES, MAX_PARTS, Mode, Part, Sequence, Tone};
use crate::units::Newtons;

/// Longest that one effect may last, in milliseconds.
const LONGEST_MS: f64 = 60_000.0;

/// A click, and what is felt where it answers a release.
pub(super) fn click_effect(
    fields: &mut Fields<'_>,
    base: Option<&EffectKind>,
    band: Band,
) -> Option<EffectKind> {
    let (base, base_release) = match base {
        Some(EffectKind::Click { press, release }) => (Some(press), release.clone()),
        _ => (None, None),
    };
    let press = click(fields, base, band);
    let own = base_release.clone();
    let release = fields.read("release", Some(base_release), |node| {
        if node.is_none() {
            return Some(None);
        }
        let mut fields = node.fields("Click")?;
        let release = click(&mut fields, own.as_ref(), band);
        fields.finish();
        release.map(Some)
    });
    Some(EffectKind::Click { press: press?, release: release? })
}

/// The fields that every effect has that clicks.
pub(super) fn click(fields: &mut Fields<'_>, base: Option<&Click>, band: Band) -> Option<Click> {
    let level = fields.read("level_n", base.map(|base| base.level.0), |node| single(node, LEVEL_N));
    let modes = fields.read("modes", base.map(|base| base.modes.clone()), |node| modes(node, band));
    let base_impulse = base.map_or(Impulse::default(), |base| base.impulse);
    let impulse = fields.read("impulse", Some(base_impulse), |node| {
        let mut fields = node.fields("Impulse")?;
        let widest = f64::from(Impulse::WIDEST_S * 1000.0);
        let width_s = millis(&mut fields, "width_ms", Some(base_impulse.width_s), 0.0..=widest);
        let round = share(&mut fields, "round", Some(base_impulse.round));
        fields.finish();
        Some(Impulse { width_s: width_s?, round: round? })
    });
    Some(Click { level: Newtons(level?), modes: modes?, impulse: impulse? })
}

fn modes(node: Node<'_>, band: Band) -> Option<ArrayVec<Mode, MAX_MODES>> {
    let nodes = node.list("mode", MAX_MODES)?;
    if nodes.is_empty() {
        let problem = Problem::error(node.span(), "a click needs a mode").expected("expected 1 to 8 modes");
        node.report(problem.help("for no click at all write None instead of Click(...)"));
        return None;
    }
    // All are read before the first that failed ends it, so that each is reported.
    let modes: Vec<Option<Mode>> = nodes.into_iter().map(|node| mode(node, band)).collect();
    modes.into_iter().collect()
}

fn mode(node: Node<'_>, band: Band) -> Option<Mode> {
    let mut fields = node.fields("Mode")?;
    let frequency = fields.read("hz", None, |node| within(node, band));
    let decay = millis(&mut fields, "decay_ms", None, 1.0..=2000.0);
    let amplitude = fields.read("amplitude", Some(1.0), |node| single(node, -1.0..=1.0));
    fields.finish();
    Some(Mode { frequency_hz: frequency?, decay_s: decay?, amplitude: amplitude? })
}

/// A tone or a noise.
pub(super) fn tone(fields: &mut Fields<'_>, base: Option<&Tone>, band: Band) -> Option<Tone> {
    let level = fields.read("level_n", base.map(|base| base.level.0), |node| single(node, LEVEL_N));
    let hz = fields.read("hz", base.map(|base| base.hz), |node| within(node, band));
    let noise = share(fields, "noise", Some(base.map_or(0.0, |base| base.noise)));
    let length = millis(fields, "length_ms", base.map(|base| base.length_s), 1.0..=LONGEST_MS);
    let attack =
        millis(fields, "attack_ms", Some(base.map_or(0.005, |base| base.attack_s)), 0.0..=LONGEST_MS);
    let decay = millis(fields, "decay_ms", Some(base.map_or(0.0, |base| base.decay_s)), 0.0..=LONGEST_MS);
    let sustain = share(fields, "sustain", Some(base.map_or(1.0, |base| base.sustain)));
    let release =
        millis(fields, "release_ms", Some(base.map_or(0.02, |base| base.release_s)), 0.0..=LONGEST_MS);
    let base_curve = base.map(|base| base.curve.clone()).unwrap_or_default();
    let curve = fields.read("curve", Some(base_curve), |node| curves::tone(node, hz, band));
    Some(Tone {
        level: Newtons(level?),
        hz: hz?,
        noise: noise?,
        length_s: length?,
        attack_s: attack?,
        decay_s: decay?,
        sustain: sustain?,
        release_s: release?,
        curve: curve?,
    })
}

/// Clicks and tones one after the other.
pub(super) fn sequence(fields: &mut Fields<'_>, base: Option<&Sequence>, band: Band) -> Option<Sequence> {
    let base_parts = base.map(|base| base.parts.clone());
    let parts = fields.read("parts", base_parts, |node| {
        let nodes = node.list("part", MAX_PARTS)?;
        if nodes.is_empty() {
            let problem = Problem::error(node.span(), "a sequence needs a part");
            node.report(problem.expected(format!("expected 1 to {MAX_PARTS} parts")));
            return None;
        }
        let read: Vec<Option<Vec<Part>>> = nodes.into_iter().map(|node| part(node, band)).collect();
        let mut parts: Vec<Part> =
            read.into_iter().collect::<Option<Vec<_>>>()?.into_iter().flatten().collect();
        if parts.len() > MAX_PARTS {
            let problem = Problem::error(node.span(), "this sequence has too many parts");
            let expected = format!("expected at most {MAX_PARTS} clicks and tones, found {}", parts.len());
            node.report(problem.expected(expected));
            return None;
        }
        parts.sort_by(|a, b| a.at_s.total_cmp(&b.at_s));
        Some(parts.into())
    });
    let base_curve = base.map(|base| base.curve.clone()).unwrap_or_default();
    let curve = fields.read("curve", Some(base_curve), curves::level);
    Some(Sequence { parts: parts?, curve: curve? })
}

/// One part of a sequence; several if it is a sequence itself.
fn part(node: Node<'_>, band: Band) -> Option<Vec<Part>> {
    let mut fields = node.fields("Part")?;
    let at = millis(&mut fields, "at_ms", None, 0.0..=LONGEST_MS);
    let level = fields.read("level", Some(1.0), |node| single(node, 0.0..=4.0));
    let pitch = fields.read("pitch", Some(1.0), |node| single(node, 0.1..=10.0));
    let effect = fields.read("plays", None, |node| match node.peek_text() {
        Some(_) => named(node).map(|effect| (*effect).clone()),
        None => written(node, None, ("Click", Form::Click)),
    });
    let plays_at = fields.span("plays");
    if let Some(effect) = &effect
        && !crate::feel::Use::Once.fits(&effect.kind)
    {
        let message = format!("a {} can't be part of a sequence", effect.kind.name());
        let problem = Problem::error(plays_at, message);
        fields.report(problem.expected(format!("expected {}", crate::feel::Use::Once.fitting())));
        fields.finish();
        return None;
    }
    fields.finish();
    let (at, level, pitch) = (at?, level?, pitch?);
    let turned = |hz: f32| band.clamp((hz * pitch).clamp(*HERTZ.start() as f32, *HERTZ.end() as f32));
    let changed = |beat: Beat| match beat {
        Beat::Click(click) => Beat::Click(click.scaled(level, pitch)),
        Beat::Tone(tone) => Beat::Tone(Tone {
            level: tone.level * level,
            hz: turned(tone.hz),
            curve: tone
                .curve
                .into_iter()
                .map(|point| crate::feel::TonePoint { hz: turned(point.hz), ..point })
                .collect(),
            ..tone
        }),
    };
    Some(match effect?.kind {
        EffectKind::Click { press, .. } => vec![Part { at_s: at, beat: changed(Beat::Click(press)) }],
        EffectKind::Continuous(tone) => vec![Part { at_s: at, beat: changed(Beat::Tone(tone)) }],
        EffectKind::Sequence(inner) => (0..inner.parts.len())
            .filter_map(|index| inner.part(index))
            .map(|part| Part { at_s: at + part.at_s, beat: changed(part.beat) })
            .collect(),
        _ => Vec::new(),
    })
}
