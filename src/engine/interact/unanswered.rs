//! Contacts on controls without a response, and the reasons.

use super::super::feet::{AS_GOOD_AS_LIFTED_N, FootHistory, PressMode};
use super::super::ignored::Ignored;
use super::{Interaction, Moment};
use crate::widget::{Control, OffReason};

impl Interaction {
    /// Notes the contacts that lie on controls without operating one, and closes the visits that are over.
    pub(super) fn note_ignored(&mut self, at: &Moment<'_>) {
        for contact in at.contacts.iter().filter(|contact| contact.force.0 >= AS_GOOD_AS_LIFTED_N) {
            let Some(widget) = self.hits.widget_at(at.layout, self.page, contact.centroid) else { continue };
            let (Some(spec), Some(control)) = (at.layout.widgets.get(widget), self.controls.get(widget))
            else {
                continue;
            };
            if self.ignored.is_noted(contact.id) {
                continue;
            }
            let foot = self.feet.of(contact.id);
            let is = |so: fn(&FootHistory) -> bool| foot.is_some_and(so);
            let in_region = at
                .layout
                .regions
                .get(spec.region)
                .is_some_and(|region| region.area.contains(contact.centroid));
            let why = if is(FootHistory::is_in_stance) {
                Ignored::Stance
            } else if is(FootHistory::is_object) {
                Ignored::Object
            } else if !in_region {
                Ignored::OutsideRegion
            } else if foot.is_some_and(|foot| foot.is_step_on(PressMode::of(spec), at.now())) {
                Ignored::Step
            } else {
                Ignored::OtherFoot
            };
            let why = switched_off(control).unwrap_or(why);
            self.ignored.note(contact.id, widget, contact.force, Some(why));
        }
        let press = |widget: usize| {
            let spec = at.layout.widgets.get(widget)?;
            Some((spec.id.clone(), spec.behaviour.thresholds().press))
        };
        self.ignored.end(at.now(), press);
    }
}

/// The reason why `control` responds to no foot, if it is off.
pub(super) fn switched_off(control: &Control) -> Option<Ignored> {
    let disabled = control.is_disabled().then_some(OffReason::Disabled);
    disabled.or(control.inhibited()).map(Ignored::Off)
}
