//! The menu of the projectors, in the bar of Project mode.

use eframe::egui::accesskit::Role;
use eframe::egui::containers::menu::{MenuButton, MenuConfig};
use eframe::egui::{Button, PopupCloseBehavior, RichText, Slider, Ui, WidgetInfo};

use super::Projection;
use super::brightness::Brightness;
use super::pair::{MOST, ProjectorName};
use super::screens;
use super::view::WindowKey;
use crate::preview::icons::{Icon, named, with};
use crate::preview::style::quiet;
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

impl Projection {
    /// Shows the menu; it stays open after a click.
    pub(in crate::preview) fn menu(&mut self, ui: &mut Ui, theme: &Theme) {
        let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
        let button = MenuButton::new(with(Icon::Projector, "Projectors")).config(config);
        let (button, _) = button.ui(ui, |ui| {
            ui.set_width(300.0);
            for index in 0..self.pair.count().min(MOST) {
                self.projector(ui, theme, ProjectorName { index });
                ui.separator();
            }
            self.second(ui, theme);
        });
        named(button, "Projectors");
    }

    /// The settings of one projector.
    fn projector(&mut self, ui: &mut Ui, theme: &Theme, name: ProjectorName) {
        let connected = self.screens;
        let (Some(setup), Some(window)) =
            (self.pair.setups.get_mut(name.index), self.windows.get_mut(name.index))
        else {
            return;
        };
        ui.label(RichText::new(name.title()).strong().color(color(theme.ink)));
        ui.horizontal(|ui| {
            ui.label(quiet(theme, "Brightness"));
            let mut percent = setup.brightness.percent();
            ui.spacing_mut().slider_width = 140.0;
            let slider = ui.add(Slider::new(&mut percent, 0..=100).suffix(" %"));
            let spoken = format!("Brightness of {}", name.inline());
            slider.widget_info(|| WidgetInfo::slider(true, f64::from(percent), &spoken));
            setup.brightness = Brightness::new(percent).unwrap_or(setup.brightness);
        });
        let mut key = None;
        ui.horizontal(|ui| {
            let is_on = window.is_full;
            if switch(ui, is_on, Icon::Maximize, ("Full screen", name), "F in its window does the same") {
                key = Some(WindowKey::FullScreen);
            }
            let hint = "Fills the next screen; N in its window does the same";
            if switch(ui, false, Icon::MonitorUp, ("Next screen", name), hint) {
                key = Some(WindowKey::NextScreen);
            }
            let place = match setup.screen {
                Some(screen) if !screens::has(connected, screen) => format!("no screen {screen}"),
                Some(screen) => format!("screen {screen}"),
                None => String::new(),
            };
            ui.label(quiet(theme, place));
        });
        let mut was_used = false;
        ui.horizontal(|ui| {
            let view = &mut window.view;
            let hint = "Lay the floor’s corners onto the real ones; C in its window does the same";
            if switch(ui, view.corners.selected().is_some(), Icon::Crosshair, ("Adjust corners", name), hint)
            {
                view.corners.toggle();
                was_used = true;
            }
            let hint = "Texts of known size, colours and edges; T in its window does the same";
            if switch(ui, view.has_check_page, Icon::Type, ("Check page", name), hint) {
                view.has_check_page ^= true;
                was_used = true;
            }
        });
        if was_used {
            self.addressed = name.index;
        }
        if let Some(key) = key {
            self.handle_key(name.index, key);
        }
    }

    /// The button that adds or removes the second projector, and the light of both.
    fn second(&mut self, ui: &mut Ui, theme: &Theme) {
        if self.pair.has_second {
            let light = format!("Where both shine: {} % of the light of one", self.pair.light_percent());
            ui.label(quiet(theme, light));
            let hint = "Its corners stay for the next time; the first projector gets its light";
            if ui.add(Button::new("Remove the second projector")).on_hover_text(hint).clicked() {
                self.remove_second();
            }
        } else {
            ui.label(quiet(theme, "A second projector on the other side fills the shadows of people."));
            let hint = "Opens a second window with the same controls; each projector gives half of the light";
            if ui.add(Button::new("Add a second projector")).on_hover_text(hint).clicked() {
                self.add_second();
            }
        }
    }
}

/// A button that stays down while `is_on`; its spoken name also says which projector it is for.
fn switch(ui: &mut Ui, is_on: bool, icon: Icon, (text, name): (&str, ProjectorName), hint: &str) -> bool {
    let button = ui.add(Button::selectable(is_on, with(icon, text)).frame_when_inactive(true));
    button.widget_info(|| WidgetInfo::selected(Role::Button, true, is_on, name.label(text)));
    button.on_hover_text(hint).clicked()
}
