//! The face of a slider along an arc or at an angle.

use glam::Vec2;

use super::super::Scene;
use super::super::face::{Face, SMALL_M};
use super::super::mark::{Anchor, Ink, Lettering, Paint, Stroke};
use super::super::widths::CAP_HEIGHT;
use super::reading::Reading;
use super::{HANDLE, stops};
use underfoot::floor::Rect;
use underfoot::widget::{Scale, SliderTrack};

/// Points along a track.
const POINTS: usize = 48;

/// A slider with a curved or slanted track: a broad line, filled up to the handle.
pub(super) fn draw(scene: &mut Scene, face: &Face<'_>, scale: &Scale, track: SliderTrack, value: f32) {
    face.draw(scene);
    let size = face.area.size();
    let broad = (0.18 * size.min_element()).clamp(0.016, 0.05);
    // The handle is at the foot's place; a line ends a little before the face does.
    let whole = face.widget.area;
    let at = |share: f32| whole.min + track.place_at(share, whole.size()) * whole.size();
    let line = |from: f32, to: f32| {
        (0..=POINTS).map(move |step| at(from + (to - from) * step as f32 / POINTS as f32))
    };
    let (low, high) = match track {
        SliderTrack::Line { .. } => {
            // A slanted line comes nearer to the side of the face than to its end.
            let edge = 1.5 * (0.5 * broad + 0.012) / at(0.0).distance(at(1.0));
            (edge.min(0.4), 1.0 - edge.min(0.4))
        }
        SliderTrack::Arc { .. } => (0.0, 1.0),
    };
    let share = scale.share(value).clamp(low, high);
    let broadly = |colour| Paint::stroke(Stroke::new(broad, Ink::solid(colour)));
    scene.add_path(line(low, high), false, broadly(face.groove()));
    if share > low {
        scene.add_path(line(low, share), false, broadly(face.lit()));
    }
    for stop in stops(scale).into_iter().flatten() {
        let tick = Paint::fill(Ink::faint(face.ink, 0.35));
        scene.add_circle(at(stop), 0.003, tick);
    }
    let colour = HANDLE.mix(face.colour, if face.is_out_of_use() { 0.5 } else { 0.0 });
    let outline = face.theme.readable(face.ink, colour);
    let edge = Stroke::new(if face.state.pressed { 0.006 } else { 0.0035 }, Ink::solid(outline));
    scene.add_circle(at(share), 0.5 * broad + 0.004, Paint::fill(Ink::solid(colour)).with_stroke(edge));
    scene.add_circle(at(share), 0.005, Paint::fill(Ink::faint(outline, 0.7)));
    let (middle, room) = words(track, face.area.grown(-0.02), broad);
    write(scene, face, middle, room, &Reading::of(scale, value));
    face.draw_badge(scene);
}

/// Position and width of the value and the label: at the centre of an arc, or in the corner that a line leaves free.
fn words(track: SliderTrack, area: Rect, broad: f32) -> (Vec2, f32) {
    match (track, track.circle(area.size())) {
        (_, Some((centre, radius))) => {
            let hub = area.centre() + centre;
            let middle = hub.clamp(area.min + Vec2::splat(0.03), area.max - Vec2::splat(0.03));
            (middle + Vec2::new(0.0, 0.014), (radius - 0.5 * broad) * 1.3)
        }
        (SliderTrack::Line { degrees }, None) => {
            let rising = degrees.to_radians().tan() >= 0.0;
            let side = if rising { 1.0 } else { -1.0 };
            let corner = area.centre() + area.size() * Vec2::new(0.25 * side, -0.28);
            (corner, 0.46 * area.size().x)
        }
        (SliderTrack::Arc { .. }, None) => (area.centre(), 0.5 * area.size().x),
    }
}

/// The value with the label beneath it, both within `room` metres.
fn write(scene: &mut Scene, face: &Face<'_>, middle: Vec2, room: f32, reading: &Reading) {
    let size_m = (room / reading.widest).min(0.036);
    let mut lettering = Lettering::new(middle, Anchor::Middle, size_m, Ink::solid(face.ink)).strong();
    scene.add_text(lettering, format_args!("{}", reading.text));
    let below = middle.y - 0.006 - CAP_HEIGHT * SMALL_M - 0.25 * SMALL_M;
    // A badge needs the strip for itself.
    if face.badge().is_none() && below > face.area.min.y + 0.004 {
        lettering.at.y = below + 0.25 * SMALL_M;
        lettering.size_m = SMALL_M;
        scene.add_line_of(lettering, face.label(), room, SMALL_M);
    }
}
