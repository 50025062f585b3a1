//! A thread for work that may block, behind a bounded queue.

use std::io;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, TrySendError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{Builder, JoinHandle};
use std::time::Duration;

use super::wait_free::{SharedSender, WaitFreeReceiver, wait_free_shared};

/// Maximum number of waiting jobs: a second in which every foot of a crowd causes an event.
const QUEUE: usize = 1024;

/// Maximum wait for the last jobs at the end of the program; a stopped reader must not block it.
const SHUTDOWN_TIMEOUT: Duration = Duration::from_secs(2);

/// A thread for work that may block, so that its owner never blocks.
#[derive(Debug)]
pub(crate) struct Worker<T> {
    /// `None` only while being dropped.
    jobs: Option<SharedSender<T>>,
    /// Locked only in `drop`: several threads may share a worker.
    finished: Mutex<Receiver<()>>,
    thread: Option<JoinHandle<()>>,
    dropped: Arc<AtomicU64>,
}

impl<T: Send + 'static> Worker<T> {
    /// Starts a thread that runs `work` until the jobs end; if `work` ends earlier, waiting jobs are dropped.
    pub(crate) fn spawn(
        name: &str,
        work: impl FnOnce(&mut WaitFreeReceiver<T>) + Send + 'static,
    ) -> io::Result<Self> {
        let (jobs, mut queue) = wait_free_shared(QUEUE);
        let (finish, finished) = channel();
        let dropped = Arc::new(AtomicU64::new(0));
        let left = dropped.clone();
        let thread = Builder::new().name(name.into()).spawn(move || {
            work(&mut queue);
            left.fetch_add(queue.try_iter().count() as u64, Ordering::Relaxed);
            // The owner may have stopped waiting for the end.
            let _ = finish.send(());
        })?;
        let finished = Mutex::new(finished);
        Ok(Self { jobs: Some(jobs), finished, thread: Some(thread), dropped })
    }

    /// Queues a job; false, and counted, if the queue is full or the thread has ended.
    pub(crate) fn offer(&self, job: T) -> bool {
        let taken = self.try_offer(job);
        if !taken {
            self.dropped.fetch_add(1, Ordering::Relaxed);
        }
        taken
    }

    /// Queues a job; returns it if the queue is full. If the thread has ended, the job is dropped and counted.
    pub(crate) fn hand(&self, job: T) -> Option<T> {
        match self.jobs.as_ref()?.try_send(job) {
            Ok(()) => None,
            Err(TrySendError::Full(job)) => Some(job),
            Err(TrySendError::Disconnected(_)) => {
                self.dropped.fetch_add(1, Ordering::Relaxed);
                None
            }
        }
    }

    /// Queues a job that may be lost.
    pub(crate) fn try_offer(&self, job: T) -> bool {
        self.jobs.as_ref().is_some_and(|jobs| jobs.try_send(job).is_ok())
    }

    /// Returns the number of dropped jobs.
    pub(crate) fn dropped(&self) -> u64 {
        self.dropped.load(Ordering::Relaxed)
    }
}

impl<T> Drop for Worker<T> {
    /// Waits for the thread to finish the queued jobs, up to a time-out.
    fn drop(&mut self) {
        self.jobs = None;
        let finished = self.finished.get_mut().unwrap_or_else(PoisonError::into_inner);
        if finished.recv_timeout(SHUTDOWN_TIMEOUT).is_ok()
            && let Some(thread) = self.thread.take()
            && thread.join().is_err()
        {
            tracing::warn!("a thread that passes events on has panicked");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_offered_is_done_before_the_end() {
        let (done, results) = channel();
        let worker = Worker::spawn("test", move |jobs: &mut WaitFreeReceiver<u32>| {
            jobs.iter().for_each(|job| done.send(job).unwrap());
        })
        .unwrap();
        assert!((0..1000).all(|job| worker.offer(job)));
        drop(worker);
        assert_eq!(results.iter().collect::<Vec<_>>(), (0..1000).collect::<Vec<_>>());
    }

    #[test]
    fn too_many_jobs_are_counted_and_never_wait() {
        let (go, gate) = channel::<()>();
        let worker = Worker::spawn("test", move |jobs: &mut WaitFreeReceiver<u32>| {
            let _ = gate.recv();
            jobs.iter().for_each(drop);
        })
        .unwrap();
        let taken = (0..5000).filter(|&job| worker.offer(job)).count();
        assert_eq!(taken, QUEUE);
        assert_eq!(worker.dropped(), 5000 - QUEUE as u64);
        drop(go);
    }
}
