//! The gallery of layouts to open: a picture, a title and a sentence of each, as cards over the window.

use eframe::egui::accesskit::Role;
use eframe::egui::text::LayoutJob;
use eframe::egui::{
    self, Button, FontId, Key, Modal, Rect, RichText, ScrollArea, Sense, StrokeKind, Ui, WidgetInfo, vec2,
};

use super::handheld::is_for_fingers;
use super::icons::Icon;
use super::style::{panel_colour, quiet, selected_ground};
use underfoot::engine::Snapshot;
use underfoot::floor::Geometry;
use underfoot::schema::{self, Kinds, parse_layout};
use underfoot_scene::egui_painter::{self, Palette, ScreenFromFloor, color};
use underfoot_scene::scene::{self, Scene, Show, Theme, View, in_drawn_order};

/// Width of a card that is wide enough for a sentence in four lines, in points.
const CARD: f32 = 204.0;

/// Gap between two cards, in points.
const GAP: f32 = 10.0;

/// Room around the picture in a card, in points.
const INSET: f32 = 8.0;

/// Height of the title below the picture and of each line of the sentence, in points.
const TITLE: f32 = 32.0;
const LINE: f32 = 15.0;

/// Room between the gallery and the edges of the window, in points.
const MARGIN: egui::Vec2 = vec2(36.0, 48.0);

/// The same in a window in a hand, whose room the frame of the gallery takes.
const HAND_MARGIN: egui::Vec2 = vec2(22.0, 28.0);

/// The layouts that the window can open.
#[derive(Default)]
pub(super) struct LayoutGallery {
    /// Their names: of shipped ones, or of files.
    names: Vec<String>,
    /// One card for each name, drawn at the first opening and in the colours of `theme`.
    cards: Vec<LayoutCard>,
    theme: Option<Theme>,
    is_open: bool,
    /// Whether the keyboard goes to the first card.
    takes_keys: bool,
}

/// A layout in the gallery.
struct LayoutCard {
    title: String,
    about: String,
    /// `None` for a layout without a picture.
    picture: Option<Scene>,
    /// Whether it can be opened.
    fits: bool,
    palette: Palette,
}

impl LayoutGallery {
    pub(super) fn new(names: Vec<String>) -> Self {
        Self { names, ..Self::default() }
    }

    /// Whether there is no layout to choose.
    pub(super) fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// The name of the layout with this index.
    pub(super) fn name(&self, index: usize) -> Option<&str> {
        self.names.get(index).map(String::as_str)
    }

    /// Opens it in the next frame, unless there is nothing to choose.
    pub(super) fn open(&mut self) {
        self.is_open = !self.is_empty();
        self.takes_keys = self.is_open;
    }

    /// A button with the name of the present layout, which opens the gallery.
    pub(super) fn button(&mut self, ui: &mut Ui, title: &str, width: f32) {
        let arrow = Icon::ChevronDown.unicode().to_string();
        let button = Button::new(title).right_text(arrow).truncate().min_size(vec2(width, 0.0));
        let button = ui.add_sized(vec2(width, ui.spacing().interact_size.y), button);
        button.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, "Layout"));
        if button.on_hover_text("Open another layout").clicked() {
            self.open();
        }
    }

    /// Shows the gallery while it is open, for a floor of this geometry; returns the index of the layout to open.
    pub(super) fn show(&mut self, ui: &Ui, theme: &Theme, geometry: &Geometry) -> Option<usize> {
        if !self.is_open {
            return None;
        }
        if self.theme != Some(*theme) {
            let kinds = Kinds::builtin();
            self.cards =
                self.names.iter().map(|name| LayoutCard::new(name, &kinds, geometry, theme)).collect();
            self.theme = Some(*theme);
        }
        let ctx = ui.ctx();
        let frame = egui::Frame::popup(&ctx.global_style()).inner_margin(16);
        let (mut chosen, mut is_done) = (None, false);
        let modal = Modal::new(egui::Id::unique("gallery")).frame(frame).show(ctx, |ui| {
            let margin = if is_for_fingers(ui) { HAND_MARGIN } else { MARGIN };
            let room = ctx.content_rect().size() - 2.0 * margin;
            let grid = CardGrid::of(room.x, geometry);
            ui.set_width(grid.width());
            // Otherwise the dialogue has the usual height of an area.
            ui.set_max_height(room.y);
            ui.horizontal(|ui| {
                ui.label(RichText::new("Layouts to start from").size(16.0).strong());
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                    is_done = ui.button("Close").clicked();
                });
            });
            ui.label(quiet(theme, "Each opens at once. The mouse is a foot, and so is each finger."));
            ui.add_space(6.0);
            ScrollArea::vertical().auto_shrink([false, true]).show(ui, |ui| {
                chosen = self.cards(ui, theme, geometry, &grid);
            });
        });
        if is_done || chosen.is_some() || modal.should_close() {
            self.is_open = false;
        }
        chosen
    }

    fn cards(&mut self, ui: &mut Ui, theme: &Theme, geometry: &Geometry, grid: &CardGrid) -> Option<usize> {
        let mut chosen = None;
        ui.spacing_mut().item_spacing = vec2(GAP, GAP);
        let mut all = self.names.iter().zip(&mut self.cards).enumerate();
        let mut takes_keys = self.takes_keys;
        while all.len() > 0 {
            ui.horizontal(|ui| {
                for (index, (name, card)) in all.by_ref().take(grid.columns) {
                    let response = card.show(ui, theme, geometry, grid, name);
                    // Once is not enough: a new dialogue is first laid out unseen.
                    if takes_keys && index == 0 {
                        takes_keys = !response.has_focus();
                        response.request_focus();
                    }
                    if response.clicked() {
                        chosen = Some(index);
                    }
                }
            });
        }
        self.takes_keys = takes_keys;
        chosen
    }
}

