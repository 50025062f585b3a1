//! Warnings about refused datagrams, at a limited rate.

use std::net::{IpAddr, SocketAddr};
use std::time::Duration;

use super::admission::AdmissionRefusal;
use crate::rate_limit::RateLimit;
use crate::units::Instant;
use crate::wire::WireError;

/// Minimum time between two messages about one kind of refusal, or about one sender.
const QUIET: Duration = Duration::from_secs(60);

/// Maximum number of senders that get messages of their own.
const NAMED: usize = 16;

/// Warnings about refused datagrams: the first of each kind, then one a minute with the number in between. Senders
/// that may not send get a warning each, up to a limit.
#[derive(Debug)]
pub(super) struct RefusalLog {
    malformed: RateLimit,
    unknown: RateLimit,
    skipped: RateLimit,
    readings: RateLimit,
    shape: RateLimit,
    unanswered: RateLimit,
    named: Vec<(IpAddr, RateLimit)>,
    others: RateLimit,
}

impl Default for RefusalLog {
    fn default() -> Self {
        let limit = RateLimit::new(1, QUIET);
        Self {
            malformed: limit,
            unknown: limit,
            skipped: limit,
            readings: limit,
            shape: limit,
            unanswered: limit,
            named: Vec::new(),
            others: limit,
        }
    }
}

impl RefusalLog {
    pub(super) fn refused(&mut self, now: Instant, sender: SocketAddr, error: &WireError) {
        let limit = match error {
            WireError::Malformed(_) => &mut self.malformed,
            WireError::UnknownAddress { .. } => &mut self.unknown,
            WireError::WrongReadings { .. } => &mut self.readings,
            WireError::WrongShape { .. } | WireError::TooEarly { .. } => &mut self.shape,
        };
        if let Some(others) = limit.take(now) {
            tracing::warn!(%sender, others_like_it = others, "datagram refused: {error}");
        }
    }

    /// Logs a message for another receiver, in a bundle whose remaining messages are used.
    pub(super) fn skipped(&mut self, now: Instant, sender: SocketAddr, address: &str) {
        if let Some(others) = self.skipped.take(now) {
            tracing::info!(
                %sender,
                others_like_it = others,
                "messages for {address:?} in bundles are skipped; the rest of each bundle is used"
            );
        }
    }

    pub(super) fn not_admitted(&mut self, now: Instant, sender: SocketAddr, refusal: AdmissionRefusal) {
        let ip = sender.ip().to_canonical();
        let limit = match self.named.iter().position(|(named, _)| *named == ip) {
            Some(index) => self.named.get_mut(index).map(|(_, limit)| limit),
            None if self.named.len() < NAMED => {
                self.named.push((ip, RateLimit::new(1, QUIET)));
                self.named.last_mut().map(|(_, limit)| limit)
            }
            None => None,
        };
        if let Some(others) = limit.unwrap_or(&mut self.others).take(now) {
            tracing::warn!(%sender, others_like_it = others, "datagram refused: {refusal}");
        }
    }

    pub(super) fn unanswered(&mut self, now: Instant, to: SocketAddr, error: &std::io::Error) {
        if let Some(others) = self.unanswered.take(now) {
            tracing::debug!(%to, others_like_it = others, "an answer could not be sent: {error}");
        }
    }
}
