//! Files that the user drops on the window.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};

use eframe::egui::{Context, DroppedFileHandle};

use crate::platform::Arrival;

/// Takes in files that the user drops on the window.
pub(crate) struct FileInbox {
    sent: Sender<PathBuf>,
    come: Receiver<PathBuf>,
}

impl FileInbox {
    /// Whether [`FileInbox::choose`] shows the files of this computer; without that, the window asks for a path.
    pub(crate) const CHOOSES: bool = false;

    /// An empty inbox.
    pub(crate) fn new() -> Self {
        let (sent, come) = channel();
        Self { sent, come }
    }

    /// Takes in a file that was dropped on the window.
    pub(crate) fn take_dropped(&self, file: &DroppedFileHandle) {
        // The inbox has both ends.
        let _ = self.sent.send(file.path().to_path_buf());
    }

    /// Does nothing.
    pub(crate) fn choose(&self) {}

    /// The next arrival.
    pub(crate) fn next(&self, _ctx: &Context) -> Option<Arrival> {
        self.come.try_recv().ok().map(Arrival::Layout)
    }
}

/// Whether [`give`] gives the user files that the browser keeps.
pub(crate) const GIVES: bool = false;

/// Does nothing: the user has the files.
pub(crate) fn give(_name: &str, _text: &str) -> Result<(), String> {
    Ok(())
}

/// Does nothing: what is saved is in its own file.
pub(crate) fn note_saved(_path: &Path, _text: &str) {}
