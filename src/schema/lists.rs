//! How many controls a layout may have.

use std::sync::atomic::{AtomicUsize, Ordering};

/// Most controls, regions or stance zones of one layout.
pub const MAX_WIDGETS: usize = 4096;

/// How many more controls the layout that is being read may have.
pub(super) struct Room(AtomicUsize);

impl Default for Room {
    fn default() -> Self {
        Self(AtomicUsize::new(MAX_WIDGETS))
    }
}

impl Room {
    /// How many more there may be.
    pub(super) fn left(&self) -> usize {
        self.0.load(Ordering::Relaxed)
    }

    /// Notes so many controls; a layout is read by one thread.
    pub(super) fn take(&self, count: usize) {
        self.0.store(self.left().saturating_sub(count), Ordering::Relaxed);
    }
}
