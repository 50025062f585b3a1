//! What is selected, field by field: made from the same descriptions that its file is read by.

use std::collections::HashMap;
use std::sync::Arc;

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::text::CCursor;
use eframe::egui::text_selection::CCursorRange;
use eframe::egui::{
    ComboBox, DragValue, Key, Margin, Panel, Response, RichText, ScrollArea, TextEdit, Ui, WidgetInfo,
};
use glam::Vec2;

use super::{Designer, Pane};
use crate::edit::{Address, Edit, Origin, Property, Section};
use crate::egui_painter::color;
use crate::feel::{Effect, Feel, Gesture};
use crate::floor::Rect;
use crate::format::describe::FieldType;
use crate::format::diagnostic::Severity;
use crate::format::number::plain;
use crate::format::words::unit;
use crate::layout::Widget;
use crate::preview::PreviewCommand;
use crate::preview::style::{panel_frame, quiet, section};
use crate::scene::Theme;

/// The inspector's own memory.
#[derive(Default)]
pub(super) struct Inspector {
    /// Fields in which something is being typed.
    typed: HashMap<String, String>,
    /// What is shown, and for which record and revision.
    shown: Vec<Section>,
    of: Option<(Address, u64)>,
}

/// Its width, in points.
const INSPECTOR_PX: f32 = 330.0;

/// Widths of a field's name and of a text that is typed, in points.
const NAME_PX: f32 = 96.0;
const TYPED_PX: f32 = 122.0;

/// Height of a row.
const ROW_PX: f32 = 24.0;

/// Fields that no record does without.
const KEPT: [&str; 3] = ["id", "kind", "at"];

