//! Adds people to a running simulated floor.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};

use thiserror::Error;

use super::foot::{Foot, FootDriver};
use super::script::Script;
use underfoot::units::Instant;

/// Maximum number of scripts that play at the same time; each has two feet per person.
const MOST: usize = 32;

/// Reason why a script can't be added.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum ArrivalError {
    /// 32 scripts are playing already.
    #[error("{MOST} are on the floor already: wait until some have left")]
    Crowded,
    /// The floor has ended.
    #[error("the floor has ended")]
    Ended,
}

/// Returns a handle that adds people, and a driver with the feet of `driver` and of the added people.
///
/// The driver goes to the simulated floor's thread; the sending thread keeps the handle. The performance ends when
/// `driver` has ended and all added scripts are over.
#[must_use]
pub fn arrivals(driver: Box<dyn FootDriver>) -> (ArrivalHandle, Arrivals) {
    let (sender, sent) = sync_channel(MOST);
    let playing = Arc::<AtomicUsize>::default();
    let handle = ArrivalHandle { sender, playing: Arc::clone(&playing) };
    (handle, Arrivals { driver, sent, playing, present: Vec::new(), theirs: Vec::new() })
}

/// Adds people to a floor.
#[derive(Clone, Debug)]
pub struct ArrivalHandle {
    sender: SyncSender<Script>,
    playing: Arc<AtomicUsize>,
}

impl ArrivalHandle {
    /// Plays `script` once, starting now. Never blocks.
    ///
    /// # Errors
    /// [`ArrivalError`] if 32 scripts are playing, or if the floor has ended.
    pub fn send(&self, script: Script) -> Result<(), ArrivalError> {
        let one_more = |playing| (playing < MOST).then_some(playing + 1);
        self.playing
            .fetch_update(Ordering::Relaxed, Ordering::Relaxed, one_more)
            .map_err(|_| ArrivalError::Crowded)?;
        // The channel has room for as many scripts as may play.
        self.sender.try_send(script).map_err(|_| ArrivalError::Ended)
    }

    /// Returns the number of scripts that are playing or start with the next millisecond.
    #[must_use]
    pub fn playing(&self) -> usize {
        self.playing.load(Ordering::Relaxed)
    }
}

/// The feet of a driver, and of the people that were added to it.
pub struct Arrivals {
    driver: Box<dyn FootDriver>,
    sent: Receiver<Script>,
    playing: Arc<AtomicUsize>,
    /// Start time and script of each added performance.
    present: Vec<(Instant, Script)>,
    theirs: Vec<Foot>,
}

impl FootDriver for Arrivals {
    fn feet(&mut self, at: Instant, feet: &mut Vec<Foot>) -> bool {
        let goes_on = self.driver.feet(at, feet);
        self.present.extend(self.sent.try_iter().map(|script| (at, script)));
        self.present.retain_mut(|(since, script)| {
            let stays = script.feet(Instant::START + at.since(*since), &mut self.theirs);
            feet.append(&mut self.theirs);
            if !stays {
                self.playing.fetch_sub(1, Ordering::Relaxed);
            }
            stays
        });
        goes_on || !self.present.is_empty()
    }
}

impl std::fmt::Debug for Arrivals {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Arrivals").field("present", &self.present.len()).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use glam::Vec2;

    use super::*;
    use crate::{Performance, Person, feet_by_hand};
    use underfoot::floor::Geometry;

    /// A script of one person who stands on the floor for `ms` milliseconds.
    fn stands(ms: u64) -> Script {
        let mut person = Performance::new(Person::default(), 1);
        person.appear(Vec2::new(0.9, 0.9), 0.0).unwrap();
        person.wait(Duration::from_millis(ms));
        Script::new(vec![person], Geometry::default().bounds())
    }

    #[test]
    fn people_come_when_they_are_sent_and_go_when_they_are_done() {
        let (_hand, nobody) = feet_by_hand();
        let (handle, mut floor) = arrivals(Box::new(nobody));
        let mut feet = Vec::new();
        let mut count_at = |floor: &mut Arrivals, ms| {
            assert!(floor.feet(Instant::from_millis(ms), &mut feet), "the hand is still there");
            feet.len()
        };
        assert_eq!(count_at(&mut floor, 5000), 0);
        handle.send(stands(1000)).unwrap();
        handle.send(stands(300)).unwrap();
        assert_eq!(count_at(&mut floor, 5001), 4);
        assert_eq!(handle.playing(), 2);
        assert_eq!(count_at(&mut floor, 5500), 2, "one has gone");
        assert_eq!(count_at(&mut floor, 6500), 0);
        assert_eq!(handle.playing(), 0);
    }

    #[test]
    fn the_floor_ends_after_the_last_one_has_left_and_takes_only_so_many() {
        let (hand, nobody) = feet_by_hand();
        let (handle, mut floor) = arrivals(Box::new(nobody));
        for _ in 0..MOST {
            handle.send(stands(100)).unwrap();
        }
        assert_eq!(handle.send(stands(100)), Err(ArrivalError::Crowded));
        drop(hand);
        let mut feet = Vec::new();
        assert!(floor.feet(Instant::from_millis(1), &mut feet));
        assert_eq!(feet.len(), 2 * MOST);
        assert!(!floor.feet(Instant::from_millis(500), &mut feet) && feet.is_empty());
        drop(floor);
        assert_eq!(handle.send(stands(100)), Err(ArrivalError::Ended));
    }
}
