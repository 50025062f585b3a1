//! The side panel's list of events.

use std::collections::VecDeque;

use eframe::egui::accesskit::Role;
use eframe::egui::{Align2, ScrollArea, Sense, TextEdit, Ui, WidgetInfo, vec2};

use super::super::handheld::is_for_fingers;
use super::super::messages::{Happened, WindowMessages};
use super::super::near_misses::NearMiss;
use super::super::style::{TextRow, quiet, section};
use underfoot::engine::{Ignored, IgnoredPress};
use underfoot::messages::MessageNews;
use underfoot::outgoing::json::{event_line, ignored_line, sent_line};
use underfoot::units::Instant;
use underfoot::widget::{EventKind, Value, WidgetEvent};
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Height of one line, in points.
const LINE: f32 = 18.0;

/// Shows the events, newest first, in `height` points with its heading; `search` holds the text that its
/// lines must contain, empty for all.
pub(super) fn events_part(
    ui: &mut Ui,
    theme: &Theme,
    messages: &WindowMessages,
    search: &mut String,
    height: f32,
) {
    let top = ui.cursor().top();
    // As wide as the headings above, beside whose parts is a scroll bar.
    ui.scope(|ui| {
        ui.set_max_width(ui.available_width() - 12.0);
        section(ui, theme, "Events", |ui| {
            ui.label(quiet(theme, format!("{} so far", messages.event_count)).size(12.0));
        });
    });
    search_events(ui, messages, search);
    let left = height - (ui.cursor().top() - top) - 8.0;
    ui.spacing_mut().item_spacing.y = 0.0;
    let wanted = search.to_lowercase();
    let recent: Vec<&Happened> =
        messages.recent.iter().filter(|happened| is_wanted(happened, &wanted)).collect();
    let area = ScrollArea::vertical().id_salt("events").max_height(left).min_scrolled_height(left);
    area.auto_shrink(false).show_rows(ui, LINE, recent.len().max(1), |ui, lines| {
        if recent.is_empty() {
            ui.label(quiet(theme, if wanted.is_empty() { "nothing yet" } else { "nothing with that" }));
        }
        for happened in lines.filter_map(|line| recent.get(line)) {
            match happened {
                Happened::Event(event) => show(ui, theme, event),
                Happened::Sent(news) => show_sent(ui, theme, news),
                Happened::Ignored(press) => show_ignored(ui, theme, press),
                Happened::NearMiss(miss) => show_near_miss(ui, theme, miss),
                Happened::GroundEvent { material, count, at, .. } => {
                    gave_way(ui, theme, material, *count, *at);
                }
            }
        }
    });
    ui.spacing_mut().item_spacing.y = 5.0;
}

/// A search field for the list, and a button that copies the listed events.
fn search_events(ui: &mut Ui, messages: &WindowMessages, search: &mut String) {
    ui.horizontal(|ui| {
        let copy = if is_for_fingers(ui) { 96.0 } else { 70.0 };
        let room = (ui.available_width() - copy).max(60.0);
        let field = TextEdit::singleline(search).hint_text("Search").desired_width(room);
        let field = field.align(Align2::LEFT_CENTER);
        let field = ui.add(field);
        field.widget_info(|| WidgetInfo::labeled(Role::SearchInput, true, "Search events"));
        let copy = ui.button("Copy").on_hover_text("The listed events as JSON lines, oldest first");
        copy.widget_info(|| WidgetInfo::labeled(Role::Button, true, "Copy events"));
        if copy.clicked() {
            ui.ctx().copy_text(exported(&messages.recent, search));
        }
    });
}

/// Whether a line contains all words of `wanted`, which is in lower case: in its control, its event, the reason for
/// an ignored press, or its material.
fn is_wanted(happened: &Happened, wanted: &str) -> bool {
    if wanted.is_empty() {
        return true;
    }
    let words = match happened {
        Happened::Event(event) => format!("{} {} {}", event.id, event.kind.name(), value(event.kind)),
        Happened::Sent(news) => format!("{} sent {news}", news.order.control),
        Happened::Ignored(press) => format!("{} ignored: {}", press.id, press.why),
        Happened::NearMiss(miss) => format!("{} missed: {}", miss.id, miss.text),
        Happened::GroundEvent { material, .. } => format!("{material} gave way"),
    };
    wanted.split_whitespace().all(|word| words.to_lowercase().contains(word))
}

/// The listed events in the format of `--json`, oldest first; presses beside a control, which `--json` leaves out, have
/// a line `missed`.
fn exported(recent: &VecDeque<Happened>, wanted: &str) -> String {
    let wanted = wanted.to_lowercase();
    let listed = recent.iter().rev().filter(|happened| is_wanted(happened, &wanted));
    let lines = listed.filter_map(|happened| match happened {
        Happened::Event(event) => Some(event_line(event) + "\n"),
        Happened::Sent(news) => Some(sent_line(news) + "\n"),
        Happened::Ignored(press) => Some(ignored_line(press) + "\n"),
        Happened::NearMiss(miss) => {
            let (t_s, id, why) = (miss.at.secs(), miss.id.as_str(), &miss.text);
            let line = serde_json::json!({
                "t_s": t_s, "event": "missed", "id": id, "force_n": miss.force.0,
                "x_m": miss.place.x, "y_m": miss.place.y, "distance_m": miss.distance_m, "why": why,
            });
            Some(format!("{line}\n"))
        }
        Happened::GroundEvent { .. } => None,
    });
    lines.collect()
}

