//! Texts of messages: keys, notes, addresses, topics. A text that names nothing stays in its field, with the reason.

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, RichText, TextEdit, Ui, WidgetInfo};

use super::sends::{MessageList, PART_PX};
use underfoot::messages::{KeyStroke, MidiNote, MqttTarget};
use underfoot_scene::egui_painter::color;

/// Maximum number of letters of a text.
const LONGEST: usize = 1000;

/// Gives the reason why a text cannot be; `None` for a valid one.
type Refusal = fn(&str) -> Option<String>;

/// A text of a message.
#[derive(Clone, Copy)]
pub(super) struct MessageText<'a> {
    /// Its spoken name.
    name: &'a str,
    now: &'a str,
    /// The text that counts while the field is empty.
    hint: &'a str,
    /// Whether it takes the rest of the row.
    is_wide: bool,
    refusal: Refusal,
}

impl<'a> MessageText<'a> {
    /// A text that must be written.
    pub(super) const fn new(name: &'a str, now: &'a str, refusal: Refusal) -> Self {
        Self { name, now, hint: "", is_wide: false, refusal }
    }

    /// The same text in a field as wide as the rest of the row, as for addresses.
    pub(super) const fn wide(self, hint: &'a str) -> Self {
        Self { is_wide: true, hint, ..self }
    }
}

impl MessageList<'_> {
    /// A text field; returns its text once the user has finished and it is another, valid one.
    pub(super) fn typed(&mut self, ui: &mut Ui, of: MessageText<'_>) -> Option<String> {
        let text = self.texts.entry(of.name.to_owned()).or_insert_with(|| of.now.to_owned());
        let edit = TextEdit::singleline(text).hint_text(of.hint).char_limit(LONGEST);
        let width = if of.is_wide { ui.available_width() } else { PART_PX };
        let field = ui.add(edit.desired_width(width));
        field.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, of.name));
        if field.lost_focus() && ui.input(|i| i.key_pressed(Key::Escape)) {
            of.now.clone_into(text);
        }
        if text == of.now || field.has_focus() {
            return None;
        }
        if let Some(refusal) = (of.refusal)(text) {
            let ink = color(self.theme.warning);
            ui.label(RichText::new(refusal).size(11.5).color(ink));
            return None;
        }
        field.lost_focus().then(|| text.clone())
    }
}

/// Accepts every text.
pub(super) fn any(_text: &str) -> Option<String> {
    None
}

pub(super) fn no_key(text: &str) -> Option<String> {
    let part = text.parse::<KeyStroke>().err()?;
    Some(format!("No key is called “{part}”."))
}

pub(super) fn no_note(text: &str) -> Option<String> {
    MidiNote::key_called(text).is_none().then(|| "A note is 0 to 127, or a name such as C4 or F#3.".into())
}

pub(super) fn no_topic(text: &str) -> Option<String> {
    (!MqttTarget::is_topic(text))
        .then(|| "A topic has 1 to 200 letters, no + and #, and does not begin with $.".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reads(refusal: Refusal, good: &[&str], bad: &[&str]) {
        assert!(good.iter().all(|text| refusal(text).is_none()), "{good:?}");
        assert!(bad.iter().all(|text| refusal(text).is_some()), "{bad:?}");
    }

    #[test]
    fn a_text_that_names_nothing_has_a_reason() {
        reads(no_key, &["Right", "Control+Shift+z", "+"], &["", "Rihgt", "Control+Rihgt"]);
        reads(no_note, &["C4", "60", "F#3"], &["", "H4", "128"]);
        reads(no_topic, &["floor/lamp"], &["", "$SYS/x", "floor/#"]);
    }
}
