//! The picture of one projector: the controls or the check page, laid onto the floor, and the adjustment of its corners.

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{
    Align2, Color32, CursorIcon, FontId, Key, Pos2, Rect, Sense, Stroke, Ui, WidgetInfo, pos2, vec2,
};
use glam::Vec2;

use super::brightness::Brightness;
use super::check_page;
use super::corners::{Adjusted, CornerEditor, HANDLE, handle_of};
use super::homography::Homography;
use super::marks::AlignmentMarks;
use super::pair::{ProjectorName, ProjectorSetup};
use super::picture::Picture;
use super::placement::Placement;
use crate::preview::shown::ShownFloor;
use underfoot::layout::Colour;
use underfoot_scene::egui_painter::{self, Palette, ScreenFromFloor, color};
use underfoot_scene::scene::{Scene, Theme};

/// Per cent by which a key changes the brightness.
const BRIGHTER: i32 = 5;

/// Light of the controls while the corners are adjusted, so that the lines stand out.
const BEHIND_LINES: i32 = 30;

/// Colour of the selected corner.
const CHOSEN: Colour = Colour::rgb(0xff, 0xe6, 0x00);

/// Colour of the lines of a projector that is alone.
const ALONE: Colour = Colour::rgb(0xff, 0xff, 0xff);

/// Colours of the lines of two projectors: together they are white, so that lines that lie on each other are.
const TOGETHER: [Colour; 2] = [Colour::rgb(0x00, 0xff, 0xff), Colour::rgb(0xff, 0x00, 0x00)];

/// The floor that a projector shows.
pub(super) struct ProjectedFloor<'a> {
    pub(super) shown: &'a ShownFloor,
    /// Its controls, drawn in floor metres.
    pub(super) controls: &'a Scene,
    pub(super) theme: &'a Theme,
    /// Whether a second projector lights the same floor.
    pub(super) is_pair: bool,
}

/// A key that acts on the projector's window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum WindowKey {
    Close,
    FullScreen,
    NextScreen,
}

/// The picture of one projector, and its state from one frame to the next.
#[derive(Default)]
pub(super) struct ProjectorView {
    pub(super) corners: CornerEditor,
    /// Whether the check page is in place of the controls.
    pub(super) has_check_page: bool,
    marks: Scene,
    palette: Palette,
    palette_of_marks: Palette,
}

impl ProjectorView {
    /// Ends the adjustment and the check page.
    pub(super) fn close(&mut self) {
        self.corners.close();
        self.has_check_page = false;
    }

