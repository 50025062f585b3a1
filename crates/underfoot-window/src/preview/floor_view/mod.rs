//! The floor in the middle of the window, and the mouse on it.

mod feet;
mod first_steps;

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{
    Align2, CursorIcon, EventFilter, FontId, Id, Key, PointerButton, Pos2, Rect, Response, Sense, Ui,
    WidgetInfo, vec2,
};

pub(super) use feet::FloorFeet;
pub(super) use first_steps::FirstSteps;

use super::floor_check::FloorCheck;
use super::near_misses::{NearMiss, NearMissWatch};
use super::off_hint::why_off;
use super::pointer::way_while_down;
use super::selection::Selection;
use super::shown::ShownFloor;
use super::trails::Trails;
use super::walks::Walks;
use super::watch::{Banner, Weight};
use super::zoom::{ViewRoom, Zoom};
use underfoot::floor::{self, TileId};
use underfoot::layout::Layout;
use underfoot::widget::{Behaviour, Value};
use underfoot_scene::egui_painter::{self, Palette, ScreenFromFloor, color};
use underfoot_scene::scene::{self, Scene, Shoe, Show, Theme, View};

/// The view of the floor.
pub(super) struct FloorPane {
    pub(super) zoom: Zoom,
    /// The zoom at which the whole floor fills the part of the window that panels leave free.
    whole: Zoom,
    /// The controls on the screen, in their order for the keyboard.
    controls: Vec<Id>,
    scene: Scene,
    pub(super) palette: Palette,
    /// The layers over the floor.
    pub(super) show: Show,
    pub(super) trails: Trails,
    /// The presses beside controls.
    pub(super) misses: NearMissWatch,
    /// The first steps of a new user.
    pub(super) steps: FirstSteps,
}

/// The parts of the window that act on the floor by the mouse.
pub(super) struct OnFloor<'a> {
    pub(super) feet: &'a mut FloorFeet,
    pub(super) selection: &'a mut Selection,
    pub(super) walks: Option<&'a mut Walks>,
    pub(super) check: Option<&'a FloorCheck>,
    /// Whether the first steps are shown.
    pub(super) has_steps: bool,
}

impl FloorPane {
    /// A view with these layers.
    pub(super) fn new(show: Show) -> Self {
        Self {
            zoom: Zoom::default(),
            whole: Zoom::default(),
            controls: Vec::new(),
            scene: Scene::new(),
            palette: Palette::default(),
            show,
            trails: Trails::default(),
            misses: NearMissWatch::default(),
            steps: FirstSteps::default(),
        }
    }

    /// The controls of the last frame, in their order for the keyboard.
    pub(super) fn controls(&self) -> &[Id] {
        &self.controls
    }

