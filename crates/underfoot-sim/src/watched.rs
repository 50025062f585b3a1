//! Publishes the feet of a simulated floor, for display.

use triple_buffer::{Input, Output, triple_buffer};

use super::foot::{Foot, FootDriver};
use underfoot::units::Instant;

/// Wraps `driver` unchanged, and returns its feet of the last millisecond for another thread to read.
#[must_use]
pub fn watched(driver: Box<dyn FootDriver>) -> (WatchedFeet, Output<Vec<Foot>>) {
    let (seen, shown) = triple_buffer(&Vec::new());
    (WatchedFeet { driver, seen }, shown)
}

/// A driver that publishes its feet.
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
