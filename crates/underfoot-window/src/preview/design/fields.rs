//! One field of the inspector: its value can be typed, dragged, ticked or chosen.

use eframe::egui::accesskit::Role;
use eframe::egui::text::CCursor;
use eframe::egui::text_selection::CCursorRange;
use eframe::egui::{ComboBox, DragValue, Key, Response, TextEdit, Ui, WidgetInfo};
use glam::Vec2;

use super::edited::EditedLayout;
use super::inspector::{Inspector, ROW_PX, effect_name, felt, unit_name};
use crate::edit::{Address, Edit, FieldOrigin, Property};
use underfoot::floor::Rect;
use underfoot_format::describe::FieldType;
use underfoot_format::text::Text;
use underfoot_format::words::unit;

/// Width of a text field, in points.
const TYPED_PX: f32 = 122.0;

impl Inspector {
    /// Shows the value of a field for editing; returns the edit, if any.
    pub(super) fn value(
        &mut self,
        ui: &mut Ui,
        edited: &mut EditedLayout,
        record: &Address,
        property: &Property,
    ) -> (Option<Edit>, Response) {
        let set = |value: String| Some(Edit::set(record, &property.name, value));
        let (short, value) = (property.short(), property.value.as_str());
        if property.is_place()
            && let Some(pair) = place_of(edited, record, property)
        {
            return self.place(ui, edited, record, property, pair);
        }
        if let Some(choices) = choices(edited, property) {
            let shown = felt(edited, record, property).map_or_else(
                || value.trim_matches('"').to_owned(),
                |effect| effect_name(&edited.document, &effect).unwrap_or("its own").to_owned(),
            );
            let (chosen, response) = choice(ui, short, &shown, &choices);
            return (chosen.and_then(set), response);
        }
        match &property.shape {
            FieldType::Flag => {
                let mut on = value == "true";
                let tick = ui.checkbox(&mut on, "");
                tick.widget_info(|| WidgetInfo::selected(Role::CheckBox, true, on, short));
                (tick.changed().then(|| set(Text::Flag(on).inline())).flatten(), tick)
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
                let changed = drag.changed().then(|| set(Text::rounded(number).inline())).flatten();
                (self.dragged(edited, &drag, changed), drag)
            }
            shape => {
                let is_text = matches!(shape, FieldType::Text(_)) && property.value != "None";
                let (typed, response) = self.typed(ui, property, is_text);
                (typed.and_then(set), response)
            }
        }
    }

    /// Applies the edits of one drag as one undo step; returns an edit that was typed to the caller.
    fn dragged(&self, edited: &mut EditedLayout, drag: &Response, edit: Option<Edit>) -> Option<Edit> {
        if drag.drag_started() {
            edited.stroke += 1;
        }
        if !drag.dragged() {
            return edit;
        }
        if let Some(edit) = edit {
            self.edit_shared(edited, edit, Some(edited.stroke));
        }
        None
    }

