//! Positions of numbers within their ranges, so that steps and ends are felt.

use arrayvec::ArrayVec;
use glam::Vec2;

use super::{Now, PUSH, push, spots};
use crate::feel::{Detents, EffectKind, Lasting, SustainedCue, SustainedCues, key};
use crate::layout::{Layout, Widget};
use crate::sense::ContactId;
use crate::units::Instant;
use crate::widget::{Behaviour, Control, Scale, Value};

/// Positions of the controls' numbers within their ranges.
#[derive(Debug, Default)]
pub(super) struct NumberShares(Vec<Share>);

/// One control's number.
#[derive(Clone, Copy, Debug)]
struct Share {
    /// 0 to 1, both numbers of a pad; NaN for other values.
    at: Vec2,
    /// The last detent of the effect that was felt, and the maximum distance of the number from it since.
    detent: f32,
    away: f32,
}

/// Distance from a detent after which it is felt again, in spacings of detents (our choice: a foot that rests on one
/// sways by less).
const AGAIN: f32 = 0.25;

/// A change of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct NumberChange {
    pub(super) from: f32,
    pub(super) to: f32,
    /// The end that the change reached: true for the high one; `None` if it reached none.
    pub(super) end: Option<bool>,
}

impl NumberShares {
    pub(super) fn begin(&mut self, layout: &Layout, controls: &[Control]) {
        self.0.clear();
        self.0.extend(layout.widgets.iter().zip(controls).map(|(widget, control)| {
            let at = control.value().map_or(Vec2::NAN, |value| shares(&widget.behaviour, value));
            Share { at, detent: f32::NAN, away: 0.0 }
        }));
    }

    /// Notes the new value of control number `widget`; `None` if it is not a number.
    pub(super) fn go(&mut self, widget: usize, behaviour: &Behaviour, value: Value) -> Option<NumberChange> {
        let share = self.0.get_mut(widget)?;
        let to = shares(behaviour, value);
        let from = std::mem::replace(&mut share.at, to);
        share.away = share.away.max((to.x - share.detent).abs());
        if to.x.is_nan() {
            return None;
        }
        let end = [(from.x, to.x), (from.y, to.y)]
            .into_iter()
            .find_map(|(from, to)| end_of(to).filter(|_| from != to));
        Some(NumberChange { from: from.x, to: to.x, end })
    }

    /// The detent of `detents` that a number passes on this `way`, if it is not the last one that was felt.
    pub(super) fn detent(&mut self, widget: usize, detents: &Detents, way: NumberChange) -> Option<f32> {
        let detent = detents.passed(way.from, way.to)?;
        let share = self.0.get_mut(widget)?;
        if share.detent == detent && share.away < AGAIN * detents.every {
            return None;
        }
        (share.detent, share.away) = (detent, 0.0);
        Some(detent)
    }

    /// The change of a number that stays at its end although it was meant to go on.
    pub(super) fn stay(&self, widget: usize) -> NumberChange {
        let at = self.0.get(widget).map_or(f32::NAN, |share| share.at.x);
        NumberChange { from: at, to: at, end: end_of(at) }
    }

    /// Whether a number is at either end of its range.
    pub(super) fn is_at_end(&self, widget: usize) -> bool {
        self.0.get(widget).is_some_and(|share| end_of(share.at.x).is_some() || end_of(share.at.y).is_some())
    }
}

/// The end at which a share is: true for the high one; `None` between the ends.
fn end_of(share: f32) -> Option<bool> {
    if share <= 0.0 {
        Some(false)
    } else if share >= 1.0 {
        Some(true)
    } else {
        None
    }
}

