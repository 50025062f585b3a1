//! The window.

use std::f32::consts::{FRAC_PI_2, TAU};
use std::time::Duration;

use eframe::egui::{
    self, Align, Align2, Color32, Context, CornerRadius, FontId, Key, Layout, Painter, RawInput, Rect,
    RichText, Sense, Stroke, StrokeKind, Ui, UiBuilder, Vec2, ViewportCommand, pos2, vec2,
};
use underfoot::floor::{self, Geometry};
use underfoot::runtime::SessionSnapshot;
use underfoot_egui::{FootInput, Projector, SmallFloor};
use underfoot_scene::scene::Theme;
use underfoot_sim::FootHandle;

use crate::beam::Cause;
use crate::chart::{Film, Screen};
use crate::guide::Guide;
use crate::series::Series;

const GROUND: Color32 = Color32::from_rgb(0x14, 0x17, 0x1b);
const INK: Color32 = Color32::from_rgb(0xe9, 0xec, 0xef);
const QUIET: Color32 = Color32::from_rgb(0x97, 0xa1, 0xab);
const AMBER: Color32 = Color32::from_rgb(0xff, 0xb3, 0x2e);
const RED: Color32 = Color32::from_rgb(0xd9, 0x3b, 0x34);
const DARK: Color32 = Color32::from_rgb(0x2a, 0x2f, 0x36);

/// Width of the panel beside the picture, and height of the line above both, in points.
const PANEL: f32 = 372.0;
const LINE: f32 = 34.0;

/// Space between the panel's edge and its content, in points.
const EDGE: f32 = 22.0;

/// Time between two frames of a window that does not change.
const IDLE: Duration = Duration::from_millis(50);

/// Greatest number of skipped files named in the window; standard error names all of them.
const NAMED: usize = 3;

/// The loaded series.
pub struct Shelf {
    pub series: Vec<Series>,
    pub left_out: Vec<String>,
    /// Whether they are of the phantom.
    pub is_phantom: bool,
}

pub struct App {
    guide: Guide,
    shelf: Shelf,
    film: Film,
    geometry: Geometry,
    feet: FootInput,
    small: SmallFloor,
    projector: Projector,
    drag: [f64; 2],
    /// Turn of a wheel that has not reached a slice yet, in slices.
    wheel: f32,
}

impl App {
    /// `free` is the part of the floor where feet drag the picture; `hand` moves the foot of a simulated floor.
    pub fn new(
        context: &Context,
        guide: Guide,
        shelf: Shelf,
        geometry: Geometry,
        free: floor::Rect,
        hand: Option<FootHandle>,
    ) -> Self {
        FootInput::tune(context);
        context.set_theme(egui::Theme::Dark);
        let (small, projector) = (SmallFloor::new(Theme::DARK, hand), Projector::new(false));
        let (feet, film) = (FootInput::new(free), Film::default());
        Self { guide, shelf, film, geometry, feet, small, projector, drag: [0.0; 2], wheel: 0.0 }
    }

    /// The picture, and warnings over it.
    fn picture(&mut self, ui: &Ui, rect: Rect) {
        let state = &self.guide.state;
        let painter = ui.painter_at(rect);
        self.film.paint(ui.ctx(), &painter, rect, &self.shelf.series, state);
        if state.is_lost || self.guide.has_ended {
            painter.rect_filled(rect, 0.0, Color32::from_black_alpha(150));
            let words = ["The floor is silent", "Whatever was held has been stopped"];
            band(&painter, rect, RED, words);
        } else if state.beam.has_warned {
            painter.rect_stroke(rect, 0.0, Stroke::new(10.0, AMBER), StrokeKind::Inside);
        }
        if let Some(notice) = state.notice() {
            let at = rect.center_bottom() - vec2(0.0, 70.0);
            let galley =
                painter.layout_no_wrap(notice.to_owned(), FontId::proportional(20.0), Color32::BLACK);
            let place = Align2::CENTER_CENTER.anchor_size(at, galley.size());
            painter.rect_filled(place.expand2(vec2(16.0, 9.0)), 8.0, AMBER);
            painter.galley(place.min, galley, Color32::BLACK);
        }
    }

