//! The time line under a recorded floor: pause, seek, speed, and repeating a part.

use std::time::Duration;

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{
    Align, CornerRadius, EventFilter, Key, Layout, Margin, Modifiers, Panel, Rangef, Rect, Response,
    RichText, Sense, Stroke, Ui, WidgetInfo, pos2, vec2,
};

use super::feed::PreviewInput;
use super::playback::{MarkWeight, Playback, PlaybackMark, PlaybackOrder, PlaybackState};
use super::style::{panel_frame, quiet, selectable};
use underfoot::layout::Colour;
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Time between frames during playback: the head takes longer than that for a pixel.
const PICTURE: Duration = Duration::from_millis(33);

/// The speeds to choose from, slowest first.
const SPEEDS: [(f64, &str); 6] =
    [(0.1, "1/10"), (0.25, "1/4"), (0.5, "1/2"), (1.0, "1 ×"), (4.0, "4 ×"), (f64::INFINITY, "fastest")];

/// Step of the arrow keys, and of the keys for single steps, in seconds.
const FAR_S: f64 = 1.0;
const NEAR_S: f64 = 0.05;

/// Minimum length of a repeated part, in seconds.
const SHORTEST_S: f64 = 0.2;

/// Distance from a mark within which the pointer shows its text, in points.
const NEAR_MARK: f32 = 5.0;

/// A recording and the state of the mouse on its time line.
pub(super) struct TimeLine {
    playback: Box<dyn Playback>,
    state: PlaybackState,
    /// The time at which the mouse holds the head.
    held_s: Option<f64>,
    /// The time at which the mouse began to mark a part.
    stretch_from_s: Option<f64>,
    /// The floor that goes on under the window's own feet, once the user has taken over.
    taken: Option<Box<PreviewInput>>,
}

impl TimeLine {
    pub(super) fn new(playback: Box<dyn Playback>) -> Self {
        Self { playback, state: PlaybackState::default(), held_s: None, stretch_from_s: None, taken: None }
    }

    /// The part that is marked, in seconds; `None` without one.
    pub(super) fn part(&self) -> Option<(f64, f64)> {
        let all = (0.0, self.state.length_s);
        self.state.repeats.filter(|part| *part != all)
    }

    /// The floor that goes on under the window's own feet, once after the user has taken over.
    pub(super) fn taken_over(&mut self) -> Option<Box<PreviewInput>> {
        self.taken.take()
    }

    fn go_to(&mut self, at_s: f64) {
        self.playback.lead(PlaybackOrder::GoTo(at_s.clamp(0.0, self.state.length_s)));
    }

    /// The time that the user sees as the present: the target of the head.
    fn here_s(&self) -> f64 {
        self.held_s.or(self.state.goes_to_s).unwrap_or(self.state.at_s)
    }
}

