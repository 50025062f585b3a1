//! The frames of the window over the last half minute of the floor.

use std::collections::VecDeque;
use std::sync::Arc;

use glam::Vec2;

use underfoot::engine::Snapshot;
use underfoot::layout::Layout;
use underfoot::sense::ContactId;
use underfoot::units::Instant;
use underfoot::widget::{Value, WidgetId};

/// Time for which moments are kept, in seconds.
pub(super) const LONGEST_S: f64 = 30.0;

/// Maximum number of moments: those of [`LONGEST_S`] at 60 frames a second.
const MOST: usize = 1900;

/// The state of the floor in one frame of the window.
#[derive(Clone, Debug)]
pub(super) struct PlotMoment {
    pub(super) at: Instant,
    layout: Arc<Layout>,
    /// In tile-index order.
    pub(super) tiles: Vec<Tile>,
    pub(super) feet: Vec<PlotFoot>,
    /// In the layout's order.
    controls: Vec<PlotControl>,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tile {
    pub(super) force: f32,
    pub(super) sensors: [f32; 4],
}

#[derive(Clone, Copy, Debug)]
pub(super) struct PlotFoot {
    pub(super) contact: ContactId,
    pub(super) force: f32,
    pub(super) at: Vec2,
    pub(super) leads: bool,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PlotControl {
    /// Force of the heaviest foot on it, in newtons.
    pub(super) force: f32,
    pub(super) values: [Option<f32>; 2],
}

/// The index of a control in the layout: looked up once for all moments with the same layout.
#[derive(Debug, Default)]
pub(super) struct ControlIndex(Option<(Arc<Layout>, Option<usize>)>);

impl ControlIndex {
    /// The control called `id` in a moment; every call must use the same id.
    pub(super) fn control<'m>(&mut self, moment: &'m PlotMoment, id: &WidgetId) -> Option<&'m PlotControl> {
        let known = self.0.as_ref().filter(|(layout, _)| Arc::ptr_eq(layout, &moment.layout));
        let index = known.map_or_else(|| moment.layout.widget_index(id.as_str()), |(_, index)| *index);
        if known.is_none() {
            self.0 = Some((Arc::clone(&moment.layout), index));
        }
        moment.controls.get(index?)
    }
}

impl PlotMoment {
    fn fill(&mut self, snapshot: &Snapshot, layout: &Arc<Layout>) {
        self.at = snapshot.at;
        self.layout = Arc::clone(layout);
        self.tiles.clear();
        self.tiles
            .extend(snapshot.tiles.iter().map(|tile| Tile { force: tile.force.0, sensors: tile.forces }));
        self.feet.clear();
        self.feet.extend(snapshot.contacts.iter().map(|contact| PlotFoot {
            contact: contact.id,
            force: contact.force.0,
            at: contact.centroid,
            leads: snapshot.cursors.iter().flatten().any(|cursor| cursor.contact == contact.id),
        }));
        self.controls.clear();
        self.controls.extend(snapshot.widgets.iter().map(|state| PlotControl {
            force: 0.0,
            values: match state.value {
                None => [None; 2],
                Some(Value::Switch(on)) => [Some(f32::from(u8::from(on))), None],
                Some(Value::Number(number)) => [Some(number), None],
                Some(Value::Choice(choice)) => [Some(f32::from(choice)), None],
                Some(Value::Pair(pair)) => [Some(pair.x), Some(pair.y)],
            },
        }));
        for foot in &self.feet {
            let control = layout.widget_at(snapshot.page, foot.at);
            if let Some(control) = control.and_then(|control| self.controls.get_mut(control)) {
                control.force = control.force.max(foot.force);
            }
        }
    }
}

/// The latest moments, oldest first.
#[derive(Default)]
pub(super) struct PlotHistory {
    moments: VecDeque<PlotMoment>,
}

impl PlotHistory {
    /// Records a frame's state. Skips a frame with the same time as the last; an earlier one, as from a repeated
    /// recording, clears the history.
    pub(super) fn note(&mut self, snapshot: &Snapshot, layout: &Arc<Layout>) {
        match self.moments.back() {
            Some(last) if last.at == snapshot.at => return,
            Some(last) if last.at > snapshot.at => self.moments.clear(),
            _ => {}
        }
        let is_old = |moment: &PlotMoment| snapshot.at.since(moment.at).as_secs_f64() > LONGEST_S;
        let mut spare = None;
        while self.moments.len() >= MOST || self.moments.front().is_some_and(is_old) {
            spare = self.moments.pop_front();
        }
        let mut moment = spare.unwrap_or_else(|| PlotMoment {
            at: snapshot.at,
            layout: Arc::clone(layout),
            tiles: Vec::new(),
            feet: Vec::new(),
            controls: Vec::new(),
        });
        moment.fill(snapshot, layout);
        self.moments.push_back(moment);
    }

    /// The time of the latest moment.
    pub(super) fn end(&self) -> Option<Instant> {
        self.moments.back().map(|moment| moment.at)
    }

    /// The moments of the last `span_s` seconds, and the one before them, oldest first.
    pub(super) fn last(&self, span_s: f64) -> impl Iterator<Item = &PlotMoment> {
        let end = self.end().unwrap_or_default();
        let from = self.moments.partition_point(|moment| end.since(moment.at).as_secs_f64() > span_s);
        self.moments.range(from.saturating_sub(1)..)
    }

    /// The contacts in the history, the latest first.
    pub(super) fn contacts(&self) -> Vec<ContactId> {
        let mut contacts: Vec<ContactId> = Vec::new();
        for foot in self.moments.iter().rev().flat_map(|moment| &moment.feet) {
            if !contacts.contains(&foot.contact) {
                contacts.push(foot.contact);
            }
        }
        contacts
    }
}
