//! The file of the layout: opening, saving, changes by other programs, and drafts.

use std::io;
use std::path::Path;
use std::sync::Arc;

use super::{Ask, Asking, Designer, shelf};
use crate::edit::{Document, LayoutFile, Saving, Template};
use crate::platform::{self, FileInbox};
use underfoot::floor::Floor;

/// The mark before the name of an unsaved layout.
const UNSAVED: &str = "•";

/// Interval between drafts, in seconds.
const DRAFT_S: f64 = 2.0;

impl Designer {
    /// Saves, or asks for a path.
    pub(in crate::preview) fn save(&mut self) {
        let Some(path) = self.storage.file.path().map(Path::to_path_buf) else {
            return self.ask_for(Ask::SaveAs);
        };
        let text = self.edited.document.file_text();
        match self.storage.file.save(&text) {
            Ok(Saving::Saved) => {
                self.edited.say(format!("Saved in {}", path.display()));
                platform::note_saved(&path, &text);
            }
            Ok(other) => {
                if self.take_in(other) {
                    self.save();
                }
            }
            Err(error) => self.edited.complain(error.to_string()),
        }
    }

    /// Takes over the text of another program; returns whether it was merged.
    pub(super) fn take_in(&mut self, saving: Saving) -> bool {
        match saving {
            Saving::Saved => false,
            Saving::Merged(text) => match self.edited.document.write(&text, None) {
                Ok(()) => {
                    self.edited.say(format!(
                        "{} was changed outside: both changes are here",
                        self.storage.file.name()
                    ));
                    true
                }
                Err(_) => {
                    let theirs = self.storage.file.outside().ok().flatten().unwrap_or(text);
                    self.storage.conflict = Some((theirs, Vec::new()));
                    false
                }
            },
            Saving::Conflict { theirs, records } => {
                self.storage.conflict = Some((theirs, records));
                false
            }
        }
    }

    /// Reads the changes that other programs have saved: the file, and the current text of its kinds and effects.
    ///
    /// # Errors
    /// Returns the problems of a file that cannot be read, in the program's output format; the layout is unchanged
    /// then.
    pub(super) fn reload(&mut self) -> Result<(), String> {
        let kinds =
            (self.storage.kinds_of)(self.storage.file.path()).map_err(|problems| problems.to_string())?;
        self.edited.document.make_of(&kinds).map_err(|problems| problems.to_string())?;
        let Some(theirs) = self.storage.file.outside().map_err(|error| error.to_string())? else {
            return Ok(());
        };
        // Only a readable text can be merged with the edits made here.
        let document = &self.edited.document;
        Document::read(document.name(), &theirs, document.kinds(), document.floor())
            .map_err(|problems| problems.to_string())?;
        let (mine, known) = (self.edited.document.file_text(), self.storage.file.known().to_owned());
        match self.storage.file.take_in(&mine, theirs) {
            Saving::Merged(text) => {
                self.edited.document.write(&text, None).map_err(|problems| {
                    // The change stays new until it can be read.
                    self.storage.file.know(known.clone());
                    problems.to_string()
                })?;
                if mine != known {
                    self.edited.say(format!(
                        "{} was changed outside: both changes are here",
                        self.storage.file.name()
                    ));
                }
                self.storage.conflict = None;
            }
            Saving::Conflict { theirs, records } => self.storage.conflict = Some((theirs, records)),
            Saving::Saved => {}
        }
        Ok(())
    }

    /// Saves a draft at the interval of `DRAFT_S`.
    pub(super) fn keep(&mut self, now_s: f64) {
        if now_s - self.storage.drafted_s >= DRAFT_S && self.storage.left_over.is_none() {
            self.storage.drafted_s = now_s;
            let text = self.edited.document.file_text();
            if let Err(error) = self.storage.file.keep_draft(&text) {
                self.edited.complain(format!("no draft is kept: {error}"));
            }
        }
    }

    /// Saves a draft of what is not saved, before the window shows another floor.
    pub(in crate::preview) fn keep_now(&mut self) {
        if !self.is_saved() {
            self.storage.drafted_s = f64::NEG_INFINITY;
            self.keep(0.0);
        }
    }

    /// Opens a file; returns whether that succeeded.
    pub(super) fn open(&mut self, path: &Path) -> bool {
        match opened(path, self.edited.document.floor(), false) {
            Ok((file, text)) => {
                let is_open = self.begin(&path.display().to_string(), &text, file, None);
                if is_open {
                    shelf::note_recent(&self.storage.state, path);
                }
                is_open
            }
            Err(error) => {
                self.edited.complain(format!("{} can't be opened: {error}", path.display()));
                false
            }
        }
    }

