//! The floor from above: plates, sensors and their forces.

use eframe::egui::accesskit::Role;
use eframe::egui::{
    Align2, FontId, Painter, Pos2, Rect, Sense, Shape, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2,
};

use crate::setup::{SensorState, SensorView};
use underfoot::floor::{Geometry, TileId};
use underfoot_scene::egui_painter::{ScreenFromFloor, color};
use underfoot_scene::scene::Theme;

/// Force whose disc is as large as the greatest (N).
const GREATEST_N: f32 = 400.0;

/// Force from which a sensor's number is written beside it (N).
const WRITTEN_N: f32 = 5.0;

/// Maximum number of tiles with sensors: on larger floors the dots would run together.
const MOST_WITH_SENSORS: usize = 400;

/// The state of a tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TileLook {
    /// Nothing to say.
    Plain,
    /// A person should step on it.
    Lit,
    /// It carries a load, and another one is lit.
    Felt,
    /// It is right.
    Good,
    /// It is wrong, or needs more.
    Bad,
}

impl TileLook {
    /// The state in words, after the tile's name.
    const fn words(self) -> &'static str {
        match self {
            Self::Plain => "empty",
            Self::Lit => "step here",
            Self::Felt => "feels somebody",
            Self::Good => "good",
            Self::Bad => "something is wrong",
        }
    }
}

/// A drawing of one floor in a part of the window.
pub(super) struct FloorDrawing<'a> {
    pub(super) geometry: &'a Geometry,
    pub(super) theme: &'a Theme,
    pub(super) map: ScreenFromFloor,
    pub(super) painter: Painter,
}

impl<'a> FloorDrawing<'a> {
    /// Draws the empty floor in the middle of `room`, north up.
    pub(super) fn new(ui: &Ui, room: Rect, geometry: &'a Geometry, theme: &'a Theme) -> Self {
        let map = ScreenFromFloor::fit(geometry.bounds(), room.shrink2(vec2(40.0, 40.0)));
        let painter = ui.painter_at(room);
        let area = map.rect(geometry.bounds());
        painter.rect_filled(area.expand(8.0), 10.0, color(theme.seam));
        let north = pos2(area.center().x, area.top() - 16.0);
        painter.text(north, Align2::CENTER_CENTER, "north", FontId::proportional(12.5), color(theme.quiet));
        Self { geometry, theme, map, painter }
    }

    /// Draws all plates with their states.
    pub(super) fn tiles(&self, ui: &Ui, look: impl Fn(TileId) -> TileLook) {
        let theme = self.theme;
        for tile in self.geometry.tiles().filter(|tile| self.geometry.has(*tile)) {
            let area = self.map.rect(self.geometry.plate(tile)).shrink(1.5);
            let look = look(tile);
            let ink = match look {
                TileLook::Plain => theme.line,
                TileLook::Lit => theme.accent,
                TileLook::Felt => theme.warning,
                TileLook::Good => theme.good,
                TileLook::Bad => theme.fault,
            };
            self.painter.rect_filled(area, 5.0, color(theme.plate));
            let (weight, edge) = match look {
                TileLook::Plain => (0.0, 1.0),
                // It breathes, so that it is found from across the room.
                TileLook::Lit => (0.42 + 0.2 * (4.0 * ui.input(|i| i.time)).sin() as f32, 5.0),
                TileLook::Felt => (0.25, 2.0),
                TileLook::Good => (0.24, 1.5),
                TileLook::Bad => (0.24, 2.0),
            };
            self.painter.rect_filled(area, 5.0, color(ink).gamma_multiply(weight));
            self.painter.rect_stroke(area, 5.0, Stroke::new(edge, color(ink)), StrokeKind::Inside);
            self.sign(area, look);
            let font = FontId::proportional((0.09 * area.height()).clamp(8.0, 14.0));
            let at = area.center_bottom() - vec2(0.0, 0.04 * area.height() + 2.0);
            let name = format!("{}, {}", tile.column, tile.row);
            self.painter.text(at, Align2::CENTER_BOTTOM, name, font, color(theme.quiet));
            let node = ui.interact(area, ui.scope_id().with(("tile", tile.column, tile.row)), Sense::hover());
            node.widget_info(|| {
                WidgetInfo::labeled(Role::Label, true, format!("Tile {tile}: {}", look.words()))
            });
        }
    }

