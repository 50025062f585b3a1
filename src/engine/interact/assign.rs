//! The feet of each region, assigned to the controls below them.

use super::candidate::{Conditions, PressCandidate, PressRefusal};
use super::unanswered::switched_off;
use super::{Interaction, Moment, holds_to_run, report};
use crate::engine::event::ControlEvent;
use crate::engine::feet::{AS_GOOD_AS_LIFTED_N, FootHistory, PressMode};
use crate::engine::region::{EngagedFoot, Finger};
use crate::layout::{CursorRule, Layout};
use crate::sense::Contact;

impl Interaction {
    pub(super) fn step_region(&mut self, index: usize, at: &Moment<'_>, events: &mut Vec<ControlEvent>) {
        let Some((state, region)) = self.regions.get_mut(index).zip(at.layout.regions.get(index)) else {
            return;
        };
        let (feet, hits, page) = (&self.feet, &self.hits, self.page);
        let works = |contact: &Contact, foot: &FootHistory| {
            let widget = hits.widget_at(at.layout, page, contact.centroid);
            let spec = widget.and_then(|widget| at.layout.widgets.get(widget));
            spec.is_some_and(|spec| {
                spec.region == index && foot.may_operate(PressMode::of(spec), at.now()).is_ok()
            })
        };
        let may = |contact: &Contact| {
            let all = region.cursor != CursorRule::Working;
            feet.of(contact.id).is_none_or(|foot| foot.may_lead().is_ok() && (all || works(contact, foot)))
        };
        state.point(region, at.contacts, may, at.now());
        // Taken out while the rest of the interaction works with them.
        let mut fingers = std::mem::take(&mut state.fingers);
        let busy = fingers.iter().any(|finger| finger.held.is_some());
        self.running = false;
        for finger in fingers.iter_mut().filter(|finger| finger.held.is_some()) {
            finger.over = None;
            self.step_held(finger, at, events);
            self.running |= finger.held.is_some_and(|held| holds_to_run(at.layout, held.widget));
        }
        if !busy || region.cursor == CursorRule::Each {
            self.step_free(index, &mut fingers, at, events);
        }
        if let Some(state) = self.regions.get_mut(index) {
            state.fingers = fingers;
        }
    }

    /// Free fingers feed the control below them; of several on one control, the heaviest does.
    fn step_free(
        &mut self,
        index: usize,
        fingers: &mut [Finger],
        at: &Moment<'_>,
        events: &mut Vec<ControlEvent>,
    ) {
        for this in 0..fingers.len() {
            let Some(&finger) = fingers.get(this).filter(|finger| finger.held.is_none()) else { continue };
            if at.contact(finger.cursor.contact).is_some_and(|contact| !at.is_new(contact)) {
                continue;
            }
            let on = |finger: &Finger| {
                let widget = self.hits.widget_at(at.layout, self.page, finger.cursor.position)?;
                (at.layout.widgets.get(widget)?.region == index).then_some(widget)
            };
            let over = on(&finger).filter(|&widget| {
                let heavier = |other: &Finger| {
                    let (ours, theirs) = (finger.cursor, other.cursor);
                    theirs.force > ours.force || (theirs.force == ours.force && theirs.contact < ours.contact)
                };
                fingers.iter().all(|other| {
                    other.cursor.contact == finger.cursor.contact
                        || !(other.holds(widget)
                            || other.held.is_none() && heavier(other) && on(other) == Some(widget))
                })
            });
            let is_new = over != finger.over;
            let Some(finger) = fingers.get_mut(this) else { continue };
            finger.over = over;
            if let Some(widget) = over {
                self.step_over(widget, finger, is_new, at, events);
            }
        }
    }

    /// Feeds a control from a foot that it does not hold yet.
    fn step_over(
        &mut self,
        widget: usize,
        finger: &mut Finger,
        is_new: bool,
        at: &Moment<'_>,
        events: &mut Vec<ControlEvent>,
    ) {
        let now = at.now();
        let Some(contact) = at.contact(finger.cursor.contact) else { return };
        let rivals = self.runs_elsewhere(widget, at.layout);
        let (Some(spec), Some(control)) = (at.layout.widgets.get(widget), self.controls.get_mut(widget))
        else {
            return;
        };
        let conditions = Conditions { is_new, needs_lift: control.needs_lift(), rivals, rises: &self.rises };
        let (input, why) = match PressCandidate::new(contact, spec, &self.feet, at).input(&conditions) {
            Ok(input) => (input, None),
            Err(PressRefusal { why, input }) => (input, Some(why)),
        };
        let why = switched_off(control).or(why);
        let emitted = control.step(now, input);
        if contact.force.0 >= AS_GOOD_AS_LIFTED_N {
            self.ignored.note(contact.id, widget, contact.force, why);
        }
        if control.is_engaged() || !emitted.is_empty() {
            self.ignored.note_answer(contact.id, widget, contact.force);
        }
        let held =
            EngagedFoot { widget, contact: contact.id, force: contact.force, position: contact.centroid };
        if control.is_engaged() {
            finger.held = Some(held);
            self.running |= holds_to_run(at.layout, widget);
            self.feet.note_press(contact.id);
        }
        report(at.layout, now, widget, Some(held), &emitted, events);
        self.wake(widget);
    }

    /// Whether `widget` acts while it is held, and another such control is held already: only one runs at a time.
    pub(super) fn runs_elsewhere(&self, widget: usize, layout: &Layout) -> bool {
        holds_to_run(layout, widget)
            && (self.running || self.held().any(|held| holds_to_run(layout, held.widget)))
    }
}
