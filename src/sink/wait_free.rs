//! A bounded queue from one thread to another, in which no thread ever waits for the progress of the other one.
//!
//! A channel of the standard library does, for a moment: a sender that finds it full spins while a receiver that has
//! begun to take something finishes, and a receiver spins for a sender that has begun to send. If the spinning thread
//! has the higher real-time priority and the other one needs its processor, that moment lasts for ever.

use std::sync::atomic::{Ordering, fence};
use std::sync::mpsc::{RecvError, RecvTimeoutError, SendError, TrySendError};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::thread::{self, Thread};
use std::time::{Duration, Instant};

use rtrb::{Consumer, Producer, PushError, RingBuffer};

/// The end of the queue that gives: the thread with the higher priority may hold it.
#[derive(Debug)]
pub struct WaitFreeSender<T> {
    // Dropped before `reader` wakes the receiver, which then finds the queue abandoned.
    items: Producer<T>,
    reader: Wake,
}

/// The end of the queue that takes. One thread must take everything.
#[derive(Debug)]
pub struct WaitFreeReceiver<T> {
    items: Consumer<T>,
    reader: Arc<OnceLock<Thread>>,
}

/// The end of the queue that gives, shared by several threads: a thread may wait for another one that gives, but the
/// receiver waits for none of them.
#[derive(Debug)]
pub struct SharedSender<T>(Arc<Mutex<WaitFreeSender<T>>>);

/// Interval between two attempts to send into a full queue.
const ROOM_EVERY: Duration = Duration::from_millis(1);

/// Wakes the thread that takes, also when dropped.
#[derive(Debug)]
struct Wake(Arc<OnceLock<Thread>>);

/// The two ends of a queue of at most `capacity` items; with 0 it is always full.
#[must_use]
pub fn wait_free<T>(capacity: usize) -> (WaitFreeSender<T>, WaitFreeReceiver<T>) {
    let (producer, consumer) = RingBuffer::new(capacity);
    let reader = Arc::<OnceLock<Thread>>::default();
    let sender = WaitFreeSender { items: producer, reader: Wake(Arc::clone(&reader)) };
    (sender, WaitFreeReceiver { items: consumer, reader })
}

/// As [`wait_free`], with an end for several threads that give.
#[must_use]
pub fn wait_free_shared<T>(capacity: usize) -> (SharedSender<T>, WaitFreeReceiver<T>) {
    let (sender, receiver) = wait_free(capacity);
    (SharedSender(Arc::new(Mutex::new(sender))), receiver)
}

impl<T> WaitFreeSender<T> {
    /// Queues `item` and wakes the receiver.
    ///
    /// # Errors
    /// Returns `item` if the queue is full or the receiver has been dropped.
    pub fn try_send(&mut self, item: T) -> Result<(), T> {
        if self.items.is_abandoned() {
            return Err(item);
        }
        self.items.push(item).map_err(|PushError::Full(item)| item)?;
        self.reader.wake();
        Ok(())
    }
}

impl<T> SharedSender<T> {
    /// Queues `item` and wakes the receiver.
    ///
    /// # Errors
    /// Returns `item` if the queue is full or the receiver has been dropped.
    pub fn try_send(&self, item: T) -> Result<(), TrySendError<T>> {
        let mut sender = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        sender.try_send(item).map_err(|item| {
            if sender.items.is_abandoned() {
                TrySendError::Disconnected(item)
            } else {
                TrySendError::Full(item)
            }
        })
    }

    /// Queues `item`, waits until there is room for it, and wakes the receiver. It sleeps for a millisecond at a
    /// time while the queue is full, so it is not for a thread that must not wait, nor for a page in a browser.
    ///
    /// # Errors
    /// Returns `item` if the receiver has been dropped.
    pub fn send(&self, mut item: T) -> Result<(), SendError<T>> {
        loop {
            match self.try_send(item) {
                Ok(()) => return Ok(()),
                Err(TrySendError::Disconnected(item)) => return Err(SendError(item)),
                Err(TrySendError::Full(again)) => item = again,
            }
            thread::sleep(ROOM_EVERY);
        }
    }
}

impl<T> Clone for SharedSender<T> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<T> WaitFreeReceiver<T> {
    /// The next item, or `None` if there is none yet. Does not wait.
    pub fn try_recv(&mut self) -> Option<T> {
        self.items.pop().ok()
    }

    /// The next item, for which it waits at most `patience`.
    ///
    /// # Errors
    /// [`RecvTimeoutError::Timeout`] if none has come, [`RecvTimeoutError::Disconnected`] once the sender has been
    /// dropped and everything taken.
    pub fn recv_timeout(&mut self, patience: Duration) -> Result<T, RecvTimeoutError> {
        self.be_reader();
        let start = Instant::now();
        loop {
            if let Some(taken) = self.take_or_end() {
                return taken.map_err(|RecvError| RecvTimeoutError::Disconnected);
            }
            let left = patience.saturating_sub(start.elapsed());
            if left.is_zero() {
                return Err(RecvTimeoutError::Timeout);
            }
            // Returns at once if the sender has woken this thread since it last waited.
            thread::park_timeout(left);
        }
    }

