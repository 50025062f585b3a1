//! The floor for a projector: a separate window that holds only the controls, fitted to the real floor by its
//! corners.
//!
//! This window is an output only. Feet use the controls on the floor itself; the corners move by mouse and keys of
//! this computer, and only in adjustment mode.

mod awake;
mod homography;
mod placement;

use std::path::PathBuf;

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{
    Align2, Color32, CursorIcon, Event, FontId, Key, PointerButton, Pos2, Rect, Sense, Stroke, Ui,
    ViewportBuilder, ViewportCommand, ViewportId, WidgetInfo, pos2, vec2,
};
use glam::{DVec2, Vec2};

use self::awake::Awake;
use self::placement::{Placement, usual_file};
use super::appearance::Appearance;
use super::messages::WindowMessages;
use super::shown::ShownFloor;
use underfoot_scene::egui_painter::{self, Palette, ScreenFromFloor, color};
use underfoot_scene::scene::{self, Scene, Show, Theme, View};

/// Radius of a corner's handle, in points.
const HANDLE: f32 = 22.0;

/// Distance that an arrow key moves a corner, in points; with Shift, and without.
const NUDGE: (f32, f32) = (10.0, 1.0);

/// The initial state of the projection.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ProjectionOptions {
    /// Whether its window opens at once, as full screen.
    pub open: bool,
    /// Whether the screen stays on while the window is open.
    pub keeps_awake: bool,
    /// The screen for full screen, numbered by the system from 0; `None` for the one on which it opens.
    pub monitor: Option<usize>,
    /// The file that stores the corners, in place of the usual one.
    pub corners: Option<PathBuf>,
}

/// The projector's window and its settings.
pub(super) struct Projection {
    is_open: bool,
    is_full: bool,
    monitor: Option<usize>,
    file: Option<PathBuf>,
    /// `None` until the picture's shape is known, if no file provides it.
    placement: Option<Placement>,
    /// Whether the user has set it; otherwise it follows the window, which gets its screen some frames after it
    /// opens.
    is_set: bool,
    /// The corner that keys move, in adjustment mode.
    adjusting: Option<usize>,
    /// The corner that the mouse holds, and its offset from the pointer, in points.
    held: Option<(usize, egui::Vec2)>,
    scene: Scene,
    palette: Palette,
    keeps_awake: bool,
    /// Present while the window is open and the screen must stay on.
    awake: Option<Awake>,
}

impl Projection {
    /// Uses `options`; also returns a message for the user if the file of corners cannot be used.
    pub(super) fn new(options: &ProjectionOptions) -> (Self, Option<String>) {
        let file = options.corners.clone().or_else(usual_file);
        let read = file.as_deref().map_or(Ok(None), Placement::load);
        let (placement, wrong) = read.map_or_else(|wrong| (None, Some(wrong)), |placement| (placement, None));
        let projection = Self {
            is_open: options.open,
            is_full: options.open || options.monitor.is_some(),
            monitor: options.monitor,
            file,
            is_set: placement.is_some(),
            placement,
            adjusting: None,
            held: None,
            scene: Scene::new(),
            palette: Palette::default(),
            keeps_awake: options.keeps_awake,
            awake: None,
        };
        (projection, wrong)
    }

    pub(super) fn is_open(&self) -> bool {
        self.is_open
    }

    /// Opens or closes the window.
    pub(super) fn toggle(&mut self) {
        self.is_open = !self.is_open;
        self.adjusting = None;
    }

    fn window(&self) -> ViewportBuilder {
        let window = ViewportBuilder::default()
            .with_title("underfoot: the floor")
            .with_app_id("underfoot")
            .with_inner_size([960.0, 720.0])
            .with_fullscreen(self.is_full);
        match self.monitor.filter(|_| self.is_full) {
            Some(monitor) => window.with_monitor(monitor),
            None => window,
        }
    }

    /// Handles the keys of this window; returns whether the placement has changed.
    fn handle_keys(&mut self, ui: &Ui, size: Vec2, floor: f32) -> bool {
        let pressed = |key: Key| ui.input(|i| i.key_pressed(key));
        if pressed(Key::Escape) && self.adjusting.is_some() {
            self.adjusting = None;
        } else if pressed(Key::Escape) || pressed(Key::F11) {
            self.toggle();
        }
        if pressed(Key::F) {
            self.is_full = !self.is_full;
        }
        if pressed(Key::N) {
            (self.is_full, self.monitor) = (true, Some(self.monitor.map_or(0, |monitor| (monitor + 1) % 8)));
        }
        if pressed(Key::C) {
            self.adjusting = if self.adjusting.is_some() { None } else { Some(0) };
        }
        let (Some(placement), Some(selected)) = (&mut self.placement, &mut self.adjusting) else {
            return false;
        };
        let before = *placement;
        for (index, key) in [Key::Num1, Key::Num2, Key::Num3, Key::Num4].into_iter().enumerate() {
            if pressed(key) {
                *selected = index;
            }
        }
        placement.mirrored ^= pressed(Key::M);
        placement.quarter_turns = (placement.quarter_turns + u8::from(pressed(Key::R))) % 4;
        if pressed(Key::Home) {
            *placement = Placement::fit(floor, size.x / size.y);
        }
        let by = if ui.input(|i| i.modifiers.shift) { NUDGE.0 } else { NUDGE.1 };
        for (key, way) in [
            (Key::ArrowLeft, Vec2::NEG_X),
            (Key::ArrowRight, Vec2::X),
            (Key::ArrowUp, Vec2::NEG_Y),
            (Key::ArrowDown, Vec2::Y),
        ] {
            if pressed(key) {
                *placement = placement.moved(*selected, placement.corners[*selected] + way * by / size);
            }
        }
        *placement != before
    }

