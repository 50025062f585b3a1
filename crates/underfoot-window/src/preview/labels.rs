//! Small text over the floor, placed beside its control and clear of all other controls and texts.

use eframe::egui;
use eframe::egui::{Align2, Color32, FontId, Pos2, Rect, Stroke, StrokeKind, Vec2, pos2, vec2};

use underfoot::layout::Colour;
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Gap between a text and its control, in points.
const GAP: f32 = 4.0;

/// Maximum width of a text before it wraps, in points.
const WIDEST: f32 = 260.0;

/// Padding of a text, in points.
const PADDING: Vec2 = vec2(6.0, 3.0);

/// Distance between two places that a text without room beside its control tries, in points.
const STEP: f32 = 16.0;

/// A card with a mark and a text.
pub(super) struct StepCard<'a> {
    /// A letter or a sign in a disc.
    pub(super) mark: &'a str,
    pub(super) text: &'a str,
    pub(super) colour: Colour,
}

/// Texts beside controls.
pub(super) struct Labels {
    /// The part of the screen for texts.
    pub(super) within: Rect,
    /// Areas that no text may cover.
    taken: Vec<Rect>,
}

impl Labels {
    /// Labels within an area of the screen that cover none of `taken`, such as the controls.
    pub(super) fn within(within: Rect, taken: impl IntoIterator<Item = Rect>) -> Self {
        Self { within, taken: taken.into_iter().collect() }
    }

    /// Writes the lines of `text` beside `control`; returns the area of the text.
    pub(super) fn put(
        &mut self,
        painter: &egui::Painter,
        control: Rect,
        text: &str,
        colour: Colour,
        theme: &Theme,
    ) -> Rect {
        let galley = painter.layout(text.to_owned(), FontId::proportional(12.5), color(theme.ink), WIDEST);
        let place = self.take(control, galley.size() + 2.0 * PADDING);
        plate(painter, place, colour, theme);
        painter.galley(place.min + PADDING, galley, color(theme.ink));
        place
    }

    /// Writes a short text beside `subject`, such as a gap between controls.
    pub(super) fn note(
        &mut self,
        painter: &egui::Painter,
        subject: Rect,
        text: &str,
        colour: Color32,
        theme: &Theme,
    ) {
        let galley = painter.layout_no_wrap(text.to_owned(), FontId::proportional(11.5), colour);
        let place = self.take(subject, galley.size() + vec2(8.0, 2.0));
        painter.rect_filled(place, 3, color(theme.plate).gamma_multiply(0.92));
        painter.galley(place.min + vec2(4.0, 1.0), galley, colour);
    }

    /// Draws a card beside `control`; returns its area.
    pub(super) fn card(
        &mut self,
        painter: &egui::Painter,
        control: Rect,
        card: &StepCard<'_>,
        theme: &Theme,
    ) -> Rect {
        const DISC: f32 = 11.0;
        let font = FontId::proportional(14.0);
        let galley = painter.layout_no_wrap(card.text.to_owned(), font.clone(), color(theme.ink));
        let size = vec2(galley.size().x + 2.0 * DISC + 22.0, galley.size().y.max(2.0 * DISC) + 8.0);
        let place = self.take(control, size);
        plate(painter, place, card.colour, theme);
        let disc = pos2(place.left() + 6.0 + DISC, place.center().y);
        painter.circle_filled(disc, DISC, color(card.colour));
        painter.text(disc, Align2::CENTER_CENTER, card.mark, font, color(theme.plate));
        let at = pos2(disc.x + DISC + 7.0, place.center().y - 0.5 * galley.size().y);
        painter.galley(at, galley, color(theme.ink));
        painter.line_segment(
            [place.clamp(control.center()), control.clamp(place.center())],
            Stroke::new(1.5, color(card.colour)),
        );
        place
    }

    /// Reserves a free area of this size: beside `control` if there is room, or else the nearest one.
    fn take(&mut self, control: Rect, size: Vec2) -> Rect {
        let place = self.free(control, size).unwrap_or_else(|| {
            // No place is free: the corner of the view is farthest from the controls.
            Rect::from_min_size(self.within.left_bottom() - vec2(-GAP, size.y + GAP), size)
        });
        self.taken.push(place);
        place
    }

    fn free(&self, control: Rect, size: Vec2) -> Option<Rect> {
        let clamped = |at: Pos2| {
            let most = (self.within.max - size).max(self.within.min);
            Rect::from_min_size(at.clamp(self.within.min, most), size)
        };
        let beside = [
            pos2(control.left(), control.bottom() + GAP),
            pos2(control.left(), control.top() - GAP - size.y),
            pos2(control.right() + GAP, control.center().y - 0.5 * size.y),
            pos2(control.left() - GAP - size.x, control.center().y - 0.5 * size.y),
        ];
        let is_free = |place: &Rect| {
            self.within.contains_rect(*place) && !self.taken.iter().any(|taken| taken.intersects(*place))
        };
        if let Some(place) = beside.map(clamped).into_iter().find(is_free) {
            return Some(place);
        }
        let (columns, rows) = (self.within.width() / STEP, self.within.height() / STEP);
        let grid = (0..rows.clamp(0.0, 400.0) as u16)
            .flat_map(|row| (0..columns.clamp(0.0, 400.0) as u16).map(move |column| (column, row)));
        let places = grid
            .map(|(column, row)| clamped(self.within.min + vec2(f32::from(column), f32::from(row)) * STEP));
        let far = |place: &Rect| place.center().distance(control.center());
        places.filter(is_free).min_by(|one, other| far(one).total_cmp(&far(other)))
    }
}

/// A plate for text, legible on any background, with an edge in `colour`.
fn plate(painter: &egui::Painter, place: Rect, colour: Colour, theme: &Theme) {
    let edge = Stroke::new(1.2, color(colour));
    painter.rect(place, 5, color(theme.plate), edge, StrokeKind::Inside);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_cover_no_control_and_no_other_text_however_crowded_the_floor_is() {
        let view = Rect::from_min_size(pos2(0.0, 40.0), vec2(600.0, 500.0));
        let cell = |x: u8, y: u8| {
            let at = pos2(20.0 + 110.0 * f32::from(x), 60.0 + 90.0 * f32::from(y));
            Rect::from_min_size(at, vec2(90.0, 55.0))
        };
        let controls: Vec<Rect> = (0..5).flat_map(|x| (0..5).map(move |y| cell(x, y))).collect();
        let mut labels = Labels::within(view, controls.clone());
        for control in &controls {
            let before = labels.taken.clone();
            let place = labels.take(*control, vec2(60.0, 12.0));
            assert!(view.contains_rect(place), "{place}");
            assert!(!before.iter().any(|taken| taken.intersects(place)), "{place} covers something");
        }
    }

    #[test]
    fn a_text_stands_directly_below_its_control_where_there_is_room() {
        let view = Rect::from_min_size(pos2(0.0, 0.0), vec2(600.0, 500.0));
        let control = Rect::from_min_size(pos2(200.0, 200.0), vec2(90.0, 55.0));
        let mut labels = Labels::within(view, [control]);
        let place = labels.take(control, vec2(120.0, 20.0));
        assert_eq!(place.min, pos2(200.0, 255.0 + GAP));
    }
}
