//! The parts of a sequence in files: any effect that is played once, with changed level and pitch, at its time.

use std::sync::Arc;

use super::reading::{Effects, Played};
use super::{Clicks, Effect, EffectKind, MAX_PARTS, Manner, Part, PartKind, Tone, TonePoint, Use};
use crate::feel::MODE_HZ;
use underfoot_format::describe::FieldType;
use underfoot_format::hand::Hand;
use underfoot_format::node::{Node, Within};
use underfoot_format::problem::Problem;
use underfoot_format::text::RonText;
use underfoot_format::{Codec, List, Rec, list, num, record};

record! {
    /// One part of a sequence.
    struct PartRecord = "Part" with Effects;
    /// Start time, from the sequence's start.
    at_s: f32 = "at_ms", super::tone::TIME;
    /// Factor of its level.
    level: f32 = "level", super::tone::STRENGTH => 1.0;
    /// Factor of its frequencies.
    pitch: f32 = "pitch", num(0.1..=10.0) => 1.0;
    /// The effect: one that is played once, by its name or written out.
    plays: Arc<Effect> = "plays", Played(Use::Once);
}

const PARTS: List<Rec> = list("part", MAX_PARTS, Rec).at_least(1, "a sequence needs a part");

/// The parts of a sequence.
pub(super) struct Parts;

impl Codec<Arc<[Part]>> for Parts {
    type Context = Effects;

    fn read(&self, node: Node<'_>, _: Option<&Arc<[Part]>>, effects: &Effects) -> Option<Arc<[Part]>> {
        let written: Vec<PartRecord> = PARTS.read(node, None, effects)?;
        let parts = written.into_iter().flat_map(|part| part.into_parts(node.within));
        let mut parts: Vec<Part> = parts.collect();
        if parts.len() > MAX_PARTS {
            let problem = Problem::error(node.span(), "this sequence has too many parts");
            let expected = format!("expected at most {MAX_PARTS} clicks and tones, found {}", parts.len());
            node.report(problem.expected(expected));
            return None;
        }
        parts.sort_by(|a, b| a.at_s.total_cmp(&b.at_s));
        Some(parts.into())
    }

    fn write(&self, parts: &Arc<[Part]>) -> RonText {
        let written = parts.iter().map(|part| {
            let kind = match part.kind.clone() {
                PartKind::Click(press) => EffectKind::Click(Clicks { press, release: None }),
                PartKind::Tone(tone) => EffectKind::Continuous(tone),
            };
            let plays = Arc::new(Effect { kind, manner: Manner::PLAIN });
            PartRecord { at_s: part.at_s, level: 1.0, pitch: 1.0, plays }
        });
        PARTS.write(&written.collect::<Vec<_>>())
    }

    fn shape(&self) -> FieldType {
        Codec::<Vec<PartRecord>>::shape(&PARTS)
    }

    fn stand_in(&self) -> Arc<[Part]> {
        Arc::from([])
    }

    fn turn(&self, parts: &mut Arc<[Part]>, _: &'static str, hand: &mut Hand<'_>) {
        for (index, part) in Arc::make_mut(parts).iter_mut().enumerate() {
            hand.part(&format!("part {}", index + 1), |hand| {
                super::tone::TIME.hand(0.0..=3000.0).turn(&mut part.at_s, "at_ms", hand);
                match &mut part.kind {
                    PartKind::Click(click) => Rec.turn(click, "", hand),
                    PartKind::Tone(tone) => Rec.turn(tone, "", hand),
                }
            });
        }
    }
}

impl PartRecord {
    /// The parts that it stands for: several if it plays a sequence.
    fn into_parts(self, within: Option<Within>) -> Vec<Part> {
        let Self { at_s, level, pitch, plays } = self;
        let turned = |hz: f32| {
            let hz = (hz * pitch).clamp(*MODE_HZ.start(), *MODE_HZ.end());
            within.map_or(hz, |within| hz.max(within.low as f32).min(within.high as f32))
        };
        let changed = |kind: PartKind| match kind {
            PartKind::Click(click) => PartKind::Click(click.scaled(level, pitch)),
            PartKind::Tone(tone) => {
                let point = |point: TonePoint| TonePoint { hz: point.hz.map(turned), ..point };
                let curve = tone.curve.iter().copied().map(point).collect();
                PartKind::Tone(Tone { level: tone.level * level, hz: turned(tone.hz), curve, ..tone })
            }
        };
        let part = |at_s, kind| Part { at_s, kind: changed(kind) };
        let parts = plays.kind.timeline().into_iter().flat_map(|timeline| timeline.parts());
        parts.map(|inner| part(at_s + inner.at_s, inner.kind)).collect()
    }
}
