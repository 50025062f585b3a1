//! Icons of buttons: the letters of the Lucide font.

use std::sync::Arc;

use eframe::egui::accesskit::Role;
use eframe::egui::{Button, FontData, FontDefinitions, FontFamily, Response, Ui, WidgetInfo};

pub(super) use lucide_icons::Icon;

/// Adds the icons to `fonts`, after the letters.
pub(super) fn add_to(fonts: &mut FontDefinitions) {
    let name = "lucide";
    fonts.font_data.insert(name.into(), Arc::new(FontData::from_static(lucide_icons::LUCIDE_FONT_BYTES)));
    fonts.families.entry(FontFamily::Proportional).or_default().push(name.into());
}

/// The text of a button: the icon before `name`.
pub(super) fn with(icon: Icon, name: &str) -> String {
    format!("{} {name}", icon.unicode())
}

/// The text of a button: the icon before `name`, or alone where there is little room.
pub(super) fn short(icon: Icon, name: &str, is_compact: bool) -> String {
    if is_compact { icon.unicode().to_string() } else { with(icon, name) }
}

/// A button with an icon alone, for an action called `name`; a hover shows the name and `hint`.
pub(super) fn icon_button(ui: &mut Ui, is_on: bool, icon: Icon, name: &str, hint: &str) -> bool {
    let button = ui.add_enabled(is_on, Button::new(icon.unicode().to_string()));
    named(button, name).on_hover_text(format!("{name}: {hint}")).clicked()
}

/// `button` with `name` for screen readers, without its icon.
pub(super) fn named(button: Response, name: &str) -> Response {
    button.widget_info(|| WidgetInfo::labeled(Role::Button, button.enabled(), name));
    button
}
