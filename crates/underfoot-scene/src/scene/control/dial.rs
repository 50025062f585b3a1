//! The face of a dial.

use glam::Vec2;

use super::super::Scene;
use super::super::face::{Face, SMALL_M};
use super::super::mark::{Anchor, Ink, Lettering, Paint, Stroke};
use super::super::widths::{CAP_HEIGHT, width};
use super::reading::Reading;
use super::stops;
use underfoot::widget::DialSpec;

/// Points along a full turn.
const POINTS: f32 = 72.0;

/// A ring that fills clockwise, ticks at the steps, a needle, and value and label in the middle.
pub(super) fn draw(scene: &mut Scene, face: &Face<'_>, spec: &DialSpec, value: f32) {
    face.draw(scene);
    let centre = face.area.centre();
    let radius = 0.5 * face.area.size().min_element() - 0.020;
    let broad = (0.14 * radius).clamp(0.008, 0.020);
    // A dial of more than one turn is drawn as one turn.
    let turn = spec.turn_degrees.min(330.0);
    let angle = |share: f32| (90.0 + turn * (0.5 - share)).to_radians();
    let at = |share: f32, reach: f32| centre + Vec2::from_angle(angle(share)) * reach;
    let share = spec.scale.share(value);
    let ring = radius - 0.5 * broad;
    let arc = |to: f32| {
        let steps = (POINTS * to * turn / 360.0).ceil().max(1.0) as usize;
        (0..=steps).map(move |step| at(to * step as f32 / steps as f32, ring))
    };
    let broadly = |colour| Paint::stroke(Stroke::new(broad, Ink::solid(colour)));
    scene.add_path(arc(1.0), false, broadly(face.groove()));
    if share > 0.0 {
        scene.add_path(arc(share), false, broadly(face.lit()));
    }
    for stop in stops(&spec.scale).into_iter().flatten().chain([0.0, 1.0]) {
        let tick = Paint::stroke(Stroke::new(0.003, Ink::faint(face.ink, 0.55)));
        scene.add_line(at(stop, ring - 0.5 * broad), at(stop, ring + 0.5 * broad), tick);
    }
    let needle = Paint::stroke(Stroke::new(0.008, Ink::solid(face.ink)));
    scene.add_line(at(share, 0.70 * radius), at(share, radius), needle);
    words(scene, face, centre, 0.66 * radius, &Reading::of(&spec.scale, value));
    face.draw_badge(scene);
}

/// The value with the label beneath it, inside a circle of `reach` metres.
fn words(scene: &mut Scene, face: &Face<'_>, centre: Vec2, reach: f32, reading: &Reading) {
    let size_m = (1.5 * reach / reading.widest).min(0.046).min(0.9 * reach);
    let label = face.label();
    // Narrower at the bottom, where the needle may be on either side.
    let room = 1.5 * reach;
    let small = (room / width(label).max(1e-3)).clamp(SMALL_M, 0.032);
    let labelled = !label.is_empty() && reach > 0.035;
    let lift = if labelled { 0.006 } else { -0.5 * CAP_HEIGHT * size_m };
    let mut lettering =
        Lettering::new(centre + Vec2::new(0.0, lift), Anchor::Middle, size_m, Ink::solid(face.ink)).strong();
    scene.add_text(lettering, format_args!("{}", reading.text));
    if labelled {
        lettering.at = centre - Vec2::new(0.0, 0.006 + CAP_HEIGHT * small);
        lettering.size_m = small;
        scene.add_line_of(lettering, label, room, SMALL_M);
    }
}
