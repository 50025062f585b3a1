//! The top bar: title, file, state of the link, and the buttons.

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::containers::menu::{MenuButton, MenuConfig};
use eframe::egui::{Align, Key, Layout, Margin, Panel, PopupCloseBehavior, RichText, Ui, WidgetInfo};

use super::TWO_LINES;
use crate::preview::app::App;
use crate::preview::closing::file_name;
use crate::preview::feed::{LayoutCause, PreviewCommand};
use crate::preview::rehearsal::Rehearsal;
use crate::preview::shown::ShownFloor;
use crate::preview::style::{panel_frame, pill, quiet, selectable, toggle};
use underfoot::wire::LinkState;
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::{Show, Theme, in_drawn_order};

/// Time for which the window reports that a saved file was loaded, in seconds.
pub(in crate::preview) const TELL_S: f64 = 6.0;

/// The choice of layouts, and whether the warnings are listed.
pub(in crate::preview) struct TopBar {
    /// Names of the layouts that the window can open.
    pub(in crate::preview) choices: Vec<String>,
    /// Whether the warnings about the layout are listed below the floor.
    pub(in crate::preview) lists_warnings: bool,
}

impl TopBar {
    /// Shows the layout's title, as a menu if there is a choice; returns the index of the layout to open.
    fn title(&self, ui: &mut Ui, theme: &Theme, title: &str) -> Option<usize> {
        if self.choices.is_empty() {
            let text = RichText::new(in_drawn_order(title)).size(17.0).strong().color(color(theme.ink));
            ui.add(egui::Label::new(text).truncate());
            return None;
        }
        let mut chosen = None;
        let text = RichText::new(in_drawn_order(title)).size(15.0).color(color(theme.ink));
        let menu = egui::ComboBox::from_id_salt("layout").selected_text(text).width(150.0);
        let response = menu.show_ui(ui, |ui| {
            for (index, choice) in self.choices.iter().enumerate() {
                if ui.selectable_label(*choice == title, choice).clicked() {
                    chosen = Some(index);
                }
            }
        });
        response.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, "Layout"));
        chosen
    }
}

impl App {
    /// Shows the title, the file and the buttons.
    pub(in crate::preview) fn show_top_bar(&mut self, ui: &mut Ui) {
        let theme = self.appearance.theme();
        let frame = panel_frame(&theme, Margin::symmetric(14, 7));
        Panel::top("top bar").frame(frame).resizable(false).show(ui, |ui| {
            if ui.available_width() < TWO_LINES {
                ui.horizontal(|ui| {
                    ui.set_min_height(26.0);
                    self.heading(ui, &theme);
                    mutes(ui, &theme, &self.shown, self.rehearsal.as_ref());
                    link_state(ui, &theme, &self.shown, self.time_line.is_some());
                });
                ui.horizontal_wrapped(|ui| self.buttons(ui));
                return;
            }
            ui.horizontal(|ui| {
                ui.set_min_height(26.0);
                // Lay out from the right first: the title shrinks.
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    link_state(ui, &theme, &self.shown, self.time_line.is_some());
                    self.buttons(ui);
                    // Left of the buttons, so that those keep their places.
                    mutes(ui, &theme, &self.shown, self.rehearsal.as_ref());
                    ui.with_layout(Layout::left_to_right(Align::Center), |ui| self.heading(ui, &theme));
                });
            });
        });
    }

    fn heading(&mut self, ui: &mut Ui, theme: &Theme) {
        if let Some(index) = self.top_bar.title(ui, theme, &self.shown.layout().title) {
            self.shown.command(PreviewCommand::Open(index));
            if let (Some(designer), Some(name)) = (&mut self.designer, self.top_bar.choices.get(index)) {
                designer.open_choice(name);
            }
        }
        if let Some(designer) = &self.designer {
            file_name(ui, theme, designer);
        }
        // In Design mode, the design bar shows its own count, which leads to each problem.
        let count = self.shown.messages.warnings.count;
        if count > 0 && !self.is_designing() {
            let text = if count == 1 { "1 warning".to_owned() } else { format!("{count} warnings") };
            let text = RichText::new(text).color(color(theme.warning));
            toggle(ui, &mut self.top_bar.lists_warnings, text, "Trouble for feet and eyes");
        }
        file_news(ui, theme, &self.shown, self.designer.is_none());
    }

    fn buttons(&mut self, ui: &mut Ui) {
        self.appearance.menu(ui, &mut self.shown.messages);
        let is_checking = self.is_checking();
        if let Some(designer) = &mut self.designer {
            designer.mode_button(ui, is_checking, &mut self.feet);
        }
        self.panel.button(ui);
        let (tries, plots) = (!self.is_designing(), &mut self.plots.is_open);
        let button = egui::Button::selectable(*plots && tries, "Plots").frame_when_inactive(true);
        let button = ui.add_enabled(tries, button);
        if button.on_hover_text("Forces and values over time; P does the same").clicked() {
            *plots = !*plots;
        }
        layers_menu(ui, &mut self.view.show);
        if self.shown.scopes.is_fed() {
            let muted = self.shown.snapshot().muted.all;
            if selectable(ui, muted, "Mute", "Let nothing be felt or heard; M does the same") {
                self.shown.command(PreviewCommand::Mute(!muted));
            }
        }
        if let Some(tuner) = &mut self.tuner {
            toggle(ui, &mut tuner.is_open, "Effects", "Tune what controls feel like: see, hear and save");
        }
        let projects = self.projection.is_open();
        let hint =
            "The floor alone, in a window of its own for a projector; F11 does the same, C there adjusts it";
        if selectable(ui, projects, "Project", hint) {
            self.projection.toggle();
        }
        self.feet.stance_button(ui, &self.shown);
        self.show_visit_button(ui);
    }
}

