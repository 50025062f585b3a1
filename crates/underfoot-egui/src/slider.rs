//! A slider for feet: several can be dragged at once, and a cancel restores the value.

use std::ops::RangeInclusive;

use egui::{
    Event, Pos2, Rect, Response, Sense, StrokeKind, TextStyle, TouchId, TouchPhase, Ui, Vec2, Widget,
    WidgetInfo, WidgetText, lerp, pos2, remap_clamp, vec2,
};

use crate::touch::DEVICE;

/// Its height, and its width without more room, in points: a foot's ball is as wide.
const HEIGHT: f32 = 48.0;
const WIDTH: f32 = 260.0;

/// Width of its knob, in points.
const KNOB: f32 = 26.0;

/// A horizontal slider for feet: as large as they need it, several can be dragged at once, and a cancelled press
/// restores the value.
///
/// egui has one pointer, so of several feet on its own sliders only the first drags. This one reads touches itself:
/// the foot that lands on it keeps it until it lifts. A mouse drags it like any slider.
#[must_use = "it is shown by `ui.add`"]
pub struct FootSlider<'a> {
    value: &'a mut f32,
    range: RangeInclusive<f32>,
    text: String,
}

/// The foot that drags it, and the value that a cancel restores.
#[derive(Clone, Copy, Debug)]
struct Grip {
    touch: TouchId,
    before: f32,
}

impl<'a> FootSlider<'a> {
    /// A slider of `value` from the range's start on the left to its end on the right, either of which may be the
    /// larger one. It shows a value that is not finite at the start.
    pub fn new(value: &'a mut f32, range: RangeInclusive<f32>) -> Self {
        Self { value, range, text: String::new() }
    }

    /// The text on it, which is also its name for screen readers.
    pub fn text(mut self, text: impl Into<String>) -> Self {
        self.text = text.into();
        self
    }
}

impl Widget for FootSlider<'_> {
    fn ui(self, ui: &mut Ui) -> Response {
        let width = ui.available_width().clamp(2.0 * KNOB, WIDTH);
        let (rect, mut response) = ui.allocate_exact_size(vec2(width, HEIGHT), Sense::drag());
        let before = *self.value;
        let mut grip: Option<Grip> = ui.data(|data| data.get_temp(response.id));
        let was_gripped = grip.is_some();
        for (touch, phase, at) in touches(ui) {
            let own = grip.filter(|grip| grip.touch == touch);
            match phase {
                TouchPhase::Start if ui.is_enabled() && is_hit(ui, &response, at) => {
                    grip = Some(Grip { touch, before: *self.value });
                    *self.value = value_at(&self.range, rect, at);
                }
                TouchPhase::Start => {}
                TouchPhase::Move if own.is_some() => *self.value = value_at(&self.range, rect, at),
                TouchPhase::Move => {}
                TouchPhase::End | TouchPhase::Cancel => {
                    if let Some(own) = own {
                        if phase == TouchPhase::Cancel {
                            *self.value = own.before;
                        }
                        grip = None;
                    }
                }
            }
        }
        // The pointer of the foot that drags it only repeats its touch.
        let is_gripped = grip.is_some();
        if let (false, false, true, Some(at)) =
            (was_gripped, is_gripped, response.dragged(), response.interact_pointer_pos())
        {
            *self.value = value_at(&self.range, rect, at);
        }
        ui.data_mut(|data| match grip {
            Some(grip) => {
                data.insert_temp(response.id, grip);
            }
            None => data.remove::<Grip>(response.id),
        });
        if *self.value != before {
            response.mark_changed();
        }
        let value = f64::from(*self.value);
        response.widget_info(|| WidgetInfo::slider(ui.is_enabled(), value, &self.text));
        self.paint(ui, rect, &response, is_gripped);
        response
    }
}

impl FootSlider<'_> {
    fn paint(&self, ui: &Ui, rect: Rect, response: &Response, is_gripped: bool) {
        if !ui.is_rect_visible(rect) {
            return;
        }
        let states = &ui.visuals().widgets;
        let visuals = if is_gripped { &states.active } else { ui.style().interact(response) };
        let painter = ui.painter();
        painter.rect(
            rect,
            visuals.corner_radius,
            states.inactive.bg_fill,
            visuals.bg_stroke,
            StrokeKind::Inside,
        );
        let x = place_of(&self.range, rect, *self.value);
        let filled = Rect::from_min_max(rect.min, pos2(x, rect.max.y));
        painter.rect_filled(filled, visuals.corner_radius, ui.visuals().selection.bg_fill);
        let knob = Rect::from_center_size(pos2(x, rect.center().y), vec2(KNOB, HEIGHT));
        let ink = visuals.fg_stroke;
        painter.rect(knob.shrink(3.0), visuals.corner_radius, visuals.weak_bg_fill, ink, StrokeKind::Inside);
        let words = WidgetText::from(&self.text);
        let galley = words.into_galley(ui, None, rect.width() - KNOB, TextStyle::Button);
        let at = rect.center() - 0.5 * galley.size();
        painter.galley(at, galley, ui.visuals().text_color());
    }
}

/// The touches of feet since the last frame.
fn touches(ui: &Ui) -> Vec<(TouchId, TouchPhase, Pos2)> {
    ui.input(|input| {
        let touch = |event: &Event| match event {
            Event::Touch { device_id: DEVICE, id, phase, pos, .. } => Some((*id, *phase, *pos)),
            _ => None,
        };
        input.events.iter().filter_map(touch).collect()
    })
}

/// Whether a touch at `at` lands on it, and not on a layer above it.
fn is_hit(ui: &Ui, response: &Response, at: Pos2) -> bool {
    response.interact_rect.contains(at)
        && ui.ctx().layer_id_at(at).is_none_or(|layer| layer == response.layer_id)
}

/// The track of the knob's centre.
fn track(rect: Rect) -> Rect {
    rect.shrink2(Vec2::new(0.5 * KNOB, 0.0))
}

fn value_at(range: &RangeInclusive<f32>, rect: Rect, at: Pos2) -> f32 {
    let track = track(rect);
    let share = remap_clamp(at.x, track.left()..=track.right(), 0.0..=1.0);
    lerp(*range.start()..=*range.end(), share)
}

fn place_of(range: &RangeInclusive<f32>, rect: Rect, value: f32) -> f32 {
    let track = track(rect);
    let share = (value - range.start()) / (range.end() - range.start());
    let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
    lerp(track.left()..=track.right(), share)
}
