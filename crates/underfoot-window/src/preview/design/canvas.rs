//! The canvas: the floor with the layout, for editing.

use std::borrow::Cow;

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{Sense, Ui, WidgetInfo};

use super::edited::EditedLayout;
use super::gestures::{PointerGesture, reachable_at, touched};
use super::in_place::InPlace;
use super::marks::marks;
use super::menu::{begin, show_menu};
use super::palette::InHand;
use super::spacing_marks::spacing_marks;
use super::trial::GestureResult;
use crate::edit::{Address, Item, RecordList};
use crate::preview::labels::Labels;
use crate::preview::zoom::{ViewRoom, Zoom};
use underfoot::engine::Snapshot;
use underfoot::floor::Rect;
use underfoot::layout::Layout;
use underfoot_scene::egui_painter::{self, Palette, ScreenFromFloor};
use underfoot_scene::scene::{self, Scene, Show, Theme, View};

/// The drawing board, and the gesture of the pointer on it.
#[derive(Default)]
pub(super) struct Canvas {
    pub(super) view: Zoom,
    /// Whether the next frame shows the whole floor.
    fits: bool,
    scene: Scene,
    pub(super) scale: DrawnToScale,
    pub(super) gesture: PointerGesture,
    /// The thing that the next click or drag puts down.
    pub(super) placing: Option<InHand>,
    /// The text that is edited on the floor.
    pub(super) in_place: Option<InPlace>,
}

/// The optional marks that are drawn to scale.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct DrawnToScale {
    pub(super) shoes: bool,
    pub(super) reach: bool,
}

impl Canvas {
    /// Shows the floor in the remaining part of the window, fitted into `room`.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        palette: &mut Palette,
        edited: &mut EditedLayout,
        room: ViewRoom,
    ) {
        let rect = ui.available_rect_before_wrap();
        let canvas = ui.allocate_rect(rect, Sense::click_and_drag());
        canvas.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, "Drawing board"));
        let geometry = edited.document.floor().geometry;
        let show = Show { sensors: false, contacts: false, ..Show::WINDOW };
        let bounds = scene::extent(&geometry, show);
        if std::mem::take(&mut self.fits) {
            self.view = Zoom::fitted(bounds, room);
        }
        self.zoom(ui, &canvas, bounds, room);
        let map = self.view.map(bounds, room.stage);
        self.menu(&canvas, map, edited);
        let trial = if self.is_typed_under(ui, edited, map) {
            GestureResult::default()
        } else {
            self.gestures(ui, &canvas, map, room, edited)
        };
        self.edit_on_double_click(&canvas, map, edited);
        let shown = trial.layout.as_ref().unwrap_or_else(|| edited.document.layout());
        let shown = without_hidden(edited, shown);
        let snapshot = Snapshot { page: edited.page, ..Snapshot::default() };
        let pointer = canvas.hover_pos().map(|at| map.floor(at));
        let shoes = self.scale.shoes(edited.layout(), pointer);
        let view = View { show, shoes: &shoes, ..View::new(&geometry, &shown, &snapshot, theme) };
        scene::draw(&mut self.scene, &view);
        let painter = ui.painter_at(rect);
        egui_painter::paint(&painter, palette, &self.scene, map);
        let controls = shown.widgets.iter().filter(|widget| widget.is_on(edited.page));
        let taken = controls.map(|widget| widget.area).chain(self.scene.written());
        let mut notes = Labels::within(rect, taken.map(|area| map.rect(area)));
        self.scale.reach(&painter, map, theme, edited.layout(), &mut notes);
        marks(edited, ui, map, theme, &trial, &mut notes);
        spacing_marks(&painter, map, theme, geometry.bounds(), &trial, &mut notes);
        names(edited, ui, map);
        if let Some(mut editor) = self.in_place.take()
            && editor.show(ui, theme, map, edited)
        {
            self.in_place = Some(editor);
        }
    }

    /// Whether the pointer is over the text that is being edited.
    fn is_typed_under(&self, ui: &Ui, edited: &EditedLayout, map: ScreenFromFloor) -> bool {
        let editor = self.in_place.as_ref().and_then(|editor| editor.rect(edited, map));
        let pointer = ui.input(|i| i.pointer.interact_pos());
        editor.zip(pointer).is_some_and(|(editor, pointer)| editor.expand(3.0).contains(pointer))
    }

    /// Edits the text of the record under a double click.
    fn edit_on_double_click(
        &mut self,
        canvas: &egui::Response,
        map: ScreenFromFloor,
        edited: &mut EditedLayout,
    ) {
        let at = canvas.interact_pointer_pos().filter(|_| canvas.double_clicked() && self.placing.is_none());
        let Some(record) = at.and_then(|at| reachable_at(edited, map.floor(at))) else { return };
        edited.select_only(record.clone());
        let found = InPlace::text_of(edited, &record);
        begin(edited, &mut self.in_place, Some(found));
    }

    /// The menu of the right button, for the record under the pointer or for the selection around it.
    fn menu(&mut self, canvas: &egui::Response, map: ScreenFromFloor, edited: &mut EditedLayout) {
        if canvas.secondary_clicked()
            && let Some(at) = canvas.interact_pointer_pos()
        {
            self.placing = None;
            match touched(edited, map.floor(at)) {
                Some(record) if !edited.selected.contains(&record) => edited.select_only(record),
                Some(_) => {}
                None => edited.selected.clear(),
            }
        }
        canvas.context_menu(|ui| show_menu(ui, edited, &mut self.in_place));
    }

    fn zoom(&mut self, ui: &Ui, canvas: &egui::Response, bounds: Rect, room: ViewRoom) {
        let Some(pointer) = ui.input(|i| i.pointer.hover_pos()).filter(|_| canvas.contains_pointer()) else {
            return;
        };
        let (wheel, pinch) = ui.input(|i| (i.smooth_scroll_delta().y, i.zoom_delta()));
        let by = pinch * (wheel * 0.004).exp();
        if (by - 1.0).abs() > 1e-4 {
            self.view.about(pointer, by, bounds, room);
        }
    }

    /// Shows the whole floor again, from this frame on.
    pub(super) fn fit(&mut self) {
        self.fits = true;
    }
}

