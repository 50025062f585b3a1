//! Text that is edited on the floor itself: a label, or an id.

use eframe::egui::accesskit::Role;
use eframe::egui::text::CCursor;
use eframe::egui::text_selection::CCursorRange;
use eframe::egui::{self, Key, TextEdit, Ui, UiBuilder, WidgetInfo, vec2};

use super::edited::EditedLayout;
use crate::edit::{Address, Edit, RecordList, quoted};
use underfoot_format::outline::Outline;
use underfoot_scene::egui_painter::{ScreenFromFloor, color};
use underfoot_scene::scene::Theme;

/// The field of a record that is edited where the record lies.
pub(super) struct InPlace {
    record: Address,
    field: &'static str,
    text: String,
    /// Whether it waits for the keyboard.
    is_new: bool,
}

/// Minimum size of the editor, in points.
const LEAST: egui::Vec2 = vec2(96.0, 24.0);

impl InPlace {
    /// Edits the text that people read on the record; a region and a group show their id.
    ///
    /// # Errors
    /// The reason why the record has no such text of its own.
    pub(super) fn text_of(edited: &EditedLayout, record: &Address) -> Result<Self, String> {
        let is_group = edited.item(record).is_some_and(|item| item.is_group);
        match record.list() {
            Some(RecordList::Grounds) | None => Err("a ground has no text".into()),
            Some(RecordList::Widgets) if edited.document.written(record, "repeat.labels").is_some() => {
                Err("the labels of this grid are in its `repeat`: Text shows them".into())
            }
            Some(RecordList::Widgets) if !is_group => Ok(Self::new(edited, record, "label")),
            Some(RecordList::Stances) => Ok(Self::new(edited, record, "label")),
            Some(_) => Ok(Self::new(edited, record, "id")),
        }
    }

    /// Edits the id of the record; a stance zone has a label only.
    ///
    /// # Errors
    /// The reason why the record has no id.
    pub(super) fn name_of(edited: &EditedLayout, record: &Address) -> Result<Self, String> {
        match record.list() {
            Some(RecordList::Grounds) | None => Err("a ground has no name".into()),
            Some(RecordList::Stances) => Ok(Self::new(edited, record, "label")),
            Some(RecordList::Widgets) if edited.document.written(record, "repeat.ids").is_some() => {
                Err("the ids of this grid are in its `repeat`: Text shows them".into())
            }
            Some(_) => Ok(Self::new(edited, record, "id")),
        }
    }

    fn new(edited: &EditedLayout, record: &Address, field: &'static str) -> Self {
        let written = edited.document.written(record, field).and_then(Outline::parse);
        let text = written.and_then(|value| value.says).unwrap_or_default();
        Self { record: record.clone(), field, text, is_new: true }
    }

    /// The part of the screen that it takes; `None` once its record is gone.
    pub(super) fn rect(&self, edited: &EditedLayout, map: ScreenFromFloor) -> Option<egui::Rect> {
        let shown = map.rect(edited.item(&self.record)?.area);
        Some(egui::Rect::from_center_size(shown.center(), vec2(shown.width().max(LEAST.x), LEAST.y)))
    }

    /// Shows the editor over its record; returns whether it stays. Enter and a click elsewhere apply the text, Escape
    /// leaves the old one.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        map: ScreenFromFloor,
        edited: &mut EditedLayout,
    ) -> bool {
        let Some(rect) = self.rect(edited, map) else { return false };
        let id = egui::Id::unique("text in place");
        let is_new = std::mem::take(&mut self.is_new);
        let frame = egui::Frame::new().fill(color(theme.plate)).inner_margin(2);
        let frame = frame.stroke(egui::Stroke::new(1.5, color(theme.accent))).corner_radius(3);
        let shown = ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
            let edit = TextEdit::singleline(&mut self.text).id(id).frame(frame);
            edit.desired_width(f32::INFINITY).show(ui)
        });
        let shown = shown.inner;
        let response = shown.response.response;
        let name = if self.field == "id" { "Id on the floor" } else { "Label on the floor" };
        response.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, name));
        if is_new {
            response.request_focus();
            let all = CCursorRange::two(CCursor::new(0), CCursor::new(self.text.chars().count()));
            let mut state = shown.state;
            state.cursor.set_char_range(Some(all));
            state.store(ui.ctx(), id);
            return true;
        }
        if !response.lost_focus() {
            return response.has_focus();
        }
        if ui.input(|i| i.key_pressed(Key::Escape)) || self.apply(edited) {
            return false;
        }
        // A refused text can be mended, or left with Escape.
        self.is_new = true;
        true
    }

    /// Writes the text; returns whether the layout accepts it.
    fn apply(&self, edited: &mut EditedLayout) -> bool {
        let before = Self::new(edited, &self.record, self.field);
        if before.text == self.text {
            return true;
        }
        let has_id = edited.document.id_of(&self.record).is_some();
        let edit = if self.field == "id" && has_id {
            Edit::Rename { record: self.record.clone(), id: self.text.clone() }
        } else {
            Edit::set(&self.record, self.field, quoted(&self.text))
        };
        edited.edit(&[edit])
    }
}