/// The cards in rows.
struct CardGrid {
    columns: usize,
    /// Size of a card, in points.
    card: egui::Vec2,
    /// Size of its picture, in points.
    picture: egui::Vec2,
    /// Largest number of lines of a sentence; the rest of it appears under the pointer.
    lines: usize,
}

impl CardGrid {
    /// As many columns as `room` points hold, at least two, for pictures of a floor of this geometry.
    fn of(room: f32, geometry: &Geometry) -> Self {
        let columns = ((room + GAP) / (CARD + GAP)).floor().clamp(2.0, 5.0);
        let width = ((room + GAP) / columns - GAP).clamp(80.0, CARD);
        let (side, floor) = (width - 2.0 * INSET, geometry.bounds().size());
        let picture = vec2(side, (side * floor.y / floor.x).clamp(0.3 * side, 1.2 * side));
        let lines = if width < CARD - 24.0 { 6 } else { 4 };
        let card = vec2(width, picture.y + INSET + TITLE + LINE * lines as f32);
        Self { columns: columns as usize, card, picture, lines }
    }

    fn width(&self) -> f32 {
        self.columns as f32 * (self.card.x + GAP) + GAP
    }
}

impl LayoutCard {
    fn new(name: &str, kinds: &Kinds, geometry: &Geometry, theme: &Theme) -> Self {
        let card = |title: &str, about: String, picture, fits| Self {
            title: in_drawn_order(title).into_owned(),
            about,
            picture,
            fits,
            palette: Palette::default(),
        };
        let Some(text) = schema::builtin_layout(name) else {
            return card(name, "The layout with which this window was opened.".into(), None, true);
        };
        match parse_layout(text, name, kinds, geometry) {
            Ok(loaded) => {
                let (layout, snapshot) = (loaded.layout, Snapshot::default());
                let view = View { show: Show::PROJECTOR, ..View::new(geometry, &layout, &snapshot, theme) };
                let mut picture = Scene::new();
                scene::draw(&mut picture, &view);
                card(&layout.title, schema::head_comment(text), Some(picture), true)
            }
            Err(problems) => {
                let why = problems.iter().next().map_or_else(String::new, |problem| problem.message.clone());
                card(name, format!("Not for this floor: {why}"), None, false)
            }
        }
    }

    fn show(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        geometry: &Geometry,
        grid: &CardGrid,
        name: &str,
    ) -> egui::Response {
        let sense = if self.fits { Sense::click() } else { Sense::hover() };
        let (rect, response) = ui.allocate_exact_size(grid.card, sense);
        response.widget_info(|| {
            let mut info = WidgetInfo::labeled(Role::Button, self.fits, name);
            info.current_text_value = Some(format!("{}: {}", self.title, self.about));
            info
        });
        if response.gained_focus() && ui.input(|i| i.key_pressed(Key::Tab)) {
            response.scroll_to_me(None);
        }
        if !ui.is_rect_visible(rect) {
            return response;
        }
        let is_lit = response.hovered() && self.fits || response.has_focus();
        let (fill, stroke) = match is_lit {
            true => (selected_ground(theme), theme.accent),
            false => (panel_colour(theme), theme.line),
        };
        ui.painter().rect(rect, 8, color(fill), (1.0, color(stroke)), StrokeKind::Inside);
        let place = Rect::from_min_size(rect.min + egui::Vec2::splat(INSET), grid.picture);
        if let Some(picture) = &self.picture {
            let map = ScreenFromFloor::fit(geometry.bounds(), place);
            let clip = map.rect(geometry.bounds()).intersect(ui.clip_rect());
            egui_painter::paint(&ui.painter().with_clip_rect(clip), &mut self.palette, picture, map);
        }
        let mut at = place.left_bottom() + vec2(0.0, 6.0);
        let [ink, faint] = [theme.ink, theme.quiet].map(|ink| color(theme.legible(ink, fill)));
        for (text, size, ink, lines) in [(&self.title, 13.5, ink, 1), (&self.about, 11.5, faint, grid.lines)]
        {
            let mut job = LayoutJob::simple(text.clone(), FontId::proportional(size), ink, grid.picture.x);
            job.wrap.max_rows = lines;
            let galley = ui.painter().layout_job(job);
            let height = galley.size().y;
            ui.painter().galley(at, galley, ink);
            at.y += height + 2.0;
        }
        response.on_hover_text(&self.about)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_layout_for_a_larger_floor_is_off_and_says_why() {
        let (kinds, small) = (Kinds::builtin(), Geometry::of_paper_tiles(4, 4).unwrap());
        let card = |name, floor: &Geometry| LayoutCard::new(name, &kinds, floor, &Theme::LIGHT);
        let map = card("map", &small);
        assert!(!map.fits && map.picture.is_none());
        assert!(map.about.starts_with("Not for this floor: region"), "{}", map.about);
        let map = card("map", &Geometry::default());
        assert!(map.fits && map.picture.is_some() && map.title == "Map navigation");
        assert!(card("mine.ron", &small).fits, "a file is read when it is opened");
    }

    #[test]
    fn the_cards_of_a_phone_stand_in_two_columns_within_its_screen() {
        for (room, columns) in [(290.0, 2), (600.0, 2), (1200.0, 5), (2400.0, 5)] {
            let grid = CardGrid::of(room, &Geometry::default());
            assert_eq!(grid.columns, columns, "{room}");
            assert!(grid.columns as f32 * (grid.card.x + GAP) - GAP <= room + 0.1, "{room}");
        }
    }
}
