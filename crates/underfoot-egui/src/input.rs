//! Contacts on a part of the floor as touches, and one of them as the pointer.

use egui::{Context, Event, Pos2, RawInput, Rect};
use underfoot::engine::{FootRole, Snapshot};
use underfoot::floor;
use underfoot::glam::Vec2;
use underfoot::layout::Layout;
use underfoot::runtime::Session;
use underfoot::sense::{Contact, ContactId};
use underfoot::units::{Instant, Newtons};
use underfoot::wire::LinkState;

use crate::touch::TouchingFoot;

/// Force at which a foot touches, and below which it releases: those of the shipped buttons.
const PRESS: Newtons = Newtons(60.0);
const RELEASE: Newtons = Newtons(40.0);

/// Time in seconds that a foot must press before it touches: a walking foot is mostly classified as a step by then.
const DWELL_S: f64 = 0.06;

/// Greatest age of a snapshot, in seconds: after it, its feet may have moved or left.
const STALE_S: f64 = 0.15;

/// Greatest distance, in points, and duration, in seconds, of a press that still clicks. egui's own limits are for
/// fingers: 6 points, 0.8 s. A foot rolls by some centimetres and needs a second.
const CLICK_DISTANCE: f32 = 40.0;
const CLICK_S: f64 = 5.0;

/// A foot without a touch (yet).
#[derive(Clone, Copy, Debug)]
enum Before {
    /// It has pressed since this time, in seconds of egui's clock.
    Presses(f64),
    /// It came from elsewhere, or was cancelled: it must lift first.
    MustLift,
}

/// Contacts on a part of the floor as touches, and the first of them as egui's one pointer.
///
/// Each foot is a touch with an id of its own, for [`crate::FootSlider`] and egui's gestures of several fingers. The
/// first is the pointer as well, until it lifts; a later foot does not replace it.
///
/// A touch begins when a free foot presses with 60 N for 60 ms at a place without a control of the layout; it ends
/// below 40 N. The touch is cancelled, which neither clicks nor changes a value, when the foot is classified as a
/// step or an object, when it leaves the mapped part, when the floor falls silent or ends, and by
/// [`FootInput::cancel`]. An egui slider keeps the value it has followed until then; a [`crate::FootSlider`] restores
/// the old one.
#[derive(Clone, Debug)]
pub struct FootInput {
    part: floor::Rect,
    target: Option<Rect>,
    touches: Vec<TouchingFoot>,
    others: Vec<(ContactId, Before)>,
    /// The latest snapshot's time, and the time of its arrival in seconds of egui's clock.
    seen: Option<(Instant, f64)>,
}

impl FootInput {
    /// The feet on `part` of the floor, in floor metres, which is stretched over the whole window: its north-west
    /// corner is the window's upper left one. A part without area has no feet on it.
    #[must_use]
    pub const fn new(part: floor::Rect) -> Self {
        Self { part, target: None, touches: Vec::new(), others: Vec::new(), seen: None }
    }

    /// Stretches the part over `target`, in points, instead of the whole window; from then on, also for feet that
    /// are down.
    pub const fn set_target(&mut self, target: Rect) {
        self.target = Some(target);
    }

    /// Sets the click limits of `context` to those of feet: a press may move by 40 points and last for 5 s and still
    /// click.
    ///
    /// The limits then hold for the mouse of this app as well, since egui has one limit for all pointers.
    pub fn tune(context: &Context) {
        context.options_mut(|options| {
            options.input_options.max_click_dist = CLICK_DISTANCE;
            options.input_options.max_click_duration = CLICK_S;
        });
    }

    /// Adds the touches of `floor` to `raw`; call it for each frame, in `eframe::App::raw_input_hook`.
    ///
    /// With `move || context.request_repaint()` as [`underfoot::runtime::SessionBuilder::wake`], egui draws a frame
    /// at each event of a control; a foot on free floor causes no event, so this method requests the next frame by
    /// itself while there is any contact.
    pub fn follow(&mut self, context: &Context, floor: &Session, raw: &mut RawInput) {
        if floor.has_ended() {
            return self.cancel(context, raw);
        }
        let snapshot = floor.snapshot();
        self.feed(context, &snapshot.layout, &snapshot.floor, raw);
        if !snapshot.floor.contacts.is_empty() {
            context.request_repaint();
        }
    }

