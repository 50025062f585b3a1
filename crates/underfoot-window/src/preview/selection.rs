//! The tile and the control that the side panel shows.

use underfoot::engine::Snapshot;
use underfoot::floor::{Geometry, TileId};
use underfoot::layout::{Layout, Widget};
use underfoot::widget::WidgetId;

/// The content of the side panel: the tile under the working foot and the control that was pressed last, or pinned
/// ones.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Selection {
    tile: TileId,
    control: Option<WidgetId>,
    pinned: bool,
}

impl Selection {
    /// The tile in the middle of the floor, until a foot steps on another one.
    pub(super) fn new(geometry: &Geometry) -> Self {
        let TileId { column, row } = geometry.first();
        let tile = TileId::new(column + geometry.columns() / 2, row + geometry.rows() / 2);
        Self { tile, control: None, pinned: false }
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

    /// Follows the control that was pressed last, unless another one is pinned.
    pub(super) fn follow_press(&mut self, control: Option<&WidgetId>) {
        if control.is_some() && (!self.pinned || self.control.is_none()) && self.control.as_ref() != control {
            self.control = control.cloned();
        }
    }

    pub(super) fn pin(&mut self, tile: TileId) {
        (self.tile, self.pinned) = (tile, true);
    }

    /// Shows this control until the user selects another one.
    pub(super) fn pin_control(&mut self, control: WidgetId) {
        (self.control, self.pinned) = (Some(control), true);
    }

    #[cfg(test)]
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
    fn the_control_is_the_one_pressed_last_until_one_is_pinned() {
        let mut selection = Selection::new(&Geometry::default());
        let [home, zoom] = ["home", "zoom"].map(WidgetId::new);
        selection.follow_press(Some(&home));
        selection.follow_press(Some(&zoom));
        assert_eq!(selection.control(), Some(&zoom));
        selection.pin_control(home.clone());
        selection.follow_press(Some(&zoom));
        assert_eq!(selection.control(), Some(&home));
        selection.unpin();
        selection.follow_press(Some(&zoom));
        assert_eq!(selection.control(), Some(&zoom));
    }
}
