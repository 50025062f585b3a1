//! The end of a server: what feet hold is cancelled before anybody is told goodbye.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Duration;

use tracing::error;

use super::Server;
use crate::feel::DeviceStatus;

/// How long the actuators are given to fade out: the 5 ms of the fade, and the longest usual block of a card.
const FADE: Duration = Duration::from_millis(50);

impl Server {
    /// Cancels what feet hold, tells so, and lets the actuators fade out; a second time changes nothing.
    pub(super) fn end(&mut self) {
        self.cancel_all();
        let Some(feel) = self.feel.as_mut().filter(|feel| !feel.is_silenced()) else { return };
        feel.silence();
        self.play_until(self.source.now() + FADE);
        let keeps_its_own_time =
            self.actuators.as_ref().is_some_and(|actuators| actuators.device(&mut DeviceStatus::default()));
        if keeps_its_own_time {
            std::thread::sleep(FADE);
        }
    }

    /// Cancels what feet hold, which restores what they had changed, and tells so.
    pub(super) fn cancel_all(&mut self) {
        let cancelled = self.engine.cancel_all();
        if let Some(events) = &mut self.events {
            events.events(cancelled);
        }
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
