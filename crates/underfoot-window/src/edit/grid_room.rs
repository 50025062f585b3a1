//! The room that the cells of a grid need: their size and the gaps between them.

use glam::Vec2;

use super::change::Edit;
use super::document::Document;
use super::item::Item;
use super::place::pair;
use super::room::SLACK_M;
use super::snap::round_step_m;
use underfoot::floor::Rect;
use underfoot::layout::{Layout, Widget};
use underfoot_scene::ergonomics::{SMALL_M, gap_between_m, needed_gap_m, smallest_part};

/// A width that suits a shoe, in metres (rule U101).
const GOOD_M: f32 = 0.12;

/// The size of the control with room for a shoe on each of its parts; its own size if it has that room.
pub(super) fn good_size(widget: &Widget) -> Vec2 {
    let (size, (part, _)) = (widget.area.size(), smallest_part(widget));
    if part.min_element() >= SMALL_M - SLACK_M { size } else { size * (GOOD_M / part).max(Vec2::ONE) }
}

/// The size of the cells of a grid and the gaps between them, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GridRoom {
    size: Vec2,
    gap: Vec2,
}

impl GridRoom {
    /// The present one.
    fn of(cells: &[Widget]) -> Option<Self> {
        let first = cells.first()?;
        let size = first.area.size();
        let pitch = pitch(cells);
        let gap = (pitch - size).max(Vec2::ZERO);
        // A grid of one row has a gap in one direction only.
        let gap = Vec2::select(pitch.cmpgt(Vec2::ZERO), gap, Vec2::new(gap.y, gap.x));
        Some(Self { size, gap })
    }

    /// The room that the cells of `item` need; `None` if they have it, or for a single control.
    pub(super) fn needed(document: &Document, item: &Item) -> Option<Self> {
        let cells = document.layout().widgets.get(item.widgets.clone())?;
        let (present, first) = (Self::of(cells).filter(|_| cells.len() > 1)?, cells.first()?);
        let step = round_step_m(document.unit_m(), &document.floor().geometry);
        let wide = (Vec2::splat(needed_gap_m(first) - SLACK_M) / step).ceil() * step;
        let gap = if is_crowded(cells) { wide.max(present.gap) } else { present.gap };
        let needed = Self { size: good_size(first), gap };
        (needed != present).then_some(needed)
    }

    /// The edits that give `item` this room.
    pub(super) fn edits(self, document: &Document, item: &Item) -> Vec<Edit> {
        let present = document.layout().widgets.get(item.widgets.clone()).and_then(Self::of);
        let written = |length: Vec2| pair(length.as_dvec2() / document.unit_m()).inline();
        let size = Edit::set(&item.record, "size", written(self.size));
        let gap = Edit::set(&item.record, "repeat.gap", written(self.gap));
        let is_new =
            [present.map(|it| it.size) != Some(self.size), present.map(|it| it.gap) != Some(self.gap)];
        [size, gap].into_iter().zip(is_new).filter_map(|(edit, is_new)| is_new.then_some(edit)).collect()
    }

    /// Spreads the cells of `item` in `layout` about their middle.
    pub(super) fn spread(self, layout: &mut Layout, item: &Item) {
        let Some(cells) = layout.widgets.get_mut(item.widgets.clone()) else { return };
        let (old, south_west) = (pitch(cells), corner(cells));
        let Some(around) = super::item::around(cells.iter().map(|cell| cell.area)) else { return };
        let number = |cell: &Widget| {
            let steps = (cell.area.min - south_west) / old;
            Vec2::select(old.cmpgt(Vec2::ZERO), steps, Vec2::ZERO).round()
        };
        let new = self.size + self.gap;
        let most = cells.iter().map(number).fold(Vec2::ZERO, Vec2::max);
        let begin = around.centre() - 0.5 * (most * new + self.size);
        for cell in cells {
            cell.area = Rect::from_min_size(begin + number(cell) * new, self.size);
        }
    }
}

/// Whether any of the controls is too close to another one of them.
pub(super) fn is_crowded(cells: &[Widget]) -> bool {
    let is_close = |at: usize, one: &Widget| {
        let mut others = cells.iter().skip(at + 1);
        others.any(|other| gap_between_m(one.area, other.area) < needed_gap_m(one) - SLACK_M)
    };
    cells.iter().enumerate().any(|(at, one)| is_close(at, one))
}

fn corner(cells: &[Widget]) -> Vec2 {
    cells.iter().map(|cell| cell.area.min).reduce(Vec2::min).unwrap_or_default()
}

/// The distance from one column to the next and from one row to the next; 0 where there is only one.
fn pitch(cells: &[Widget]) -> Vec2 {
    let first = corner(cells);
    let next = |axis: usize| {
        let apart = cells.iter().map(|cell| cell.area.min[axis] - first[axis]);
        let apart = apart.filter(|apart| *apart > SLACK_M).min_by(f32::total_cmp);
        apart.unwrap_or_default()
    };
    Vec2::new(next(0), next(1))
}
