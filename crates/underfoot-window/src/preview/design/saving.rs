//! The saved state of the layout, for all displays of it.

use eframe::egui;

use super::{Ask, Designer};

/// The mark before the name of an unsaved layout.
const UNSAVED: &str = "•";

impl Designer {
    /// The layout's name for titles, behind a dot while the file lacks edits.
    pub(in crate::preview) fn title(&self) -> String {
        let name = self.name();
        if self.is_saved() { name } else { format!("{UNSAVED} {name}") }
    }

    /// The last message about the file, and whether it reports a failure.
    pub(in crate::preview) fn last_message(&self) -> Option<(&str, bool)> {
        self.message().map(|message| (message.text.as_str(), message.is_bad))
    }

    /// Ends the typing in a field, so that its text is applied.
    pub(in crate::preview) fn finish_typing(&self, ctx: &egui::Context) {
        if let Some(id) = ctx.memory(|memory| memory.focused()) {
            ctx.memory_mut(|memory| memory.surrender_focus(id));
        }
    }

    /// Saves, or asks for a path.
    pub(in crate::preview) fn save_or_ask(&mut self) {
        if self.file.path().is_some() { self.save() } else { self.ask_for(Ask::SaveAs) }
    }

    /// Whether a question to the user blocks saving.
    pub(in crate::preview) fn is_asking(&self) -> bool {
        self.asking.is_some() || self.conflict.is_some()
    }

    /// Discards unsaved edits; a draft of an earlier window that waits for a decision stays.
    pub(in crate::preview) fn discard(&mut self) {
        if self.left_over.is_none() {
            self.file.drop_draft();
        }
    }
}
