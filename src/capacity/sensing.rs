//! How fast sensing is: floors of several sizes with people walking on them.

use super::crowd::{Loads, walkers_on};
use crate::sense::{ForceFrame, Method, Sensing};
use crate::units::Instant;

/// The sensing of a square floor on which people walk, frame by frame.
#[derive(Debug)]
pub struct SensingLoad {
    sensing: Sensing,
    frame: ForceFrame,
    /// What is loaded at each millisecond, over and over.
    moments: Vec<Loads>,
    next: usize,
    millis: u64,
}

impl SensingLoad {
    /// A floor of `side` x `side` tiles with so many walkers, two on each stretch of 6 x 6 tiles.
    ///
    /// A side of less than 6 is taken for 6, one that no floor can have for the largest there is; there are
    /// no more walkers than stretches have room for.
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

    /// Senses one second of floor, 1000 frames; the answer is the number of contacts in the last.
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
        // Each has one or two feet down.
        assert!((2..=4).contains(&most(6, 2).unwrap()), "{:?}", most(6, 2));
        assert!((20..=40).contains(&most(24, 20).unwrap()), "{:?}", most(24, 20));
    }
}