    /// Draws the picture and handles the pointer, and the keys if `has_keys`; returns the key for the window, if any.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        setup: &mut ProjectorSetup,
        floor: &ProjectedFloor<'_>,
        (name, has_keys): (ProjectorName, bool),
    ) -> Option<WindowKey> {
        let picture = Picture::filling(ui);
        let node = ui.interact(picture.area, ui.scope_id().with("projected floor"), Sense::hover());
        node.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, name.label("Projected floor")));
        let size = floor.shown.floor.geometry.bounds().size();
        let fit = Placement::fit(size.x / size.y, picture.shape());
        let key = if has_keys { self.handle_keys(ui, setup) } else { None };
        let mut adjusted = Adjusted { placement: &mut setup.placement, fit, picture };
        if has_keys {
            self.corners.handle_keys(ui, &mut adjusted);
        }
        let (events, now_s) = ui.input(|i| (i.events.clone(), i.time));
        self.corners.drag(&events, now_s, &mut adjusted);
        let placement = adjusted.now();
        self.paint(ui, floor, placement, picture, (name, setup.brightness));
        if let Some(selected) = self.corners.selected() {
            show_handles(ui, placement, picture, (name, selected));
            if !self.corners.is_holding() {
                let corner = placement.corners[selected % 4] / picture.pixel();
                let mut lines = help_lines(name, setup.brightness, (selected, corner));
                if floor.is_pair {
                    lines.push("Lines of both projectors that lie on each other are white".to_owned());
                } else if self.corners.is_complete() {
                    lines.push("All four are placed: the mouse in the main window ends this too".to_owned());
                }
                help(ui, picture, lines);
            }
        } else if node.contains_pointer() {
            ui.ctx().set_cursor_icon(CursorIcon::None);
        }
        key
    }

    /// Handles the keys of the window.
    fn handle_keys(&mut self, ui: &Ui, setup: &mut ProjectorSetup) -> Option<WindowKey> {
        let pressed = |key: Key| ui.input(|i| i.key_pressed(key));
        if pressed(Key::C) {
            self.corners.toggle();
        }
        self.has_check_page ^= pressed(Key::T);
        let presses = |key: Key| {
            let count = ui.input(|i| if i.modifiers.command { 0 } else { i.num_presses(key) });
            i32::try_from(count).unwrap_or(i32::MAX / BRIGHTER)
        };
        let steps =
            presses(Key::Plus).saturating_add(presses(Key::Equals)).saturating_sub(presses(Key::Minus));
        setup.brightness = setup.brightness.changed(steps.saturating_mul(BRIGHTER));
        let is_ended = pressed(Key::Escape)
            && (self.corners.escape(&mut setup.placement) || std::mem::take(&mut self.has_check_page));
        if pressed(Key::F11) || pressed(Key::Escape) && !is_ended {
            Some(WindowKey::Close)
        } else if pressed(Key::N) {
            Some(WindowKey::NextScreen)
        } else {
            pressed(Key::F).then_some(WindowKey::FullScreen)
        }
    }

    /// Draws the controls or the check page, and the marks of the adjustment over them.
    fn paint(
        &mut self,
        ui: &Ui,
        floor: &ProjectedFloor<'_>,
        placement: Placement,
        picture: Picture,
        (name, light): (ProjectorName, Brightness),
    ) {
        let canvas = if self.has_check_page { Color32::BLACK } else { light.dim(color(floor.theme.canvas)) };
        ui.painter().rect_filled(picture.area, 0.0, canvas);
        let geometry = &floor.shown.floor.geometry;
        let bounds = geometry.bounds();
        let Some(homography) = placement.floor_to_picture(bounds, picture.size()) else { return };
        let (map, painter) = (ScreenFromFloor::fit(bounds, picture.area), ui.painter_at(picture.area));
        let throw = |palette: &mut Palette, scene: &Scene, light: Brightness| {
            let dimmer = light.dimmer();
            egui_painter::paint_warped(&painter, palette, scene, map, |vertex| {
                vertex.pos = onto(&homography, picture, map.floor(vertex.pos));
                vertex.color = dimmer(vertex.color);
            });
        };
        if self.has_check_page {
            let heading = format!("{}, {} %", name.title(), light.percent());
            check_page::draw(&mut self.marks, bounds, &heading);
            throw(&mut self.palette_of_marks, &self.marks, light);
            check_page::draw_border(&painter, picture, light);
            let page = ui.interact(picture.area, ui.scope_id().with("check page"), Sense::hover());
            page.widget_info(|| WidgetInfo::labeled(Role::Label, true, name.label("Projected check page")));
        } else {
            let behind = light.percent();
            let behind = i32::from(behind) * BEHIND_LINES / 100 - i32::from(behind);
            let light = if self.corners.selected().is_some() { light.changed(behind) } else { light };
            throw(&mut self.palette, floor.controls, light);
            name_controls(ui, floor.shown, name, |at| onto(&homography, picture, at));
        }
        if let Some(selected) = self.corners.selected() {
            let line = if floor.is_pair { TOGETHER[name.index % 2] } else { ALONE };
            let corner = placement.corners_of(bounds)[selected % 4];
            AlignmentMarks { line, chosen: CHOSEN, corner }.draw(&mut self.marks, geometry);
            throw(&mut self.palette_of_marks, &self.marks, Brightness::FULL);
        }
    }
}

/// The point of the picture on which a point of the floor lies.
fn onto(homography: &Homography, picture: Picture, at: Vec2) -> Pos2 {
    let place = homography.map(at.as_dvec2());
    picture.area.min + vec2(place.x as f32, place.y as f32)
}

