//! A recording that begins and ends while the floor runs.

use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::Duration;

use super::events::{EventLines, JobSink};
use super::kept::as_kept;
use super::recorder::{BATCH, Recorder, WhenBehind};
use super::tap::{EntrySink, tapped};
use super::writer::{Job, RecordingHead};
use super::{RecordingError, restored};
use crate::engine::Snapshot;
use crate::floor::Floor;
use crate::layout::Layout;
use crate::schema;
use crate::sense::Method;
use crate::sink::{JsonSink, SinkError};
use crate::source::log::Entries;
use crate::source::{FloorInput, Journal};
use crate::units::Newtons;

/// Begins and ends recordings of one running floor, one after the other; clones are handles to the same floor.
///
/// A recording that begins in the middle has the values of the controls at its beginning. A replay finds the feet on
/// the floor anew: its first events may differ from those that were recorded, but each replay gives the same ones.
#[derive(Clone, Debug, Default)]
pub struct RecordingSwitch(Arc<Switched>);

#[derive(Debug, Default)]
struct Switched {
    floor: OnceLock<(Floor, Method)>,
    /// The layout that the floor got last.
    layout: Mutex<Option<Layout>>,
    is_on: AtomicBool,
    /// Locked for moments only: the sensing thread hands its entries to it.
    recorder: Mutex<Option<Recorder>>,
    lost: AtomicU64,
}

impl RecordingSwitch {
    /// Connects the switch to the floor of `input`; it records nothing before [`Self::begin`].
    pub(crate) fn wrap(
        &self,
        input: FloorInput,
        floor: &Floor,
        layout: &Layout,
        method: Method,
    ) -> FloorInput {
        // A switch belongs to its first floor.
        let _ = self.0.floor.set((floor.clone(), method));
        *locked(&self.0.layout) = Some(layout.clone());
        let mut input = tapped(input, self.clone(), floor.geometry);
        input.journals.push(Box::new(self.clone()));
        input
    }

    /// Records events while a recording is in progress: as the lines of [`JsonSink`].
    ///
    /// # Errors
    /// [`SinkError::Output`] if the system provides no thread.
    pub(crate) fn events(&self) -> Result<JsonSink, SinkError> {
        JsonSink::new(EventLines::new(self.clone()))
    }

    /// Begins a recording in a file at `path` and replaces an existing one. `snapshot` has the state of the controls,
    /// and `tare` the tare in use, if it is not the floor's own.
    ///
    /// # Errors
    /// [`RecordingError::Switch`] if a recording is in progress or the floor does not run, otherwise as for
    /// [`Recorder::around`].
    pub fn begin(
        &self,
        path: &Path,
        snapshot: &Snapshot,
        tare: Option<Vec<[Newtons; 4]>>,
    ) -> Result<(), RecordingError> {
        if self.is_on() {
            return Err(RecordingError::Switch("a recording is in progress"));
        }
        let (Some((floor, method)), Some(layout)) = (self.0.floor.get(), locked(&self.0.layout).clone())
        else {
            return Err(RecordingError::Switch("the floor does not run yet"));
        };
        let mut floor = floor.clone();
        if let Some(tare) = tare {
            floor.tare = tare;
        }
        let (layout_text, layout) = as_kept(&layout, &floor.geometry)?;
        let floor_text = schema::write_floor(&floor);
        let head = RecordingHead { floor: &floor_text, layout: &layout_text, method: *method, begins: None };
        let recorder = Recorder::create(path, head, WhenBehind::LeaveOut)?;
        // The queue is empty: they fit.
        let _ = recorder.hand_job(Job::Entries(restored::entries(snapshot, &layout)));
        *locked(&self.0.recorder) = Some(recorder);
        self.0.is_on.store(true, Ordering::Release);
        Ok(())
    }

    /// Ends the recording in progress, if any; the file is complete when this returns. Waits at most two seconds for
    /// the disk.
    pub fn end(&self) {
        self.0.is_on.store(false, Ordering::Release);
        let recorder = locked(&self.0.recorder).take();
        if let Some(recorder) = recorder {
            let lost = recorder.lost();
            drop(recorder);
            self.0.lost.fetch_add(lost.load(Ordering::Relaxed), Ordering::Relaxed);
        }
    }

    /// Whether a recording is in progress.
    #[must_use]
    pub fn is_on(&self) -> bool {
        self.0.is_on.load(Ordering::Acquire)
    }

    /// Number of entries and lines that all recordings so far lack, because the disk was full or too slow.
    #[must_use]
    pub fn lost(&self) -> u64 {
        let now =
            locked(&self.0.recorder).as_ref().map_or(0, |recorder| recorder.lost().load(Ordering::Relaxed));
        self.0.lost.load(Ordering::Relaxed) + now
    }
}

impl JobSink for RecordingSwitch {
    fn hand_job(&self, job: Job) -> Option<Job> {
        // Without a recording, nothing is wanted.
        locked(&self.0.recorder).as_ref()?.hand_job(job)
    }

    fn note_lost(&self, count: u64) {
        self.0.lost.fetch_add(count, Ordering::Relaxed);
    }
}

impl EntrySink for RecordingSwitch {
    fn is_wanted(&self) -> bool {
        self.is_on()
    }

    fn batch(&self) -> Duration {
        BATCH
    }

    fn is_exact(&self) -> bool {
        self.is_on()
    }

    fn hand(&self, entries: Entries) -> Option<Entries> {
        self.hand_entries(entries)
    }

    fn count_lost(&self, entries: u64) {
        self.note_lost(entries);
    }
}

/// Notes the layouts of the floor also while nothing is recorded.
impl Journal for RecordingSwitch {
    fn note_request(&mut self, _request: &crate::wire::Request) {}

    fn note_layout(&mut self, layout: &mut Layout) {
        *locked(&self.0.layout) = Some(layout.clone());
    }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
