//! The recent places and loads of a foot.

use std::time::Duration;

use glam::Vec2;

use crate::units::Instant;

/// Interval at which a foot's place is recorded, and number of places: the last 0.4 s.
pub(super) const PLACE_EVERY: Duration = Duration::from_millis(20);
const PLACES: usize = 20;

/// Place and force of a foot, and the load on the person's other feet, at one moment of the past.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PastLoad {
    pub(super) place: Vec2,
    pub(super) force: f32,
    pub(super) others: f32,
}

/// The last [`PLACES`] records of a foot.
#[derive(Clone, Debug)]
pub(super) struct Past {
    /// The latest is at `next` - 1.
    loads: [PastLoad; PLACES],
    next: usize,
    kept: usize,
    kept_at: Instant,
}

impl Past {
    /// The history of a foot that lands now with `load`.
    pub(super) const fn new(load: PastLoad, now: Instant) -> Self {
        Self { loads: [load; PLACES], next: 0, kept: 0, kept_at: now }
    }

    /// Records `load`, unless the last record is more recent than [`PLACE_EVERY`].
    #[inline]
    pub(super) fn note(&mut self, load: PastLoad, now: Instant) {
        if now.since(self.kept_at) >= PLACE_EVERY {
            self.kept_at = now;
            self.loads[self.next] = load;
            self.next = (self.next + 1) % PLACES;
            self.kept = (self.kept + 1).min(PLACES);
        }
    }

    /// Number of records.
    pub(super) const fn len(&self) -> usize {
        self.kept
    }

    /// The record of so many records ago.
    #[inline]
    pub(super) fn ago(&self, ago: usize) -> PastLoad {
        self.loads[(self.next + 2 * PLACES - 1 - ago) % PLACES]
    }

    /// The last records, at most so many, latest first.
    pub(super) fn latest(&self, most: usize) -> impl Iterator<Item = PastLoad> + '_ {
        (0..most.min(self.kept)).map(|ago| self.ago(ago))
    }
}
