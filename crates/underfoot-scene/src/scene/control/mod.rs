//! Controls: each has a face with the features of its kind.

mod curved;
mod dial;
mod lean;
mod pad;
mod pedal;
mod reading;
mod selector;
mod slider;
mod stepper;
mod switch;

use glam::Vec2;

use super::face::{Face, SMALL_M};
use super::mark::{Anchor, Ink, Lettering, Paint, Stroke};
use super::widths::CAP_HEIGHT;
use super::{Scene, View, layers};
use reading::Reading;
use underfoot::engine::WidgetState;
use underfoot::floor::Rect;
use underfoot::layout::{Colour, Shape, Widget};
use underfoot::widget::{Axis, Behaviour, Scale, SliderTrack, Value};

/// Colour of a slider's handle.
const HANDLE: Colour = Colour::rgb(0xff, 0xff, 0xff);

/// Maximum number of steps drawn as ticks.
const MOST_STOPS: f32 = 20.5;

/// Draws every control in the layout's order.
pub(super) fn draw_all(scene: &mut Scene, view: &View<'_>) {
    for (index, widget) in view.layout.widgets.iter().enumerate() {
        let mut state = view.widget_state(index);
        if !view.show.engagement {
            state.press_share = 0.0;
        } else if view.show.ignored && state.press_share <= 0.0 {
            state.press_share = layers::light_share(view, widget);
        }
        if !state.hidden {
            draw(scene, view, view.as_apps_set(index, widget).as_ref().unwrap_or(widget), state);
        }
    }
}

fn draw(scene: &mut Scene, view: &View<'_>, widget: &Widget, state: WidgetState) {
    let pressed = f32::from(u8::from(state.pressed));
    let face = |lit: f32| Face::new(widget, state, view.theme, lit);
    // Faces with a value keep their colour, with only a trace of the lit one.
    let calm = || face(0.12 * pressed).straight();
    match (&widget.behaviour, state.value) {
        (Behaviour::Switch(_), Some(Value::Switch(on))) => {
            // A switch that is on is lit; pressing mixes in 30 % of the other colour.
            let lit = if on { 1.0 - 0.3 * pressed } else { 0.3 * pressed };
            switch::draw(scene, &face(lit), on);
        }
        (Behaviour::Hold(_), Some(Value::Switch(on))) => {
            hold(scene, &face(if on { 1.0 } else { building(state) }), on);
        }
        (Behaviour::Selector(spec), Some(Value::Choice(choice))) => {
            selector::draw(scene, &calm(), spec, choice);
        }
        (Behaviour::Slider(spec), Some(Value::Number(value))) => match spec.track {
            SliderTrack::EAST => slider::draw(scene, &calm(), &spec.scale, Axis::East, value),
            SliderTrack::NORTH => slider::draw(scene, &calm(), &spec.scale, Axis::North, value),
            track => curved::draw(scene, &calm(), &spec.scale, track, value),
        },
        (Behaviour::Pedal(spec), Some(Value::Number(value))) => {
            pedal::draw(scene, &calm(), &spec.scale, value);
        }
        (Behaviour::Pad(spec), Some(Value::Pair(value))) => pad::draw(scene, &calm(), spec, value),
        (Behaviour::Dial(spec), Some(Value::Number(value))) => {
            dial::draw(scene, &face(0.12 * pressed), spec, value);
        }
        (Behaviour::Stepper(spec), Some(Value::Number(value))) => {
            stepper::draw(scene, &calm(), spec, value);
        }
        (Behaviour::Lean(_), Some(Value::Pair(value))) => {
            lean::draw(scene, &face(0.3 * pressed), value);
        }
        _ => button(scene, &face(pressed.max(building(state)))),
    }
}

/// Lit share of a face while the force on it is growing.
fn building(state: WidgetState) -> f32 {
    if state.press_share.is_finite() { 0.25 * state.press_share.clamp(0.0, 1.0) } else { 0.0 }
}

fn button(scene: &mut Scene, face: &Face<'_>) {
    face.draw(scene);
    face.write_label(scene);
    face.draw_badge(scene);
}

