//! One foot as a touch in egui.

use egui::{Context, DragAndDrop, Event, Modifiers, PointerButton, Pos2, TouchDeviceId, TouchId, TouchPhase};
use underfoot::sense::ContactId;
use underfoot::units::Newtons;

/// The device id of feet's touches: "feet".
pub(crate) const DEVICE: TouchDeviceId = TouchDeviceId(0x6665_6574);

/// Force that egui receives as 1: a person on one foot.
const FULL: Newtons = Newtons(800.0);

/// Distance in points to which a pointer jumps before its release, so that the release does not click.
const AWAY: f32 = 100_000.0;

/// A foot that touches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TouchingFoot {
    pub(crate) contact: ContactId,
    pub(crate) at: Pos2,
    pub(crate) force: Newtons,
    /// Whether it is egui's one pointer as well.
    pub(crate) is_pointer: bool,
}

impl TouchingFoot {
    pub(crate) fn start(self, events: &mut Vec<Event>) {
        events.push(self.event(TouchPhase::Start));
        if self.is_pointer {
            events.extend([Event::PointerMoved(self.at), self.button(true)]);
        }
    }

    pub(crate) fn moved(self, events: &mut Vec<Event>) {
        events.push(self.event(TouchPhase::Move));
        if self.is_pointer {
            events.push(Event::PointerMoved(self.at));
        }
    }

    /// Ends the touch by a release; the press counts.
    pub(crate) fn end(self, events: &mut Vec<Event>) {
        events.push(self.event(TouchPhase::End));
        if self.is_pointer {
            events.extend([self.button(false), Event::PointerGone]);
        }
    }

    /// Ends the touch without a click.
    ///
    /// A pointer that has been far away does not click at its release; released at its old place, it leaves sliders
    /// of any direction unchanged. A dragged payload is dropped nowhere.
    pub(crate) fn cancel(self, context: &Context, events: &mut Vec<Event>) {
        events.push(self.event(TouchPhase::Cancel));
        if self.is_pointer {
            DragAndDrop::clear_payload(context);
            let away = Event::PointerMoved(self.at - egui::vec2(0.0, AWAY));
            events.extend([away, Event::PointerMoved(self.at), self.button(false), Event::PointerGone]);
        }
    }

    fn event(self, phase: TouchPhase) -> Event {
        let force = Some((self.force / FULL).clamp(0.0, 1.0));
        Event::Touch { device_id: DEVICE, id: TouchId(u64::from(self.contact.0)), phase, pos: self.at, force }
    }

    fn button(self, pressed: bool) -> Event {
        let (button, modifiers) = (PointerButton::Primary, Modifiers::NONE);
        Event::PointerButton { pos: self.at, button, pressed, modifiers }
    }
}
