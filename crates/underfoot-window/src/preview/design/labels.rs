//! Small text on the canvas.

use std::sync::Arc;

use eframe::egui;
use eframe::egui::{Align2, Color32, FontId, Galley, Pos2, pos2, vec2};

use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Text beside controls that avoids the text of other controls.
pub(super) struct Labels {
    within: egui::Rect,
    taken: Vec<egui::Rect>,
}

impl Labels {
    /// Maximum distance of a text from its control, in lines.
    const FARTHEST: u8 = 4;

    pub(super) fn within(within: egui::Rect) -> Self {
        Self { within, taken: Vec::new() }
    }

    /// Draws the first of `texts` that fits under `shown` or above it, from the longest to the shortest; if none
    /// fits, draws the last one directly below.
    pub(super) fn put(
        &mut self,
        painter: &egui::Painter,
        shown: egui::Rect,
        texts: &[&str],
        colour: Color32,
        theme: &Theme,
    ) {
        let laid = texts.iter().map(|text| laid(painter, text, colour));
        let mut best = None;
        for galley in laid {
            let size = plate_of(shown.left_top(), &galley).size();
            let place = self.free(shown, size);
            let is_free = place.is_some();
            let at = place.unwrap_or_else(|| pos2(shown.left(), shown.bottom() + 3.0));
            best = Some((at, galley));
            if is_free {
                break;
            }
        }
        let Some((at, galley)) = best else { return };
        self.taken.push(plate_of(at, &galley));
        written(painter, at, galley, colour, theme);
    }

    /// A free place for a text of this size beside `shown`.
    fn free(&self, shown: egui::Rect, size: egui::Vec2) -> Option<Pos2> {
        let x = shown.left().min(self.within.right() - size.x).max(self.within.left());
        let lines = (0..Self::FARTHEST).flat_map(|line| {
            let away = 3.0 + f32::from(line) * (size.y + 1.0);
            [shown.bottom() + away, shown.top() - away - size.y]
        });
        lines.map(|y| pos2(x, y)).find(|at| {
            let plate = egui::Rect::from_min_size(*at, size);
            self.within.contains_rect(plate) && !self.taken.iter().any(|taken| taken.intersects(plate))
        })
    }
}

/// Small text on a plate, legible on any background.
pub(super) fn label(painter: &egui::Painter, at: Pos2, text: &str, colour: Color32, theme: &Theme) {
    written(painter, at, laid(painter, text, colour), colour, theme);
}

fn laid(painter: &egui::Painter, text: &str, colour: Color32) -> Arc<Galley> {
    painter.layout_no_wrap(text.to_owned(), FontId::proportional(11.5), colour)
}

fn plate_of(at: Pos2, galley: &Galley) -> egui::Rect {
    Align2::LEFT_TOP.anchor_size(at, galley.size() + vec2(8.0, 2.0))
}

fn written(painter: &egui::Painter, at: Pos2, galley: Arc<Galley>, colour: Color32, theme: &Theme) {
    let plate = plate_of(at, &galley);
    painter.rect_filled(plate, 3, color(theme.plate).gamma_multiply(0.92));
    painter.galley(plate.min + vec2(4.0, 1.0), galley, colour);
}
