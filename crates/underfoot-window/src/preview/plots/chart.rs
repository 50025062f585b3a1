//! One plot: lines of the same unit over the last seconds, and thresholds that the pointer can drag.

use eframe::egui;
use eframe::egui::{
    Align2, Color32, CursorIcon, EventFilter, FontId, Key, Rect, Sense, Ui, WidgetInfo, pos2,
};
use egui_plot::{GridInput, GridMark, HLine, HoverPosition, Line, LineStyle, Plot, PlotPoint, PlotPoints};

use super::series::Unit;
use crate::preview::design::Threshold;
use underfoot::units::Newtons;
use underfoot::widget::WidgetId;
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Height of the area around a threshold's line that the pointer can grab, in points.
const GRIP: f32 = 11.0;

/// Step of the arrow keys for a threshold, in newtons; ten times as much with Shift.
const KEY_N: f32 = 1.0;

/// One line.
pub(super) struct PlotLine {
    pub(super) name: String,
    pub(super) colour: Color32,
    pub(super) points: Vec<[f64; 2]>,
}

/// Both thresholds of a control, each with its force.
pub(super) type ThresholdPair = [(Threshold, Newtons); 2];

/// The content of a plot.
pub(super) struct Chart<'a> {
    pub(super) theme: &'a Theme,
    pub(super) unit: Unit,
    pub(super) span_s: f64,
    pub(super) height: f32,
    pub(super) traces: Vec<PlotLine>,
    /// The control with its thresholds and their forces, and whether they can be set.
    pub(super) thresholds: Option<(&'a WidgetId, ThresholdPair, bool)>,
    /// The thresholds without the present drag: an axis that followed the drag would move away from the pointer.
    pub(super) at_rest: Option<[Newtons; 2]>,
}

/// The drag of a threshold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum ThresholdDrag {
    /// In progress.
    To(Threshold, Newtons),
    /// Released there.
    Done(Threshold, Newtons),
}

impl Chart<'_> {
    /// Draws the plot; returns the drag of a threshold, if any.
    pub(super) fn show(self, ui: &mut Ui) -> Option<ThresholdDrag> {
        let Self { theme, unit, span_s, height, traces, thresholds, at_rest } = self;
        let lines = at_rest.into_iter().flatten().map(|force| f64::from(force.0));
        let (low, high) = bounds(unit, traces.iter().flat_map(|trace| &trace.points).map(|it| it[1]), lines);
        let spoken = traces.iter().map(|trace| told(trace, unit)).collect::<Vec<_>>().join(", ");
        // A margin keeps lines at the ends of the axis fully visible.
        let (under, over) = (low - 0.04 * (high - low), high + 0.06 * (high - low));
        let fixed = |range: [f64; 2]| move |_: GridInput| marks(range);
        let plot = Plot::new(("plot", unit.name()))
            .height(height)
            .allow_drag(false)
            .allow_zoom(false)
            .allow_scroll(false)
            .allow_boxed_zoom(false)
            .allow_double_click_reset(false)
            .allow_axis_zoom_drag(false)
            .sense(Sense::hover())
            .show_crosshair(false)
            .set_margin_fraction(egui::Vec2::ZERO)
            .y_axis_min_width(44.0)
            .grid_color(color(theme.line))
            .x_grid_spacer(fixed([-span_s, 0.0]))
            .y_grid_spacer(fixed([low, high]))
            // The ends have no space for labels.
            .x_axis_formatter(move |mark, _| match mark.value {
                at if at == 0.0 || at <= -span_s => String::new(),
                at => format!("{at:.0} s"),
            })
            .y_axis_formatter(move |mark, range| {
                let digits = if (range.end() - range.start()) < 5.0 { 2 } else { 0 };
                format!("{:.digits$}", mark.value)
            })
            .label_formatter(move |hover| match hover {
                HoverPosition::NearDataPoint { plot_name, position, .. } => {
                    Some(format!("{plot_name}\n{}, {:.2} s ago", unit.figure(position.y), -position.x))
                }
                HoverPosition::Elsewhere { .. } => None,
            });
        let drawn = plot.show(ui, |plot| {
            plot.set_plot_bounds_x(-span_s..=0.0);
            plot.set_plot_bounds_y(under..=over);
            for (_, force) in thresholds.iter().flat_map(|(_, lines, _)| lines) {
                let line = HLine::new("", f64::from(force.0)).color(color(theme.accent)).width(1.5);
                plot.hline(line.style(LineStyle::dashed_dense()).allow_hover(false));
            }
            for trace in traces {
                // One line on each side of a gap.
                for points in trace.points.split(|point| !point[1].is_finite()).filter(|it| !it.is_empty()) {
                    let points = PlotPoints::from(points.to_vec());
                    plot.line(Line::new(trace.name.as_str(), points).color(trace.colour).width(1.6));
                }
            }
        });
        drawn.response.widget_info(|| {
            WidgetInfo::labeled(
                egui::accesskit::Role::Figure,
                true,
                format!("Plot in {}: {spoken}", unit.name()),
            )
        });
        let frame = *drawn.transform.frame();
        let unit_at = frame.left_top() + egui::vec2(6.0, 4.0);
        let font = FontId::proportional(11.5);
        ui.painter().text(unit_at, Align2::LEFT_TOP, unit.name(), font.clone(), color(theme.quiet));
        let (id, lines, can_set) = thresholds?;
        let mut done = None;
        for (which, force) in lines {
            let y = drawn.transform.position_from_point(&PlotPoint::new(0.0, f64::from(force.0))).y;
            let grip = Grip { id, which, force, can_set };
            let force_at = |y: f32| {
                let at = drawn.transform.value_from_position(pos2(frame.center().x, y)).y;
                Newtons((at as f32).round().min(high as f32).clamp(which.least(), 1000.0))
            };
            done = grip.show(ui, theme, frame, y, force_at).or(done);
        }
        done
    }
}

