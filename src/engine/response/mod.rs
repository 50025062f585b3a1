//! Assigns effects to events: the one place where controls meet feel.

mod values;

use std::sync::Arc;

use super::event::ControlEvent;
use super::interact::Sliding;
use crate::feel::{
    Click, Clicks, Cue, Effect, EffectKind, Manner, Player, Spot, Spots, SustainedCue, SustainedCues, key,
};
use crate::ground::GroundEvent;
use crate::layout::{Layout, Widget};
use crate::sense::{Contact, ContactId, ForceFrame};
use crate::units::Instant;
use crate::widget::{Behaviour, Control, EventKind, Value};

use values::{Ends, NumberChange, NumberShares};

/// Turns events of controls into cues.
#[derive(Debug, Default)]
pub(super) struct Responses {
    player: Player,
    shares: NumberShares,
    ends: Ends,
    last_spots: LastSpots,
}

/// Keys for the simultaneous cues of one foot, for [`key`].
const DRAG: u32 = 0;
const PUSH: u32 = 1;

/// The inputs of one frame.
#[derive(Clone, Copy)]
pub(super) struct Now<'a> {
    pub(super) at: Instant,
    pub(super) received: Instant,
    pub(super) layout: &'a Layout,
    pub(super) contacts: &'a [Contact],
}

impl<'a> Now<'a> {
    pub(super) fn of(frame: &ForceFrame, layout: &'a Layout, contacts: &'a [Contact]) -> Self {
        Self { at: frame.at, received: frame.received, layout, contacts }
    }

    fn contact(&self, id: ContactId) -> Option<&'a Contact> {
        self.contacts.iter().find(|contact| contact.id == id)
    }
}

impl Responses {
    /// Drops the state of the previous layout; `controls` are those of `layout`.
    pub(super) fn begin(&mut self, layout: &Layout, controls: &[Control]) {
        self.shares.begin(layout, controls);
        self.ends.clear();
        self.player.clear();
    }

    /// Notes a value that an app has set.
    pub(super) fn note(&mut self, widget: usize, layout: &Layout, value: Value) {
        if let Some(spec) = layout.widgets.get(widget) {
            self.shares.go(widget, &spec.behaviour, value);
        }
    }

    /// Appends the cues that answer `events`, on the tiles under the contacts that caused them.
    ///
    /// Neither a cancel nor the change that it reverts has a cue: the foot has left, or the floor is unreliable.
    pub(super) fn answer(&mut self, events: &[ControlEvent], now: Now<'_>, cues: &mut Vec<Cue>) {
        for (number, event) in events.iter().enumerate() {
            let widget = event.widget;
            let Some(spec) = now.layout.widgets.get(widget) else { continue };
            let way = match event.kind {
                EventKind::Changed(value) => self.shares.go(widget, &spec.behaviour, value),
                _ => None,
            };
            let next = events.get(number + 1);
            let taken_back =
                next.is_some_and(|next| next.kind == EventKind::Cancelled && next.widget == widget);
            let Some(id) = event.contact.filter(|_| !taken_back) else { continue };
            let spots = match now.contact(id) {
                Some(contact) => spots(contact),
                None => match self.last_spots.of(id) {
                    Some(spots) => spots,
                    None => continue,
                },
            };
            let audio_gain = spec.feel.sound;
            let cue = Cue { at: event.at, received: now.received, spots, audio_gain, ..Cue::default() };
            if let (EventKind::Changed(Value::Number(_) | Value::Pair(_)), Some(way)) = (event.kind, way) {
                self.ends.reach(widget, spec, way, id, now);
                if let Some((click, manner)) = self.stop((widget, spec), way, event, now) {
                    cues.push(Cue { click, manner, ..cue });
                }
                continue;
            }
            let changes = events
                .iter()
                .any(|other| other.widget == widget && matches!(other.kind, EventKind::Changed(_)));
            if event.kind == EventKind::Pressed && !changes && self.shares.is_at_end(widget) && steps(spec) {
                let way = self.shares.stay(widget);
                if let Some((click, manner)) = self.stop((widget, spec), way, event, now) {
                    cues.push(Cue { click, manner, ..cue });
                }
                continue;
            }
            if let Some(effect) = answering(spec, event.kind) {
                let release = matches!(event.kind, EventKind::Released | EventKind::HardReleased);
                self.player.play(effect, id.0, release, cue, cues);
            }
        }
    }

