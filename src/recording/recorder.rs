//! Makes a recording.

use std::fs::File;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use super::RecordingError;
use super::events::{EventLines, JobSink};
use super::kept::as_kept;
use super::tap::{EntrySink, tapped};
use super::writer::{Job, RecordingFile, RecordingHead};
use crate::floor::Floor;
use crate::layout::Layout;
use crate::schema;
use crate::sense::Method;
use crate::sink::{JsonSink, SinkError, Worker};
use crate::source::FloorInput;
use crate::source::log::Entries;

/// Behaviour when the disk is slower than the recording.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WhenBehind {
    /// Drops and counts the entries that do not fit: for running floors.
    #[default]
    LeaveOut,
    /// Blocks the sender: for simulated floors that run at full speed.
    Wait,
}

/// A recording in progress, on a thread of its own; it ends when this value and everything made from it are dropped.
#[derive(Clone, Debug)]
pub struct Recorder {
    worker: Arc<Worker<Job>>,
    lost: Arc<AtomicU64>,
    behind: WhenBehind,
}

/// A floor whose input is recorded, or which is unchanged.
pub struct Recorded {
    /// The recorder, if the floor is recorded.
    pub recorder: Option<Recorder>,
    /// The input to use from now on.
    pub input: FloorInput,
    /// The floor as stored in the recording.
    pub floor: Floor,
    /// The layout as stored in the recording.
    pub layout: Layout,
}

impl Recorder {
    /// Records all results of `input` into a file at `path` and replaces an existing one. Without a `path`, records
    /// and changes nothing.
    ///
    /// Floor and layout are stored as text, and the floor must work with the values read back from it: the numbers
    /// may differ from the given ones by a rounding. The input's time stands still between packets, so that a replay
    /// returns the same time at every query.
    ///
    /// # Errors
    /// [`RecordingError`] if the file can't be written, or if the floor or the layout can't be stored.
    pub fn around(
        path: Option<&Path>,
        input: impl Into<FloorInput>,
        floor: Floor,
        layout: Layout,
        method: Method,
        behind: WhenBehind,
    ) -> Result<Recorded, RecordingError> {
        let input = input.into();
        let Some(path) = path else { return Ok(Recorded { recorder: None, input, floor, layout }) };
        let floor_text = schema::write_floor(&floor);
        let floor = Floor { file: floor.file.clone(), ..schema::parse_floor(&floor_text, super::FLOOR)? };
        let (layout_text, layout) = as_kept(&layout, &floor.geometry)?;
        let head = RecordingHead { floor: &floor_text, layout: &layout_text, method, begins: None };
        let recorder = Self::create(path, head, behind)?;
        let input = tapped(input, recorder.clone(), floor.geometry);
        Ok(Recorded { recorder: Some(recorder), input, floor, layout })
    }

    /// Begins the file at `path`, and replaces an existing one.
    pub(super) fn create(
        path: &Path,
        head: RecordingHead<'_>,
        behind: WhenBehind,
    ) -> Result<Self, RecordingError> {
        let failed = |source| RecordingError::File { path: path.into(), source };
        let file = File::create(path).map_err(failed)?;
        let file = RecordingFile::begin(file, path, head).map_err(failed)?;
        let lost = Arc::<AtomicU64>::default();
        let counter = Arc::clone(&lost);
        let worker =
            Worker::spawn("recording", move |jobs| file.write_all(jobs, &counter)).map_err(failed)?;
        Ok(Self { worker: Arc::new(worker), lost, behind })
    }

    /// Records events: as the lines of [`JsonSink`].
    ///
    /// # Errors
    /// [`SinkError::Output`] if the system provides no thread.
    pub fn events(&self) -> Result<JsonSink, SinkError> {
        JsonSink::new(EventLines::new(self.clone()))
    }

    /// The counter of lost entries and event lines.
    #[must_use]
    pub fn lost(&self) -> Arc<AtomicU64> {
        Arc::clone(&self.lost)
    }
}

impl JobSink for Recorder {
    fn hand_job(&self, job: Job) -> Option<Job> {
        let mut job = self.worker.hand(job)?;
        if self.behind == WhenBehind::LeaveOut {
            return Some(job);
        }
        loop {
            std::thread::sleep(Duration::from_millis(1));
            job = self.worker.hand(job)?;
        }
    }

    fn note_lost(&self, count: u64) {
        self.lost.fetch_add(count, Ordering::Relaxed);
    }
}

/// Span of the floor's time in one batch; the writing thread's queue holds 20 s of it.
pub(super) const BATCH: Duration = Duration::from_millis(20);

impl EntrySink for Recorder {
    fn is_wanted(&self) -> bool {
        true
    }

    fn batch(&self) -> Duration {
        BATCH
    }

    fn is_exact(&self) -> bool {
        true
    }

    fn hand(&self, entries: Entries) -> Option<Entries> {
        self.hand_entries(entries)
    }

    fn count_lost(&self, entries: u64) {
        self.note_lost(entries);
    }
}
