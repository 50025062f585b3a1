//! Bounds on the rate of messages.

use std::time::Duration;

use crate::rate_limit::RateLimit;
use crate::units::Instant;

/// Shortest time between two messages that follow one value: 100 a second, as contacts in OSC.
pub(super) const EVERY: Duration = Duration::from_millis(10);

/// Tokens that one key, click or event costs; one that follows a value costs 1.
pub(super) const STROKE: u32 = 5;

/// The bound of one target: 1000 tokens a second (our choice: 200 keys, far beyond feet, or ten values at
/// [`EVERY`]), 200 of them at once.
pub(super) fn of_target() -> RateLimit {
    RateLimit::new(200, Duration::from_millis(1))
}

/// The next message that follows one value.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ValuePace {
    last: Option<Instant>,
    /// Whether a value waits; the latest one goes out.
    pub(super) waits: bool,
}

impl ValuePace {
    /// Whether a waiting value may go out at `now`.
    pub(super) fn is_due(&self, now: Instant) -> bool {
        self.waits && self.last.is_none_or(|last| now.since(last) >= EVERY)
    }

    /// Notes that the latest value has gone out.
    pub(super) fn sent(&mut self, now: Instant) {
        *self = Self { last: Some(now), waits: false };
    }
}
