//! The marks to stand on: two shoes for the present one.

use eframe::egui::accesskit::Role;
use eframe::egui::epaint::PathShape;
use eframe::egui::{Pos2, Rect, Sense, Shape, Stroke, Ui, WidgetInfo, vec2};

use super::drawing::FloorDrawing;
use underfoot::glam::Vec2;
use underfoot::layout::Colour;
use underfoot::sense::StandingMark;
use underfoot_scene::egui_painter::color;

/// Length of a shoe, its width at the ball and at the heel, and the distance of each from the middle (m).
const LENGTH: f32 = 0.27;
const BALL: f32 = 0.048;
const HEEL: f32 = 0.036;
const APART: f32 = 0.06;

/// Number of corners of a shoe's outline.
const CORNERS: u16 = 36;

impl FloorDrawing<'_> {
    /// Draws a mark that is not the present one: a small cross, or a dot once it is done.
    pub(super) fn small_mark(&self, mark: &StandingMark, is_done: bool) {
        let at = self.map.point(mark.at);
        let size = (0.011 * self.map.scale()).clamp(2.0, 5.0);
        if is_done {
            self.painter.circle_filled(at, size, color(self.theme.good));
            return;
        }
        let stroke = Stroke::new(1.2, color(self.theme.quiet).gamma_multiply(0.7));
        for way in [vec2(size, 0.0), vec2(0.0, size)] {
            self.painter.line_segment([at - way, at + way], stroke);
        }
    }

    /// Draws the present mark: shoes that show the direction, and a ring that closes while the stand is measured.
    pub(super) fn present_mark(&self, ui: &Ui, mark: &StandingMark, share: f32, ink: Colour, words: &str) {
        let turn = Vec2::from_angle(mark.facing);
        for side in [-1.0, 1.0] {
            let outline = (0..CORNERS).map(|corner| {
                let place = shoe(f32::from(corner) / f32::from(CORNERS), side);
                self.map.point(mark.at + turn.rotate(place))
            });
            let outline: Vec<Pos2> = outline.collect();
            let fill = color(ink).gamma_multiply(0.35);
            self.painter.add(Shape::Path(PathShape::convex_polygon(
                outline,
                fill,
                Stroke::new(2.0, color(ink)),
            )));
        }
        let (at, radius) = (self.map.point(mark.at), (0.19 * self.map.scale()).max(14.0));
        self.painter.circle_stroke(at, radius, Stroke::new(2.0, color(ink).gamma_multiply(0.3)));
        if share > 0.0 {
            let steps = (64.0 * share.clamp(0.0, 1.0)).ceil() as u16;
            let arc = (0..=steps).map(|step| {
                let angle = std::f32::consts::TAU * share * f32::from(step) / f32::from(steps.max(1));
                at + radius * vec2(angle.sin(), -angle.cos())
            });
            self.painter.line(arc.collect(), Stroke::new(6.0, color(ink)));
        }
        for way in [vec2(6.0, 0.0), vec2(0.0, 6.0)] {
            self.painter.line_segment([at - way, at + way], Stroke::new(2.0, color(self.theme.ink)));
        }
        let area = Rect::from_center_size(at, vec2(2.0, 2.0) * radius);
        let node = ui.interact(area, ui.scope_id().with("present mark"), Sense::hover());
        node.widget_info(|| WidgetInfo::labeled(Role::Label, true, words));
    }
}

/// A place on the outline of a shoe that faces north, in metres from the middle between both shoes; `way` runs once
/// around, and `side` is -1 for the left one.
fn shoe(way: f32, side: f32) -> Vec2 {
    let (east, north) = (std::f32::consts::TAU * way).sin_cos();
    // Fuller than an ellipse at both ends, wide at the ball and narrow at the heel.
    let full = |way: f32| way.abs().powf(0.8).copysign(way);
    let width = HEEL + (BALL - HEEL) * (0.5 + 0.5 * full(north));
    Vec2::new(side * APART + full(east) * width, 0.5 * LENGTH * full(north))
}
