//! The engine: sensing, interaction, grounds and responses, one frame at a time.

use std::time::Duration;

use crate::feel::{Cue, SustainedCues};
use crate::floor::{FloorFile, Geometry, PositionMap};
use crate::ground::{GroundEvent, Grounds};
use crate::layout::Layout;
use crate::sense::{Contact, ForceFrame, Method, Sensing};
use crate::units::Instant;
use crate::widget::{
    Behaviour, Control, Emitted, EventKind, Indicator, OffReason, SetError, Value, WidgetEvent, WidgetId,
};

use super::event::ControlEvent;
use super::ignored::{IgnoredPress, SHOWN};
use super::interact::Interaction;
use super::overrides::Overrides;
use super::response::{Now, Responses};
use super::{PageShown, Snapshot, TileState, WidgetState};

/// A floor with a page of controls on it: takes frames, returns events and cues.
///
/// It reads no clock and draws no random number: its output depends on the frames and the calls alone. In steady
/// state it allocates nothing.
#[derive(Debug)]
pub struct Engine {
    geometry: Geometry,
    layout: Layout,
    /// A layout that waits until every foot has let go, with its revision.
    waiting_layout: Option<(Layout, u64)>,
    /// Number of layouts given so far, without the first one.
    layouts_given: u64,
    layout_revision: u64,
    pages: PageTurns,
    overrides: Overrides,
    sensing: Sensing,
    interaction: Interaction,
    grounds: Grounds,
    responses: Responses,
    /// The file that the floor was read from.
    floor_file: FloorFile,
    last_frame: ForceFrame,
    /// Whether a frame has been processed.
    has_begun: bool,
    /// Events of calls between two steps; the next step reports them.
    pending: Vec<WidgetEvent>,
    /// Events of one call, before they get ids.
    indexed: Vec<ControlEvent>,
    events: Vec<WidgetEvent>,
    cues: Vec<Cue>,
    sustained: SustainedCues,
}

/// The pages on their way to the feet and to the apps.
#[derive(Debug, Default)]
struct PageTurns {
    /// A page that waits until every foot has let go.
    waiting: Option<usize>,
    /// A page shown since the last step.
    shown: Option<PageShown>,
    /// The page that the last step reports.
    reported: Option<PageShown>,
}

/// The results of one frame.
#[derive(Clone, Copy, Debug)]
pub struct FrameResults<'a> {
    /// Events of the controls, in order.
    pub events: &'a [WidgetEvent],
    /// The page that has replaced another since the last frame.
    pub page: Option<&'a PageShown>,
    /// Clicks to render.
    pub cues: &'a [Cue],
    /// Sustained cues, such as the friction under feet that slide.
    pub sustained: &'a SustainedCues,
    /// Presses without a response of a control, reported when the foot leaves.
    pub ignored: &'a [IgnoredPress],
    /// Ground events of the frame; their cues are among `cues`.
    pub grounds: &'a [GroundEvent],
    /// The feet on the floor.
    pub contacts: &'a [Contact],
}

/// Capacity for events and cues of controls in one frame, without an allocation: more than feet can cause.
const CUES: usize = 64;

impl Engine {
    /// An engine for the controls of `layout` on a floor of this geometry.
    ///
    /// Every control works only once it has been seen unloaded.
    #[must_use]
    pub fn new(geometry: Geometry, layout: Layout, method: Method) -> Self {
        let interaction = Interaction::new(&layout, &geometry, 0);
        let mut responses = Responses::default();
        responses.begin(&layout, interaction.controls());
        let grounds = Grounds::new(layout.grounds.iter().map(|ground| ground.spec), &geometry);
        let cues = Vec::with_capacity(CUES + grounds.most_events());
        Self {
            interaction,
            grounds,
            sensing: Sensing::new(geometry, method),
            floor_file: FloorFile::NONE,
            last_frame: ForceFrame::empty(&geometry),
            has_begun: false,
            geometry,
            layout,
            waiting_layout: None,
            layouts_given: 0,
            layout_revision: 0,
            pages: PageTurns::default(),
            overrides: Overrides::default(),
            responses,
            pending: Vec::with_capacity(CUES),
            indexed: Vec::with_capacity(CUES),
            events: Vec::with_capacity(CUES),
            cues,
            sustained: SustainedCues::new(),
        }
    }