/// `layout` without the hidden records.
fn without_hidden<'l>(edited: &EditedLayout, layout: &'l Layout) -> Cow<'l, Layout> {
    if edited.hidden.is_empty() {
        return Cow::Borrowed(layout);
    }
    let hidden: Vec<&Item> = edited.items.iter().filter(|item| edited.is_hidden(&item.record)).collect();
    let is_left = |list: RecordList, index: usize| {
        !hidden.iter().any(|item| match list {
            RecordList::Widgets => item.widgets.contains(&index),
            _ => item.record == Address::of(list, index),
        })
    };
    let mut layout = layout.clone();
    keep(&mut layout.widgets, |index| is_left(RecordList::Widgets, index));
    keep(&mut layout.stances, |index| is_left(RecordList::Stances, index));
    let grounds: Vec<bool> = edited
        .items
        .iter()
        .filter(|item| item.record.list() == Some(RecordList::Grounds))
        .map(|item| !edited.is_hidden(&item.record))
        .collect();
    keep(&mut layout.grounds, |index| grounds.get(index).copied().unwrap_or(true));
    Cow::Owned(layout)
}

/// Gives screen readers, tests and scripts the place of the floor, and the name and place of each record.
fn names(edited: &EditedLayout, ui: &Ui, map: ScreenFromFloor) {
    let bounds = map.rect(edited.document.floor().geometry.bounds());
    let floor = ui.interact(bounds, ui.scope_id().with("floor"), Sense::hover());
    floor.widget_info(|| WidgetInfo::labeled(Role::Group, true, "Whole floor"));
    let is_seen = |item: &&Item| item.is_on(edited.page) && !item.is_group && !edited.is_hidden(&item.record);
    for item in edited.items.iter().filter(is_seen) {
        let id = ui.scope_id().with(("record", item.record.to_string()));
        let node = ui.interact(map.rect(item.area), id, Sense::hover());
        let is_selected = edited.selected.contains(&item.record);
        node.widget_info(|| {
            WidgetInfo::selected(Role::ListItem, true, is_selected, format!("On the floor: {}", item.name))
        });
    }
}

/// Removes the entries for which `is_left` returns false.
fn keep<T>(all: &mut Vec<T>, is_left: impl Fn(usize) -> bool) {
    let mut index = 0;
    all.retain(|_| {
        index += 1;
        is_left(index - 1)
    });
}
