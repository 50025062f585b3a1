//! Gestures of the pointer on the canvas: selects, moves, sizes and puts down.

use eframe::egui;
use eframe::egui::{CursorIcon, Key, PointerButton, Pos2, Ui, pos2};
use glam::Vec2;

use super::canvas::Canvas;
use super::edited::EditedLayout;
use super::trial::{GestureResult, Snapping, copying, moving, rect_between};
use crate::edit::{Address, Edges, Item, RecordList};
use crate::preview::pointer::way_while_down;
use crate::preview::zoom::ViewRoom;
use underfoot_scene::egui_painter::ScreenFromFloor;

/// Half the side of a handle, and the distance within which the pointer grabs it, in points.
pub(super) const HANDLE: f32 = 5.0;
const NEAR: f32 = 9.0;

/// Travel of the pointer that turns a press into a drag, in points.
pub(super) const SLACK: f32 = 4.0;

/// The current gesture of the pointer.
#[derive(Clone, Debug, Default)]
pub(super) enum PointerGesture {
    #[default]
    None,
    /// Pressed on a record, which moves once the pointer goes further.
    Pressed { at: Pos2, record: Address },
    /// The selection follows the pointer; with Alt, copies of it do.
    Moving { from: Vec2, edges: Edges },
    /// The thing to put down becomes as large as the pointer draws it.
    Drawing { from: Vec2 },
    /// The pointer draws a rectangle around the records to select.
    Lasso { from: Vec2 },
    /// The view follows the pointer.
    Panning,
}

/// The pointer over the canvas in one frame.
pub(super) struct Pressing {
    /// Its place on the floor.
    pub(super) at: Vec2,
    pub(super) inside: bool,
    pub(super) pressed: bool,
    pub(super) released: bool,
    /// Whether it brings the thing from the palette and lets go of it.
    pub(super) dropped: bool,
    /// Whether the thing to put down stays in hand for another one.
    pub(super) stays: bool,
}

impl Canvas {
    /// Follows the pointer; returns the result that a release would have now.
    pub(super) fn gestures(
        &mut self,
        ui: &Ui,
        canvas: &egui::Response,
        map: ScreenFromFloor,
        room: ViewRoom,
        edited: &mut EditedLayout,
    ) -> GestureResult {
        let (pointer, pressed, released, space, modifiers) = ui.input(|i| {
            (
                i.pointer.interact_pos().or(i.pointer.hover_pos()),
                i.pointer.primary_pressed(),
                i.pointer.primary_released(),
                i.key_down(Key::Space),
                i.modifiers,
            )
        });
        let (shift, snapping) = (modifiers.shift, Snapping { map, is_off: modifiers.command });
        let Some(pointer) = pointer else { return GestureResult::default() };
        let inside = canvas.contains_pointer() || canvas.rect.contains(pointer) && self.placing.is_some();
        let at = map.floor(pointer);
        let button = match self.gesture {
            PointerGesture::Panning => Some(PointerButton::Primary),
            _ => Some(PointerButton::Middle).filter(|_| inside),
        };
        let panned = button.map_or(egui::Vec2::ZERO, |button| ui.input(|i| way_while_down(i, button)));
        if panned != egui::Vec2::ZERO {
            self.view.pan(panned, room);
            ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
        }
        if let Some(hand) = self.placing.clone() {
            // For a drag onto the canvas, the press began elsewhere.
            let dropped = released && !canvas.clicked() && !canvas.drag_stopped();
            let pressing = Pressing { at, inside, pressed, released, dropped, stays: shift };
            return self.put_down(edited, hand, &pressing, snapping);
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
            PointerGesture::Moving { from, edges } if modifiers.alt && *edges == Edges::ALL => {
                copying(edited, at - *from, snapping)
            }
            PointerGesture::Moving { from, edges } => moving(edited, at - *from, *edges, snapping),
            PointerGesture::Lasso { from } => {
                GestureResult { lasso: Some(rect_between(*from, at)), ..GestureResult::default() }
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
            PointerGesture::Moving { .. } if trial.copied_by.is_some() => {
                edited.copy_by(trial.copied_by.unwrap_or_default());
            }
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
}

/// The record to grab at `point`: the whole outermost group, unless a member of it is selected. Ignores locked
/// and hidden records.
pub(super) fn touched(edited: &EditedLayout, point: Vec2) -> Option<Address> {
    let record = reachable_at(edited, point)?;
    let group = group_of(&record);
    let is_entered = edited.selected.iter().any(|one| *one != group && one.is_within(&group));
    Some(if is_entered { record } else { group })
}

/// The topmost record at `point` that is neither locked nor hidden; never a group.
pub(super) fn reachable_at(edited: &EditedLayout, point: Vec2) -> Option<Address> {
    let free = |item: &&Item| !edited.is_locked(&item.record) && !edited.is_hidden(&item.record);
    let free: Vec<Item> = edited.items.iter().filter(free).cloned().collect();
    edited.document.item_at(&free, edited.page, point)
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
