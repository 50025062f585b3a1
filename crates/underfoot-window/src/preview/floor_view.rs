//! The floor in the middle of the window, and the mouse on it.

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{
    Align2, CursorIcon, Event, EventFilter, FontId, Key, MouseWheelSource, MouseWheelUnit, PointerButton,
    Pos2, Rect, Response, Sense, Ui, WidgetInfo, pos2, vec2,
};
use glam::Vec2;

use super::app::App;
use super::feet::{Hand, MouseFeet, Move};
use super::off_hint::why_off;
use super::pointer::{pressed_at, way_while_down};
use super::touches::Touch;
use super::watch::{Banner, Weight};
use super::zoom::Zoom;
use underfoot::floor::TileId;
use underfoot::widget::{Behaviour, Value};
use underfoot_scene::egui_painter::{self, ScreenFromFloor, color};
use underfoot_scene::scene::{self, Show, Theme, View};

/// Radius of the standing foot's handle, in points: easy to hit with a mouse.
const HANDLE: f32 = 13.0;

/// Turn for each point that the mouse moves sideways with the right button, in radians.
const TURN_PER_POINT: f32 = 0.012;

/// Turn while Q or E is held, in radians per second.
const TURN_PER_S: f32 = 1.8;

/// The state of the mouse on the standing foot.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Grip {
    /// Whether the mouse drags it.
    held: bool,
    /// The position of its handle, while the pointer is near.
    handle: Option<Pos2>,
}

