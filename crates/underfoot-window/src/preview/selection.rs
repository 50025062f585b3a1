//! The tile and the control that the side panel shows.

use underfoot::engine::Snapshot;
use underfoot::floor::{Geometry, TileId};
use underfoot::layout::{Layout, Widget};
use underfoot::units::Instant;
use underfoot::widget::WidgetId;

/// The content of the side panel: the tile under the working foot and the control that was pressed last, or pinned
/// ones.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Selection {
    tile: TileId,
    control: Option<WidgetId>,
    pinned: bool,
    /// The controls under feet in the last frame.
    held: Vec<WidgetId>,
    /// The time of the last press that was followed.
    pressed_at: Option<Instant>,
}

impl Selection {
    /// The tile in the middle of the floor, until a foot steps on another one.
    pub(super) fn new(geometry: &Geometry) -> Self {
        let TileId { column, row } = geometry.first();
        let tile = TileId::new(column + geometry.columns() / 2, row + geometry.rows() / 2);
        Self { tile, control: None, pinned: false, held: Vec::new(), pressed_at: None }
    }

    /// Follows the heaviest tile of the cursor, or of the heaviest contact, unless pinned.
    pub(super) fn follow(&mut self, snapshot: &Snapshot) {
        if self.pinned {
            return;
        }
        let leads = |id| snapshot.cursors.iter().flatten().any(|cursor| cursor.contact == id);
        let foot = snapshot.contacts.iter().max_by(|a, b| {
            (leads(a.id), a.force.0)
                .partial_cmp(&(leads(b.id), b.force.0))
                .unwrap_or(std::cmp::Ordering::Equal)
        });
        if let Some(load) = foot.and_then(|contact| contact.tiles.first()) {
            self.tile = load.tile;
        }
    }

    /// Follows the control in use, unless another one is pinned: the one that a foot took hold of last, or, with no
    /// foot on any control, the one of the last press, which ended at its time.
    pub(super) fn follow_use(&mut self, held: &[WidgetId], last_press: Option<(&WidgetId, Instant)>) {
        let begun = held.iter().find(|id| !self.held.contains(id)).cloned();
        let ended = last_press.filter(|(_, at)| held.is_empty() && self.pressed_at != Some(*at));
        if held.is_empty() {
            self.pressed_at = last_press.map(|(_, at)| at);
        }
        if self.held != held {
            self.held = held.to_vec();
        }
        if self.pinned && self.control.is_some() {
            return;
        }
        if let Some(id) = begun.or_else(|| ended.map(|(id, _)| id.clone())) {
            self.control = Some(id);
        }
    }

    pub(super) fn pin(&mut self, tile: TileId) {
        (self.tile, self.pinned) = (tile, true);
    }

    /// Shows this control until the user selects another one.
    pub(super) fn pin_control(&mut self, control: WidgetId) {
        (self.control, self.pinned) = (Some(control), true);
    }

    /// The control in use, the one of the last press, or the pinned one; `None` before any.
    pub(super) fn control(&self) -> Option<&WidgetId> {
        self.control.as_ref()
    }

    /// The selected control, or the first control of `layout` if the selected one is not in it.
    pub(super) fn control_of<'l>(&self, layout: &'l Layout) -> Option<&'l Widget> {
        let chosen = self.control.as_ref().and_then(|id| layout.widget_index(id.as_str()));
        layout.widgets.get(chosen.unwrap_or(0))
    }

    pub(super) fn unpin(&mut self) {
        self.pinned = false;
        // The last press counts again, so that its control returns at once.
        self.pressed_at = None;
    }

    pub(super) fn tile(&self) -> TileId {
        self.tile
    }

    pub(super) fn pinned(&self) -> Option<TileId> {
        self.pinned.then_some(self.tile)
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::preview::sample::{at_rest, map, pressing, step_on};

    #[test]
    fn follows_the_working_foot_and_stays_when_it_is_gone() {
        let layout = map();
        let mut selection = Selection::new(&Geometry::default());
        assert_eq!(selection.tile(), TileId::new(3, 3));
        // The standing foot is heavier, but the other one is the cursor.
        selection.follow(&pressing(&layout));
        assert_eq!(selection.tile(), TileId::new(0, 4));
        selection.follow(&at_rest(&layout));
        assert_eq!(selection.tile(), TileId::new(0, 4));
        selection.pin(TileId::new(5, 5));
        let mut elsewhere = at_rest(&layout);
        step_on(&mut elsewhere, 3, Vec2::new(1.0, 1.0), 300.0, Vec2::ZERO);
        selection.follow(&elsewhere);
        assert_eq!(selection.pinned(), Some(TileId::new(5, 5)));
        selection.unpin();
        selection.follow(&elsewhere);
        assert_eq!(selection.tile(), TileId::new(3, 3));
    }

    #[test]
    fn the_control_is_the_one_in_use_until_one_is_pinned() {
        let mut selection = Selection::new(&Geometry::default());
        let [home, zoom] = ["home", "zoom"].map(WidgetId::new);
        let at = Instant::from_millis;
        selection.follow_use(&[], Some((&home, at(1))));
        selection.follow_use(&[], Some((&zoom, at(2))));
        assert_eq!(selection.control(), Some(&zoom));
        selection.pin_control(home.clone());
        selection.follow_use(&[], Some((&zoom, at(3))));
        assert_eq!(selection.control(), Some(&home));
        selection.unpin();
        selection.follow_use(&[], Some((&zoom, at(4))));
        assert_eq!(selection.control(), Some(&zoom));
    }

    #[test]
    fn a_control_that_is_dragged_is_shown_and_stays_when_the_foot_leaves() {
        let mut selection = Selection::new(&Geometry::default());
        let [home, zoom] = ["home", "zoom"].map(WidgetId::new);
        let before = Some((&home, Instant::from_millis(1)));
        selection.follow_use(&[], before);
        selection.follow_use(std::slice::from_ref(&zoom), before);
        assert_eq!(selection.control(), Some(&zoom), "the press before is over");
        selection.follow_use(&[], before);
        assert_eq!(selection.control(), Some(&zoom), "the report of its press comes later");
        // A second foot takes another one meanwhile.
        selection.follow_use(std::slice::from_ref(&zoom), before);
        selection.follow_use(&[zoom, home.clone()], before);
        assert_eq!(selection.control(), Some(&home));
    }
}
