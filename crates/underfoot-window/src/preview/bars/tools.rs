//! The tools of Try mode, and the key that mutes.

use eframe::egui::containers::menu::{MenuButton, MenuConfig};
use eframe::egui::{Button, Key, PopupCloseBehavior, RichText, Ui};

use crate::preview::app::App;
use crate::preview::feed::PreviewCommand;
use crate::preview::handheld::menu_content;
use crate::preview::icons::{Icon, named, short, with};
use crate::preview::mode::WindowMode;
use crate::preview::shown::ShownFloor;
use crate::preview::style::switch_button;
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::{Show, Theme};

impl App {
    /// The buttons that belong to the use of the floor; compact ones have icons alone.
    pub(super) fn try_tools(&mut self, ui: &mut Ui, theme: &Theme, is_compact: bool) {
        if self.mode() == WindowMode::Project {
            self.projection.menu(ui, theme);
        }
        self.feet.stance_button(ui, &self.shown, is_compact);
        self.show_visit_button(ui, is_compact);
        self.share_button(ui, is_compact);
        if self.shown.scopes.is_fed() {
            let muted = self.shown.snapshot().muted.all;
            let hint = "Let nothing be felt or heard; M does the same";
            if switch_button(ui, muted, Icon::VolumeX, "Mute", is_compact, hint) {
                self.shown.command(PreviewCommand::Mute(!muted));
            }
        }
        layers_menu(ui, &mut self.view.show, is_compact);
        if let Some(tuner) = &mut self.tuner {
            let hint = "Tune what controls feel like: see, hear and save";
            tuner.is_open ^=
                switch_button(ui, tuner.is_open, Icon::AudioWaveform, "Effects", is_compact, hint);
        }
        let plots = &mut self.plots.is_open;
        let hint = "Forces and values over time; P does the same";
        *plots ^= switch_button(ui, *plots, Icon::ChartLine, "Plots", is_compact, hint);
        self.panel.button(ui, false, is_compact);
        let count = self.shown.messages.warnings.count;
        if count > 0 {
            let text = if count == 1 { "1 warning".to_owned() } else { format!("{count} warnings") };
            let shown = with(Icon::TriangleAlert, &count.to_string());
            let shown = RichText::new(shown).color(color(theme.warning));
            let lists = &mut self.top_bar.lists_warnings;
            let button = Button::selectable(*lists, shown).frame_when_inactive(true);
            let button =
                named(ui.add(button), &text).on_hover_text(format!("{text}: trouble for feet and eyes"));
            *lists ^= button.clicked();
        }
    }
}

/// A menu of the layers over the floor; it stays open after a click.
fn layers_menu(ui: &mut Ui, show: &mut Show, is_compact: bool) {
    let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    let (button, _) =
        MenuButton::new(short(Icon::Layers, "Layers", is_compact)).config(config).ui(ui, |ui| {
            ui.set_min_width(170.0);
            menu_content(ui, |ui| layers(ui, show));
        });
    named(button, "Layers");
}

fn layers(ui: &mut Ui, show: &mut Show) {
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
}

/// Mutes or unmutes everything, unless a text field has the focus.
pub(in crate::preview) fn handle_mute_key(ui: &Ui, shown: &ShownFloor) {
    let is_free = ui.ctx().memory(|memory| memory.focused().is_none());
    if is_free && shown.scopes.is_fed() && ui.input(|i| i.key_pressed(Key::M)) {
        shown.command(PreviewCommand::Mute(!shown.snapshot().muted.all));
    }
}
