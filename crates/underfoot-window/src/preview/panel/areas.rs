//! The side panel's areas of a floor that several computers serve.

use eframe::egui::Ui;

use super::super::app::App;
use super::super::style::{row, section};
use underfoot::sink::AreaState;
use underfoot_scene::egui_painter::color;

impl App {
    /// Shows the state of each area and the uncertainty of its event times; nothing on a floor of one computer.
    pub(super) fn areas_part(&mut self, ui: &mut Ui) {
        let theme = &self.theme;
        let Some(server) = self.server.as_ref().filter(|server| !server.areas.is_empty()) else { return };
        section(ui, theme, "Areas", |_| {});
        ui.spacing_mut().item_spacing.y = 2.0;
        for news in &server.areas {
            let (state, because) = (news.state.name(), &news.why);
            let spoken = format!("Area {} is {state} {because}", news.area);
            let line = row(ui, 19.0, 13.0, &spoken);
            line.left(0.0, 0.58, &news.area, color(theme.ink));
            let colour = match news.state {
                AreaState::Live => theme.good,
                AreaState::Waiting => theme.warning,
                AreaState::Lost | AreaState::Disputed => theme.fault,
            };
            line.left(0.58, 0.78, state, color(colour));
            if news.state == AreaState::Live {
                let sure = format!("± {:.1} ms", 1e3 * news.uncertainty.as_secs_f32());
                line.right(1.0, &sure, color(theme.quiet));
            }
        }
        ui.spacing_mut().item_spacing.y = 5.0;
    }
}
