//! The feet on the floor: those that mouse, fingers and keyboard move, and those that the floor reports.

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{
    Event, FontId, Key, MouseWheelSource, MouseWheelUnit, PointerButton, Pos2, Rect, Response, Sense, Ui,
    WidgetInfo, pos2, vec2,
};
use glam::Vec2;

use crate::preview::feed::{FootSink, ShoeFeed};
use crate::preview::feet::{HandInput, MouseFeet, Move};
use crate::preview::icons::Icon;
use crate::preview::keyboard::Keyboard;
use crate::preview::pointer::{pressed_at, way_while_down};
use crate::preview::shown::ShownFloor;
use crate::preview::style::switch_button;
use crate::preview::touches::FloorTouch;
use underfoot_scene::egui_painter::{ScreenFromFloor, color};
use underfoot_scene::scene::{Shoe, Theme};

/// Radius of the standing foot's handle, in points: easy to hit with a mouse.
const HANDLE: f32 = 13.0;

/// Turn for each point that the mouse moves sideways with the right button, in radians.
const TURN_PER_POINT: f32 = 0.012;

/// Turn while Q or E is held, in radians per second.
const TURN_PER_S: f32 = 1.8;

/// The state of the mouse on the standing foot.
#[derive(Clone, Copy, Debug, Default)]
struct Grip {
    /// Whether the mouse drags it.
    held: bool,
    /// The position of its handle, while the pointer is near.
    handle: Option<Pos2>,
}

/// The feet on the floor.
pub(in crate::preview) struct FloorFeet {
    /// The feet of the mouse, and their floor; `None` unless the floor is simulated.
    mouse: Option<(MouseFeet, Box<dyn FootSink>)>,
    /// The feet on the floor, as the floor reports them.
    feed: Option<ShoeFeed>,
    /// The shoes on display.
    shoes: Vec<Shoe>,
    grip: Grip,
    keyboard: Keyboard,
}

impl FloorFeet {
    pub(in crate::preview) fn new(sink: Option<Box<dyn FootSink>>, feed: Option<ShoeFeed>) -> Self {
        Self {
            mouse: sink.map(|sink| (MouseFeet::new(), sink)),
            feed,
            shoes: Vec::new(),
            grip: Grip::default(),
            keyboard: Keyboard::default(),
        }
    }

    /// Whether the mouse moves feet.
    pub(in crate::preview) fn are_led(&self) -> bool {
        self.mouse.is_some()
    }

    /// The place of the standing foot, in floor metres, if it is down.
    pub(in crate::preview) fn standing_at(&self) -> Option<Vec2> {
        self.mouse.as_ref().and_then(|(feet, _)| feet.standing()).map(|shoe| shoe.position)
    }

    /// The shoes on display.
    pub(super) fn shoes(&self) -> &[Shoe] {
        &self.shoes
    }

    /// Takes in the shoes that the floor reports.
    pub(in crate::preview) fn receive(&mut self) {
        if let Some(feed) = &mut self.feed {
            feed(&mut self.shoes);
        }
    }

    /// Sets the control with the keyboard focus, if any.
    pub(super) fn focus(&mut self, control: Option<usize>) {
        self.keyboard.focus(control);
    }

    /// Lifts all feet of the mouse.
    pub(in crate::preview) fn lift(&mut self) {
        if let Some((feet, sink)) = &mut self.mouse {
            feet.lift_working();
            feet.lift_standing();
            sink.lead(0.0, &[]);
        }
    }

    /// A button that places the standing foot, or lifts it; a compact one has an icon alone.
    pub(in crate::preview) fn stance_button(&mut self, ui: &mut Ui, shown: &ShownFloor, is_compact: bool) {
        let Some((feet, _)) = &mut self.mouse else { return };
        let stands = feet.standing().is_some();
        let hint = "A second foot that stays where it is left; Space puts it under the mouse";
        if switch_button(ui, stands, Icon::Footprints, "Stance foot", is_compact, hint) {
            if stands {
                feet.lift_standing();
            } else {
                let floor = shown.floor.geometry.bounds();
                let place = shown.layout().stances.first().map(|stance| stance.area);
                // The usual place to stand without one in the layout: the middle of the south side.
                let south = floor.min + floor.size() * Vec2::new(0.5, 0.12);
                feet.stand(place.map_or(south, |area| area.centre()).clamp(floor.min, floor.max));
            }
        }
    }

    /// Updates the shoes on display: those that press, as the floor reports them, and the mouse's own while it is in
    /// the air.
    pub(super) fn update_shoes(&mut self) {
        let Some((feet, _)) = &self.mouse else { return };
        if self.feed.is_none() {
            self.shoes.clear();
        }
        self.shoes.retain(|shoe| shoe.force.0 > 0.0);
        let is_led = self.shoes.is_empty();
        self.shoes.extend(feet.shoes().iter().filter(|shoe| is_led || shoe.force.0 == 0.0));
    }

    /// Moves the simulated feet; returns whether the pointer is on the standing foot's handle. While it
    /// draws walks, the mouse is not a foot.
    pub(super) fn follow(
        &mut self,
        ui: &mut Ui,
        canvas: &Response,
        map: ScreenFromFloor,
        shown: &ShownFloor,
        draws_walks: bool,
    ) -> bool {
        let Some((feet, sink)) = &mut self.mouse else { return false };
        let (on_handle, drag) =
            stand_and_drag(ui, canvas, map, feet, &mut self.grip, shown.floor.geometry.bounds());
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
        if let Some(key) = self.keyboard.hand(ui, shown.layout(), hand.elapsed_s) {
            let touches = std::mem::take(&mut hand.touches);
            hand = HandInput { touches, ..key };
        }
        feet.step(&hand, sink.as_mut());
        on_handle || self.grip.held
    }

    /// Draws a disc with a cross of arrows: the standing foot can be moved.
    pub(super) fn draw_handle(&self, ui: &Ui, rect: Rect, theme: &Theme) {
        let Some(at) = self.grip.handle else { return };
        let painter = ui.painter_at(rect);
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
    pub(super) fn read_out(&self, ui: &Ui, rect: Rect, theme: &Theme, on_handle: bool) {
        let (Some((feet, _)), Some(pointer)) = (&self.mouse, ui.input(|i| i.pointer.hover_pos())) else {
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

fn read_hand(ui: &Ui, canvas: &Response, map: ScreenFromFloor) -> HandInput {
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
    let touches =
        events.iter().filter_map(|event| FloorTouch::of(event, |at| map.floor(at), is_floor)).collect();
    ui.input(|i| {
        let down = i.pointer.primary_down();
        // A press that began on the floor continues beyond its edge, as a foot would.
        let pointer = i.pointer.latest_pos().filter(|_| inside || down);
        let turned = if inside { way_while_down(i, PointerButton::Secondary).x } else { 0.0 };
        let key = |key: Key| f32::from(u8::from(keys && i.key_down(key)));
        let turning_s = i.stable_dt.clamp(0.0, 0.1);
        HandInput {
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
            ..HandInput::default()
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
