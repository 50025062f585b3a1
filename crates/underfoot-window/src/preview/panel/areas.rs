//! The side panel's areas of a floor that several computers serve.

use eframe::egui::Ui;

use super::super::style::{row, section};
use underfoot::sink::{AreaNews, AreaState};
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Shows the state of each area and the uncertainty of its event times; nothing without areas.
pub(super) fn areas_part(ui: &mut Ui, theme: &Theme, areas: &[AreaNews]) {
    if areas.is_empty() {
        return;
    }
    section(ui, theme, "Areas", |_| {});
    ui.spacing_mut().item_spacing.y = 2.0;
    for news in areas {
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