/// The handle of a threshold.
struct Grip<'a> {
    id: &'a WidgetId,
    which: Threshold,
    force: Newtons,
    can_set: bool,
}

impl Grip<'_> {
    fn show(
        self,
        ui: &Ui,
        theme: &Theme,
        frame: Rect,
        y: f32,
        force_at: impl Fn(f32) -> Newtons,
    ) -> Option<ThresholdDrag> {
        let Self { id, which, force, can_set } = self;
        let area = Rect::from_x_y_ranges(frame.x_range(), (y - 0.5 * GRIP)..=(y + 0.5 * GRIP));
        let sense = if can_set { Sense::drag() } else { Sense::hover() };
        let node = ui.interact(area.intersect(frame), ui.scope_id().with(("threshold", which)), sense);
        let what = match which {
            Threshold::Press => "takes",
            Threshold::Release => "lets go",
        };
        node.widget_info(|| WidgetInfo::slider(can_set, f64::from(force.0), format!("{id} {what}")));
        let is_held = node.dragged() || node.has_focus();
        let ink = color(if is_held || node.hovered() { theme.ink } else { theme.accent });
        let text = format!("{what} {:.0} N", force.0);
        // Side by side, so that the labels of two close lines stay legible.
        let off = match which {
            Threshold::Press => 6.0,
            Threshold::Release => 96.0,
        };
        let painter = ui.painter().with_clip_rect(frame);
        let at = pos2(frame.right() - off, (y - 1.0).max(frame.top() + 15.0));
        painter.text(at, Align2::RIGHT_BOTTOM, text, FontId::proportional(12.0), ink);
        if is_held {
            painter.hline(frame.x_range(), y, egui::Stroke::new(2.0, ink));
        }
        let pointer = node.interact_pointer_pos();
        if can_set && (node.hovered() || node.dragged()) {
            ui.ctx().set_cursor_icon(CursorIcon::ResizeVertical);
        }
        if let Some(pointer) = pointer.filter(|_| node.dragged()) {
            return Some(ThresholdDrag::To(which, force_at(pointer.y)));
        }
        if node.drag_stopped() {
            return Some(ThresholdDrag::Done(which, force));
        }
        if !node.has_focus() {
            return None;
        }
        let filter = EventFilter { vertical_arrows: true, ..EventFilter::default() };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(node.id, filter));
        let by = if ui.input(|i| i.modifiers.shift) { 10.0 * KEY_N } else { KEY_N };
        let pressed = |key| if ui.input(|i| i.key_pressed(key)) { by } else { 0.0 };
        let by = pressed(Key::ArrowUp) - pressed(Key::ArrowDown);
        (by != 0.0).then(|| ThresholdDrag::Done(which, Newtons((force.0 + by).clamp(which.least(), 1000.0))))
    }
}

