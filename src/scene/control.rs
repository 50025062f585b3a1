//! Buttons, switches and sliders.

use std::fmt;

use glam::Vec2;

use super::face::{BADGE_STRIP_M, Face, SMALL_M};
use super::mark::{Anchor, Ink, Lettering, Paint, Stroke};
use super::theme::readable;
use super::widths::{CAP_HEIGHT, width};
use super::{Scene, View};
use crate::floor::Rect;
use crate::layout::{Colour, Shape, Widget};
use crate::widget::{Axis, Behaviour, Scale, SliderSpec, Track, Value};

/// A slider's handle.
const HANDLE: Colour = Colour::rgb(0xff, 0xff, 0xff);

/// Draws every control in the layout's order.
pub(super) fn draw_all(scene: &mut Scene, view: &View<'_>) {
    for (index, widget) in view.layout.widgets.iter().enumerate() {
        draw(scene, view, index, widget);
    }
}

fn draw(scene: &mut Scene, view: &View<'_>, index: usize, widget: &Widget) {
    let state = view.widget_state(index);
    let pressed = f32::from(u8::from(state.pressed));
    match (&widget.behaviour, state.value) {
        (Behaviour::Switch(_), Some(Value::Switch(on))) => {
            // On is lit; pressing shows half of the other colour under either.
            let lit = if on { 1.0 - 0.3 * pressed } else { 0.3 * pressed };
            switch(scene, &Face::new(widget, state, view.theme, lit), on);
        }
        (Behaviour::Slider(slider), Some(Value::Number(value))) => {
            let face = Face::new(widget, state, view.theme, 0.12 * pressed).straight();
            self::slider(scene, &face, slider, value);
        }
        _ => {
            let building =
                if state.press_share.is_finite() { state.press_share.clamp(0.0, 1.0) } else { 0.0 };
            button(scene, &Face::new(widget, state, view.theme, pressed.max(0.25 * building)));
        }
    }
}

fn button(scene: &mut Scene, face: &Face<'_>) {
    face.draw(scene);
    face.write_label(scene);
    face.draw_badge(scene);
}

/// The label, and a pill whose knob stands at one end.
fn switch(scene: &mut Scene, face: &Face<'_>, on: bool) {
    face.draw(scene);
    let room = face.room();
    let size = room.size();
    let wide = size.x > 1.7 * size.y;
    let across = if wide { 0.42 * size.x } else { 0.8 * size.x }.min(0.135);
    let down = (0.46 * across).min(if wide { 0.8 * size.y } else { 0.42 * size.y });
    let pill_size = Vec2::new(across, down);
    let gap = if wide { 0.022 } else { 0.012 };
    let labelled = !face.widget.label.is_empty();
    let (label, middle) = match (labelled, wide) {
        (false, _) => (None, room.centre()),
        (true, true) => (
            Some(Rect::new(room.min, Vec2::new(room.max.x - across - gap, room.max.y))),
            Vec2::new(room.max.x - 0.5 * across, room.centre().y),
        ),
        (true, false) => (
            Some(Rect::new(Vec2::new(room.min.x, room.min.y + down + gap), room.max)),
            Vec2::new(room.centre().x, room.min.y + 0.5 * down),
        ),
    };
    if let Some(label) = label {
        let anchor = if wide && face.shape == Shape::Box { Anchor::Start } else { Anchor::Middle };
        face.write(scene, &face.widget.label, label, anchor);
    }
    pill(scene, face, Rect::from_centre_size(middle, pill_size), on);
    face.draw_badge(scene);
}

fn pill(scene: &mut Scene, face: &Face<'_>, area: Rect, on: bool) {
    let radius = 0.5 * area.size().y;
    let edge = Stroke::new(0.004, Ink::solid(face.ink));
    // On: filled with ink, a hole for a knob. Off: an outline with a knob of ink.
    let (paint, knob) = if on {
        (Paint::fill(Ink::solid(face.ink)).with_stroke(edge), face.colour)
    } else {
        (Paint::fill(Ink::faint(face.colour, 0.6)).with_stroke(edge), face.ink)
    };
    scene.add_box(area, radius, paint);
    let reach = 0.5 * area.size().x - radius;
    let side = if on { reach } else { -reach };
    let centre = area.centre();
    scene.add_circle(centre + Vec2::new(side, 0.0), radius - 0.009, Paint::fill(Ink::solid(knob)));
    let size_m = (1.05 * radius).min(0.032);
    let ink = if on { readable(face.colour, face.ink) } else { face.ink };
    let lettering = Lettering {
        at: centre - Vec2::new(0.85 * side, 0.5 * CAP_HEIGHT * size_m),
        anchor: Anchor::Middle,
        size_m,
        strong: true,
        turn_rad: 0.0,
        ink: Ink::solid(ink),
    };
    if size_m >= 0.018 {
        scene.add_text(lettering, format_args!("{}", if on { "on" } else { "off" }));
    }
}

