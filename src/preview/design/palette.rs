//! What there is to put down: kinds of controls with their pictures, regions, places to stand, grounds; and below it
//! what there is already.

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Margin, Panel, ScrollArea, Sense, Ui, WidgetInfo, vec2};
use glam::Vec2;

use super::{Designer, Pane};
use crate::edit::{Address, Edit, List};
use crate::egui_painter::{self, Palette, ScreenFromFloor, color};
use crate::engine::Snapshot;
use crate::floor::{Geometry, Rect};
use crate::layout::{Layout, Widget};
use crate::preview::style::{panel_frame, quiet, section};
use crate::scene::{self, Scene, Show, Theme, View};
use crate::widget::WidgetId;

/// A tile's width of control: 16 cm and more suit a shoe (rule U101).
const SMALL_M: Vec2 = Vec2::new(0.18, 0.16);

/// What slides or leans needs room for it.
const WIDE_M: Vec2 = Vec2::new(0.36, 0.18);

/// Height of a picture in the palette, in points.
const PICTURE: f32 = 34.0;

/// Something to put down.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Thing {
    /// A control of this kind.
    Control(String),
    Region,
    Stance,
    /// A ground of this name.
    Ground(&'static str),
}

impl Thing {
    fn name(&self) -> String {
        match self {
            Self::Control(kind) => kind.replace('_', " "),
            Self::Region => "region".into(),
            Self::Stance => "place to stand".into(),
            Self::Ground(name) => name.to_lowercase(),
        }
    }

    /// How large it is put down, in metres: full twentieths of a tile.
    pub(super) fn size(&self, geometry: &Geometry) -> Vec2 {
        let grid = 0.05 * geometry.pitch_m();
        let size = match self {
            Self::Control(kind) => {
                let wide = ["slider", "fader", "stepper", "selector", "lean", "pad"];
                if wide.iter().any(|name| kind.contains(name)) { WIDE_M } else { SMALL_M }
            }
            Self::Region | Self::Ground(_) => Vec2::splat(2.0 * geometry.pitch_m()),
            Self::Stance => Vec2::new(2.0, 1.0) * geometry.pitch_m(),
        };
        (size / grid).round() * grid
    }
}

