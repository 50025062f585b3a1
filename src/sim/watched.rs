//! The feet of a simulated floor, for whoever wants to see them.

use triple_buffer::{Input, Output, triple_buffer};

use super::foot::{Foot, FootDriver};
use crate::units::Instant;

/// `driver` as before, and its feet of the last millisecond, to be read on another thread.
#[must_use]
pub fn watched(driver: Box<dyn FootDriver>) -> (WatchedFeet, Output<Vec<Foot>>) {
    let (seen, shown) = triple_buffer(&Vec::new());
    (WatchedFeet { driver, seen }, shown)
}

/// A driver whose feet somebody looks at.
pub struct WatchedFeet {
    driver: Box<dyn FootDriver>,
    seen: Input<Vec<Foot>>,
}

impl FootDriver for WatchedFeet {
    fn feet(&mut self, at: Instant, feet: &mut Vec<Foot>) -> bool {
        let goes_on = self.driver.feet(at, feet);
        self.seen.input_buffer_mut().clone_from(feet);
        self.seen.publish();
        goes_on
    }
}

impl std::fmt::Debug for WatchedFeet {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("WatchedFeet").finish_non_exhaustive()
    }
}
