//! The result that a gesture would have now: snapped places, copies, and the layout that they give.

use glam::Vec2;

use super::edited::EditedLayout;
use crate::edit::{
    Edges, Item, NeighbourGap, RecordList, SnapGrid, SnapGuide, SnapReason, gaps_around, round_step_m,
};
use underfoot::floor::Rect;
use underfoot::layout::Layout;
use underfoot_scene::egui_painter::ScreenFromFloor;

/// Distance within which a guide line attracts, in points.
const PULL: f32 = 7.0;

/// Minimum width and depth from dragging, in metres; the format allows 0.05 tiles.
const LEAST_M: f32 = 0.03;

/// The result that a gesture would have if it ended now.
#[derive(Default)]
pub(super) struct GestureResult {
    /// The layout; `None` where it is refused or unchanged.
    pub(super) layout: Option<Layout>,
    /// The reason for a refusal.
    pub(super) refused: Option<String>,
    /// The areas of the selection, of its copies, or of the thing that is put down.
    pub(super) areas: Vec<Rect>,
    pub(super) guides: Vec<SnapGuide>,
    /// The gaps to the neighbours.
    pub(super) gaps: Vec<NeighbourGap>,
    /// The edges that the floor stops.
    pub(super) stopped: Edges,
    /// The distance from the selection to its copies, while the gesture makes copies.
    pub(super) copied_by: Option<Vec2>,
    pub(super) lasso: Option<Rect>,
}

/// The conditions under which places snap.
#[derive(Clone, Copy)]
pub(super) struct Snapping {
    pub(super) map: ScreenFromFloor,
    /// Whether the user holds the key that turns snapping off.
    pub(super) is_off: bool,
}

/// A place that a gesture wants, as the floor and its neighbours give it.
pub(super) struct SnappedArea {
    pub(super) area: Rect,
    guides: Vec<SnapGuide>,
    gaps: Vec<NeighbourGap>,
    stopped: Edges,
}

impl SnappedArea {
    /// The result without a layout.
    pub(super) fn result(self, areas: Vec<Rect>) -> GestureResult {
        let Self { guides, gaps, stopped, .. } = self;
        GestureResult { areas, guides, gaps, stopped, ..GestureResult::default() }
    }
}

impl Snapping {
    /// `area`, whose `edges` are dragged, with these edges at the best lines in reach and stopped by the floor.
    /// `neighbours` tells which records attract it.
    pub(super) fn snap(
        self,
        edited: &EditedLayout,
        area: Rect,
        edges: Edges,
        neighbours: impl Fn(&Item) -> bool,
    ) -> SnappedArea {
        let others = edited.items.iter().filter(|item| {
            item.is_on(edited.page) && !item.is_group && !edited.is_hidden(&item.record) && neighbours(item)
        });
        let of = |lists: &'static [RecordList]| {
            let is_of = move |item: &&&Item| item.record.list().is_some_and(|list| lists.contains(&list));
            let cells = |item: &&Item| {
                let cells = edited.layout().widgets.get(item.widgets.clone()).unwrap_or_default();
                let cells: Vec<Rect> = cells.iter().map(|widget| widget.area).collect();
                if cells.is_empty() { vec![item.area] } else { cells }
            };
            others.clone().collect::<Vec<_>>().iter().filter(is_of).flat_map(cells).collect::<Vec<Rect>>()
        };
        let lines = of(&[RecordList::Widgets, RecordList::Regions, RecordList::Stances]);
        let row = of(&[RecordList::Widgets, RecordList::Stances]);
        let geometry = &edited.document.floor().geometry;
        let (mut area, mut guides) = (area, Vec::new());
        if !self.is_off {
            let step_m = round_step_m(edited.document.unit_m(), geometry);
            let reach_m = PULL / self.map.scale();
            let grid = SnapGrid { geometry, neighbours: &lines, row: &row, reach_m, step_m };
            (area, guides) = grid.snap(area, edges);
        }
        // Round numbers need no line, and equal gaps show themselves.
        guides.retain(|guide| !matches!(guide.reason, SnapReason::Round | SnapReason::Spacing));
        let (area, stopped) = edges.stopped(area, geometry.bounds());
        SnappedArea { area, guides, gaps: gaps_around(area, &row), stopped }
    }
}

/// The result of moving the given edges of the selection by `by`.
pub(super) fn moving(edited: &EditedLayout, by: Vec2, edges: Edges, snapping: Snapping) -> GestureResult {
    let items = edited.selected_items();
    let Some(all) = crate::edit::around(items.iter().map(|item| item.area)) else {
        return GestureResult::default();
    };
    let is_other = |item: &Item| !edited.selected.iter().any(|selected| item.record.is_within(selected));
    let snapped = snapping.snap(edited, edges.moved(all, by, LEAST_M), edges, is_other);
    let areas = match items[..] {
        [_] => vec![snapped.area],
        _ => shifted(&items, snapped.area.min - all.min),
    };
    let pairs: Vec<(&Item, Rect)> = items.iter().copied().zip(areas.iter().copied()).collect();
    let tried = edited.document.placing(&pairs).and_then(|edits| edited.document.trial(&edits));
    let (layout, refused) = match tried {
        Ok(layout) => (Some(layout), None),
        Err(refusal) => (None, Some(refusal.short())),
    };
    GestureResult { layout, refused, ..snapped.result(areas) }
}

/// The result of putting copies of the selection down at a distance of `by`.
pub(super) fn copying(edited: &EditedLayout, by: Vec2, snapping: Snapping) -> GestureResult {
    let items = edited.selected_items();
    let Some(all) = crate::edit::around(items.iter().map(|item| item.area)) else {
        return GestureResult::default();
    };
    let moved = Edges::ALL.moved(all, by, LEAST_M);
    let snapped = snapping.snap(edited, moved, Edges::ALL, |_| true);
    let by = snapped.area.min - all.min;
    let copies = edited.document.duplicating(&edited.selected, by);
    let tried = copies.and_then(|(edits, _)| edited.document.trial(&edits));
    let (layout, refused) = match tried {
        Ok(layout) => (Some(layout), None),
        Err(refusal) => (None, Some(refusal.short())),
    };
    GestureResult { layout, refused, copied_by: Some(by), ..snapped.result(shifted(&items, by)) }
}

fn shifted(items: &[&Item], by: Vec2) -> Vec<Rect> {
    items.iter().map(|item| Rect::new(item.area.min + by, item.area.max + by)).collect()
}

/// The rectangle with these two corners.
pub(super) fn rect_between(a: Vec2, b: Vec2) -> Rect {
    Rect::new(a.min(b), a.max(b))
}
