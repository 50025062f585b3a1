//! Gestures of the pointer on the canvas: selects, moves, sizes and puts down.

use eframe::egui;
use eframe::egui::{CursorIcon, Key, PointerButton, Pos2, Ui, pos2};
use glam::Vec2;

use super::canvas::Canvas;
use super::edited::EditedLayout;
use crate::edit::{Address, Edges, Item, RecordList, SnapGrid, SnapGuide};
use crate::preview::pointer::way_while_down;
use underfoot::floor::Rect;
use underfoot::layout::Layout;
use underfoot_scene::egui_painter::ScreenFromFloor;

/// Half the side of a handle, and the distance within which the pointer grabs it, in points.
pub(super) const HANDLE: f32 = 5.0;
const NEAR: f32 = 9.0;

/// Distance within which a guide line attracts, in points.
const PULL: f32 = 7.0;

/// Travel of the pointer that turns a press into a drag, in points.
const SLACK: f32 = 4.0;

/// Minimum width and depth from dragging, in metres; the format allows 0.05 tiles.
const LEAST_M: f32 = 0.03;

/// The current gesture of the pointer.
#[derive(Clone, Debug, Default)]
pub(super) enum PointerGesture {
    #[default]
    None,
    /// Pressed on a record, which moves once the pointer goes further.
    Pressed { at: Pos2, record: Address },
    /// The selection follows the pointer.
    Moving { from: Vec2, edges: Edges },
    /// The pointer draws a rectangle around the records to select.
    Lasso { from: Vec2 },
    /// The view follows the pointer.
    Panning,
}

impl Canvas {
    /// Follows the pointer; returns the result that a release would have now.
    pub(super) fn gestures(
        &mut self,
        ui: &Ui,
        canvas: &egui::Response,
        map: ScreenFromFloor,
        screen: egui::Rect,
        edited: &mut EditedLayout,
    ) -> GestureResult {
        let (pointer, pressed, released, space, shift, alt) = ui.input(|i| {
            (
                i.pointer.interact_pos().or(i.pointer.hover_pos()),
                i.pointer.primary_pressed(),
                i.pointer.primary_released(),
                i.key_down(Key::Space),
                i.modifiers.shift,
                i.modifiers.alt,
            )
        });
        let Some(pointer) = pointer else { return GestureResult::default() };
        let inside = canvas.contains_pointer() || canvas.rect.contains(pointer) && self.placing.is_some();
        let at = map.floor(pointer);
        let button = match self.gesture {
            PointerGesture::Panning => Some(PointerButton::Primary),
            _ => Some(PointerButton::Middle).filter(|_| inside),
        };
        let panned = button.map_or(egui::Vec2::ZERO, |button| ui.input(|i| way_while_down(i, button)));
        if panned != egui::Vec2::ZERO {
            self.view.pan(panned, screen);
            ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
        }
        if let Some(thing) = self.placing.clone() {
            // For a drag onto the canvas, the press began elsewhere.
            let dropped = released && !canvas.clicked() && !canvas.drag_stopped();
            return self.put_down(edited, &thing, at, inside, pressed, dropped, map, alt);
        }
        if pressed && inside {
            canvas.request_focus();
            ui.ctx().memory_mut(|memory| memory.surrender_focus(canvas.id));
            edited.stroke += 1;
            self.begin_gesture(edited, (pointer, at), map, space, shift);
        }
        if let PointerGesture::Pressed { at: from, record } = self.gesture.clone()
            && from.distance(pointer) > SLACK
        {
            if !edited.selected.contains(&record) {
                edited.select_only(record);
            }
            self.gesture = PointerGesture::Moving { from: map.floor(from), edges: Edges::ALL };
        }
        let trial = match &self.gesture {
            PointerGesture::Moving { from, edges } => moving(edited, at - *from, *edges, map, alt),
            PointerGesture::Lasso { from } => {
                GestureResult { lasso: Some(around(*from, at)), ..GestureResult::default() }
            }
            _ => GestureResult::default(),
        };
        if inside && matches!(self.gesture, PointerGesture::None) {
            hover(edited, ui, pointer, map);
        }
        if released {
            self.end_gesture(edited, &trial, shift, map);
        }
        trial
    }

