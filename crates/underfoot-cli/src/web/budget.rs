//! The rate limit on the input of one client.

use std::time::Instant;

/// A token bucket of bytes read from one client; bytes beyond it wait in the connection.
#[derive(Debug)]
pub(super) struct Budget {
    most: f64,
    left: f64,
    at: Instant,
}

impl Budget {
    /// `most` bytes at once, and per second.
    pub(super) fn new(most: usize, now: Instant) -> Self {
        let most = most as f64;
        Self { most, left: most, at: now }
    }

    /// Whether another message may be read at `now`.
    pub(super) fn allows(&mut self, now: Instant) -> bool {
        let passed = now.duration_since(self.at).as_secs_f64();
        self.at = now;
        self.left = (self.left + passed * self.most).min(self.most);
        self.left > 0.0
    }

    /// Subtracts a message that was read; the last one may exceed the remainder.
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