fn shares(behaviour: &Behaviour, value: Value) -> Vec2 {
    let share = |scale: &Scale, number: f32| {
        // The last step may differ from the greatest value by rounding.
        let share = scale.share(number);
        if share < 1e-5 {
            0.0
        } else if share > 1.0 - 1e-5 {
            1.0
        } else {
            share
        }
    };
    match (behaviour, value) {
        (Behaviour::Pad(spec), Value::Pair(pair)) => {
            Vec2::new(share(&spec.x(), pair.x), share(&spec.y(), pair.y))
        }
        (Behaviour::Pedal(spec), Value::Number(number)) => Vec2::new(share(&spec.scale, number), f32::NAN),
        (_, Value::Number(number)) => {
            behaviour.scale().map_or(Vec2::NAN, |scale| Vec2::new(share(scale, number), f32::NAN))
        }
        _ => Vec2::NAN,
    }
}

/// Feet that have slid a number to its end, and may push on.
#[derive(Debug, Default)]
pub(super) struct Ends(ArrayVec<Pushing, MAX_PUSHING>);

const MAX_PUSHING: usize = 16;

/// One such foot.
#[derive(Clone, Copy, Debug)]
struct Pushing {
    widget: usize,
    contact: ContactId,
    /// Place of the foot when it reached the end, and its direction of motion.
    anchor: Vec2,
    way: Vec2,
    /// Farthest distance of the push beyond the end, in metres, and the time of the last push.
    reached: f32,
    pushed: Instant,
}

/// Additional distance that counts as pushing on, rather than sway, in metres (our choice: a standing foot wanders by
/// less within a second).
const PUSHES_M: f32 = 0.004;

/// Time over which the effect of pushing fades once the foot is at rest again, in seconds (our choice: a wall is not
/// an alarm).
const FADES_S: f32 = 1.2;

impl Ends {
    pub(super) fn clear(&mut self) {
        self.0.clear();
    }

    /// Notes a changed number: it may have reached an end, or left it.
    pub(super) fn reach(
        &mut self,
        widget: usize,
        spec: &Widget,
        way: NumberChange,
        id: ContactId,
        now: Now<'_>,
    ) {
        let Some(EffectKind::EndStop(end)) = spec.feel.end.as_ref().map(|effect| &effect.kind) else {
            return;
        };
        if end.push.is_none() || way.end.is_none() {
            return;
        }
        let Some(contact) = now.contact(id) else { return };
        self.0.retain(|pushing| pushing.contact != id);
        let way = contact.velocity.normalize_or_zero();
        let pushing =
            Pushing { widget, contact: id, anchor: contact.centroid, way, reached: 0.0, pushed: now.at };
        // Of more feet than fit, the last ones only feel the thud.
        let _ = self.0.try_push(pushing);
    }

    /// Appends the sustained cues of feet that push on against an end.
    pub(super) fn push(&mut self, shares: &NumberShares, now: Now<'_>, sustained: &mut SustainedCues) {
        self.0.retain(|pushing| {
            let Some(contact) = now.contact(pushing.contact) else { return false };
            let Some(feel) = now.layout.widgets.get(pushing.widget).map(|widget| &widget.feel) else {
                return false;
            };
            let Some(effect) = feel.end.as_ref() else {
                return false;
            };
            let EffectKind::EndStop(end) = &effect.kind else { return false };
            if !shares.is_at_end(pushing.widget) {
                return false;
            }
            let Some(felt) = end.push else { return false };
            let beyond = (contact.centroid - pushing.anchor).dot(pushing.way);
            if beyond > pushing.reached + PUSHES_M {
                (pushing.reached, pushing.pushed) = (beyond, now.at);
            }
            // A foot that moves back a little and pushes again feels it again.
            pushing.reached = pushing.reached.min(beyond + PUSHES_M);
            let fresh = 1.0 - now.at.since(pushing.pushed).as_secs_f32() / FADES_S;
            if beyond > 0.0 && fresh > 0.0 {
                let mut hum = felt.hum_at(beyond);
                hum.level = hum.level * fresh;
                let sustained_cue = SustainedCue {
                    key: key(contact.id.0, PUSH),
                    spots: spots(contact),
                    effect: Lasting::Hum(hum),
                    manner: effect.manner,
                    speed_m_s: contact.velocity.length(),
                    force: contact.force,
                    audio_gain: feel.sound,
                };
                push(sustained, Some(sustained_cue));
            }
            true
        });
    }
}
