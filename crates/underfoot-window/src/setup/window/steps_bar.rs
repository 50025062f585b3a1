//! The steps at the left.

use eframe::egui::accesskit::Role;
use eframe::egui::{Align2, FontId, Label, RichText, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

use super::app::SetupApp;
use super::parts::Wish;
use crate::preview::style::quiet;
use crate::setup::{SetupStep, SetupView, StepState};
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Height of a step, in points.
const HEIGHT: f32 = 46.0;

/// Radius of the disc with the number of a step, in points.
const RADIUS: f32 = 13.0;

impl SetupApp {
    /// Shows the steps; a click begins one.
    pub(super) fn steps_bar(&self, ui: &mut Ui, theme: &Theme, view: &SetupView, wishes: &mut Vec<Wish>) {
        ui.label(RichText::new("Set up a floor").size(18.0).strong().color(color(theme.ink)));
        ui.add(Label::new(quiet(theme, &self.options.file)).truncate());
        ui.add_space(12.0);
        for step in SetupStep::ALL {
            let (area, button) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::click());
            let is_shown = step == self.step;
            let state = view.step(step).state;
            let is_on = !step.needs_floor() || view.floor.is_some();
            button.widget_info(|| {
                WidgetInfo::selected(
                    Role::Button,
                    is_on,
                    is_shown,
                    format!("{}. {}", step.index() + 1, step.name()),
                )
            });
            let painter = ui.painter();
            if is_shown || button.hovered() || button.has_focus() {
                let ground = color(theme.accent).gamma_multiply(if is_shown { 0.13 } else { 0.06 });
                painter.rect_filled(area.expand2(vec2(6.0, 0.0)), 6.0, ground);
            }
            let middle = pos2(area.left() + RADIUS + 2.0, area.center().y);
            if let Some(next) = step.next() {
                // The line to the next step.
                let from = middle + vec2(0.0, RADIUS + 3.0);
                let below = middle + vec2(0.0, HEIGHT + ui.spacing().item_spacing.y - RADIUS - 3.0);
                let is_past = view.step(next).state != StepState::Open && state == StepState::Done;
                let ink = if is_past { theme.good } else { theme.line };
                painter.line_segment([from, below], Stroke::new(1.5, color(ink)));
            }
            let fill = match state {
                StepState::Done => theme.good,
                StepState::Trouble => theme.fault,
                StepState::Open if is_shown => theme.accent,
                StepState::Open => theme.line,
            };
            painter.circle_filled(middle, RADIUS, color(fill));
            let ink = color(theme.legible(theme.plate, fill));
            if state == StepState::Done {
                let tick = [vec2(-5.0, 0.5), vec2(-1.5, 4.5), vec2(5.5, -4.0)].map(|way| middle + way);
                painter.line(tick.to_vec(), Stroke::new(2.2, ink));
            } else {
                let sign =
                    if state == StepState::Trouble { "!".to_owned() } else { (step.index() + 1).to_string() };
                painter.text(middle, Align2::CENTER_CENTER, sign, FontId::proportional(14.0), ink);
            }
            let ink = if is_on { theme.ink } else { theme.quiet };
            let at = pos2(middle.x + RADIUS + 10.0, middle.y);
            painter.text(at, Align2::LEFT_CENTER, step.name(), FontId::proportional(14.5), color(ink));
            if button.clicked() && is_on {
                wishes.push(Wish::Step(step));
            }
        }
        ui.add_space(14.0);
        let words = "Each step can be repeated and left at any time. Results are in the floor file at once.";
        ui.add(Label::new(quiet(theme, words)).wrap());
    }
}
