//! The end of a server: it cancels everything held before the sinks say goodbye.

use std::panic::{AssertUnwindSafe, catch_unwind};

use tracing::error;

use super::Server;

impl Server {
    /// Cancels everything held, reports and shows that, and lets the actuators fade out; a second call changes
    /// nothing.
    pub(super) fn end(&mut self) {
        self.cancel_all();
        self.show_now();
        self.haptics.fade_out(self.source.now());
    }

    /// Cancels everything held, which restores the values that the feet had changed, and reports that.
    pub(super) fn cancel_all(&mut self) {
        let cancelled = self.engine.cancel_all();
        self.outputs.events(cancelled);
        self.beat();
        self.outputs.release(self.source.now());
    }
}

impl Drop for Server {
    /// Runs also at the end of a thread that panics: sinks say goodbye when they are dropped, after this.
    fn drop(&mut self) {
        // The cause of a panic may cause another one, and a second panic while unwinding would abort the program.
        if catch_unwind(AssertUnwindSafe(|| self.end())).is_err() {
            error!("not everything that was held could be cancelled");
        }
    }
}
