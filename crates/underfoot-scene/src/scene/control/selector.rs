//! The face of a selector.

use glam::Vec2;

use super::super::Scene;
use super::super::face::{Face, SMALL_M};
use super::super::mark::{Anchor, Ink, Lettering, Paint, Stroke};
use super::super::widths::CAP_HEIGHT;
use super::strip_m;
use underfoot::floor::Rect;
use underfoot::widget::{Axis, SelectorSpec, Value};

/// A strip with the label, and a segment for each option; the chosen one is lit.
pub(super) fn draw(scene: &mut Scene, face: &Face<'_>, spec: &SelectorSpec, choice: u16) {
    face.draw(scene);
    let area = face.area;
    let strip = if face.label().is_empty() { 0.010 } else { strip_m(face) };
    if !face.label().is_empty() {
        let size_m = (0.60 * strip).min(0.036);
        let at = Vec2::new(area.min.x + 0.022, area.max.y - 0.5 * strip - 0.5 * CAP_HEIGHT * size_m);
        let ink = Ink::solid(face.ink);
        let lettering = Lettering::new(at, Anchor::Start, size_m, ink).strong();
        scene.add_line_of(lettering, face.label(), area.size().x - 0.044, SMALL_M.min(size_m));
    }
    let inset = 0.010;
    let field = Rect::new(area.min + inset, Vec2::new(area.max.x - inset, area.max.y - strip));
    let pending = match face.state.pending {
        Some(Value::Choice(pending)) => Some(pending),
        _ => None,
    };
    let count = spec.options.len().max(1) as f32;
    for (index, option) in (0_u16..).zip(spec.options.iter()) {
        let from = f32::from(index) / count;
        let (low, high) = (from, from + 1.0 / count);
        // The parts as measured for the foot; only the outermost are clipped to the field.
        let whole = face.widget.area;
        let cell = match spec.axis {
            Axis::East => Rect::new(
                Vec2::new(whole.min.x + low * whole.size().x, field.min.y),
                Vec2::new(whole.min.x + high * whole.size().x, field.max.y),
            ),
            Axis::North => Rect::new(
                Vec2::new(field.min.x, whole.max.y - high * whole.size().y),
                Vec2::new(field.max.x, whole.max.y - low * whole.size().y),
            ),
        };
        let cell = Rect::new(cell.min.max(field.min), cell.max.min(field.max)).grown(-0.002);
        segment(scene, face, cell, option, index == choice, pending == Some(index));
    }
    face.draw_badge(scene);
}

fn segment(scene: &mut Scene, face: &Face<'_>, cell: Rect, option: &str, chosen: bool, pending: bool) {
    let (mut paint, ground) = match chosen {
        true => (Paint::fill(Ink::solid(face.lit())), face.lit()),
        false => (face.sunk(), face.sunk().fill.map_or(face.colour, |ink| ink.colour)),
    };
    let ink = face.theme.readable(face.ink, ground);
    if pending {
        paint = paint.with_stroke(Stroke::new(0.006, Ink::solid(face.ink)).dashed(0.014, 0.009));
    } else if chosen {
        paint = paint.with_stroke(Stroke::new(0.004, Ink::faint(ink, 0.8)));
    }
    scene.add_box(cell.grown(if pending { -0.003 } else { 0.0 }), 0.012, paint);
    let mut room = cell.grown(-0.008);
    if face.badge().is_some() {
        room.min.y = room.min.y.max(face.room().min.y);
    }
    face.write_in(scene, option, room, Anchor::Middle, ink);
}