impl TimeLine {
    /// Shows the bar with the time line.
    pub(super) fn show(&mut self, ui: &mut Ui, theme: &Theme) {
        self.state = self.playback.state();
        self.handle_keys(ui);
        let frame = panel_frame(theme, Margin::symmetric(14, 6));
        Panel::bottom("time line").frame(frame).resizable(false).show(ui, |ui| {
            ui.horizontal(|ui| {
                ui.set_min_height(28.0);
                self.pause_button(ui);
                self.clock(ui, theme);
                // Lay out from the right first: the line takes the remaining width.
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    self.take_over_button(ui);
                    self.repeat_button(ui);
                    self.speed_menu(ui);
                    self.track(ui, theme);
                });
            });
            if let Some(why) = &self.state.broken {
                let text = format!("The recording breaks off: {why}");
                ui.label(RichText::new(text).size(12.5).color(color(theme.warning)));
            }
        });
        if !self.state.is_paused || self.state.goes_to_s.is_some() {
            ui.ctx().request_repaint_after(PICTURE);
        }
    }

    fn handle_keys(&mut self, ui: &Ui) {
        if ui.ctx().memory(|memory| memory.focused().is_some()) {
            return;
        }
        let pressed = |key| ui.input_mut(|i| i.consume_key(Modifiers::NONE, key));
        if pressed(Key::Space) {
            self.playback.lead(PlaybackOrder::Pause(!self.state.is_paused));
        }
        for (key, by_s) in [(Key::Comma, -NEAR_S), (Key::Period, NEAR_S)] {
            if pressed(key) {
                self.playback.lead(PlaybackOrder::Pause(true));
                self.go_to(self.here_s() + by_s);
            }
        }
    }

    fn pause_button(&mut self, ui: &mut Ui) {
        let text = if self.state.is_paused { "Play" } else { "Pause" };
        let button = ui.add_sized(vec2(62.0, 26.0), egui::Button::new(text));
        if button.on_hover_text("Space does the same").clicked() {
            self.playback.lead(PlaybackOrder::Pause(!self.state.is_paused));
        }
    }

    fn clock(&self, ui: &mut Ui, theme: &Theme) {
        let size = vec2(124.0, 20.0);
        ui.allocate_ui_with_layout(size, Layout::right_to_left(Align::Center), |ui| {
            ui.set_min_size(size);
            let ink = if self.state.goes_to_s.is_some() { theme.warning } else { theme.ink };
            ui.label(quiet(theme, format!("/ {}", minutes(self.state.length_s))).size(12.5));
            let meaning = match self.state.goes_to_s {
                Some(_) => "The floor is sensed again up to there",
                None => "The recording's time",
            };
            let text = RichText::new(minutes(self.here_s())).size(13.5).color(color(ink));
            ui.label(text).on_hover_text(meaning);
        });
    }

    fn take_over_button(&mut self, ui: &mut Ui) {
        if !self.state.can_take_over {
            return;
        }
        let hint = "Go on from this moment with feet of your own: the mouse, fingers, keys";
        if ui.button("Take over").on_hover_text(hint).clicked() {
            self.taken = self.playback.take_over().map(Box::new);
        }
    }

    fn repeat_button(&mut self, ui: &mut Ui) {
        let repeats = self.state.repeats.is_some();
        let hint = "Again and again; drag with Shift on the time line for a part of it";
        if selectable(ui, repeats, "Repeat", hint) {
            let all = (0.0, self.state.length_s);
            self.playback.lead(PlaybackOrder::Repeat((!repeats).then_some(all)));
        }
    }

    fn speed_menu(&mut self, ui: &mut Ui) {
        let name =
            SPEEDS.iter().find(|(speed, _)| *speed == self.state.speed).map_or("1 ×", |(_, name)| name);
        let menu = egui::ComboBox::from_id_salt("speed").selected_text(name).width(74.0);
        let response = menu.show_ui(ui, |ui| {
            for (speed, name) in SPEEDS {
                if ui.selectable_label(speed == self.state.speed, name).clicked() {
                    self.playback.lead(PlaybackOrder::Speed(speed));
                }
            }
        });
        response.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, "Speed"));
    }

    /// The line itself, over the remaining width.
    fn track(&mut self, ui: &mut Ui, theme: &Theme) {
        let size = vec2(ui.available_width() - 10.0, 28.0);
        let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
        let scale = Scale { x: rect.x_range().shrink(8.0), length_s: self.state.length_s };
        self.drag(ui, &response, scale);
        self.step_by_keyboard(ui, &response);
        self.draw(ui, rect, scale, response.has_focus(), theme);
        response.widget_info(|| {
            let mut info = WidgetInfo::slider(true, self.here_s(), "Time line");
            info.current_text_value = Some(format!("{:.1} s", self.here_s()));
            info
        });
        let Some(pointer) = response.hover_pos() else { return };
        let near = |mark: &&PlaybackMark| (scale.x_of(mark.at_s) - pointer.x).abs() < NEAR_MARK;
        if let Some(mark) = self.state.marks.iter().find(near) {
            response.on_hover_text(format!("{}  {}", minutes(mark.at_s), mark.what));
        }
    }

    /// A drag holds the head until release; with Shift it marks a part.
    fn drag(&mut self, ui: &Ui, response: &Response, scale: Scale) {
        let Some(at_s) = response.interact_pointer_pos().map(|pointer| scale.time_at(pointer.x)) else {
            return;
        };
        if response.drag_started() && ui.input(|i| i.modifiers.shift) {
            let begun = ui.input(|i| i.pointer.press_origin());
            // The press has taken hold of the head.
            self.held_s = None;
            self.stretch_from_s = Some(begun.map_or(at_s, |begun| scale.time_at(begun.x)));
        }
        if let Some(from) = self.stretch_from_s {
            if response.drag_stopped() {
                self.stretch_from_s = None;
                let stretch = Some((from.min(at_s), from.max(at_s)));
                let stretch = stretch.filter(|(from, to)| to - from >= SHORTEST_S);
                self.playback.lead(PlaybackOrder::Repeat(stretch));
            } else {
                self.state.repeats = Some((from.min(at_s), from.max(at_s)));
            }
        } else if response.drag_stopped() || response.clicked() {
            self.held_s = None;
            self.go_to(at_s);
        } else if response.is_pointer_button_down_on() {
            self.held_s = Some(at_s);
        }
    }

    fn step_by_keyboard(&mut self, ui: &Ui, response: &Response) {
        if !response.has_focus() {
            return;
        }
        let arrows = EventFilter { horizontal_arrows: true, ..EventFilter::default() };
        ui.ctx().memory_mut(|memory| memory.set_focus_lock_filter(response.id, arrows));
        let pressed = |key| ui.input(|i| i.key_pressed(key));
        for (key, to_s) in [
            (Key::ArrowLeft, self.here_s() - FAR_S),
            (Key::ArrowRight, self.here_s() + FAR_S),
            (Key::Home, 0.0),
            (Key::End, self.state.length_s),
        ] {
            if pressed(key) {
                self.go_to(to_s);
            }
        }
    }

    fn draw(&self, ui: &Ui, rect: Rect, scale: Scale, has_focus: bool, theme: &Theme) {
        let painter = ui.painter_at(rect);
        let middle = rect.center().y;
        let band = |from: f32, to: f32, half: f32| {
            Rect::from_min_max(pos2(from, middle - half), pos2(to.max(from), middle + half))
        };
        let round = CornerRadius::same(3);
        if let Some((from, to)) = self.state.repeats {
            let stretch = band(scale.x_of(from), scale.x_of(to), 12.0);
            painter.rect_filled(stretch, round, color(theme.accent).gamma_multiply(0.14));
        }
        painter.rect_filled(band(scale.x.min, scale.x.max, 3.0), round, color(theme.line));
        let played = scale.x_of(self.state.at_s);
        painter.rect_filled(band(scale.x.min, played, 3.0), round, color(theme.accent));
        for mark in self.state.marks.iter() {
            let x = scale.x_of(mark.at_s);
            let (ink, reach) = mark_look(mark.weight, theme);
            painter.vline(x, Rangef::new(middle - reach, middle + reach), Stroke::new(1.5, color(ink)));
        }
        let head = pos2(scale.x_of(self.here_s()), middle);
        painter.circle_filled(head, 7.0, color(theme.plate));
        let edge = if has_focus { 3.0 } else { 2.0 };
        painter.circle_stroke(head, 7.0, Stroke::new(edge, color(theme.accent)));
    }
}

