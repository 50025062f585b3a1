//! Walks that the mouse draws, for people who are sent onto the simulated floor.

use std::time::Duration;

use eframe::egui::{
    Align2, Color32, FontId, Key, Modifiers, PointerButton, Rect, Response, Shape, Stroke, Ui, vec2,
};
use glam::Vec2;

use super::shown::ShownFloor;
use underfoot::floor::Geometry;
use underfoot::layout::Layout;
use underfoot::widget::WidgetId;
use underfoot_scene::egui_painter::{ScreenFromFloor, color};
use underfoot_scene::scene::{Theme, in_drawn_order};
use underfoot_sim::{ArrivalHandle, DrawnWalk, Script};

/// Minimum distance of a new point of a line from the last one, in metres.
const STEP_M: f32 = 0.01;

/// Maximum number of points of a line: 40 m of it.
const MOST_POINTS: usize = 4096;

/// Maximum number of stored walks, for repeating and for saving as a scenario.
const MOST_WALKS: usize = 64;

/// The people sent onto the floor along drawn walks.
pub(super) struct Walks {
    handle: ArrivalHandle,
    /// Whether the mouse draws walks instead of being a foot.
    pub(super) are_drawn: bool,
    /// The line that is being drawn, in floor metres.
    line: Vec<Vec2>,
    /// The walks so far, oldest first.
    sent: Vec<Sent>,
    /// Why the last walk was refused.
    pub(super) refused: Option<String>,
}

/// A person who was sent along a walk.
struct Sent {
    walk: DrawnWalk,
    script: Script,
    line: Vec<Vec2>,
    /// Time of the start on the window's clock, in seconds.
    at_s: f64,
}

impl Walks {
    pub(super) fn new(handle: ArrivalHandle) -> Self {
        Self { handle, are_drawn: false, line: Vec::new(), sent: Vec::new(), refused: None }
    }

    /// The number of people who are walking now.
    pub(super) fn walking(&self) -> usize {
        self.handle.playing()
    }

    /// The number of stored walks.
    pub(super) fn remembered(&self) -> usize {
        self.sent.len()
    }

    /// Starts or extends the line; a point close to the last one changes nothing.
    fn draw_to(&mut self, at: Vec2) {
        let is_new = self.line.last().is_none_or(|last| last.distance(at) >= STEP_M);
        if is_new && self.line.len() < MOST_POINTS {
            self.line.push(at);
        }
    }

    /// Sends a person along the line.
    fn send(&mut self, now_s: f64, page: usize, layout: &Layout, geometry: &Geometry) {
        let line = std::mem::take(&mut self.line);
        self.refused = match DrawnWalk::new(&line, page, layout, geometry) {
            Err(error) => Some(error.to_string()),
            Ok((walk, script)) => match self.handle.send(script.clone()) {
                Err(error) => Some(error.to_string()),
                Ok(()) => {
                    if self.sent.len() == MOST_WALKS {
                        self.sent.remove(0);
                    }
                    self.sent.push(Sent { walk, script, line, at_s: now_s });
                    None
                }
            },
        };
    }

    /// Repeats all walks, at once.
    pub(super) fn repeat(&mut self) {
        let failed = self.sent.iter().find_map(|sent| self.handle.send(sent.script.clone()).err());
        self.refused = failed.map(|error| error.to_string());
    }

    /// Clears the stored walks; people on the floor stay.
    pub(super) fn forget(&mut self) {
        self.sent.clear();
        self.refused = None;
    }

    /// All walks as a scenario, with the delays at which they were drawn.
    pub(super) fn scenario(&self, title: &str) -> String {
        let first_s = self.sent.first().map_or(0.0, |sent| sent.at_s);
        let after = |sent: &Sent| Duration::try_from_secs_f64(sent.at_s - first_s).unwrap_or_default();
        let walks: Vec<(Duration, DrawnWalk)> =
            self.sent.iter().map(|sent| (after(sent), sent.walk.clone())).collect();
        DrawnWalk::scenario(title, &walks)
    }

