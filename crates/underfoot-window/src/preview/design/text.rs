//! The layout's text beside the floor: the text and the floor show the same selection.

use std::ops::Range;

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::text::CCursor;
use eframe::egui::text_selection::CCursorRange;
use eframe::egui::{Margin, Panel, ScrollArea, TextEdit, Ui, WidgetInfo};

use super::edited::EditedLayout;
use super::{Pane, Panes};
use crate::edit::Address;
use crate::preview::handheld::panel_at;
use crate::preview::stage::StageOfWindow;
use crate::preview::style::{panel_frame, quiet};
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// The text editor.
#[derive(Default)]
pub(super) struct Editor {
    pub(super) is_open: bool,
    text: String,
    /// The revision of the document on display; it differs from the current one after a change elsewhere.
    revision: Option<u64>,
    /// The problems of the text.
    problems: Option<String>,
    /// The selection when the text was last drawn.
    selected: Option<Address>,
    stroke: u64,
}

/// The first stroke number of typing, above those of drags, which count from 0.
const TYPING: u64 = 1 << 32;

impl Editor {
    /// Shows the text, at most `widest` points wide.
    pub(super) fn panel(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        edited: &mut EditedLayout,
        panes: &mut Panes,
        stage: &StageOfWindow,
    ) {
        let frame = panel_frame(theme, Margin { left: 10, right: 4, top: 6, bottom: 6 });
        let panel = panel_at(stage.sheet(), || {
            let widest = stage.widest();
            let panel = Panel::right("layout text").resizable(true).default_size(430.0);
            panel.size_range(240.0_f32.min(widest)..=widest)
        });
        panel.frame(frame).show(ui, |ui| {
            if let Some(problems) = self.problems.clone() {
                let frame = egui::Frame::new().fill(color(theme.fault).gamma_multiply(0.08));
                Panel::bottom("text problems").frame(frame.inner_margin(6)).show(ui, |ui| {
                    ui.label(quiet(theme, "The floor keeps the last text that could be read."));
                    ScrollArea::both().max_height(150.0).show(ui, |ui| {
                        let text = egui::RichText::new(problems).monospace().size(11.5);
                        ui.add(egui::Label::new(text.color(color(theme.fault))).extend().selectable(true));
                    });
                });
            }
            ScrollArea::both().auto_shrink(false).show(ui, |ui| self.show(ui, theme, edited, panes));
        });
    }

    fn show(&mut self, ui: &mut Ui, theme: &Theme, edited: &mut EditedLayout, panes: &mut Panes) {
        if self.revision != Some(edited.document.revision()) {
            self.text = edited.document.text().to_owned();
            self.revision = Some(edited.document.revision());
            self.problems = None;
            self.stroke += 1;
        }
        let id = egui::Id::unique("layout text");
        let edit = TextEdit::multiline(&mut self.text).id(id).code_editor().desired_width(f32::INFINITY);
        let shown = edit.frame(egui::Frame::new()).show(ui);
        let response = &shown.response.response;
        if panes.leads_to(Pane::Text) {
            response.request_focus();
        }
        response.widget_info(|| WidgetInfo::labeled(Role::MultilineTextInput, true, "Text of the layout"));
        if response.changed() {
            let text = self.text.clone();
            match edited.document.write(&text, Some(TYPING + self.stroke)) {
                Ok(()) => {
                    self.revision = Some(edited.document.revision());
                    self.problems = None;
                }
                Err(problems) => self.problems = Some(problems.to_string()),
            }
        }
        let is_same = self.problems.is_none() && self.text == edited.document.text();
        if !is_same {
            return;
        }
        // The record under the text cursor becomes the selection.
        if response.has_focus()
            && let Some(cursor) = shown.cursor_range
        {
            let at = bytes(&self.text, cursor.primary.index.0);
            if let Some(record) = edited.document.record_at(at)
                && edited.selected.first() != Some(&record)
            {
                edited.select_only(record);
            }
            self.selected = edited.selected.first().cloned();
        }
        let Some(record) = edited.selected.first() else {
            self.selected = None;
            return;
        };
        let Some(span) = edited.document.span(record) else { return };
        let chars = characters(&self.text, &span);
        let at = |index: usize| shown.galley.pos_from_cursor(CCursor::new(index));
        let (first, last) = (at(chars.start), at(chars.end));
        let mark = egui::Rect::from_min_max(
            egui::pos2(ui.min_rect().left(), shown.galley_pos.y + first.top()),
            egui::pos2(ui.min_rect().right(), shown.galley_pos.y + last.bottom()),
        );
        ui.painter().rect_filled(mark, 2, color(theme.accent).gamma_multiply(0.14));
        if self.selected.as_ref() != Some(record) {
            self.selected = Some(record.clone());
            let mut state = shown.state;
            let range = CCursorRange::one(CCursor::new(chars.start));
            state.cursor.set_char_range(Some(range));
            state.store(ui.ctx(), id);
            ui.scroll_to_rect(mark, Some(egui::Align::Center));
        }
    }
}

/// The byte offset of the character number `index`.
fn bytes(text: &str, index: usize) -> usize {
    text.char_indices().nth(index).map_or(text.len(), |(at, _)| at)
}

/// The range of characters that covers these bytes.
fn characters(text: &str, span: &Range<usize>) -> Range<usize> {
    let count = |to: usize| text.get(..to).map_or(0, |text| text.chars().count());
    count(span.start)..count(span.end)
}