/// Shows an ignored press with its reason: the whole sentence on hover.
fn show_ignored(ui: &mut Ui, theme: &Theme, press: &IgnoredPress) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width() - 8.0, LINE), Sense::hover());
    let spoken = format!("{} ignored {:.0} N: {}", press.id, press.force.0, press.why);
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
    let line = TextRow { ui, rect, size: 12.5 };
    line.right(0.19, &format!("{:.3}", press.at.secs()), color(theme.quiet));
    line.left(0.23, 0.56, press.id.as_str(), color(theme.ink));
    line.left(0.58, 0.86, &in_short(press.why), color(theme.warning));
    line.right(1.0, &format!("{:.0} N", press.force.0), color(theme.ink));
    response.on_hover_text(spoken);
}

/// The reason for which a press was ignored, in a word or two that fit their column.
fn in_short(why: Ignored) -> String {
    let words = match why {
        Ignored::Off(_) => "it is off",
        Ignored::Step => "a step, a rest",
        Ignored::Object => "an object",
        Ignored::Stance => "stands there",
        Ignored::OutsideRegion => "from outside",
        Ignored::OtherFoot => "other foot",
        Ignored::SlidOn => "slid onto it",
        Ignored::NotSeenUnloaded => "was loaded",
        Ignored::Unbelieved => "bad forces",
        Ignored::Guard => "not settled",
        Ignored::TooLight => "too light",
        Ignored::TooShort => "too short",
        other => return other.to_string(),
    };
    words.to_owned()
}

/// Shows a message to another program: its target on the right, all of it on hover.
fn show_sent(ui: &mut Ui, theme: &Theme, news: &MessageNews) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width() - 8.0, LINE), Sense::hover());
    let spoken = format!("{} sends {news}", news.order.control);
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
    let line = TextRow { ui, rect, size: 12.5 };
    line.right(0.19, &format!("{:.3}", news.at.secs()), color(theme.quiet));
    line.left(0.23, 0.42, news.order.control.as_str(), color(theme.ink));
    line.left(0.44, 0.8, &news.order.act.to_string(), color(theme.haptic));
    line.right(1.0, news.target(), color(theme.quiet));
    response.on_hover_text(spoken);
}

/// Shows a press beside a control.
fn show_near_miss(ui: &mut Ui, theme: &Theme, miss: &NearMiss) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width() - 8.0, LINE), Sense::hover());
    let spoken = format!("{:.0} N, {}: no control there", miss.force.0, miss.text);
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
    let line = TextRow { ui, rect, size: 12.5 };
    line.right(0.19, &format!("{:.3}", miss.at.secs()), color(theme.quiet));
    line.left(0.23, 0.86, &miss.text, color(theme.warning));
    line.right(1.0, &format!("{:.0} N", miss.force.0), color(theme.ink));
    response.on_hover_text(spoken);
}

/// Shows ground events with their number.
fn gave_way(ui: &mut Ui, theme: &Theme, material: &str, count: u64, at: Instant) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width() - 8.0, LINE), Sense::hover());
    let spoken = format!("{material} gave way {count}");
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
    let line = TextRow { ui, rect, size: 12.5 };
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
    let line = TextRow { ui, rect, size: 12.5 };
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

/// The new value of a control.
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

#[cfg(test)]
mod tests {
    use super::*;
    use underfoot::sense::ContactId;
    use underfoot::units::Newtons;
    use underfoot::widget::WidgetId;

    fn listed() -> VecDeque<Happened> {
        let event = |at, id| Happened::Event(crate::preview::tests::event(at, id));
        let at = Instant::from_millis(150);
        let ground = Happened::GroundEvent { ground: 0, material: "Ice", count: 3, at };
        let (id, contact, why) = (WidgetId::new("zoom"), ContactId(4), Ignored::TooLight);
        let ignored = Happened::Ignored(IgnoredPress { at, id, contact, force: Newtons(24.0), why });
        [event(200, "zoom"), ground, ignored, event(100, "home")].into()
    }

    #[test]
    fn events_are_found_by_any_part_of_their_words() {
        let found = |wanted: &str| listed().iter().filter(|happened| is_wanted(happened, wanted)).count();
        assert_eq!(["", "zo", "pressed", "zoom pressed", "gave", "zoom gave"].map(found), [4, 2, 2, 1, 1, 0]);
        assert_eq!(["ignored", "light", "home light"].map(found), [1, 1, 0]);
    }

    #[test]
    fn the_list_is_copied_as_json_lines_in_the_order_of_time() {
        let lines = |wanted: &str| -> Vec<serde_json::Value> {
            exported(&listed(), wanted).lines().map(|line| serde_json::from_str(line).unwrap()).collect()
        };
        let ids: Vec<String> = lines("PRESSED")
            .iter()
            .map(|line| format!("{} {}", line["t_s"], line["id"].as_str().unwrap()))
            .collect();
        assert_eq!(ids, ["0.1 home", "0.2 zoom"]);
        let ignored = &lines("ignored")[0];
        assert_eq!((ignored["why"].as_str(), ignored["force_n"].as_f64()), (Some("too light"), Some(24.0)));
        // The names are those of other lines.
        let names = |line: &serde_json::Value| line.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
        let usual = names(&lines("home")[0]);
        for name in ["t_s", "event", "id", "contact", "force_n"] {
            assert!(usual.contains(&name.to_owned()), "{name} of {usual:?}");
        }
    }
}