/// Shows the result of the last change to the layout file; `names_file` shows its name in the meantime too.
fn file_news(ui: &mut Ui, theme: &Theme, shown: &ShownFloor, names_file: bool) {
    match &shown.messages.file {
        Some(file) if file.diagnostics.is_some() => {
            pill(ui, theme.fault, theme, &format!("{} has problems", file.name));
        }
        Some(file) if shown.now_s - file.at_s < TELL_S && !file.came_by_itself() => {
            let what = match file.cause {
                Some(LayoutCause::Opened) => "opened",
                Some(LayoutCause::Served) => "on the server’s floor",
                _ => "saved changes loaded",
            };
            pill(ui, theme.good, theme, &format!("{}: {what}", file.name));
        }
        Some(file) if names_file => {
            ui.add(egui::Label::new(quiet(theme, &file.name)).truncate());
        }
        _ => {}
    }
}

/// Shows the number of simulated faults and the muted parts.
fn mutes(ui: &mut Ui, theme: &Theme, shown: &ShownFloor, rehearsal: Option<&Rehearsal>) {
    let rehearsed = rehearsal.map_or(0, Rehearsal::count);
    if rehearsed > 0 {
        let text = if rehearsed == 1 { "1 fault on".into() } else { format!("{rehearsed} faults on") };
        pill(ui, theme.warning, theme, &text)
            .on_hover_text("Faults are rehearsed; the side panel mends them");
    }
    match &shown.snapshot().muted {
        muted if muted.all => {
            pill(ui, theme.warning, theme, "muted").on_hover_text("Nothing is felt or heard");
        }
        muted if !muted.is_nothing() => {
            let text = format!("{} muted", muted.tiles.len());
            pill(ui, theme.warning, theme, &text).on_hover_text("Tiles that are not felt");
        }
        _ => {}
    }
}

/// Shows the state of the link; for a recording, the state at the time on display.
fn link_state(ui: &mut Ui, theme: &Theme, shown: &ShownFloor, is_recorded: bool) {
    let state = shown.snapshot().link;
    let (text, colour) = link(state, theme);
    match (is_recorded, state) {
        (false, _) => drop(pill(ui, colour, theme, text)),
        (true, LinkState::Live) => {
            pill(ui, theme.accent, theme, "replay").on_hover_text("A recording is shown");
        }
        (true, _) => {
            let hint = "A recording is shown, in which the floor was so";
            pill(ui, colour, theme, &format!("replay: {text}")).on_hover_text(hint);
        }
    }
}

/// A menu of the layers over the floor; it stays open after a click.
fn layers_menu(ui: &mut Ui, show: &mut Show) {
    let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    MenuButton::new("Layers").config(config).ui(ui, |ui| {
        ui.set_min_width(170.0);
        for (name, layer) in Show::LAYERS {
            ui.checkbox(layer(show), name);
        }
        ui.separator();
        ui.horizontal(|ui| {
            if ui.button("All").clicked() {
                Show::LAYERS.iter().for_each(|(_, layer)| *layer(show) = true);
            }
            if ui.button("Usual").clicked() {
                *show = Show::WINDOW;
            }
        });
    });
}

/// Mutes or unmutes everything, unless a text field has the focus.
pub(in crate::preview) fn handle_mute_key(ui: &Ui, shown: &ShownFloor) {
    let is_free = ui.ctx().memory(|memory| memory.focused().is_none());
    if is_free && shown.scopes.is_fed() && ui.input(|i| i.key_pressed(Key::M)) {
        shown.command(PreviewCommand::Mute(!shown.snapshot().muted.all));
    }
}

fn link(state: LinkState, theme: &Theme) -> (&'static str, underfoot::layout::Colour) {
    match state {
        LinkState::Waiting => ("waiting", theme.warning),
        LinkState::Live => ("live", theme.good),
        LinkState::Partial => ("partial", theme.warning),
        LinkState::Lost => ("lost", theme.fault),
    }
}
