//! Jobs that wait for a slow reader: bounded, with a gap record in the place of every dropped job.

use std::collections::VecDeque;

use crate::units::Instant;

/// Maximum number of entries kept one by one: an hour of four presses a second.
const KEPT: usize = 16_384;

/// Importance of a job when there is no room for all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Worth<K> {
    /// Only the latest job with the same key matters: values, states.
    Latest(K),
    /// Each job matters: begins and ends of presses. Beyond `KEPT` entries the oldest with the same key is dropped.
    Each(K),
    /// The job may always be dropped.
    None,
}

/// Jobs dropped between two others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Gap {
    /// Time of the last of them.
    pub(super) at: Instant,
    /// Number of dropped jobs.
    pub(super) dropped: u64,
}

impl Gap {
    fn add(&mut self, other: Self) {
        self.at = self.at.max(other.at);
        self.dropped += other.dropped;
    }
}

/// Jobs that found no room in the queue to a reader.
#[derive(Debug)]
pub(super) struct Backlog<T, K> {
    entries: VecDeque<Entry<T, K>>,
    /// Jobs dropped after the last entry.
    tail: Gap,
    dropped: u64,
}

#[derive(Debug)]
struct Entry<T, K> {
    at: Instant,
    job: T,
    worth: Worth<K>,
    /// Jobs dropped before it.
    before: Gap,
}

impl<T, K> Default for Backlog<T, K> {
    fn default() -> Self {
        Self { entries: VecDeque::new(), tail: Gap::default(), dropped: 0 }
    }
}

impl<T: From<Gap>, K: PartialEq> Backlog<T, K> {
    /// Whether no jobs wait.
    pub(super) fn is_empty(&self) -> bool {
        self.entries.is_empty() && self.tail.dropped == 0
    }

    /// Returns the number of jobs dropped so far.
    pub(super) const fn dropped(&self) -> u64 {
        self.dropped
    }

    /// Appends a job of time `at`; drops a less important one to make room.
    pub(super) fn push(&mut self, at: Instant, job: T, worth: Worth<K>) {
        let replaced = match &worth {
            Worth::None => {
                self.dropped += 1;
                self.tail.add(Gap { at, dropped: 1 });
                return;
            }
            Worth::Latest(_) => self.entries.iter().rposition(|entry| entry.worth == worth),
            Worth::Each(_) if self.entries.len() >= KEPT => {
                self.entries.iter().position(|entry| entry.worth == worth)
            }
            Worth::Each(_) => None,
        };
        if let Some(index) = replaced {
            self.drop_entry(index);
        }
        let before = std::mem::take(&mut self.tail);
        self.entries.push_back(Entry { at, job, worth, before });
    }

    /// Drops one entry and adds it to the gap before the next one.
    fn drop_entry(&mut self, index: usize) {
        let Some(Entry { at, before, .. }) = self.entries.remove(index) else { return };
        let next = self.entries.get_mut(index).map_or(&mut self.tail, |next| &mut next.before);
        next.add(before);
        next.add(Gap { at, dropped: 1 });
        self.dropped += 1;
    }

    /// Passes jobs to `offer`, in order and with the gaps in their places, until it returns one.
    pub(super) fn flush(&mut self, mut offer: impl FnMut(T) -> Option<T>) {
        loop {
            let gap = self.entries.front_mut().map_or(&mut self.tail, |entry| &mut entry.before);
            if gap.dropped > 0 {
                if offer(T::from(*gap)).is_some() {
                    return;
                }
                *gap = Gap::default();
            }
            let Some(Entry { at, job, worth, before }) = self.entries.pop_front() else { return };
            if let Some(job) = offer(job) {
                self.entries.push_front(Entry { at, job, worth, before });
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[derive(Clone, Copy, Debug, PartialEq)]
    enum Job {
        Number(u64),
        Gap(u64),
    }

    impl From<Gap> for Job {
        fn from(gap: Gap) -> Self {
            Self::Gap(gap.dropped)
        }
    }

    #[derive(Clone, Copy, Debug)]
    enum Op {
        Push(Worth<u8>),
        Read(usize),
    }

    fn ops() -> impl Strategy<Value = Vec<Op>> {
        let op = prop_oneof![
            4 => (0_u8..3).prop_map(|key| Op::Push(Worth::Latest(key))),
            2 => (0_u8..3).prop_map(|key| Op::Push(Worth::Each(key))),
            1 => Just(Op::Push(Worth::None)),
            1 => (0_usize..4).prop_map(Op::Read),
        ];
        prop::collection::vec(op, 0..200)
    }

    fn read(backlog: &mut Backlog<Job, u8>, mut room: usize, read: &mut Vec<Job>) {
        backlog.flush(|job| {
            if room == 0 {
                return Some(job);
            }
            room -= 1;
            read.push(job);
            None
        });
    }

    proptest! {
        /// For any sequence of pushes and reads: order, correct gaps in the correct places, every end and every last
        /// value.
        #[test]
        fn what_is_left_out_is_told_in_its_place(ops in ops()) {
            let (mut backlog, mut heard, mut pushed) = (Backlog::default(), Vec::new(), Vec::new());
            for op in ops {
                match op {
                    Op::Push(worth) => {
                        let number = pushed.len() as u64;
                        backlog.push(Instant::from_millis(number), Job::Number(number), worth);
                        pushed.push(worth);
                    }
                    Op::Read(room) => read(&mut backlog, room, &mut heard),
                }
            }
            read(&mut backlog, usize::MAX, &mut heard);
            prop_assert!(backlog.is_empty());
            // Every number is either read or counted in the gap in its place.
            let (mut next, mut dropped) = (0, 0);
            for job in &heard {
                match *job {
                    Job::Number(number) => {
                        prop_assert_eq!(number, next);
                        next += 1;
                    }
                    Job::Gap(missing) => {
                        next += missing;
                        dropped += missing;
                    }
                }
            }
            prop_assert_eq!((next, dropped), (pushed.len() as u64, backlog.dropped()));
            let is_read = |number: usize| heard.contains(&Job::Number(number as u64));
            for (number, worth) in pushed.iter().enumerate() {
                match worth {
                    Worth::Each(_) => prop_assert!(is_read(number), "{} matters", number),
                    Worth::Latest(_) if !pushed[number + 1..].contains(worth) => {
                        prop_assert!(is_read(number), "{} is the latest", number);
                    }
                    Worth::Latest(_) | Worth::None => {}
                }
            }
        }
    }

    #[test]
    fn a_reader_that_never_comes_back_costs_bounded_memory_and_the_last_end_is_kept() {
        let mut backlog = Backlog::default();
        let last = 3 * KEPT as u64;
        for number in 0..=last {
            backlog.push(Instant::START, Job::Number(number), Worth::Each(number % 2));
        }
        assert_eq!(backlog.entries.len(), KEPT);
        let mut heard = Vec::new();
        backlog.flush(|job| {
            heard.push(job);
            None
        });
        assert_eq!(heard.first(), Some(&Job::Gap(last + 1 - KEPT as u64)));
        assert_eq!(heard[heard.len() - 2..], [Job::Number(last - 1), Job::Number(last)]);
    }
}