impl App {
    /// Fills the remaining part of the window with the floor.
    pub(super) fn floor_view(&mut self, ui: &mut Ui) {
        let rect = ui.available_rect_before_wrap();
        let canvas = ui.allocate_rect(rect, Sense::drag());
        canvas.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, "Floor"));
        let show = self.show;
        self.zoom_by_wheel(ui, &canvas, show);
        let map = self.zoom.map(scene::extent(&self.floor.geometry, show), rect.shrink(6.0));
        self.look_at_tiles(ui, &canvas, map);
        self.draw_walk(ui, &canvas, map);
        let on_handle = self.move_feet(ui, &canvas, map);
        self.draw(ui, rect, map, show);
        self.show_walks(ui, rect, map);
        self.show_check(ui, rect, map);
        self.name_controls(ui, map);
        if self.zoom.is_closer() {
            self.zoom_out_button(ui, rect);
        }
        if let Some(at) = self.grip.handle {
            self.draw_handle(ui, rect, at);
        }
        if self.feet.is_some() && canvas.contains_pointer() {
            ui.ctx().set_cursor_icon(if on_handle { CursorIcon::Grab } else { CursorIcon::Crosshair });
            if !self.draws_walks() {
                self.read_out(ui, rect, on_handle);
            }
        }
        let link = self.snapshots.output_buffer().link;
        if let Some(banner) = self.watch.banner(self.now_s, link, &self.source, self.server.as_ref()) {
            show_banner(ui, rect, &self.theme, &banner);
        }
    }

    /// The shoes that press, as the floor reports them, and the mouse's own while it is in the air.
    fn visible_shoes(&mut self) {
        let Some((feet, _)) = &self.feet else { return };
        if self.shoe_feed.is_none() {
            self.shoes.clear();
        }
        self.shoes.retain(|shoe| shoe.force.0 > 0.0);
        let is_led = self.shoes.is_empty();
        self.shoes.extend(feet.shoes().iter().filter(|shoe| is_led || shoe.force.0 == 0.0));
    }

    fn draw(&mut self, ui: &Ui, rect: Rect, map: ScreenFromFloor, show: Show) {
        self.visible_shoes();
        let view = View {
            show,
            shoes: &self.shoes,
            levels: self.scopes.levels(),
            trails: self.trails.all(),
            chosen: self.selection.pinned(),
            ..View::new(
                &self.floor.geometry,
                &self.messages.layout,
                self.snapshots.output_buffer(),
                &self.theme,
            )
        };
        scene::draw(&mut self.scene, &view);
        let painter = ui.painter_at(rect);
        egui_painter::paint(&painter, &mut self.palette, &self.scene, map);
    }

    /// Ctrl with the wheel, and a pinch, zoom about the pointer; the middle button pans.
    fn zoom_by_wheel(&mut self, ui: &Ui, canvas: &Response, show: Show) {
        let Some(pointer) = ui.input(|i| i.pointer.hover_pos()).filter(|_| canvas.contains_pointer()) else {
            return;
        };
        let (by, panned) = ui.input(|i| {
            // Fingers on the floor are feet, even two of them.
            let zoomed = if i.any_touches() { 1.0 } else { i.zoom_delta() };
            (zoomed, way_while_down(i, PointerButton::Middle))
        });
        let screen = canvas.rect.shrink(6.0);
        let extent = scene::extent(&self.floor.geometry, show);
        if by != 1.0 {
            self.zoom.about(pointer, by, extent, screen);
        }
        if panned != egui::Vec2::ZERO {
            self.zoom.pan(panned, screen);
        }
    }

    fn zoom_out_button(&mut self, ui: &mut Ui, rect: Rect) {
        let area = Rect::from_min_size(rect.left_top() + vec2(10.0, 10.0), vec2(84.0, 26.0));
        let button = ui.put(area, egui::Button::new(format!("{:.0} % · fit", 100.0 * self.zoom.by())));
        if button.on_hover_text("Show the whole floor").clicked() {
            self.zoom = Zoom::default();
        }
    }

    /// Selects the tile and the control for the side panel.
    fn look_at_tiles(&mut self, ui: &Ui, canvas: &Response, map: ScreenFromFloor) {
        let (pressed, shift, pointer) =
            ui.input(|i| (i.pointer.primary_pressed(), i.modifiers.shift, i.pointer.interact_pos()));
        if let (true, Some(pointer)) = (pressed && canvas.contains_pointer(), pointer)
            && (shift || self.feet.is_none())
            && let Some(tile) = self.floor.geometry.tile_under(map.floor(pointer))
        {
            self.selection.pin(tile);
            let (at, page) = (map.floor(pointer), self.snapshots.output_buffer().page);
            let layout = &self.messages.layout;
            if let Some(widget) = layout.widget_at(page, at).and_then(|index| layout.widgets.get(index)) {
                self.selection.pin_control(widget.id.clone());
            }
        }
        if ui.ctx().memory(|memory| memory.focused().is_none()) {
            for (key, east, north) in [
                (Key::ArrowLeft, -1, 0),
                (Key::ArrowRight, 1, 0),
                (Key::ArrowDown, 0, -1),
                (Key::ArrowUp, 0, 1),
            ] {
                if ui.input(|i| i.key_pressed(key)) {
                    let tile = self.selection.tile();
                    let moved = TileId::new(
                        tile.column.saturating_add_signed(east),
                        tile.row.saturating_add_signed(north),
                    );
                    if self.floor.geometry.index(moved).is_some() {
                        self.selection.pin(moved);
                    }
                }
            }
        }
    }

    /// Moves the simulated feet; returns whether the pointer is on the standing foot's handle.
    fn move_feet(&mut self, ui: &mut Ui, canvas: &Response, map: ScreenFromFloor) -> bool {
        let draws_walks = self.draws_walks();
        let Some((feet, sink)) = &mut self.feet else { return false };
        let (on_handle, drag) =
            stand_and_drag(ui, canvas, map, feet, &mut self.grip, self.floor.geometry.bounds());
        let mut hand = read_hand(ui, canvas, map);
        hand.on_handle = on_handle;
        hand.drag = drag;
        if self.grip.held {
            hand.moves.clear();
        }
        if draws_walks {
            hand.moves.clear();
            hand.pointer = None;
        }
        if ui.input(|i| i.events.contains(&Event::WindowFocused(false))) {
            feet.lift_working();
            hand.moves.clear();
            hand.touches.clear();
        }
        if let Some(key) = self.keyboard.hand(ui, &self.messages.layout, hand.elapsed_s) {
            let touches = std::mem::take(&mut hand.touches);
            hand = Hand { touches, ..key };
        }
        feet.step(&hand, sink.as_mut());
        on_handle || self.grip.held
    }

    /// Draws a disc with a cross of arrows: the standing foot can be moved.
    fn draw_handle(&self, ui: &Ui, rect: Rect, at: Pos2) {
        let (painter, theme) = (ui.painter_at(rect), &self.theme);
        let edge = egui::Stroke::new(1.5, color(if self.grip.held { theme.accent } else { theme.ink }));
        painter.circle(at, HANDLE - 2.0, color(theme.plate), edge);
        for way in [vec2(1.0, 0.0), vec2(0.0, 1.0), vec2(-1.0, 0.0), vec2(0.0, -1.0)] {
            let tip = at + way * 7.0;
            painter.line_segment([at, tip], edge);
            for side in [1.0, -1.0] {
                painter.line_segment([tip, tip - way * 2.5 + way.rot90() * 2.5 * side], edge);
            }
        }
    }

    /// Draws force and heading of the foot under the pointer, beside the pointer.
    fn read_out(&self, ui: &Ui, rect: Rect, on_handle: bool) {
        let (Some((feet, _)), Some(pointer)) = (&self.feet, ui.input(|i| i.pointer.hover_pos())) else {
            return;
        };
        let (force, heading) = feet.wanted(on_handle);
        let mut text = format!("{:.0} N", force.0);
        let degrees = heading.to_degrees().round();
        if degrees != 0.0 {
            let way = if degrees > 0.0 { "left" } else { "right" };
            text.push_str(&format!(" · {:.0}° {way}", degrees.abs()));
        }
        let pressing = feet.is_pressing() || on_handle;
        let theme = &self.theme;
        let (ground, ink) = if pressing { (theme.ink, theme.plate) } else { (theme.plate, theme.ink) };
        let painter = ui.painter_at(rect);
        let galley = painter.layout_no_wrap(text, FontId::proportional(13.0), color(ink));
        let size = galley.size() + vec2(14.0, 6.0);
        // South-east of the pointer, or on the other side at the edge of the view.
        let x = if pointer.x + 18.0 + size.x > rect.right() {
            pointer.x - 18.0 - size.x
        } else {
            pointer.x + 18.0
        };
        let y = (pointer.y + 18.0).min(rect.bottom() - size.y - 2.0);
        let plate = Rect::from_min_size(pos2(x, y), size);
        let edge = egui::Stroke::new(1.0, color(theme.quiet));
        painter.rect(plate, 6, color(ground), edge, egui::StrokeKind::Inside);
        painter.galley(plate.min + vec2(7.0, 3.0), galley, color(ink));
    }

    /// Gives screen readers and tests the name and state of each control on the floor.
    fn name_controls(&mut self, ui: &Ui, map: ScreenFromFloor) {
        let mut focused = None;
        let snapshot = self.snapshots.output_buffer();
        for (index, widget) in self.messages.layout.widgets.iter().enumerate() {
            let state = snapshot.widgets.get(index).copied().unwrap_or_default();
            if state.hidden {
                continue;
            }
            let id = ui.scope_id().with(("floor control", index));
            let node = ui.interact(map.rect(widget.area), id, Sense::focusable_noninteractive());
            let off = why_off(snapshot, index);
            if node.has_focus() {
                focused = Some(index);
                // Arrow keys slide the foot; they must not move the focus.
                let filter =
                    EventFilter { horizontal_arrows: true, vertical_arrows: true, ..EventFilter::default() };
                ui.memory_mut(|memory| memory.set_focus_lock_filter(node.id, filter));
                let edge = egui::Stroke::new(3.0, color(self.theme.cursor));
                ui.painter().rect_stroke(node.rect.expand(4.0), 8.0, edge, egui::StrokeKind::Outside);
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
        self.keyboard.focus(focused);
    }
}

/// Places or lifts the standing foot at the pointer on Space, and drags it by its handle or, with Alt, by its sole.
fn stand_and_drag(
    ui: &mut Ui,
    canvas: &Response,
    map: ScreenFromFloor,
    feet: &mut MouseFeet,
    grip: &mut Grip,
    floor: underfoot::floor::Rect,
) -> (bool, Vec2) {
    let pointer = ui.input(|i| i.pointer.interact_pos()).filter(|_| canvas.contains_pointer());
    let keys = ui.ctx().memory(|memory| memory.focused().is_none());
    if let (true, Some(pointer)) = (keys && ui.input(|i| i.key_pressed(Key::Space)), pointer) {
        let on_it =
            feet.standing().is_some_and(|shoe| map.point(shoe.position).distance(pointer) < 2.0 * HANDLE);
        if on_it {
            feet.lift_standing();
        } else {
            feet.stand(map.floor(pointer).clamp(floor.min, floor.max));
        }
    }
    let Some(shoe) = feet.standing().copied() else {
        *grip = Grip::default();
        return (false, Vec2::ZERO);
    };
    let middle = map.point(shoe.position);
    let handle = ui.interact(
        Rect::from_center_size(middle, egui::Vec2::splat(2.0 * HANDLE)),
        ui.scope_id().with("standing foot"),
        Sense::drag(),
    );
    handle.widget_info(|| WidgetInfo::labeled(Role::Button, true, "Standing foot"));
    let near = |pointer: Pos2, reach: f32| pointer.distance(middle) <= reach;
    let alt = ui.input(|i| i.modifiers.alt);
    let reach = if alt { 0.5 * shoe.length_m * map.scale() } else { HANDLE };
    let over = pointer.is_some_and(|pointer| near(pointer, reach)) && !feet.is_pressing();
    let began = ui.input(|i| pressed_at(i, PointerButton::Primary));
    let began = began.is_some_and(|at| near(at, reach) && canvas.rect.contains(at) && !feet.is_pressing());
    grip.handle = Some(middle).filter(|_| grip.held || pointer.is_some_and(|at| near(at, 5.0 * HANDLE)));
    grip.held |= began;
    let way = ui.input(|i| way_while_down(i, PointerButton::Primary));
    let drag = if grip.held { map.floor_vector(way) } else { Vec2::ZERO };
    let was_held = grip.held;
    grip.held &= ui.input(|i| i.pointer.primary_down());
    // Its middle stays on the floor, even if the mouse leaves it.
    let drag = (shoe.position + drag).clamp(floor.min, floor.max) - shoe.position;
    (over || was_held, drag)
}

fn read_hand(ui: &Ui, canvas: &Response, map: ScreenFromFloor) -> Hand {
    let inside = canvas.contains_pointer();
    let keys = ui.ctx().memory(|memory| memory.focused().is_none());
    let events = ui.input(|i| i.events.clone());
    // A press counts by its own position: with slow frames it may be much older than the pointer's present position.
    let is_floor = |at: Pos2| {
        canvas.rect.contains(at) && ui.ctx().layer_id_at(at).is_none_or(|layer| layer == ui.layer_id())
    };
    let moves = events.iter().filter_map(|event| match event {
        Event::PointerMoved(at) => Some(Move::To(map.floor(*at))),
        Event::PointerButton { pos, button: PointerButton::Primary, pressed: true, modifiers }
            if is_floor(*pos) && !modifiers.shift =>
        {
            Some(Move::Press(map.floor(*pos)))
        }
        Event::PointerButton { pos, button: PointerButton::Primary, pressed: false, .. } => {
            Some(Move::Release(map.floor(*pos)))
        }
        _ => None,
    });
    let moves = moves.collect();
    let touches = events.iter().filter_map(|event| Touch::of(event, |at| map.floor(at), is_floor)).collect();
    ui.input(|i| {
        let down = i.pointer.primary_down();
        // A press that began on the floor continues beyond its edge, as a foot would.
        let pointer = i.pointer.latest_pos().filter(|_| inside || down);
        let turned = if inside { way_while_down(i, PointerButton::Secondary).x } else { 0.0 };
        let key = |key: Key| f32::from(u8::from(keys && i.key_down(key)));
        let turning_s = i.stable_dt.clamp(0.0, 0.1);
        Hand {
            moves,
            touches,
            pointer: pointer.map(|at| map.floor(at)),
            down,
            wheel: if inside {
                notches(&events) + 8.0 * turning_s * (key(Key::R) - key(Key::F))
            } else {
                0.0
            },
            turn_rad: -turned * TURN_PER_POINT + (key(Key::Q) - key(Key::E)) * TURN_PER_S * turning_s,
            elapsed_s: i.unstable_dt,
            ..Hand::default()
        }
    })
}

/// The turn of the wheel, in notches.
fn notches(events: &[Event]) -> f32 {
    let notches = |event: &Event| match event {
        // The momentum of a touch pad after the fingers have left is not a change of force.
        Event::MouseWheel { source: MouseWheelSource::Momentum, .. } => 0.0,
        // The zoom uses these.
        Event::MouseWheel { modifiers, .. } if modifiers.command || modifiers.ctrl => 0.0,
        Event::MouseWheel { unit, delta, .. } => match unit {
            // A notch is about 50 points on a touch pad.
            MouseWheelUnit::Point => delta.y / 50.0,
            MouseWheelUnit::Line => delta.y,
            MouseWheelUnit::Page => delta.y * 5.0,
        },
        _ => 0.0,
    };
    events.iter().map(notches).sum::<f32>().clamp(-20.0, 20.0)
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
    let ink = color(if theme.is_dark() { theme.seam } else { theme.plate });
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
