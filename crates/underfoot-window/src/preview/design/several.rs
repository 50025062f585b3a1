//! Place and size of several selected records: one value or a range, changed together.

use std::collections::HashMap;

use eframe::egui::accesskit::Role;
use eframe::egui::{self, Ui, WidgetInfo};

use super::edited::EditedLayout;
use super::inspector::{EDITOR_PX, capital, unit_name, unmarked_name};
use crate::edit::{EditRefusal, PlaceNumber, SharedNumber, TypedChange, changing, shared_number};
use crate::preview::style::{is_entered, quiet};
use underfoot_format::text::Text;
use underfoot_scene::scene::Theme;

/// Shows place and size of the selection; `typed` holds the text of the field in which the user is typing.
pub(super) fn shared_place(
    ui: &mut Ui,
    theme: &Theme,
    edited: &mut EditedLayout,
    typed: &mut HashMap<String, String>,
) {
    ui.label(quiet(theme, "+0.2 and -0.2 move or grow each, *2 and /2 scale, a number sets all."));
    let mut wanted = None;
    for number in PlaceNumber::ALL {
        let items = edited.selected_items();
        let Some(shared) = shared_number(&edited.document, &items, number) else { continue };
        let name = format!("all {}", number.name());
        ui.horizontal(|ui| {
            unmarked_name(ui, &format!("{} ({})", capital(number.name()), unit_name(&edited.document)));
            let plain = |value: f64| Text::rounded(value).inline();
            let value = match shared {
                SharedNumber::Same(value) => plain(value),
                SharedNumber::Mixed(..) => String::new(),
            };
            let mut text = typed.get(&name).cloned().unwrap_or_else(|| value.clone());
            let hint = match shared {
                SharedNumber::Same(_) => String::new(),
                SharedNumber::Mixed(least, most) => format!("{} to {}", plain(least), plain(most)),
            };
            let edit = egui::TextEdit::singleline(&mut text).hint_text(hint).desired_width(EDITOR_PX);
            let field = ui.add(edit);
            field.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, &name));
            if field.has_focus() {
                typed.insert(name.clone(), text.clone());
            }
            if is_entered(ui, &field) || field.lost_focus() {
                typed.remove(&name);
                if text != value {
                    wanted = Some((number, text));
                }
            }
        });
    }
    let Some((number, text)) = wanted else { return };
    match TypedChange::parse(&text) {
        Some(change) => apply(edited, number, change),
        None => edited.complain(format!("\"{text}\" is neither a number nor a change such as +0.2 or *2")),
    }
}

fn apply(edited: &mut EditedLayout, number: PlaceNumber, change: TypedChange) {
    if edited.holds_locked() {
        return;
    }
    let edits: Result<_, EditRefusal> = changing(&edited.document, &edited.selected_items(), number, change);
    match edits {
        Ok(edits) => drop(edited.edit(&edits)),
        Err(refusal) => edited.complain(refusal.short()),
    }
}
