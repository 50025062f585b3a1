//! From cursors to controls: which control gets which foot.

use std::time::Duration;

use glam::Vec2;

use super::rise::Rises;
use crate::floor::Geometry;
use crate::layout::{Layout, Widget};
use crate::sense::{Contact, ContactId, Cursor, CursorPicker, ForceFrame, Quality};
use crate::units::{Instant, Newtons};
use crate::widget::{Control, Emitted, Input, WidgetEvent};

/// How far beyond its edge a control keeps the foot that presses it (our choice: within the sway of a foot that means to stay).
const SLIDE_OFF_MARGIN_M: f32 = 0.03;

/// How long a landing foot's centroid may travel before entering a control counts as sliding on
/// (our choice: a heel-first landing rolls forward for about a quarter of a second).
const LANDING: Duration = Duration::from_millis(300);

/// The controls of one layout at work.
#[derive(Debug)]
pub(super) struct Interaction {
    geometry: Geometry,
    regions: Vec<RegionState>,
    controls: Vec<Control>,
    /// Tiles under each control, by index.
    tiles: Vec<Vec<usize>>,
    /// Whether each control lies on a tile that can't be sensed.
    unsensed: Vec<bool>,
    /// Controls for which even an empty floor changes something.
    awake: Vec<usize>,
    landed: Vec<(ContactId, Instant)>,
    rises: Rises,
}

#[derive(Debug)]
struct RegionState {
    picker: CursorPicker,
    cursor: Option<Cursor>,
    /// The control under the cursor and its foot, since the last frame.
    over: Option<(usize, ContactId)>,
    /// The control that keeps its foot.
    held: Option<Held>,
}

/// A foot that a control has engaged.
#[derive(Clone, Copy, Debug)]
struct Held {
    widget: usize,
    contact: ContactId,
    force: Newtons,
    position: Vec2,
}

/// A foot sliding on a control that keeps it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sliding {
    pub(super) widget: usize,
    pub(super) contact: ContactId,
}

impl Interaction {
    /// All controls at their initial values; each must first be seen unloaded.
    pub(super) fn new(layout: &Layout, geometry: &Geometry) -> Self {
        let regions = layout.regions.iter().map(|_| RegionState::new()).collect();
        let controls: Vec<_> =
            layout.widgets.iter().map(|widget| Control::new(&widget.behaviour, widget.area.size())).collect();
        let tiles = layout.widgets.iter().map(|widget| tiles_under(widget, geometry)).collect();
        let awake = (0..controls.len()).collect();
        let unsensed = vec![false; controls.len()];
        let rises = Rises::default();
        Self { geometry: *geometry, regions, controls, tiles, unsensed, awake, landed: Vec::new(), rises }
    }

    pub(super) fn controls(&self) -> &[Control] {
        &self.controls
    }

    pub(super) fn control_mut(&mut self, widget: usize) -> Option<&mut Control> {
        self.controls.get_mut(widget)
    }

