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

use crate::touch::Touch;

/// Force from which on a foot touches, and below which it lets go: those of the shipped buttons.
const PRESS: Newtons = Newtons(60.0);
const RELEASE: Newtons = Newtons(40.0);

/// How long a foot must press before it touches, in seconds: one that walks across is mostly known for a step by then.
const DWELL_S: f64 = 0.06;

/// How old a snapshot may be, in seconds: beyond it, its feet may have moved or left.
const STALE_S: f64 = 0.15;

/// How far a press may roll and still click, in points; how long it may last, in seconds. egui's own are for
/// fingers: 6 points, 0.8 s. A foot rolls by some centimetres and needs a second.
const CLICK_DISTANCE: f32 = 40.0;
const CLICK_S: f64 = 5.0;

/// A foot that has not touched (yet).
#[derive(Clone, Copy, Debug)]
enum Before {
    /// It presses since then, in seconds of egui's clock.
    Presses(f64),
    /// It came from elsewhere, or was cancelled: it must let go first.
    MustLift,
}

/// Contacts on a part of the floor as touches, and the first of them as egui's one pointer.
///
/// Each foot is a touch with an id of its own, for [`crate::FootSlider`] and egui's gestures of several fingers. The
/// first is the pointer as well, until it lets go; a foot that came later does not take its place.
///
/// A touch begins when a free foot presses with 60 N for 60 ms, where no control of the layout is; it ends below 40 N.
/// It is cancelled, which neither clicks nor changes a value, when the foot turns out to take a step or to be an
/// object, when it leaves the mapped part, when the floor falls silent or ends, and by [`FootInput::cancel`].
/// What an egui slider has followed until then it keeps; a [`crate::FootSlider`] takes it back.
#[derive(Clone, Debug)]
pub struct FootInput {
    part: floor::Rect,
    target: Option<Rect>,
    touches: Vec<Touch>,
    others: Vec<(ContactId, Before)>,
    /// The latest snapshot's time, and when it came, in seconds of egui's clock.
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

    /// Lets presses of `context` roll and last as those of feet do, before they no longer count as clicks: by 40
    /// points, for 5 s.
    ///
    /// The same holds for the mouse of this app then; egui has one limit for all pointers.
    pub fn tune(context: &Context) {
        context.options_mut(|options| {
            options.input_options.max_click_dist = CLICK_DISTANCE;
            options.input_options.max_click_duration = CLICK_S;
        });
    }

    /// Puts into `raw` what the feet of `floor` do; to be called for each picture, in `eframe::App::raw_input_hook`.
    ///
    /// With `move || context.request_repaint()` as [`underfoot::runtime::SessionBuilder::wake`] pictures come when
    /// controls are pressed; a foot on free floor makes no event, so this asks for the next picture by itself while
    /// anything stands on the floor.
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

    /// As [`FootInput::follow`], from a snapshot and the layout that it belongs to.
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

    /// Cancels all touches; feet that are down must let go before they touch again.
    pub fn cancel(&mut self, context: &Context, raw: &mut RawInput) {
        for touch in self.touches.drain(..) {
            touch.cancel(context, &mut raw.events);
            self.others.push((touch.contact, Before::MustLift));
        }
    }

    /// How many feet touch.
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
            // A foot that is about to let go rolls: what it pointed at is where it last pressed.
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
                    let touch = Touch { contact: contact.id, at, force: contact.force, is_pointer };
                    touch.start(events);
                    self.touches.push(touch);
                }
                (Some(_), _) => {}
            }
        }
    }

    /// Where a free foot points, if it is on the mapped part and on no control.
    fn free_place(&self, layout: &Layout, floor: &Snapshot, target: Rect, contact: &Contact) -> Option<Pos2> {
        let is_free = role(floor, contact.id) == FootRole::Free
            && layout.widget_at(floor.page, contact.centroid).is_none();
        if is_free { place(self.part, target, contact.centroid) } else { None }
    }
}

/// Where in `target` a place on `part` of the floor is; `None` beside it, and where either has no area.
fn place(part: floor::Rect, target: Rect, at: Vec2) -> Option<Pos2> {
    if !part.contains(at) {
        return None;
    }
    let share = (at - part.min) / part.size();
    let at = target.lerp_inside(egui::vec2(share.x, 1.0 - share.y));
    (at.x.is_finite() && at.y.is_finite()).then_some(at)
}

/// What a contact is taken for; free where nothing is known of it.
fn role(floor: &Snapshot, contact: ContactId) -> FootRole {
    floor.feet.iter().find(|foot| foot.contact == contact).map_or(FootRole::Free, |foot| foot.role)
}