    /// The lines on which people still walk; the line that is being drawn is the last.
    fn lines(&self, now_s: f64) -> impl Iterator<Item = &[Vec2]> {
        let walked =
            self.sent.iter().filter(move |sent| now_s - sent.at_s < sent.script.duration().as_secs_f64());
        walked.map(|sent| sent.line.as_slice()).chain(std::iter::once(self.line.as_slice()))
    }

    /// The control at the end of the line.
    fn aims_at(&self, page: usize, layout: &Layout) -> Option<WidgetId> {
        let end = self.line.last()?;
        let index = layout.widget_at(page, *end)?;
        layout.widgets.get(index).map(|widget| widget.id.clone())
    }
}

impl Walks {
    /// W changes between foot and drawing, Escape returns to the foot; both only outside text fields and Design mode.
    pub(super) fn handle_key(&mut self, ui: &Ui, is_designing: bool) {
        let is_free = ui.ctx().memory(|memory| memory.focused().is_none()) && !is_designing;
        if is_free && ui.input_mut(|i| i.consume_key(Modifiers::NONE, Key::W)) {
            self.are_drawn = !self.are_drawn;
        } else if is_free && self.are_drawn && ui.input(|i| i.key_pressed(Key::Escape)) {
            self.are_drawn = false;
        }
        if !self.are_drawn {
            self.line.clear();
        }
    }

    /// Records the line of the mouse, and sends a person on release.
    pub(super) fn draw(&mut self, ui: &Ui, canvas: &Response, map: ScreenFromFloor, shown: &ShownFloor) {
        if !self.are_drawn {
            return;
        }
        let (pressed, released, shift) = ui.input(|i| {
            let pointer = &i.pointer;
            (pointer.primary_pressed(), pointer.button_released(PointerButton::Primary), i.modifiers.shift)
        });
        let pointer = ui.input(|i| i.pointer.interact_pos());
        let begins = pressed && !shift && canvas.contains_pointer();
        if let Some(pointer) = pointer.filter(|_| begins || !self.line.is_empty()) {
            self.draw_to(map.floor(pointer));
        }
        if released && !self.line.is_empty() {
            self.send(shown.now_s, shown.snapshot().page, shown.layout(), &shown.floor.geometry);
        }
    }

    /// Draws the walks over the floor.
    pub(super) fn show(&self, ui: &Ui, rect: Rect, map: ScreenFromFloor, shown: &ShownFloor, theme: &Theme) {
        let painter = ui.painter_at(rect);
        let ink = color(theme.accent);
        for line in self.lines(shown.now_s) {
            way(&painter, line, map, ink);
        }
        let (layout, page) = (shown.layout(), shown.snapshot().page);
        let aimed = self.aims_at(page, layout);
        if let Some(widget) = layout.widgets.iter().find(|widget| Some(&widget.id) == aimed.as_ref()) {
            let area = map.rect(widget.area).expand(3.0);
            painter.rect_stroke(area, 7.0, Stroke::new(2.5, ink), eframe::egui::StrokeKind::Outside);
            let name = if widget.label.is_empty() { widget.id.as_str() } else { &widget.label };
            let words = format!("uses {}", in_drawn_order(name));
            painter.text(
                area.center_top() - vec2(0.0, 5.0),
                Align2::CENTER_BOTTOM,
                words,
                FontId::proportional(13.0),
                ink,
            );
        }
    }
}

/// Draws a dashed line with an arrowhead.
fn way(painter: &eframe::egui::Painter, line: &[Vec2], map: ScreenFromFloor, ink: Color32) {
    let points: Vec<_> = line.iter().map(|point| map.point(*point)).collect();
    let (Some(first), Some(end)) = (points.first(), points.last()) else { return };
    let stroke = Stroke::new(2.0, ink);
    painter.circle_filled(*first, 4.0, ink);
    painter.extend(Shape::dashed_line(&points, stroke, 7.0, 5.0));
    // Take the direction from the last 10 points of screen distance, not from the last pixel.
    let before = points.iter().rev().find(|point| point.distance(*end) > 10.0);
    if let Some(before) = before {
        let back = (*before - *end).normalized() * 11.0;
        let side = back.rot90() * 0.5;
        painter.line_segment([*end, *end + back + side], stroke);
        painter.line_segment([*end, *end + back - side], stroke);
    }
}
