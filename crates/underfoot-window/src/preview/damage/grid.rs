//! A window cut into square cells, each with a number that stands for its content.

use eframe::egui::{Pos2, Rect, vec2};

/// Width of a cell in pixels: half of the tiles in which Mesa draws without a graphics card.
const CELL_PX: f32 = 32.0;

/// Maximum number of areas that are drawn separately: each is a call to the driver for every texture in it.
const MOST_AREAS: usize = 40;

/// Maximum number of columns and rows.
const MOST_CELLS: f32 = 1024.0;

/// The cells of a window.
pub(super) struct Grid {
    screen: Rect,
    pixels_per_point: f32,
    /// Side length of a cell in points.
    side: f32,
    columns: usize,
    /// For each cell, row by row, the folded names of the shapes that touch it.
    cells: Vec<u64>,
}

impl Grid {
    /// A grid without shapes.
    pub(super) fn new(screen: Rect, pixels_per_point: f32) -> Self {
        let longest = screen.width().max(screen.height());
        // A scale of NaN or zero makes one cell of all.
        let side = (CELL_PX / pixels_per_point).min(longest).max(longest / MOST_CELLS);
        let [columns, rows] =
            [screen.width(), screen.height()].map(|length| ((length / side).ceil() as usize).max(1));
        Self { screen, pixels_per_point, side, columns, cells: vec![0; columns * rows] }
    }

    /// Adds a shape with this name, over all earlier ones.
    pub(super) fn fold(&mut self, reach: Rect, name: u64) {
        let reach = reach.intersect(self.screen);
        if !reach.is_positive() {
            return;
        }
        let (from, to) = (self.cell(reach.min), self.cell(reach.max));
        for row in self.cells.chunks_mut(self.columns).take(to.1 + 1).skip(from.1) {
            for cell in row.iter_mut().take(to.0 + 1).skip(from.0) {
                *cell = folded(*cell, name);
            }
        }
    }

    /// Column and row of the cell at this place; those of the rim stand for all places outside.
    fn cell(&self, at: Pos2) -> (usize, usize) {
        let at = (at - self.screen.min) / self.side;
        // The cast turns negative numbers into zero.
        ((at.x as usize).min(self.columns - 1), (at.y as usize).min(self.cells.len() / self.columns - 1))
    }

    /// Whether both windows have the same size and scale.
    pub(super) fn fits(&self, other: &Self) -> bool {
        self.screen == other.screen && self.pixels_per_point == other.pixels_per_point
    }

    /// Areas that do not overlap and cover all cells that differ from those of another grid of the same size.
    ///
    /// Soft edges that are drawn twice are too dark, therefore they do not overlap. If small cells make too many areas,
    /// larger ones take their place.
    pub(super) fn differences(&self, other: Option<&Self>) -> Vec<Rect> {
        let Some(other) = other.filter(|other| self.fits(other)) else { return vec![self.screen] };
        let mut differs: Vec<bool> =
            self.cells.iter().zip(&other.cells).map(|(one, other)| one != other).collect();
        let (mut columns, mut side) = (self.columns, self.side);
        loop {
            let blocks = blocks(&differs, columns);
            if blocks.len() <= MOST_AREAS {
                return blocks.into_iter().map(|block| self.area(block, side)).collect();
            }
            (differs, columns, side) = (halved(&differs, columns), columns.div_ceil(2), 2.0 * side);
        }
    }

    /// The area of a block of cells with this side length.
    fn area(&self, Block { columns, rows }: Block, side: f32) -> Rect {
        let corner = |column: usize, row: usize| self.screen.min + side * vec2(column as f32, row as f32);
        Rect::from_min_max(corner(columns.0, rows.0), corner(columns.1, rows.1)).intersect(self.screen)
    }
}

/// Folds a name into the number of a cell.
///
/// # Source
/// The step of `FxHash`: <https://docs.rs/rustc-hash>, version 1.
const fn folded(cell: u64, name: u64) -> u64 {
    (cell.rotate_left(5) ^ name).wrapping_mul(0x517c_c1b7_2722_0a95)
}

/// First column and row of a rectangle of cells, and those after the last.
#[derive(Clone, Copy)]
struct Block {
    columns: (usize, usize),
    rows: (usize, usize),
}

/// The cells that differ, as rectangles: runs of a row, joined with equal runs of the rows below.
fn blocks(differs: &[bool], columns: usize) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    for (row, cells) in differs.chunks(columns).enumerate() {
        let mut column = 0;
        for run in cells.chunk_by(|one, other| one == other) {
            let span = (column, column + run.len());
            column = span.1;
            if run.first() != Some(&true) {
                continue;
            }
            match blocks.iter_mut().find(|above| above.columns == span && above.rows.1 == row) {
                Some(above) => above.rows.1 += 1,
                None => blocks.push(Block { columns: span, rows: (row, row + 1) }),
            }
        }
    }
    blocks
}

/// Cells of twice the side length: one differs if any of its four does.
fn halved(differs: &[bool], columns: usize) -> Vec<bool> {
    let of_rows = |rows: &[bool]| -> Vec<bool> {
        let mut pairs = vec![false; columns.div_ceil(2)];
        for (at, differs) in rows.iter().enumerate().filter(|(_, differs)| **differs) {
            if let Some(pair) = pairs.get_mut(at % columns / 2) {
                *pair |= differs;
            }
        }
        pairs
    };
    differs.chunks(2 * columns).flat_map(of_rows).collect()
}

#[cfg(test)]
mod tests {
    use eframe::egui::pos2;
    use proptest::prelude::*;

    use super::*;

    /// A window of 2000 x 1000 points with one shape in each of these places.
    fn grid(places: &[(u16, u16)]) -> Grid {
        let mut grid = Grid::new(Rect::from_min_max(pos2(0.0, 0.0), pos2(2000.0, 1000.0)), 1.0);
        for (name, (x, y)) in (1..).zip(places) {
            let at = pos2(f32::from(*x), f32::from(*y));
            grid.fold(Rect::from_min_max(at, at + vec2(9.0, 9.0)), name);
        }
        grid
    }

    #[test]
    fn a_window_of_another_size_or_of_none_is_drawn_as_a_whole() {
        let [empty, dense] = [(0.0, 1.0), (1000.0, f32::NAN)]
            .map(|(side, scale)| Grid::new(Rect::from_min_max(pos2(0.0, 0.0), pos2(side, side)), scale));
        assert!(empty.differences(Some(&empty)).is_empty());
        assert_eq!(dense.differences(Some(&grid(&[]))), [dense.screen]);
        assert_eq!(dense.differences(None), [dense.screen]);
    }

    proptest! {
        /// Many feet at once make larger areas, not more of them.
        #[test]
        fn areas_are_few_and_apart_and_cover_all_that_differs(places in prop::collection::vec((0..1990_u16, 0..990_u16), 0..300)) {
            let areas = grid(&places).differences(Some(&grid(&[])));
            prop_assert!(areas.len() <= MOST_AREAS);
            for (x, y) in &places {
                let middle = pos2(f32::from(*x) + 4.5, f32::from(*y) + 4.5);
                prop_assert!(areas.iter().any(|area| area.contains(middle)));
            }
            for (at, area) in areas.iter().enumerate() {
                prop_assert!(!areas[..at].iter().any(|other| other.intersect(*area).is_positive()));
            }
        }
    }
}
