//! Marks over the canvas: the selection, guide lines, findings, and feet to scale.

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{Align2, FontId, Pos2, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2};
use glam::Vec2;

use super::canvas::DrawnToScale;
use super::edited::EditedLayout;
use super::gestures::{HANDLE, can_be_sized, handles};
use super::trial::GestureResult;
use crate::preview::labels::Labels;
use underfoot::floor::Rect;
use underfoot::layout::Layout;
use underfoot::units::Newtons;
use underfoot_format::diagnostic::Severity;
use underfoot_scene::egui_painter::{ScreenFromFloor, color};
use underfoot_scene::ergonomics::{Finding, REACH_M, STEP_AWAY_M, footing};
use underfoot_scene::scene::{Shoe, Theme};

/// Radius of a badge, in points.
const BADGE: f32 = 8.5;

/// Draws the selection, its guide lines and the findings; `notes` has a place for each text about the gesture.
pub(super) fn marks(
    edited: &EditedLayout,
    ui: &Ui,
    map: ScreenFromFloor,
    theme: &Theme,
    trial: &GestureResult,
    notes: &mut Labels,
) {
    let rect = notes.within;
    let painter = ui.painter_at(rect);
    let accent = color(theme.accent);
    if trial.layout.is_none() {
        badges(edited, ui, map, theme, notes);
    }
    let is_moving = !trial.areas.is_empty();
    for item in edited.selected_items() {
        let shown = map.rect(item.area);
        let colour = if is_moving { accent.gamma_multiply(0.4) } else { accent };
        painter.rect_stroke(shown, 2, Stroke::new(2.0, colour), StrokeKind::Outside);
    }
    if let ([item], false) = (&edited.selected_items()[..], is_moving)
        && can_be_sized(item)
    {
        for (at, _) in handles(map.rect(item.area)) {
            let square = egui::Rect::from_center_size(at, vec2(2.0 * HANDLE, 2.0 * HANDLE));
            painter.rect(square, 2, color(theme.plate), Stroke::new(1.5, accent), StrokeKind::Inside);
        }
    }
    let bad = color(theme.fault);
    for area in &trial.areas {
        let shown = map.rect(*area);
        let colour = if trial.refused.is_some() { bad } else { accent };
        painter.rect(shown, 2, colour.gamma_multiply(0.12), Stroke::new(2.0, colour), StrokeKind::Outside);
        let size = area.size() * 100.0;
        let text = format!("{:.1} x {:.1} cm", size.x, size.y);
        notes.note(&painter, shown, &text, colour, theme);
    }
    if let (Some(refused), Some(area)) = (&trial.refused, trial.areas.first()) {
        notes.note(&painter, map.rect(*area), refused, bad, theme);
    }
    for guide in &trial.guides {
        let at = map.point(Vec2::splat(guide.at_m));
        let line = if guide.is_upright {
            [pos2(at.x, rect.top()), pos2(at.x, rect.bottom())]
        } else {
            [pos2(rect.left(), at.y), pos2(rect.right(), at.y)]
        };
        painter.line_segment(line, Stroke::new(1.0, accent));
    }
    if let Some(lasso) = trial.lasso {
        let shown = map.rect(lasso);
        painter.rect(shown, 0, accent.gamma_multiply(0.1), Stroke::new(1.0, accent), StrokeKind::Inside);
    }
}

