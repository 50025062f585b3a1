//! Drop-downs: kinds, pages, named choices, and choices with fields of their own, such as guards.

use eframe::egui::accesskit::Role;
use eframe::egui::{ComboBox, Response, Ui, WidgetInfo};

use super::field::{EDITOR_PX, FieldAnswer, FieldEdits, ShownField};
use super::number::{NumberField, number, written};
use super::words::{choice, label, start};
use crate::edit::quoted;
use underfoot_format::describe::{Description, FieldType};
use underfoot_format::outline::Outline;

/// The choices for a field, as the file writes them; `None` for a field that is no choice.
pub(super) fn choices(field: &ShownField<'_>) -> Option<Vec<String>> {
    let all = |names: Vec<String>| names.iter().map(|name| quoted(name)).collect::<Vec<_>>();
    let (document, layout) = (&field.edited.document, field.edited.layout());
    let none = || std::iter::once("None".to_owned());
    match (&field.property.shape, field.property.name.as_str()) {
        (FieldType::Names(names), "kind") if names.is_empty() => {
            Some(all(document.all_kinds().iter().map(|kind| kind.name.clone()).collect()))
        }
        (FieldType::Names(names), _) => Some(names.iter().map(|name| (*name).to_owned()).collect()),
        (_, "goto") if !layout.pages.is_empty() => {
            Some(all(layout.pages.iter().map(|page| page.id.to_string()).collect()))
        }
        (FieldType::Optional(_), name) if name.starts_with("feel.") => {
            let effects = document.all_kinds().effects();
            Some(none().chain(all(effects.iter().map(|named| named.name.clone()).collect())).collect())
        }
        (FieldType::Optional(each), _) => match &**each {
            FieldType::Names(names) => Some(none().chain(names.iter().map(|name| (*name).into())).collect()),
            _ => None,
        },
        _ => None,
    }
}

/// A list of names; returns the name that the user chose, as the file writes it.
pub(super) fn drop_down(ui: &mut Ui, name: &str, shown: &str, all: &[String]) -> (Option<String>, Response) {
    let mut chosen = None;
    let name = label(name);
    let menu = ComboBox::from_id_salt(("choice", &name)).selected_text(shown).width(EDITOR_PX).height(360.0);
    let menu = menu.truncate().show_ui(ui, |ui| {
        for one in all {
            let plain = choice(one);
            if ui.selectable_label(plain == shown, &plain).clicked() && plain != shown {
                chosen = Some(one.clone());
            }
        }
    });
    menu.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, &name));
    (chosen, menu.response)
}

/// A choice whose value is one of `all`.
pub(super) fn chosen(ui: &mut Ui, field: &ShownField<'_>, shown: &str, all: &[String]) -> FieldAnswer {
    let (chosen, response) = drop_down(ui, &field.property.name, shown, all);
    (chosen.map(|value| field.set(value).into()), response)
}

/// A value that is one of several named records, such as a guard.
struct WrittenVariant {
    name: String,
    /// The fields that are written, with their texts.
    fields: Vec<(String, String)>,
}

impl WrittenVariant {
    fn parse(value: &str) -> Option<Self> {
        let outline = Outline::parse(value)?;
        let fields = outline.elements.iter().filter_map(|element| {
            let (name, _) = element.field.clone()?;
            Some((name, value.get(element.value.span.clone())?.to_owned()))
        });
        let fields = fields.collect();
        Some(Self { name: outline.name.unwrap_or_else(|| value.trim().to_owned()), fields })
    }

    /// As files write it, with `field` set to `value`; absent if that is `None`.
    fn with(&self, field: &str, value: Option<String>) -> String {
        let mut fields: Vec<(&str, String)> = self
            .fields
            .iter()
            .filter(|(name, _)| name != field)
            .map(|(name, text)| (name.as_str(), text.clone()))
            .collect();
        fields.extend(value.map(|value| (field, value)));
        variant_text(&self.name, &fields)
    }
}

