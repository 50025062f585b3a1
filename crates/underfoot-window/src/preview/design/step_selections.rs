//! The selection at each step of undo.

use crate::edit::Address;

/// The selection that was last seen at each step of the document, the first step first.
#[derive(Debug, Default)]
pub(super) struct StepSelections(Vec<Vec<Address>>);

impl StepSelections {
    /// Keeps the selection at `step`.
    pub(super) fn note(&mut self, step: usize, selected: &[Address]) {
        if self.0.get(step).is_some_and(|seen| seen == selected) {
            return;
        }
        if self.0.len() <= step {
            self.0.resize(step + 1, Vec::new());
        }
        if let Some(seen) = self.0.get_mut(step) {
            seen.clear();
            seen.extend_from_slice(selected);
        }
    }

    /// The selection at `step`; empty for a step that no frame has shown.
    pub(super) fn at(&self, step: usize) -> Vec<Address> {
        self.0.get(step).cloned().unwrap_or_default()
    }

    /// Forgets all, for another document.
    pub(super) fn clear(&mut self) {
        self.0.clear();
    }
}
