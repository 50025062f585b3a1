//! Notices that may repeat: some at once, then few, with the number in between.

use std::time::Duration;

use tracing::{info, warn};

use crate::rate_limit::RateLimit;
use crate::units::Instant;

/// One kind of notice.
#[derive(Debug)]
pub(super) struct Limited(RateLimit);

impl Limited {
    /// At most `burst` at once, and in the long run one in each `every`.
    pub(super) const fn new(burst: u32, every: Duration) -> Self {
        Self(RateLimit::new(burst, every))
    }

    /// Warns, unless there were too many.
    pub(super) fn warn(&mut self, now: Instant, text: impl FnOnce() -> String) {
        if let Some(held_back) = self.0.take(now) {
            warn!("{}{}", text(), in_between(held_back));
        }
    }

    /// Says, unless there was too much.
    pub(super) fn info(&mut self, now: Instant, text: impl FnOnce() -> String) {
        if let Some(held_back) = self.0.take(now) {
            info!("{}{}", text(), in_between(held_back));
        }
    }
}

/// What stands behind a notice after others were held back.
fn in_between(held_back: u64) -> String {
    if held_back == 0 {
        String::new()
    } else {
        format!(" (and {held_back} notices like it that were held back)")
    }
}