    /// Starts with a text that has no file yet.
    pub(super) fn begin_untitled(&mut self, name: &str, text: &str) -> bool {
        let (file, slot) = untitled(&self.storage.state, text, false);
        self.begin(name, text, file, slot)
    }

    /// Starts with another text, from a template or a file; returns whether it can be read.
    pub(super) fn begin(
        &mut self,
        name: &str,
        text: &str,
        file: LayoutFile,
        slot: Option<shelf::Slot>,
    ) -> bool {
        let floor = Arc::clone(self.edited.document.floor());
        let read = (self.storage.kinds_of)(file.path());
        match read.and_then(|kinds| Document::read(name, text, &kinds, &floor)) {
            Ok(document) => {
                self.edited.message = None;
                let mut kept = None;
                if !self.is_saved() && self.storage.left_over.is_none() {
                    match self.storage.file.keep_draft(&self.edited.document.file_text()) {
                        Ok(()) => {
                            let name = self.storage.file.name();
                            kept = Some(format!(
                                "{name} was not saved: its draft is kept and will be offered again"
                            ));
                        }
                        Err(error) => {
                            self.edited
                                .complain(format!("{} is not saved, and {error}", self.storage.file.name()));
                            return false;
                        }
                    }
                }
                let revision = self.edited.document.revision() + 1;
                self.edited.document = document;
                self.edited.document.begin_at(revision);
                if let Some(kept) = kept {
                    self.edited.say(kept);
                }
                self.storage.left_over = file.left_over().ok().flatten();
                (self.storage.file, self.storage.slot, self.edited.seen, self.storage.conflict) =
                    (file, slot, None, None);
                self.edited.selected.clear();
                self.edited.steps.clear();
                self.edited.locked.clear();
                self.edited.hidden.clear();
                true
            }
            Err(problems) => {
                self.edited.complain(problems.to_string());
                false
            }
        }
    }

    /// Lets the user choose a file to open: in the dialogue of a browser, or by its path.
    pub(super) fn ask_to_open(&mut self) {
        if FileInbox::CHOOSES { self.storage.inbox.choose() } else { self.ask_for(Ask::Open) }
    }

    pub(super) fn ask_for(&mut self, to: Ask) {
        let path = self.storage.file.path().map(|path| path.display().to_string());
        self.storage.asking = Some(Asking { to, path: path.unwrap_or_else(|| self.storage.file.name()) });
    }

    /// The layout's name for titles, behind a dot while the file lacks edits.
    pub(in crate::preview) fn title(&self) -> String {
        let name = self.name();
        if self.is_saved() { name } else { format!("{UNSAVED} {name}") }
    }

    /// Whether a question to the user blocks saving.
    pub(in crate::preview) fn is_asking(&self) -> bool {
        self.storage.asking.is_some() || self.storage.conflict.is_some()
    }

    /// Discards unsaved edits; a draft of an earlier window that waits for a decision stays.
    pub(in crate::preview) fn discard(&mut self) {
        if self.storage.left_over.is_none() {
            self.storage.file.drop_draft();
        }
    }
}

/// A layout without a file and the slot for its draft; with `left_over`, a slot with the draft of an earlier window.
pub(super) fn untitled(state: &Path, text: &str, left_over: bool) -> (LayoutFile, Option<shelf::Slot>) {
    let file = |slot: &shelf::Slot| LayoutFile::untitled(&slot.folder, text);
    let has_draft = |slot: &shelf::Slot| platform::is_file(&file(slot).draft_path());
    let older = left_over.then(|| shelf::left_slots(state)).into_iter().flatten();
    // Collect all of them: this removes the empty ones.
    let mut older: Vec<shelf::Slot> = older.filter(has_draft).collect();
    let at = older.iter().position(|slot| file(slot).left_over().ok().flatten().is_some());
    let slot = at.map(|at| older.swap_remove(at));
    let slot = slot.or_else(|| shelf::slots(state).find(|slot| !has_draft(slot)));
    // Without such a folder, saving a draft fails with a message.
    let folder = slot.as_ref().map_or_else(|| state.join("untitled"), |slot| slot.folder.clone());
    (LayoutFile::untitled(&folder, text), slot)
}

/// Opens the layout at `path`; an empty file starts with an empty floor, and with `begins` so does a missing one.
pub(super) fn opened(path: &Path, floor: &Floor, begins: bool) -> io::Result<(LayoutFile, String)> {
    let read = LayoutFile::open(path);
    let begins = match &read {
        Ok((_, text)) => text.trim().is_empty(),
        Err(error) => begins && error.kind() == io::ErrorKind::NotFound,
    };
    if begins {
        let text = Template::Empty.text(&floor.geometry);
        return Ok((LayoutFile::begun(path, &text), text));
    }
    read
}