    /// The panel beside the picture.
    fn panel(&mut self, ui: &mut Ui, snapshot: &SessionSnapshot) {
        let state = &self.guide.state;
        let (sheet, view) = (state.sheet(), state.view());
        ui.label(RichText::new(&sheet.title).size(23.0).strong().color(INK));
        let count = format!("Series {} of {}", state.current + 1, state.sheets.len());
        ui.label(RichText::new(count).size(14.0).color(QUIET));
        if self.shelf.is_phantom {
            ui.label(RichText::new("A computed phantom: no patient, no scanner").size(14.0).color(AMBER));
        }
        ui.add_space(10.0);
        egui::Grid::new("numbers").num_columns(2).spacing(vec2(26.0, 5.0)).show(ui, |ui| {
            let rows = [
                ("Slice", format!("{} of {}", view.slice + 1, sheet.frames)),
                ("Window", format!("width {:.0}  level {:.0}", view.window.width, view.window.level)),
                ("Zoom", format!("{:.1}", view.zoom)),
            ];
            for (name, value) in rows {
                ui.label(RichText::new(name).size(15.0).color(QUIET));
                ui.label(RichText::new(value).size(19.0).color(INK));
                ui.end_row();
            }
        });
        ui.add_space(8.0);
        self.measures(ui);
        ui.add_space(8.0);
        self.lamp(ui);
        if !self.shelf.left_out.is_empty() {
            ui.add_space(6.0);
            let count = self.shelf.left_out.len();
            let words = if count == 1 {
                "1 file is not shown:".into()
            } else {
                format!("{count} files are not shown:")
            };
            ui.label(RichText::new(words).size(13.0).color(AMBER));
            for told in self.shelf.left_out.iter().take(NAMED) {
                ui.add(egui::Label::new(RichText::new(told).size(12.0).color(QUIET)).truncate());
            }
        }
        ui.with_layout(Layout::bottom_up(Align::Min), |ui| self.floor(ui, snapshot));
    }

    fn measures(&self, ui: &mut Ui) {
        let state = &self.guide.state;
        let (sheet, view) = (state.sheet(), state.view());
        ui.label(RichText::new("Measurements").size(15.0).color(QUIET));
        if view.measures.is_empty() {
            let words = if view.first.is_some() { "Now the second point" } else { "None" };
            ui.label(RichText::new(words).size(19.0).color(INK));
        }
        let skipped = view.measures.len().saturating_sub(3);
        for (number, measure) in view.measures.iter().enumerate().skip(skipped) {
            let words = format!(
                "{}: {:.1} {}  on slice {}",
                number + 1,
                measure.length(),
                sheet.unit(measure.slice),
                measure.slice + 1
            );
            ui.label(RichText::new(words).size(19.0).color(INK));
        }
        if sheet.unit(view.slice) == "px" {
            ui.label(RichText::new("The files don't say how large a pixel is").size(13.0).color(AMBER));
        }
        if state.is_armed {
            ui.label(RichText::new("Press Clear again to clear them").size(15.0).strong().color(AMBER));
        }
    }