impl Designer {
    /// Everything to choose from.
    pub(super) fn palette_panel(&mut self, ui: &mut Ui, theme: &Theme, palette: &mut Palette) {
        let frame = panel_frame(theme, Margin { left: 12, right: 4, top: 0, bottom: 6 });
        let panel = Panel::left("palette").frame(frame).resizable(true);
        panel.default_size(190.0).size_range(150.0..=300.0).show(ui, |ui| {
            let half = 0.5 * ui.available_height();
            let below = Panel::bottom("on the floor").frame(egui::Frame::new()).resizable(true);
            below.default_size(0.36 * ui.available_height()).size_range(90.0..=half.max(91.0)).show(
                ui,
                |ui| {
                    section(ui, theme, "On the floor", |_| {});
                    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                        ui.set_width(ui.available_width() - 8.0);
                        self.list(ui, theme);
                    });
                },
            );
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                ui.set_width(ui.available_width() - 8.0);
                section(ui, theme, "Put down", |_| {});
                let kinds: Vec<String> = self.document.kinds().iter().map(|kind| kind.name.clone()).collect();
                let mut is_led = self.leads_to(Pane::Things);
                for kind in kinds {
                    self.thing(ui, theme, palette, Thing::Control(kind), std::mem::take(&mut is_led));
                }
                for thing in [Thing::Region, Thing::Stance] {
                    self.thing(ui, theme, palette, thing, false);
                }
                for name in ["Ice", "Snow", "Gravel", "Sand", "Wood"] {
                    self.thing(ui, theme, palette, Thing::Ground(name), false);
                }
                if ui.button("Add a page").clicked() {
                    self.add_page();
                }
            });
        });
    }

    fn thing(&mut self, ui: &mut Ui, theme: &Theme, palette: &mut Palette, thing: Thing, is_led: bool) {
        let size = vec2(ui.available_width(), PICTURE + 6.0);
        let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
        if is_led {
            response.request_focus();
        }
        if response.gained_focus() {
            response.scroll_to_me(None);
        }
        let name = thing.name();
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Put down: {name}")));
        if ui.is_rect_visible(rect) {
            let is_chosen = self.placing.as_ref() == Some(&thing);
            let visuals = ui.style().interact_selectable(&response, is_chosen);
            ui.painter().rect(rect, 6, visuals.weak_bg_fill, visuals.bg_stroke, egui::StrokeKind::Inside);
            if is_chosen {
                ui.painter().rect_filled(rect, 6, color(theme.accent).gamma_multiply(0.2));
            }
            let picture = egui::Rect::from_min_size(rect.min + vec2(5.0, 3.0), vec2(54.0, PICTURE));
            if let Thing::Control(kind) = &thing {
                self.picture(ui, theme, palette, kind, picture);
            } else {
                let ink = egui::Stroke::new(1.5, color(theme.accent));
                ui.painter().rect_stroke(picture.shrink(4.0), 3, ink, egui::StrokeKind::Inside);
            }
            let at = egui::pos2(picture.right() + 7.0, rect.center().y);
            let font = egui::FontId::proportional(12.5);
            ui.painter().with_clip_rect(rect).text(
                at,
                egui::Align2::LEFT_CENTER,
                &name,
                font,
                color(theme.ink),
            );
        }
        if response.drag_started() || response.clicked() {
            // By keyboard there is no pointer to follow: it is put where there is room.
            let by_key =
                response.clicked() && ui.input(|i| i.key_pressed(Key::Enter) || i.key_pressed(Key::Space));
            if by_key {
                self.put_somewhere(&thing);
            } else {
                self.placing = if self.placing.as_ref() == Some(&thing) { None } else { Some(thing) };
            }
        }
        response.on_hover_text(
            "Click, then click on the floor; or drag it there; Enter puts it where there is room",
        );
    }

    /// The kind as it is on the floor.
    fn picture(&mut self, ui: &Ui, theme: &Theme, palette: &mut Palette, kind: &str, picture: egui::Rect) {
        let Some(kind) = self.document.kinds().get(kind) else { return };
        let size = Thing::Control(kind.name.clone()).size(&self.document.floor().geometry);
        let area = Rect::from_min_size(Vec2::ZERO, size);
        let widget = Widget {
            id: WidgetId::new("it"),
            kind: kind.name.clone(),
            region: 0,
            page: None,
            goto: None,
            area,
            label: String::new(),
            behaviour: kind.behaviour.clone(),
            feel: kind.feel.clone(),
            look: kind.look,
        };
        let layout = Layout {
            title: String::new(),
            regions: Vec::new(),
            stances: Vec::new(),
            pages: Vec::new(),
            grounds: Vec::new(),
            widgets: vec![widget],
        };
        let snapshot = Snapshot::default();
        let geometry = self.document.floor().geometry;
        let view = View { show: Show::PROJECTOR, ..View::new(&geometry, &layout, &snapshot, theme) };
        let mut drawn = Scene::new();
        scene::draw(&mut drawn, &view);
        let map = ScreenFromFloor::fit(area.grown(0.01), picture);
        // Without the floor around it.
        let clip = map.rect(area.grown(0.004)).intersect(ui.clip_rect());
        egui_painter::paint(&ui.painter().with_clip_rect(clip), palette, &drawn, map);
    }

    /// Puts `thing` with its middle at `at`, in floor metres.
    pub(super) fn put(&mut self, thing: &Thing, area: Rect) -> bool {
        let on_page = |list| {
            let page = self.layout().pages.get(self.page).map(|_| Address::of(List::Pages, self.page));
            page.unwrap_or(Address::LAYOUT).entry(list, usize::MAX)
        };
        let place = self.document.placed(area);
        let (at, text) = match thing {
            Thing::Control(kind) => (on_page(List::Widgets), self.document.new_control(kind, area)),
            Thing::Ground(name) => (on_page(List::Grounds), format!("{name}({place})")),
            Thing::Stance => {
                let text = format!("({place}, label: \"Stand here\")");
                (Address::LAYOUT.entry(List::Stances, usize::MAX), text)
            }
            Thing::Region => {
                let id = self.document.free_id("region", &[]);
                (Address::LAYOUT.entry(List::Regions, usize::MAX), format!("(id: \"{id}\", {place})"))
            }
        };
        let done = self.edit(&[Edit::Insert { at: at.clone(), text }]);
        if done {
            self.refresh();
            let list = at.split().map(|(parent, list, _)| (parent, list));
            let is_in = |address: &Address| address.split().map(|(parent, list, _)| (parent, list)) == list;
            let last =
                self.items.iter().map(|item| &item.record).filter(|record| is_in(record)).max().cloned();
            self.selected = last.into_iter().collect();
        }
        done
    }

    /// Puts `thing` at the first place of a grid of half tiles where the reader lets it be.
    fn put_somewhere(&mut self, thing: &Thing) {
        let geometry = self.document.floor().geometry;
        let size = thing.size(&geometry);
        let step = 0.5 * geometry.pitch_m();
        let within = match thing {
            Thing::Control(_) => {
                self.layout().regions.first().map_or(geometry.bounds(), |region| region.area)
            }
            _ => geometry.bounds(),
        };
        let steps = ((within.size() - size) / step).max(Vec2::ZERO).floor();
        for row in 0..=steps.y as u32 {
            for column in 0..=steps.x as u32 {
                let at = within.min + Vec2::new(column as f32, row as f32) * step + Vec2::splat(0.2 * step);
                let area = Rect::from_min_size(at.min(within.max - size), size);
                // Half a shoe of room (rule U102), where there is some.
                let wide = area.grown(0.06);
                let is_taken = |item: &crate::edit::Item| {
                    item.record.list() == Some(List::Widgets)
                        && item.is_on(self.page)
                        && item.area.overlaps(wide)
                };
                if matches!(thing, Thing::Control(_)) && self.items.iter().any(is_taken) {
                    continue;
                }
                if self.put(thing, area) {
                    return;
                }
            }
        }
        if self.message.is_none() {
            self.complain("there is no room left");
        }
    }

    fn add_page(&mut self) {
        let id = self.document.free_id("page_1", &[]);
        let at = Address::of(List::Pages, usize::MAX);
        if self.edit(&[Edit::Insert { at, text: format!("(id: \"{id}\", widgets: [])") }]) {
            self.refresh();
            self.page = self.layout().pages.len().saturating_sub(1);
            self.selected = vec![Address::of(List::Pages, self.page)];
        }
    }

    /// What there is on the shown page, to be selected by name.
    fn list(&mut self, ui: &mut Ui, theme: &Theme) {
        if self.layout().pages.len() > 1 {
            let names: Vec<String> = self.layout().pages.iter().map(|page| page.id.to_string()).collect();
            for (number, name) in names.iter().enumerate() {
                if ui.selectable_label(self.page == number, format!("Page {name}")).clicked() {
                    self.page = number;
                    self.selected = vec![Address::of(List::Pages, number)];
                }
            }
        }
        let mut chosen = None;
        let (mut locks, mut hides) = (None, None);
        let mut is_led = self.leads_to(Pane::Floor);
        for item in self.items.iter().filter(|item| item.is_on(self.page)) {
            let what = match item.record.list() {
                Some(List::Regions) => "Region",
                Some(List::Stances) => "Stance",
                Some(List::Grounds) => "Ground",
                _ if item.is_group => "Group",
                _ => "Control",
            };
            let is_selected = self.selected.contains(&item.record);
            let name = if item.name.is_empty() { item.record.to_string() } else { item.name.clone() };
            let is_inner = item.record.split().is_some_and(|(of, ..)| of.list() == Some(List::Widgets));
            let (is_locked, is_hidden) = (self.is_locked(&item.record), self.is_hidden(&item.record));
            ui.horizontal(|ui| {
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                    ui.spacing_mut().item_spacing.x = 2.0;
                    for (sign, is_on, wish) in
                        [(Sign::Hide, is_hidden, &mut hides), (Sign::Lock, is_locked, &mut locks)]
                    {
                        let button = sign.button(ui, theme, is_on);
                        let does = if sign == Sign::Hide { "Hide" } else { "Lock" };
                        button.widget_info(|| {
                            WidgetInfo::selected(Role::Button, true, is_on, format!("{does}: {name}"))
                        });
                        if button.on_hover_text(does).clicked() {
                            *wish = Some(item.record.clone());
                        }
                    }
                    ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                        ui.add_space(if is_inner { 12.0 } else { 0.0 });
                        let row = egui::Button::selectable(is_selected, format!("{what} {name}")).truncate();
                        let row = ui.add(row);
                        if std::mem::take(&mut is_led) {
                            row.request_focus();
                        }
                        if row.gained_focus() {
                            row.scroll_to_me(None);
                        }
                        if row.clicked() {
                            chosen = Some(item.record.clone());
                        }
                    });
                });
            });
        }
        if let Some(record) = locks {
            self.turn_lock(&[record]);
        }
        if let Some(record) = hides {
            self.turn_hidden(&[record]);
        }
        if let Some(record) = chosen {
            if ui.input(|i| i.modifiers.shift) { self.toggle(record) } else { self.select_only(record) }
        }
        if self.items.is_empty() {
            ui.label(quiet(theme, "Nothing yet"));
        }
    }
}