    /// Corrects each tile by its position map; in tile-index order.
    #[must_use]
    pub fn with_maps(mut self, maps: &[Option<PositionMap>]) -> Self {
        self.sensing = self.sensing.with_maps(maps);
        self
    }

    /// Sets the file from which the floor was read, for messages about missing parts of it.
    #[must_use]
    pub fn with_floor_file(mut self, file: FloorFile) -> Self {
        self.floor_file = file;
        self
    }

    /// Processes one frame; frames must come in time order and be of this floor's size.
    ///
    /// A frame with missing tiles counts as an unsensed floor: every control is cancelled.
    pub fn step(&mut self, frame: &ForceFrame) -> FrameResults<'_> {
        if frame.is_new {
            self.sensing.update(frame);
        }
        self.respond(frame, None)
    }

    /// As [`Engine::step`] with given contacts: one sensing for many layouts on the same floor.
    pub fn step_given<'a>(&'a mut self, frame: &ForceFrame, contacts: &'a [Contact]) -> FrameResults<'a> {
        self.respond(frame, Some(contacts))
    }

    fn respond<'a>(&'a mut self, frame: &ForceFrame, given: Option<&'a [Contact]>) -> FrameResults<'a> {
        let contacts = given.unwrap_or_else(|| self.sensing.contacts());
        self.cues.clear();
        self.sustained.clear();
        self.events.clear();
        self.events.append(&mut self.pending);
        self.indexed.clear();
        self.indexed.extend(self.events.iter().map(|event| ControlEvent::indexed(event, &self.layout)));
        self.interaction.step(frame, contacts, &self.layout, &mut self.indexed);
        let (interaction, now) = (&self.interaction, Now::of(frame, &self.layout, contacts));
        self.responses.answer(&self.indexed, now, &mut self.cues);
        let sliding = interaction.sliding();
        self.responses.last(sliding, &interaction.holding(), now, &mut self.cues, &mut self.sustained);
        let broken = self.grounds.step(frame, &self.last_frame, contacts, self.interaction.page());
        self.responses.give_way(broken, now, &mut self.cues);
        self.responses.remember(contacts, |id| interaction.holds(id));
        keep(&mut self.last_frame, frame);
        self.has_begun = true;
        self.follow_clicks();
        let new = self.indexed.iter().skip(self.events.len());
        self.events.extend(new.filter_map(|event| event.named(&self.layout)));
        self.take_waiting_layout();
        self.take_waiting_page();
        self.pages.reported = self.pages.shown.take();
        FrameResults {
            events: &self.events,
            page: self.pages.reported.as_ref(),
            cues: &self.cues,
            sustained: &self.sustained,
            ignored: self.interaction.ignored().new_ones(),
            grounds: self.grounds.events(),
            contacts: given.unwrap_or_else(|| self.sensing.contacts()),
        }
    }

    /// The layout in use.
    #[must_use]
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// The floor's dimensions.
    #[must_use]
    pub const fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// Installs another layout and keeps the values of controls that both have.
    ///
    /// While a foot is engaged, the change waits until the foot has let go. If the engaged control is missing from
    /// the new layout, the next step cancels it. The n-th layout given this way has [`Snapshot::layout_revision`] n.
    pub fn set_layout(&mut self, layout: Layout) {
        self.layouts_given += 1;
        self.waiting_layout = Some((layout, self.layouts_given));
        self.take_waiting_layout();
    }

    /// Ends every press and disarms every control without committing anything, because no more frames will come;
    /// changes under way are reverted. Returns the events.
    ///
    /// Each control works again only once it has been seen unloaded.
    pub fn cancel_all(&mut self) -> &[WidgetEvent] {
        self.events.clear();
        self.events.append(&mut self.pending);
        self.indexed.clear();
        self.interaction.cancel_all(&self.layout, self.last_frame.at, &mut self.indexed);
        self.events.extend(self.indexed.iter().filter_map(|event| event.named(&self.layout)));
        &self.events
    }

    /// The controls that feet press now, in any order.
    pub fn held(&self) -> impl Iterator<Item = &WidgetId> + Clone + '_ {
        let widgets = self.interaction.holding();
        widgets.filter_map(|held| self.layout.widgets.get(held.widget).map(|widget| &widget.id))
    }

    /// The name of the current page; `None` in a layout without pages.
    #[must_use]
    pub fn page(&self) -> Option<&str> {
        self.layout.pages.get(self.interaction.page()).map(|page| page.id.as_str())
    }

    /// Shows the page named `id`; [`FrameResults::page`] reports the change.
    ///
    /// While a foot is engaged, the page waits until every foot has let go; a later call replaces the waiting page.
    /// Feet that stand where a control appears must lift before it works.
    ///
    /// # Errors
    /// [`SetError::Unknown`] if the layout has no such page.
    pub fn set_page(&mut self, id: &str) -> Result<(), SetError> {
        self.pages.waiting = Some(self.layout.page_index(id).ok_or(SetError::Unknown)?);
        self.take_waiting_page();
        Ok(())
    }

    /// Revision of the layout in use, the same as [`Snapshot::layout_revision`].
    pub(crate) const fn layout_revision(&self) -> u64 {
        self.layout_revision
    }

    /// The file from which the floor was read.
    pub(crate) const fn floor_file(&self) -> &FloorFile {
        &self.floor_file
    }

    /// The reason why no foot can press the control at `index` of the layout; `None` if a foot can, and for an index
    /// out of range.
    pub(crate) fn off(&self, index: usize) -> Option<OffReason> {
        self.interaction.off(index, &self.layout, self.has_begun.then_some(&self.last_frame))
    }

    /// The time of the last frame, on the floor's sample clock.
    #[must_use]
    pub fn now(&self) -> Instant {
        self.last_frame.at
    }

    /// The value of the control named `id`; `None` for a button or an unknown name.
    #[must_use]
    pub fn value(&self, id: &str) -> Option<Value> {
        self.control(id)?.value()
    }

    /// Sets the value of the control named `id`, without an event.
    ///
    /// # Errors
    /// [`SetError`] says whether trying again can help; the control stays as it was.
    pub fn set_value(&mut self, id: &str, value: Value) -> Result<(), SetError> {
        let widget = self.layout.widget_index(id).ok_or(SetError::Unknown)?;
        let control = self.interaction.control_mut(widget).ok_or(SetError::Unknown)?;
        control.set_value(value)?;
        if let Some(value) = control.value() {
            self.responses.note(widget, &self.layout, value);
        }
        Ok(())
    }

    /// Switches the control named `id` off or on; switching off cancels its press (reported by the next step).
    ///
    /// # Errors
    /// [`SetError::Unknown`] if the layout has no such control.
    pub fn set_enabled(&mut self, id: &str, enabled: bool) -> Result<(), SetError> {
        let widget = self.layout.widget_index(id).ok_or(SetError::Unknown)?;
        self.change(widget, |control| control.set_disabled(!enabled));
        Ok(())
    }

    /// Locks or unlocks the control named `id`; locking cancels its press (reported by the next step).
    ///
    /// A locked control keeps its value, and emits a refusal when a foot presses it.
    ///
    /// # Errors
    /// [`SetError::Unknown`] if the layout has no such control.
    pub fn set_locked(&mut self, id: &str, locked: bool) -> Result<(), SetError> {
        let widget = self.layout.widget_index(id).ok_or(SetError::Unknown)?;
        self.change(widget, |control| control.set_locked(locked));
        Ok(())
    }

    /// Changes the state of a control; the next step reports the events.
    fn change(&mut self, widget: usize, change: impl FnOnce(&mut Control) -> Emitted) {
        self.indexed.clear();
        self.interaction.change(widget, change, &self.layout, self.last_frame.at, &mut self.indexed);
        self.pending.extend(self.indexed.iter().filter_map(|event| event.named(&self.layout)));
    }

    /// Sets the lamp of the control named `id`.
    ///
    /// # Errors
    /// [`SetError::Unknown`] if the layout has no such control.
    pub fn set_indicator(&mut self, id: &str, indicator: Indicator) -> Result<(), SetError> {
        let widget = self.layout.widget_index(id).ok_or(SetError::Unknown)?;
        self.interaction.control_mut(widget).ok_or(SetError::Unknown)?.set_indicator(indicator);
        Ok(())
    }

    /// Writes `label` on the control named `id`, in place of the layout's label; layouts given later get it too.
    ///
    /// Keeps only the first 64 characters, the maximum in a layout.
    ///
    /// # Errors
    /// [`SetError::Unknown`] if the layout has no such control.
    pub fn set_label(&mut self, id: &str, label: &str) -> Result<(), SetError> {
        let widget = self.layout.widget_index(id).ok_or(SetError::Unknown)?;
        self.overrides.write_label(&mut self.layout, widget, label);
        Ok(())
    }

    /// Sets the range of the slider, dial or stepper named `id`, from `least` to `greatest`, in place of the layout's
    /// range; layouts given later get it too. Clamps the value to the range, without an event.
    ///
    /// # Errors
    /// [`SetError::WrongType`] for other controls, [`SetError::NoRange`] for a range that is empty, not finite,
    /// beyond a million or narrower than the control's step; [`SetError::InUse`], [`SetError::Locked`].
    pub fn set_range(&mut self, id: &str, least: f32, greatest: f32) -> Result<(), SetError> {
        let widget = self.layout.widget_index(id).ok_or(SetError::Unknown)?;
        let spec = self.layout.widgets.get_mut(widget).ok_or(SetError::Unknown)?;
        spec.behaviour.scale().ok_or(SetError::WrongType)?;
        let behaviour = spec.behaviour.with_range(least, greatest).ok_or(SetError::NoRange)?;
        let control = self.interaction.control_mut(widget).ok_or(SetError::Unknown)?;
        control.set_behaviour(&behaviour)?;
        spec.behaviour = behaviour;
        self.overrides.keep_range(spec.id.clone(), [least, greatest]);
        if let Some(value) = control.value() {
            self.responses.note(widget, &self.layout, value);
        }
        Ok(())
    }

    /// The control named `id`, with its value and state; `None` for an unknown name.
    #[must_use]
    pub fn control(&self, id: &str) -> Option<&Control> {
        self.interaction.controls().get(self.layout.widget_index(id)?)
    }

    /// Writes the present state into `snapshot`; the caller fills in the link state and the counters.
    pub fn snapshot(&self, snapshot: &mut Snapshot) {
        snapshot.at = self.last_frame.at;
        snapshot.layout_revision = self.layout_revision;
        snapshot.contacts.clear();
        snapshot.contacts.extend_from_slice(self.sensing.contacts());
        snapshot.feet.clear();
        snapshot.feet.extend(self.interaction.feet(self.last_frame.at));
        snapshot.labels.clear();
        snapshot.labels.extend(self.overrides.labels(&self.layout));
        snapshot.ranges.clear();
        snapshot.ranges.extend(self.overrides.ranges(&self.layout));
        snapshot.page = self.interaction.page();
        snapshot.cursors.clear();
        snapshot.cursors.extend(self.interaction.cursors());
        snapshot.widgets.clear();
        let page = self.interaction.page();
        snapshot.floor_file.clone_from(&self.floor_file);
        let off = (0..).map(|index| self.off(index));
        let controls = self.interaction.controls().iter().zip(&self.layout.widgets).zip(off);
        snapshot.widgets.extend(controls.map(|((control, widget), off)| WidgetState {
            pressed: control.is_engaged(),
            value: control.value(),
            press_share: control.press_share(),
            needs_lift: control.needs_lift(),
            disabled: control.is_disabled(),
            off,
            hidden: !widget.is_on(page),
            locked: control.is_locked(),
            armed: control.is_armed(),
            warned: control.has_warned(),
            indicator: control.indicator(),
            pending: control.pending(),
        }));
        snapshot.ignored.clear();
        snapshot.ignored.reserve(SHOWN);
        snapshot.ignored.extend(self.interaction.ignored().latest().cloned());
        snapshot.answered.clear();
        snapshot.answered.reserve(SHOWN);
        snapshot.answered.extend(self.interaction.ignored().answered().cloned());
        self.grounds.show(&mut snapshot.grounds);
        snapshot.tiles.clear();
        let frame = &self.last_frame;
        let tiles = self.sensing.tiles().zip(&frame.forces).zip(&frame.quality).enumerate();
        snapshot.tiles.extend(tiles.map(|(index, ((tile, forces), quality))| TileState {
            forces: *forces,
            quality: *quality,
            force: tile.force,
            centroid: tile.centroid,
            age: frame.samples.get(index).map_or(Duration::ZERO, |sample| sample.age),
        }));
    }

    /// Takes over the page that a click requests.
    fn follow_clicks(&mut self) {
        let clicked = self.indexed.iter().filter(|event| event.kind == EventKind::Clicked);
        let goto = clicked.filter_map(|event| self.layout.widgets.get(event.widget)?.goto).next_back();
        self.pages.waiting = goto.or(self.pages.waiting);
    }

    fn take_waiting_page(&mut self) {
        if self.pages.waiting.is_none() || self.interaction.is_engaged() {
            return;
        }
        let Some(page) = self.pages.waiting.take().filter(|&page| page != self.interaction.page()) else {
            return;
        };
        self.interaction.show(page, &self.layout);
        self.pages.shown = self
            .layout
            .pages
            .get(page)
            .map(|shown| PageShown { at: self.last_frame.at, page: shown.id.clone() });
    }

    fn take_waiting_layout(&mut self) {
        let now = self.last_frame.at;
        let Some((waiting, _)) = &self.waiting_layout else { return };
        let vanished: Vec<usize> = self
            .interaction
            .engaged()
            .filter(|&widget| {
                self.layout
                    .widgets
                    .get(widget)
                    .is_none_or(|old| !has_like(waiting, old.id.as_str(), &old.behaviour))
            })
            .collect();
        self.indexed.clear();
        for widget in vanished {
            self.interaction.cancel(widget, &self.layout, now, &mut self.indexed);
        }
        self.pending.extend(self.indexed.iter().filter_map(|event| event.named(&self.layout)));
        if self.interaction.is_engaged() {
            return;
        }
        let Some((mut layout, revision)) = self.waiting_layout.take() else { return };
        // The current page and a waiting page stay if the new layout has them too.
        let same_page = |page: usize| layout.page_index(self.layout.pages.get(page)?.id.as_str());
        let page = same_page(self.interaction.page()).unwrap_or(0);
        let waiting_page = self.pages.waiting.and_then(same_page);
        self.overrides.apply(&mut layout);
        let mut interaction = Interaction::new(&layout, &self.geometry, page);
        for (index, widget) in layout.widgets.iter().enumerate() {
            let old = self.layout.widget_index(widget.id.as_str());
            let old = old.and_then(|old| self.interaction.controls().get(old));
            if let (Some(old), Some(new)) = (old, interaction.control_mut(index)) {
                // A control that changed its behaviour starts from its own initial value.
                let _ = old.value().map(|value| new.set_value(value));
                new.set_disabled(old.is_disabled());
                new.set_locked(old.is_locked());
                new.set_indicator(old.indicator());
            }
        }
        interaction.inherit(&mut self.interaction);
        let mut grounds = Grounds::new(layout.grounds.iter().map(|ground| ground.spec), &self.geometry);
        grounds.inherit(&mut self.grounds);
        self.cues.reserve(CUES + grounds.most_events());
        self.grounds = grounds;
        self.pages.waiting = waiting_page;
        self.interaction = interaction;
        self.layout = layout;
        self.responses.begin(&self.layout, self.interaction.controls());
        self.layout_revision = revision;
    }
}

/// Copies `frame` into `kept` without new memory; a derived `clone_from` would allocate.
fn keep(kept: &mut ForceFrame, frame: &ForceFrame) {
    let ForceFrame {
        at,
        received,
        forces,
        quality,
        may_start,
        hold_doubts,
        calibration_fault,
        samples,
        is_new,
    } = frame;
    (kept.at, kept.received, kept.calibration_fault) = (*at, *received, *calibration_fault);
    kept.is_new = *is_new;
    kept.samples.clone_from(samples);
    kept.forces.clone_from(forces);
    kept.quality.clone_from(quality);
    kept.may_start.clone_from(may_start);
    kept.hold_doubts.clone_from(hold_doubts);
}

fn has_like(layout: &Layout, id: &str, behaviour: &Behaviour) -> bool {
    layout
        .widget_index(id)
        .and_then(|widget| layout.widgets.get(widget))
        .is_some_and(|widget| std::mem::discriminant(&widget.behaviour) == std::mem::discriminant(behaviour))
}