    /// Like [`FootInput::follow`], from a snapshot and its layout.
    pub fn feed(&mut self, context: &Context, layout: &Layout, floor: &Snapshot, raw: &mut RawInput) {
        let now = raw.time.unwrap_or_else(|| context.input(|input| input.time));
        let since = match self.seen {
            Some((at, since)) if at == floor.at => since,
            _ => now,
        };
        self.seen = Some((floor.at, since));
        let is_known = matches!(floor.link, LinkState::Live | LinkState::Partial);
        if !is_known || now - since > STALE_S {
            return self.cancel(context, raw);
        }
        let target = self.target.or(raw.screen_rect).unwrap_or_else(|| context.content_rect());
        self.follow_touches(context, floor, target, &mut raw.events);
        self.find_touches(layout, floor, target, now, &mut raw.events);
    }

    /// Cancels all touches; feet on the floor must lift before they touch again.
    pub fn cancel(&mut self, context: &Context, raw: &mut RawInput) {
        for touch in self.touches.drain(..) {
            touch.cancel(context, &mut raw.events);
            self.others.push((touch.contact, Before::MustLift));
        }
    }

    /// Number of feet that touch.
    #[must_use]
    pub fn touches(&self) -> usize {
        self.touches.len()
    }

    fn follow_touches(&mut self, context: &Context, floor: &Snapshot, target: Rect, events: &mut Vec<Event>) {
        let (part, others) = (self.part, &mut self.others);
        self.touches.retain_mut(|touch| {
            let Some(contact) = floor.contacts.iter().find(|contact| contact.id == touch.contact) else {
                touch.end(events);
                return false;
            };
            if contact.force < RELEASE {
                touch.end(events);
                others.push((touch.contact, Before::MustLift));
                return false;
            }
            let at = place(part, target, contact.centroid);
            let Some(at) = at.filter(|_| role(floor, contact.id) == FootRole::Free) else {
                touch.cancel(context, events);
                others.push((touch.contact, Before::MustLift));
                return false;
            };
            touch.force = contact.force;
            // A foot that is about to lift rolls: its target is the place where it last pressed.
            if contact.force >= PRESS && at != touch.at {
                touch.at = at;
                touch.moved(events);
            }
            true
        });
    }

    fn find_touches(
        &mut self,
        layout: &Layout,
        floor: &Snapshot,
        target: Rect,
        now: f64,
        events: &mut Vec<Event>,
    ) {
        let pressing = |id| floor.contacts.iter().any(|it| it.id == id && it.force >= RELEASE);
        self.others.retain(|(id, _)| pressing(*id));
        for contact in floor.contacts.iter().filter(|contact| contact.force >= PRESS) {
            if self.touches.iter().any(|touch| touch.contact == contact.id) {
                continue;
            }
            let at = self.free_place(layout, floor, target, contact);
            let known = self.others.iter().position(|(id, _)| *id == contact.id);
            match (known.and_then(|index| self.others.get_mut(index)), at) {
                (None, at) => {
                    let before = if at.is_some() { Before::Presses(now) } else { Before::MustLift };
                    self.others.push((contact.id, before));
                }
                (Some((_, before @ Before::Presses(_))), None) => *before = Before::MustLift,
                (Some((_, Before::Presses(since))), Some(at)) if now - *since >= DWELL_S => {
                    self.others.retain(|(id, _)| *id != contact.id);
                    let is_pointer = !self.touches.iter().any(|touch| touch.is_pointer);
                    let touch = TouchingFoot { contact: contact.id, at, force: contact.force, is_pointer };
                    touch.start(events);
                    self.touches.push(touch);
                }
                (Some(_), _) => {}
            }
        }
    }

    /// The point at which a free foot aims, if it is on the mapped part and not on a control.
    fn free_place(&self, layout: &Layout, floor: &Snapshot, target: Rect, contact: &Contact) -> Option<Pos2> {
        let is_free = role(floor, contact.id) == FootRole::Free
            && layout.widget_at(floor.page, contact.centroid).is_none();
        if is_free { place(self.part, target, contact.centroid) } else { None }
    }
}

/// The point in `target` of a place on `part` of the floor; `None` outside it, and where either has no area.
fn place(part: floor::Rect, target: Rect, at: Vec2) -> Option<Pos2> {
    if !part.contains(at) {
        return None;
    }
    let share = (at - part.min) / part.size();
    let at = target.lerp_inside(egui::vec2(share.x, 1.0 - share.y));
    (at.x.is_finite() && at.y.is_finite()).then_some(at)
}

/// The role of a contact; free if the floor has none for it.
fn role(floor: &Snapshot, contact: ContactId) -> FootRole {
    floor.feet.iter().find(|foot| foot.contact == contact).map_or(FootRole::Free, |foot| foot.role)
}
