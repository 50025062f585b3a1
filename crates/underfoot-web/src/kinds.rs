//! The kinds and effects of the user's in the page: those of a link, those made here, and those beside a layout.

use std::cell::RefCell;
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;

use underfoot::schema::{Effects, Kinds};
use underfoot_window::link::{EFFECTS, KINDS, ReadableParts, SharedLayout};
use underfoot_window::preview::texts_beside;

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

    /// The kinds and effects for the layout at `path`, as a layout without a text: those in the folders `widgets` and
    /// `effects` beside it, or the kinds of the link, and the effects of the link and those kept here. Those that cannot
    /// be read are left out: the window has shown their problems when they came.
    #[must_use]
    pub fn of_layout(&self, path: Option<&Path>) -> SharedLayout {
        self.readable(path).texts
    }

    /// All kinds and effects for the layout at `path` that can be read, with those that come with underfoot.
    #[must_use]
    pub fn read(&self, path: Option<&Path>) -> Arc<Kinds> {
        Arc::new(self.readable(path).kinds)
    }

    fn readable(&self, path: Option<&Path>) -> ReadableParts {
        let mut own = self.0.borrow().clone();
        let beside = |name| path.map(|path| texts_beside(path, name)).unwrap_or_default();
        let new = SharedLayout { kinds: beside(KINDS), effects: beside(EFFECTS), ..SharedLayout::default() };
        if !new.kinds.is_empty() {
            own.kinds.clear();
        }
        ReadableParts::of(&Effects::builtin(), &own, &new)
    }
}