    fn begin_gesture(
        &mut self,
        edited: &mut EditedLayout,
        (pointer, at): (Pos2, Vec2),
        map: ScreenFromFloor,
        space: bool,
        shift: bool,
    ) {
        if space {
            self.gesture = PointerGesture::Panning;
            return;
        }
        if let Some(edges) = handle_under(edited, pointer, map) {
            self.gesture = PointerGesture::Moving { from: at, edges };
            return;
        }
        match touched(edited, at) {
            // A region is behind everything: a drag across it selects with a rectangle, a click selects the region.
            Some(record)
                if record.list() == Some(RecordList::Regions) && !edited.selected.contains(&record) =>
            {
                self.gesture = PointerGesture::Lasso { from: at };
            }
            Some(record) if shift => edited.toggle(record),
            Some(record) => self.gesture = PointerGesture::Pressed { at: pointer, record },
            // Locked records are selected in the list.
            None => self.gesture = PointerGesture::Lasso { from: at },
        }
    }

    fn end_gesture(
        &mut self,
        edited: &mut EditedLayout,
        trial: &GestureResult,
        shift: bool,
        map: ScreenFromFloor,
    ) {
        match std::mem::take(&mut self.gesture) {
            // A second click on a group selects the member under the pointer.
            PointerGesture::Pressed { record, at } if edited.selected == [record.clone()] => {
                let inner = edited.document.item_at(&edited.items, edited.page, map.floor(at));
                edited.select_only(inner.filter(|inner| inner.is_within(&record)).unwrap_or(record));
            }
            PointerGesture::Pressed { record, .. } => edited.select_only(record),
            PointerGesture::Moving { .. } if !trial.areas.is_empty() => {
                let areas = trial.areas.clone();
                edited.move_to(&areas);
            }
            PointerGesture::Lasso { from } => {
                let Some(area) = trial.lasso else { return };
                if !shift {
                    edited.selected.clear();
                }
                if area.size().max_element() < 0.01 {
                    let record = touched(edited, from);
                    edited.selected.extend(record);
                    return;
                }
                let page = edited.page;
                let inside = edited.items.iter().filter(|item| {
                    item.record.list() == Some(RecordList::Widgets)
                        && !item.is_group
                        && item.is_on(page)
                        && item.area.overlaps(area)
                        && !edited.is_locked(&item.record)
                        && !edited.is_hidden(&item.record)
                });
                let found: Vec<Address> = inside.map(|item| group_of(&item.record)).collect();
                for record in found {
                    if !edited.selected.contains(&record) {
                        edited.selected.push(record);
                    }
                }
            }
            _ => {}
        }
    }

    #[expect(clippy::too_many_arguments, reason = "what the pointer does in one frame")]
    fn put_down(
        &mut self,
        edited: &mut EditedLayout,
        thing: &super::palette::PaletteThing,
        at: Vec2,
        inside: bool,
        pressed: bool,
        dropped: bool,
        map: ScreenFromFloor,
        alt: bool,
    ) -> GestureResult {
        if !inside {
            return GestureResult::default();
        }
        let size = thing.size(&edited.document.floor().geometry);
        let area = Rect::from_centre_size(at, size);
        let (area, guides) = snapped(edited, area, Edges::ALL, map, alt);
        // After a drag onto the canvas, the thing is put down on release; after a click, on the press.
        if pressed || dropped {
            if edited.put(thing, area) || dropped {
                self.placing = None;
            }
            return GestureResult::default();
        }
        GestureResult { areas: vec![area], guides, ..GestureResult::default() }
    }
}

/// The record to grab at `point`: the whole outermost group, unless a member of it is selected. Ignores locked
/// and hidden records.
fn touched(edited: &EditedLayout, point: Vec2) -> Option<Address> {
    let free = |item: &&Item| !edited.is_locked(&item.record) && !edited.is_hidden(&item.record);
    let free: Vec<Item> = edited.items.iter().filter(free).cloned().collect();
    let record = edited.document.item_at(&free, edited.page, point)?;
    let group = group_of(&record);
    let is_entered = edited.selected.iter().any(|one| *one != group && one.is_within(&group));
    Some(if is_entered { record } else { group })
}

/// The edges that the handle under the pointer drags, for a single selected record.
fn handle_under(edited: &EditedLayout, pointer: Pos2, map: ScreenFromFloor) -> Option<Edges> {
    let [item] = edited.selected_items()[..] else { return None };
    if !can_be_sized(item) || edited.is_locked(&item.record) {
        return None;
    }
    let near = handles(map.rect(item.area)).into_iter().find(|(at, _)| at.distance(pointer) <= NEAR);
    near.map(|(_, edges)| edges)
}

