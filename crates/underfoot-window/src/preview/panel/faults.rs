//! The side panel's faults: simulates the faults of a real floor.

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{CollapsingHeader, DragValue, RichText, Ui, WidgetInfo};

use super::super::rehearsal::{PacketFaults, Rehearsal};
use super::super::style::quiet;
use super::tile::rows_of_sensors;
use underfoot::floor::{Geometry, SensorId, TileId};
use underfoot::units::Newtons;
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;
use underfoot_sim::SensorFault;

/// Force on a sensor beside its plate, as under a jammed plate: that of a light foot.
const PINCHED: Newtons = Newtons(60.0);

/// The faults of one sensor.
const SENSOR_FAULTS: [(Option<SensorFault>, &str); 5] = [
    (None, "works"),
    (Some(SensorFault::Stuck), "stuck"),
    (Some(SensorFault::Open), "torn off"),
    (Some(SensorFault::Short), "shorted"),
    (Some(SensorFault::Offset(PINCHED)), "pinched"),
];

/// Shows the switches for faults of packets and of the sensors of `tile`.
pub(super) fn faults_part(
    ui: &mut Ui,
    theme: &Theme,
    rehearsal: &mut Rehearsal,
    geometry: &Geometry,
    tile: TileId,
) {
    ui.add_space(2.0);
    let title = match rehearsal.count() {
        0 => RichText::new("Rehearse faults").color(color(theme.ink)),
        1 => RichText::new("Rehearse faults: 1 on").color(color(theme.warning)),
        count => RichText::new(format!("Rehearse faults: {count} on")).color(color(theme.warning)),
    };
    CollapsingHeader::new(title).id_salt("faults").show_unindented(ui, |ui| {
        packets(ui, theme, rehearsal);
        sensors(ui, theme, rehearsal, geometry, tile);
        let some = rehearsal.count() > 0;
        if ui.add_enabled(some, egui::Button::new("Mend everything")).clicked() {
            rehearsal.mend();
        }
    });
}

fn packets(ui: &mut Ui, theme: &Theme, rehearsal: &mut Rehearsal) {
    let mut chosen = rehearsal.packets.clone();
    let PacketFaults { lost_percent, damaged_percent, late_ms, silent, unplugged } = &mut chosen;
    for (name, value, most, unit) in [
        ("Packets lost", lost_percent, 100.0, " %"),
        ("Packets damaged", damaged_percent, 100.0, " %"),
        ("Half late by up to", late_ms, 500.0, " ms"),
    ] {
        ui.horizontal(|ui| {
            ui.set_min_height(22.0);
            ui.label(quiet(theme, name));
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let field = DragValue::new(value).range(0.0..=most).speed(0.2).suffix(unit).max_decimals(1);
                let field = ui.add_sized([72.0, 20.0], field);
                field.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, name));
            });
        });
    }
    ui.checkbox(silent, "Nothing arrives");
    ui.label(quiet(theme, "Boards unplugged"));
    ui.horizontal_wrapped(|ui| {
        for board in 0..rehearsal.boards {
            let was = unplugged.contains(&board);
            let button = egui::Button::selectable(was, board.to_string()).frame_when_inactive(true);
            let button = ui.add(button);
            button.widget_info(|| {
                WidgetInfo::selected(Role::CheckBox, true, was, format!("Board {board} unplugged"))
            });
            if button.clicked() && !unplugged.remove(&board) {
                unplugged.insert(board);
            }
        }
    });
    if chosen != rehearsal.packets {
        rehearsal.packets = chosen;
        rehearsal.apply();
    }
}

fn sensors(ui: &mut Ui, theme: &Theme, rehearsal: &mut Rehearsal, geometry: &Geometry, tile: TileId) {
    ui.label(quiet(theme, format!("Sensors of tile {}, {}", tile.column, tile.row)));
    egui::Grid::new("broken sensors").num_columns(2).show(ui, |ui| {
        for row in rows_of_sensors(geometry, tile) {
            for corner in row {
                sensor(ui, rehearsal, SensorId { tile, corner }, geometry.sensor_name(corner));
            }
            ui.end_row();
        }
    });
}

fn sensor(ui: &mut Ui, rehearsal: &mut Rehearsal, sensor: SensorId, corner: &str) {
    let is = rehearsal.of_sensor(sensor);
    let name = |fault| SENSOR_FAULTS.iter().find(|(one, _)| *one == fault).map_or("broken", |(_, name)| name);
    let menu = egui::ComboBox::from_id_salt(("sensor", sensor))
        .selected_text(format!("{} {}", corner.to_uppercase(), name(is)))
        .width(122.0);
    let response = menu.show_ui(ui, |ui| {
        for (fault, name) in SENSOR_FAULTS {
            if ui.selectable_label(fault == is, name).clicked() {
                rehearsal.set_sensor(sensor, fault);
            }
        }
    });
    let spoken = format!("Sensor {corner} of the tile");
    response.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, &spoken));
    response.response.on_hover_text(spoken);
}