    /// The next item, for which it waits.
    ///
    /// # Errors
    /// [`RecvError`] once the sender has been dropped and everything taken.
    pub fn recv(&mut self) -> Result<T, RecvError> {
        self.be_reader();
        loop {
            if let Some(taken) = self.take_or_end() {
                return taken;
            }
            // As above.
            thread::park();
        }
    }

    /// All items until the sender is dropped; waits for each.
    pub fn iter(&mut self) -> impl Iterator<Item = T> {
        std::iter::from_fn(|| self.recv().ok())
    }

    /// Lets the sender wake this thread.
    fn be_reader(&self) {
        self.reader.get_or_init(thread::current);
        // Either the sender sees this thread after it has queued an item, or this thread sees the item.
        fence(Ordering::SeqCst);
    }

    /// The next item, or the end; `None` while there is neither.
    fn take_or_end(&mut self) -> Option<Result<T, RecvError>> {
        // Asked first: what was sent before the sender was dropped is still taken.
        let is_last = self.items.is_abandoned();
        let item = self.try_recv();
        item.map(Ok).or_else(|| is_last.then_some(Err(RecvError)))
    }

    /// All items that are there. Does not wait.
    pub fn try_iter(&mut self) -> impl Iterator<Item = T> {
        std::iter::from_fn(|| self.try_recv())
    }
}

impl Wake {
    fn wake(&self) {
        // See `be_reader`.
        fence(Ordering::SeqCst);
        if let Some(reader) = self.0.get() {
            reader.unpark();
        }
    }
}

impl Drop for Wake {
    fn drop(&mut self) {
        self.wake();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LONG: Duration = Duration::from_secs(30);

    #[test]
    fn everything_arrives_in_order_and_then_the_end() {
        let (mut sender, mut receiver) = wait_free(4);
        let giver = thread::spawn(move || {
            for number in 0..10_000 {
                let mut item = number;
                // Full for as long as the other thread is not there.
                while let Err(again) = sender.try_send(item) {
                    item = again;
                    thread::yield_now();
                }
            }
        });
        let mut taken = Vec::new();
        while let Ok(number) = receiver.recv_timeout(LONG) {
            taken.push(number);
        }
        assert!(taken.iter().copied().eq(0..10_000));
        assert_eq!(receiver.recv_timeout(LONG), Err(RecvTimeoutError::Disconnected));
        giver.join().unwrap();
    }

    #[test]
    fn a_full_queue_and_a_receiver_that_is_gone_return_the_item() {
        let (mut sender, mut receiver) = wait_free(2);
        assert_eq!([1, 2, 3].map(|item| sender.try_send(item)), [Ok(()), Ok(()), Err(3)]);
        assert_eq!(receiver.try_iter().collect::<Vec<_>>(), [1, 2]);
        assert_eq!(receiver.recv_timeout(Duration::ZERO), Err(RecvTimeoutError::Timeout));
        drop(receiver);
        assert_eq!(sender.try_send(4), Err(4));
    }

    #[test]
    fn several_threads_send_and_wait_for_room() {
        let (sender, mut receiver) = wait_free_shared(2);
        let givers = [0, 1_000].map(|first| {
            let sender = sender.clone();
            thread::spawn(move || (first..first + 50).for_each(|number| sender.send(number).unwrap()))
        });
        let mut taken: Vec<i32> = (0..100).map(|_| receiver.recv_timeout(LONG).unwrap()).collect();
        taken.sort_unstable();
        assert!(taken.into_iter().eq((0..50).chain(1_000..1_050)));
        givers.into_iter().for_each(|giver| giver.join().unwrap());
        sender.try_send(1).unwrap();
        sender.try_send(2).unwrap();
        assert_eq!(sender.try_send(3), Err(TrySendError::Full(3)));
        drop(receiver);
        assert_eq!(sender.try_send(3), Err(TrySendError::Disconnected(3)));
        assert_eq!(sender.send(3), Err(SendError(3)));
    }

    #[test]
    fn a_receiver_that_waits_is_woken_by_an_item_and_by_the_end() {
        let (mut sender, mut receiver) = wait_free(2);
        let taker = thread::spawn(move || [receiver.recv_timeout(LONG), receiver.recv_timeout(LONG)]);
        let started = Instant::now();
        // Long enough for the other thread to be waiting, at least mostly.
        thread::sleep(Duration::from_millis(20));
        sender.try_send(7).unwrap();
        thread::sleep(Duration::from_millis(20));
        drop(sender);
        assert_eq!(taker.join().unwrap(), [Ok(7), Err(RecvTimeoutError::Disconnected)]);
        assert!(started.elapsed() < LONG, "nobody woke it");
    }
}
