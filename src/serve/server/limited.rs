//! Rate-limited notices: a burst at once, then few, with the number of suppressed ones.

use std::time::Duration;

use tracing::{info, warn};

use crate::rate_limit::RateLimit;
use crate::units::Instant;

/// One kind of notice.
#[derive(Debug)]
pub(super) struct Limited(RateLimit);

impl Limited {
    /// At most `burst` at once, and one per `every` in the long run.
    pub(super) const fn new(burst: u32, every: Duration) -> Self {
        Self(RateLimit::new(burst, every))
    }

    /// Logs a warning within the rate limit.
    pub(super) fn warn(&mut self, now: Instant, text: impl FnOnce() -> String) {
        if let Some(held_back) = self.0.take(now) {
            warn!("{}{}", text(), in_between(held_back));
        }
    }

    /// Logs information within the rate limit.
    pub(super) fn info(&mut self, now: Instant, text: impl FnOnce() -> String) {
        if let Some(held_back) = self.0.take(now) {
            info!("{}{}", text(), in_between(held_back));
        }
    }
}

/// Returns the suffix of a notice after others were held back.
fn in_between(held_back: u64) -> String {
    if held_back == 0 {
        String::new()
    } else {
        format!(" (and {held_back} notices like it that were held back)")
    }
}