fn variant_text(name: &str, fields: &[(&str, String)]) -> String {
    let fields: Vec<String> = fields.iter().map(|(name, value)| format!("{name}: {value}")).collect();
    if fields.is_empty() { name.to_owned() } else { format!("{name}({})", fields.join(", ")) }
}

/// A variant as it is begun: the fields that must be written get usual values.
fn begun(variant: &Description) -> String {
    let required = variant.fields.iter().filter(|field| field.default.is_none());
    let fields: Vec<(&str, String)> =
        required.filter_map(|field| Some((field.name, start(field.name)?.to_owned()))).collect();
    variant_text(variant.name, &fields)
}

/// The drop-down of a choice with fields of its own; [`variant_fields`] shows these below.
pub(super) fn variants(ui: &mut Ui, field: &ShownField<'_>, all: &[Description]) -> FieldAnswer {
    let now = WrittenVariant::parse(&field.property.value).map_or_else(String::new, |now| now.name);
    let names: Vec<String> = all.iter().map(|variant| variant.name.to_owned()).collect();
    let (chosen, response) = drop_down(ui, &field.property.name, &choice(&now), &names);
    let chosen = chosen.and_then(|name| all.iter().find(|variant| variant.name == name));
    (chosen.map(|variant| field.set(begun(variant)).into()), response)
}

/// The numbers of the chosen variant, each on a row of its own.
pub(super) fn variant_fields(ui: &mut Ui, field: &ShownField<'_>) -> Option<FieldEdits> {
    let FieldType::Variants(describe) = &field.property.shape else { return None };
    let now = WrittenVariant::parse(&field.property.value)?;
    let variant = describe().into_iter().find(|variant| variant.name == now.name)?;
    let mut edits = None;
    for part in &variant.fields {
        let text = now.fields.iter().find(|(name, _)| name == part.name).map(|(_, text)| text.as_str());
        let text = text.or(part.default.as_deref()).unwrap_or_default();
        let shape = match &part.shape {
            FieldType::Optional(each) => each,
            other => other,
        };
        let Some(of) = NumberField::of(part.name, shape) else { continue };
        ui.horizontal(|ui| {
            ui.add_space(16.0);
            ui.label(label(part.name))
                .on_hover_text(format!("{}.{}\n{}", field.property.name, part.name, part.about));
            match text.parse::<f64>() {
                Ok(value) => {
                    let (changed, moved) = number(ui, of, value);
                    if let Some(changed) = changed {
                        let set = field.set(now.with(part.name, Some(written(changed))));
                        edits = Some(FieldEdits::from(set).dragged_by(&moved));
                    }
                }
                Err(_) => {
                    let start = start(part.name).map(str::to_owned);
                    if ui.small_button(format!("Set {}", label(part.name).to_lowercase())).clicked() {
                        edits = Some(field.set(now.with(part.name, start)).into());
                    }
                }
            }
        });
    }
    edits
}

#[cfg(test)]
mod tests {
    use super::*;
    use underfoot::widget::Guard;
    use underfoot_format::Variants;

    #[test]
    fn each_guard_begins_with_what_it_must_have() {
        let all: Vec<String> = Guard::describe().iter().map(begun).collect();
        assert_eq!(all, ["Free", "Confirm", "HoldToRun(max_s: 60)"]);
    }

    #[test]
    fn a_number_of_a_guard_is_replaced_and_the_others_stay() {
        let guard = WrittenVariant::parse("HoldToRun(max_s: 120, warn_s: 30)").unwrap();
        assert_eq!(guard.with("max_s", Some("90".into())), "HoldToRun(warn_s: 30, max_s: 90)");
        assert_eq!(guard.with("warn_s", None), "HoldToRun(max_s: 120)");
        assert_eq!(WrittenVariant::parse("Free").unwrap().name, "Free");
    }
}
