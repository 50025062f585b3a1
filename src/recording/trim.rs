//! A part of a recording as a recording of its own.
//!
//! The events of a part depend on all that came before: on the values of controls, on the feet on the floor, on the
//! noise of the sensors. The new file therefore keeps the messages before the part, and notes where the part begins.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::time::Duration;

use super::RecordingError;
use super::events::time_of;
use super::kept::as_kept;
use super::messages::LogPart;
use super::reader::Recording;
use super::writer::{RecordingFile, RecordingHead};
use crate::schema;
use crate::source::log::LogEntry;
use crate::units::Instant;

/// Number of entries and lines between two progress reports: about a second of a recording.
const ROUND: usize = 5_000;

/// Maximum time by which the line of an event follows its entries in the file: lines come from another thread.
const LINES_BEHIND: Duration = Duration::from_secs(2);

/// The result of a trim.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Trimmed {
    /// Last moment of the new recording; the floor's start if nothing was recorded.
    pub ends: Instant,
    /// Place and reason, if the recording breaks off before the end of the part.
    pub broken: Option<String>,
}

impl Recording {
    /// Writes a recording that shows the part from `from` to `to` only, and replaces an existing file at `path`, which
    /// may be that of this recording. Times are those of the floor's clock; an earlier `from` than
    /// [`Self::begins`] counts as that. A replay reports the same events within the part; at its end, all holds are
    /// cancelled.
    ///
    /// Calls `tell` from time to time with the moment that is reached; `false` from it stops the work, leaves the file
    /// as it was, and gives `None`.
    ///
    /// # Errors
    /// [`RecordingError::File`] if the file can't be written, [`RecordingError::Diagnostics`] if the floor or the
    /// layout can't be stored.
    pub fn trim(
        self,
        path: &Path,
        (from, to): (Instant, Instant),
        tell: impl FnMut(Instant) -> bool,
    ) -> Result<Option<Trimmed>, RecordingError> {
        // The recording may be read from the file that is to be replaced.
        let aside = aside(path);
        let trimmed = self.write_part(&aside, (from, to), tell).and_then(|trimmed| {
            if trimmed.is_some() {
                fs::rename(&aside, path)
                    .map_err(|source| RecordingError::File { path: path.into(), source })?;
            }
            Ok(trimmed)
        });
        if !matches!(trimmed, Ok(Some(_))) {
            // It may not exist.
            let _ = fs::remove_file(&aside);
        }
        trimmed
    }

    fn write_part(
        self,
        path: &Path,
        (from, to): (Instant, Instant),
        mut tell: impl FnMut(Instant) -> bool,
    ) -> Result<Option<Trimmed>, RecordingError> {
        let failed = |source| RecordingError::File { path: path.into(), source };
        let floor = schema::write_floor(self.floor());
        let (layout, _) = as_kept(self.layout(), &self.floor().geometry)?;
        let begins = Some(self.begins().map_or(from, |begins| begins.max(from)));
        let head = RecordingHead { floor: &floor, layout: &layout, method: self.method(), begins };
        let file = File::create(path).map_err(failed)?;
        let mut file = RecordingFile::begin(file, path, head).map_err(failed)?;
        let (mut parts, mut trimmed, mut at) = (self.into_parts(), Trimmed::default(), Instant::START);
        for round in 1_usize.. {
            match parts.next_part() {
                LogPart::Entry(taken, _) if taken > to + LINES_BEHIND => break,
                LogPart::Entry(taken, _) if taken > to => {}
                LogPart::Entry(taken, entry) => {
                    at = taken;
                    trimmed.ends = taken;
                    file.entry(taken, &entry).map_err(failed)?;
                }
                LogPart::Event(line) => {
                    let time = time_of(&line);
                    if time <= to {
                        file.event(time, &line).map_err(failed)?;
                    }
                }
                LogPart::Whole => break,
                LogPart::Broken(why) => {
                    trimmed.broken = Some(why);
                    break;
                }
            }
            if round % ROUND == 0 && !tell(at) {
                return Ok(None);
            }
        }
        file.entry(trimmed.ends, &LogEntry::End).map_err(failed)?;
        file.finish().map_err(failed)?;
        Ok(Some(trimmed))
    }
}

/// The name of the file while it is incomplete.
fn aside(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".part");
    name.into()
}