    /// Shows handles at the corners; returns whether a corner was moved and released.
    fn adjust(&mut self, ui: &mut Ui, theme: &Theme, picture: Rect, size: Vec2) -> bool {
        if self.adjusting.is_none() || self.placement.is_none() {
            self.held = None;
            return false;
        }
        let let_go = self.drag_corners(&ui.input(|i| i.events.clone()), picture, size);
        let (Some(placement), Some(selected)) = (&self.placement, &self.adjusting) else { return let_go };
        let on_picture = |corner: Vec2| picture.min + vec2(corner.x, corner.y) * picture.size();
        for (index, corner) in placement.corners.into_iter().enumerate() {
            let area = handle_of(on_picture(corner), picture);
            let handle = ui.interact(area, ui.scope_id().with(("corner", index)), Sense::drag());
            handle.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Corner {}", index + 1)));
        }
        let painter = ui.painter();
        let line = color(theme.cursor);
        let corners = placement.corners.map(on_picture);
        for (index, &corner) in corners.iter().enumerate() {
            painter.line_segment([corner, corners[(index + 1) % 4]], Stroke::new(2.0, line));
            let shown = handle_of(corner, picture).center();
            let fill = if index == *selected { line } else { Color32::BLACK };
            painter.circle(shown, HANDLE - 2.0, fill, Stroke::new(2.0, line));
            let number = format!("{}", index + 1);
            painter.text(shown, Align2::CENTER_CENTER, number, FontId::proportional(20.0), Color32::WHITE);
        }
        help(ui, picture);
        let_go
    }

    /// Moves corners event by event: a window with slow frames gets press, drag and release at once. Returns whether
    /// a corner was released.
    fn drag_corners(&mut self, events: &[Event], picture: Rect, size: Vec2) -> bool {
        let mut let_go = false;
        for event in events {
            let (to, is_release) = match event {
                Event::PointerMoved(to) => (*to, false),
                Event::PointerButton { pos, button: PointerButton::Primary, pressed, .. } => {
                    if *pressed {
                        self.take_corner(*pos, picture);
                    }
                    (*pos, !*pressed)
                }
                _ => continue,
            };
            let (Some(placement), Some((index, beside))) = (&mut self.placement, self.held) else { continue };
            let corner = (to + beside - picture.min) / picture.size();
            let before = placement.corners.get(index).copied();
            let to = Vec2::new(corner.x, corner.y);
            // A corner that is only clicked stays unchanged, bit for bit.
            if before.is_some_and(|before| ((to - before) * size).length() > 1e-3) {
                *placement = placement.moved(index, to);
            }
            if is_release {
                (let_go, self.held) = (true, None);
            }
        }
        let_go
    }

    /// Grabs the corner with its handle at `pointer`, the topmost one.
    fn take_corner(&mut self, pointer: Pos2, picture: Rect) {
        let Some(placement) = &self.placement else { return };
        let corners = placement.corners.map(|corner| picture.min + vec2(corner.x, corner.y) * picture.size());
        let touched = corners
            .into_iter()
            .enumerate()
            .rev()
            .find(|(_, corner)| handle_of(*corner, picture).contains(pointer));
        if let Some((index, corner)) = touched {
            self.held = Some((index, corner - pointer));
            self.adjusting = Some(index);
        }
    }
}

/// The handle of a corner; for a corner beyond the picture, it is at the edge.
fn handle_of(corner: Pos2, picture: Rect) -> Rect {
    Rect::from_center_size(picture.shrink(HANDLE).clamp(corner), egui::Vec2::splat(2.0 * HANDLE))
}

/// Shows how to adjust the corners, in the middle of the picture.
fn help(ui: &Ui, picture: Rect) {
    let lines = [
        "Drag each corner onto the floor’s own corner",
        "1 to 4 and arrows: by a point, with Shift by ten",
        "M mirror     R turn     Home start anew",
        "F full screen     N next screen",
        "C or Esc: done",
    ];
    let size = (picture.width() / 44.0).clamp(13.0, 30.0);
    let height = 1.5 * size;
    let middle = picture.center();
    let half = vec2(15.0 * size, 0.5 * height * (lines.len() as f32 + 1.0));
    ui.painter().rect_filled(
        Rect::from_center_size(middle, 2.0 * half),
        10.0,
        Color32::from_black_alpha(220),
    );
    for (index, line) in lines.into_iter().enumerate() {
        let at = pos2(middle.x, middle.y + (index as f32 - 2.0) * height);
        ui.painter().text(at, Align2::CENTER_CENTER, line, FontId::proportional(size), Color32::WHITE);
    }
}

