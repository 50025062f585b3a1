//! The boards that send, as cards with live readings.

use eframe::egui::{Frame, Margin, Rect, RichText, ScrollArea, Sense, Stroke, Ui, pos2, vec2};

use super::parts::{remark, say, troubles};
use crate::preview::style::{panel_colour, pill};
use crate::setup::{BoardView, SetupView};
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Maximum number of boards with a card of their own.
const MOST: usize = 100;

/// Height of the bars of the readings, in points.
const BARS: f32 = 44.0;

/// Shows a card for each board.
pub(super) fn board_cards(ui: &mut Ui, theme: &Theme, view: &SetupView) {
    ScrollArea::vertical().id_salt("boards").auto_shrink(false).show(ui, |ui| {
        for board in view.boards.iter().take(MOST) {
            let frame = Frame::new()
                .fill(color(panel_colour(theme)))
                .stroke(Stroke::new(1.0, color(theme.line)))
                .corner_radius(8)
                .inner_margin(Margin::symmetric(16, 12));
            frame.show(ui, |ui| card(ui, theme, board));
            ui.add_space(6.0);
        }
        if view.boards.len() > MOST {
            remark(ui, theme, &format!("and {} more boards", view.boards.len() - MOST));
        }
    });
}

/// The card of one board.
fn card(ui: &mut Ui, theme: &Theme, board: &BoardView) {
    ui.set_width(ui.available_width());
    ui.horizontal(|ui| {
        ui.label(RichText::new(&board.name).size(16.0).strong().color(color(theme.ink)));
        let (ink, words) = match (board.rate_hz, board.troubles.is_empty()) {
            (Some(hz), true) => (theme.good, format!("{hz:.0} packets a second")),
            (Some(hz), false) => (theme.fault, format!("{hz:.0} packets a second")),
            (None, _) => (theme.quiet, "one packet".to_owned()),
        };
        pill(ui, ink, theme, &words);
    });
    bars(ui, theme, board);
    let number = if board.is_numbered { "numbered packets" } else { "no number: arrival times count" };
    let resolution = board.full_scale.map_or_else(String::new, |(full, bits)| {
        format!(", up to {:.0} so far: {bits} bits or more (full scale {full})", board.greatest)
    });
    remark(ui, theme, &format!("{} channels of {}{resolution}, {number}", board.channels, board.kind));
    troubles(ui, theme, &board.troubles);
}

/// A bar for each reading, of the full scale that the counts need so far.
fn bars(ui: &mut Ui, theme: &Theme, board: &BoardView) {
    let count = board.readings.len();
    if count == 0 {
        return say(ui, "no readings", 13.0, theme.quiet);
    }
    let (area, _) = ui.allocate_exact_size(vec2(ui.available_width().min(560.0), BARS), Sense::hover());
    let full = board.full_scale.map_or(500.0, |(full, _)| f64::from(full));
    let step = (area.width() / count as f32).min(36.0);
    for (number, reading) in (0_u16..).zip(&board.readings) {
        let left = area.left() + step * f32::from(number);
        let share = (reading / full).clamp(0.0, 1.0) as f32;
        let ground = Rect::from_min_max(pos2(left + 1.5, area.top()), pos2(left + step - 1.5, area.bottom()));
        let bar = Rect::from_min_max(pos2(ground.left(), area.bottom() - share * BARS), ground.max);
        ui.painter().rect_filled(ground, 2.0, color(theme.plate));
        ui.painter().rect_filled(bar, 2.0, color(theme.contact));
    }
}
