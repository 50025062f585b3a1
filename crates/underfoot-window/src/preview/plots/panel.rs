//! The plots under the floor, and the list from which their lines are chosen.

use eframe::egui::accesskit::Role;
use eframe::egui::containers::menu::{MenuButton, MenuConfig};
use eframe::egui::{
    Align, Button, Color32, ComboBox, Key, Label, Layout, Margin, Panel, PopupCloseBehavior, ScrollArea,
    Sense, TextEdit, Ui, WidgetInfo, vec2,
};

use super::chart::{Chart, PlotLine, ThresholdDrag, ThresholdPair};
use super::series::{Series, Unit};
use super::{MOST, Plots, SPANS};
use crate::preview::design::{Designer, Threshold, set_threshold};
use crate::preview::handheld::{PanelSheet, is_for_fingers, panel_at};
use crate::preview::selection::Selection;
use crate::preview::shown::ShownFloor;
use crate::preview::style::{panel_frame, quiet, small_button, toggle};
use underfoot::units::Newtons;
use underfoot::widget::WidgetId;
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Height of a line of the list, in points.
const LINE: f32 = 20.0;

/// A request from the strip above the plots.
enum Wish {
    Turn(Series),
    Close,
}

impl Plots {
    /// Shows the plots, if they are open. A threshold that the user drags in them is set by `designer`.
    pub(in crate::preview) fn show(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        shown: &ShownFloor,
        selection: &Selection,
        designer: Option<&mut Designer>,
        sheet: Option<PanelSheet>,
    ) {
        if !self.is_open {
            return;
        }
        let selected = selection.control_of(shown.layout()).map(|widget| widget.id.clone());
        let frame = panel_frame(theme, Margin { left: 14, right: 14, top: 6, bottom: 6 });
        let most = (0.6 * ui.available_height()).max(121.0);
        let panel = panel_at(sheet, || {
            Panel::bottom("plots").resizable(true).default_size(210.0).size_range(120.0..=most)
        });
        panel.frame(frame).show(ui, |ui| {
            self.strip(ui, theme, shown, selected.as_ref());
            self.charts(ui, theme, shown, selected, designer);
        });
    }

    /// Opens or closes the plots on P, unless a text field has the focus.
    pub(in crate::preview) fn handle_key(&mut self, ui: &Ui) {
        let is_free = ui.ctx().memory(|memory| memory.focused().is_none());
        if is_free && ui.input(|i| i.key_pressed(Key::P) && i.modifiers.is_none()) {
            self.is_open = !self.is_open;
        }
    }

