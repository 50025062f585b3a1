//! The list of the records on the floor: selects, locks and hides them by name.

use std::mem::take;

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{Sense, Ui, Vec2, WidgetInfo, vec2};

use super::edited::EditedLayout;
use super::in_place::InPlace;
use super::list_keys::go_on;
use super::menu::show_menu;
use super::{Pane, Panes};
use crate::edit::{Address, RecordList};
use crate::preview::handheld::{is_for_fingers, side, with_word};
use crate::preview::style::quiet;
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::{Theme, in_drawn_order};

/// Lists the records of the page on display, to be selected by name; each row has the menu that its record has on the
/// floor.
pub(super) fn list(
    ui: &mut Ui,
    theme: &Theme,
    edited: &mut EditedLayout,
    in_place: &mut Option<InPlace>,
    panes: &mut Panes,
) {
    if edited.layout().pages.len() > 1 {
        let names: Vec<String> = edited.layout().pages.iter().map(|page| page.id.to_string()).collect();
        for (number, name) in names.iter().enumerate() {
            if ui.selectable_label(edited.page == number, format!("Page {name}")).clicked() {
                edited.page = number;
                edited.selected = vec![Address::of(RecordList::Pages, number)];
            }
        }
    }
    let mut chosen = None;
    let (mut locks, mut hides) = (None, None);
    let (mut rows, mut records) = (Vec::new(), Vec::new());
    let mut is_led = panes.leads_to(Pane::Floor);
    for item in edited.items.iter().filter(|item| item.is_on(edited.page)) {
        let what = match item.record.list() {
            Some(RecordList::Regions) => "Region",
            Some(RecordList::Stances) => "Stance",
            Some(RecordList::Grounds) => "Ground",
            _ if item.is_group => "Group",
            _ => "Control",
        };
        let is_selected = edited.selected.contains(&item.record);
        let name = if item.name.is_empty() { item.record.to_string() } else { item.name.clone() };
        let is_inner = item.record.split().is_some_and(|(of, ..)| of.list() == Some(RecordList::Widgets));
        let (is_locked, is_hidden) = (edited.is_locked(&item.record), edited.is_hidden(&item.record));
        ui.horizontal(|ui| {
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                ui.spacing_mut().item_spacing.x = 2.0;
                for (sign, is_on, wish) in
                    [(Sign::Hide, is_hidden, &mut hides), (Sign::Lock, is_locked, &mut locks)]
                {
                    let button = sign.button(ui, theme, is_on);
                    let does = if sign == Sign::Hide { "Hide" } else { "Lock" };
                    button.widget_info(|| {
                        WidgetInfo::selected(Role::Button, true, is_on, format!("{does}: {name}"))
                    });
                    if button.on_hover_text(does).clicked() {
                        *wish = Some(item.record.clone());
                    }
                }
                ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                    ui.add_space(if is_inner { 12.0 } else { 0.0 });
                    let shown = in_drawn_order(&name);
                    // The signs of fingers leave room for the name alone.
                    let text = if is_for_fingers(ui) { shown.into() } else { format!("{what} {shown}") };
                    let row =
                        with_word(ui, |ui| ui.add(egui::Button::selectable(is_selected, text).truncate()));
                    row.widget_info(|| {
                        WidgetInfo::selected(Role::Button, true, is_selected, format!("{what} {name}"))
                    });
                    if take(&mut is_led) {
                        row.request_focus();
                    }
                    if row.gained_focus() {
                        row.scroll_to_me(None);
                    }
                    if row.clicked() {
                        chosen = Some(item.record.clone());
                    }
                    records.push(item.record.clone());
                    rows.push(row);
                });
            });
        });
    }
    go_on(ui, &rows);
    for (row, record) in rows.iter().zip(records) {
        if row.secondary_clicked() && !edited.selected.contains(&record) {
            edited.select_only(record);
        }
        row.context_menu(|ui| show_menu(ui, edited, in_place));
    }
    if let Some(record) = locks {
        edited.turn_lock(&[record]);
    }
    if let Some(record) = hides {
        edited.turn_hidden(&[record]);
    }
    if let Some(record) = chosen {
        if ui.input(|i| i.modifiers.shift) { edited.toggle(record) } else { edited.select_only(record) }
    }
    if edited.items.is_empty() {
        ui.label(quiet(theme, "Nothing yet"));
    }
}

/// The buttons at the end of a row of the list.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Sign {
    Hide,
    Lock,
}

impl Sign {
    /// Draws the sign, because the window's font lacks it; faint while it is off.
    fn button(self, ui: &mut Ui, theme: &Theme, is_on: bool) -> egui::Response {
        let (rect, response) = ui.allocate_exact_size(Vec2::splat(side(ui, 18.0)), Sense::click());
        let is_touched = response.hovered() || response.has_focus();
        let ink = if is_on || is_touched { theme.ink } else { theme.quiet.mix(theme.plate, 0.25) };
        let line = egui::Stroke::new(1.3, color(ink));
        let (painter, at) = (ui.painter(), rect.center());
        if response.has_focus() {
            painter.rect_stroke(
                rect,
                4,
                egui::Stroke::new(2.0, color(theme.accent)),
                egui::StrokeKind::Inside,
            );
        }
        match self {
            Self::Hide => {
                painter.add(egui::epaint::EllipseShape::stroke(at, vec2(6.0, 3.6), line));
                painter.circle_filled(at, 1.8, color(ink));
                if is_on {
                    painter.line_segment([at + vec2(-5.5, 5.5), at + vec2(5.5, -5.5)], line);
                }
            }
            Self::Lock => {
                let body = egui::Rect::from_min_max(at + vec2(-4.0, -0.5), at + vec2(4.0, 5.5));
                painter.rect(
                    body,
                    1,
                    color(ink).gamma_multiply(f32::from(u8::from(is_on))),
                    line,
                    egui::StrokeKind::Middle,
                );
                // An open lock has its shackle to the side.
                let aside = if is_on { 0.0 } else { 3.0 };
                let points =
                    [(-2.5, -0.5), (-2.5, -4.0), (2.5, -4.0), (2.5, if is_on { -0.5 } else { -2.5 })];
                let points = points.map(|(x, y)| at + vec2(x + aside, y));
                painter.add(egui::Shape::line(points.to_vec(), line));
            }
        }
        response
    }
}
