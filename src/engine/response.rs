//! Which cue answers which event: the one place where controls meet feel.

use crate::feel::{Cue, Rub, Rubs, Spot, Spots};
use crate::layout::Layout;
use crate::sense::{Contact, ContactId};
use crate::units::Instant;
use crate::widget::{EventKind, WidgetEvent};

use super::interact::Sliding;

/// The cues that answer `events`, on the tiles under the contacts that caused them.
pub(super) fn cues<'a>(
    events: &'a [WidgetEvent],
    received: Instant,
    layout: &'a Layout,
    contacts: &'a [Contact],
    last_spots: &'a LastSpots,
) -> impl Iterator<Item = Cue> + 'a {
    events.iter().enumerate().filter_map(move |(at, event)| {
        let next = events.get(at + 1);
        let taken_back = next.is_some_and(|next| next.kind == EventKind::Cancelled && next.id == event.id);
        if taken_back { None } else { cue(event, received, layout, contacts, last_spots) }
    })
}

/// The cue that answers `event`; `None` if it has none.
///
/// A cancel is not felt, nor what it takes back: the foot has left, or the floor can't be trusted.
fn cue(
    event: &WidgetEvent,
    received: Instant,
    layout: &Layout,
    contacts: &[Contact],
    last_spots: &LastSpots,
) -> Option<Cue> {
    let widget = &layout.widgets.get(layout.widget_index(event.id.as_str())?)?;
    let feel = &widget.feel;
    let click = match event.kind {
        EventKind::Pressed => feel.press.as_ref(),
        EventKind::Released => feel.release.as_ref(),
        EventKind::HardPressed | EventKind::LongPressed => feel.stage.as_ref().or(feel.press.as_ref()),
        EventKind::HardReleased => feel.release.as_ref(),
        EventKind::Ticked => feel.step.as_ref(),
        EventKind::Changed(value) if widget.behaviour.is_stop(value) => feel.step.as_ref(),
        EventKind::Armed => feel.arm.as_ref(),
        EventKind::Warned | EventKind::Refused => feel.warn.as_ref(),
        EventKind::Clicked
        | EventKind::DoubleTapped
        | EventKind::Swiped(_)
        | EventKind::Cancelled
        | EventKind::Changed(_)
        | EventKind::Disarmed => None,
    }?;
    let id = event.contact?;
    let spots = match contacts.iter().find(|contact| contact.id == id) {
        Some(contact) => spots(contact),
        None => last_spots.of(id)?,
    };
    Some(Cue { at: event.at, received, spots, click: click.clone(), to_air: feel.sound })
}

/// What a foot sliding on a control feels like now; `None` if the control has no friction.
pub(super) fn rub(sliding: Sliding, layout: &Layout, contacts: &[Contact]) -> Option<Rub> {
    let friction = layout.widgets.get(sliding.widget)?.feel.drag?;
    let contact = contacts.iter().find(|contact| contact.id == sliding.contact)?;
    Some(Rub {
        key: contact.id.0,
        spots: spots(contact),
        friction,
        speed_m_s: contact.velocity.length(),
        force: contact.force,
    })
}

/// Appends `rub` unless the list is full, which takes more feet than a floor control page has room for.
pub(super) fn push(rubs: &mut Rubs, rub: Rub) {
    // The rubs beyond the limit are the latest to land; they stay silent until one ends.
    let _ = rubs.try_push(rub);
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

/// Where contacts were felt last, so that a release is felt where the foot was although it has just left.
#[derive(Debug, Default)]
pub(super) struct LastSpots(Vec<(ContactId, Spots)>);

impl LastSpots {
    /// Remembers the contacts of this frame; those that were gone in the last one too are forgotten
    /// unless `keep` says that a control still waits for them.
    pub(super) fn update(&mut self, contacts: &[Contact], keep: impl Fn(ContactId) -> bool) {
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
