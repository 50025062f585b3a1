//! Marks of a gesture: gaps to the neighbours, and the floor's edge where it stops the pointer.

use eframe::egui::{self, Align2, Stroke, vec2};

use super::trial::GestureResult;
use crate::edit::NeighbourGap;
use crate::preview::labels::label;
use underfoot::floor::Rect;
use underfoot_scene::egui_painter::{ScreenFromFloor, color};
use underfoot_scene::scene::Theme;

/// Half the length of the line across the end of a gap, in points.
const END: f32 = 4.0;

/// Draws the gaps, equal ones in another colour, and the edges of the floor that stop the gesture.
pub(super) fn spacing_marks(
    painter: &egui::Painter,
    map: ScreenFromFloor,
    theme: &Theme,
    floor: Rect,
    trial: &GestureResult,
) {
    for gap in &trial.gaps {
        draw_gap(painter, map, theme, gap);
    }
    let shown = map.rect(floor);
    let stopped = trial.stopped;
    let sides = [
        (stopped.west, [shown.left_top(), shown.left_bottom()]),
        (stopped.east, [shown.right_top(), shown.right_bottom()]),
        (stopped.south, [shown.left_bottom(), shown.right_bottom()]),
        (stopped.north, [shown.left_top(), shown.right_top()]),
    ];
    let colour = color(theme.warning);
    for (_, line) in sides.iter().filter(|(is_stopped, _)| *is_stopped) {
        painter.line_segment(*line, Stroke::new(3.0, colour));
    }
    if let Some(area) = trial.areas.first().filter(|_| stopped.is_any()) {
        let at = map.rect(*area).center() - vec2(64.0, 8.0);
        label(painter, at, "stops at the floor's edge", colour, theme);
    }
}

fn draw_gap(painter: &egui::Painter, map: ScreenFromFloor, theme: &Theme, gap: &NeighbourGap) {
    let (from, to) = (map.point(gap.from), map.point(gap.to));
    if from.distance(to) < 2.0 {
        return;
    }
    let colour = color(if gap.is_equal { theme.good } else { theme.accent });
    let stroke = Stroke::new(if gap.is_equal { 2.5 } else { 1.0 }, colour);
    painter.line_segment([from, to], stroke);
    let across = (to - from).normalized().rot90() * END;
    for end in [from, to] {
        painter.line_segment([end - across, end + across], stroke);
    }
    let centimetres = gap.length_m() * 100.0;
    let text = if gap.is_equal { format!("= {centimetres:.1} cm") } else { format!("{centimetres:.1} cm") };
    // Above a level line, beside an upright one.
    let is_level = (to.y - from.y).abs() < (to.x - from.x).abs();
    let anchor = if is_level { Align2::CENTER_BOTTOM } else { Align2::LEFT_CENTER };
    let size = vec2(6.0 * text.len() as f32 + 8.0, 16.0);
    let at = anchor.anchor_size(from.lerp(to, 0.5) + vec2(4.0, -3.0), size).min;
    label(painter, at, &text, colour, theme);
}
