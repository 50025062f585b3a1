//! The results of a server's source, as frames for the windows that have joined.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::time::Duration;

use super::frame;
use crate::floor::Geometry;
use crate::recording::{EntrySink, tapped};
use crate::sink::{SinkError, WaitFreeReceiver, Worker};
use crate::source::FloorInput;
use crate::source::log::Entries;

/// Span of the floor's time in one frame, which is the maximum delay that framing adds.
const BATCH: Duration = Duration::from_millis(4);

/// Taps the source of a server and turns its results into frames; does no work while no window has joined.
#[derive(Clone, Debug)]
pub struct MirrorFeed {
    worker: Arc<Worker<Entries>>,
    joined: Arc<AtomicUsize>,
    lost: Arc<AtomicU64>,
}

impl MirrorFeed {
    /// Calls `tell` with each frame, on a thread of its own, while `joined`, the number of joined windows, is not
    /// zero.
    ///
    /// # Errors
    /// [`SinkError::Output`] if the system provides no thread.
    pub fn start(
        joined: Arc<AtomicUsize>,
        mut tell: impl FnMut(Vec<u8>) + Send + 'static,
    ) -> Result<Self, SinkError> {
        let failed = |source| SinkError::Output {
            message: format!("the floor can't be shown elsewhere: {source}"),
            source,
        };
        let work = move |batches: &mut WaitFreeReceiver<Entries>| {
            for entries in batches.iter() {
                let mut bytes = Vec::with_capacity(128 * entries.len());
                frame::write(&entries, &mut bytes);
                tell(bytes);
            }
        };
        let worker = Arc::new(Worker::spawn("mirror", work).map_err(failed)?);
        Ok(Self { worker, joined, lost: Arc::default() })
    }

    /// Wraps `input`, for a floor of this geometry, so that its results are sent to all joined windows.
    #[must_use]
    pub fn wrap(&self, input: impl Into<FloorInput>, geometry: Geometry) -> FloorInput {
        tapped(input.into(), self.clone(), geometry)
    }

    /// Number of entries dropped because the thread did not keep up; the stream has a gap entry in their place.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.lost.load(Ordering::Relaxed)
    }
}

impl EntrySink for MirrorFeed {
    fn is_wanted(&self) -> bool {
        self.joined.load(Ordering::Relaxed) > 0
    }

    fn batch(&self) -> Duration {
        BATCH
    }

    /// Joined windows do not change the server's own time.
    fn is_exact(&self) -> bool {
        false
    }

    fn hand(&self, entries: Entries) -> Option<Entries> {
        if entries.is_empty() { None } else { self.worker.hand(entries) }
    }

    fn count_lost(&self, entries: u64) {
        self.lost.fetch_add(entries, Ordering::Relaxed);
    }
}
