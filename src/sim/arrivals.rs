//! People who come onto a simulated floor whenever somebody sends them.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};

use thiserror::Error;

use super::foot::{Foot, FootDriver};
use super::script::Script;
use crate::units::Instant;

/// Scripts that are played at one time; each has two feet for each of its people.
const MOST: usize = 32;

/// Why nobody comes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum ArrivalError {
    /// So many play already.
    #[error("{MOST} are on the floor already: wait until some have left")]
    Crowded,
    /// The floor has ended.
    #[error("the floor has ended")]
    Ended,
}

/// A handle to send people with, and `driver` with the feet of those who were sent beside its own.
///
/// The driver goes to the simulated floor's thread, the handle stays with whoever sends people. The performance is
/// over when that of `driver` is and nobody who was sent is left.
#[must_use]
pub fn arrivals(driver: Box<dyn FootDriver>) -> (ArrivalHandle, Arrivals) {
    let (sender, sent) = sync_channel(MOST);
    let playing = Arc::<AtomicUsize>::default();
    let handle = ArrivalHandle { sender, playing: Arc::clone(&playing) };
    (handle, Arrivals { driver, sent, playing, present: Vec::new(), theirs: Vec::new() })
}

/// Sends people onto a floor.
#[derive(Clone, Debug)]
pub struct ArrivalHandle {
    sender: SyncSender<Script>,
    playing: Arc<AtomicUsize>,
}

impl ArrivalHandle {
    /// Plays `script` once, from now on. Never blocks.
    ///
    /// # Errors
    /// [`ArrivalError`]: 32 scripts are being played, or the floor has ended.
    pub fn send(&self, script: Script) -> Result<(), ArrivalError> {
        let one_more = |playing| (playing < MOST).then_some(playing + 1);
        self.playing
            .fetch_update(Ordering::Relaxed, Ordering::Relaxed, one_more)
            .map_err(|_| ArrivalError::Crowded)?;
        // There is room for all that may play.
        self.sender.try_send(script).map_err(|_| ArrivalError::Ended)
    }

    /// How many scripts are being played, or will be from the next millisecond on.
    #[must_use]
    pub fn playing(&self) -> usize {
        self.playing.load(Ordering::Relaxed)
    }
}

/// A driver's feet, and those of people who were sent.
pub struct Arrivals {
    driver: Box<dyn FootDriver>,
    sent: Receiver<Script>,
    playing: Arc<AtomicUsize>,
    /// Who is there, and since when.
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
    use crate::floor::Geometry;
    use crate::sim::{Performance, Person, feet_by_hand};

    /// Somebody who stands on the floor for as long.
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
