//! The side panel's list of controls: values set, controls switched off.

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{CollapsingHeader, DragValue, RichText, Ui, WidgetInfo};

use super::super::feed::PreviewCommand;
use super::super::off_hint::why_off;
use super::super::shown::ShownFloor;
use super::super::style::quiet;
use underfoot::widget::{Behaviour, Value};
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Offers the requests of an app for each control: set its value, disable it.
pub(super) fn controls_part(ui: &mut Ui, theme: &Theme, shown: &ShownFloor) {
    ui.add_space(6.0);
    let mut commands = Vec::new();
    let header = CollapsingHeader::new("Controls, as an app sets them").id_salt("controls");
    header.show_unindented(ui, |ui| {
        let snapshot = shown.snapshot();
        for (index, widget) in shown.layout().widgets.iter().enumerate() {
            let Some(state) = snapshot.widgets.get(index) else { break };
            let id = &widget.id;
            ui.horizontal(|ui| {
                let mut works = !state.disabled;
                let tick = ui.checkbox(&mut works, id.as_str());
                tick.widget_info(|| WidgetInfo::selected(Role::CheckBox, true, works, format!("{id} works")));
                if tick.on_hover_text("Whether it works").changed() {
                    commands.push(PreviewCommand::Enable { id: id.clone(), enabled: works });
                }
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                    match (widget.behaviour.scale(), state.value) {
                        (Some(scale), Some(Value::Number(value))) => {
                            let mut wanted = value;
                            let speed = 0.005 * (scale.range());
                            let range = scale.min..=scale.max;
                            let drag = ui.add(DragValue::new(&mut wanted).range(range).speed(speed));
                            drag.widget_info(|| {
                                WidgetInfo::slider(true, f64::from(value), format!("{id} value"))
                            });
                            if drag.changed() && wanted != value {
                                let value = Value::Number(wanted);
                                commands.push(PreviewCommand::Set { id: id.clone(), value });
                            }
                        }
                        _ if matches!(widget.behaviour, Behaviour::Switch(_)) => {
                            let on = state.value == Some(Value::Switch(true));
                            let mut wanted = on;
                            let tick = ui.checkbox(&mut wanted, if on { "on" } else { "off" });
                            tick.widget_info(|| {
                                WidgetInfo::selected(Role::CheckBox, true, on, format!("{id} value"))
                            });
                            if tick.changed() {
                                let value = Value::Switch(wanted);
                                commands.push(PreviewCommand::Set { id: id.clone(), value });
                            }
                        }
                        _ => {
                            let text = if state.pressed { "pressed" } else { "" };
                            ui.label(quiet(theme, text));
                        }
                    }
                });
            });
            // The check box already shows that an app has disabled it.
            if let Some(why) = why_off(snapshot, index).filter(|_| !state.disabled) {
                ui.label(RichText::new(why).color(color(theme.warning)).small());
            }
        }
    });
    for command in commands {
        shown.command(command);
    }
}
