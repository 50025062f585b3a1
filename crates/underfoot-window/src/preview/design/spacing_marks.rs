//! Marks of a gesture: gaps to the neighbours, and the floor's edge where it stops the pointer.

use eframe::egui::{self, Rect, Stroke};

use super::trial::GestureResult;
use crate::edit::NeighbourGap;
use crate::preview::labels::Labels;
use underfoot::floor;
use underfoot_scene::egui_painter::{ScreenFromFloor, color};
use underfoot_scene::scene::Theme;

/// Half the length of the line across the end of a gap, in points.
const END: f32 = 4.0;

/// Draws the gaps, equal ones in another colour, and the edges of the floor that stop the gesture; `notes` has a place
/// for each text.
pub(super) fn spacing_marks(
    painter: &egui::Painter,
    map: ScreenFromFloor,
    theme: &Theme,
    floor: floor::Rect,
    trial: &GestureResult,
    notes: &mut Labels,
) {
    for gap in &trial.gaps {
        draw_gap(painter, map, theme, gap, notes);
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
        notes.note(painter, map.rect(*area), "stops at the floor's edge", colour, theme);
    }
}

fn draw_gap(
    painter: &egui::Painter,
    map: ScreenFromFloor,
    theme: &Theme,
    gap: &NeighbourGap,
    notes: &mut Labels,
) {
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
    notes.note(painter, Rect::from_two_pos(from, to), &text, colour, theme);
}
