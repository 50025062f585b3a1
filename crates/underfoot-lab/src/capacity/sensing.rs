//! Speed of sensing: floors of several sizes with people walking on them.

use super::crowd::{TileLoads, walkers_on};
use underfoot::sense::{ForceFrame, Method, Sensing};
use underfoot::units::Instant;

/// Sensing of a square floor with walkers, frame by frame.
#[derive(Debug)]
pub struct SensingLoad {
    sensing: Sensing,
    frame: ForceFrame,
    /// Loads at each millisecond; the sequence repeats.
    moments: Vec<TileLoads>,
    next: usize,
    millis: u64,
}

impl SensingLoad {
    /// Prepares a floor of `side` x `side` tiles with `walkers` people, two on each stretch of 6 x 6 tiles.
    ///
    /// `side` is clamped to 6 and the largest side of a floor; the number of walkers is limited to two for each
    /// stretch.
    #[must_use]
    pub fn new(side: u16, walkers: u16) -> Self {
        let (geometry, moments) = walkers_on(side, walkers);
        Self {
            moments,
            sensing: Sensing::new(geometry, Method::Tracker),
            frame: ForceFrame::empty(&geometry),
            next: 0,
            millis: 0,
        }
    }

    /// Senses one second of floor time, 1000 frames; returns the number of contacts in the last frame.
    pub fn second(&mut self) -> usize {
        let mut contacts = 0;
        for _ in 0..1000 {
            let before = (self.next + self.moments.len() - 1) % self.moments.len();
            self.moments[before].iter().for_each(|(index, _)| self.frame.forces[*index] = [0.0; 4]);
            self.moments[self.next].iter().for_each(|(index, forces)| self.frame.forces[*index] = *forces);
            self.frame.at = Instant::from_millis(self.millis);
            contacts = std::hint::black_box(self.sensing.update(&self.frame)).len();
            self.next = (self.next + 1) % self.moments.len();
            self.millis += 1;
        }
        contacts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_walkers_are_on_the_floor() {
        let most = |side, walkers| {
            let mut load = SensingLoad::new(side, walkers);
            (0..4).map(|_| load.second()).max()
        };
        // Each walker has one or two feet on the floor.
        assert!((2..=4).contains(&most(6, 2).unwrap()), "{:?}", most(6, 2));
        assert!((20..=40).contains(&most(24, 20).unwrap()), "{:?}", most(24, 20));
    }
}
