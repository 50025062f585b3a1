//! The side panel's people: the walks on the simulated floor.

use eframe::egui::{Button, Label, Ui};

use super::super::style::{quiet, section, toggle};
use super::super::walks::Walks;
use underfoot_scene::scene::Theme;

/// Height of the message below, in points: constant for all messages.
const WORDS: f32 = 32.0;

/// Shows the walks, to be repeated or saved as a scenario on the layout called `title`.
pub(super) fn people_part(ui: &mut Ui, theme: &Theme, walks: &mut Walks, title: &str) {
    let (walking, remembered) = (walks.walking(), walks.remembered());
    section(ui, theme, "People", |ui| {
        let text = match walking {
            0 => "none on the floor".to_owned(),
            count => format!("{count} on the floor"),
        };
        ui.label(quiet(theme, text).size(12.5));
    });
    ui.horizontal(|ui| {
        let hint = "The mouse draws a way over the floor, and somebody walks it; W does the same";
        toggle(ui, &mut walks.are_drawn, "Draw a walk", hint);
        let some = remembered > 0;
        if ui
            .add_enabled(some, Button::new("Again"))
            .on_hover_text("Everybody who was sent, at once")
            .clicked()
        {
            walks.repeat();
        }
        let hint = "All walks as a scenario's text, for underfoot preview --scenario FILE";
        if ui.add_enabled(some, Button::new("Copy")).on_hover_text(hint).clicked() {
            ui.ctx().copy_text(walks.scenario(&format!("Walks on {title}")));
        }
        if ui.add_enabled(some, Button::new("Forget")).on_hover_text("Clears the drawn trails").clicked() {
            walks.forget();
        }
    });
    let words = match (&walks.refused, remembered) {
        (Some(refused), _) => refused.clone(),
        (None, 0) => "a way that ends on a control is walked by somebody who uses it".into(),
        (None, 1) => "1 way drawn".into(),
        (None, several) => format!("{several} ways drawn"),
    };
    let ink = if walks.refused.is_some() { theme.warning } else { theme.quiet };
    ui.allocate_ui(eframe::egui::vec2(ui.available_width(), WORDS), |ui| {
        ui.set_min_height(WORDS);
        let words = quiet(theme, words).size(12.5).color(underfoot_scene::egui_painter::color(ink));
        ui.add(Label::new(words).wrap());
    });
}
