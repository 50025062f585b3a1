//! The bars at the window's edges: state, buttons, help and problems.

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::containers::menu::{MenuButton, MenuConfig};
use eframe::egui::{
    Align, Key, Layout, Margin, Panel, PopupCloseBehavior, RichText, ScrollArea, Ui, WidgetInfo,
};

use super::app::App;
use super::feed::{LayoutCause, PreviewCommand};
use super::rehearsal::Rehearsal;
use super::style::{panel_colour, panel_frame, pill, quiet, selectable, toggle};
use underfoot::wire::LinkState;
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::{Show, Theme, in_drawn_order};

/// Width of the window below which the top bar takes two lines, in points.
const TWO_LINES: f32 = 1010.0;

/// Height of the window below which the help bar is hidden, in points.
const HELP: f32 = 560.0;

/// Time for which the window reports that a saved file was loaded, in seconds.
pub(super) const TELL_S: f64 = 6.0;

impl App {
    /// Shows the title, the file and the buttons.
    pub(super) fn top_bar(&mut self, ui: &mut Ui) {
        let frame = panel_frame(&self.theme, Margin::symmetric(14, 7));
        Panel::top("top bar").frame(frame).resizable(false).show(ui, |ui| {
            if ui.available_width() < TWO_LINES {
                ui.horizontal(|ui| {
                    ui.set_min_height(26.0);
                    self.heading(ui);
                    self.mutes(ui);
                    self.link_state(ui);
                });
                ui.horizontal_wrapped(|ui| self.buttons(ui));
                return;
            }
            ui.horizontal(|ui| {
                ui.set_min_height(26.0);
                // Lay out from the right first: the title shrinks.
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    self.link_state(ui);
                    self.buttons(ui);
                    // Left of the buttons, so that those keep their places.
                    self.mutes(ui);
                    ui.with_layout(Layout::left_to_right(Align::Center), |ui| self.heading(ui));
                });
            });
        });
    }

    fn heading(&mut self, ui: &mut Ui) {
        let title = self.messages.layout.title.clone();
        if self.choices.is_empty() {
            let text = RichText::new(in_drawn_order(&title)).size(17.0).strong().color(color(self.theme.ink));
            ui.add(egui::Label::new(text).truncate());
        } else {
            let mut chosen = None;
            let text = RichText::new(in_drawn_order(&title)).size(15.0).color(color(self.theme.ink));
            let menu = egui::ComboBox::from_id_salt("layout").selected_text(text).width(150.0);
            let response = menu.show_ui(ui, |ui| {
                for (index, choice) in self.choices.iter().enumerate() {
                    if ui.selectable_label(*choice == title, choice).clicked() {
                        chosen = Some(index);
                    }
                }
            });
            response.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, "Layout"));
            if let Some(index) = chosen {
                self.command(PreviewCommand::Open(index));
                self.design_choice(index);
            }
        }
        self.file_name(ui);
        // In Design mode, the design bar shows its own count, which leads to each problem.
        let count = self.messages.warnings.count;
        if count > 0 && !self.is_designing() {
            let text = if count == 1 { "1 warning".to_owned() } else { format!("{count} warnings") };
            let text = RichText::new(text).color(color(self.theme.warning));
            toggle(ui, &mut self.lists_warnings, text, "Trouble for feet and eyes");
        }
        match &self.messages.file {
            Some(file) if file.diagnostics.is_some() => {
                pill(ui, self.theme.fault, &self.theme, &format!("{} has problems", file.name));
            }
            Some(file) if self.now_s - file.at_s < TELL_S && !file.came_by_itself() => {
                let what = match file.cause {
                    Some(LayoutCause::Opened) => "opened",
                    Some(LayoutCause::Served) => "on the server’s floor",
                    _ => "saved changes loaded",
                };
                pill(ui, self.theme.good, &self.theme, &format!("{}: {what}", file.name));
            }
            _ if self.designer.is_some() => {}
            Some(file) => {
                ui.add(egui::Label::new(quiet(&self.theme, &file.name)).truncate());
            }
            None => {}
        }
    }

    /// Shows the number of simulated faults and the muted parts.
    fn mutes(&self, ui: &mut Ui) {
        let theme = &self.theme;
        let rehearsed = self.rehearsal.as_ref().map_or(0, Rehearsal::count);
        if rehearsed > 0 {
            let text = if rehearsed == 1 { "1 fault on".into() } else { format!("{rehearsed} faults on") };
            pill(ui, theme.warning, theme, &text)
                .on_hover_text("Faults are rehearsed; the side panel mends them");
        }
        match &self.snapshots.output_buffer().muted {
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
    fn link_state(&self, ui: &mut Ui) {
        let theme = &self.theme;
        let state = self.snapshots.output_buffer().link;
        let (text, colour) = link(state, theme);
        match (&self.time_line, state) {
            (None, _) => drop(pill(ui, colour, theme, text)),
            (Some(_), LinkState::Live) => {
                pill(ui, theme.accent, theme, "replay").on_hover_text("A recording is shown");
            }
            (Some(_), _) => {
                let hint = "A recording is shown, in which the floor was so";
                pill(ui, colour, theme, &format!("replay: {text}")).on_hover_text(hint);
            }
        }
    }

    fn buttons(&mut self, ui: &mut Ui) {
        self.appearance_menu(ui);
        self.mode_button(ui);
        let width = ui.ctx().content_rect().width();
        let shown = self.shows_panel(width);
        if selectable(ui, shown, "Panel", "Figures, events and actuators at the side") {
            self.panel_wanted = Some(!shown);
        }
        let (tries, plots) = (!self.is_designing(), &mut self.plots.is_open);
        let button = egui::Button::selectable(*plots && tries, "Plots").frame_when_inactive(true);
        let button = ui.add_enabled(tries, button);
        if button.on_hover_text("Forces and values over time; P does the same").clicked() {
            *plots = !*plots;
        }
        self.layers_menu(ui);
        if self.scopes.is_fed() {
            let muted = self.snapshots.output_buffer().muted.all;
            if selectable(ui, muted, "Mute", "Let nothing be felt or heard; M does the same") {
                self.command(PreviewCommand::Mute(!muted));
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
        let Some((feet, _)) = &mut self.feet else { return };
        let stands = feet.standing().is_some();
        let hint = "A second foot that stays where it is left; Space puts it under the mouse";
        if selectable(ui, stands, "Stance foot", hint) {
            if stands {
                feet.lift_standing();
            } else {
                let floor = self.floor.geometry.bounds();
                let place = self.messages.layout.stances.first().map(|stance| stance.area);
                // The usual place to stand without one in the layout: the middle of the south side.
                let south = floor.min + floor.size() * glam::Vec2::new(0.5, 0.12);
                feet.stand(place.map_or(south, |area| area.centre()).clamp(floor.min, floor.max));
            }
        }
    }

    /// A menu of the layers over the floor; it stays open after a click.
    fn layers_menu(&mut self, ui: &mut Ui) {
        let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
        MenuButton::new("Layers").config(config).ui(ui, |ui| {
            ui.set_min_width(170.0);
            for (name, layer) in Show::LAYERS {
                ui.checkbox(layer(&mut self.show), name);
            }
            ui.separator();
            ui.horizontal(|ui| {
                if ui.button("All").clicked() {
                    Show::LAYERS.iter().for_each(|(_, layer)| *layer(&mut self.show) = true);
                }
                if ui.button("Usual").clicked() {
                    self.show = Show::WINDOW;
                }
            });
        });
    }

    /// Mutes or unmutes everything, unless a text field has the focus.
    pub(super) fn handle_mute_key(&self, ui: &Ui) {
        let is_free = ui.ctx().memory(|memory| memory.focused().is_none());
        if is_free && self.scopes.is_fed() && ui.input(|i| i.key_pressed(Key::M)) {
            self.command(PreviewCommand::Mute(!self.snapshots.output_buffer().muted.all));
        }
    }

    /// Shows how to use the floor, if the window is tall enough.
    pub(super) fn help_bar(&self, ui: &mut Ui) {
        if ui.ctx().content_rect().height() < HELP {
            return;
        }
        let theme = &self.theme;
        let frame = panel_frame(theme, Margin::symmetric(14, 5));
        Panel::bottom("help bar").frame(frame).resizable(false).show(ui, |ui| {
            let steps: &[(&str, &str)] = if self.is_designing() {
                &[
                    ("Drag", "move"),
                    ("Corners", "size"),
                    ("Arrows", "nudge"),
                    ("Alt", "no snapping"),
                    ("Shift-click", "select more"),
                    ("Ctrl-D, Delete", "double, remove"),
                    ("Ctrl-Z", "undo"),
                    ("Wheel", "zoom"),
                    ("F2", "try it"),
                ]
            } else if self.is_checking() {
                &[("Step", "where the floor is marked"), ("Escape", "end the check")]
            } else if self.draws_walks() {
                &[
                    ("Drag", "a way over the floor: somebody walks it"),
                    ("End on a control", "they use it"),
                    ("Ctrl-wheel", "zoom"),
                    ("W, Escape", "be a foot again"),
                ]
            } else if self.feet.is_some() {
                &[
                    ("Hold", "press"),
                    ("Drag", "slide"),
                    ("Wheel, R, F", "harder, softer"),
                    ("Ctrl-wheel", "zoom"),
                    ("Right-drag, Q, E", "turn"),
                    ("Space", "stance foot here"),
                    ("Shift-click", "look at a tile"),
                    ("Tab, Enter", "press by keyboard"),
                    ("W", "draw a walk"),
                    ("F11", "project"),
                    ("P", "plots"),
                    ("M", "mute"),
                ]
            } else if self.time_line.is_some() {
                &[
                    ("Space", "pause"),
                    ("Comma, Period", "a step back, on"),
                    ("Shift-drag", "repeat a part"),
                    ("Click", "look at a tile"),
                    ("Ctrl-wheel", "zoom"),
                ]
            } else if self.scopes.is_fed() {
                &[("Click", "look at a tile"), ("Arrows", "the next one"), ("M", "mute")]
            } else {
                // Without rendering there is nothing to mute.
                &[("Click", "look at a tile"), ("Arrows", "the next one")]
            };
            // A narrow window shows the first ones only; the documentation lists the rest.
            let told = if ui.available_width() < TWO_LINES { 4 } else { steps.len() };
            ui.horizontal(|ui| {
                ui.spacing_mut().item_spacing.x = 5.0;
                for (key, does) in steps.iter().take(told) {
                    ui.label(RichText::new(*key).size(12.0).color(color(theme.ink)));
                    ui.label(RichText::new(*does).size(12.0).color(color(theme.quiet)));
                    ui.add_space(9.0);
                }
            });
        });
    }

    /// Shows the warnings of `underfoot check` about the layout, if they are switched on.
    pub(super) fn warnings(&mut self, ui: &mut Ui) {
        let warnings = &self.messages.warnings;
        if !self.lists_warnings || warnings.count == 0 {
            return;
        }
        let theme = &self.theme;
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
    pub(super) fn notices(&mut self, ui: &mut Ui) {
        if self.messages.notes.is_empty() {
            return;
        }
        let ground = color(panel_colour(&self.theme).mix(self.theme.warning, 0.12));
        let frame = egui::Frame::new().fill(ground).inner_margin(Margin::symmetric(14, 4));
        let mut put_away = None;
        Panel::top("notices").frame(frame).resizable(false).show(ui, |ui| {
            for (index, note) in self.messages.notes.iter().enumerate() {
                ui.horizontal(|ui| {
                    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                        let button = ui.small_button("Hide");
                        button
                            .widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Hide: {note}")));
                        if button.clicked() {
                            put_away = Some(index);
                        }
                        ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                            ui.add(egui::Label::new(RichText::new(note).color(color(self.theme.ink))).wrap());
                        });
                    });
                });
            }
        });
        if let Some(index) = put_away {
            self.messages.notes.remove(index);
        }
    }

    /// Shows the problems of the layout file, under the floor with the last good layout.
    pub(super) fn problems(&mut self, ui: &mut Ui) {
        let Some(file) = &self.messages.file else { return };
        let Some(diagnostics) = &file.diagnostics else { return };
        let theme = &self.theme;
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
}

fn link(state: LinkState, theme: &Theme) -> (&'static str, underfoot::layout::Colour) {
    match state {
        LinkState::Waiting => ("waiting", theme.warning),
        LinkState::Live => ("live", theme.good),
        LinkState::Partial => ("partial", theme.warning),
        LinkState::Lost => ("lost", theme.fault),
    }
}
