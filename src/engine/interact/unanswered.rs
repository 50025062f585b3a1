//! Contacts on controls without a response, and the reasons.

use super::super::feet::{AS_GOOD_AS_LIFTED_N, FootHistory, PressMode};
use super::super::ignored::Ignored;
use super::{Interaction, Moment};
use crate::sense::Contact;
use crate::widget::{Control, OffReason};

/// Notes the contacts that lie on controls without operating one, and closes the visits that are over.
pub(super) fn note_ignored(interaction: &mut Interaction, at: &Moment<'_>) {
    for contact in at.contacts.iter().filter(|contact| !at.is_new(contact)) {
        interaction.ignored.note_stay(contact.id);
    }
    let heavy = |contact: &&Contact| contact.force.0 >= AS_GOOD_AS_LIFTED_N && at.is_new(contact);
    for contact in at.contacts.iter().filter(heavy) {
        let Some(widget) = interaction.hits.widget_at(at.layout, interaction.page, contact.centroid) else {
            continue;
        };
        let (Some(spec), Some(control)) = (at.layout.widgets.get(widget), interaction.controls.get(widget))
        else {
            continue;
        };
        if interaction.ignored.is_noted(contact.id) {
            continue;
        }
        let foot = interaction.feet.of(contact.id);
        let in_region =
            at.layout.regions.get(spec.region).is_some_and(|region| region.area.contains(contact.centroid));
        let may = foot.map_or(Ok(()), FootHistory::may_lead);
        let may = may.and(if in_region { Ok(()) } else { Err(Ignored::OutsideRegion) });
        let operates = |foot: &FootHistory| foot.may_operate(PressMode::of(spec), at.now());
        let may = may.and_then(|()| foot.map_or(Ok(()), operates));
        let why = may.err().unwrap_or(Ignored::OtherFoot);
        let why = switched_off(control).unwrap_or(why);
        interaction.ignored.note(contact.id, widget, contact.force, Some(why));
    }
    let press = |widget: usize| {
        let spec = at.layout.widgets.get(widget)?;
        Some((spec.id.clone(), spec.behaviour.thresholds().press))
    };
    interaction.ignored.end(at.now(), press);
}

/// The reason why `control` responds to no foot, if it is off.
pub(super) fn switched_off(control: &Control) -> Option<Ignored> {
    let disabled = control.is_disabled().then_some(OffReason::Disabled);
    disabled.or(control.inhibited()).map(Ignored::Off)
}
