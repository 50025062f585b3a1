//! The palette of things to put down: kinds of controls with their pictures, regions, places to stand, grounds.

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{FocusDirection, Key, Margin, Panel, Response, ScrollArea, Sense, Ui, WidgetInfo, vec2};
use glam::Vec2;

use super::edited::EditedLayout;
use super::list::list;
use super::{Pane, Panes};
use crate::edit::{Address, Document, Edit, RecordList};
use crate::preview::style::{panel_frame, section};
use underfoot::engine::Snapshot;
use underfoot::floor::{Geometry, Rect};
use underfoot::layout::{Layout, Widget};
use underfoot::widget::WidgetId;
use underfoot_format::text::Text;
use underfoot_scene::egui_painter::{self, Palette, ScreenFromFloor, color};
use underfoot_scene::scene::{self, Scene, Show, Theme, View};

/// Size of a control of about one tile: 16 cm and more suit a shoe (rule U101).
const SMALL_M: Vec2 = Vec2::new(0.18, 0.16);

/// Size of a control that needs room to slide or lean.
const WIDE_M: Vec2 = Vec2::new(0.36, 0.18);

/// Height of a picture in the palette, in points.
const PICTURE: f32 = 34.0;

/// Something to put down.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum PaletteThing {
    /// A control of this kind.
    Control(String),
    Region,
    Stance,
    /// A ground of this name.
    Ground(&'static str),
}

impl PaletteThing {
    fn name(&self) -> String {
        match self {
            Self::Control(kind) => kind.replace('_', " "),
            Self::Region => "region".into(),
            Self::Stance => "place to stand".into(),
            Self::Ground(name) => name.to_lowercase(),
        }
    }

    /// Its size when it is put down, in metres: a multiple of a twentieth of a tile.
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

/// Shows all things to choose from, and below them the list of records.
pub(super) fn palette_panel(
    ui: &mut Ui,
    theme: &Theme,
    palette: &mut Palette,
    edited: &mut EditedLayout,
    placing: &mut Option<PaletteThing>,
    panes: &mut Panes,
) {
    let frame = panel_frame(theme, Margin { left: 12, right: 4, top: 0, bottom: 6 });
    let panel = Panel::left("palette").frame(frame).resizable(true);
    panel.default_size(204.0).size_range(150.0..=300.0).show(ui, |ui| {
        let half = 0.5 * ui.available_height();
        let below = Panel::bottom("on the floor").frame(egui::Frame::new()).resizable(true);
        below.default_size(0.36 * ui.available_height()).size_range(90.0..=half.max(91.0)).show(ui, |ui| {
            section(ui, theme, "On the floor", |_| {});
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                ui.set_width(ui.available_width() - 8.0);
                list(ui, theme, edited, panes);
            });
        });
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.set_width(ui.available_width() - 8.0);
            section(ui, theme, "Put down", |_| {});
            let kinds: Vec<String> = edited.document.kinds().iter().map(|kind| kind.name.clone()).collect();
            let controls = kinds.into_iter().map(PaletteThing::Control);
            let places = [PaletteThing::Region, PaletteThing::Stance];
            let grounds = ["Ice", "Snow", "Gravel", "Sand", "Wood"].map(PaletteThing::Ground);
            let is_led = panes.leads_to(Pane::Things);
            let things = controls.chain(places).chain(grounds);
            let shown: Vec<Response> =
                things.map(|thing| show_thing(ui, theme, palette, thing, edited, placing)).collect();
            if is_led && let Some(first) = shown.first() {
                first.request_focus();
                first.scroll_to_me(None);
            }
            go_on(ui, &shown);
            if ui.button("Add a page").clicked() {
                edited.add_page();
            }
        });
    });
}

fn show_thing(
    ui: &mut Ui,
    theme: &Theme,
    palette: &mut Palette,
    thing: PaletteThing,
    edited: &mut EditedLayout,
    placing: &mut Option<PaletteThing>,
) -> Response {
    let size = vec2(ui.available_width(), PICTURE + 6.0);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    if response.gained_focus() {
        response.scroll_to_me(None);
    }
    let name = thing.name();
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Put down: {name}")));
    if ui.is_rect_visible(rect) {
        let is_chosen = placing.as_ref() == Some(&thing);
        let visuals = ui.style().interact_selectable(&response, is_chosen);
        ui.painter().rect(rect, 6, visuals.weak_bg_fill, visuals.bg_stroke, egui::StrokeKind::Inside);
        if is_chosen {
            ui.painter().rect_filled(rect, 6, color(theme.accent).gamma_multiply(0.2));
        }
        let picture = egui::Rect::from_min_size(rect.min + vec2(5.0, 3.0), vec2(54.0, PICTURE));
        if let PaletteThing::Control(kind) = &thing {
            draw_control(ui, theme, palette, &edited.document, kind, picture);
        } else {
            let ink = egui::Stroke::new(1.5, color(theme.accent));
            ui.painter().rect_stroke(picture.shrink(4.0), 3, ink, egui::StrokeKind::Inside);
        }
        let at = egui::pos2(picture.right() + 7.0, rect.center().y);
        let font = egui::FontId::proportional(12.5);
        ui.painter().with_clip_rect(rect).text(at, egui::Align2::LEFT_CENTER, &name, font, color(theme.ink));
    }
    if response.drag_started() || response.clicked() {
        // The keyboard has no pointer position: the thing goes to the first free place.
        let by_key =
            response.clicked() && ui.input(|i| i.key_pressed(Key::Enter) || i.key_pressed(Key::Space));
        if by_key {
            edited.put_somewhere(&thing);
        } else {
            *placing = if placing.as_ref() == Some(&thing) { None } else { Some(thing) };
        }
    }
    response
        .on_hover_text("Click, then click on the floor; or drag it there; Enter puts it where there is room")
}

