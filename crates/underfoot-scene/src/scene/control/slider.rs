//! The face of a straight slider.

use glam::Vec2;

use super::super::Scene;
use super::super::face::{BADGE_STRIP_M, Face, SMALL_M};
use super::super::mark::{Anchor, Ink, Lettering, Paint, Stroke};
use super::super::widths::CAP_HEIGHT;
use super::reading::Reading;
use super::{HANDLE, caption, stops};
use underfoot::floor::Rect;
use underfoot::widget::{Axis, Scale};

/// A caption strip with label and value, and a track filled up to the handle.
///
/// Along its axis the track is as long as the control, so the handle is at the foot's place.
pub(super) fn draw(scene: &mut Scene, face: &Face<'_>, scale: &Scale, axis: Axis, value: f32) {
    face.draw(scene);
    let area = face.area;
    let reading = Reading::of(scale, value);
    let size = area.size();
    let inset = 0.010;
    let track = match axis {
        Axis::East => {
            let strip = (0.34 * size.y).min(0.062);
            caption(scene, face, Rect::new(Vec2::new(area.min.x, area.max.y - strip), area.max), &reading);
            Rect::new(area.min + inset, Vec2::new(area.max.x - inset, area.max.y - strip))
        }
        Axis::North => {
            let strip = (0.42 * size.x).min(0.085);
            let side = Rect::new(Vec2::new(area.max.x - strip, area.min.y), area.max);
            upright_caption(scene, face, side, &reading);
            Rect::new(area.min + inset, Vec2::new(area.max.x - strip, area.max.y - inset))
        }
    };
    self::track(scene, face, scale, axis, track, value);
    match axis {
        // On the half of the track without the handle.
        Axis::East => {
            let east = if scale.share(value) > 0.5 { 0.25 } else { 0.75 };
            let x = track.min.x + east * track.size().x;
            face.draw_badge_at(scene, Vec2::new(x, track.centre().y));
        }
        Axis::North => face.draw_badge(scene),
    }
}

fn track(scene: &mut Scene, face: &Face<'_>, scale: &Scale, axis: Axis, track: Rect, value: f32) {
    let share = scale.share(value);
    let out_of_use = face.is_out_of_use();
    let lit = face.lit();
    let radius = face.radius_m - 0.008;
    scene.add_box(track, radius, face.sunk());
    let along = match axis {
        Axis::East => Vec2::X,
        Axis::North => Vec2::Y,
    };
    // The foot's position is measured from the control's own ends, not from the track's.
    let (low, high) = (face.widget.area.min, face.widget.area.max);
    let at = (low + (high - low) * share).clamp(track.min, track.max);
    let end = track.max * (Vec2::ONE - along) + at * along;
    scene.add_box(Rect::new(track.min, end), radius, Paint::fill(Ink::solid(lit)));
    steps(scene, face, scale, track, along);
    // The handle: a bar across the track.
    let thick = 0.022;
    let reach = track.size() * (Vec2::ONE - along) + along * thick;
    let middle = track.centre() * (Vec2::ONE - along)
        + at.clamp(track.min + 0.5 * thick, track.max - 0.5 * thick) * along;
    let handle = Rect::from_centre_size(middle, reach).grown(0.004);
    if !out_of_use {
        let shadow = Paint::fill(Ink::faint(face.theme.shadow, 0.16));
        scene.add_box(handle.grown(0.003), 0.012, shadow);
    }
    // The handle is light on a lit track; its edge separates it from the track.
    let colour = HANDLE.mix(face.colour, if out_of_use { 0.5 } else { 0.0 });
    let outline = face.theme.readable(face.ink, colour);
    let edge = Stroke::new(if face.state.pressed { 0.006 } else { 0.0035 }, Ink::solid(outline));
    scene.add_box(handle, 0.009, Paint::fill(Ink::solid(colour)).with_stroke(edge));
    let grip = 0.5 * handle.size() * (Vec2::ONE - along) * 0.45;
    scene.add_line(middle - grip, middle + grip, Paint::stroke(Stroke::new(0.003, Ink::faint(outline, 0.7))));
}

/// Small ticks at the stops, unless they are too many to distinguish.
fn steps(scene: &mut Scene, face: &Face<'_>, scale: &Scale, track: Rect, along: Vec2) {
    let Some(stops) = stops(scale) else { return };
    let (low, high) = (face.widget.area.min, face.widget.area.max);
    for share in stops {
        let at = low + (high - low) * share;
        let across = Vec2::ONE - along;
        let from = track.min * across + at * along;
        let to = from + across * (0.16 * track.size()).min(Vec2::splat(0.014));
        scene.add_line(from, to, Paint::stroke(Stroke::new(0.003, Ink::faint(face.ink, 0.35))));
    }
}

/// Writes the value at the top of a narrow strip, and the label upright below it.
fn upright_caption(scene: &mut Scene, face: &Face<'_>, strip: Rect, reading: &Reading) {
    let inset = 0.008;
    let size_m = ((strip.size().x - inset) / reading.widest).min(0.034);
    let centre = strip.centre().x - 0.5 * inset;
    let top = strip.max.y - 0.016 - CAP_HEIGHT * size_m;
    let mut lettering =
        Lettering::new(Vec2::new(centre, top), Anchor::Middle, size_m, Ink::solid(face.ink)).strong();
    scene.add_text(lettering, format_args!("{}", reading.text));
    let south = strip.min.y + if face.badge().is_some() { BADGE_STRIP_M + 0.014 } else { 0.018 };
    lettering.at = Vec2::new(centre, south);
    lettering.anchor = Anchor::Start;
    lettering.turn_rad = std::f32::consts::FRAC_PI_2;
    lettering.size_m = 0.036_f32.min(0.7 * (strip.size().x - inset));
    // Turned to read northwards, the letters are west of their base line.
    lettering.at.x += 0.5 * CAP_HEIGHT * lettering.size_m;
    let smallest_m = SMALL_M.min(lettering.size_m);
    scene.add_line_of(lettering, &face.widget.label, top - 0.012 - south, smallest_m);
}
