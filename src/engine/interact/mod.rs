//! From cursors to controls: assigns feet to controls.

mod belief;
mod off;
mod unanswered;

use std::time::Duration;

use glam::Vec2;

use self::belief::{certainly_presses, is_believed, is_certain, is_sensed, is_unlearned};
use self::off::of_calibration;
use self::unanswered::switched_off;
use super::feet::{AS_GOOD_AS_LIFTED_N, FootHistories, FootHistory, PressMode};
use super::ignored::{Ignored, IgnoredPresses};
use super::region::{Finger, Held, RegionState};
use super::rise::Rises;
use super::snapshot::FootState;
use crate::floor::Geometry;
use crate::layout::{CursorRule, HitIndex, Layout, Widget};
use crate::sense::{Contact, ContactId, Cursor, ForceFrame, Quality};
use crate::units::{Instant, Newtons};
use crate::widget::{Behaviour, Control, Emitted, EventKind, Guard, Input, OffReason, WidgetEvent};

/// Distance beyond its edge within which a control keeps the foot that presses it (our choice: within the sway of a
/// foot that is meant to stay).
const SLIDE_OFF_MARGIN_M: f32 = 0.03;

/// Time after the landing within which a foot may enter a control without sliding on (our choice: a heel-first
/// landing rolls forward for about a quarter of a second).
const LANDING: Duration = Duration::from_millis(300);

/// The state of all controls of one layout.
#[derive(Debug)]
pub(super) struct Interaction {
    geometry: Geometry,
    hits: HitIndex,
    /// The current page.
    page: usize,
    regions: Vec<RegionState>,
    controls: Vec<Control>,
    /// Whether each control lies on a tile without sensing, and the list of those that do.
    unsensed: Vec<bool>,
    lost: Vec<usize>,
    /// The indices of the tiles that each control lies on.
    tiles_under: Vec<Vec<usize>>,
    /// Controls that even an empty floor can change.
    awake: Vec<usize>,
    feet: FootHistories,
    rises: Rises,
    ignored: IgnoredPresses,
    /// Whether a control of the region in work acts while it is held.
    running: bool,
}

/// The inputs of one frame.
#[derive(Clone, Copy)]
struct Moment<'a> {
    frame: &'a ForceFrame,
    contacts: &'a [Contact],
    layout: &'a Layout,
}

impl Moment<'_> {
    fn now(&self) -> Instant {
        self.frame.at
    }

    fn contact(&self, id: ContactId) -> Option<&Contact> {
        self.contacts.iter().find(|contact| contact.id == id)
    }
}

/// A foot on a control that it keeps pressed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sliding {
    pub(super) widget: usize,
    pub(super) contact: ContactId,
}

impl Interaction {
    /// All controls at their initial values; each works once it has been seen unloaded.
    pub(super) fn new(layout: &Layout, geometry: &Geometry, page: usize) -> Self {
        let controls: Vec<_> =
            layout.widgets.iter().map(|widget| Control::new(&widget.behaviour, widget.area.size())).collect();
        let hits = HitIndex::new(layout, geometry);
        Self {
            tiles_under: tiles_under(layout, geometry, &hits),
            geometry: *geometry,
            hits,
            page,
            regions: layout.regions.iter().map(|_| RegionState::default()).collect(),
            unsensed: vec![false; controls.len()],
            lost: Vec::with_capacity(controls.len()),
            awake: (0..controls.len()).collect(),
            controls,
            feet: FootHistories::default(),
            rises: Rises::default(),
            ignored: IgnoredPresses::default(),
            running: false,
        }
    }

    /// Takes over the feet that `other` tracks.
    pub(super) fn inherit(&mut self, other: &mut Self) {
        self.feet = std::mem::take(&mut other.feet);
        self.rises = std::mem::take(&mut other.rises);
        self.ignored = std::mem::take(&mut other.ignored);
        self.ignored.forget();
    }

    pub(super) fn controls(&self) -> &[Control] {
        &self.controls
    }

    pub(super) fn control_mut(&mut self, widget: usize) -> Option<&mut Control> {
        self.controls.get_mut(widget)
    }

