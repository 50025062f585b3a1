//! A bounded queue between two threads that never blocks; when full, it evicts its oldest items.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use rtrb::{Consumer, Producer, RingBuffer};

/// Both ends of a queue that holds the `capacity` newest items (at least one); allocates all memory here.
///
/// A ring alone can only reject its newest item, since the reader owns the items inside. So items are numbered: those
/// that do not fit wait in the writer's backlog. The writer also publishes the number of the oldest valid item, and
/// the reader skips older ones.
pub(super) fn evicting_queue<T>(capacity: usize) -> (Writer<T>, QueueReader<T>) {
    let capacity = capacity.max(1);
    let (producer, consumer) = RingBuffer::new(capacity);
    let shared = Arc::new(Shared::default());
    let writer = Writer {
        ring: producer,
        backlog: VecDeque::with_capacity(capacity),
        capacity: capacity as u64,
        next: 0,
        shared: Arc::clone(&shared),
    };
    (writer, QueueReader { ring: consumer, shared })
}

#[derive(Debug, Default)]
struct Shared {
    /// Number of the oldest valid item.
    oldest: AtomicU64,
    /// Items evicted so far.
    dropped: AtomicU64,
}

#[derive(Debug)]
struct Numbered<T> {
    number: u64,
    item: T,
}

/// The end that inserts items.
#[derive(Debug)]
pub(super) struct Writer<T> {
    ring: Producer<Numbered<T>>,
    /// Items that did not fit into the ring, oldest first.
    backlog: VecDeque<Numbered<T>>,
    capacity: u64,
    next: u64,
    shared: Arc<Shared>,
}

impl<T> Writer<T> {
    /// Inserts an item; if the queue is full, evicts its oldest one.
    pub(super) fn push(&mut self, item: T) {
        let number = self.announce();
        self.hand_over(number, item);
    }

    /// Drops items that have become too old, and numbers the item that takes their place.
    fn announce(&mut self) -> u64 {
        let number = self.next;
        self.next += 1;
        let oldest = self.next.saturating_sub(self.capacity);
        self.shared.oldest.store(oldest, Ordering::Release);
        while self.backlog.front().is_some_and(|front| front.number < oldest) {
            self.backlog.pop_front();
            self.shared.dropped.fetch_add(1, Ordering::Relaxed);
        }
        number
    }

    fn hand_over(&mut self, number: u64, item: T) {
        // Fewer than `capacity` are left, so this does not allocate.
        self.backlog.push_back(Numbered { number, item });
        self.flush();
    }

    /// Moves items from the backlog into the ring; to be called now and then.
    pub(super) fn flush(&mut self) {
        while let Some(front) = self.backlog.pop_front() {
            if let Err(rtrb::PushError::Full(front)) = self.ring.push(front) {
                self.backlog.push_front(front);
                break;
            }
        }
    }

    /// Drops the backlog; returns the number of its items.
    pub(super) fn take_back(&mut self) -> u32 {
        let number = self.backlog.len() as u32;
        self.backlog.clear();
        number
    }

    /// Items evicted so far in favour of newer ones.
    pub(super) fn dropped(&self) -> u64 {
        self.shared.dropped.load(Ordering::Relaxed)
    }
}

/// The end that removes items.
///
/// # Real-time
/// No call blocks, allocates or enters the system.
#[derive(Debug)]
pub(super) struct QueueReader<T> {
    ring: Consumer<Numbered<T>>,
    shared: Arc<Shared>,
}

impl<T> QueueReader<T> {
    /// Removes the oldest valid item.
    pub(super) fn pop(&mut self) -> Option<T> {
        let oldest = self.shared.oldest.load(Ordering::Acquire);
        loop {
            let numbered = self.ring.pop().ok()?;
            if numbered.number >= oldest {
                return Some(numbered.item);
            }
            self.shared.dropped.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// Items evicted so far in favour of newer ones.
    pub(super) fn dropped(&self) -> u64 {
        self.shared.dropped.load(Ordering::Relaxed)
    }

    /// The first item in the ring, perhaps one that is too old.
    pub(super) fn peek(&self) -> Option<&T> {
        self.ring.peek().ok().map(|numbered| &numbered.item)
    }

    /// Removes the first item in the ring, perhaps one that is too old.
    pub(super) fn skip(&mut self) -> bool {
        self.ring.pop().is_ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drain(reader: &mut QueueReader<u32>) -> Vec<u32> {
        std::iter::from_fn(|| reader.pop()).collect()
    }

    #[test]
    fn a_queue_that_nobody_reads_keeps_the_newest() {
        let (mut writer, mut reader) = evicting_queue(4);
        (0..10).for_each(|item| writer.push(item));
        // The ring still holds the first four, which are too old now; the writer holds the last four.
        assert!(drain(&mut reader).is_empty());
        writer.flush();
        assert_eq!(drain(&mut reader), [6, 7, 8, 9]);
        assert_eq!(writer.dropped(), 6);
        writer.push(10);
        assert_eq!((drain(&mut reader), writer.dropped()), (vec![10], 6));
    }

    /// A step of one thread that is atomic for the other thread.
    #[derive(Clone, Copy, Debug)]
    enum Step {
        Announce,
        HandOver,
        Flush,
    }

    /// A8: every way in which the two threads' steps can follow each other.
    ///
    /// The steps are those that the other side can distinguish: the writer's store and its ring operation, the
    /// reader's whole pop (one load, then the removal). The test assumes that the ring itself is linearisable.
    #[test]
    fn a8_in_every_interleaving_order_is_kept_and_only_the_oldest_are_evicted() {
        const CAPACITY: usize = 2;
        let writing = [Step::Announce, Step::HandOver].repeat(5).into_iter().chain([Step::Flush]);
        let writing: Vec<Step> = writing.collect();
        let reads = 6;
        let mut tried = 0;
        // A set bit is a step of the reader.
        let steps = writing.len() + reads;
        for order in (0_u32..1 << steps).filter(|order| order.count_ones() as usize == reads) {
            let (mut writer, mut reader) = evicting_queue::<u32>(CAPACITY);
            let mut todo = writing.iter();
            let (mut sent, mut number, mut got) = (0, 0, Vec::new());
            for step in 0..steps {
                if order >> step & 1 == 1 {
                    got.extend(reader.pop());
                    continue;
                }
                match todo.next() {
                    Some(Step::Announce) => number = writer.announce(),
                    Some(Step::HandOver) => {
                        writer.hand_over(number, sent);
                        sent += 1;
                    }
                    Some(Step::Flush) => writer.flush(),
                    None => unreachable!("as many steps as there are"),
                }
                assert!(writer.backlog.len() <= CAPACITY, "{order:b}");
            }
            got.extend(drain(&mut reader));
            writer.flush();
            got.extend(drain(&mut reader));
            assert!(got.is_sorted_by(|a, b| a < b), "{order:b}: out of order: {got:?}");
            assert_eq!(
                got.len() as u64 + writer.dropped(),
                u64::from(sent),
                "{order:b}: some are unaccounted for"
            );
            assert!(got.ends_with(&[3, 4]), "{order:b}: the newest must come through: {got:?}");
            tried += 1;
        }
        assert_eq!(tried, 12_376, "17 steps, 6 of them the reader's");
    }
}
