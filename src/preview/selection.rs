//! Which tile the side panel shows.

use crate::engine::Snapshot;
use crate::floor::{Geometry, TileId};

/// Which tile the side panel shows: the one under the foot that works, or one that was pinned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Selection {
    tile: TileId,
    pinned: bool,
}

impl Selection {
    /// The middle of the floor, until a foot comes.
    pub(super) fn new(geometry: &Geometry) -> Self {
        let TileId { column, row } = geometry.first();
        let tile = TileId::new(column + geometry.columns() / 2, row + geometry.rows() / 2);
        Self { tile, pinned: false }
    }

    /// Goes along with the cursor's heaviest tile, or the heaviest contact's, unless pinned.
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

    pub(super) fn pin(&mut self, tile: TileId) {
        *self = Self { tile, pinned: true };
    }

    pub(super) fn unpin(&mut self) {
        self.pinned = false;
    }

    pub(super) fn tile(self) -> TileId {
        self.tile
    }

    pub(super) fn pinned(self) -> Option<TileId> {
        self.pinned.then_some(self.tile)
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::scene::sample::{at_rest, map, pressing, step_on};

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
}