    fn place(
        &mut self,
        ui: &mut Ui,
        edited: &mut EditedLayout,
        record: &Address,
        property: &Property,
        before: [f64; 2],
    ) -> (Option<Edit>, Response) {
        let is_at = property.name == "at";
        let names = if is_at { ["east", "north"] } else { ["width", "depth"] };
        let unit = edited.document.unit_m();
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
            drag.on_hover_text(format!(
                "{}: in {}, or with cm or m behind it",
                names[side],
                unit_name(&edited.document)
            ))
        });
        let value = Text::Tuple(now.map(Text::rounded).into()).inline();
        let wanted = (now != before).then(|| Edit::set(record, &property.name, value));
        let [first, second] = drags;
        let wanted = self.dragged(edited, &first, wanted);
        let wanted = self.dragged(edited, &second, wanted);
        let Some(edit) = wanted else { return (None, first) };
        if property.origin == FieldOrigin::Written {
            return (Some(edit), first);
        }
        // A control that stood beside a neighbour gets a place of its own.
        if let Some(item) = edited.item(record).cloned() {
            let metres = Vec2::new((now[0] * unit) as f32, (now[1] * unit) as f32);
            let area = match is_at {
                true => Rect::from_min_size(metres, item.area.size()),
                false => Rect::from_min_size(item.area.min, metres),
            };
            match edited.document.placing(&[(&item, area)]) {
                Ok(edits) => drop(edited.edit(&edits)),
                Err(refusal) => edited.complain(refusal.short()),
            }
        }
        (None, first)
    }

    /// A text field; returns its text once the user has finished.
    fn typed(&mut self, ui: &mut Ui, property: &Property, is_text: bool) -> (Option<String>, Response) {
        // A default is shown as a hint, not as editable text: it may be words.
        let is_default = property.origin == FieldOrigin::Default;
        let shown = if is_text { property.value.trim_matches('"') } else { &property.value };
        let (shown, hint) = if is_default { ("", shown) } else { (shown, "") };
        let typed = self.typed.entry(property.name.clone()).or_insert_with(|| shown.to_owned());
        let field = ui.add(TextEdit::singleline(typed).hint_text(hint).desired_width(TYPED_PX));
        field.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, &property.name));
        if field.gained_focus()
            && let Some(mut state) = TextEdit::load_state(ui.ctx(), field.id)
        {
            // As in a table, typing replaces the whole value.
            let all = CCursorRange::two(CCursor::new(0), CCursor::new(typed.chars().count()));
            state.cursor.set_char_range(Some(all));
            state.store(ui.ctx(), field.id);
        }
        let done = field.lost_focus() && typed != shown;
        let typed = if done { self.typed.remove(&property.name) } else { None };
        let typed = typed.filter(|_| !ui.input(|i| i.key_pressed(Key::Escape)));
        (typed.map(|typed| if is_text { crate::edit::quoted(&typed) } else { typed }), field)
    }
}

/// The two numbers of a place or a size, in the layout's unit; the resolved area if the place depends on a
/// neighbour.
fn place_of(edited: &EditedLayout, record: &Address, property: &Property) -> Option<[f64; 2]> {
    if property.origin == FieldOrigin::Written {
        let (one, other) = property.value.trim_matches(['(', ')']).split_once(',')?;
        let number = |text: &str| text.trim().trim_end_matches(',').trim().parse::<f64>().ok();
        return Some([number(one)?, number(other)?]);
    }
    let area = edited.item(record).filter(|item| !item.is_group)?.area;
    let metres = if property.name == "at" { area.min } else { area.size() };
    let unit = edited.document.unit_m();
    Some([metres.x, metres.y].map(|metres| (f64::from(metres) / unit * 1e4).round() / 1e4))
}

/// The choices for a field, as the file writes them; `None` for a field that is typed.
fn choices(edited: &EditedLayout, property: &Property) -> Option<Vec<String>> {
    let quoted = |names: Vec<String>| names.iter().map(|name| crate::edit::quoted(name)).collect();
    match (&property.shape, property.name.as_str()) {
        (FieldType::Names(names), "kind") if names.is_empty() => {
            Some(quoted(edited.document.kinds().iter().map(|kind| kind.name.clone()).collect()))
        }
        (FieldType::Names(names), _) => Some(names.iter().map(|name| (*name).to_owned()).collect()),
        (_, "goto") if !edited.layout().pages.is_empty() => {
            Some(quoted(edited.layout().pages.iter().map(|page| page.id.to_string()).collect()))
        }
        (FieldType::Optional(_), name) if name.starts_with("feel.") => {
            let names = edited.document.kinds().effects().iter().map(|named| named.name.clone()).collect();
            let names: Vec<String> = quoted(names);
            Some(std::iter::once("None".to_owned()).chain(names).collect())
        }
        _ => None,
    }
}

/// A list of names; returns the name that the user chose, as the file writes it.
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

/// Parses a length in units of `unit_m` metres; also accepts `57 cm`, `570 mm` or `0.57 m`.
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
