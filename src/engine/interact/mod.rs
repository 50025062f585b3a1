//! From cursors to controls: assigns feet to controls.

mod assign;
mod belief;
mod candidate;
mod foot;
mod held;
mod off;
mod readings;
mod unanswered;

use self::readings::tiles_under;
use super::event::ControlEvent;
use super::feet::FootHistories;
use super::ignored::IgnoredPresses;
use super::region::{EngagedFoot, RegionState};
use super::rise::Rises;
use super::snapshot::FootState;
use crate::floor::Geometry;
use crate::layout::{HitIndex, Layout};
use crate::sense::{Contact, ContactId, Cursor, ForceFrame};
use crate::units::{Instant, Newtons};
use crate::widget::{Control, Emitted, Guard, Input};

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

    /// Whether any force of `contact` is new in this frame. A decision on a press takes new forces: between the
    /// samples of a slow board nothing is known of the foot.
    fn is_new(&self, contact: &Contact) -> bool {
        let mut tiles = contact.tiles.iter().peekable();
        match tiles.peek() {
            Some(_) => tiles.any(|load| self.frame.is_new_at(load.index)),
            None => self.frame.is_new,
        }
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

    fn held(&self) -> impl Iterator<Item = EngagedFoot> + Clone + '_ {
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
        events: &mut Vec<ControlEvent>,
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
        events: &mut Vec<ControlEvent>,
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
    pub(super) fn cancel_all(&mut self, layout: &Layout, now: Instant, events: &mut Vec<ControlEvent>) {
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
        events: &mut Vec<ControlEvent>,
    ) {
        let at = Moment { frame, contacts, layout };
        if frame.is_new {
            self.feet.update(contacts, &layout.stances, at.now());
            self.rises.update(contacts, at.now());
        }
        self.ignored.begin();
        self.inhibit(&at, events);
        self.lose_unsensed(&at, events);
        for index in 0..self.regions.len() {
            self.step_region(index, &at, events);
        }
        unanswered::note_ignored(self, &at);
        self.rest(&at, events);
    }

    /// Controls with no foot on them come to rest.
    fn rest(&mut self, at: &Moment<'_>, events: &mut Vec<ControlEvent>) {
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

    fn release_hold(&mut self, widget: usize) -> Option<EngagedFoot> {
        self.regions.iter_mut().find_map(|region| region.let_go(widget))
    }

    fn wake(&mut self, widget: usize) {
        if !self.awake.contains(&widget) {
            self.awake.push(widget);
        }
    }
}

/// Whether `widget` acts only while it is held.
fn holds_to_run(layout: &Layout, widget: usize) -> bool {
    let spec = layout.widgets.get(widget);
    spec.is_some_and(|spec| matches!(spec.behaviour.thresholds().guard, Guard::HoldToRun { .. }))
}

fn report(
    layout: &Layout,
    at: Instant,
    widget: usize,
    held: Option<EngagedFoot>,
    emitted: &Emitted,
    events: &mut Vec<ControlEvent>,
) {
    let Some(spec) = layout.widgets.get(widget) else { return };
    let (contact, force, position) = match held {
        Some(held) => (Some(held.contact), held.force, held.position),
        None => (None, Newtons::ZERO, spec.area.centre()),
    };
    events.extend(emitted.iter().map(|&kind| ControlEvent { at, widget, kind, contact, force, position }));
}
