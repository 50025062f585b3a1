//! Icons of buttons: letters of the Lucide font.

use std::sync::Arc;

use eframe::egui::accesskit::Role;
use eframe::egui::{Button, FontData, FontDefinitions, FontFamily, Response, Ui, WidgetInfo};

pub(super) use lucide_icons::Icon;

/// The icons that the window uses, without the two thousand others; `tools/icons.py` makes the file.
const FONT: &[u8] = include_bytes!("../../fonts/icons.ttf");

/// Adds the icons to `fonts`, after the letters.
pub(super) fn add_to(fonts: &mut FontDefinitions) {
    let name = "lucide";
    fonts.font_data.insert(name.into(), Arc::new(FontData::from_static(FONT)));
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

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;

    use eframe::egui::{Context, FontId, RawInput};

    use super::*;

    /// The names behind `Icon::` in the sources below `folder`.
    fn used(folder: &Path, names: &mut Vec<String>) {
        for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
            if entry.file_type().unwrap().is_dir() {
                used(&entry.path(), names);
                continue;
            }
            let text = fs::read_to_string(entry.path()).unwrap();
            for (at, _) in text.match_indices("Icon::") {
                let is_ours = !text[..at].ends_with(char::is_alphanumeric);
                let name = text[at + 6..].split(|c: char| !c.is_alphanumeric()).next().unwrap();
                if is_ours && name.starts_with(char::is_uppercase) {
                    names.push(name.to_owned());
                }
            }
        }
    }

    /// `CopyPlus` and `Undo2` as `copy-plus` and `undo-2`.
    fn lucide_name(name: &str) -> String {
        let parts = name.split_inclusive(|_: char| true).map(|c| {
            let starts = c.starts_with(|c: char| c.is_uppercase() || c.is_numeric());
            format!("{}{}", if starts { "-" } else { "" }, c.to_lowercase())
        });
        parts.collect::<String>().trim_start_matches('-').to_owned()
    }

    #[test]
    fn the_font_has_every_icon_that_the_window_uses() {
        let mut names = Vec::new();
        used(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), &mut names);
        assert!(names.len() > 20, "{names:?}");
        let ctx = Context::default();
        let mut fonts = FontDefinitions::empty();
        add_to(&mut fonts);
        ctx.set_fonts(fonts);
        ctx.run_ui(RawInput::default(), |_| {}).textures_delta.clear();
        let font = FontId::proportional(14.0);
        let lacks = |name: &&String| {
            let icon = Icon::try_from(lucide_name(name).as_str()).unwrap();
            !ctx.fonts_mut(|fonts| fonts.has_glyph(&font, icon.unicode()))
        };
        let missing: Vec<&String> = names.iter().filter(lacks).collect();
        assert!(missing.is_empty(), "the font lacks {missing:?}: run tools/icons.py");
    }
}