    /// The simulated X-ray lamp.
    fn lamp(&self, ui: &mut Ui) {
        let beam = &self.guide.state.beam;
        let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 92.0), Sense::hover());
        let (face, ink, words) = match (beam.is_on, beam.has_warned) {
            (true, true) => (AMBER, Color32::BLACK, "X-RAY ENDS SOON"),
            (true, false) => (Color32::from_rgb(0xff, 0xd9, 0x4a), Color32::BLACK, "X-RAY ON"),
            (false, _) => (DARK, QUIET, "X-ray off"),
        };
        response.widget_info(|| egui::WidgetInfo::labeled(egui::accesskit::Role::Status, true, words));
        let painter = ui.painter();
        if beam.is_on {
            for glow in 1..=6_u8 {
                let around = rect.expand(2.0 * f32::from(glow));
                painter.rect_filled(around, 12.0, face.gamma_multiply(0.06));
            }
        }
        painter.rect_filled(rect, 10.0, face);
        trefoil(
            painter,
            pos2(rect.left() + 46.0, rect.center().y),
            if beam.is_on { Color32::BLACK } else { QUIET },
        );
        let at = pos2(rect.left() + 92.0, rect.top() + 14.0);
        painter.text(at, Align2::LEFT_TOP, words, FontId::proportional(24.0), ink);
        let why = match beam.ended {
            _ if beam.is_on => format!("{:.1} s of {:.0}", beam.held_s, self.guide.state.longest_s),
            None => "Held: a foot on X-ray".to_owned(),
            Some(Cause::Lifted) => "The foot let go".to_owned(),
            Some(Cause::Time) => "Stopped by itself: lift the foot".to_owned(),
            Some(Cause::FloorLost) => "Stopped: the floor fell silent".to_owned(),
            Some(Cause::Doubt) => "Stopped: the foot slid or stepped".to_owned(),
        };
        painter.text(at + vec2(0.0, 32.0), Align2::LEFT_TOP, why, FontId::proportional(15.0), ink);
        let small = FontId::proportional(12.0);
        painter.text(at + vec2(0.0, 52.0), Align2::LEFT_TOP, "Simulated: nothing radiates", small, ink);
        if beam.is_on {
            let share = (beam.held_s / self.guide.state.longest_s).clamp(0.0, 1.0) as f32;
            let bar = Rect::from_min_max(
                pos2(rect.left() + 12.0, rect.bottom() - 9.0),
                rect.right_bottom() - vec2(12.0, 4.0),
            );
            painter.rect_filled(bar, 2.0, Color32::from_black_alpha(60));
            let left = bar.with_max_x(bar.right() - share * bar.width());
            painter.rect_filled(left, 2.0, Color32::BLACK);
        }
    }

    /// The small floor, with the mouse as a foot on it.
    fn floor(&mut self, ui: &mut Ui, snapshot: &SessionSnapshot) {
        let side = ui.available_width().min(ui.available_height() - 26.0).max(120.0);
        let words = self.small.advice(&self.guide.floor, snapshot);
        let words = words.unwrap_or("Key P: the floor for a projector");
        ui.label(RichText::new(words).size(13.0).color(QUIET));
        ui.allocate_ui(Vec2::splat(side), |ui| self.small.ui(ui, &self.geometry, snapshot));
    }
}

impl eframe::App for App {
    fn raw_input_hook(&mut self, context: &Context, raw: &mut RawInput) {
        self.small.lead(&mut self.feet, &self.guide.floor, context, raw);
    }

    /// In `logic` and not in `ui`, since a fully covered window does not call `ui`: the beam's lamp goes out in time.
    fn logic(&mut self, context: &Context, _: &mut eframe::Frame) {
        self.guide.turn(std::mem::take(&mut self.drag));
        context.request_repaint_after(IDLE);
        if self.guide.has_ended && !self.small.is_simulated() {
            context.send_viewport_cmd(ViewportCommand::Close);
        }
    }

    fn ui(&mut self, ui: &mut Ui, _: &mut eframe::Frame) {
        let (rect, snapshot) = (ui.max_rect(), self.guide.floor.snapshot());
        ui.painter().rect_filled(rect, 0.0, GROUND);
        let line = rect.with_max_y(rect.top() + LINE);
        ui.painter().rect_filled(line, 0.0, AMBER);
        let font = FontId::proportional(16.0);
        let words = "NOT A MEDICAL DEVICE: an example of a user interface, not for diagnosis or treatment";
        ui.painter().text(line.center(), Align2::CENTER_CENTER, words, font, Color32::BLACK);

        let picture = Rect::from_min_max(line.left_bottom(), rect.right_bottom() - vec2(PANEL, 0.0));
        self.drag = dragged(ui, &mut self.feet, picture, &self.guide, self.drag);
        self.picture(ui, picture);
        if ui.input(|input| input.key_pressed(Key::P)) {
            self.projector.toggle();
        }
        let slices = turned(ui, picture, &mut self.wheel);
        if slices != 0.0 {
            self.guide.state.step(slices);
        }
        let panel = Rect::from_min_max(pos2(picture.right(), line.bottom()), rect.max).shrink(EDGE);
        let mut beside = ui.new_child(UiBuilder::new().max_rect(panel));
        beside.set_clip_rect(panel.expand(EDGE));
        self.panel(&mut beside, &snapshot);
        self.projector.show(&ui.ctx().clone(), &self.geometry, &snapshot);
    }
}

