//! The end of a server: what feet hold is cancelled before anybody is told goodbye.

use std::panic::{AssertUnwindSafe, catch_unwind};

use tracing::error;

use super::Server;

impl Server {
    /// Cancels what feet hold, tells and shows so, and lets the actuators fade out; a second time changes nothing.
    pub(super) fn end(&mut self) {
        self.cancel_all();
        self.show_now();
        self.haptics.fade_out(self.source.now());
    }

    /// Cancels what feet hold, which restores what they had changed, and tells so.
    pub(super) fn cancel_all(&mut self) {
        let cancelled = self.engine.cancel_all();
        self.outputs.events(cancelled);
        self.beat();
    }
}

impl Drop for Server {
    /// Also the end of a thread that panics: sinks say goodbye when they are dropped, after this.
    fn drop(&mut self) {
        // Whatever panicked may do so again, and a second panic on the way out would end the program at once.
        if catch_unwind(AssertUnwindSafe(|| self.end())).is_err() {
            error!("not everything that was held could be cancelled");
        }
    }
}
