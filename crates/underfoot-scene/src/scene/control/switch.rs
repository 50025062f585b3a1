//! The face of a switch.

use glam::Vec2;

use super::super::Scene;
use super::super::face::Face;
use super::super::mark::{Anchor, Ink, Lettering, Paint, Stroke};
use super::super::widths::CAP_HEIGHT;
use super::beside;
use underfoot::floor::Rect;

/// The label, and a pill with a knob at one end.
pub(super) fn draw(scene: &mut Scene, face: &Face<'_>, on: bool) {
    face.draw(scene);
    let area = beside(scene, face, 0.135, 0.46);
    pill(scene, face, area, on);
    face.draw_badge(scene);
}

fn pill(scene: &mut Scene, face: &Face<'_>, area: Rect, on: bool) {
    let radius = 0.5 * area.size().y;
    let edge = Stroke::new(0.004, Ink::solid(face.ink));
    // On: filled with ink, with a hole as the knob. Off: an outline with a knob of ink.
    let (paint, knob) = if on {
        (Paint::fill(Ink::solid(face.ink)).with_stroke(edge), face.colour)
    } else {
        (Paint::fill(Ink::faint(face.colour, 0.6)).with_stroke(edge), face.ink)
    };
    scene.add_box(area, radius, paint);
    let reach = 0.5 * area.size().x - radius;
    let side = if on { reach } else { -reach };
    let centre = area.centre();
    // A box like the pill, round all around.
    let round = radius - 0.009;
    let place = Rect::from_centre_size(centre + Vec2::new(side, 0.0), Vec2::splat(2.0 * round));
    scene.add_box(place, round, Paint::fill(Ink::solid(knob)));
    let size_m = (1.05 * radius).min(0.032);
    let ink = if on { face.theme.readable(face.colour, face.ink) } else { face.ink };
    let lettering = Lettering::new(
        centre - Vec2::new(0.85 * side, 0.5 * CAP_HEIGHT * size_m),
        Anchor::Middle,
        size_m,
        Ink::solid(ink),
    )
    .strong();
    if size_m >= 0.018 {
        scene.add_text(lettering, format_args!("{}", if on { "on" } else { "off" }));
    }
}