    /// Fills the remaining part of the window with the floor, fitted into `room`.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        shown: &ShownFloor,
        on_floor: OnFloor<'_>,
        room: ViewRoom,
    ) {
        let OnFloor { feet, selection, mut walks, check, has_steps } = on_floor;
        let rect = ui.available_rect_before_wrap();
        let canvas = ui.allocate_rect(rect, Sense::drag());
        canvas.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, "Floor"));
        let extent = scene::extent(&shown.floor.geometry, self.show);
        self.zoom_by_wheel(ui, &canvas, extent, room);
        let map = self.zoom.map(extent, room.stage);
        look_at_tiles(ui, &canvas, map, shown, selection, feet.are_led());
        if let Some(walks) = &mut walks {
            walks.draw(ui, &canvas, map, shown);
        }
        let draws_walks = walks.as_ref().is_some_and(|walks| walks.are_drawn);
        let on_handle = feet.follow(ui, &canvas, map, shown, draws_walks);
        feet.update_shoes();
        self.draw(ui, rect, map, theme, shown, (feet.shoes(), selection.pinned()));
        if let Some(walks) = &walks {
            walks.show(ui, rect, map, shown, theme);
        }
        if let Some(check) = check {
            check.show_marks(ui, rect, map, theme, &shown.floor);
        }
        feet.focus(name_controls(ui, map, shown, &mut self.controls));
        if has_steps && !draws_walks {
            let written = self.scene.written().map(|area| map.rect(area));
            self.steps.show(ui, rect, map, theme, shown, written);
        }
        self.whole = Zoom::fitted(extent, room);
        feet.draw_handle(ui, rect, theme);
        if feet.are_led() && canvas.contains_pointer() {
            ui.ctx().set_cursor_icon(if on_handle { CursorIcon::Grab } else { CursorIcon::Crosshair });
            if !draws_walks {
                feet.read_out(ui, rect, theme, on_handle);
            }
        }
        if let Some(banner) = shown.banner() {
            show_banner(ui, rect, theme, &banner);
        }
    }

    fn draw(
        &mut self,
        ui: &Ui,
        rect: Rect,
        map: ScreenFromFloor,
        theme: &Theme,
        shown: &ShownFloor,
        (shoes, chosen): (&[Shoe], Option<TileId>),
    ) {
        let misses: Vec<scene::PressBeside> =
            self.misses.latest().into_iter().map(|miss| beside(miss, shown.layout())).collect();
        let view = View {
            show: self.show,
            shoes,
            levels: shown.scopes.levels(),
            trails: self.trails.all(),
            chosen,
            near_misses: &misses,
            ..View::new(&shown.floor.geometry, shown.layout(), shown.snapshot(), theme)
        };
        scene::draw(&mut self.scene, &view);
        let painter = ui.painter_at(rect);
        egui_painter::paint(&painter, &mut self.palette, &self.scene, map);
    }

    /// Ctrl with the wheel, and a pinch, zoom about the pointer; the middle button pans.
    fn zoom_by_wheel(&mut self, ui: &Ui, canvas: &Response, extent: floor::Rect, room: ViewRoom) {
        let Some(pointer) = ui.input(|i| i.pointer.hover_pos()).filter(|_| canvas.contains_pointer()) else {
            return;
        };
        let (by, panned) = ui.input(|i| {
            // Fingers on the floor are feet, even two of them.
            let zoomed = if i.any_touches() { 1.0 } else { i.zoom_delta() };
            (zoomed, way_while_down(i, PointerButton::Middle))
        });
        if by != 1.0 {
            self.zoom.about(pointer, by, extent, room);
        }
        if panned != egui::Vec2::ZERO {
            self.zoom.pan(panned, room);
        }
    }

    /// A button that shows the whole floor in the part of the window that panels leave free, unless it is on display.
    pub(super) fn fit_button(&mut self, ui: &mut Ui) {
        if self.zoom.is_close_to(self.whole) {
            return;
        }
        let button =
            egui::Button::new(format!("{:.0} % · fit", 100.0 * self.zoom.by())).min_size(vec2(84.0, 26.0));
        if ui.add(button).on_hover_text("Show the whole floor").clicked() {
            self.zoom = self.whole;
        }
    }
}

/// The drawing of a press beside a control.
fn beside(miss: &NearMiss, layout: &Layout) -> scene::PressBeside {
    let widget = layout.widgets.iter().find(|widget| widget.id == miss.id);
    scene::PressBeside {
        at: miss.at,
        place: miss.place,
        control: widget.map(|widget| widget.area),
        text: miss.text.clone(),
    }
}

/// Selects the tile and the control for the side panel, by a click or by arrow keys. With `needs_shift`, a click
/// without Shift is a step.
fn look_at_tiles(
    ui: &Ui,
    canvas: &Response,
    map: ScreenFromFloor,
    shown: &ShownFloor,
    selection: &mut Selection,
    needs_shift: bool,
) {
    let (pressed, shift, pointer) =
        ui.input(|i| (i.pointer.primary_pressed(), i.modifiers.shift, i.pointer.interact_pos()));
    if let (true, Some(pointer)) = (pressed && canvas.contains_pointer(), pointer)
        && (shift || !needs_shift)
        && let Some(tile) = shown.floor.geometry.tile_under(map.floor(pointer))
    {
        selection.pin(tile);
        let (at, page) = (map.floor(pointer), shown.snapshot().page);
        let layout = shown.layout();
        if let Some(widget) = layout.widget_at(page, at).and_then(|index| layout.widgets.get(index)) {
            selection.pin_control(widget.id.clone());
        }
    }
    if ui.ctx().memory(|memory| memory.focused().is_none()) {
        for (key, east, north) in
            [(Key::ArrowLeft, -1, 0), (Key::ArrowRight, 1, 0), (Key::ArrowDown, 0, -1), (Key::ArrowUp, 0, 1)]
        {
            if ui.input(|i| i.key_pressed(key)) {
                let tile = selection.tile();
                let moved = TileId::new(
                    tile.column.saturating_add_signed(east),
                    tile.row.saturating_add_signed(north),
                );
                if shown.floor.geometry.index(moved).is_some() {
                    selection.pin(moved);
                }
            }
        }
    }
}

