//! The face of a lean pad.

use glam::Vec2;

use super::super::Scene;
use super::super::face::Face;
use super::super::mark::{Anchor, Ink, Paint, Stroke};
use underfoot::floor::Rect;

/// Four arrows around the label, lit in proportion to the foot's lean in their direction, and a dot at the lean.
pub(super) fn draw(scene: &mut Scene, face: &Face<'_>, value: Vec2) {
    face.draw(scene);
    let centre = face.area.centre();
    let half = 0.5 * face.area.size();
    let value = if value.is_finite() { value.clamp_length_max(1.0) } else { Vec2::ZERO };
    let arrow = (0.17 * half.min_element()).min(0.03);
    let badge = if face.badge().is_some() { 0.82 } else { 1.0 };
    for way in [Vec2::Y, Vec2::X, Vec2::NEG_Y, Vec2::NEG_X] {
        let tip = centre + way * (half - 0.026) * Vec2::new(1.0, if way.y < 0.0 { badge } else { 1.0 });
        let side = way.perp() * arrow;
        let back = tip - way * 1.1 * arrow;
        let lean = value.dot(way).clamp(0.0, 1.0);
        let fill = Ink::faint(face.ink, 0.25 + 0.75 * lean);
        let edge = Stroke::new(0.003, Ink::faint(face.ink, 0.8));
        scene.add_path([tip, back + side, back - side], true, Paint::fill(fill).with_stroke(edge));
    }
    let room = Rect::from_centre_size(centre, face.area.size() * Vec2::new(0.56, 0.34));
    if value == Vec2::ZERO {
        face.write(scene, face.label(), room, Anchor::Middle);
    } else {
        let reach = half - 0.05;
        let ring = Paint::stroke(Stroke::new(0.003, Ink::faint(face.ink, 0.4)));
        scene.add_ellipse(centre, reach, ring);
        let stem = Paint::stroke(Stroke::new(0.006, Ink::solid(face.ink)));
        let dot = centre + value * reach;
        scene.add_line(centre, dot, stem);
        let edge = Stroke::new(0.005, Ink::solid(face.ink));
        scene.add_circle(dot, 0.016, Paint::fill(Ink::solid(face.lit())).with_stroke(edge));
    }
    face.draw_badge(scene);
}
