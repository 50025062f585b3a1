//! Warnings about refused datagrams, at a limited rate.

use std::net::SocketAddr;
use std::time::Duration;

use crate::rate_limit::RateLimit;
use crate::units::Instant;
use crate::wire::WireError;

/// How often one kind of refusal is written about.
const QUIET: Duration = Duration::from_secs(60);

/// Warnings about refused datagrams: the first of each kind, then one a minute with the number in between.
#[derive(Debug)]
pub(super) struct RefusalLog {
    malformed: RateLimit,
    unknown: RateLimit,
    shape: RateLimit,
    foreign: RateLimit,
}

impl Default for RefusalLog {
    fn default() -> Self {
        let limit = RateLimit::new(1, QUIET);
        Self { malformed: limit, unknown: limit, shape: limit, foreign: limit }
    }
}

impl RefusalLog {
    pub(super) fn refused(&mut self, now: Instant, sender: SocketAddr, error: &WireError) {
        let warned = match error {
            WireError::Malformed(_) => &mut self.malformed,
            WireError::UnknownAddress { .. } => &mut self.unknown,
            WireError::WrongShape { .. } | WireError::TooEarly { .. } => &mut self.shape,
        };
        if let Some(others) = warned.take(now) {
            tracing::warn!(%sender, others_like_it = others, "datagram refused: {error}");
        }
    }

    pub(super) fn foreign(&mut self, now: Instant, sender: SocketAddr) {
        if let Some(others) = self.foreign.take(now) {
            tracing::warn!(
                %sender,
                others_like_it = others,
                "datagram refused: the sender is not among the allowed ones"
            );
        }
    }
}