/// Gives screen readers, tests and scripts the place of the floor, and the name and state of each control on it; returns
/// the index of the control with the keyboard focus.
fn name_controls(ui: &Ui, map: ScreenFromFloor, shown: &ShownFloor, controls: &mut Vec<Id>) -> Option<usize> {
    let bounds = map.rect(shown.floor.geometry.bounds());
    let floor = ui.interact(bounds, ui.scope_id().with("floor"), Sense::hover());
    floor.widget_info(|| WidgetInfo::labeled(Role::Group, true, "Whole floor"));
    let mut focused = None;
    controls.clear();
    let snapshot = shown.snapshot();
    for (index, widget) in shown.layout().widgets.iter().enumerate() {
        let state = snapshot.widgets.get(index).copied().unwrap_or_default();
        if state.hidden {
            continue;
        }
        let id = ui.scope_id().with(("floor control", index));
        controls.push(id);
        // The focus gets these controls before all other widgets: see `FocusRing::begin`.
        let node = ui.interact(map.rect(widget.area), id, Sense::focusable_noninteractive());
        let off = why_off(snapshot, index);
        if node.has_focus() {
            focused = Some(index);
            // Arrow keys slide the foot; they must not move the focus.
            let filter =
                EventFilter { horizontal_arrows: true, vertical_arrows: true, ..EventFilter::default() };
            ui.memory_mut(|memory| memory.set_focus_lock_filter(node.id, filter));
        }
        node.widget_info(|| {
            let name = if widget.label.is_empty() { widget.id.as_str() } else { &widget.label };
            let enabled = !state.disabled && off.is_none();
            match (&widget.behaviour, state.value) {
                (Behaviour::Switch(_) | Behaviour::Hold(_), Some(Value::Switch(on))) => {
                    WidgetInfo::selected(Role::Switch, enabled, on, name)
                }
                (_, Some(Value::Number(value))) => WidgetInfo::slider(enabled, f64::from(value), name),
                _ => WidgetInfo::selected(Role::Button, enabled, state.pressed, name),
            }
        });
        if let Some(why) = off {
            node.on_hover_text_at_pointer(why);
        }
    }
    focused
}

/// Draws a prominent strip across the floor; a narrow one at its top if the floor still works.
fn show_banner(ui: &Ui, rect: Rect, theme: &Theme, banner: &Banner) {
    let colour = match banner.weight {
        Weight::Hint => theme.warning,
        Weight::Pause => theme.quiet,
        Weight::Fault => theme.fault,
    };
    let strip = match banner.weight {
        Weight::Hint => Rect::from_min_size(rect.min, vec2(rect.width(), 28.0)),
        Weight::Pause | Weight::Fault => Rect::from_center_size(rect.center(), vec2(rect.width(), 92.0)),
    };
    let strip = strip.intersect(rect);
    let painter = ui.painter_at(rect);
    painter.rect_filled(strip, 0, color(colour).gamma_multiply(0.94));
    let ink = color(theme.readable(theme.plate, colour));
    let write = |at: Pos2, size: f32, text: &str| {
        painter.text(at, Align2::CENTER_CENTER, text, FontId::proportional(size), ink);
    };
    let spoken = format!("{}. {}", banner.headline, banner.detail);
    let middle = strip.center();
    if banner.weight == Weight::Hint {
        write(middle, 13.5, &spoken);
    } else {
        // A narrow view gets smaller letters instead of clipped ones.
        let size = (rect.width() / 26.0).clamp(13.0, 24.0);
        write(middle - vec2(0.0, 14.0), size, &banner.headline);
        write(middle + vec2(0.0, 18.0), (0.62 * size).max(12.0), &banner.detail);
    }
    let node = ui.interact(strip, ui.scope_id().with("banner"), Sense::hover());
    node.widget_info(|| WidgetInfo::labeled(Role::Alert, true, &spoken));
}
