//! The face of a pedal.

use glam::Vec2;

use super::super::Scene;
use super::super::face::Face;
use super::super::mark::{Ink, Paint, Stroke};
use super::reading::Reading;
use super::{caption, strip_m};
use underfoot::floor::Rect;
use underfoot::widget::Scale;

/// Number of grooves across a pedal.
const GROOVES: usize = 5;

/// A caption, and a grooved plate that fills from the heel in proportion to the force.
pub(super) fn draw(scene: &mut Scene, face: &Face<'_>, scale: &Scale, value: f32) {
    face.draw(scene);
    let area = face.area;
    let strip = strip_m(face);
    let top = Rect::new(Vec2::new(area.min.x, area.max.y - strip), area.max);
    caption(scene, face, top, &Reading::of(scale, value));
    let plate = Rect::new(area.min + 0.010, Vec2::new(area.max.x - 0.010, area.max.y - strip));
    let radius = face.radius_m - 0.008;
    scene.add_box(plate, radius, face.sunk());
    let full = Vec2::new(plate.max.x, plate.min.y + scale.share(value) * plate.size().y);
    if full.y - plate.min.y > 0.002 {
        scene.add_box(Rect::new(plate.min, full), radius, Paint::fill(Ink::solid(face.lit())));
    }
    for groove in 1..=GROOVES {
        let y = plate.min.y + plate.size().y * groove as f32 / (GROOVES + 1) as f32;
        let reach = 0.14 * plate.size().x;
        let paint = Paint::stroke(Stroke::new(0.005, Ink::faint(face.ink, 0.30)));
        scene.add_line(Vec2::new(plate.min.x + reach, y), Vec2::new(plate.max.x - reach, y), paint);
    }
    let edge = Stroke::new(0.003, Ink::faint(face.ink, 0.45));
    scene.add_box(plate, radius, Paint::stroke(edge));
    face.draw_badge(scene);
}
