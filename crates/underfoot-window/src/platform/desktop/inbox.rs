//! Files that the user drops on the window.

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};

use eframe::egui::{Context, DroppedFileHandle};

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
    pub(crate) fn take_dropped(&self, file: &DroppedFileHandle, _ctx: &Context) {
        // The inbox has both ends.
        let _ = self.sent.send(file.path().to_path_buf());
    }

    /// Does nothing.
    pub(crate) fn choose(&self, _ctx: &Context) {}

    /// The next file, or the reason why it did not come.
    pub(crate) fn next(&self) -> Option<Result<PathBuf, String>> {
        self.come.try_recv().ok().map(Ok)
    }
}

/// Whether [`give`] gives the user files that the browser keeps.
pub(crate) const GIVES: bool = false;

/// Does nothing: the user has the files.
pub(crate) fn give(_name: &str, _text: &str) -> Result<(), String> {
    Ok(())
}