fn hover(edited: &EditedLayout, ui: &Ui, pointer: Pos2, map: ScreenFromFloor) {
    let icon = match handle_under(edited, pointer, map) {
        Some(Edges { north: false, south: false, .. }) => CursorIcon::ResizeHorizontal,
        Some(Edges { east: false, west: false, .. }) => CursorIcon::ResizeVertical,
        Some(edges) if edges.north == edges.east => CursorIcon::ResizeNeSw,
        Some(_) => CursorIcon::ResizeNwSe,
        None if ui.input(|i| i.key_down(Key::Space)) => CursorIcon::Grab,
        None => CursorIcon::Default,
    };
    ui.ctx().set_cursor_icon(icon);
}

/// The result of moving the given edges of the selection by `by`.
fn moving(edited: &EditedLayout, by: Vec2, edges: Edges, map: ScreenFromFloor, alt: bool) -> GestureResult {
    let items = edited.selected_items();
    let Some(all) = crate::edit::around(items.iter().map(|item| item.area)) else {
        return GestureResult::default();
    };
    let moved = edges.moved(all, by, LEAST_M);
    let (snapped, guides) = snapped(edited, moved, edges, map, alt);
    let shift = snapped.min - all.min;
    let areas: Vec<Rect> = match items[..] {
        [_] => vec![snapped],
        _ => items.iter().map(|item| Rect::new(item.area.min + shift, item.area.max + shift)).collect(),
    };
    let pairs: Vec<(&Item, Rect)> = items.iter().copied().zip(areas.iter().copied()).collect();
    let tried = edited.document.placing(&pairs).and_then(|edits| edited.document.trial(&edits));
    let (layout, refused) = match tried {
        Ok(layout) => (Some(layout), None),
        Err(refusal) => (None, Some(refusal.short())),
    };
    GestureResult { layout, refused, areas, guides, lasso: None }
}

fn snapped(
    edited: &EditedLayout,
    area: Rect,
    edges: Edges,
    map: ScreenFromFloor,
    alt: bool,
) -> (Rect, Vec<SnapGuide>) {
    if alt {
        return (area, Vec::new());
    }
    let others = edited.items.iter().filter(|item| {
        matches!(item.record.list(), Some(RecordList::Widgets | RecordList::Regions | RecordList::Stances))
            && item.is_on(edited.page)
            && !item.is_group
            && !edited.selected.iter().any(|selected| item.record.is_within(selected))
    });
    let neighbours: Vec<Rect> = others.map(|item| item.area).collect();
    let geometry = &edited.document.floor().geometry;
    let grid = SnapGrid { geometry, neighbours: &neighbours, reach_m: PULL / map.scale() };
    grid.snap(area, edges)
}

/// The result that a gesture would have if it ended now.
#[derive(Default)]
pub(super) struct GestureResult {
    /// The layout; `None` where it is refused or unchanged.
    pub(super) layout: Option<Layout>,
    /// The reason for a refusal.
    pub(super) refused: Option<String>,
    /// The areas of the selection, or of the thing that is put down.
    pub(super) areas: Vec<Rect>,
    pub(super) guides: Vec<SnapGuide>,
    pub(super) lasso: Option<Rect>,
}

/// The outermost group of a record; the record itself outside any group.
fn group_of(record: &Address) -> Address {
    let mut outermost = record.clone();
    while let Some((parent, ..)) =
        outermost.split().filter(|(parent, ..)| parent.list() == Some(RecordList::Widgets))
    {
        outermost = parent;
    }
    outermost
}

pub(super) fn can_be_sized(item: &Item) -> bool {
    !item.is_group && item.widgets.len() <= 1
}

fn around(a: Vec2, b: Vec2) -> Rect {
    Rect::new(a.min(b), a.max(b))
}

/// The handles around `shown`, each with the edges that it drags.
pub(super) fn handles(shown: egui::Rect) -> [(Pos2, Edges); 8] {
    let (x, y) = (shown.center().x, shown.center().y);
    let edges = |west, east, south, north| Edges { west, east, south, north };
    [
        (shown.left_top(), edges(true, false, false, true)),
        (shown.right_top(), edges(false, true, false, true)),
        (shown.left_bottom(), edges(true, false, true, false)),
        (shown.right_bottom(), edges(false, true, true, false)),
        (pos2(shown.left(), y), edges(true, false, false, false)),
        (pos2(shown.right(), y), edges(false, true, false, false)),
        (pos2(x, shown.bottom()), edges(false, false, true, false)),
        (pos2(x, shown.top()), edges(false, false, false, true)),
    ]
}