impl Projection {
    /// Shows the projector's window while it is open; F11 opens and closes it.
    pub(super) fn show(&mut self, ui: &Ui, shown: &mut ShownFloor, appearance: &Appearance) {
        if ui.input(|i| i.key_pressed(Key::F11)) {
            self.toggle();
            ui.ctx().request_repaint();
            // On systems without several windows, the same key event would close it again.
            return;
        }
        self.stay_awake(&mut shown.messages);
        if !self.is_open {
            return;
        }
        let ctx = ui.ctx().clone();
        let window = self.window();
        ctx.show_viewport_immediate(ViewportId::from_hash_of("projection"), window, |ui, _| {
            self.project(ui, shown, &appearance.projected());
        });
        // On a computer with one screen, the projection covers the window that draws it.
        ctx.send_viewport_cmd_to(ViewportId::ROOT, ViewportCommand::RequestPaintWhileHidden);
    }

    fn project(&mut self, ui: &mut Ui, shown: &mut ShownFloor, theme: &Theme) {
        if ui.input(|i| i.viewport().close_requested()) {
            self.toggle();
            return;
        }
        let picture = ui.available_rect_before_wrap();
        let node = ui.interact(picture, ui.scope_id().with("projected floor"), Sense::hover());
        node.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, "Projected floor"));
        let size = Vec2::new(picture.width(), picture.height()).max(Vec2::ONE);
        let floor = shown.floor.geometry.bounds();
        let shape = floor.size().x / floor.size().y;
        let fit = Placement::fit(shape, size.x / size.y);
        if !self.is_set {
            self.placement = Some(fit);
        }
        let changed = self.handle_keys(ui, size, shape);
        ui.painter().rect_filled(picture, 0.0, color(theme.canvas));
        self.draw(ui, theme, shown, picture, size);
        let moved = self.adjust(ui, theme, picture, size);
        self.is_set = self.placement != Some(fit);
        if self.adjusting.is_none() {
            ui.ctx().set_cursor_icon(CursorIcon::None);
        }
        if changed || moved {
            self.keep_placement(&mut shown.messages);
        }
    }

    fn draw(&mut self, ui: &Ui, theme: &Theme, shown: &ShownFloor, picture: Rect, size: Vec2) {
        let floor = shown.floor.geometry.bounds();
        let homography = self.placement.and_then(|placement| placement.floor_to_picture(floor, size));
        let Some(homography) = homography else { return };
        let view = View {
            show: Show::PROJECTOR,
            ..View::new(&shown.floor.geometry, shown.layout(), shown.snapshot(), theme)
        };
        scene::draw(&mut self.scene, &view);
        let map = ScreenFromFloor::fit(floor, picture);
        let onto = |at: Pos2| {
            let place = homography.map(map.floor(at).as_dvec2());
            picture.min + vec2(place.x as f32, place.y as f32)
        };
        let Self { palette, scene, .. } = self;
        egui_painter::paint_warped(&ui.painter_at(picture), palette, scene, map, onto);
        // For tests and screen readers: the place of each control on the picture.
        let snapshot = shown.snapshot();
        for (index, widget) in shown.layout().widgets.iter().enumerate() {
            if snapshot.widgets.get(index).is_some_and(|state| state.hidden) {
                continue;
            }
            let corner = |at: Vec2| {
                let at: DVec2 = homography.map(at.as_dvec2());
                picture.min + vec2(at.x as f32, at.y as f32)
            };
            let area = widget.area;
            let others = [Vec2::new(area.min.x, area.max.y), Vec2::new(area.max.x, area.min.y), area.max];
            let around = others.into_iter().fold(Rect::from_pos(corner(area.min)), |mut around, at| {
                around.extend_with(corner(at));
                around
            });
            let node = ui.interact(around, ui.scope_id().with(("projected", index)), Sense::hover());
            let name = if widget.label.is_empty() { widget.id.as_str() } else { &widget.label };
            node.widget_info(|| WidgetInfo::labeled(Role::Label, true, format!("Projected {name}")));
        }
    }

    /// While feet use a projected floor, keys and mouse are idle, so the screen would go dark.
    fn stay_awake(&mut self, messages: &mut WindowMessages) {
        let wanted = self.is_open && self.keeps_awake;
        let awake = &mut self.awake;
        match awake {
            None if wanted => *awake = Some(Awake::begin()),
            Some(_) if !wanted => *awake = None,
            _ => {}
        }
        if let Some(why) = awake.as_ref().and_then(Awake::failure) {
            messages.note(format!("The screen may go dark while the floor is projected: {why}"));
        }
    }

    fn keep_placement(&self, messages: &mut WindowMessages) {
        let (Some(placement), Some(file)) = (self.placement, &self.file) else { return };
        if let Err(wrong) = placement.save(file) {
            messages.note(format!("The corners are not remembered: {wrong}"));
        }
    }
}
