//! Clicks and tones one after the other.

use std::borrow::Cow;
use std::sync::Arc;

use arrayvec::ArrayVec;

use super::parts::Parts;
use super::reading::Effects;
use super::tone::{STRENGTH, TIME, check_order};
use super::{EffectTimeline, MAX_POINTS, Tone, TonePoint};
use crate::feel::Click;
use underfoot_format::{Rec, list, record};

/// Maximum number of parts of a sequence: each held part has a key of its own, of which a foot has 256 (see
/// [`crate::feel::key`]) and other effects have the first 16. The longest of Apple's own patterns have some 150 taps.
pub const MAX_PARTS: usize = 240;

record! {
    /// Clicks and tones one after the other, or at once.
    pub struct Sequence = "Sequence" with Effects => |it, faults| {
        check_order(it.curve.iter().map(|point| point.at_s), faults);
    };
    /// The parts, in order of time.
    pub parts: Arc<[Part]> = "parts", Parts;
    /// Factor of each part's level over time, in order of time; empty for a factor of 1.
    pub curve: ArrayVec<CurvePoint, MAX_POINTS> = "curve", list("point", MAX_POINTS, Rec).still() => ArrayVec::new();
}

/// One part of a sequence.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Start time, in seconds from the sequence's start.
    pub at_s: f32,
    /// The click or tone.
    pub kind: PartKind,
}

/// The content of one part of a sequence.
#[derive(Clone, Debug, PartialEq)]
pub enum PartKind {
    /// A click.
    Click(Click),
    /// A tone or noise.
    Tone(Tone),
}

record! {
    /// A factor of the level at one moment.
    pub struct CurvePoint = "Point", Copy, Default;
    /// Time since the start, in seconds.
    pub at_s: f32 = "at_ms", TIME;
    /// Share of the level.
    pub level: f32 = "level", STRENGTH;
}

impl EffectTimeline for Sequence {
    fn written(&self, index: usize) -> Option<Cow<'_, Part>> {
        self.parts.get(index).map(Cow::Borrowed)
    }

    /// Part number `index` with the curve applied.
    fn part(&self, index: usize) -> Option<Part> {
        let part = self.parts.get(index)?;
        let kind = match &part.kind {
            PartKind::Click(click) => PartKind::Click(click.scaled(self.share_at(part.at_s), 1.0)),
            PartKind::Tone(tone) => PartKind::Tone(self.curved(tone, part.at_s)),
        };
        Some(Part { at_s: part.at_s, kind })
    }

    /// Value of the curve `t` seconds from the start.
    fn share_at(&self, t: f32) -> f32 {
        let after = self.curve.iter().position(|point| point.at_s > t).unwrap_or(self.curve.len());
        let before = after.checked_sub(1).and_then(|before| self.curve.get(before));
        match (before, self.curve.get(after)) {
            (None, None) => 1.0,
            (Some(point), None) | (None, Some(point)) => point.level,
            (Some(a), Some(b)) => a.level + (b.level - a.level) * (t - a.at_s) / (b.at_s - a.at_s).max(1e-6),
        }
    }
}

impl Sequence {
    /// `tone`, begun at `start`, with its own curve times this one; keeps the first sixteen points of both curves.
    fn curved(&self, tone: &Tone, start: f32) -> Tone {
        if self.curve.is_empty() {
            return tone.clone();
        }
        let mut times: ArrayVec<f32, { 2 * MAX_POINTS + 1 }> = ArrayVec::new();
        times.push(0.0);
        times.extend(tone.curve.iter().map(|point| point.at_s));
        let inside = self.curve.iter().map(|point| point.at_s - start);
        times.extend(inside.filter(|t| *t > 0.0 && *t < tone.whole_s()));
        times.sort_unstable_by(f32::total_cmp);
        let plain = Tone { attack_s: 0.0, decay_s: 0.0, ..tone.clone() };
        let mut curve = ArrayVec::new();
        let mut last = f32::NEG_INFINITY;
        for at_s in times {
            if at_s - last > 1e-5 && !curve.is_full() {
                let (level, hz) = plain.held_at(at_s);
                curve.push(TonePoint { at_s, level: level * self.share_at(start + at_s), hz: Some(hz) });
                last = at_s;
            }
        }
        Tone { curve, ..tone.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::feel::{Impulse, Mode};
    use crate::units::Newtons;

    #[test]
    fn the_curve_scales_clicks_where_they_begin_and_tones_all_along() {
        let modes = [Mode { frequency_hz: 200.0, decay_s: 0.01, amplitude: 1.0 }].into_iter().collect();
        let click = Click { modes, level: Newtons(8.0), impulse: Impulse::default() };
        let tone = Tone { level: Newtons(2.0), hz: 90.0, length_s: 1.0, ..Tone::default() };
        let sequence = Sequence {
            parts: [
                Part { at_s: 0.5, kind: PartKind::Click(click) },
                Part { at_s: 0.5, kind: PartKind::Tone(tone) },
            ]
            .into(),
            curve: [CurvePoint { at_s: 0.0, level: 0.0 }, CurvePoint { at_s: 1.0, level: 1.0 }]
                .into_iter()
                .collect(),
        };
        let Some(Part { kind: PartKind::Click(click), .. }) = sequence.part(0) else { panic!("a click") };
        assert_eq!(click.level, Newtons(4.0));
        let Some(Part { kind: PartKind::Tone(tone), .. }) = sequence.part(1) else { panic!("a tone") };
        for (t, level) in [(0.0, 0.5), (0.25, 0.75), (0.5, 1.0), (0.9, 1.0)] {
            assert!((tone.at(t).0 - level).abs() < 1e-5, "{t} s: {:?}", tone.at(t));
        }
        assert_eq!(sequence.part(2), None);
        let timeline: &dyn EffectTimeline = &sequence;
        assert!((timeline.end_s() - 1.5).abs() < 1e-5);
    }
}
