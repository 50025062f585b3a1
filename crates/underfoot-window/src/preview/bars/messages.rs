//! Messages over the floor: they cover a part of it for a while, and never move it.

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{
    Align, Align2, Area, CollapsingHeader, Color32, Frame, Id, Layout, Margin, Order, Rect, RichText,
    ScrollArea, Ui, WidgetInfo, vec2,
};

use super::pills::file_news;
use crate::preview::feed::Warnings;
use crate::preview::handheld::is_for_fingers;
use crate::preview::messages::{FileNote, WindowMessages};
use crate::preview::shown::ShownFloor;
use crate::preview::style::{panel_colour, pill, quiet, small_button};
use underfoot::layout::Colour;
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Distance of messages from the edges of the canvas, in points.
const INSET: f32 = 8.0;

/// Share of the canvas that a list of problems or warnings covers at most.
const SHARE: f32 = 0.3;

/// The messages of one frame over the canvas.
pub(in crate::preview) struct MessageStack<'a> {
    pub(in crate::preview) theme: &'a Theme,
    /// The part of the window with the floor.
    pub(in crate::preview) canvas: Rect,
}

impl MessageStack<'_> {
    /// Shows notices and news at the upper edge, above those that `add` adds.
    pub(in crate::preview) fn upper(&self, ui: &Ui, shown: &mut ShownFloor, add: impl FnOnce(&mut Ui)) {
        let at = self.canvas.left_top() + vec2(INSET, INSET);
        let area = Area::new(Id::unique("messages")).order(Order::Middle).fixed_pos(at).constrain(false);
        area.show(ui.ctx(), |ui| {
            ui.set_max_width((self.canvas.width() - 2.0 * INSET).max(100.0));
            self.notices(ui, &mut shown.messages);
            if let Some(news) = file_news(shown) {
                self.tell(ui, self.theme.good, &news);
            }
            add(ui);
        });
    }

    /// Shows the problems of the layout file, and the warnings about the layout if `lists_warnings`, at the lower
    /// edge.
    pub(in crate::preview) fn lower(&self, ui: &Ui, messages: &WindowMessages, lists_warnings: bool) {
        let problems = messages.file.as_ref().and_then(|file| Some((file, file.diagnostics.as_ref()?)));
        let warnings = Some(&messages.warnings).filter(|warnings| lists_warnings && warnings.count > 0);
        if problems.is_none() && warnings.is_none() {
            return;
        }
        let at = self.canvas.left_bottom() + vec2(INSET, -INSET);
        let area = Area::new(Id::unique("problems")).order(Order::Middle).constrain(false);
        area.pivot(Align2::LEFT_BOTTOM).fixed_pos(at).show(ui.ctx(), |ui| {
            ui.set_width((self.canvas.width() - 2.0 * INSET).max(100.0));
            if let Some(warnings) = warnings {
                self.warnings(ui, warnings);
            }
            if let Some((file, diagnostics)) = problems {
                self.problems(ui, file, diagnostics);
            }
        });
    }

    /// The frame of a message about something as serious as `colour` tells.
    pub(in crate::preview) fn frame(&self, colour: Colour) -> Frame {
        message_frame(self.theme, colour)
    }

    /// Shows a short message.
    pub(in crate::preview) fn tell(&self, ui: &mut Ui, colour: Colour, text: &str) {
        Frame::new().fill(color(self.theme.plate)).corner_radius(9).show(ui, |ui| {
            pill(ui, colour, self.theme, text);
        });
    }

    /// Messages of the program, until the user closes them.
    fn notices(&self, ui: &mut Ui, messages: &mut WindowMessages) {
        let mut put_away = None;
        for (index, note) in messages.notes.iter().enumerate() {
            self.frame(self.theme.warning).show(ui, |ui| {
                ui.horizontal(|ui| {
                    let width = ui.available_width() - if is_for_fingers(ui) { 80.0 } else { 60.0 };
                    ui.allocate_ui_with_layout(
                        vec2(width, 20.0),
                        Layout::left_to_right(Align::Center),
                        |ui| {
                            ui.set_max_width(width);
                            ui.add(egui::Label::new(RichText::new(note).color(color(self.theme.ink))).wrap());
                        },
                    );
                    let button = small_button(ui, "Hide");
                    button.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Hide: {note}")));
                    if button.clicked() {
                        put_away = Some(index);
                    }
                });
            });
        }
        if let Some(index) = put_away {
            messages.notes.remove(index);
        }
    }

    /// The warnings of `underfoot check` about the layout.
    fn warnings(&self, ui: &mut Ui, warnings: &Warnings) {
        self.frame(self.theme.warning).show(ui, |ui| {
            ui.label(RichText::new("Trouble for feet and eyes").size(14.5).strong());
            self.listing(ui, "warnings", &warnings.text);
        });
    }

    /// The problems of the layout file, over the floor with the last good layout.
    fn problems(&self, ui: &mut Ui, file: &FileNote, diagnostics: &str) {
        self.frame(self.theme.fault).show(ui, |ui| {
            let title = format!("{} has problems", file.name);
            let title = RichText::new(title).size(14.5).strong().color(color(self.theme.fault));
            let header = CollapsingHeader::new(title).id_salt("file problems").default_open(true);
            header.show_unindented(ui, |ui| {
                let rest = "The floor keeps the last good layout; saving a better file replaces it.";
                ui.add(egui::Label::new(quiet(self.theme, rest)).truncate());
                self.listing(ui, "problem list", diagnostics);
            });
        });
    }

    fn listing(&self, ui: &mut Ui, id: &str, text: &str) {
        let area = ScrollArea::both().id_salt(id).max_height(SHARE * self.canvas.height());
        area.auto_shrink([false, true]).show(ui, |ui| {
            let text = RichText::new(text).monospace().size(12.5).color(color(self.theme.ink));
            ui.add(egui::Label::new(text).extend().selectable(true));
        });
    }
}

/// The frame of a message over the floor.
pub(in crate::preview) fn message_frame(theme: &Theme, colour: Colour) -> Frame {
    let edge: Color32 = color(colour).gamma_multiply(0.6);
    Frame::new()
        .fill(color(panel_colour(theme).mix(colour, 0.10)))
        .stroke(egui::Stroke::new(1.0, edge))
        .corner_radius(6)
        .inner_margin(Margin::symmetric(10, 5))
}
