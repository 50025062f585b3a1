//! The window.

use std::time::Duration;

use eframe::egui::{
    self, Align2, Color32, Context, CornerRadius, FontId, Frame, Key, Margin, RawInput, Rect, Response,
    RichText, Sense, Shadow, Ui, Vec2, ViewportBuilder, ViewportCommand, ViewportId, pos2, vec2,
};
use underfoot::floor::{self, Geometry};
use underfoot::glam;
use underfoot::runtime::Snapshot;
use underfoot::scene::{Show, Theme};
use underfoot::sim::{Foot, FootHandle};
use underfoot::units::Newtons;
use underfoot::wire::LinkState;
use underfoot_egui::{FloorView, FootInput};

use crate::chart;
use crate::guide::Guide;

const INK: Color32 = Color32::from_rgb(0x2a, 0x28, 0x25);
const QUIET: Color32 = Color32::from_rgb(0x5d, 0x58, 0x50);
const CARD: Color32 = Color32::from_rgba_premultiplied(0xed, 0xea, 0xe5, 0xf2);

/// What lies between the edge of a card and what is on it, in points.
const EDGE: Vec2 = vec2(18.0, 14.0);

/// How wide the small floor is, in points.
const INSET: f32 = 330.0;

/// How often a map is drawn on which nothing moves.
const IDLE: Duration = Duration::from_millis(50);

/// What a mouse that plays the foot presses with.
const PRESS: Newtons = Newtons(120.0);

pub struct App {
    guide: Guide,
    geometry: Geometry,
    feet: FootInput,
    hand: Option<FootHandle>,
    /// Whether the mouse holds that foot down.
    is_played: bool,
    inset: FloorView,
    projected: FloorView,
    project: bool,
    drag: Vec2,
    levels: f64,
}

impl App {
    /// `free` is the part of the floor where feet drag the map; `hand` moves the foot of a simulated floor.
    pub fn new(
        context: &Context,
        guide: Guide,
        geometry: Geometry,
        free: floor::Rect,
        hand: Option<FootHandle>,
        project: bool,
    ) -> Self {
        FootInput::tune(context);
        context.set_theme(egui::Theme::Light);
        let inset =
            FloorView::new(Theme::LIGHT, Show { sensors: false, loads: false, ruler: false, ..Show::WINDOW });
        let projected = FloorView::new(Theme::DARK, Show::PROJECTOR);
        let feet = FootInput::new(free);
        let is_played = false;
        Self {
            guide,
            geometry,
            feet,
            hand,
            is_played,
            inset,
            projected,
            project,
            drag: Vec2::ZERO,
            levels: 0.0,
        }
    }

    /// The card in a corner that says where one is.
    fn title(&self, ui: &mut Ui, rect: Rect, snapshot: &Snapshot) {
        let camera = &self.guide.state.camera;
        let side = |degrees: f64, [plus, minus]: [&str; 2]| {
            format!("{:.1}° {}", degrees.abs(), if degrees < 0.0 { minus } else { plus })
        };
        let (north, east) = (side(camera.lat, ["N", "S"]), side(camera.lon, ["E", "W"]));
        card(ui, Rect::from_min_size(rect.min + vec2(24.0, 24.0), vec2(300.0, 10.0)), |ui| {
            ui.label(RichText::new(&self.guide.place).size(28.0).strong().color(INK));
            ui.label(
                RichText::new(format!("{north}   {east}   zoom {:.1}", camera.zoom)).size(15.0).color(QUIET),
            );
            let (colour, words) = match (snapshot.floor.link, snapshot.floor.contacts.is_empty()) {
                _ if self.guide.has_ended => (Theme::LIGHT.fault, "The floor is gone"),
                (LinkState::Lost, _) => (Theme::LIGHT.fault, "The floor is silent"),
                (LinkState::Waiting, _) => (Theme::LIGHT.warning, "Waiting for the floor"),
                (_, true) if self.hand.is_some() => {
                    (Theme::LIGHT.quiet, "Press the small floor with the mouse")
                }
                (_, true) => (Theme::LIGHT.quiet, "Step onto the floor"),
                (_, false) => return,
            };
            let colour = Color32::from_rgb(colour.red, colour.green, colour.blue);
            ui.label(RichText::new(words).size(15.0).color(colour));
        });
    }