    /// Shows the chosen lines and the time span.
    fn strip(&mut self, ui: &mut Ui, theme: &Theme, shown: &ShownFloor, selected: Option<&WidgetId>) {
        let mut wish = None;
        ui.horizontal(|ui| {
            ui.set_min_height(24.0);
            wish = self.everything(ui, theme, shown, selected);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let close = small_button(ui, "x");
                close.widget_info(|| WidgetInfo::labeled(Role::Button, true, "Close plots"));
                if close.on_hover_text("Close the plots; P does the same").clicked() {
                    wish = Some(Wish::Close);
                }
                toggle(ui, &mut self.is_held, "Freeze", "Let what is seen stay");
                let span = &mut self.span_s;
                let text = |span: f64| format!("{span:.0} s");
                let menu = ComboBox::from_id_salt("span").selected_text(text(*span)).width(56.0);
                let menu = menu.show_ui(ui, |ui| {
                    for one in SPANS {
                        ui.selectable_value(span, one, text(one));
                    }
                });
                menu.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, "Seconds plotted"));
                if !is_for_fingers(ui) {
                    ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                        // Text that does not fit is cut off, so that buttons keep their places.
                        wish = self.chips(ui, theme, selected).or(wish.take());
                    });
                }
            });
        });
        if is_for_fingers(ui) {
            // A small window has no room for them beside the buttons.
            ui.horizontal_wrapped(|ui| wish = self.chips(ui, theme, selected).or(wish.take()));
        }
        match wish {
            Some(Wish::Turn(series)) => self.turn(series),
            Some(Wish::Close) => self.is_open = false,
            None => {}
        }
    }

    /// The chosen lines, each of which a click removes.
    fn chips(&self, ui: &mut Ui, theme: &Theme, selected: Option<&WidgetId>) -> Option<Wish> {
        let mut wish = None;
        for (series, colour) in self.chosen.iter().zip(colours(theme)) {
            if chip(ui, theme, &series.name(selected), colour) {
                wish = Some(Wish::Turn(series.clone()));
            }
        }
        if let Some(told) = &self.told {
            ui.add(Label::new(quiet(theme, told)).truncate());
        }
        wish
    }

    /// A menu of everything that can be plotted, with a search field; it stays open after a choice.
    fn everything(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        shown: &ShownFloor,
        selected: Option<&WidgetId>,
    ) -> Option<Wish> {
        let mut wish = None;
        let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
        MenuButton::new("Plot ...").config(config).ui(ui, |ui| {
            ui.set_width(250.0);
            let field =
                TextEdit::singleline(&mut self.wanted).hint_text("Search: tile 2, 3").desired_width(240.0);
            let field = ui.add(field);
            field.widget_info(|| WidgetInfo::labeled(Role::SearchInput, true, "Search what to plot"));
            let contacts = self.history.contacts();
            let all = Series::all(shown.layout(), &shown.floor, &contacts);
            let wanted = self.wanted.to_lowercase();
            let found: Vec<(Series, String)> = all
                .into_iter()
                .map(|series| (series.name(selected), series))
                .filter(|(name, _)| wanted.split_whitespace().all(|word| name.to_lowercase().contains(word)))
                .map(|(name, series)| (series, name))
                .collect();
            let area =
                ScrollArea::vertical().id_salt("everything").max_height(13.0 * LINE).auto_shrink(false);
            area.show_rows(ui, LINE, found.len().max(1), |ui, lines| {
                if found.is_empty() {
                    ui.label(quiet(theme, "nothing with that"));
                }
                for (series, name) in lines.filter_map(|line| found.get(line)) {
                    let is_chosen = self.chosen.contains(series);
                    if ui.selectable_label(is_chosen, name).clicked() {
                        wish = Some(Wish::Turn(series.clone()));
                    }
                }
            });
            ui.label(quiet(theme, format!("{} of {MOST} at once", self.chosen.len())).size(12.0));
        });
        wish
    }

    fn charts(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        shown: &ShownFloor,
        selected: Option<WidgetId>,
        designer: Option<&mut Designer>,
    ) {
        let units: Vec<Unit> =
            Unit::ALL.into_iter().filter(|unit| self.chosen.iter().any(|one| one.unit() == *unit)).collect();
        if units.is_empty() {
            ui.centered_and_justified(|ui| ui.label(quiet(theme, "Choose what to plot.")));
            return;
        }
        ui.spacing_mut().item_spacing.y = 4.0;
        let height = (ui.available_height() - 4.0 * (units.len() - 1) as f32) / units.len() as f32;
        let thresholds = selected.as_ref().and_then(|id| thresholds_at(shown.layout(), id));
        let mut drag = None;
        for unit in units {
            let of = self.chosen.iter().zip(colours(theme)).filter(|(series, _)| series.unit() == unit);
            let traces = of.map(|(series, colour)| PlotLine {
                name: series.name(selected.as_ref()),
                colour,
                points: self.points(series, &shown.floor.geometry, selected.as_ref()),
            });
            let traces = traces.collect();
            let lines = thresholds.filter(|_| unit == Unit::Newtons);
            let at_rest = lines.map(|lines| lines.map(|(_, force)| force));
            let can_set = designer.is_some();
            let lines = selected.as_ref().zip(lines).map(|(id, lines)| (id, self.dragged(lines), can_set));
            let span_s = self.span_s;
            let chart = Chart { theme, unit, span_s, height, traces, thresholds: lines, at_rest };
            drag = chart.show(ui).or(drag);
        }
        if let (Some(drag), Some(id)) = (drag, selected) {
            self.drag_threshold(&id, drag, shown, designer);
        }
    }

    /// The thresholds, with the dragged one at its present force.
    fn dragged(&self, lines: [(Threshold, Newtons); 2]) -> [(Threshold, Newtons); 2] {
        lines.map(|(which, force)| match self.dragged {
            Some((dragged, to)) if dragged == which => (which, to),
            _ => (which, force),
        })
    }

    /// Sets the threshold at the end of the drag, so that a drag is one undo step.
    fn drag_threshold(
        &mut self,
        id: &WidgetId,
        drag: ThresholdDrag,
        shown: &ShownFloor,
        designer: Option<&mut Designer>,
    ) {
        match drag {
            ThresholdDrag::To(which, force) => self.dragged = Some((which, force)),
            ThresholdDrag::Done(which, force) => {
                self.dragged = None;
                self.told = Some(set_threshold(designer, shown, id, which, force));
            }
        }
    }

    /// Plots the force on a control of `layout`, and its value.
    pub(in crate::preview) fn add_control(&mut self, layout: &underfoot::layout::Layout, id: &WidgetId) {
        let widget = layout.widget_index(id.as_str()).and_then(|index| layout.widgets.get(index));
        let holds = widget.is_some_and(|widget| widget.behaviour.initial().is_some());
        self.add([Series::Force(id.clone())].into_iter().chain(holds.then(|| Series::Value(id.clone()))));
    }
}

/// The thresholds of a control of `layout`.
fn thresholds_at(layout: &underfoot::layout::Layout, id: &WidgetId) -> Option<ThresholdPair> {
    let now = layout.widgets.get(layout.widget_index(id.as_str())?)?.behaviour.thresholds();
    Some([(Threshold::Press, now.press), (Threshold::Release, now.release)])
}

/// Shows a line's name with its colour; returns whether to remove the line.
fn chip(ui: &mut Ui, theme: &Theme, name: &str, colour: Color32) -> bool {
    let (mark, _) = ui.allocate_exact_size(vec2(14.0, 14.0), Sense::hover());
    ui.painter().hline(mark.x_range(), mark.center().y, eframe::egui::Stroke::new(3.0, colour));
    ui.spacing_mut().item_spacing.x = 4.0;
    ui.label(quiet(theme, name).color(color(theme.ink)).size(12.5));
    let button = ui.add(Button::new("x").small().frame(false));
    button.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Leave out {name}")));
    ui.add_space(8.0);
    button.on_hover_text("Leave it out").clicked()
}

/// Colours of the lines, in order of their choice: the colours of the theme that differ most, also for people with
/// red-green colour blindness.
fn colours(theme: &Theme) -> impl Iterator<Item = Color32> {
    let all = [theme.contact, theme.cursor, theme.warning, theme.haptic, theme.ink, theme.stale];
    all.into_iter().map(color)
}
