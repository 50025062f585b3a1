//! Bars with messages: notices of the program, warnings about the layout, problems of its file.

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{Align, Layout, Margin, Panel, RichText, ScrollArea, Ui, WidgetInfo};

use crate::preview::feed::Warnings;
use crate::preview::messages::WindowMessages;
use crate::preview::style::{panel_colour, quiet};
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Shows the warnings of `underfoot check` about the layout, if there are any.
pub(in crate::preview) fn warnings(ui: &mut Ui, theme: &Theme, warnings: &Warnings) {
    if warnings.count == 0 {
        return;
    }
    let frame = egui::Frame::new()
        .fill(color(panel_colour(theme).mix(theme.warning, 0.05)))
        .inner_margin(Margin { left: 14, right: 8, top: 8, bottom: 8 });
    let panel = Panel::bottom("warnings").frame(frame).resizable(true);
    panel.default_size(180.0).size_range(70.0..=(0.5 * ui.available_height()).max(71.0)).show(ui, |ui| {
        ui.label(RichText::new("Trouble for feet and eyes").size(14.5).strong());
        ScrollArea::both().auto_shrink(false).show(ui, |ui| {
            let text = RichText::new(&warnings.text).monospace().size(12.5).color(color(theme.ink));
            ui.add(egui::Label::new(text).extend().selectable(true));
        });
    });
}

/// Shows messages of the program until the user closes them.
pub(in crate::preview) fn notices(ui: &mut Ui, theme: &Theme, messages: &mut WindowMessages) {
    if messages.notes.is_empty() {
        return;
    }
    let ground = color(panel_colour(theme).mix(theme.warning, 0.12));
    let frame = egui::Frame::new().fill(ground).inner_margin(Margin::symmetric(14, 4));
    let mut put_away = None;
    Panel::top("notices").frame(frame).resizable(false).show(ui, |ui| {
        for (index, note) in messages.notes.iter().enumerate() {
            ui.horizontal(|ui| {
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    let button = ui.small_button("Hide");
                    button.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Hide: {note}")));
                    if button.clicked() {
                        put_away = Some(index);
                    }
                    ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                        ui.add(egui::Label::new(RichText::new(note).color(color(theme.ink))).wrap());
                    });
                });
            });
        }
    });
    if let Some(index) = put_away {
        messages.notes.remove(index);
    }
}

/// Shows the problems of the layout file, under the floor with the last good layout.
pub(in crate::preview) fn problems(ui: &mut Ui, theme: &Theme, messages: &WindowMessages) {
    let Some(file) = &messages.file else { return };
    let Some(diagnostics) = &file.diagnostics else { return };
    let frame = egui::Frame::new()
        .fill(color(panel_colour(theme).mix(theme.fault, 0.05)))
        .inner_margin(Margin { left: 14, right: 8, top: 8, bottom: 8 });
    let half = 0.45 * ui.available_height();
    let panel = Panel::bottom("problems").frame(frame).resizable(true);
    panel
        .default_size((0.33 * ui.available_height()).clamp(90.0, 230.0))
        .size_range(70.0..=half.max(71.0))
        .show(ui, |ui| {
            let title = format!("{} has problems", file.name);
            ui.horizontal(|ui| {
                ui.label(RichText::new(title).size(14.5).strong().color(color(theme.fault)));
                let rest = "The floor keeps the last good layout; saving a better file replaces it.";
                ui.add(egui::Label::new(quiet(theme, rest)).truncate());
            });
            ScrollArea::both().auto_shrink(false).show(ui, |ui| {
                let text = RichText::new(diagnostics).monospace().size(12.5).color(color(theme.ink));
                ui.add(egui::Label::new(text).extend().selectable(true));
            });
        });
}