/// The drag in units of the series: `before`, plus the drag of the picture in `rect` by feet or the mouse.
pub fn dragged(ui: &Ui, feet: &mut FootInput, rect: Rect, guide: &Guide, before: [f64; 2]) -> [f64; 2] {
    let picture = ui.interact(rect, ui.scope_id().with("picture"), Sense::drag());
    picture.widget_info(|| egui::WidgetInfo::labeled(egui::accesskit::Role::Image, true, "Slice"));
    feet.set_target(rect);
    let scale = Screen::new(rect, &guide.state).scale;
    let by = picture.drag_delta();
    [before[0] + f64::from(by.x) / scale, before[1] + f64::from(by.y) / scale]
}

/// Number of slices to turn by a wheel over the picture and by keys; `rest` is the wheel's turn below a whole slice.
fn turned(ui: &Ui, picture: Rect, rest: &mut f32) -> f64 {
    /// Points by which one step of a wheel scrolls in egui.
    const STEP: f32 = 50.0;
    let keys = [
        (Key::ArrowUp, -1.0),
        (Key::ArrowLeft, -1.0),
        (Key::ArrowDown, 1.0),
        (Key::ArrowRight, 1.0),
        (Key::PageUp, -10.0),
        (Key::PageDown, 10.0),
        (Key::Home, f64::NEG_INFINITY),
        (Key::End, f64::INFINITY),
    ];
    ui.input(|input| {
        let by_key = keys.iter().map(|(key, slices)| f64::from(input.num_presses(*key) as u32) * slices);
        let by_key: f64 = by_key.filter(|slices| !slices.is_nan()).sum();
        if input.pointer.hover_pos().is_some_and(|at| picture.contains(at)) {
            let moved: f32 = input
                .events
                .iter()
                .map(|event| match event {
                    egui::Event::MouseWheel { unit, delta, .. } => match unit {
                        egui::MouseWheelUnit::Point => delta.y / STEP,
                        egui::MouseWheelUnit::Line | egui::MouseWheelUnit::Page => delta.y,
                    },
                    _ => 0.0,
                })
                .sum();
            *rest -= moved;
        }
        let whole = rest.trunc();
        *rest -= whole;
        by_key + f64::from(whole)
    })
}

/// A band across the picture with a large line and a smaller one.
fn band(painter: &Painter, rect: Rect, colour: Color32, [large, small]: [&str; 2]) {
    let place = Rect::from_center_size(rect.center(), vec2(rect.width(), 120.0));
    painter.rect_filled(place, CornerRadius::ZERO, colour);
    let at = place.center();
    painter.text(
        at - vec2(0.0, 16.0),
        Align2::CENTER_CENTER,
        large,
        FontId::proportional(40.0),
        Color32::WHITE,
    );
    painter.text(
        at + vec2(0.0, 30.0),
        Align2::CENTER_CENTER,
        small,
        FontId::proportional(19.0),
        Color32::WHITE,
    );
}

/// The sign for radiation: a disc and three blades of 60 degrees.
fn trefoil(painter: &Painter, at: egui::Pos2, colour: Color32) {
    painter.circle_filled(at, 6.0, colour);
    for blade in 0..3_u8 {
        let middle = FRAC_PI_2 + TAU * f32::from(blade) / 3.0;
        let mut mesh = egui::Mesh::default();
        for step in -6..=6_i8 {
            let way = Vec2::angled(middle + f32::from(step) * TAU / 72.0);
            mesh.colored_vertex(at + 10.0 * way, colour);
            mesh.colored_vertex(at + 30.0 * way, colour);
        }
        for step in 0..12_u32 {
            mesh.add_triangle(2 * step, 2 * step + 1, 2 * step + 2);
            mesh.add_triangle(2 * step + 1, 2 * step + 2, 2 * step + 3);
        }
        painter.add(mesh);
    }
}