    /// The click of the end or the step that a number reaches on this `way`; `None` if there is none.
    fn stop(
        &mut self,
        (number, widget): (usize, &Widget),
        way: NumberChange,
        event: &ControlEvent,
        now: Now<'_>,
    ) -> Option<(Click, Manner)> {
        if let (Some(high), Some(effect)) = (way.end, &widget.feel.end) {
            let velocity =
                event.contact.and_then(|id| now.contact(id)).map(|contact| contact.velocity.length());
            let click = match &effect.kind {
                EffectKind::EndStop(end) => end.click_at(high, velocity.unwrap_or(0.0)),
                EffectKind::Click(Clicks { press, .. }) => press.clone(),
                _ => return None,
            };
            return Some((click, effect.manner));
        }
        let effect = widget.feel.step.as_ref()?;
        let is_stop = match event.kind {
            EventKind::Changed(value) => widget.behaviour.is_stop(value),
            _ => false,
        };
        let click = match &effect.kind {
            EffectKind::Detents(detents) if detents.every > 0.0 => {
                detents.click_at(self.shares.detent(number, detents, way)?, way.to > way.from)
            }
            EffectKind::Detents(detents) if is_stop => detents.click_at(way.to, way.to >= way.from),
            EffectKind::Click(Clicks { press, .. }) if is_stop => press.clone(),
            _ => return None,
        };
        Some((click, effect.manner))
    }

    /// Appends the sustained cues: friction under sliding feet, feet that push against an end, effects of held
    /// controls; and continues sequences.
    pub(super) fn last(
        &mut self,
        sliding: impl Iterator<Item = Sliding>,
        holding: &(impl Iterator<Item = Sliding> + Clone),
        now: Now<'_>,
        cues: &mut Vec<Cue>,
        sustained: &mut SustainedCues,
    ) {
        for sliding in sliding {
            push(sustained, sustained_cue(sliding, now.layout, now.contacts));
        }
        self.ends.push(&self.shares, now, sustained);
        for Sliding { widget, contact } in holding.clone() {
            let Some(feel) = now.layout.widgets.get(widget).map(|widget| &widget.feel) else { continue };
            if let (Some(effect), Some(contact)) = (&feel.hold, now.contact(contact)) {
                let (at, received, audio_gain) = (now.at, now.received, feel.sound);
                let cue = Cue { at, received, spots: spots(contact), audio_gain, ..Cue::default() };
                self.player.hold(effect, contact.id.0, &cue);
            }
        }
        self.player.let_go(|owner| holding.clone().any(|holding| holding.contact.0 == owner));
        let place = |owner: u32| now.contact(ContactId(owner)).map(spots);
        self.player.due(now.at, place, cues, sustained);
    }

    /// Appends the cues of ground events: felt on the tiles under the contact that caused them, by its weights, or on
    /// the tile alone if the contact is unknown by now; heard from the place of the event.
    pub(super) fn give_way(&self, broken: &[GroundEvent], now: Now<'_>, cues: &mut Vec<Cue>) {
        for event in broken {
            let here = event.contact.and_then(|id| now.contact(id)).map(spots);
            let spots = here.or_else(|| self.last_spots.of(event.contact?)).unwrap_or_else(|| {
                let tile = u16::try_from(event.tile).unwrap_or(u16::MAX);
                Spots::from_iter([Spot { tile, weight: 1.0 }])
            });
            let (at, received, click) = (event.at, now.received, event.click.clone());
            let ground = now.layout.grounds.get(event.ground);
            let audio_gain = ground.map_or(0.0, |ground| ground.spec.material.sound());
            let heard_at = Some(event.place);
            cues.push(Cue { at, received, spots, click, audio_gain, heard_at, ..Cue::default() });
        }
    }

