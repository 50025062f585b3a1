//! Fields that are typed.

use eframe::egui::accesskit::Role;
use eframe::egui::{Align2, Key, TextEdit, Ui, WidgetInfo};

use super::field::{FieldAnswer, ShownField, TypedTexts};
use super::words::label;
use crate::edit::{FieldOrigin, quoted};
use crate::preview::style::replace_by_typing;

/// A text field of this width; asks for its text once the user has finished. Text in quotes is shown without them if
/// `is_text`.
pub(super) fn typed(
    ui: &mut Ui,
    field: &ShownField<'_>,
    texts: &mut TypedTexts,
    is_text: bool,
    width: f32,
) -> FieldAnswer {
    let property = field.property;
    // A default is shown as a hint, not as editable text: it may be words.
    let is_default = property.origin == FieldOrigin::Default;
    let shown = if is_text { property.value.trim_matches('"') } else { &property.value };
    let (shown, hint) = if is_default { ("", shown) } else { (shown, "") };
    let text = texts.entry(property.name.clone()).or_insert_with(|| shown.to_owned());
    let edit =
        ui.add(TextEdit::singleline(text).hint_text(hint).desired_width(width).align(Align2::LEFT_CENTER));
    let name = label(&property.name);
    edit.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, &name));
    replace_by_typing(ui, &edit, text);
    if !edit.lost_focus() || text == shown {
        return (None, edit);
    }
    if ui.input(|i| i.key_pressed(Key::Escape)) {
        texts.remove(&property.name);
        return (None, edit);
    }
    // A refused text stays, to be mended.
    let value = if is_text { quoted(text) } else { text.clone() };
    (Some(field.set(value).into()), edit)
}
