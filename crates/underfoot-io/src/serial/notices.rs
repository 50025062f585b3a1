//! PortNotices about one port, at a limited rate.

use std::time::Duration;

use underfoot::units::Instant;

/// Minimum time between two notices.
const QUIET: Duration = Duration::from_secs(60);

/// Lets the first notice pass, then one a minute with the number in between.
#[derive(Debug, Default)]
pub(super) struct PortNotices {
    last: Option<Instant>,
    held_back: u64,
}

impl PortNotices {
    /// The number of notices since the last one that passed, if this one passes.
    pub(super) fn pass(&mut self, now: Instant) -> Option<u64> {
        if self.last.is_some_and(|last| now.since(last) < QUIET) {
            self.held_back += 1;
            return None;
        }
        self.last = Some(now);
        Some(std::mem::take(&mut self.held_back))
    }
}