/// The mapping of times to the screen.
#[derive(Clone, Copy)]
struct Scale {
    x: Rangef,
    length_s: f64,
}

impl Scale {
    fn x_of(self, at_s: f64) -> f32 {
        let share = if self.length_s > 0.0 { (at_s / self.length_s).clamp(0.0, 1.0) } else { 0.0 };
        self.x.min + share as f32 * self.x.span()
    }

    fn time_at(self, x: f32) -> f64 {
        f64::from(((x - self.x.min) / self.x.span().max(1.0)).clamp(0.0, 1.0)) * self.length_s
    }
}

/// The colour of a mark, and its extent above and below the line.
fn mark_look(weight: MarkWeight, theme: &Theme) -> (Colour, f32) {
    match weight {
        MarkWeight::Usual => (theme.quiet, 7.0),
        MarkWeight::Odd => (theme.warning, 9.0),
        MarkWeight::Fault => (theme.fault, 12.0),
    }
}

/// A time in minutes and seconds: `1:04.2`.
fn minutes(at_s: f64) -> String {
    // The cast from float saturates at the range of the integer.
    let tenths = (10.0 * at_s.max(0.0)).round() as u64;
    format!("{}:{:02}.{}", tenths / 600, tenths / 10 % 60, tenths % 10)
}