/// A hold control: the label, and a bar that a foot holds down.
fn hold(scene: &mut Scene, face: &Face<'_>, on: bool) {
    face.draw(scene);
    let area = beside(scene, face, 0.11, 0.62);
    let ink = Ink::solid(face.ink);
    let size = area.size();
    let stroke = |width: f32| Paint::stroke(Stroke::new(width, ink));
    let base = Vec2::new(0.5 * size.x, 0.06 * size.y);
    let south = Vec2::new(area.centre().x, area.min.y + base.y);
    scene.add_line(south - Vec2::new(base.x, 0.0), south + Vec2::new(base.x, 0.0), stroke(0.007));
    // An arrow, on the bar while it is held and above it otherwise.
    let tip = south + Vec2::new(0.0, if on { 0.010 } else { 0.24 * size.y });
    let tail = Vec2::new(tip.x, area.max.y);
    scene.add_line(tip, tail, stroke(0.006));
    let wing = Vec2::splat(0.26 * size.y);
    scene.add_path([tip + wing * Vec2::new(-1.0, 1.0), tip, tip + wing], false, stroke(0.006));
    face.draw_badge(scene);
}

/// Writes the label, and returns the area beside or above it for a symbol of at most `widest_m`, with the depth
/// `tall` times the width.
fn beside(scene: &mut Scene, face: &Face<'_>, widest_m: f32, tall: f32) -> Rect {
    let room = face.room();
    let size = room.size();
    let wide = size.x > 1.7 * size.y;
    let across = if wide { 0.42 * size.x } else { 0.8 * size.x }.min(widest_m);
    let down = (tall * across).min(if wide { 0.8 * size.y } else { 0.42 * size.y });
    let figure = Vec2::new(across, down);
    let gap = if wide { 0.022 } else { 0.012 };
    let labelled = !face.label().is_empty() || face.widget.look.icon.is_some();
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
        let label = face.draw_icon(scene, label);
        let anchor = if wide && face.shape == Shape::Box { Anchor::Start } else { Anchor::Middle };
        face.write(scene, face.label(), label, anchor);
    }
    Rect::from_centre_size(middle, figure)
}

/// Depth of the strip with label and value at the top of a face.
fn strip_m(face: &Face<'_>) -> f32 {
    (0.34 * face.area.size().y).min(0.062)
}

/// Writes the label at the strip's start and the value at its end.
fn caption(scene: &mut Scene, face: &Face<'_>, strip: Rect, reading: &Reading) {
    // Clear of the round ends of a slider with a round shape.
    let inset = 0.022 + 0.5 * (face.radius_m - 0.028).max(0.0);
    let room = strip.size().x - 2.0 * inset;
    // The label gets about as much room as the value.
    let part = if face.label().is_empty() { 1.0 } else { 0.46 };
    let size_m = (0.60 * strip.size().y).min(0.036).min(part * room / reading.widest);
    let wide = reading.widest * size_m;
    let value = Vec2::new(strip.max.x - inset, strip.centre().y - 0.5 * CAP_HEIGHT * size_m);
    let lettering = Lettering::new(value, Anchor::End, size_m, Ink::solid(face.ink)).strong();
    scene.add_text(lettering, format_args!("{}", reading.text));
    let end = strip.max.x - inset - wide - 0.02;
    let start = strip.min.x + inset;
    let lettering = Lettering { at: Vec2::new(start, value.y), anchor: Anchor::Start, ..lettering };
    scene.add_line_of(lettering, face.label(), end - start, SMALL_M.min(size_m));
}

/// Shares of the scale with a stop between its ends; `None` if they are too many to distinguish.
fn stops(scale: &Scale) -> Option<impl Iterator<Item = f32> + use<>> {
    let width = if scale.step > 0.0 { scale.step } else { scale.detent };
    let stops = scale.range() / width;
    let shown = (1.5..=MOST_STOPS).contains(&stops);
    shown.then(|| (1..(stops + 0.5) as usize).map(move |stop| stop as f32 / stops))
}