    pub(super) fn cursors(&self) -> impl Iterator<Item = Option<Cursor>> + '_ {
        self.regions.iter().map(|region| region.cursor)
    }

    pub(super) fn is_engaged(&self) -> bool {
        self.regions.iter().any(|region| region.held.is_some())
    }

    /// The controls that are engaged, by index.
    pub(super) fn engaged(&self) -> impl Iterator<Item = usize> + '_ {
        self.regions.iter().filter_map(|region| region.held).map(|held| held.widget)
    }

    /// Whether a control keeps the foot `contact`.
    pub(super) fn holds(&self, contact: ContactId) -> bool {
        self.regions.iter().filter_map(|region| region.held).any(|held| held.contact == contact)
    }

    /// Feet that slide on a control that keeps them.
    pub(super) fn sliding(&self) -> impl Iterator<Item = Sliding> + '_ {
        self.regions
            .iter()
            .filter_map(|region| region.held)
            .filter(|held| self.controls.get(held.widget).is_some_and(Control::captures))
            .map(|held| Sliding { widget: held.widget, contact: held.contact })
    }

    /// Switches a control off or on, or locks it, which `change` does.
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

    /// Takes in one frame.
    pub(super) fn step(
        &mut self,
        frame: &ForceFrame,
        contacts: &[Contact],
        layout: &Layout,
        events: &mut Vec<WidgetEvent>,
    ) {
        let now = frame.at;
        self.note_landings(contacts, now);
        self.rises.update(contacts, now);
        self.lose_unsensed(frame, layout, events);
        for index in 0..self.regions.len() {
            self.step_region(index, frame, contacts, layout, events);
        }
        self.rest(layout, now, events);
    }

    fn step_region(
        &mut self,
        index: usize,
        frame: &ForceFrame,
        contacts: &[Contact],
        layout: &Layout,
        events: &mut Vec<WidgetEvent>,
    ) {
        let Some((region, area)) =
            self.regions.get_mut(index).zip(layout.regions.get(index).map(|region| region.area))
        else {
            return;
        };
        let now = frame.at;
        region.cursor = region.picker.update(area, contacts, now);
        if region.held.is_some() {
            self.step_held(index, frame, contacts, layout, events);
            return;
        }
        let over = region.cursor.and_then(|cursor| {
            let widget = layout.widget_at(cursor.position)?;
            (layout.widgets.get(widget)?.region == index).then_some((widget, cursor))
        });
        let entered = over.map(|(widget, cursor)| (widget, cursor.contact));
        let is_new = entered != region.over;
        region.over = entered;
        let Some((widget, cursor)) = over else { return };
        let Some(contact) = contacts.iter().find(|contact| contact.id == cursor.contact) else { return };
        let (Some(spec), Some(control)) = (layout.widgets.get(widget), self.controls.get_mut(widget)) else {
            return;
        };
        let slid_on = is_new
            && contact.force >= spec.behaviour.thresholds().release
            && self.landed.iter().any(|&(id, at)| id == contact.id && now.since(at) > LANDING);
        // A foot whose force could not be believed when it pressed is not believed once it lightens.
        let unbelieved = contact.force >= spec.behaviour.thresholds().press && !may_start(contact, frame);
        let input = if slid_on || unbelieved {
            Input::SlidOn { force: contact.force }
        } else {
            foot(contact, spec, frame, self.rises.has_risen(contact))
        };
        let emitted = control.step(now, input);
        let held = Held { widget, contact: contact.id, force: contact.force, position: contact.centroid };
        if control.is_engaged()
            && let Some(region) = self.regions.get_mut(index)
        {
            region.held = Some(held);
            region.picker.hold(Some(contact.id));
        }
        report(layout, now, widget, Some(held), &emitted, events);
        self.wake(widget);
    }

    /// A control that is engaged follows its own foot, whatever the cursor does.
    fn step_held(
        &mut self,
        index: usize,
        frame: &ForceFrame,
        contacts: &[Contact],
        layout: &Layout,
        events: &mut Vec<WidgetEvent>,
    ) {
        let Some(region) = self.regions.get_mut(index) else { return };
        let Some(mut held) = region.held else { return };
        let (Some(spec), Some(control)) =
            (layout.widgets.get(held.widget), self.controls.get_mut(held.widget))
        else {
            region.held = None;
            return;
        };
        let input = match contacts.iter().find(|contact| contact.id == held.contact) {
            Some(contact) => {
                held.force = contact.force;
                held.position = contact.centroid;
                let off = spec.area.distance(contact.centroid) > SLIDE_OFF_MARGIN_M;
                if off && !control.captures() { Input::SlidOff } else { foot(contact, spec, frame, true) }
            }
            // Gone from a floor that is sensed, it was lifted; gone with the sensors, nobody knows.
            None if is_sensed_at(held.position, &self.geometry, frame) => Input::Foot {
                force: Newtons::ZERO,
                trusted: true,
                place: place(held.position, spec),
                weight: None,
            },
            None => Input::Lost,
        };
        let emitted = control.step(frame.at, input);
        region.held = control.is_engaged().then_some(held);
        if region.held.is_none() {
            region.picker.hold(None);
            region.over = None;
        }
        report(layout, frame.at, held.widget, Some(held), &emitted, events);
        self.wake(held.widget);
    }

    /// Controls with no foot on them come to rest.
    fn rest(&mut self, layout: &Layout, now: Instant, events: &mut Vec<WidgetEvent>) {
        let mut awake = std::mem::take(&mut self.awake);
        awake.retain(|&widget| {
            let touched = self.regions.iter().any(|region| {
                region.held.is_some_and(|held| held.widget == widget)
                    || region.over.is_some_and(|(over, _)| over == widget)
            });
            let Some(control) = self.controls.get_mut(widget) else { return false };
            let unsensed = self.unsensed.get(widget).is_some_and(|unsensed| *unsensed);
            if touched || unsensed {
                return true;
            }
            let emitted = control.step(now, Input::Clear);
            report(layout, now, widget, None, &emitted, events);
            !control.is_at_rest()
        });
        self.awake = awake;
    }

    /// Controls on a tile that can't be sensed are lost.
    fn lose_unsensed(&mut self, frame: &ForceFrame, layout: &Layout, events: &mut Vec<WidgetEvent>) {
        if frame.quality.iter().flatten().all(|quality| *quality < Quality::Stale) {
            self.unsensed.fill(false);
            return;
        }
        let is_unsensed = |tile: &usize| frame.quality.get(*tile).is_none_or(|tile| !is_sensed(tile));
        for widget in 0..self.controls.len() {
            let lost = self.tiles.get(widget).is_some_and(|tiles| tiles.iter().any(is_unsensed));
            if let Some(unsensed) = self.unsensed.get_mut(widget) {
                *unsensed = lost;
            }
            let Some(control) = self.controls.get_mut(widget).filter(|_| lost) else { continue };
            let emitted = control.step(frame.at, Input::Lost);
            let held = self.release_hold(widget);
            report(layout, frame.at, widget, held, &emitted, events);
            self.wake(widget);
        }
    }

    fn release_hold(&mut self, widget: usize) -> Option<Held> {
        let region =
            self.regions.iter_mut().find(|region| region.held.is_some_and(|held| held.widget == widget))?;
        region.picker.hold(None);
        region.over = None;
        region.held.take()
    }

    fn note_landings(&mut self, contacts: &[Contact], now: Instant) {
        self.landed.retain(|(id, _)| contacts.iter().any(|contact| contact.id == *id));
        for contact in contacts {
            if !self.landed.iter().any(|(id, _)| *id == contact.id) {
                self.landed.push((contact.id, now));
            }
        }
    }

    fn wake(&mut self, widget: usize) {
        if !self.awake.contains(&widget) {
            self.awake.push(widget);
        }
    }
}

