//! The window.

use std::time::{Duration, Instant};

use eframe::egui::{
    self, Align2, Color32, Context, CornerRadius, FontId, Frame, Key, Margin, RawInput, Rect, Response,
    RichText, Sense, Shadow, Ui, Vec2, ViewportCommand, pos2, vec2,
};
use underfoot::floor::{self, Geometry};
use underfoot::runtime::SessionSnapshot;
use underfoot::wire::LinkState;
use underfoot_egui::{FootInput, Projector, SmallFloor};
use underfoot_scene::scene::Theme;
use underfoot_sim::FootHandle;

use crate::chart;
use crate::guide::Guide;
use crate::inset::Part;
use crate::tiles::Tiles;

const INK: Color32 = Color32::from_rgb(0x2a, 0x28, 0x25);
const QUIET: Color32 = Color32::from_rgb(0x5d, 0x58, 0x50);
const CARD: Color32 = Color32::from_rgba_premultiplied(0xed, 0xea, 0xe5, 0xf2);

/// Space between the edge of a card and its content, in points.
const EDGE: Vec2 = vec2(18.0, 14.0);

/// Time between two frames of a map that does not move.
const IDLE: Duration = Duration::from_millis(50);

pub struct App {
    guide: Guide,
    geometry: Geometry,
    feet: FootInput,
    small: SmallFloor,
    projector: Projector,
    picture: Picture,
    /// The part of the floor that the small one shows.
    part: Part,
    drag: Vec2,
    levels: f64,
    /// The areas that covered the map in the last frame.
    covered: Vec<Rect>,
}

/// Pictures over the map's own shapes.
#[derive(Default)]
pub struct Picture {
    pub tiles: Option<Tiles>,
    /// The owner of the pictures; empty for none.
    pub attribution: String,
}

impl Picture {
    /// The sources of the visible shapes and pictures, and the reason why some are missing.
    fn credits(&self) -> String {
        let attribution = Some(self.attribution.clone()).filter(|text| !text.is_empty());
        let trouble = self.tiles.as_ref().and_then(Tiles::trouble).map(|why| format!("No tiles: {why}"));
        let own = "Shapes: Natural Earth   Cities: GeoNames, CC BY 4.0".to_owned();
        let all = std::iter::once(own).chain(attribution).chain(trouble);
        all.collect::<Vec<_>>().join("   ")
    }
}

impl App {
    /// `free` is the part of the floor where feet drag the map; `hand` moves the foot of a simulated floor.
    pub fn new(
        context: &Context,
        guide: Guide,
        geometry: Geometry,
        free: floor::Rect,
        hand: Option<FootHandle>,
        picture: Picture,
        project: bool,
    ) -> Self {
        FootInput::tune(context);
        context.set_theme(egui::Theme::Light);
        let (small, projector) = (SmallFloor::new(Theme::LIGHT, hand), Projector::new(project));
        let part = Part::of(&geometry, &guide.floor.snapshot().layout);
        let (drag, levels, covered) = (Vec2::ZERO, 0.0, Vec::new());
        Self {
            guide,
            geometry,
            feet: FootInput::new(free),
            small,
            projector,
            picture,
            part,
            drag,
            levels,
            covered,
        }
    }

    /// The card in a corner with the map's position; returns the area that it covers.
    fn title(&self, ui: &mut Ui, rect: Rect, snapshot: &SessionSnapshot) -> Rect {
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
            let Some(words) = self.small.advice(&self.guide.floor, snapshot) else { return };
            let colour = match snapshot.floor.link {
                LinkState::Lost => Theme::LIGHT.fault,
                LinkState::Waiting => Theme::LIGHT.warning,
                _ => Theme::LIGHT.quiet,
            };
            let colour = Color32::from_rgb(colour.red, colour.green, colour.blue);
            ui.label(RichText::new(words).size(15.0).color(colour));
        })
    }

    /// The small floor, with the mouse as a foot on it; returns the area that it covers.
    fn floor(&mut self, ui: &mut Ui, rect: Rect, snapshot: &SessionSnapshot) -> Rect {
        let size = self.part.size(rect.size());
        let outer = size + 2.0 * EDGE;
        let at = Rect::from_min_size(rect.max - outer - vec2(24.0, 24.0), outer);
        card(ui, at, |ui| {
            let (shown, _) = ui.allocate_exact_size(size, Sense::hover());
            let whole = self.part.whole(&self.geometry, shown);
            let mut inside = ui.new_child(egui::UiBuilder::new().max_rect(whole));
            inside.set_clip_rect(shown.intersect(ui.clip_rect()));
            self.small.ui(&mut inside, &self.geometry, snapshot);
        })
    }
}

impl eframe::App for App {
    fn raw_input_hook(&mut self, context: &Context, raw: &mut RawInput) {
        self.small.lead(&mut self.feet, &self.guide.floor, context, raw);
    }

    /// In `logic` and not in `ui`, since a fully covered window does not call `ui` while its time advances.
    fn logic(&mut self, context: &Context, _: &mut eframe::Frame) {
        let before = self.guide.state.camera;
        self.guide.turn(std::mem::take(&mut self.drag), std::mem::take(&mut self.levels));
        if before != self.guide.state.camera {
            context.request_repaint();
        }
        context.request_repaint_after(IDLE);
        if self.guide.has_ended && !self.small.is_simulated() {
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
            self.projector.toggle();
        }
        chart::shapes(ui.painter(), rect, &self.guide.world, &self.guide.state);
        if let Some(tiles) = &mut self.picture.tiles {
            tiles.paint(ui.ctx(), ui.painter(), rect, &self.guide.state.camera, Instant::now());
        }
        chart::layers(ui.painter(), rect, &self.guide.world, &self.guide.state, &self.covered);
        chart::scale_bar(
            ui.painter(),
            rect,
            &self.guide.state,
            pos2(rect.left() + 28.0, rect.bottom() - 28.0),
        );
        let below = pos2(rect.left() + 28.0, rect.bottom() - 6.0);
        let font = FontId::proportional(11.0);
        let credits = ui.painter().text(below, Align2::LEFT_BOTTOM, self.picture.credits(), font, QUIET);
        let corner =
            Rect::from_min_max(pos2(rect.left(), rect.bottom() - 60.0), pos2(credits.right(), rect.bottom()));
        self.covered = vec![corner, self.title(ui, rect, &snapshot), self.floor(ui, rect, &snapshot)];
        self.projector.show(&ui.ctx().clone(), &self.geometry, &snapshot);
    }
}

/// The map in `rect`, dragged by feet or the mouse.
pub fn dragged(ui: &Ui, feet: &mut FootInput, rect: Rect) -> Response {
    let map = ui.interact(rect, ui.scope_id().with("map"), Sense::drag());
    map.widget_info(|| egui::WidgetInfo::labeled(egui::accesskit::Role::Image, true, "Map"));
    feet.set_target(rect);
    map
}

/// A light card over the map; returns its area.
fn card(ui: &mut Ui, rect: Rect, add: impl FnOnce(&mut Ui)) -> Rect {
    let mut ui = ui.new_child(egui::UiBuilder::new().max_rect(rect));
    let shadow = Shadow { offset: [0, 2], blur: 14, spread: 0, color: Color32::from_black_alpha(45) };
    Frame::new()
        .fill(CARD)
        .corner_radius(CornerRadius::same(12))
        .shadow(shadow)
        .inner_margin(Margin::symmetric(EDGE.x as i8, EDGE.y as i8))
        .show(&mut ui, add)
        .response
        .rect
}
