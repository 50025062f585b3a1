//! A visit to the floor, recorded while the window shows it, and exported.

mod bar;
#[cfg(test)]
mod tests;

use std::path::PathBuf;

use underfoot::engine::Snapshot;

pub(super) use bar::{VisitAction, VisitBar};

use crate::link::SharedVisit;

/// Records the floor on display, and exports the recording; the work is done on other threads.
pub trait VisitDesk {
    /// The present state; called for each frame.
    fn state(&mut self) -> VisitState;

    /// Sends a command; the state shows its effect.
    fn lead(&mut self, order: VisitOrder);

    /// The feet of [`VisitState::kept`] for a link; `None` if the floor is not simulated here, a sentence if they do not
    /// fit into one.
    fn shared(&self) -> Option<Result<SharedVisit, String>> {
        None
    }
}

/// The state of recording and exporting.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VisitState {
    /// The recording in progress.
    pub recording: Option<VisitSize>,
    /// The recording that can be saved, played and exported: the last one, or the one on display.
    pub kept: Option<VisitSize>,
    /// Whether [`Self::kept`] is lost with the window unless it is saved.
    pub is_unsaved: bool,
    /// Whether recordings are feet for links, and no files: the bar then only shares and plays them.
    pub is_for_links: bool,
    /// Why the floor cannot be recorded; `None` if it can.
    pub off: Option<String>,
    /// The export in progress.
    pub work: Option<VisitWork>,
    /// The result of the last command, for the user.
    pub told: Option<String>,
}

/// The size of a recording.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VisitSize {
    /// Its length, in seconds; 0 if it is unknown.
    pub length_s: f64,
    /// Bytes of its file so far.
    pub bytes: u64,
}

/// An export in progress.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VisitWork {
    /// Name of the file or folder.
    pub name: String,
    /// The share that is done, from 0 to 1.
    pub share: f64,
}

/// The form of an export.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum VisitForm {
    /// An animated picture, GIF.
    #[default]
    Picture,
    /// A recording, MCAP.
    Recording,
    /// A folder of tables, CSV.
    Tables,
}

/// A command of the user.
#[derive(Clone, Debug)]
pub enum VisitOrder {
    /// Begin a recording of the floor, whose state this is.
    Begin(Box<Snapshot>),
    /// End it.
    End,
    /// Save the last recording in this file.
    Save(PathBuf),
    /// Play the last recording in a window of its own.
    PlayAgain,
    /// Delete the last recording.
    Discard,
    /// Export a part of the recording, or all of it, into this file or folder.
    Export {
        /// The form.
        form: VisitForm,
        /// The file or folder.
        to: PathBuf,
        /// From and to, in seconds of the time line.
        part: Option<(f64, f64)>,
    },
    /// Stop the export in progress.
    StopExport,
}