/// The text for a screen reader: the name of a line and its latest figure.
fn told(trace: &PlotLine, unit: Unit) -> String {
    match trace.points.last() {
        Some([_, figure]) if figure.is_finite() => format!("{} {}", trace.name, unit.figure(*figure)),
        _ => format!("{}, nothing", trace.name),
    }
}

/// The limits of the axis: in steps, so that they do not move with every figure.
fn bounds(unit: Unit, figures: impl Iterator<Item = f64>, lines: impl Iterator<Item = f64>) -> (f64, f64) {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    let lines = lines.map(|line| 1.2 * line);
    for figure in figures.chain(lines).filter(|figure| figure.is_finite()) {
        (low, high) = (low.min(figure), high.max(figure));
    }
    match unit {
        // The noise of an empty floor goes a little below zero.
        Unit::Newtons => (if low < -20.0 { -stepped(-low) } else { 0.0 }, stepped(high.max(20.0))),
        Unit::Metres => (0.0, stepped(high.max(0.5))),
        Unit::Value if low < 0.0 => (-stepped(-low), stepped(high.max(-0.1 * low))),
        Unit::Value => (0.0, stepped(high.max(1.0))),
    }
}

/// The lowest of `steps` times a power of ten that is at least `value`, which is positive.
fn next_of(steps: &[f64], value: f64) -> f64 {
    if !value.is_finite() || value <= 0.0 {
        return 1.0;
    }
    let power = 10.0_f64.powf(value.log10().floor());
    steps.iter().map(|step| step * power).find(|step| *step >= value).unwrap_or(10.0 * power)
}

/// The next round figure for an end of the axis.
fn stepped(value: f64) -> f64 {
    next_of(&[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0], value)
}

/// Four or five grid lines at round figures.
fn marks([low, high]: [f64; 2]) -> Vec<GridMark> {
    let step = next_of(&[1.0, 2.0, 5.0], (high - low) / 5.0);
    let first = (low / step).ceil() as i64;
    let last = (high / step).floor() as i64;
    (first..=last).map(|mark| GridMark { value: mark as f64 * step, step_size: step }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_go_by_steps_so_that_they_stand_still() {
        let of = |unit, figures: &[f64], lines: &[f64]| {
            bounds(unit, figures.iter().copied(), lines.iter().copied())
        };
        assert_eq!(of(Unit::Newtons, &[-0.7, 4.0], &[60.0, 40.0]), (0.0, 80.0));
        assert_eq!(of(Unit::Newtons, &[-0.7, 73.0, f64::NAN], &[60.0]), (0.0, 80.0));
        assert_eq!(of(Unit::Newtons, &[], &[]), (0.0, 20.0));
        assert_eq!(of(Unit::Newtons, &[310.0], &[]), (0.0, 400.0));
        assert_eq!(of(Unit::Value, &[-10.0, 3.0], &[]), (-10.0, 3.0));
        assert_eq!(of(Unit::Metres, &[1.2], &[]), (0.0, 1.5));
        let lines: Vec<f64> = marks([0.0, 100.0]).iter().map(|mark| mark.value).collect();
        assert_eq!(lines, [0.0, 20.0, 40.0, 60.0, 80.0, 100.0]);
    }
}
