//! The palette of things to put down: searched by words, in sections of what feet do there, each with its picture.

mod in_hand;
mod picture;
mod put;
mod thing;

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{
    Id, Key, Margin, Panel, Response, RichText, ScrollArea, Sense, TextEdit, Ui, WidgetInfo, vec2,
};

use super::canvas::Canvas;
use super::edited::EditedLayout;
use super::list::list;
use super::list_keys::go_on;
use super::{Pane, Panes};
use crate::preview::handheld::{TARGET, is_for_fingers, panel_at};
use crate::preview::style::{panel_frame, quiet, replace_by_typing, section, write_within};
use in_hand::PutOrder;
use thing::PaletteSection;
use underfoot_scene::egui_painter::{Palette, color};
use underfoot_scene::scene::Theme;

pub(super) use in_hand::InHand;
pub(super) use picture::{draw_thing, draw_widget, is_shipped};
pub(super) use thing::PaletteThing;

/// Size of a picture in the palette, in points.
const PICTURE: egui::Vec2 = vec2(50.0, 30.0);

/// Height below which the list of things stands alone in the panel, in points.
const LOWEST: f32 = 280.0;

/// Maximum number of recently used things on display.
const RECENT: usize = 3;

/// The list of things to put down.
#[derive(Default)]
pub(super) struct ThingList {
    /// The words of the search.
    words: String,
    /// Whether the search was used since the pointer came to it.
    is_searched: bool,
    /// The things that were taken last, the latest first.
    recent: Vec<PaletteThing>,
}

/// A thing in the list, under its heading.
struct ThingRow {
    heading: Option<&'static str>,
    hand: InHand,
    /// Whether it stands in the list of the recently used ones.
    is_recent: bool,
}

/// The wish of the user about a thing.
enum ThingWish {
    /// Take it in hand, or put it back.
    Take(InHand),
    /// Put all of these at free places: the keyboard has no pointer position.
    Put(Vec<InHand>),
}

impl ThingList {
    /// Shows all things to choose from, and below them the list of records.
    pub(super) fn panel(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        palette: &mut Palette,
        edited: &mut EditedLayout,
        canvas: &mut Canvas,
        panes: &mut Panes,
    ) {
        let frame = panel_frame(theme, Margin { left: 12, right: 4, top: 0, bottom: 6 });
        let panel = panel_at(panes.sheet, || {
            // In a narrow window all panels have one place.
            let panel = if panes.is_narrow { Panel::right("palette") } else { Panel::left("palette") };
            panel.resizable(true).default_size(204.0).size_range(150.0..=300.0)
        });
        panel.frame(frame).show(ui, |ui| {
            let half = 0.5 * ui.available_height();
            let below = Panel::bottom("on the floor").frame(egui::Frame::new()).resizable(true);
            let below = below.default_size(0.36 * ui.available_height()).size_range(90.0..=half.max(91.0));
            // A low panel has room for one list.
            if ui.available_height() >= LOWEST {
                below.show(ui, |ui| {
                    section(ui, theme, "On the floor", |_| {});
                    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                        ui.set_width(ui.available_width() - 8.0);
                        list(ui, theme, edited, &mut canvas.in_place, panes);
                    });
                });
            }
            ui.add_space(8.0);
            let is_led = panes.leads_to(Pane::Things);
            let search = self.search(ui, is_led);
            let wish = ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                ui.set_width(ui.available_width() - 8.0);
                self.show(ui, theme, palette, edited, canvas.placing.as_ref(), search)
            });
            if let Some(wish) = wish.inner {
                self.obey(wish, edited, &mut canvas.placing);
            }
        });
    }

    fn obey(&mut self, wish: ThingWish, edited: &mut EditedLayout, placing: &mut Option<InHand>) {
        let used = match &wish {
            ThingWish::Take(hand) => std::slice::from_ref(hand),
            ThingWish::Put(hands) => &hands[..],
        };
        for hand in used {
            self.recent.retain(|known| *known != hand.thing);
            self.recent.insert(0, hand.thing.clone());
        }
        self.recent.truncate(RECENT);
        match wish {
            ThingWish::Put(hands) => {
                edited.put_all(hands);
                self.words.clear();
            }
            ThingWish::Take(hand) => {
                *placing = if placing.as_ref() == Some(&hand) { None } else { Some(hand) };
            }
        }
    }

    /// The field for the words of a search.
    fn search(&mut self, ui: &mut Ui, is_led: bool) -> Response {
        let width = ui.available_width() - 12.0;
        let field = TextEdit::singleline(&mut self.words).hint_text("Search").desired_width(width);
        let field = field.align(egui::Align2::LEFT_CENTER);
        let field = ui.add(field);
        field.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, "Search things"));
        if is_led {
            field.request_focus();
        }
        replace_by_typing(ui, &field, &self.words);
        if field.lost_focus() && ui.input(|i| i.key_pressed(Key::Escape)) {
            self.words.clear();
        }
        if field.has_focus() || !self.words.is_empty() {
            self.is_searched = true;
        } else if !field.hovered() {
            self.is_searched = false;
        }
        if self.is_searched {
            // The hint would cover the list of what is found.
            return field;
        }
        field.on_hover_text(
            "Enter puts the first one where there is room; several at once, with labels: 3 button: Map, Help, Home; switch",
        )
    }

    /// The rows that fit the words of the search, the best first; all in their sections without words.
    fn rows(&self, edited: &EditedLayout) -> Vec<ThingRow> {
        let all = all_things(edited);
        let orders = PutOrder::all(&self.words);
        if let Some((last, before)) = orders.split_last() {
            let row = |hand| ThingRow { heading: None, hand, is_recent: false };
            // The best one of each part, and all that fit the part that is being typed.
            let best = before.iter().filter_map(|order| fits(&all, *order).into_iter().next());
            return best.chain(fits(&all, *last)).map(row).collect();
        }
        let own = all.iter().filter(|(section, _)| *section == PaletteSection::Own).count();
        let row = |heading: &'static str, is_first: bool, thing: PaletteThing, is_recent: bool| ThingRow {
            heading: is_first.then_some(heading),
            hand: InHand::one(thing),
            is_recent,
        };
        let mut rows = Vec::new();
        let mut before = None;
        for (section, thing) in all.iter().take(own) {
            rows.push(row(section.title(), before.replace(*section) != Some(*section), thing.clone(), false));
        }
        // A kind that the layout no longer has can't be used again.
        let known = self.recent.iter().filter(|thing| all.iter().any(|(_, other)| other == *thing));
        for (number, thing) in known.enumerate() {
            rows.push(row("Recently used", number == 0, thing.clone(), true));
        }
        for (section, thing) in all.into_iter().skip(own) {
            rows.push(row(section.title(), before.replace(section) != Some(section), thing, false));
        }
        rows
    }

    fn show(
        &self,
        ui: &mut Ui,
        theme: &Theme,
        palette: &mut Palette,
        edited: &mut EditedLayout,
        placing: Option<&InHand>,
        search: Response,
    ) -> Option<ThingWish> {
        let rows = self.rows(edited);
        let mut wish = None;
        let orders = PutOrder::all(&self.words);
        if search.lost_focus() && ui.input(|i| i.key_pressed(Key::Enter)) && !orders.is_empty() {
            let all = all_things(edited);
            // A part that names nothing is off the list, and then nothing is put down.
            let hands: Option<Vec<InHand>> =
                orders.iter().map(|order| fits(&all, *order).into_iter().next()).collect();
            wish = hands.map(ThingWish::Put);
            search.request_focus();
        }
        if rows.is_empty() {
            ui.label(quiet(theme, "Nothing is called so."));
        }
        let (mut shown, mut known) = (vec![search], Vec::new());
        for row in rows {
            if let Some(heading) = row.heading {
                ui.add_space(4.0);
                ui.label(RichText::new(heading).size(12.0).strong().color(color(theme.quiet)));
            }
            let is_chosen = placing.is_some_and(|hand| hand.thing == row.hand.thing) && !row.is_recent;
            // Two parts of a search may name the same thing.
            let own = (row.hand.thing.clone(), row.is_recent);
            let again = known.iter().filter(|known| **known == own).count();
            known.push(own);
            let response = show_row(ui, theme, palette, edited, &row, is_chosen, again);
            if response.drag_started() || response.clicked() {
                let is_key = response.clicked()
                    && ui.input(|i| i.key_pressed(Key::Enter) || i.key_pressed(Key::Space));
                wish = Some(match is_key {
                    true => ThingWish::Put(vec![row.hand]),
                    false => ThingWish::Take(row.hand),
                });
            }
            shown.push(response);
        }
        go_on(ui, &shown);
        ui.add_space(4.0);
        if ui.button("Add a page").clicked() {
            edited.add_page();
        }
        wish
    }
}

