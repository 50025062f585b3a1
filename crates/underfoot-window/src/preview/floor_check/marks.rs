//! Marks on the floor during a check: a plate for each tile, over the controls.

use eframe::egui::accesskit::Role;
use eframe::egui::{Align2, FontId, Pos2, Rect, Sense, Stroke, StrokeKind, Ui, WidgetInfo, vec2};

use super::{FloorCheck, TileMark, Walk};
use underfoot::floor::Floor;
use underfoot::serve::SensorVerdict;
use underfoot_scene::egui_painter::{ScreenFromFloor, color};
use underfoot_scene::scene::Theme;

impl FloorCheck {
    /// Covers the floor with the state of its tiles, during a check.
    pub(in crate::preview) fn show_marks(
        &self,
        ui: &Ui,
        rect: Rect,
        map: ScreenFromFloor,
        theme: &Theme,
        floor: &Floor,
    ) {
        if !self.is_running() {
            return;
        }
        let painter = ui.painter_at(rect);
        let geometry = &floor.geometry;
        // The controls are off, and remain faintly visible.
        let veil = color(theme.canvas).gamma_multiply(0.72);
        painter.rect_filled(map.rect(geometry.bounds()), 0.0, veil);
        for index in 0..geometry.tile_count() {
            let tile = geometry.tile_at_index(index);
            if geometry.is_missing(tile) {
                continue;
            }
            let area = map.rect(geometry.plate(tile)).shrink(2.0);
            let mark = self.mark(floor, index);
            let (ink, weight, edge) = match mark {
                TileMark::Open => (theme.quiet, 0.10, 1.0),
                TileMark::Begun => (theme.good, 0.12, 1.0),
                TileMark::Good => (theme.good, 0.42, 1.5),
                TileMark::Bad => (theme.fault, 0.42, 2.0),
                TileMark::Wanted => (theme.accent, 0.30, 4.0),
                TileMark::Felt => (theme.warning, 0.30, 2.0),
            };
            painter.rect_filled(area, 4.0, color(ink).gamma_multiply(weight));
            painter.rect_stroke(area, 4.0, Stroke::new(edge, color(ink)), StrokeKind::Inside);
            // Symbols tell the states apart without colour.
            let (half, stroke) = (0.13 * area.width(), Stroke::new(3.0, color(theme.ink)));
            let middle = area.center();
            match mark {
                TileMark::Good => {
                    let tick = [vec2(-half, 0.0), vec2(-0.3 * half, 0.7 * half), vec2(half, -0.7 * half)];
                    painter.line(tick.map(|way| middle + way).to_vec(), stroke);
                }
                TileMark::Bad => {
                    for side in [1.0, -1.0] {
                        let way = 0.8 * vec2(half, side * half);
                        painter.line_segment([middle - way, middle + way], stroke);
                    }
                }
                TileMark::Wanted => {
                    let font = FontId::proportional((0.2 * area.width()).clamp(9.0, 19.0));
                    painter.text(middle, Align2::CENTER_CENTER, "Step\nhere", font, color(theme.ink));
                }
                TileMark::Open | TileMark::Begun | TileMark::Felt => {
                    let font = FontId::proportional((0.12 * area.width()).clamp(8.0, 13.0));
                    let place = format!("{}, {}", tile.column, tile.row);
                    painter.text(middle, Align2::CENTER_CENTER, place, font, color(theme.quiet));
                }
            }
            if let Some(Walk::Test(walk)) = &self.walk
                && let Some(sensors) = walk.tile(index)
            {
                let at = |corner| {
                    let share = geometry.share_of_plate(tile, corner);
                    area.lerp_inside(vec2(share.x, 1.0 - share.y))
                };
                let of = geometry.sensors(tile).iter().map(|&corner| (at(corner), sensors[corner.index()]));
                show_sensors(&painter, theme, 0.05 * area.width(), of);
            }
            let node = ui.interact(area, ui.scope_id().with(("checked tile", index)), Sense::hover());
            node.widget_info(|| {
                WidgetInfo::labeled(Role::Label, true, format!("Tile {tile}: {}", mark.words()))
            });
        }
    }
}

/// Draws a dot at each sensor: grey, green, or a red square.
fn show_sensors(
    painter: &eframe::egui::Painter,
    theme: &Theme,
    radius: f32,
    sensors: impl Iterator<Item = (Pos2, SensorVerdict)>,
) {
    let radius = radius.clamp(2.0, 6.0);
    for (at, verdict) in sensors {
        match verdict {
            SensorVerdict::Untried => {
                painter.circle_stroke(at, radius, Stroke::new(1.5, color(theme.quiet)));
            }
            SensorVerdict::Answers => {
                painter.circle_filled(at, radius, color(theme.good));
            }
            SensorVerdict::NoReading | SensorVerdict::Still | SensorVerdict::Weak => {
                let square = Rect::from_center_size(at, vec2(2.4, 2.4) * radius);
                painter.rect_filled(square, 1.0, color(theme.fault));
            }
        }
    }
}
