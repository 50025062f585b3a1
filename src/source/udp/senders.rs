//! A token bucket for each sender, and a shared one for senders beyond the maximum.

use std::collections::HashMap;
use std::net::SocketAddr;
use std::time::Duration;

use crate::rate_limit::RateLimit;
use crate::units::Instant;

/// Maximum number of senders with a bucket of their own.
const MOST: usize = 1024;

/// Time for which a silent sender keeps its bucket.
const KEPT: Duration = Duration::from_secs(5);

/// Rate limits of senders, identified by address and port: two programs on one machine do not share a limit.
///
/// A sender that uses many ports at once shares one bucket with all other senders beyond the maximum.
#[derive(Debug)]
pub(super) struct Senders {
    limit: RateLimit,
    known: HashMap<SocketAddr, (RateLimit, Instant)>,
    others: RateLimit,
    /// Time of the next search for silent senders.
    next_look: Instant,
}

impl Senders {
    /// A bucket per sender: `burst` at once and one more each `every`.
    pub(super) fn new(burst: u32, every: Duration) -> Self {
        let limit = RateLimit::new(burst, every);
        Self { limit, known: HashMap::new(), others: limit, next_look: Instant::START }
    }

    /// Takes one token of `sender`; false if none is left.
    pub(super) fn take(&mut self, sender: SocketAddr, now: Instant) -> bool {
        if let Some((limit, seen)) = self.known.get_mut(&sender) {
            *seen = now;
            return limit.take(now).is_some();
        }
        if self.known.len() >= MOST && now >= self.next_look {
            self.next_look = now + Duration::from_secs(1);
            self.known.retain(|_, (_, seen)| now.since(*seen) < KEPT);
        }
        if self.known.len() >= MOST {
            return self.others.take(now).is_some();
        }
        let mut limit = self.limit;
        let may = limit.take(now).is_some();
        self.known.insert(sender, (limit, now));
        may
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sender(port: u16) -> SocketAddr {
        ([127, 0, 0, 1], port).into()
    }

    #[test]
    fn one_sender_s_flood_takes_nothing_from_another() {
        let mut senders = Senders::new(10, Duration::from_millis(1));
        let now = Instant::from_millis(100);
        assert_eq!((0..1000).filter(|_| senders.take(sender(1), now)).count(), 10);
        assert!(senders.take(sender(2), now));
        assert!(senders.take(sender(1), Instant::from_millis(101)));
    }

    #[test]
    fn many_senders_share_a_bucket_and_no_memory_grows() {
        let mut senders = Senders::new(2, Duration::from_secs(1));
        let now = Instant::from_millis(1);
        let passed = (0..50_000).filter(|&port| senders.take(sender(port), now)).count();
        assert_eq!(passed, MOST + 2);
        assert_eq!(senders.known.len(), MOST);
        // Silent senders free their buckets.
        assert!(senders.take(sender(60_000), now + KEPT));
        assert_eq!(senders.known.len(), 1);
    }
}
