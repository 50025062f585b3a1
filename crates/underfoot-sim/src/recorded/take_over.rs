//! Recorded feet up to a moment, and those of another driver from then on.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::RecordedFeet;
use crate::foot::{Foot, FootDriver};
use underfoot::units::Instant;

/// Time in which the recorded feet lift once another driver has taken over, in milliseconds: a brisk step.
const LIFTING_MS: u64 = 80;

/// Stands for a moment that has not come.
const NEVER: u64 = u64::MAX;

/// Returns a driver of the recorded feet, and the handle with which `live` takes over from them.
///
/// The driver does not end with the recorded feet: the floor stays empty after them until `live` takes over.
#[must_use]
pub fn go_on_from(recorded: Arc<RecordedFeet>, live: Box<dyn FootDriver>) -> (TakeOver, Box<dyn FootDriver>) {
    let taken_us = Arc::new(AtomicU64::new(NEVER));
    let handle = TakeOver(Arc::clone(&taken_us));
    (handle, Box::new(Joined { recorded, live, taken_us, others: Vec::new() }))
}

/// Lets a driver take over from recorded feet.
#[derive(Clone, Debug)]
pub struct TakeOver(Arc<AtomicU64>);

impl TakeOver {
    /// The recorded feet lift at the moment `at` on the floor's clock, and the other driver's feet come; only the
    /// first call counts.
    pub fn at(&self, at: Instant) {
        let _ = self.0.compare_exchange(NEVER, at.micros(), Ordering::Relaxed, Ordering::Relaxed);
    }
}

struct Joined {
    recorded: Arc<RecordedFeet>,
    live: Box<dyn FootDriver>,
    taken_us: Arc<AtomicU64>,
    others: Vec<Foot>,
}

impl FootDriver for Joined {
    fn feet(&mut self, at: Instant, feet: &mut Vec<Foot>) -> bool {
        let taken = Instant::from_micros(self.taken_us.load(Ordering::Relaxed));
        if at < taken {
            self.recorded.feet_at(at, feet);
            return true;
        }
        let goes_on = self.live.feet(at, feet);
        let lifted_ms = u64::try_from(at.since(taken).as_millis()).unwrap_or(u64::MAX);
        if lifted_ms < LIFTING_MS {
            // Each lifts where it stands.
            self.recorded.feet_at(taken, &mut self.others);
            let share = 1.0 - lifted_ms as f32 / LIFTING_MS as f32;
            feet.extend(self.others.iter().map(|foot| Foot { force: foot.force * share, ..*foot }));
        }
        goes_on
    }
}

impl fmt::Debug for Joined {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Joined").field("taken_us", &self.taken_us).finish_non_exhaustive()
    }
}
