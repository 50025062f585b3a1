//! What has been saved of the layout, for everything that says so.

use eframe::egui;

use super::{Ask, Designer};

/// What stands before the name of what is not saved.
const UNSAVED: &str = "•";

impl Designer {
    /// The layout's name, behind a dot while not everything is in its file: for titles.
    pub(in crate::preview) fn title(&self) -> String {
        let name = self.name();
        if self.is_saved() { name } else { format!("{UNSAVED} {name}") }
    }

    /// What was last done with the file, and whether it went wrong.
    pub(in crate::preview) fn last_message(&self) -> Option<(&str, bool)> {
        self.message().map(|message| (message.text.as_str(), message.is_bad))
    }

    /// Takes over what is still being typed into a field.
    pub(in crate::preview) fn finish_typing(&self, ctx: &egui::Context) {
        if let Some(id) = ctx.memory(|memory| memory.focused()) {
            ctx.memory_mut(|memory| memory.surrender_focus(id));
        }
    }

    /// Saves, or asks where to.
    pub(in crate::preview) fn save_or_ask(&mut self) {
        if self.file.path().is_some() { self.save() } else { self.ask_for(Ask::SaveAs) }
    }

    /// Whether a person has been asked something that saving waits for.
    pub(in crate::preview) fn is_asking(&self) -> bool {
        self.asking.is_some() || self.conflict.is_some()
    }

    /// Lets go of what was not saved; a draft of an earlier window, of which nobody has decided yet, stays.
    pub(in crate::preview) fn discard(&mut self) {
        if self.left_over.is_none() {
            self.file.drop_draft();
        }
    }
}
