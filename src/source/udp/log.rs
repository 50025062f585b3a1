//! Warnings about refused datagrams, at a limited rate.

use std::net::SocketAddr;
use std::time::Duration;

use crate::units::Instant;
use crate::wire::WireError;

/// How often one kind of refusal is written about.
const QUIET: Duration = Duration::from_secs(60);

/// Warnings about refused datagrams: the first of each kind, then one a minute with the number in between.
#[derive(Debug, Default)]
pub(super) struct RefusalLog {
    malformed: Warned,
    unknown: Warned,
    shape: Warned,
    foreign: Warned,
}

#[derive(Debug, Default)]
struct Warned {
    last: Option<Instant>,
    kept_quiet: u64,
}

impl Warned {
    /// How many were kept quiet since the last warning, if it is time for another.
    fn due(&mut self, now: Instant) -> Option<u64> {
        if self.last.is_some_and(|last| now.since(last) < QUIET) {
            self.kept_quiet += 1;
            return None;
        }
        self.last = Some(now);
        Some(std::mem::take(&mut self.kept_quiet))
    }
}

impl RefusalLog {
    pub(super) fn refused(&mut self, now: Instant, sender: SocketAddr, error: &WireError) {
        let warned = match error {
            WireError::Malformed(_) => &mut self.malformed,
            WireError::UnknownAddress { .. } => &mut self.unknown,
            WireError::WrongShape { .. } | WireError::TooEarly { .. } => &mut self.shape,
        };
        if let Some(others) = warned.due(now) {
            tracing::warn!(%sender, others_like_it = others, "datagram refused: {error}");
        }
    }

    pub(super) fn foreign(&mut self, now: Instant, sender: SocketAddr) {
        if let Some(others) = self.foreign.due(now) {
            tracing::warn!(
                %sender,
                others_like_it = others,
                "datagram refused: the sender is not among the allowed ones"
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_warning_a_minute_tells_how_many_were_kept_quiet() {
        let mut warned = Warned::default();
        assert_eq!(warned.due(Instant::from_millis(1)), Some(0));
        for ms in 2..100 {
            assert_eq!(warned.due(Instant::from_millis(ms)), None);
        }
        assert_eq!(warned.due(Instant::from_millis(60_001)), Some(98));
    }
}
