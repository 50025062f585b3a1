//! Reports of rejected messages, while a program runs and at its end.

use std::time::Duration;

use underfoot::units::Instant;
use underfoot_cluster::auth::AuthRefusals;

/// Interval between two checks of the counters. Messages before the first answer are no longer counted by then.
const LOOK_EVERY: Duration = Duration::from_secs(1);

/// Interval between two notices with the same reason.
const QUIET: Duration = Duration::from_secs(60);

/// The messages with one reason.
#[derive(Clone, Copy, Debug, Default)]
struct Known {
    /// Their number at the last check.
    seen: u64,
    reported: u64,
    reported_at: Option<Instant>,
}

/// Notices about rejected messages: one at the first of each reason, then one a minute with the number so far.
#[derive(Clone, Debug, Default)]
pub(super) struct RefusalNotices {
    reasons: [Known; 6],
    looked: Instant,
}

impl RefusalNotices {
    /// The notices that are due at `now`; `noun` names the messages.
    pub(super) fn look(&mut self, refusals: AuthRefusals, noun: &str, now: Instant) -> Vec<String> {
        if now.since(self.looked) < LOOK_EVERY {
            return Vec::new();
        }
        self.looked = now;
        let due = self.reasons.iter_mut().zip(refusals.by_reason()).filter_map(|(known, (count, reason))| {
            // A count that lasts from one check to the next is final.
            let lasting = count.min(std::mem::replace(&mut known.seen, count));
            let is_quiet = known.reported_at.is_some_and(|reported| now.since(reported) < QUIET);
            if lasting <= known.reported || is_quiet {
                return None;
            }
            (known.reported, known.reported_at) = (lasting, Some(now));
            Some(format!("Refused so far: {lasting} {noun} {reason}."))
        });
        due.collect()
    }
}

/// Prints one line for each reason, at the end.
pub(super) fn report(refusals: AuthRefusals, noun: &str) {
    let all = refusals.by_reason().into_iter().filter(|(count, _)| *count > 0);
    all.for_each(|(count, reason)| eprintln!("{count} {noun} {reason}, refused."));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(s: u64) -> Instant {
        Instant::from_millis(1000 * s)
    }

    #[test]
    fn a_reason_is_reported_once_a_minute() {
        let mut notices = RefusalNotices::default();
        let mut look = |forged, s| {
            let refusals = AuthRefusals { forged, ..AuthRefusals::default() };
            notices.look(refusals, "messages", at(s))
        };
        assert!(look(0, 1).is_empty());
        assert!(look(3, 2).is_empty(), "it must last for two looks");
        assert_eq!(look(9, 3), ["Refused so far: 3 messages not written with this floor's key."]);
        assert!((4..63).all(|s| look(9 * s, s).is_empty()));
        assert_eq!(look(9000, 63).len(), 1);
    }

    #[test]
    fn a_count_that_is_taken_back_is_not_reported() {
        let mut notices = RefusalNotices::default();
        let mut look = |unanswered, s| {
            let refusals = AuthRefusals { unanswered, ..AuthRefusals::default() };
            notices.look(refusals, "messages", at(s)).len()
        };
        assert_eq!([look(20, 1), look(0, 2), look(0, 3)], [0; 3]);
    }
}
