//! Controls that a foot presses: each follows its own foot.

use glam::Vec2;

use super::belief::{is_believed, is_certain, is_sensed};
use super::foot::{foot_input, place};
use super::{Interaction, Moment, report};
use crate::engine::event::ControlEvent;
use crate::engine::feet::{FootHistory, PressMode};
use crate::engine::region::Finger;
use crate::floor::Geometry;
use crate::sense::{ContactId, ForceFrame};
use crate::units::Newtons;
use crate::widget::{EventKind, Guard, Input};

/// Distance beyond its edge within which a control keeps the foot that presses it (our choice: within the sway of a
/// foot that is meant to stay).
const SLIDE_OFF_MARGIN_M: f32 = 0.03;

impl Interaction {
    /// An engaged control follows its own foot, independent of the cursor.
    pub(super) fn step_held(&mut self, finger: &mut Finger, at: &Moment<'_>, events: &mut Vec<ControlEvent>) {
        let Some(mut held) = finger.held else { return };
        let (Some(spec), Some(control)) =
            (at.layout.widgets.get(held.widget), self.controls.get_mut(held.widget))
        else {
            finger.held = None;
            return;
        };
        if !is_news(held.contact, held.position, &self.geometry, at) {
            self.ignored.note_stay(held.contact);
            return;
        }
        let force = at.contact(held.contact).map_or(held.force, |contact| contact.force);
        self.ignored.note_answer(held.contact, held.widget, force);
        let foot = self.feet.of(held.contact);
        let input = match at.contact(held.contact) {
            Some(contact) => {
                held.force = contact.force;
                held.position = contact.centroid;
                let off = spec.area.distance(contact.centroid) > SLIDE_OFF_MARGIN_M;
                let guard = spec.behaviour.thresholds().guard;
                let mode = PressMode::of(spec);
                let falls = guard != Guard::Free && foot.is_some_and(FootHistory::falls);
                let steps = |foot: &FootHistory| foot.may_operate(mode, at.now()).is_err();
                if falls || foot.is_some_and(steps) {
                    Input::Stepping { force: contact.force }
                } else if off && !control.captures() {
                    Input::SlidOff
                } else {
                    // An action on lifting needs the reliability of a press; an action while the foot is down needs
                    // certain sensors.
                    let acts = matches!(mode, PressMode::Follow | PressMode::Stand)
                        || matches!(guard, Guard::HoldToRun { .. });
                    let believed = if acts {
                        is_certain(contact, guard, at.frame)
                    } else {
                        is_believed(contact, guard, at.frame)
                    };
                    foot_input(contact, spec, at.frame, self.feet.weight(contact.id), believed)
                }
            }
            // A contact that disappears from a sensed floor was lifted; without sensing its state is unknown.
            None if is_sensed_at(held.position, &self.geometry, at.frame) => Input::Foot {
                force: Newtons::ZERO,
                trusted: true,
                place: place(held.position, spec),
                weight: None,
            },
            None => Input::Lost,
        };
        let emitted = control.step(at.now(), input);
        finger.held = control.is_engaged().then_some(held);
        if finger.held.is_none() {
            let cancelled = emitted.contains(&EventKind::Cancelled);
            self.ignored.note_end(at.now(), &spec.id, (held.contact, held.widget), cancelled);
        }
        report(at.layout, at.now(), held.widget, Some(held), &emitted, events);
        self.wake(held.widget);
    }
}

/// Whether this frame has new forces of the foot `contact`, last seen at `position`.
fn is_news(contact: ContactId, position: Vec2, geometry: &Geometry, at: &Moment<'_>) -> bool {
    let tile = || geometry.tile_under(position).and_then(|tile| geometry.index(tile));
    match at.contact(contact) {
        Some(contact) => at.is_new(contact),
        None => tile().map_or(at.frame.is_new, |tile| at.frame.is_new_at(tile)),
    }
}

fn is_sensed_at(point: Vec2, geometry: &Geometry, frame: &ForceFrame) -> bool {
    let tile = geometry.tile_under(point).and_then(|tile| geometry.index(tile));
    tile.and_then(|tile| frame.quality.get(tile)).is_none_or(is_sensed)
}
