//! Finds the control at a point.

use glam::Vec2;

use super::{Layout, Shape, Widget};
use crate::floor::{Geometry, Rect, TileBlock, TileId};

/// Whether `point` lies on the visible face of `widget`.
pub(super) fn hits(widget: &Widget, point: Vec2) -> bool {
    match widget.look.shape {
        Shape::Box => widget.area.contains(point),
        Shape::Round => {
            let radii = widget.area.size() * 0.5;
            ((point - widget.area.centre()) / radii).length_squared() < 1.0
        }
    }
}

/// The controls of one layout by their tiles: a search takes as long in a layout of thousands as in one of ten.
#[derive(Clone, Debug)]
pub struct HitIndex {
    geometry: Geometry,
    /// Per tile, in tile-index order: the controls that overlap it, in drawing order.
    tiles: Vec<Vec<usize>>,
}

impl HitIndex {
    /// The controls of `layout` on a floor of this `geometry`.
    #[must_use]
    pub fn new(layout: &Layout, geometry: &Geometry) -> Self {
        let mut tiles = vec![Vec::new(); geometry.tile_count()];
        for (index, widget) in layout.widgets.iter().enumerate() {
            for tile in cells_under(widget.area, geometry) {
                if let Some(on) = geometry.index(tile).and_then(|at| tiles.get_mut(at)) {
                    on.push(index);
                }
            }
        }
        Self { geometry: *geometry, tiles }
    }

    /// The same control as [`Layout::widget_at`]; `None` also beyond the floor.
    ///
    /// `layout` must be the one from which the index was made.
    #[must_use]
    pub fn widget_at(&self, layout: &Layout, page: usize, point: Vec2) -> Option<usize> {
        let tile = self.geometry.tile_under(point).and_then(|tile| self.geometry.index(tile))?;
        let there = |&&index: &&usize| {
            layout.widgets.get(index).is_some_and(|widget| widget.is_on(page) && hits(widget, point))
        };
        self.on_tile(tile).iter().rev().find(there).copied()
    }

    /// The controls of all pages that overlap the tile at `index`, in drawing order.
    #[must_use]
    pub fn on_tile(&self, index: usize) -> &[usize] {
        self.tiles.get(index).map_or(&[], Vec::as_slice)
    }
}

/// The tiles with a cell (plate and gap) that overlaps `area`.
fn cells_under(area: Rect, geometry: &Geometry) -> impl Iterator<Item = TileId> {
    // The casts turn negative values into zero.
    let first = (area.min / geometry.pitch_m()).floor().as_u16vec2();
    let end = (area.max / geometry.pitch_m()).ceil().as_u16vec2();
    let cells = TileBlock {
        first: TileId::new(first.x, first.y),
        columns: end.x.saturating_sub(first.x),
        rows: end.y.saturating_sub(first.y),
    };
    geometry.block().common(&cells).tiles()
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;
    use crate::schema::{Kinds, builtin_layout, parse_layout};

    #[test]
    fn the_index_finds_what_looking_at_every_control_finds() {
        let geometry = Geometry::default();
        let kinds = Kinds::builtin();
        let mut layout =
            parse_layout(builtin_layout("map").unwrap(), "map", &kinds, &geometry).unwrap().layout;
        // Half of the controls on one page, half on the other, and one on both.
        for (index, widget) in layout.widgets.iter_mut().enumerate().skip(1) {
            widget.page = Some(index % 2);
        }
        let index = HitIndex::new(&layout, &geometry);
        let mut hit = 0;
        for step in 0..200 * 200_u32 {
            let point = (UVec2::new(step % 200, step / 200).as_vec2() * 0.01) - 0.05;
            for page in 0..2 {
                let found = index.widget_at(&layout, page, point);
                assert_eq!(found, layout.widget_at(page, point), "{point} on page {page}");
                hit += u32::from(found.is_some());
            }
        }
        assert!(hit > 1000, "{hit}");
    }
}
