//! A first layout for any floor.

use underfoot::floor::Geometry;

/// Returns the text of a first layout: a button on each tile, for the foot that works beside a standing one.
#[must_use]
pub fn first_layout(geometry: &Geometry) -> String {
    let widgets: String = geometry
        .tiles()
        .filter(|tile| geometry.has(*tile))
        .map(|tile| {
            let (column, row) = (tile.column, tile.row);
            format!(
                "        (id: \"tile_{column}_{row}\", kind: \"button\", label: \"{column}, {row}\", at: ({column}.1, \
                 {row}.1), size: (0.8, 0.8)),\n"
            )
        })
        .collect();
    format!(
        "// A button on each tile: a first layout, to try the floor.\nLayout(\n    version: 1,\n    title: \"First \
         layout\",\n    regions: [(id: \"all\", at: (0, 0), size: ({}, {}), cursor: Working)],\n    widgets: \
         [\n{widgets}    ],\n)\n",
        geometry.columns(),
        geometry.rows()
    )
}

#[cfg(test)]
mod tests {
    use underfoot::schema::{Kinds, parse_layout};

    use super::*;
    use crate::setup::{FloorShape, GridShape, SHIPPED_SHAPES};

    #[test]
    fn the_first_layout_fits_every_floor_that_can_be_chosen() {
        let shipped = SHIPPED_SHAPES.iter().map(|(name, _)| FloorShape::Shipped((*name).to_owned()));
        let grids =
            [(6, 6), (1, 3)].map(|(columns, rows)| FloorShape::Grid(GridShape::of_paper(columns, rows)));
        for geometry in shipped.chain(grids).map(|shape| shape.floor().unwrap().geometry) {
            let text = first_layout(&geometry);
            let layout = parse_layout(&text, "first", &Kinds::builtin(), &geometry);
            let tiles = geometry.tiles().filter(|tile| geometry.has(*tile)).count();
            let layout = layout.unwrap_or_else(|problems| panic!("{problems}")).layout;
            assert_eq!((layout.title.as_str(), layout.widgets.len()), ("First layout", tiles));
        }
    }
}
