//! The editor of one field, by the form of its value.

use eframe::egui::Ui;
use eframe::egui::WidgetInfo;
use eframe::egui::accesskit::Role;

use super::choice::{choices, chosen, variants};
use super::colour::{colour, colour_of};
use super::effect::effect_name;
use super::field::{EDITOR_PX, FieldAnswer, ShownField, TypedTexts};
use super::number::{NumberField, following, optional, pair, required, two_numbers};
use super::place::{place, place_of};
use super::text::typed;
use super::words::{choice, label};
use crate::edit::FieldOrigin;
use underfoot_format::describe::FieldType;
use underfoot_format::text::Text;

/// Shows the value of a field for editing; returns the edits for which the user asks.
pub(super) fn value(ui: &mut Ui, field: &ShownField<'_>, texts: &mut TypedTexts) -> FieldAnswer {
    let property = field.property;
    if property.is_place()
        && let Some(before) = place_of(field)
    {
        return place(ui, field, before);
    }
    if let Some(all) = choices(field) {
        let shown = match effect_name(field).filter(|_| !field.is_shared) {
            Some(effect) => effect,
            None if property.origin == FieldOrigin::Several => String::new(),
            None => choice(property.value.split('(').next().unwrap_or_default()),
        };
        return chosen(ui, field, &shown, &all);
    }
    if let Some(now) = colour_of(field) {
        return colour(ui, field, texts, now);
    }
    match &property.shape {
        FieldType::Flag => {
            let mut on = property.value == "true";
            let said = if on { "yes" } else { "no" };
            let tick = ui.checkbox(&mut on, said);
            tick.widget_info(|| WidgetInfo::selected(Role::CheckBox, true, on, label(&property.name)));
            (tick.changed().then(|| field.set(Text::Flag(on).inline()).into()), tick)
        }
        FieldType::Variants(describe) if property.origin != FieldOrigin::Several => {
            variants(ui, field, &describe())
        }
        FieldType::Optional(each) if property.origin != FieldOrigin::Several => {
            match NumberField::of(&property.name, each) {
                Some(of) => optional(ui, field, of),
                None => typed(ui, field, texts, false, EDITOR_PX),
            }
        }
        FieldType::Pair(_, each) => {
            match NumberField::of(&property.name, each).zip(two_numbers(&property.value)) {
                Some((of, before)) => pair(ui, field, of, before),
                None => typed(ui, field, texts, false, EDITOR_PX),
            }
        }
        shape => match (NumberField::of(&property.name, shape), property.value.parse()) {
            (Some(of), Ok(now)) => required(ui, field, of, now),
            (Some(_), Err(_)) if property.origin == FieldOrigin::Default => following(ui, field),
            _ => {
                let is_text = matches!(shape, FieldType::Text(_)) && property.value != "None";
                typed(ui, field, texts, is_text, EDITOR_PX)
            }
        },
    }
}
