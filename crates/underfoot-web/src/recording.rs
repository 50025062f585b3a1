//! A recording (MCAP) in a page, read from memory, as a reel.

use std::io::Cursor;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use underfoot::recording::{Recording, RecordingError, Timeline};
use underfoot::units::Instant;
use underfoot_sim::TakeOver;
use underfoot_window::preview::{PlaybackMark, PreviewInput};

use super::floor::PageFloor;
use super::plan::NoFloor;
use super::played::Reel;

/// Maximum size of a recording in a page, in megabytes: half an hour of the usual floor.
pub(crate) const MOST_MEGABYTES: usize = 64;

/// A recording in the memory of the page.
pub struct RecordingReel {
    bytes: Arc<[u8]>,
    name: PathBuf,
    length: Duration,
    marks: Vec<PlaybackMark>,
    broken: Option<String>,
}

impl RecordingReel {
    /// The recording in `bytes`; messages call it `name`. Reads it whole, for its length and its marks.
    ///
    /// # Errors
    /// [`NoFloor::Large`] above 64 MB, [`NoFloor::Recording`] for bytes that are not a recording of a floor.
    pub fn new(name: &str, bytes: Vec<u8>) -> Result<Self, NoFloor> {
        if bytes.len() > MOST_MEGABYTES << 20 {
            return Err(NoFloor::Large);
        }
        let (bytes, length) = (Arc::from(bytes), Duration::ZERO);
        let mut reel = Self { bytes, name: name.into(), length, marks: Vec::new(), broken: None };
        let mut whole = Timeline::default();
        reel.open()?.read_timeline(|timeline| {
            whole.clone_from(timeline);
            true
        });
        let recording = reel.open()?;
        let begins = recording.begins().unwrap_or(Instant::START);
        let first = whole.span.map_or(begins, |(first, _)| first.max(begins));
        reel.length = whole.span.map_or(Duration::ZERO, |(_, last)| last.since(first));
        reel.marks = whole.marks.iter().map(|mark| PlaybackMark::of_recording(mark, first)).collect();
        reel.broken = whole.broken;
        Ok(reel)
    }

    fn open(&self) -> Result<Recording, RecordingError> {
        Recording::read(Box::new(Cursor::new(Arc::clone(&self.bytes))), &self.name)
    }
}

impl Reel for RecordingReel {
    fn begin(&self) -> Result<(PageFloor, PreviewInput, Option<TakeOver>), NoFloor> {
        let (floor, input) = PageFloor::of_recording(self.open()?);
        Ok((floor, input, None))
    }

    fn duration(&self) -> Duration {
        self.length
    }

    fn marks(&self) -> Option<Vec<PlaybackMark>> {
        Some(self.marks.clone())
    }

    fn broken(&self) -> Option<String> {
        self.broken.clone()
    }
}