    /// The presses without a response.
    pub(super) fn ignored(&self) -> &IgnoredPresses {
        &self.ignored
    }

    /// The current page.
    pub(super) fn page(&self) -> usize {
        self.page
    }

    /// Shows another page. Values stay; a foot that stands where a control appears must lift first.
    ///
    /// No control may be engaged.
    pub(super) fn show(&mut self, page: usize, layout: &Layout) {
        let before = std::mem::replace(&mut self.page, page);
        for (index, (widget, control)) in layout.widgets.iter().zip(&mut self.controls).enumerate() {
            if widget.is_on(before) != widget.is_on(page) {
                control.cancel();
                if !self.awake.contains(&index) {
                    self.awake.push(index);
                }
            }
        }
        self.regions.iter_mut().flat_map(|region| &mut region.fingers).for_each(|finger| finger.over = None);
    }

    /// One entry per region, then the further cursors of those where each contact is one.
    pub(super) fn cursors(&self) -> impl Iterator<Item = Option<Cursor>> + '_ {
        let more = self.regions.iter().flat_map(|region| region.more_cursors().map(Some));
        self.regions.iter().map(RegionState::cursor).chain(more)
    }

    /// The state of each contact.
    pub(super) fn feet(&self, now: Instant) -> impl Iterator<Item = FootState> + '_ {
        self.feet.states(now)
    }

    fn held(&self) -> impl Iterator<Item = Held> + Clone + '_ {
        self.regions.iter().flat_map(RegionState::held)
    }

    pub(super) fn is_engaged(&self) -> bool {
        self.held().next().is_some()
    }

    /// The controls that are engaged, by index.
    pub(super) fn engaged(&self) -> impl Iterator<Item = usize> + '_ {
        self.held().map(|held| held.widget)
    }

    /// Whether a control keeps the foot `contact`.
    pub(super) fn holds(&self, contact: ContactId) -> bool {
        self.held().any(|held| held.contact == contact)
    }

    /// Feet that slide on a control that captures them.
    pub(super) fn sliding(&self) -> impl Iterator<Item = Sliding> + '_ {
        self.held()
            .filter(|held| self.controls.get(held.widget).is_some_and(Control::captures))
            .map(|held| Sliding { widget: held.widget, contact: held.contact })
    }

    /// Feet that keep a control pressed.
    pub(super) fn holding(&self) -> impl Iterator<Item = Sliding> + Clone + '_ {
        self.held().map(|held| Sliding { widget: held.widget, contact: held.contact })
    }

    /// Changes the state of a control by `change`, which disables, enables, locks or unlocks it.
    pub(super) fn change(
        &mut self,
        widget: usize,
        change: impl FnOnce(&mut Control) -> Emitted,
        layout: &Layout,
        now: Instant,
        events: &mut Vec<WidgetEvent>,
    ) {
        let Some(control) = self.controls.get_mut(widget) else { return };
        let emitted = change(control);
        let held = self.release_hold(widget);
        report(layout, now, widget, held, &emitted, events);
        self.wake(widget);
    }

    /// Ends the press of one control without committing it.
    pub(super) fn cancel(
        &mut self,
        widget: usize,
        layout: &Layout,
        now: Instant,
        events: &mut Vec<WidgetEvent>,
    ) {
        let Some(control) = self.controls.get_mut(widget) else { return };
        let emitted = control.cancel();
        let held = self.release_hold(widget);
        report(layout, now, widget, held, &emitted, events);
        self.wake(widget);
    }

    /// Ends every press and disarms every control, without committing anything.
    ///
    /// Goes through the controls themselves, not through the regions that assign feet to them, so that it also works
    /// after a step that was interrupted.
    pub(super) fn cancel_all(&mut self, layout: &Layout, now: Instant, events: &mut Vec<WidgetEvent>) {
        for widget in 0..self.controls.len() {
            if self.controls.get(widget).is_some_and(|control| !control.is_at_rest()) {
                self.cancel(widget, layout, now, events);
            }
        }
    }

    /// Processes one frame.
    pub(super) fn step(
        &mut self,
        frame: &ForceFrame,
        contacts: &[Contact],
        layout: &Layout,
        events: &mut Vec<WidgetEvent>,
    ) {
        let at = Moment { frame, contacts, layout };
        self.feet.update(contacts, &layout.stances, at.now());
        self.rises.update(contacts, at.now());
        self.ignored.begin();
        self.inhibit(&at, events);
        self.lose_unsensed(&at, events);
        for index in 0..self.regions.len() {
            self.step_region(index, &at, events);
        }
        self.note_ignored(&at);
        self.rest(&at, events);
    }

    fn step_region(&mut self, index: usize, at: &Moment<'_>, events: &mut Vec<WidgetEvent>) {
        let Some((state, region)) = self.regions.get_mut(index).zip(at.layout.regions.get(index)) else {
            return;
        };
        let (feet, hits, page) = (&self.feet, &self.hits, self.page);
        let works = |contact: &Contact, foot: &FootHistory| {
            let widget = hits.widget_at(at.layout, page, contact.centroid);
            let spec = widget.and_then(|widget| at.layout.widgets.get(widget));
            spec.is_some_and(|spec| spec.region == index && !foot.is_step_on(PressMode::of(spec), at.now()))
        };
        let may = |contact: &Contact| {
            let all = region.cursor != CursorRule::Working;
            feet.of(contact.id).is_none_or(|foot| foot.may_lead() && (all || works(contact, foot)))
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
        events: &mut Vec<WidgetEvent>,
    ) {
        for this in 0..fingers.len() {
            let Some(&finger) = fingers.get(this).filter(|finger| finger.held.is_none()) else { continue };
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
        events: &mut Vec<WidgetEvent>,
    ) {
        let now = at.now();
        let Some(contact) = at.contact(finger.cursor.contact) else { return };
        let rivals = self.runs_elsewhere(widget, at.layout);
        let (Some(spec), Some(control)) = (at.layout.widgets.get(widget), self.controls.get_mut(widget))
        else {
            return;
        };
        let (foot, weight) = (self.feet.of(contact.id), self.feet.weight(contact.id));
        let (mode, thresholds) = (PressMode::of(spec), spec.behaviour.thresholds().for_weight(weight));
        let slid_on = is_new
            && contact.force >= thresholds.release
            && foot.is_some_and(|foot| now.since(foot.landed) > LANDING);
        // A foot with unreliable force at the press stays unreliable when it lightens.
        let presses = contact.force >= thresholds.press;
        let believed = is_believed(contact, thresholds.guard, at.frame);
        // The noise estimate comes soon: the foot may stay.
        let waits = matches!(thresholds.guard, Guard::HoldToRun { .. }) && is_unlearned(contact, at.frame);
        let unbelieved = presses && !believed && !waits;
        let (input, why) =
            if let Some(foot) = foot.filter(|foot| foot.is_step_on(mode, now) || foot.is_object()) {
                let why = if foot.is_object() { Ignored::Object } else { Ignored::Step };
                (Input::Stepping { force: contact.force }, Some(why))
            } else if slid_on || unbelieved {
                let why = if slid_on { Ignored::SlidOn } else { Ignored::Unbelieved };
                (Input::SlidOn { force: contact.force }, Some(why))
            } else {
                let risen = self.rises.has_risen(contact) || !presses;
                let meant = foot.is_none_or(|foot| foot.is_meant(mode, thresholds.guard, now));
                let enough = !presses || certainly_presses(contact, &thresholds, at.frame);
                let why = [
                    (control.needs_lift(), Ignored::NotSeenUnloaded),
                    (!risen || !enough || waits, Ignored::Unbelieved),
                    (!meant, Ignored::Guard),
                    (rivals, Ignored::Off(OffReason::OtherHeld)),
                ];
                let why = why.into_iter().find(|(is_so, _)| presses && *is_so).map(|(_, why)| why);
                let may = believed && risen && enough && meant && !rivals;
                (self::foot(contact, spec, at.frame, weight, may), why)
            };
        let why = switched_off(control).or(why);
        let emitted = control.step(now, input);
        if contact.force.0 >= AS_GOOD_AS_LIFTED_N {
            self.ignored.note(contact.id, widget, contact.force, why);
        }
        if control.is_engaged() || !emitted.is_empty() {
            self.ignored.note_answer(contact.id, widget, contact.force);
        }
        let held = Held { widget, contact: contact.id, force: contact.force, position: contact.centroid };
        if control.is_engaged() {
            finger.held = Some(held);
            self.running |= holds_to_run(at.layout, widget);
            self.feet.note_press(contact.id);
        }
        report(at.layout, now, widget, Some(held), &emitted, events);
        self.wake(widget);
    }

    /// Whether `widget` acts while it is held, and another such control is held already: only one runs at a time.
    fn runs_elsewhere(&self, widget: usize, layout: &Layout) -> bool {
        holds_to_run(layout, widget)
            && (self.running || self.held().any(|held| holds_to_run(layout, held.widget)))
    }

    /// An engaged control follows its own foot, independent of the cursor.
    fn step_held(&mut self, finger: &mut Finger, at: &Moment<'_>, events: &mut Vec<WidgetEvent>) {
        let Some(mut held) = finger.held else { return };
        let (Some(spec), Some(control)) =
            (at.layout.widgets.get(held.widget), self.controls.get_mut(held.widget))
        else {
            finger.held = None;
            return;
        };
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
                let is_step = |foot: &FootHistory| foot.is_step_on(mode, at.now()) || foot.is_object();
                if falls || foot.is_some_and(is_step) {
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
                    self::foot(contact, spec, at.frame, self.feet.weight(contact.id), believed)
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

    /// Controls with no foot on them come to rest.
    fn rest(&mut self, at: &Moment<'_>, events: &mut Vec<WidgetEvent>) {
        let mut awake = std::mem::take(&mut self.awake);
        awake.retain(|&widget| {
            let touched =
                self.regions.iter().flat_map(|region| &region.fingers).any(|finger| finger.has(widget));
            let Some(control) = self.controls.get_mut(widget) else { return false };
            let unsensed = self.unsensed.get(widget).is_some_and(|unsensed| *unsensed);
            if touched || unsensed {
                return true;
            }
            let emitted = control.step(at.now(), Input::Clear);
            report(at.layout, at.now(), widget, None, &emitted, events);
            !control.is_at_rest()
        });
        self.awake = awake;
    }

    /// Inhibits controls that act while they are held: on a floor with doubtful calibration, and where the readings
    /// below them are unsuitable.
    fn inhibit(&mut self, at: &Moment<'_>, events: &mut Vec<WidgetEvent>) {
        let fault = at.frame.calibration_fault.map(of_calibration);
        for widget in (0..self.controls.len()).filter(|&widget| holds_to_run(at.layout, widget)) {
            let inhibited = fault.or_else(|| self.of_readings(widget, at.frame));
            if self.controls.get(widget).is_some_and(|control| control.inhibited() != inhibited) {
                let switch = |control: &mut Control| control.set_inhibited(inhibited);
                self.change(widget, switch, at.layout, at.now(), events);
            }
        }
    }

    /// Cancels controls on tiles without sensing.
    fn lose_unsensed(&mut self, at: &Moment<'_>, events: &mut Vec<WidgetEvent>) {
        for widget in self.lost.drain(..) {
            if let Some(unsensed) = self.unsensed.get_mut(widget) {
                *unsensed = false;
            }
        }
        let quality = &at.frame.quality;
        if quality.len() >= self.geometry.tile_count()
            && quality.iter().flatten().all(|quality| *quality < Quality::Stale)
        {
            return;
        }
        for tile in 0..self.geometry.tile_count() {
            if quality.get(tile).is_some_and(is_sensed) {
                continue;
            }
            let plate = self.geometry.plate(self.geometry.tile_at_index(tile));
            for &widget in self.hits.on_tile(tile) {
                let lies_there = at.layout.widgets.get(widget).is_some_and(|spec| plate.overlaps(spec.area));
                if let Some(unsensed) = self.unsensed.get_mut(widget).filter(|lost| lies_there && !**lost) {
                    *unsensed = true;
                    self.lost.push(widget);
                }
            }
        }
        // In the layout's order, independent of the tiles.
        self.lost.sort_unstable();
        for which in 0..self.lost.len() {
            let widget = self.lost[which];
            let Some(control) = self.controls.get_mut(widget) else { continue };
            let emitted = control.step(at.now(), Input::Lost);
            let held = self.release_hold(widget);
            report(at.layout, at.now(), widget, held, &emitted, events);
            self.wake(widget);
        }
    }

    fn release_hold(&mut self, widget: usize) -> Option<Held> {
        self.regions.iter_mut().find_map(|region| region.let_go(widget))
    }

    fn wake(&mut self, widget: usize) {
        if !self.awake.contains(&widget) {
            self.awake.push(widget);
        }
    }
}

/// For each control of `layout`, the indices of the tiles below it.
fn tiles_under(layout: &Layout, geometry: &Geometry, hits: &HitIndex) -> Vec<Vec<usize>> {
    let mut under = vec![Vec::new(); layout.widgets.len()];
    for tile in 0..geometry.tile_count() {
        let plate = geometry.plate(geometry.tile_at_index(tile));
        for &widget in hits.on_tile(tile) {
            if let (Some(spec), Some(tiles)) = (layout.widgets.get(widget), under.get_mut(widget))
                && plate.overlaps(spec.area)
            {
                tiles.push(tile);
            }
        }
    }
    under
}

/// The input of `widget` from a foot of a person of this `weight`; `may` is whether that foot may act on it.
fn foot(contact: &Contact, widget: &Widget, frame: &ForceFrame, weight: Option<Newtons>, may: bool) -> Input {
    let trusted =
        may && contact.tiles.iter().all(|load| frame.quality.get(load.index).is_some_and(is_sensed));
    Input::Foot { force: contact.force, trusted, place: place(contact.centroid, widget), weight }
}

/// Whether `widget` acts only while it is held.
fn holds_to_run(layout: &Layout, widget: usize) -> bool {
    let spec = layout.widgets.get(widget);
    spec.is_some_and(|spec| matches!(spec.behaviour.thresholds().guard, Guard::HoldToRun { .. }))
}

impl PressMode {
    fn of(widget: &Widget) -> Self {
        let held = matches!(widget.behaviour.thresholds().guard, Guard::HoldToRun { .. });
        match &widget.behaviour {
            Behaviour::Lean(_) => Self::Stand,
            Behaviour::Button(button) if !button.gestures.lasts() && !held => Self::Tap,
            Behaviour::Switch(_) | Behaviour::Selector(_) if !held => Self::Tap,
            Behaviour::Button(_) | Behaviour::Switch(_) | Behaviour::Selector(_) | Behaviour::Stepper(_) => {
                Self::Hold
            }
            Behaviour::Hold(_)
            | Behaviour::Slider(_)
            | Behaviour::Pedal(_)
            | Behaviour::Pad(_)
            | Behaviour::Dial(_) => Self::Follow,
        }
    }
}

fn is_sensed_at(point: Vec2, geometry: &Geometry, frame: &ForceFrame) -> bool {
    let tile = geometry.tile_under(point).and_then(|tile| geometry.index(tile));
    tile.and_then(|tile| frame.quality.get(tile)).is_none_or(is_sensed)
}

fn place(position: Vec2, widget: &Widget) -> Vec2 {
    (position - widget.area.min) / widget.area.size()
}

fn report(
    layout: &Layout,
    at: Instant,
    widget: usize,
    held: Option<Held>,
    emitted: &Emitted,
    events: &mut Vec<WidgetEvent>,
) {
    let Some(spec) = layout.widgets.get(widget) else { return };
    let (contact, force, position) = match held {
        Some(held) => (Some(held.contact), held.force, held.position),
        None => (None, Newtons::ZERO, spec.area.centre()),
    };
    events.extend(emitted.iter().map(|&kind| WidgetEvent {
        at,
        id: spec.id.clone(),
        kind,
        contact,
        force,
        position,
    }));
}