/// All things that can be put down, by section.
fn all_things(edited: &EditedLayout) -> Vec<(PaletteSection, PaletteThing)> {
    let kinds = edited.document.all_kinds();
    PaletteThing::all(kinds, |name| kinds.get(name).is_some_and(|kind| !is_shipped(kind)))
}

/// The things that fit a part of a search, the best first.
fn fits(all: &[(PaletteSection, PaletteThing)], order: PutOrder<'_>) -> Vec<InHand> {
    let ranked = all.iter().filter_map(|(section, thing)| Some((thing.rank(*section, order.words)?, thing)));
    let mut ranked: Vec<(u8, &PaletteThing)> = ranked.collect();
    ranked.sort_by_key(|(rank, _)| *rank);
    ranked.into_iter().map(|(_, thing)| order.take(thing.clone())).collect()
}

/// One thing with its picture.
fn show_row(
    ui: &mut Ui,
    theme: &Theme,
    palette: &mut Palette,
    edited: &EditedLayout,
    row: &ThingRow,
    is_chosen: bool,
    again: usize,
) -> Response {
    let height = if is_for_fingers(ui) { TARGET } else { PICTURE.y + 6.0 };
    let size = vec2(ui.available_width(), height);
    let (_, rect) = ui.allocate_space(size);
    // A row keeps the keyboard when rows appear or disappear above.
    let id = Id::unique(("palette", row.hand.thing.name(), row.is_recent, again));
    let response = ui.interact(rect, id, Sense::click_and_drag());
    if response.gained_focus() {
        response.scroll_to_me(None);
    }
    let name = row.hand.thing.name();
    let does = if row.is_recent { "Put down again" } else { "Put down" };
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("{does}: {name}")));
    if ui.is_rect_visible(rect) {
        let visuals = ui.style().interact_selectable(&response, is_chosen);
        ui.painter().rect(rect, 6, visuals.weak_bg_fill, visuals.bg_stroke, egui::StrokeKind::Inside);
        if is_chosen {
            ui.painter().rect_filled(rect, 6, color(theme.accent).gamma_multiply(0.2));
        }
        let picture = egui::Rect::from_min_size(rect.min + vec2(5.0, 0.5 * (height - PICTURE.y)), PICTURE);
        draw_thing(ui, theme, palette, &edited.document, &row.hand.thing, picture);
        let at = egui::pos2(picture.right() + 7.0, rect.center().y);
        let font = egui::FontId::proportional(12.5);
        write_within(ui.painter(), at, rect.right() - at.x - 4.0, &name, font, color(theme.ink));
    }
    response
        .on_hover_text("Click, then click on the floor, with Shift for several; or drag it there; Enter puts it where there is room")
}
