//! Limit on the number of controls in a layout.

use std::sync::atomic::{AtomicUsize, Ordering};

/// Maximum number of controls, regions or stance zones of one layout.
pub const MAX_WIDGETS: usize = 4096;

/// Number of controls that the layout being read may still have.
pub(super) struct Room(AtomicUsize);

impl Default for Room {
    fn default() -> Self {
        Self(AtomicUsize::new(MAX_WIDGETS))
    }
}

impl Room {
    /// Returns the number of controls that may follow.
    pub(super) fn left(&self) -> usize {
        self.0.load(Ordering::Relaxed)
    }

    /// Counts `count` controls; one thread reads a layout.
    pub(super) fn take(&self, count: usize) {
        self.0.store(self.left().saturating_sub(count), Ordering::Relaxed);
    }
}