/// A caption strip with label and value, and a track whose filled part ends at the handle.
///
/// Along its axis the track is as long as the control: the handle is where the foot is.
fn slider(scene: &mut Scene, face: &Face<'_>, slider: &SliderSpec, value: f32) {
    face.draw(scene);
    let area = face.area;
    let text = Reading { value, slider };
    let size = area.size();
    let inset = 0.010;
    let track = match axis_of(slider) {
        Axis::East => {
            let strip = (0.34 * size.y).min(0.062);
            caption(scene, face, Rect::new(Vec2::new(area.min.x, area.max.y - strip), area.max), text);
            Rect::new(area.min + inset, Vec2::new(area.max.x - inset, area.max.y - strip))
        }
        Axis::North => {
            let strip = (0.42 * size.x).min(0.085);
            let side = Rect::new(Vec2::new(area.max.x - strip, area.min.y), area.max);
            upright_caption(scene, face, side, text);
            Rect::new(area.min + inset, Vec2::new(area.max.x - strip, area.max.y - inset))
        }
    };
    self::track(scene, face, slider, track, value);
    match axis_of(slider) {
        // On the half of the track where the handle is not.
        Axis::East => {
            let east = if value > 0.5 * (slider.scale.min + slider.scale.max) { 0.25 } else { 0.75 };
            let x = track.min.x + east * track.size().x;
            face.draw_badge_at(scene, Vec2::new(x, track.centre().y));
        }
        Axis::North => face.draw_badge(scene),
    }
}

fn axis_of(slider: &SliderSpec) -> Axis {
    if slider.track == Track::NORTH { Axis::North } else { Axis::East }
}

fn track(scene: &mut Scene, face: &Face<'_>, slider: &SliderSpec, track: Rect, value: f32) {
    let share = ((value - slider.scale.min) / (slider.scale.max - slider.scale.min)).clamp(0.0, 1.0);
    let share = if share.is_finite() { share } else { 0.0 };
    let out_of_use = face.state.disabled || face.state.needs_lift;
    let lit = if out_of_use { face.widget.look.lit.mix(face.theme.plate, 0.6) } else { face.widget.look.lit };
    let radius = face.radius_m - 0.008;
    let ground = face.colour.mix(face.theme.shadow, 0.13);
    scene.add_box(track, radius, Paint::fill(Ink::solid(ground)));
    let along = match axis_of(slider) {
        Axis::East => Vec2::X,
        Axis::North => Vec2::Y,
    };
    // The control's own ends, not the track's: what the foot is measured by.
    let (low, high) = (face.widget.area.min, face.widget.area.max);
    let at = (low + (high - low) * share).clamp(track.min, track.max);
    let end = track.max * (Vec2::ONE - along) + at * along;
    scene.add_box(Rect::new(track.min, end), radius, Paint::fill(Ink::solid(lit)));
    steps(scene, face, slider, track, along);
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
    // Light on a lit track, and told from the rest of it by its edge.
    let colour = HANDLE.mix(face.colour, if out_of_use { 0.5 } else { 0.0 });
    let outline = readable(face.ink, colour);
    let edge = Stroke::new(if face.state.pressed { 0.006 } else { 0.0035 }, Ink::solid(outline));
    scene.add_box(handle, 0.009, Paint::fill(Ink::solid(colour)).with_stroke(edge));
    let grip = 0.5 * handle.size() * (Vec2::ONE - along) * 0.45;
    scene.add_line(middle - grip, middle + grip, Paint::stroke(Stroke::new(0.003, Ink::faint(outline, 0.7))));
}

/// Small ticks where the value may stop, if they are few enough to be told apart.
fn steps(scene: &mut Scene, face: &Face<'_>, slider: &SliderSpec, track: Rect, along: Vec2) {
    let stops = (slider.scale.max - slider.scale.min) / slider.scale.step;
    if !(2.0..=20.5).contains(&stops) {
        return;
    }
    let (low, high) = (face.widget.area.min, face.widget.area.max);
    for stop in 1..(stops + 0.5) as usize {
        let at = low + (high - low) * (stop as f32 / stops);
        let across = Vec2::ONE - along;
        let from = track.min * across + at * along;
        let to = from + across * (0.16 * track.size()).min(Vec2::splat(0.014));
        scene.add_line(from, to, Paint::stroke(Stroke::new(0.003, Ink::faint(face.ink, 0.35))));
    }
}

