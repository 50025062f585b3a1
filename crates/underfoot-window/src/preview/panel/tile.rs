//! The side panel's tile: its four sensors, its mute.

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{Align2, CornerRadius, FontId, Rect, Sense, Ui, WidgetInfo, pos2, vec2};

use super::super::feed::PreviewCommand;
use super::super::handheld::is_for_fingers;
use super::super::plots::{Plots, Series};
use super::super::selection::Selection;
use super::super::shown::ShownFloor;
use super::super::style::{panel_colour, plot_button, quiet, section, small_button};
use underfoot::engine::TileState;
use underfoot::floor::{Corner, Floor, Geometry, TileId};
use underfoot::layout::Colour;
use underfoot::sense::Quality;
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Force of a full bar: the end of the nominal sensor's range, in newtons.
const FULL: f32 = 400.0;

/// Shows the sensors of the selected tile, those of its corners in their places.
pub(super) fn tile_part(
    ui: &mut Ui,
    theme: &Theme,
    shown: &ShownFloor,
    selection: &mut Selection,
    plots: &mut Plots,
) {
    let tile = selection.tile();
    let pinned = selection.pinned().is_some();
    let muted = shown.snapshot().muted.tiles.contains(&tile);
    let is_moved = shown.scopes.is_fed() && is_moved(&shown.floor, tile);
    let (mut unpin, mut mute, mut plot) = (false, false, false);
    section(ui, theme, &format!("Tile {}, {}", tile.column, tile.row), |ui| {
        if pinned {
            unpin = small_button(ui, "Follow the foot").clicked();
        } else {
            let label = ui.label(quiet(theme, "underfoot").size(12.0));
            label.on_hover_text("The tile under the foot that presses most; Shift-click pins another");
        }
        if is_moved {
            let button = egui::Button::selectable(muted, "Mute tile").frame_when_inactive(true);
            let button = if is_for_fingers(ui) { button } else { button.small() };
            let hint = "Let this tile's actuator not be felt";
            mute = ui.add(button).on_hover_text(hint).clicked();
        }
        plot = plot_button(ui, &format!("tile {}, {}", tile.column, tile.row));
    });
    if plot {
        plots.add([Series::Tile(tile)]);
    }
    if mute {
        shown.command(PreviewCommand::MuteTile { tile, on: !muted });
    }
    if unpin {
        selection.unpin();
    }
    let state = shown
        .floor
        .geometry
        .index(tile)
        .and_then(|index| shown.snapshot().tiles.get(index).copied())
        .unwrap_or_default();
    let cell = vec2(0.5 * (ui.available_width() - 14.0), 38.0);
    let geometry = &shown.floor.geometry;
    if geometry.is_missing(tile) {
        ui.label(quiet(theme, "a hole in the floor"));
        return;
    }
    for row in rows_of_sensors(geometry, tile) {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 14.0;
            for corner in row {
                sensor(ui, theme, cell, (corner, geometry.sensor_name(corner)), &state);
            }
        });
    }
    let place = state.centroid.map_or_else(
        || "too light to say where".to_owned(),
        |at| format!("acts at {:.3}, {:.3} m", at.x, at.y),
    );
    let age = match state.age.as_millis() {
        0 => String::new(),
        ms => format!(", {ms} ms ago"),
    };
    ui.label(quiet(theme, format!("{:.1} N in all, {place}{age}", clean(state.force.0))));
}

/// Whether an actuator moves this tile.
fn is_moved(floor: &Floor, tile: TileId) -> bool {
    let index = floor.geometry.index(tile);
    index.and_then(|index| floor.actuators.get(index)).is_some_and(Option::is_some)
}

/// The sensors of `tile` in two rows: the northern corners above the southern ones, or numbered sensors in their order.
pub(super) fn rows_of_sensors(geometry: &Geometry, tile: TileId) -> [Vec<Corner>; 2] {
    let (first, second) = geometry.sensors(tile).split_at(geometry.sensors(tile).len().min(2));
    let rows = [first.to_vec(), second.to_vec()];
    if geometry.has_corners() { [rows[1].clone(), rows[0].clone()] } else { rows }
}

/// Shows one sensor: its name, newtons, a bar, and a word if it is unreliable.
fn sensor(ui: &mut Ui, theme: &Theme, size: egui::Vec2, (corner, name): (Corner, &str), state: &TileState) {
    let (force, quality) = (state.forces[corner.index()], state.quality[corner.index()]);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    let word = word(quality, theme);
    let spoken =
        format!("{name} {:.1} newtons{}", force, word.map_or(String::new(), |(word, _)| format!(", {word}")));
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
    let painter = ui.painter();
    let line = rect.top() + 11.0;
    let small = FontId::proportional(12.0);
    painter.text(
        pos2(rect.left(), line),
        Align2::LEFT_CENTER,
        name.to_uppercase(),
        small.clone(),
        color(theme.quiet),
    );
    if let Some((word, colour)) = word {
        painter.text(pos2(rect.left() + 26.0, line), Align2::LEFT_CENTER, word, small, color(colour));
    }
    let newtons = format!("{:.1} N", clean(force));
    let ink = if quality >= Quality::Stale { theme.quiet } else { theme.ink };
    painter.text(
        pos2(rect.right(), line),
        Align2::RIGHT_CENTER,
        newtons,
        FontId::proportional(13.5),
        color(ink),
    );
    let bar = Rect::from_min_size(pos2(rect.left(), rect.top() + 23.0), vec2(rect.width(), 6.0));
    painter.rect_filled(bar, CornerRadius::same(3), color(panel_colour(theme).mix(theme.ink, 0.09)));
    // The square root, as for the dots on the floor, shows light touches too.
    let share = (force / FULL).clamp(0.0, 1.0).sqrt();
    if share > 0.0 {
        let filled = Rect::from_min_size(bar.min, vec2((share * bar.width()).max(6.0), bar.height()));
        let colour = word.map_or(theme.contact, |(_, colour)| colour);
        painter.rect_filled(filled, CornerRadius::same(3), color(colour));
    }
}

/// Removes the minus sign of a figure that rounds to zero.
fn clean(force: f32) -> f32 {
    if force.abs() < 0.05 { 0.0 } else { force }
}

/// The word for an unreliable sensor.
fn word(quality: Quality, theme: &Theme) -> Option<(&'static str, Colour)> {
    match quality {
        Quality::Live => None,
        Quality::Degraded => Some(("degraded", theme.warning)),
        Quality::Stale => Some(("silent", theme.stale.mix(theme.ink, 0.3))),
        Quality::Faulty => Some(("faulty", theme.fault)),
    }
}