    /// Draws the sign of a state: signs tell the states apart without colour.
    fn sign(&self, area: Rect, look: TileLook) {
        let middle = area.center();
        let half = (0.12 * area.width().min(area.height())).clamp(4.0, 34.0);
        let ink = |colour| Stroke::new((0.16 * half).max(2.0), color(colour));
        match look {
            TileLook::Good => {
                let tick = [vec2(-half, 0.0), vec2(-0.3 * half, 0.7 * half), vec2(half, -0.7 * half)];
                self.painter.line(tick.map(|way| middle + way).to_vec(), ink(self.theme.good));
            }
            TileLook::Bad => {
                for side in [1.0, -1.0] {
                    let way = 0.8 * vec2(half, side * half);
                    self.painter.line_segment([middle - way, middle + way], ink(self.theme.fault));
                }
            }
            TileLook::Lit => {
                let font = FontId::proportional((0.17 * area.width()).clamp(9.0, 40.0));
                self.painter.text(middle, Align2::CENTER_CENTER, "Step\nhere", font, color(self.theme.ink));
            }
            TileLook::Plain | TileLook::Felt => {}
        }
    }

    /// Draws the places of all sensors.
    pub(super) fn places(&self) {
        if self.geometry.tile_count() > MOST_WITH_SENSORS {
            return;
        }
        for tile in self.geometry.tiles().filter(|tile| self.geometry.has(*tile)) {
            for &corner in self.geometry.sensors(tile) {
                let at = self.map.point(self.geometry.sensor(tile, corner));
                self.painter.circle_filled(at, self.dot(), color(self.theme.contact));
            }
        }
    }

    /// Radius of a sensor's dot, in points.
    fn dot(&self) -> f32 {
        (0.012 * self.map.scale()).clamp(2.5, 6.0)
    }

    /// Draws the sensors with their forces and troubles.
    pub(super) fn sensors(&self, ui: &Ui, sensors: &[SensorView]) {
        if self.geometry.tile_count() > MOST_WITH_SENSORS {
            return;
        }
        // Six centimetres for a person on one sensor.
        let greatest = 0.06 * self.map.scale();
        for view in sensors {
            let (tile, corner) = (view.sensor.tile, view.sensor.corner);
            if !self.geometry.has(tile) {
                continue;
            }
            let at = self.map.point(self.geometry.sensor(tile, corner));
            let share = (view.force_n / GREATEST_N).clamp(0.0, 1.0).sqrt();
            if share > 0.0 {
                self.painter.circle_filled(at, share * greatest, color(self.theme.load).gamma_multiply(0.8));
            }
            self.dot_of(at, view.state);
            if view.force_n >= WRITTEN_N {
                // Beside the dot, towards the middle of the plate.
                let inwards = self.map.point(self.geometry.centre(tile)) - at;
                let anchor = if inwards.x >= 0.0 { Align2::LEFT_CENTER } else { Align2::RIGHT_CENTER };
                let beside = at + vec2((self.dot() + 5.0).copysign(inwards.x), 0.0);
                let font = FontId::proportional((0.04 * self.map.scale()).clamp(9.0, 15.0));
                let words = format!("{:.0} N", view.force_n);
                self.painter.text(beside, anchor, words, font, color(self.theme.ink));
            }
            let area = Rect::from_center_size(at, vec2(16.0, 16.0));
            let id = ui.scope_id().with(("sensor", tile.column, tile.row, corner.index()));
            let name = self.geometry.sensor_name(corner);
            let words = format!("Sensor {tile} {name}: {:.0} N, {}", view.force_n, view.state.words());
            let node = ui.interact(area, id, Sense::hover());
            node.widget_info(|| WidgetInfo::labeled(Role::Label, true, &words));
            node.on_hover_text(words);
        }
    }

    /// Draws the dot of a sensor: a ring, a disc, or a square for trouble.
    fn dot_of(&self, at: Pos2, state: SensorState) {
        let (radius, theme) = (self.dot(), self.theme);
        match state {
            SensorState::Waiting => {
                let ring = Stroke::new(1.6, color(theme.quiet));
                self.painter.add(Shape::circle_stroke(at, radius, ring));
            }
            SensorState::Answers => _ = self.painter.circle_filled(at, radius, color(theme.good)),
            SensorState::Silent | SensorState::Unread | SensorState::Noisy | SensorState::Saturated => {
                let square = Rect::from_center_size(at, vec2(2.2, 2.2) * radius);
                let ink = if state == SensorState::Saturated { theme.warning } else { theme.fault };
                self.painter.rect_filled(square, 1.5, color(ink));
            }
        }
    }
}
