//! Notices that may repeat: some at once, then few, with the number in between.

use std::time::Duration;

use tracing::{info, warn};

use crate::rate_limit::RateLimit;
use crate::units::Instant;

/// The notices of a server that apps, cables and sensors can make repeat.
#[derive(Debug)]
pub(super) struct Notices {
    /// Requests that could not be met.
    pub(super) denied: Limited,
    /// Floors lost and found.
    pub(super) link: Limited,
    /// Sensors in trouble and out of it.
    pub(super) troubles: Limited,
}

impl Default for Notices {
    fn default() -> Self {
        Self {
            denied: Limited::new(5, Duration::from_secs(10)),
            link: Limited::new(10, Duration::from_secs(10)),
            // As many as a large board has channels: one that is unplugged is named sensor by sensor.
            troubles: Limited::new(64, Duration::from_secs(2)),
        }
    }
}

/// One kind of notice.
#[derive(Debug)]
pub(super) struct Limited(RateLimit);

impl Limited {
    const fn new(burst: u32, every: Duration) -> Self {
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