/// Label at the strip's beginning, value at its end.
fn caption(scene: &mut Scene, face: &Face<'_>, strip: Rect, reading: Reading<'_>) {
    // Clear of the round ends of a slider whose kind is round.
    let inset = 0.022 + 0.5 * (face.radius_m - 0.028).max(0.0);
    let size_m = (0.60 * strip.size().y).min(0.036);
    let wide = reading.widest() * size_m;
    let value = Vec2::new(strip.max.x - inset, strip.centre().y - 0.5 * CAP_HEIGHT * size_m);
    let lettering = Lettering {
        at: value,
        anchor: Anchor::End,
        size_m,
        strong: true,
        turn_rad: 0.0,
        ink: Ink::solid(face.ink),
    };
    scene.add_text(lettering, format_args!("{reading}"));
    let end = strip.max.x - inset - wide - 0.02;
    let start = strip.min.x + inset;
    let lettering = Lettering { at: Vec2::new(start, value.y), anchor: Anchor::Start, ..lettering };
    scene.add_line_of(lettering, &face.widget.label, end - start, SMALL_M.min(size_m));
}

/// Value at the top of a narrow strip, the label turned upright below it.
fn upright_caption(scene: &mut Scene, face: &Face<'_>, strip: Rect, reading: Reading<'_>) {
    let inset = 0.008;
    let size_m = ((strip.size().x - inset) / reading.widest()).min(0.034);
    let centre = strip.centre().x - 0.5 * inset;
    let top = strip.max.y - 0.016 - CAP_HEIGHT * size_m;
    let mut lettering = Lettering {
        at: Vec2::new(centre, top),
        anchor: Anchor::Middle,
        size_m,
        strong: true,
        turn_rad: 0.0,
        ink: Ink::solid(face.ink),
    };
    scene.add_text(lettering, format_args!("{reading}"));
    let south = strip.min.y + if face.badge().is_some() { BADGE_STRIP_M + 0.014 } else { 0.018 };
    lettering.at = Vec2::new(centre, south);
    lettering.anchor = Anchor::Start;
    lettering.turn_rad = std::f32::consts::FRAC_PI_2;
    lettering.size_m = 0.036_f32.min(0.7 * (strip.size().x - inset));
    // Turned to read northwards, the letters stand west of their base line.
    lettering.at.x += 0.5 * CAP_HEIGHT * lettering.size_m;
    let smallest_m = SMALL_M.min(lettering.size_m);
    scene.add_line_of(lettering, &face.widget.label, top - 0.012 - south, smallest_m);
}

/// A slider's value with as many decimals as its steps need.
#[derive(Clone, Copy)]
struct Reading<'a> {
    value: f32,
    slider: &'a SliderSpec,
}

impl Reading<'_> {
    fn decimals(&self) -> usize {
        let Scale { min, max, step, .. } = self.slider.scale;
        let enough = |decimals: &i32| {
            let scale = 10_f32.powi(*decimals);
            if step > 0.0 {
                let scaled = step * scale;
                scaled > 0.5 && (scaled - scaled.round()).abs() < 1e-3 * scaled
            } else {
                // Without steps a hundredth of the range is as fine as a foot can do.
                0.01 * (max - min) * scale >= 0.999
            }
        };
        (0..4).find(enough).unwrap_or(4) as usize
    }

    /// Width that any value of the range may need, in em, so that the label never jumps.
    fn widest(&self) -> f32 {
        let number = |value: f32| {
            let mut digits = arrayvec::ArrayString::<48>::new();
            let _ = fmt::Write::write_fmt(&mut digits, format_args!("{:.1$}", value, self.decimals()));
            width(&digits)
        };
        number(self.slider.scale.min).max(number(self.slider.scale.max))
    }
}

impl fmt::Display for Reading<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let decimals = self.decimals();
        // No minus sign before a value that reads as zero.
        let half = 0.5 * 10_f32.powi(-(decimals as i32));
        let value = if self.value.abs() < half { 0.0 } else { self.value };
        write!(f, "{value:.decimals$}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::Newtons;
    use crate::widget::Thresholds;

    fn reading(min: f32, max: f32, step: f32, value: f32) -> String {
        let thresholds = Thresholds::new(Newtons(30.0), Newtons(20.0));
        let slider = SliderSpec::new(thresholds, Scale { step, ..Scale::new(min, max) });
        Reading { value, slider: &slider }.to_string()
    }

    #[test]
    fn values_show_the_decimals_their_steps_need() {
        assert_eq!(reading(0.0, 1.0, 0.0, 0.333), "0.33");
        assert_eq!(reading(0.0, 10.0, 0.5, 2.5), "2.5");
        assert_eq!(reading(0.0, 1.0, 0.25, 0.75), "0.75");
        assert_eq!(reading(0.0, 200.0, 0.0, 66.6), "67");
        assert_eq!(reading(1.0, 18.0, 1.0, 12.0), "12");
        assert_eq!(reading(-1.0, 1.0, 0.0, -0.001), "0.00");
    }
}
