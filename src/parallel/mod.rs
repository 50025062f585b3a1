//! The feet of a crowd, shared among several threads.
//!
//! Inside `ThreadPool::run` the work on a frame is divided among the pool's threads; elsewhere the calling thread
//! does all of it. The work on one foot writes nothing that the work on another reads, so the result is the same, to
//! the bit.
//!
//! Waking a thread takes about as long as sensing a hundred feet. So the pool's threads are woken at the beginning of a
//! frame and spin until its end. The calling thread never waits for a thread that has not woken yet.

#[cfg(not(feature = "threads"))]
mod alone;
#[cfg(feature = "threads")]
mod pool;

#[cfg(all(feature = "net", not(feature = "threads")))]
pub(crate) use self::alone::on_each_thread;
#[cfg(not(feature = "threads"))]
pub(crate) use self::alone::{for_each, for_each_batch, with_pool_awake};
#[cfg(all(feature = "net", feature = "threads"))]
pub(crate) use self::pool::on_each_thread;
#[cfg(feature = "threads")]
pub use self::pool::{ThreadPool, ThreadPoolError};
#[cfg(feature = "threads")]
pub(crate) use self::pool::{for_each, for_each_batch, with_pool_awake};