impl RegionState {
    fn new() -> Self {
        Self { picker: CursorPicker::default(), cursor: None, over: None, held: None }
    }
}

/// What `widget` senses of a foot; `risen` says whether that foot has pressed harder of late.
///
/// A force that has crept past the threshold starts nothing.
fn foot(contact: &Contact, widget: &Widget, frame: &ForceFrame, risen: bool) -> Input {
    let trusted = contact.tiles.iter().all(|load| frame.quality.get(load.index).is_some_and(is_sensed))
        && may_start(contact, frame)
        && (risen || contact.force < widget.behaviour.thresholds().press);
    Input::Foot { force: contact.force, trusted, place: place(contact.centroid, widget), weight: None }
}

fn is_sensed_at(point: Vec2, geometry: &Geometry, frame: &ForceFrame) -> bool {
    let tile = geometry.tile_under(point).and_then(|tile| geometry.index(tile));
    tile.and_then(|tile| frame.quality.get(tile)).is_none_or(is_sensed)
}

/// Whether `contact` may start an engagement as far as the forces are to be believed.
///
/// `Degraded` tiles may: one with a dead sensor, whose force the other three tell, and one
/// that loses packets. A tile with a saturated sensor, or one that reads what its plate
/// does not bear, may not; see [`ForceFrame::may_start`].
fn may_start(contact: &Contact, frame: &ForceFrame) -> bool {
    contact.tiles.iter().all(|load| frame.may_start.get(load.index).is_some_and(|&may| may))
}

/// A tile goes on with three sensors.
fn is_sensed(tile: &[Quality; 4]) -> bool {
    tile.iter().filter(|quality| **quality < Quality::Stale).count() >= 3
}

fn place(position: Vec2, widget: &Widget) -> Vec2 {
    (position - widget.area.min) / widget.area.size()
}

fn tiles_under(widget: &Widget, geometry: &Geometry) -> Vec<usize> {
    geometry
        .tiles()
        .enumerate()
        .filter(|(_, tile)| geometry.plate(*tile).overlaps(widget.area))
        .map(|(index, _)| index)
        .collect()
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
