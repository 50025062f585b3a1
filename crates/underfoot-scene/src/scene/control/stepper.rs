//! The face of a stepper.

use glam::Vec2;

use super::super::Scene;
use super::super::face::{Face, SMALL_M};
use super::super::mark::{Anchor, Ink, Lettering, Paint, Stroke};
use super::super::widths::CAP_HEIGHT;
use super::reading::Reading;
use underfoot::floor::Rect;
use underfoot::widget::{Axis, StepperSpec};

/// Two halves with a minus and a plus; between them the value, with the label beneath it.
pub(super) fn draw(scene: &mut Scene, face: &Face<'_>, spec: &StepperSpec, value: f32) {
    face.draw(scene);
    let (area, size) = (face.area, face.area.size());
    let along = match spec.axis {
        Axis::East => Vec2::X,
        Axis::North => Vec2::Y,
    };
    let end = 0.28 * size.dot(along);
    let across = Vec2::ONE - along;
    let low = Rect::new(area.min, area.min + along * end + size * across).grown(-0.010);
    let high = Rect::new(area.max - along * end - size * across, area.max).grown(-0.010);
    let sign = (0.32 * low.size().min_element()).min(0.032);
    // Faint at the end of the range.
    let strength = |end: f32| if value == end { 0.3 } else { 1.0 };
    let halves = [(low, strength(spec.scale.min), false), (high, strength(spec.scale.max), true)];
    for (half, strength, plus) in halves {
        let ground = face.lit().mix(face.colour, if face.state.pressed { 0.2 } else { 0.55 });
        scene.add_box(half, (face.radius_m - 0.008).max(0.004), Paint::fill(Ink::solid(ground)));
        let ink = face.theme.readable(face.ink, ground);
        let paint = Paint::stroke(Stroke::new(0.008, Ink::faint(ink, strength)));
        let middle = half.centre();
        scene.add_line(middle - Vec2::X * sign, middle + Vec2::X * sign, paint);
        if plus {
            scene.add_line(middle - Vec2::Y * sign, middle + Vec2::Y * sign, paint);
        }
    }
    let south = face.room().min.y;
    let between = match spec.axis {
        Axis::East => Rect::new(Vec2::new(low.max.x, south), Vec2::new(high.min.x, area.max.y - 0.012)),
        Axis::North => Rect::new(
            Vec2::new(area.min.x + 0.012, low.max.y.max(south)),
            Vec2::new(area.max.x - 0.012, high.min.y),
        ),
    };
    words(scene, face, between, &Reading::of(&spec.scale, value));
    face.draw_badge(scene);
}

fn words(scene: &mut Scene, face: &Face<'_>, room: Rect, reading: &Reading) {
    let size = room.size() - Vec2::new(0.016, 0.0);
    if size.min_element() < 0.01 {
        return;
    }
    let labelled = !face.label().is_empty() && size.y > 0.07;
    let tall = if labelled { 0.5 * size.y } else { 0.8 * size.y };
    let size_m = (size.x / reading.widest).min(0.050).min(tall / CAP_HEIGHT);
    let middle = room.centre();
    let lift = if labelled { 0.006 } else { -0.5 * CAP_HEIGHT * size_m };
    let mut lettering =
        Lettering::new(middle + Vec2::new(0.0, lift), Anchor::Middle, size_m, Ink::solid(face.ink)).strong();
    scene.add_text(lettering, format_args!("{}", reading.text));
    if labelled {
        let small = 0.030_f32.min(0.4 * size.y / CAP_HEIGHT).max(SMALL_M);
        lettering.at.y = middle.y - 0.010 - CAP_HEIGHT * small;
        lettering.size_m = small;
        scene.add_line_of(lettering, face.label(), size.x, SMALL_M);
    }
}
