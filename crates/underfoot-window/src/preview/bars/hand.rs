//! The top bar of a window in a hand: buttons for fingers with icons alone, in as many lines as they need.

use eframe::egui::{Align, Layout, Margin, Panel, Ui, vec2};

use super::help::help_menu;
use super::pills::{link_state, mutes};
use crate::preview::app::App;
use crate::preview::closing::file_name;
use crate::preview::handheld::{TARGET, with_word};
use crate::preview::style::panel_frame;
use underfoot::wire::LinkState;
use underfoot_scene::scene::Theme;

/// Gap between two buttons, in points.
const GAP: f32 = 2.0;

/// Least and greatest width of the title, in points.
const TITLE: (f32, f32) = (64.0, 280.0);

/// Shows the bar: modes, title, appearance and help in the first line, and the tools of the mode below it.
pub(super) fn hand_bar(app: &mut App, ui: &mut Ui, theme: &Theme) {
    let frame = panel_frame(theme, Margin::symmetric(4, 4));
    Panel::top("top bar").frame(frame).resizable(false).show(ui, |ui| {
        ui.spacing_mut().item_spacing = vec2(GAP, GAP);
        ui.horizontal(|ui| {
            app.mode_switch(ui, true);
            let room = ui.available_width() - app.top_bar.end_width - 2.0 * GAP;
            title(app, ui, theme, room.clamp(TITLE.0, TITLE.1));
            end(app, ui, theme);
        });
        ui.horizontal_wrapped(|ui| {
            match &mut app.designer {
                Some(designer) if designer.is_open => {
                    designer.tools(ui, theme, &mut app.top_bar.gallery);
                    designer.put_button(ui, &app.shown);
                    app.share_button(ui, true);
                    app.panel.button(ui, true, true);
                }
                _ => app.try_tools(ui, theme, true),
            }
            mutes(ui, theme, &app.shown, app.rehearsal.as_ref());
            let is_recorded = app.time_line.is_some();
            // A floor that works needs no words.
            if is_recorded || app.shown.snapshot().link != LinkState::Live {
                link_state(ui, theme, &app.shown, is_recorded);
            }
        });
    });
}

/// The title of the layout, or in Design mode the name of its file.
fn title(app: &mut App, ui: &mut Ui, theme: &Theme, width: f32) {
    let size = vec2(width, TARGET);
    ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
        ui.set_min_size(size);
        ui.set_max_width(width);
        match app.designer.as_ref().filter(|designer| designer.is_open) {
            Some(designer) => {
                ui.add_space(GAP);
                file_name(ui, theme, designer);
            }
            None => with_word(ui, |ui| app.top_bar.title(ui, theme, &app.shown.layout().title, width)),
        }
    });
}

/// Appearance and help, at the right end of the line.
fn end(app: &mut App, ui: &mut Ui, theme: &Theme) {
    let room = ui.available_width() - app.top_bar.end_width;
    if room > 0.0 {
        ui.add_space(room - GAP.min(room));
    }
    let left = ui.cursor().left();
    app.appearance.menu(ui, true, &mut app.shown.messages);
    let (activity, set_up) = (app.activity(), app.window.options.set_up);
    help_menu(ui, theme, activity, true, &mut app.appearance, set_up, &mut app.shown.messages);
    let width = ui.min_rect().right() - left;
    if (width - app.top_bar.end_width).abs() > 0.5 {
        app.top_bar.end_width = width;
        ui.ctx().request_repaint();
    }
}
