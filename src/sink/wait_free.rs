//! A bounded queue from one thread to another, in which no thread ever waits for the progress of the other one.
//!
//! A channel of the standard library does, for a moment: a sender that finds it full spins while a receiver that has
//! begun to take something finishes, and a receiver spins for a sender that has begun to send. If the spinning thread
//! has the higher real-time priority and the other one needs its processor, that moment lasts for ever.

use std::sync::mpsc::RecvTimeoutError;
use std::sync::{Arc, OnceLock};
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
        self.reader.get_or_init(thread::current);
        let start = Instant::now();
        loop {
            // Asked first: what was sent before the sender was dropped is still taken.
            let is_last = self.items.is_abandoned();
            if let Some(item) = self.try_recv() {
                return Ok(item);
            }
            if is_last {
                return Err(RecvTimeoutError::Disconnected);
            }
            let left = patience.saturating_sub(start.elapsed());
            if left.is_zero() {
                return Err(RecvTimeoutError::Timeout);
            }
            // Returns at once if the sender has woken this thread since it last waited.
            thread::park_timeout(left);
        }
    }

    /// All items that are there. Does not wait.
    pub fn try_iter(&mut self) -> impl Iterator<Item = T> {
        std::iter::from_fn(|| self.try_recv())
    }
}

impl Wake {
    fn wake(&self) {
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
