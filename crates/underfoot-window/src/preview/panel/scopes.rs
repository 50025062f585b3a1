//! The side panel's waveforms.

use eframe::egui::accesskit::Role;
use eframe::egui::epaint::PathShape;
use eframe::egui::{Align2, CornerRadius, FontId, Rect, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

use super::super::scopes::peak;
use super::super::shown::ShownFloor;
use super::super::style::{quiet, section};
use underfoot::floor::Floor;
use underfoot::floor::TileId;
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Height of one scope, in points.
const HEIGHT: f32 = 36.0;

/// Sample at the scope's edge, in full scales: built-in clicks reach a third.
const RANGE: f32 = 0.5;

/// Peak below which a wave is drawn as a straight line, in full scales: a tenth of a pixel.
const STILL: f32 = 3e-3;

/// Waveforms of the actuators under the feet.
pub(super) fn scopes_part(ui: &mut Ui, theme: &Theme, shown: &mut ShownFloor) {
    let ShownFloor { scopes, floor, .. } = shown;
    if !scopes.is_fed() {
        return;
    }
    section(ui, theme, "Actuators", |ui| {
        ui.label(quiet(theme, "last 100 ms").size(12.0));
    });
    scopes.for_each(floor, |tile, wave| scope(ui, theme, floor, tile, wave));
}

fn scope(ui: &mut Ui, theme: &Theme, floor: &Floor, tile: Option<TileId>, wave: &[(f32, f32)]) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
    let painter = ui.painter_at(rect);
    let words = Rect::from_min_max(rect.min, pos2(rect.left() + 62.0, rect.bottom()));
    let screen = Rect::from_min_max(pos2(words.right(), rect.top()), rect.max);
    painter.rect_filled(screen, CornerRadius::same(4), color(theme.plate));
    let middle = screen.center().y;
    painter.hline(screen.x_range().shrink(4.0), middle, Stroke::new(1.0, color(theme.line)));
    let full_scale = tile
        .and_then(|tile| floor.geometry.index(tile))
        .and_then(|index| floor.actuators.get(index).copied().flatten())
        .map(|actuator| actuator.full_scale.0);
    let name = tile.map_or_else(|| "–".to_owned(), |tile| format!("{}, {}", tile.column, tile.row));
    let force = match full_scale {
        Some(full_scale) if !wave.is_empty() => format!("{:.1} N", full_scale * peak(wave)),
        Some(_) => "no signal".into(),
        None if tile.is_some() => "none".into(),
        None => String::new(),
    };
    response
        .widget_info(|| WidgetInfo::labeled(Role::Label, true, format!("Actuator of tile {name}: {force}")));
    let font = FontId::proportional(12.5);
    painter.text(words.min + vec2(0.0, 5.0), Align2::LEFT_TOP, name, font, color(theme.ink));
    painter.text(
        words.min + vec2(0.0, 20.0),
        Align2::LEFT_TOP,
        force,
        FontId::proportional(11.5),
        color(theme.quiet),
    );
    // A signal at rest is the middle line.
    if wave.len() < 2 || peak(wave) < STILL {
        let ink = Stroke::new(1.2, color(if wave.is_empty() { theme.line } else { theme.haptic }));
        painter.hline(screen.x_range().shrink(4.0), middle, ink);
        return;
    }
    let inner = screen.shrink2(vec2(4.0, 3.0));
    let at = |index: usize, sample: f32| {
        let x = inner.left() + inner.width() * index as f32 / (wave.len() - 1) as f32;
        let sample = if sample.is_finite() { (sample / RANGE).clamp(-1.0, 1.0) } else { 0.0 };
        pos2(x, middle - 0.5 * inner.height() * sample)
    };
    // Draw each part between its lowest and highest sample, alternating upwards and downwards: one line that fills
    // the area of fast signals.
    let points = wave
        .iter()
        .enumerate()
        .flat_map(|(index, (low, high))| {
            let (first, second) = if index % 2 == 0 { (*low, *high) } else { (*high, *low) };
            [at(index, first), at(index, second)]
        })
        .collect();
    painter.add(PathShape::line(points, Stroke::new(1.2, color(theme.haptic))));
}