/// Draws a control of this kind as it looks on the floor.
fn draw_control(
    ui: &Ui,
    theme: &Theme,
    palette: &mut Palette,
    document: &Document,
    kind: &str,
    picture: egui::Rect,
) {
    let Some(kind) = document.kinds().get(kind) else { return };
    let size = PaletteThing::Control(kind.name.clone()).size(&document.floor().geometry);
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
        send: Vec::new(),
    };
    let layout = Layout {
        title: String::new(),
        regions: Vec::new(),
        stances: Vec::new(),
        pages: Vec::new(),
        targets: Vec::new(),
        grounds: Vec::new(),
        widgets: vec![widget],
    };
    let snapshot = Snapshot::default();
    let geometry = document.floor().geometry;
    let view = View { show: Show::PROJECTOR, ..View::new(&geometry, &layout, &snapshot, theme) };
    let mut drawn = Scene::new();
    scene::draw(&mut drawn, &view);
    let map = ScreenFromFloor::fit(area.grown(0.01), picture);
    // Clip off the floor around the control.
    let clip = map.rect(area.grown(0.004)).intersect(ui.clip_rect());
    egui_painter::paint(&ui.painter().with_clip_rect(clip), palette, &drawn, map);
}

impl EditedLayout {
    /// Puts `thing` on `area`, in floor metres; returns whether the layout accepts it.
    pub(super) fn put(&mut self, thing: &PaletteThing, area: Rect) -> bool {
        let on_page = |list| {
            let page = self.layout().pages.get(self.page).map(|_| Address::of(RecordList::Pages, self.page));
            page.unwrap_or(Address::LAYOUT).entry(list, usize::MAX)
        };
        let place = self.document.placed(area);
        let (at, text) = match thing {
            PaletteThing::Control(kind) => {
                (on_page(RecordList::Widgets), self.document.new_control(kind, area))
            }
            PaletteThing::Ground(name) => {
                (on_page(RecordList::Grounds), Text::Variant(name, place.into()).inline())
            }
            PaletteThing::Stance => {
                let [at, size] = place;
                let fields = vec![at, size, ("label", Text::quoted("Stand here"))];
                (
                    Address::LAYOUT.entry(RecordList::Stances, usize::MAX),
                    Text::Record("Stance", fields).inline(),
                )
            }
            PaletteThing::Region => {
                let [at, size] = place;
                let fields = vec![("id", Text::quoted(self.document.free_id("region", &[]))), at, size];
                (
                    Address::LAYOUT.entry(RecordList::Regions, usize::MAX),
                    Text::Record("Region", fields).inline(),
                )
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

    /// Puts `thing` at the first place of a grid of half tiles that the reader accepts.
    fn put_somewhere(&mut self, thing: &PaletteThing) {
        let geometry = self.document.floor().geometry;
        let size = thing.size(&geometry);
        let step = 0.5 * geometry.pitch_m();
        let within = match thing {
            PaletteThing::Control(_) => {
                self.layout().regions.first().map_or(geometry.bounds(), |region| region.area)
            }
            _ => geometry.bounds(),
        };
        let steps = ((within.size() - size) / step).max(Vec2::ZERO).floor();
        for row in 0..=steps.y as u32 {
            for column in 0..=steps.x as u32 {
                let at = within.min + Vec2::new(column as f32, row as f32) * step + Vec2::splat(0.2 * step);
                let area = Rect::from_min_size(at.min(within.max - size), size);
                // Half a shoe of room (rule U102), where possible.
                let wide = area.grown(0.06);
                let is_taken = |item: &crate::edit::Item| {
                    item.record.list() == Some(RecordList::Widgets)
                        && item.is_on(self.page)
                        && item.area.overlaps(wide)
                };
                if matches!(thing, PaletteThing::Control(_)) && self.items.iter().any(is_taken) {
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
        let id = Text::quoted(self.document.free_id("page_1", &[]));
        let page = Text::Record("Page", vec![("id", id), ("widgets", Text::List(Vec::new()))]);
        let at = Address::of(RecordList::Pages, usize::MAX);
        if self.edit(&[Edit::Insert { at, text: page.inline() }]) {
            self.refresh();
            self.page = self.layout().pages.len().saturating_sub(1);
            self.selected = vec![Address::of(RecordList::Pages, self.page)];
        }
    }
}

/// Arrow keys move through the whole list, scrolled-out entries included, and do not leave it at its end.
pub(super) fn go_on(ui: &Ui, shown: &[Response]) {
    let Some(at) = shown.iter().position(Response::has_focus) else { return };
    let (up, down) = ui.input(|i| (i.key_pressed(Key::ArrowUp), i.key_pressed(Key::ArrowDown)));
    if up == down {
        return;
    }
    ui.memory_mut(|memory| memory.move_focus(FocusDirection::None));
    let next = if up { at.checked_sub(1) } else { at.checked_add(1) };
    if let Some(next) = next.and_then(|next| shown.get(next)) {
        next.request_focus();
        next.scroll_to_me(None);
    }
}