/// Names each control at its place on the picture, for tests and screen readers.
fn name_controls(ui: &Ui, shown: &ShownFloor, name: ProjectorName, onto: impl Fn(Vec2) -> Pos2) {
    let snapshot = shown.snapshot();
    for (index, widget) in shown.layout().widgets.iter().enumerate() {
        if snapshot.widgets.get(index).is_some_and(|state| state.hidden) {
            continue;
        }
        let area = widget.area;
        let others = [Vec2::new(area.min.x, area.max.y), Vec2::new(area.max.x, area.min.y), area.max];
        let around = others.into_iter().fold(Rect::from_pos(onto(area.min)), |mut around, at| {
            around.extend_with(onto(at));
            around
        });
        let node = ui.interact(around, ui.scope_id().with(("projected", index)), Sense::hover());
        let label = if widget.label.is_empty() { widget.id.as_str() } else { &widget.label };
        let spoken = name.label(&format!("Projected {label}"));
        node.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
    }
}

/// Shows the handles of the corners: rings that leave the corner itself free, with their numbers beside them.
fn show_handles(ui: &Ui, placement: Placement, picture: Picture, (name, selected): (ProjectorName, usize)) {
    let corners = placement.corners.map(|corner| picture.point(corner));
    let sum = corners.iter().fold(egui::Vec2::ZERO, |sum, corner| sum + corner.to_vec2());
    let middle = (0.25 * sum).to_pos2();
    let painter = ui.painter_at(picture.area);
    for (index, corner) in corners.into_iter().enumerate() {
        let area = handle_of(corner, picture.area);
        let is_chosen = index == selected;
        // Not a place for the keyboard's focus: Tab goes from corner to corner.
        let handle = ui.interact(area, ui.scope_id().with(("corner", index)), Sense::DRAG);
        let spoken = name.label(&format!("Corner {}", index + 1));
        handle.widget_info(|| WidgetInfo::selected(Role::Button, true, is_chosen, spoken.clone()));
        let line = if is_chosen { color(CHOSEN) } else { Color32::WHITE };
        let ring = area.center();
        // A dark line around the ring is visible on light pictures.
        painter.circle_stroke(ring, HANDLE - 2.0, Stroke::new(6.0, Color32::from_black_alpha(160)));
        painter.circle_stroke(ring, HANDLE - 2.0, Stroke::new(if is_chosen { 4.0 } else { 2.0 }, line));
        let number = ring + (HANDLE + 18.0) * (middle - ring).normalized();
        let (fill, ink) = if is_chosen { (line, Color32::BLACK) } else { (Color32::BLACK, line) };
        painter.circle(number, 13.0, fill, Stroke::new(2.0, line));
        let text = format!("{}", index + 1);
        painter.text(number, Align2::CENTER_CENTER, text, FontId::proportional(17.0), ink);
    }
}

/// The keys of the adjustment, and the place of the selected corner in pixels of the picture.
fn help_lines(name: ProjectorName, light: Brightness, (selected, corner): (usize, Vec2)) -> Vec<String> {
    vec![
        format!("{}: drag each corner onto the floor’s own corner", name.title()),
        format!("Corner {} is at {:.0}, {:.0} pixels", selected + 1, corner.x, corner.y),
        "Tab or 1 to 4: choose a corner     Arrows: by a pixel, with Shift by ten".to_owned(),
        "Ctrl+Z undo     M mirror     R turn     Home start anew".to_owned(),
        format!("+ and - brightness, now {} %     T check page", light.percent()),
        "F full screen     N next screen     C or Esc: done".to_owned(),
    ]
}

/// Shows `lines` in the middle of the picture.
fn help(ui: &Ui, picture: Picture, lines: Vec<String>) {
    let size = (picture.area.width() / 75.0).clamp(11.0, 24.0);
    let (height, first) = (1.5 * size, 0.5 * (lines.len() as f32 - 1.0));
    let middle = picture.area.center();
    let half = vec2(18.0 * size, height * (first + 1.0));
    let ground = Rect::from_center_size(middle, 2.0 * half);
    ui.painter().rect_filled(ground, 10.0, Color32::from_black_alpha(220));
    for (index, line) in lines.into_iter().enumerate() {
        let at = pos2(middle.x, middle.y + (index as f32 - first) * height);
        ui.painter().text(at, Align2::CENTER_CENTER, line, FontId::proportional(size), Color32::WHITE);
    }
}
