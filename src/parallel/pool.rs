//! Work on one frame, divided among the threads of a pool.

use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Number of feet from which the work is divided: fewer are done before another thread has woken.
const MIN_FEET: usize = 96;

/// Fewest feet in a chunk: fewer cost less than handing them over.
const MIN_CHUNK: usize = 16;

/// Chunks per thread, so that no thread waits long for the last one.
const CHUNKS_PER_THREAD: usize = 4;

/// Spins for which the first thread that wakes leaves the other wake-ups to the other threads: about 0.1 ms.
const WAKE_SPINS: u32 = 10_000;

/// Threads that divide the work on one frame among them.
///
/// They sleep except during frames with a hundred feet and more. Needs feature `threads`.
#[derive(Debug)]
pub struct ThreadPool {
    pool: rayon::ThreadPool,
}

/// The system starts no more threads.
#[derive(Debug, thiserror::Error)]
#[error("cannot start threads for sensing: {0}; ask for fewer")]
pub struct ThreadPoolError(#[source] rayon::ThreadPoolBuildError);

impl ThreadPool {
    /// A pool of so many threads.
    ///
    /// # Errors
    /// The system starts no more threads.
    pub fn new(threads: NonZeroUsize) -> Result<Self, ThreadPoolError> {
        let name = |which| format!("sensing {which}");
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.get()).thread_name(name);
        Ok(Self { pool: pool.build().map_err(ThreadPoolError)? })
    }

    /// Runs `work` on one of the pool's threads and returns its result. The other threads take a part of each frame
    /// that [`Sensing`](crate::sense::Sensing) or an [`Engine`](crate::engine::Engine) is given in it.
    ///
    /// The calling thread waits. Meant for a whole loop over frames: each call costs a wake-up.
    ///
    /// # Panics
    /// If `work` panics.
    pub fn run<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        self.pool.install(work)
    }
}

/// Calls `work` on each of `items` with its position.
pub(crate) fn for_each<T: Send>(items: &mut [T], work: impl Fn(usize, &mut T) + Sync) {
    let chunk = if is_divided(items.len()) {
        MIN_CHUNK.max(items.len() / (CHUNKS_PER_THREAD * rayon::current_num_threads()))
    } else {
        items.len()
    };
    divide(0, items, chunk, &work);
}

/// Calls `work` on each of a few batches of work with its position; they have so many `feet` together.
pub(crate) fn for_each_batch<T: Send>(batches: &mut [T], feet: usize, work: impl Fn(usize, &mut T) + Sync) {
    let chunk = if is_divided(feet) { 1 } else { batches.len() };
    divide(0, batches, chunk, &work);
}

/// Calls `frame`, in which there are so many `feet`, while the pool's threads are awake.
pub(crate) fn with_pool_awake(feet: usize, frame: impl FnOnce() + Send) {
    if !is_divided(feet) {
        return frame();
    }
    let others = rayon::current_num_threads() - 1;
    let wake_up = WakeUp { others, awake: AtomicUsize::new(0), is_over: AtomicBool::new(false) };
    wake_up.during(others, frame);
}

/// Calls `work` once on each thread of the calling thread's pool; on the calling thread if it is in none.
#[cfg(feature = "net")]
pub(crate) fn on_each_thread(work: impl Fn() + Sync) {
    if rayon::current_thread_index().is_some() {
        rayon::broadcast(|_| work());
    } else {
        work();
    }
}

fn is_divided(feet: usize) -> bool {
    feet >= MIN_FEET && rayon::current_thread_index().is_some() && rayon::current_num_threads() > 1
}

fn divide<T: Send>(first: usize, items: &mut [T], chunk: usize, work: &(impl Fn(usize, &mut T) + Sync)) {
    if items.len() <= chunk {
        items.iter_mut().enumerate().for_each(|(position, item)| work(first + position, item));
        return;
    }
    let middle = items.len() / 2;
    let (left, right) = items.split_at_mut(middle);
    rayon::join(|| divide(first, left, chunk, work), || divide(first + middle, right, chunk, work));
}

/// Keeps the pool's other threads awake during one frame.
struct WakeUp {
    others: usize,
    awake: AtomicUsize,
    is_over: AtomicBool,
}

impl WakeUp {
    /// Calls `frame`, with a wake-up for each of so many `others`.
    fn during(&self, others: usize, frame: impl FnOnce() + Send) {
        let Some(others) = others.checked_sub(1) else {
            // Also if it panics.
            let _end = End(&self.is_over);
            return frame();
        };
        rayon::join(|| self.during(others, frame), || self.spin());
    }

    /// Works on chunks until the frame is over.
    fn spin(&self) {
        self.awake.fetch_add(1, Ordering::AcqRel);
        let is_over = || self.is_over.load(Ordering::Acquire);
        // A thread that looks for work would take the wake-ups of the other threads as well.
        for _ in 0..WAKE_SPINS {
            if is_over() || self.awake.load(Ordering::Acquire) >= self.others {
                break;
            }
            std::hint::spin_loop();
        }
        while !is_over() {
            if rayon::yield_now() != Some(rayon::Yield::Executed) {
                std::hint::spin_loop();
            }
        }
    }
}

/// Marks a frame as over when dropped.
struct End<'a>(&'a AtomicBool);

impl Drop for End<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Release);
    }
}

#[cfg(test)]
mod tests {
    use std::panic::{AssertUnwindSafe, catch_unwind};

    use super::*;

    fn pool(threads: usize) -> Option<ThreadPool> {
        NonZeroUsize::new(threads).and_then(|threads| ThreadPool::new(threads).ok())
    }

    #[test]
    fn each_foot_is_worked_on_once() {
        // Many, a number that no chunk divides, too few to be divided, and none.
        for feet in [1000, 997, 3, 0] {
            let mut done = vec![0; feet];
            let count = |which: usize, done: &mut usize| *done += which + 1;
            pool(4).unwrap().run(|| with_pool_awake(feet, || for_each(&mut done, count)));
            assert!(done.iter().enumerate().all(|(which, &done)| done == which + 1), "{feet}");
            pool(4).unwrap().run(|| for_each_batch(&mut done, 1000, count));
            assert!(done.iter().enumerate().all(|(which, &done)| done == 2 * (which + 1)), "{feet}");
        }
    }

    #[test]
    fn other_threads_take_a_part() {
        let mut by = vec![None; 1000];
        // Another thread is awake after some frames at the latest, also where all cores are busy.
        let is_divided = pool(2).unwrap().run(|| {
            (0..1000).any(|_| {
                with_pool_awake(1000, || {
                    for_each(&mut by, |_, by| {
                        std::thread::yield_now();
                        *by = rayon::current_thread_index();
                    });
                });
                by.iter().any(|&thread| thread != by[0])
            })
        });
        assert!(is_divided);
    }

    #[test]
    fn the_pool_works_on_after_a_frame_that_panics() {
        let pool = pool(3).unwrap();
        let panicked = catch_unwind(AssertUnwindSafe(|| {
            pool.run(|| with_pool_awake(1000, || panic!("a frame that cannot be sensed")));
        }));
        assert!(panicked.is_err());
        let mut done = [false; 200];
        pool.run(|| with_pool_awake(200, || for_each(&mut done, |_, done| *done = true)));
        assert_eq!(done, [true; 200]);
    }
}