impl Designer {
    /// The inspector.
    pub(super) fn side_panel(&mut self, ui: &mut Ui, theme: &Theme) {
        let frame = panel_frame(theme, Margin { left: 14, right: 6, top: 0, bottom: 6 });
        // As wide whatever it shows: the floor beside it must not move under the pointer.
        let panel = Panel::right("inspector").frame(frame).resizable(false);
        panel.exact_size(INSPECTOR_PX).show(ui, |ui| {
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                ui.set_width(ui.available_width() - 8.0);
                self.inspector(ui, theme);
            });
        });
    }

    fn inspector(&mut self, ui: &mut Ui, theme: &Theme) {
        let record = match &self.selected[..] {
            [] => Address::LAYOUT,
            [record] => record.clone(),
            more => {
                section(ui, theme, &format!("{} selected", more.len()), |_| {});
                ui.label(quiet(theme, "Arrange, move, duplicate or delete them together."));
                return;
            }
        };
        let item = self.item(&record).cloned();
        let title = match (&item, record.split()) {
            (Some(item), _) if !item.name.is_empty() => item.name.clone(),
            (_, Some(_)) => record.to_string(),
            _ => "The layout".to_owned(),
        };
        section(ui, theme, &title, |_| {});
        if let Some(item) = &item {
            let (at, size) = (item.area.min, item.area.size() * 100.0);
            let text = format!("{:.1} x {:.1} cm, {:.3} m east, {:.3} m north", size.x, size.y, at.x, at.y);
            ui.label(quiet(theme, text));
        }
        self.problems_of(ui, theme, &record);
        let revision = self.document.revision();
        if self.inspector.of != Some((record.clone(), revision)) {
            self.inspector.shown = self.document.properties(&record, item.as_ref());
            self.inspector.of = Some((record.clone(), revision));
            self.inspector.typed.clear();
        }
        let shown = std::mem::take(&mut self.inspector.shown);
        let mut wanted = None;
        let mut is_led = self.leads_to(Pane::Fields);
        for (number, part) in shown.iter().enumerate() {
            let heading = RichText::new(&part.title).strong().color(color(theme.ink));
            egui::CollapsingHeader::new(heading).id_salt(("part", number)).default_open(number < 2).show(
                ui,
                |ui| {
                    for property in &part.properties {
                        let is_led = std::mem::take(&mut is_led);
                        // What has the keyboard keeps it, also when a warning comes or goes above.
                        let id = egui::Id::unique(("field", record.to_string(), &property.name));
                        let row = ui.scope_builder(egui::UiBuilder::new().scope_id(id), |ui| {
                            self.property(ui, theme, &record, property, is_led)
                        });
                        wanted = row.inner.or(wanted.take());
                    }
                },
            );
        }
        self.inspector.shown = shown;
        if let Some(edit) = wanted {
            self.edit_in(&[edit], None);
        }
    }

    /// What is wrong with the record, in centimetres, and what mends it.
    fn problems_of(&mut self, ui: &mut Ui, theme: &Theme, record: &Address) {
        let mut mend = None;
        let own =
            self.findings.iter().filter(|finding| self.document.found_in(finding).as_ref() == Some(record));
        for finding in own {
            let colour = if finding.severity == Severity::Error { theme.fault } else { theme.warning };
            let text = format!("{}: {}; {}", finding.rule.code, finding.message, finding.expected);
            ui.add(egui::Label::new(RichText::new(text).color(color(colour))).wrap())
                .on_hover_text(finding.rule.source);
            if let Some(help) = &finding.help {
                ui.add(egui::Label::new(quiet(theme, help)).wrap());
            }
            if let Some((name, edits)) = self.document.mend(finding, &self.items)
                && ui.button(format!("{name}: do it")).clicked()
            {
                mend = Some(edits);
            }
        }
        for problem in self.document.warnings().iter() {
            if self.document.told_of(problem).as_ref() == Some(record) {
                let text = format!("{}: {}", problem.message, problem.expected);
                ui.add(egui::Label::new(RichText::new(text).color(color(theme.warning))).wrap());
            }
        }
        if let Some(edits) = mend {
            self.edit(&edits);
        }
    }

    /// One field; what shall be done to it.
    fn property(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        record: &Address,
        property: &Property,
        is_led: bool,
    ) -> Option<Edit> {
        let mut wanted = None;
        let short = property.short();
        let is_written = property.origin == Origin::Written;
        ui.horizontal(|ui| {
            let source = match &property.origin {
                Origin::Written => "written here".to_owned(),
                Origin::Kind(kind) => format!("from the kind \"{kind}\""),
                Origin::Default => "not written".to_owned(),
            };
            let name =
                if property.is_place() { format!("{short} ({})", self.unit_name()) } else { short.into() };
            let name = RichText::new(name).color(color(if is_written { theme.ink } else { theme.quiet }));
            ui.allocate_ui_with_layout(
                egui::vec2(NAME_PX, ROW_PX),
                egui::Layout::left_to_right(egui::Align::Center),
                |ui| {
                    ui.set_min_width(NAME_PX);
                    ui.add(egui::Label::new(name).truncate())
                        .on_hover_text(format!("{}\n{}\n{source}", property.about, property.told));
                },
            );
            let (edit, editor) = self.value(ui, record, property);
            wanted = edit;
            if is_led {
                editor.request_focus();
            }
            if editor.gained_focus() {
                editor.scroll_to_me(None);
            }
            self.hear(ui, record, property);
            match &property.origin {
                Origin::Written if !KEPT.contains(&property.name.as_str()) => {
                    let reset = ui.small_button("x");
                    reset.widget_info(|| {
                        WidgetInfo::labeled(Role::Button, true, format!("Leave out {short}"))
                    });
                    if reset.on_hover_text("Take it out: the kind's value counts again").clicked() {
                        wanted = Some(Edit::unset(record, &property.name));
                    }
                }
                Origin::Kind(kind) => {
                    let text = quiet(theme, format!("from {kind}")).size(11.5);
                    ui.add(egui::Label::new(text).truncate()).on_hover_text(source);
                }
                Origin::Default if !property.value.is_empty() => {
                    ui.label(quiet(theme, "default").size(11.5));
                }
                _ => {}
            }
        });
        if property.name == "id"
            && let Some(Edit::Set { value, .. }) = &wanted
        {
            return Some(Edit::Rename { record: record.clone(), id: value.trim_matches('"').to_owned() });
        }
        wanted
    }

    /// What a field says, to be changed.
    fn value(&mut self, ui: &mut Ui, record: &Address, property: &Property) -> (Option<Edit>, Response) {
        let set = |value: String| Some(Edit::set(record, &property.name, value));
        let (short, value) = (property.short(), property.value.as_str());
        if property.is_place()
            && let Some(pair) = self.place_of(record, property)
        {
            return self.place(ui, record, property, pair);
        }
        if let Some(choices) = self.choices(property) {
            let shown = self.felt(record, property).map_or_else(
                || value.trim_matches('"').to_owned(),
                |effect| self.effect_name(&effect).unwrap_or("its own").to_owned(),
            );
            let (chosen, response) = choice(ui, short, &shown, &choices);
            return (chosen.and_then(set), response);
        }
        match &property.shape {
            FieldType::Flag => {
                let mut on = value == "true";
                let tick = ui.checkbox(&mut on, "");
                tick.widget_info(|| WidgetInfo::selected(Role::CheckBox, true, on, short));
                (tick.changed().then(|| set(on.to_string())).flatten(), tick)
            }
            FieldType::Number { range: (low, high), whole } if value.parse::<f64>().is_ok() => {
                let mut number: f64 = value.parse().unwrap_or_default();
                let drag = DragValue::new(&mut number)
                    .range(*low..=*high)
                    .speed(if *whole { 0.1 } else { ((high - low) * 2e-3).min(1.0) })
                    .max_decimals(if *whole { 0 } else { 4 })
                    .suffix(if *whole { "" } else { unit(short) })
                    .update_while_editing(false);
                let drag = ui.add(drag);
                drag.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, short));
                let changed = drag.changed().then(|| set(plain(number))).flatten();
                (self.dragged(&drag, changed), drag)
            }
            shape => {
                let is_text = matches!(shape, FieldType::Text(_)) && property.value != "None";
                let (typed, response) = self.typed(ui, property, is_text);
                (typed.and_then(set), response)
            }
        }
    }

    /// All of one drag is one step, done here; what is typed is left to be done.
    fn dragged(&mut self, drag: &Response, edit: Option<Edit>) -> Option<Edit> {
        if drag.drag_started() {
            self.stroke += 1;
        }
        if !drag.dragged() {
            return edit;
        }
        if let Some(edit) = edit {
            self.edit_in(&[edit], Some(self.stroke));
        }
        None
    }

    fn unit_name(&self) -> &'static str {
        if self.document.unit_m() == 1.0 { "m" } else { "tiles" }
    }

    /// The two numbers of a place or a size, in the layout's unit; where it follows from a neighbour, as it came out.
    fn place_of(&self, record: &Address, property: &Property) -> Option<[f64; 2]> {
        if property.origin == Origin::Written {
            let (one, other) = property.value.trim_matches(['(', ')']).split_once(',')?;
            let number = |text: &str| text.trim().trim_end_matches(',').trim().parse::<f64>().ok();
            return Some([number(one)?, number(other)?]);
        }
        let area = self.item(record).filter(|item| !item.is_group)?.area;
        let metres = if property.name == "at" { area.min } else { area.size() };
        let unit = self.document.unit_m();
        Some([metres.x, metres.y].map(|metres| (f64::from(metres) / unit * 1e4).round() / 1e4))
    }

    fn place(
        &mut self,
        ui: &mut Ui,
        record: &Address,
        property: &Property,
        before: [f64; 2],
    ) -> (Option<Edit>, Response) {
        let is_at = property.name == "at";
        let names = if is_at { ["east", "north"] } else { ["width", "depth"] };
        let unit = self.document.unit_m();
        let mut now = before;
        let drags = [0, 1].map(|side| {
            let drag = DragValue::new(&mut now[side])
                .speed(0.01)
                .max_decimals(4)
                .custom_parser(move |text| length(text, unit))
                .update_while_editing(false);
            let drag = ui.add_sized([66.0, ROW_PX], drag);
            let name = format!("{} {}", property.name, names[side]);
            drag.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, &name));
            drag.on_hover_text(format!("{}: in {}, or with cm or m behind it", names[side], self.unit_name()))
        });
        let value = format!("({}, {})", plain(now[0]), plain(now[1]));
        let wanted = (now != before).then(|| Edit::set(record, &property.name, value));
        let [first, second] = drags;
        let wanted = self.dragged(&first, wanted);
        let wanted = self.dragged(&second, wanted);
        let Some(edit) = wanted else { return (None, first) };
        if property.origin == Origin::Written {
            return (Some(edit), first);
        }
        // What stood beside a neighbour gets a place of its own.
        if let Some(item) = self.item(record).cloned() {
            let metres = Vec2::new((now[0] * unit) as f32, (now[1] * unit) as f32);
            let area = match is_at {
                true => Rect::from_min_size(metres, item.area.size()),
                false => Rect::from_min_size(item.area.min, metres),
            };
            match self.document.placing(&[(&item, area)]) {
                Ok(edits) => drop(self.edit(&edits)),
                Err(refusal) => self.complain(refusal.short()),
            }
        }
        (None, first)
    }

    /// What may be chosen for a field, as it would be written; `None` for one that is typed.
    fn choices(&self, property: &Property) -> Option<Vec<String>> {
        let quoted = |names: Vec<String>| names.into_iter().map(|name| format!("\"{name}\"")).collect();
        match (&property.shape, property.name.as_str()) {
            (FieldType::Names(names), "kind") if names.is_empty() => {
                Some(quoted(self.document.kinds().iter().map(|kind| kind.name.clone()).collect()))
            }
            (FieldType::Names(names), _) => Some(names.iter().map(|name| (*name).to_owned()).collect()),
            (_, "goto") if !self.layout().pages.is_empty() => {
                Some(quoted(self.layout().pages.iter().map(|page| page.id.to_string()).collect()))
            }
            (FieldType::Optional(_), name) if name.starts_with("feel.") => {
                let names = self.document.kinds().effects().iter().map(|named| named.name.clone()).collect();
                let names: Vec<String> = quoted(names);
                Some(std::iter::once("None".to_owned()).chain(names).collect())
            }
            _ => None,
        }
    }

    fn widget_of(&self, record: &Address) -> Option<&Widget> {
        let item = self.item(record).filter(|item| !item.is_group)?;
        self.layout().widgets.get(item.widgets.start)
    }

    /// The effect that a field of the feel stands for, be it written here or in the kind.
    fn felt(&self, record: &Address, property: &Property) -> Option<Arc<Effect>> {
        let part = property.name.strip_prefix("feel.")?;
        let Feel { press, release, step, end, stage, arm, warn, on, off, hold, drag, sound: _ } =
            &self.widget_of(record)?.feel;
        let parts = [
            ("press", press),
            ("release", release),
            ("step", step),
            ("end", end),
            ("stage", stage),
            ("arm", arm),
            ("warn", warn),
            ("on", on),
            ("off", off),
            ("hold", hold),
            ("drag", drag),
        ];
        parts.into_iter().find(|(name, _)| *name == part)?.1.clone()
    }

    fn effect_name(&self, effect: &Effect) -> Option<&str> {
        let mut all = self.document.kinds().effects().iter();
        all.find(|named| *named.effect == *effect).map(|named| named.name.as_str())
    }

    /// A button that plays what the field stands for, on the tile under the control.
    fn hear(&mut self, ui: &mut Ui, record: &Address, property: &Property) {
        let Some(effect) = self.felt(record, property) else { return };
        let button = ui.small_button("Hear");
        button.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Hear {}", property.short())));
        if button.on_hover_text("Play it on the tile under the control").clicked() {
            let geometry = self.document.floor().geometry;
            let centre = self.item(record).map_or(geometry.bounds().centre(), |item| item.area.centre());
            let tile = geometry.tile_under(centre).and_then(|tile| geometry.index(tile)).unwrap_or_default();
            let gesture = Gesture::usual(&effect);
            self.wish = Some(PreviewCommand::Feel { effect, gesture, tile });
        }
    }

    /// A field that is typed; what was typed, once that is done.
    fn typed(&mut self, ui: &mut Ui, property: &Property, is_text: bool) -> (Option<String>, Response) {
        // What nobody has written is not there to be edited: it may be words.
        let is_default = property.origin == Origin::Default;
        let shown = if is_text { property.value.trim_matches('"') } else { &property.value };
        let (shown, hint) = if is_default { ("", shown) } else { (shown, "") };
        let typed = self.inspector.typed.entry(property.name.clone()).or_insert_with(|| shown.to_owned());
        let field = ui.add(TextEdit::singleline(typed).hint_text(hint).desired_width(TYPED_PX));
        field.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, &property.name));
        if field.gained_focus()
            && let Some(mut state) = TextEdit::load_state(ui.ctx(), field.id)
        {
            // As in a table: what is typed takes the place of what was there.
            let all = CCursorRange::two(CCursor::new(0), CCursor::new(typed.chars().count()));
            state.cursor.set_char_range(Some(all));
            state.store(ui.ctx(), field.id);
        }
        let done = field.lost_focus() && typed != shown;
        let typed = if done { self.inspector.typed.remove(&property.name) } else { None };
        let typed = typed.filter(|_| !ui.input(|i| i.key_pressed(Key::Escape)));
        (typed.map(|typed| if is_text { crate::edit::quoted(&typed) } else { typed }), field)
    }
}

