//! The kinds and effects of the user's in the page: those of a link, and those made here.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::Arc;

use underfoot::schema::{Diagnostics, Kinds};
use underfoot_window::link::SharedLayout;

/// The texts of the user's kinds and effects. Clones share them.
#[derive(Clone, Debug, Default)]
pub struct OwnTexts(Rc<RefCell<SharedLayout>>);

impl OwnTexts {
    /// The kinds and effects of a link.
    #[must_use]
    pub fn of(shared: &SharedLayout) -> Self {
        let SharedLayout { kinds, effects, .. } = shared.clone();
        Self(Rc::new(RefCell::new(SharedLayout { kinds, effects, ..SharedLayout::default() })))
    }

    /// Adds an effect, or replaces the one in the same file.
    pub fn keep_effect(&self, file: String, text: String) {
        self.0.borrow_mut().effects.insert(file, text);
    }

    /// The text of an effect; empty if there is none in this file.
    #[must_use]
    pub fn effect(&self, file: &str) -> String {
        self.0.borrow().effects.get(file).cloned().unwrap_or_default()
    }

    /// The texts of kinds, and those of effects, by the names of their files.
    #[must_use]
    pub fn all(&self) -> (BTreeMap<String, String>, BTreeMap<String, String>) {
        let texts = self.0.borrow();
        (texts.kinds.clone(), texts.effects.clone())
    }

    /// All kinds and effects, with those that come with underfoot.
    ///
    /// # Errors
    /// The problems of the first text that cannot be read.
    pub fn read(&self) -> Result<Arc<Kinds>, Diagnostics> {
        self.0.borrow().all_kinds().map(Arc::new)
    }
}
