//! The side panel's list of events.

use eframe::egui::accesskit::Role;
use eframe::egui::{ScrollArea, Sense, Ui, WidgetInfo, vec2};

use super::super::app::App;
use super::super::messages::Happened;
use super::super::style::{Row, quiet, section};
use crate::egui_painter::color;
use crate::scene::Theme;
use crate::units::Instant;
use crate::widget::{EventKind, Value, WidgetEvent};

/// Height of one line, in points.
const LINE: f32 = 18.0;

impl App {
    /// What happened, newest first, in `height` points with its heading.
    pub(super) fn events_part(&mut self, ui: &mut Ui, height: f32) {
        let theme = &self.theme;
        let top = ui.cursor().top();
        section(ui, theme, "Events", |ui| {
            ui.label(quiet(theme, format!("{} so far", self.messages.event_count)).size(12.0));
        });
        let left = height - (ui.cursor().top() - top) - 8.0;
        ui.spacing_mut().item_spacing.y = 0.0;
        let recent = &self.messages.recent;
        let area = ScrollArea::vertical().id_salt("events").max_height(left).min_scrolled_height(left);
        area.auto_shrink(false).show_rows(ui, LINE, recent.len().max(1), |ui, lines| {
            if recent.is_empty() {
                ui.label(quiet(theme, "nothing yet"));
            }
            for happened in lines.filter_map(|line| recent.get(line)) {
                match happened {
                    Happened::Event(event) => show(ui, theme, event),
                    Happened::GaveWay { material, count, at, .. } => {
                        gave_way(ui, theme, material, *count, *at);
                    }
                }
            }
        });
        ui.spacing_mut().item_spacing.y = 5.0;
    }
}

/// Ground that gave way, so many times.
fn gave_way(ui: &mut Ui, theme: &Theme, material: &str, count: u64, at: Instant) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width() - 8.0, LINE), Sense::hover());
    let spoken = format!("{material} gave way {count}");
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
    let line = Row { ui, rect, size: 12.5 };
    line.right(0.19, &format!("{:.3}", at.secs()), color(theme.quiet));
    line.left(0.23, 0.56, material, color(theme.ink));
    line.left(0.58, 0.82, "gave way", color(theme.haptic));
    line.right(1.0, &format!("{count} ×"), color(theme.ink));
}

fn show(ui: &mut Ui, theme: &Theme, event: &WidgetEvent) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width() - 8.0, LINE), Sense::hover());
    let value = value(event.kind);
    let spoken = format!("{} {} {value}", event.id, event.kind.name());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, spoken.trim_end()));
    let line = Row { ui, rect, size: 12.5 };
    line.right(0.19, &format!("{:.3}", event.at.secs()), color(theme.quiet));
    line.left(0.23, 0.56, event.id.as_str(), color(theme.ink));
    let colour = match event.kind {
        EventKind::Pressed | EventKind::HardPressed | EventKind::Armed => theme.accent,
        EventKind::Clicked
        | EventKind::DoubleTapped
        | EventKind::LongPressed
        | EventKind::Swiped(_)
        | EventKind::Changed(_) => theme.good,
        EventKind::Cancelled | EventKind::Warned | EventKind::Refused => theme.warning,
        EventKind::Released | EventKind::HardReleased | EventKind::Ticked | EventKind::Disarmed => {
            theme.quiet
        }
    };
    line.left(0.58, 0.82, event.kind.name(), color(colour));
    let force = if event.contact.is_some() { format!("{:.0} N", event.force.0) } else { String::new() };
    let end = if value.is_empty() { force } else { value };
    line.right(1.0, &end, color(theme.ink));
}

/// What a control changed to.
fn value(kind: EventKind) -> String {
    match kind {
        EventKind::Changed(Value::Switch(on)) => if on { "on" } else { "off" }.into(),
        EventKind::Changed(Value::Number(value)) => format!("{value:.3}"),
        EventKind::Changed(Value::Choice(choice)) => choice.to_string(),
        EventKind::Changed(Value::Pair(pair)) => format!("{:.2} {:.2}", pair.x, pair.y),
        EventKind::Swiped(direction) => direction.name().into(),
        _ => String::new(),
    }
}