/// Draws one badge for each control with findings, in the colour of the worst; the texts appear beside the control
/// under the pointer and beside those that are selected.
fn badges(edited: &EditedLayout, ui: &Ui, map: ScreenFromFloor, theme: &Theme, labels: &mut Labels) {
    let rect = labels.within;
    let painter = ui.painter_at(rect);
    let widgets = &edited.layout().widgets;
    let pointer = ui.input(|i| i.pointer.hover_pos()).filter(|at| rect.contains(*at));
    for (index, widget) in widgets.iter().enumerate().filter(|(_, widget)| widget.is_on(edited.page)) {
        let record = |finding: &Finding| edited.document.found_in(finding);
        let is_seen = |finding: &&Finding| {
            finding.widget == index && record(finding).is_some_and(|record| !edited.is_hidden(&record))
        };
        let findings: Vec<&Finding> = edited.findings.iter().filter(is_seen).collect();
        let Some(first) = findings.first() else { continue };
        let is_error = findings.iter().any(|finding| finding.severity == Severity::Error);
        let colour = if is_error { theme.fault } else { theme.warning };
        let control = map.rect(widget.area);
        let is_selected = record(first).is_some_and(|record| edited.selected.contains(&record));
        // Beside the corner, clear of the texts of the control and of the handle of one that is selected.
        let aside = if is_selected { 10.0 } else { 4.0 };
        let badge = control.right_top() + vec2(aside, -aside);
        painter.circle(badge, BADGE, color(colour), Stroke::new(1.5, color(theme.plate)));
        let mark = if findings.len() == 1 { "!".to_owned() } else { findings.len().to_string() };
        painter.text(badge, Align2::CENTER_CENTER, mark, FontId::proportional(12.0), color(theme.plate));
        let is_hovered = pointer.is_some_and(|at| control.contains(at) || at.distance(badge) < BADGE);
        let lines: Vec<String> = findings
            .iter()
            .map(|finding| format!("{} {}: {}", finding.rule.code, finding.message, finding.expected))
            .collect();
        let spoken = format!("Warnings of {}: {}", widget.id, lines.join("; "));
        let around = egui::Rect::from_center_size(badge, egui::Vec2::splat(2.0 * BADGE));
        let node = ui.interact(around, ui.scope_id().with(("warnings", index)), Sense::hover());
        node.widget_info(|| WidgetInfo::labeled(Role::Image, true, &spoken));
        if is_hovered || is_selected {
            let place = labels.put(&painter, control, &lines.join("\n"), colour, theme);
            let shown = ui.interact(place, ui.scope_id().with(("warning text", index)), Sense::hover());
            shown.widget_info(|| WidgetInfo::labeled(Role::Tooltip, true, lines.join("; ")));
        }
    }
}

impl DrawnToScale {
    /// Two shoes on each place to stand and one under the pointer, if they are switched on.
    pub(super) fn shoes(self, layout: &Layout, pointer: Option<Vec2>) -> Vec<Shoe> {
        /// Length of a sole that is long enough for 95 of 100 people.
        const LENGTH_M: f32 = 0.30;
        /// Distance between the middles of the two soles.
        const APART_M: f32 = 0.20;
        if !self.shoes {
            return Vec::new();
        }
        let shoe = |position: Vec2, left: bool| Shoe {
            position,
            heading_rad: 0.0,
            length_m: LENGTH_M,
            force: Newtons(0.0),
            roll: 0.5,
            left,
        };
        let stances = layout.stances.iter().map(|stance| stance.area.centre());
        let pairs = stances.flat_map(|at| {
            let half = Vec2::new(0.5 * APART_M, 0.0);
            [shoe(at - half, true), shoe(at + half, false)]
        });
        pairs.chain(pointer.map(|at| shoe(at, false))).collect()
    }

    /// Draws how far feet reach from each place to stand, without a step and with one, if that is switched on.
    pub(super) fn reach(
        self,
        painter: &egui::Painter,
        map: ScreenFromFloor,
        theme: &Theme,
        layout: &Layout,
        notes: &mut Labels,
    ) {
        if !self.reach {
            return;
        }
        let colour = color(theme.accent).gamma_multiply(0.8);
        for stance in &layout.stances {
            for (far, text) in [(REACH_M, "reach"), (STEP_AWAY_M, "one step")] {
                let line: Vec<Pos2> =
                    rounded(footing(stance), far).into_iter().map(|at| map.point(at)).collect();
                let north = line.iter().copied().min_by(|a, b| a.y.total_cmp(&b.y));
                painter.extend(egui::Shape::dashed_line(&line, Stroke::new(1.5, colour), 7.0, 5.0));
                if let Some(at) = north {
                    let subject = egui::Rect::from_center_size(at, vec2(48.0, 2.0));
                    notes.note(painter, subject, &format!("{text}, {far:.1} m"), color(theme.accent), theme);
                }
            }
        }
    }
}

/// A closed line at the distance `far` around `area`.
fn rounded(area: Rect, far: f32) -> Vec<Vec2> {
    let corners = [area.max, Vec2::new(area.min.x, area.max.y), area.min, Vec2::new(area.max.x, area.min.y)];
    let arc = |(quarter, corner): (usize, Vec2)| {
        (0..=16_u8).map(move |part| {
            let turn = quarter as f32 + f32::from(part) / 16.0;
            corner + far * Vec2::from_angle(turn * std::f32::consts::FRAC_PI_2)
        })
    };
    let mut line: Vec<Vec2> = corners.into_iter().enumerate().flat_map(arc).collect();
    line.extend(line.first().copied());
    line
}