/// One of several names; the one that was chosen, as it is written.
fn choice(ui: &mut Ui, name: &str, shown: &str, all: &[String]) -> (Option<String>, Response) {
    let mut chosen = None;
    let menu = ComboBox::from_id_salt(("choice", name)).selected_text(shown).width(TYPED_PX).height(360.0);
    let menu = menu.truncate().show_ui(ui, |ui| {
        for one in all {
            let plain = one.trim_matches('"');
            if ui.selectable_label(plain == shown, plain).clicked() && plain != shown {
                chosen = Some(one.clone());
            }
        }
    });
    menu.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, name));
    (chosen, menu.response)
}

/// A length in units of `unit_m` metres; also typed as `57 cm`, `570 mm` or `0.57 m`.
fn length(text: &str, unit_m: f64) -> Option<f64> {
    let text = text.trim().replace(',', ".");
    let scales =
        [("cm", 0.01 / unit_m), ("mm", 1e-3 / unit_m), ("tiles", 1.0), ("m", 1.0 / unit_m), ("", 1.0)];
    let (number, scale) =
        scales.iter().find_map(|(end, scale)| Some((text.strip_suffix(end)?.trim(), scale)))?;
    let value = number.parse::<f64>().ok().filter(|value| value.is_finite())? * scale;
    Some((value * 1e4).round() / 1e4)
}

#[cfg(test)]
mod tests {
    use super::length;

    #[test]
    fn lengths_are_typed_in_tiles_or_metres() {
        let tiles = |text| length(text, 0.304);
        assert_eq!(tiles(" 1.35"), Some(1.35));
        assert_eq!(tiles("2 tiles"), Some(2.0));
        assert_eq!((tiles("30.4 cm"), tiles("304mm"), tiles("0,304 m")), (Some(1.0), Some(1.0), Some(1.0)));
        assert_eq!(length("57 cm", 1.0), Some(0.57));
        assert_eq!((tiles("wide"), tiles("inf"), tiles("")), (None, None, None));
    }
}