    /// The small floor, and the mouse as a foot on it.
    fn floor(&mut self, ui: &mut Ui, rect: Rect, snapshot: &Snapshot) {
        let size = Vec2::splat(INSET);
        let outer = size + 2.0 * EDGE;
        let at = Rect::from_min_size(rect.max - outer - vec2(24.0, 24.0), outer);
        card(ui, at, |ui| {
            ui.set_max_size(size);
            let (response, map) = self.inset.ui(ui, &self.geometry, &snapshot.layout, &snapshot.floor);
            let Some(hand) = &mut self.hand else { return };
            let pressed = ui.interact(response.rect, response.id.with("mouse"), Sense::drag());
            let place = pressed.interact_pointer_pos().filter(|_| pressed.is_pointer_button_down_on());
            let foot = place.map(|at| foot_at(map.floor(at)));
            hand.lead(ui.input(|i| i.unstable_dt), vec![foot.into_iter().collect()]);
            self.is_played = pressed.is_pointer_button_down_on();
            if self.is_played {
                ui.ctx().request_repaint();
            }
        });
    }

    /// What a projector throws onto the floor, in a window of its own.
    fn projection(&mut self, context: &Context, snapshot: &Snapshot) {
        let builder = ViewportBuilder::default().with_title("Floor").with_inner_size([800.0, 800.0]);
        let id = ViewportId::from_hash_of("projection");
        let is_closed = context.show_viewport_immediate(id, builder, |ui, _| {
            ui.painter().rect_filled(ui.max_rect(), 0.0, Color32::BLACK);
            self.projected.ui(ui, &self.geometry, &snapshot.layout, &snapshot.floor);
            ui.input(|input| input.viewport().close_requested())
        });
        self.project &= !is_closed;
    }
}

impl eframe::App for App {
    fn raw_input_hook(&mut self, context: &Context, raw: &mut RawInput) {
        if raw.viewport_id != ViewportId::ROOT {
            return;
        }
        // egui has one pointer: while the mouse plays the foot, that foot can't be a pointer as well.
        if self.is_played {
            self.feet.cancel(context, raw);
        } else {
            self.feet.follow(context, &self.guide.floor, raw);
        }
    }

    /// Here and not in `ui`, which a window that is fully covered does not call: time goes on.
    fn logic(&mut self, context: &Context, _: &mut eframe::Frame) {
        let before = self.guide.state.camera;
        self.guide.turn(std::mem::take(&mut self.drag), std::mem::take(&mut self.levels));
        if before != self.guide.state.camera {
            context.request_repaint();
        }
        context.request_repaint_after(IDLE);
        if self.guide.has_ended && self.hand.is_none() {
            context.send_viewport_cmd(ViewportCommand::Close);
        }
    }

    fn ui(&mut self, ui: &mut Ui, _: &mut eframe::Frame) {
        let (rect, snapshot) = (ui.max_rect(), self.guide.floor.snapshot());
        let map = dragged(ui, &mut self.feet, rect);
        self.drag += map.drag_delta();
        if map.hovered() {
            self.levels += f64::from(ui.input(|input| input.smooth_scroll_delta().y)) / 200.0;
        }
        if ui.input(|input| input.key_pressed(Key::P)) {
            self.project = !self.project;
        }
        chart::paint(ui.painter(), rect, &self.guide.world, &self.guide.state);
        chart::scale_bar(
            ui.painter(),
            rect,
            &self.guide.state,
            pos2(rect.left() + 28.0, rect.bottom() - 28.0),
        );
        let below = pos2(rect.left() + 28.0, rect.bottom() - 6.0);
        let font = FontId::proportional(11.0);
        ui.painter().text(below, Align2::LEFT_BOTTOM, "Shapes: Natural Earth", font, QUIET);
        self.title(ui, rect, &snapshot);
        self.floor(ui, rect, &snapshot);
        if self.project {
            self.projection(&ui.ctx().clone(), &snapshot);
        }
    }
}

/// The map in `rect`, as it is dragged by feet or the mouse.
pub fn dragged(ui: &Ui, feet: &mut FootInput, rect: Rect) -> Response {
    let map = ui.interact(rect, ui.scope_id().with("map"), Sense::drag());
    map.widget_info(|| egui::WidgetInfo::labeled(egui::accesskit::Role::Image, true, "Map"));
    feet.set_target(rect);
    map
}

/// A foot that looks north and presses at `place`.
fn foot_at(place: glam::Vec2) -> Foot {
    let foot = Foot { position: place, heading: 0.0, length_m: 0.27, force: PRESS, roll: 0.7 };
    Foot { position: place - (foot.centre_of_pressure() - place), ..foot }
}

/// A light card over the map.
fn card(ui: &mut Ui, rect: Rect, add: impl FnOnce(&mut Ui)) {
    let mut ui = ui.new_child(egui::UiBuilder::new().max_rect(rect));
    let shadow = Shadow { offset: [0, 2], blur: 14, spread: 0, color: Color32::from_black_alpha(45) };
    Frame::new()
        .fill(CARD)
        .corner_radius(CornerRadius::same(12))
        .shadow(shadow)
        .inner_margin(Margin::symmetric(EDGE.x as i8, EDGE.y as i8))
        .show(&mut ui, add);
}