/// What stands behind a row of the list.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Sign {
    Hide,
    Lock,
}

impl Sign {
    /// Drawn, for the window's font has neither; faint while it is off.
    fn button(self, ui: &mut Ui, theme: &Theme, is_on: bool) -> egui::Response {
        let (rect, response) = ui.allocate_exact_size(vec2(18.0, 18.0), Sense::click());
        let is_touched = response.hovered() || response.has_focus();
        let ink = if is_on || is_touched { theme.ink } else { theme.quiet.mix(theme.plate, 0.5) };
        let line = egui::Stroke::new(1.3, color(ink));
        let (painter, at) = (ui.painter(), rect.center());
        if response.has_focus() {
            painter.rect_stroke(
                rect,
                4,
                egui::Stroke::new(2.0, color(theme.accent)),
                egui::StrokeKind::Inside,
            );
        }
        match self {
            Self::Hide => {
                painter.add(egui::epaint::EllipseShape::stroke(at, vec2(6.0, 3.6), line));
                painter.circle_filled(at, 1.8, color(ink));
                if is_on {
                    painter.line_segment([at + vec2(-5.5, 5.5), at + vec2(5.5, -5.5)], line);
                }
            }
            Self::Lock => {
                let body = egui::Rect::from_min_max(at + vec2(-4.0, -0.5), at + vec2(4.0, 5.5));
                painter.rect(
                    body,
                    1,
                    color(ink).gamma_multiply(f32::from(u8::from(is_on))),
                    line,
                    egui::StrokeKind::Middle,
                );
                // An open one has its shackle aside.
                let aside = if is_on { 0.0 } else { 3.0 };
                let points =
                    [(-2.5, -0.5), (-2.5, -4.0), (2.5, -4.0), (2.5, if is_on { -0.5 } else { -2.5 })];
                let points = points.map(|(x, y)| at + vec2(x + aside, y));
                painter.add(egui::Shape::line(points.to_vec(), line));
            }
        }
        response
    }
}
