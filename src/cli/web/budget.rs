//! How much one client may send.

use std::time::Instant;

/// Bytes that are read of one client, so many at once and in each second; what is beyond waits in its connection.
#[derive(Debug)]
pub(super) struct Budget {
    most: f64,
    left: f64,
    at: Instant,
}

impl Budget {
    /// `most` bytes at once, and in each second.
    pub(super) fn new(most: usize, now: Instant) -> Self {
        let most = most as f64;
        Self { most, left: most, at: now }
    }

    /// Whether another message is read at `now`.
    pub(super) fn allows(&mut self, now: Instant) -> bool {
        let passed = now.duration_since(self.at).as_secs_f64();
        self.at = now;
        self.left = (self.left + passed * self.most).min(self.most);
        self.left > 0.0
    }

    /// Notes a message that was read; the last one may be larger than what was left.
    pub(super) fn spend(&mut self, bytes: usize) {
        self.left -= bytes as f64;
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn so_many_bytes_are_read_in_each_second() {
        let begun = Instant::now();
        let mut budget = Budget::new(1000, begun);
        let mut read = 0;
        for ms in 0..10_000 {
            while budget.allows(begun + Duration::from_millis(ms)) {
                budget.spend(300);
                read += 300;
            }
        }
        assert!((10_900..=11_400).contains(&read), "{read}");
    }
}