    /// Stores the spots of this frame's contacts; drops those of contacts that have left, unless `keep` says that a
    /// control still needs them.
    pub(super) fn remember(&mut self, contacts: &[Contact], keep: impl Fn(ContactId) -> bool) {
        self.last_spots.update(contacts, keep);
    }
}

/// The effect that answers `event` of a control once; `None` if it has none.
fn answering(widget: &Widget, event: EventKind) -> Option<&Arc<Effect>> {
    let feel = &widget.feel;
    match event {
        EventKind::Pressed => feel.press.as_ref(),
        EventKind::Released => feel.release.as_ref(),
        EventKind::HardPressed | EventKind::LongPressed => feel.stage.as_ref().or(feel.press.as_ref()),
        EventKind::HardReleased => feel.release.as_ref(),
        EventKind::Ticked => feel.step.as_ref(),
        EventKind::Changed(Value::Switch(true)) => feel.on.as_ref(),
        EventKind::Changed(Value::Switch(false)) => feel.off.as_ref(),
        EventKind::Armed => feel.arm.as_ref(),
        EventKind::Warned | EventKind::Refused => feel.warn.as_ref(),
        EventKind::Clicked
        | EventKind::DoubleTapped
        | EventKind::Swiped(_)
        | EventKind::Cancelled
        | EventKind::Changed(_)
        | EventKind::Disarmed => None,
    }
}

/// Whether it is a stepper with an end effect, so that a press at its end plays that effect.
fn steps(widget: &Widget) -> bool {
    matches!(widget.behaviour, Behaviour::Stepper(_)) && widget.feel.end.is_some()
}

/// The sustained cue of a foot that slides on a control; `None` if the control has no friction.
fn sustained_cue(sliding: Sliding, layout: &Layout, contacts: &[Contact]) -> Option<SustainedCue> {
    let feel = &layout.widgets.get(sliding.widget)?.feel;
    let effect = feel.drag.as_ref()?;
    let contact = contacts.iter().find(|contact| contact.id == sliding.contact)?;
    Some(SustainedCue {
        key: key(contact.id.0, DRAG),
        spots: spots(contact),
        effect: effect.kind.lasting()?,
        manner: effect.manner,
        speed_m_s: contact.velocity.length(),
        force: contact.force,
        audio_gain: feel.sound,
    })
}

/// Appends `cue` unless the list is full, which takes more feet than fit on a page of controls.
fn push(sustained: &mut SustainedCues, cue: Option<SustainedCue>) {
    // Cues beyond the limit come from the latest feet to land; they stay silent until one ends.
    if let Some(cue) = cue {
        let _ = sustained.try_push(cue);
    }
}

/// The tiles under a contact with their weights in Eq. 4, renormalised over the heaviest four.
///
/// # Source
/// `w_k = F_k / F` (paper, Eq. 4).
fn spots(contact: &Contact) -> Spots {
    let felt = || contact.tiles.iter().take(Spots::new().capacity());
    let total: f32 = felt().map(|load| load.force.0).sum();
    felt()
        .filter(|_| total > 0.0)
        .map(|load| Spot {
            tile: u16::try_from(load.index).unwrap_or(u16::MAX),
            weight: load.force.0 / total,
        })
        .collect()
}

/// The last spots of each contact, so that a release is felt at the place of a foot that has just left.
#[derive(Debug, Default)]
struct LastSpots(Vec<(ContactId, Spots)>);

impl LastSpots {
    fn update(&mut self, contacts: &[Contact], keep: impl Fn(ContactId) -> bool) {
        self.0.retain(|(id, _)| keep(*id) || contacts.iter().any(|contact| contact.id == *id));
        for contact in contacts {
            match self.0.iter_mut().find(|(id, _)| *id == contact.id) {
                Some((_, known)) => *known = spots(contact),
                None => self.0.push((contact.id, spots(contact))),
            }
        }
    }

    fn of(&self, id: ContactId) -> Option<Spots> {
        self.0.iter().find(|(known, _)| *known == id).map(|(_, spots)| spots.clone())
    }
}
