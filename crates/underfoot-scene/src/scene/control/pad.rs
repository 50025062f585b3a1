//! The face of a pad.

use glam::Vec2;

use super::super::Scene;
use super::super::face::Face;
use super::super::mark::{Ink, Paint, Stroke};
use super::reading::Reading;
use super::{HANDLE, caption, stops, strip_m};
use underfoot::floor::Rect;
use underfoot::widget::{PadSpec, Scale};

/// A caption, and a field with a crosshair at the values.
pub(super) fn draw(scene: &mut Scene, face: &Face<'_>, spec: &PadSpec, value: Vec2) {
    face.draw(scene);
    let area = face.area;
    let strip = strip_m(face);
    let top = Rect::new(Vec2::new(area.min.x, area.max.y - strip), area.max);
    caption(scene, face, top, &Reading::pair(&spec.x(), &spec.y(), value));
    let field = Rect::new(area.min + 0.010, Vec2::new(area.max.x - 0.010, area.max.y - strip));
    scene.add_box(field, face.radius_m - 0.008, face.sunk());
    // The foot's position is measured from the control's own edges.
    let whole = face.widget.area;
    let at = |share: Vec2| (whole.min + share * whole.size()).clamp(field.min, field.max);
    grid(&spec.x(), |share| {
        let x = at(Vec2::splat(share)).x;
        scene.add_line(Vec2::new(x, field.min.y), Vec2::new(x, field.max.y), faint(face));
    });
    grid(&spec.y(), |share| {
        let y = at(Vec2::splat(share)).y;
        scene.add_line(Vec2::new(field.min.x, y), Vec2::new(field.max.x, y), faint(face));
    });
    let mark = at(Vec2::new(spec.x().share(value.x), spec.y().share(value.y)));
    let hair = Paint::stroke(Stroke::new(0.004, Ink::faint(face.ink, 0.75)));
    scene.add_line(Vec2::new(mark.x, field.min.y), Vec2::new(mark.x, field.max.y), hair);
    scene.add_line(Vec2::new(field.min.x, mark.y), Vec2::new(field.max.x, mark.y), hair);
    let radius = (0.09 * field.size().min_element()).clamp(0.010, 0.022);
    let middle = mark.clamp(field.min + radius, (field.max - radius).max(field.min + radius));
    let fill = if face.state.pressed { face.lit() } else { HANDLE.mix(face.colour, 0.1) };
    let edge = Stroke::new(
        if face.state.pressed { 0.006 } else { 0.004 },
        Ink::solid(face.theme.readable(face.ink, fill)),
    );
    scene.add_circle(middle, radius, Paint::fill(Ink::solid(fill)).with_stroke(edge));
    face.draw_badge(scene);
}

/// Calls `draw` with the shares of a scale for grid lines: its stops, or quarters.
fn grid(scale: &Scale, mut draw: impl FnMut(f32)) {
    match stops(scale) {
        Some(stops) => stops.for_each(draw),
        None => [0.25, 0.5, 0.75].into_iter().for_each(&mut draw),
    }
}

fn faint(face: &Face<'_>) -> Paint {
    Paint::stroke(Stroke::new(0.002, Ink::faint(face.ink, 0.22)))
}
