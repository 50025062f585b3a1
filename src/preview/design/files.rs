//! The file that is designed: opened, saved, changed by others, kept as a draft.

use std::borrow::Cow;
use std::path::Path;
use std::sync::Arc;

use super::{Ask, Asking, Designer, shelf};
use crate::edit::{Document, LayoutFile, Saving, Template};
use crate::floor::Floor;

/// How long a draft may be behind, in seconds.
const DRAFT_S: f64 = 2.0;

impl Designer {
    pub(super) fn save(&mut self) {
        let Some(path) = self.file.path().map(Path::to_path_buf) else {
            return self.ask_for(Ask::SaveAs);
        };
        let text = self.document.file_text();
        match self.file.save(&text) {
            Ok(Saving::Saved) => self.say(format!("Saved in {}", path.display())),
            Ok(other) => {
                if self.take_in(other) {
                    self.save();
                }
            }
            Err(error) => self.complain(error.to_string()),
        }
    }

    /// Takes in what another program has written; whether that was merged.
    pub(super) fn take_in(&mut self, saving: Saving) -> bool {
        match saving {
            Saving::Saved => false,
            Saving::Merged(text) => match self.document.write(&text, None) {
                Ok(()) => {
                    self.say(format!("{} was changed outside: both changes are here", self.file.name()));
                    true
                }
                Err(_) => {
                    let theirs = self.file.outside().ok().flatten().unwrap_or(text);
                    self.conflict = Some((theirs, Vec::new()));
                    false
                }
            },
            Saving::Conflict { theirs, records } => {
                self.conflict = Some((theirs, records));
                false
            }
        }
    }

    /// Takes in what other programs have saved: the file, and what its kinds and effects say now.
    ///
    /// # Errors
    /// What can't be read, as the program would print it; everything is as it was then.
    pub(super) fn reload(&mut self) -> Result<(), String> {
        let kinds = (self.kinds_of)(self.file.path()).map_err(|problems| problems.to_string())?;
        self.document.make_of(&kinds).map_err(|problems| problems.to_string())?;
        let Some(theirs) = self.file.outside().map_err(|error| error.to_string())? else { return Ok(()) };
        // Only what can be read can be merged with the edits made here.
        let document = &self.document;
        Document::read(document.name(), &theirs, document.kinds(), document.floor())
            .map_err(|problems| problems.to_string())?;
        let (mine, known) = (self.document.file_text(), self.file.known().to_owned());
        match self.file.take_in(&mine, theirs) {
            Saving::Merged(text) => {
                self.document.write(&text, None).map_err(|problems| {
                    // It counts as new until it can be read.
                    self.file.know(known.clone());
                    problems.to_string()
                })?;
                if mine != known {
                    self.say(format!("{} was changed outside: both changes are here", self.file.name()));
                }
                self.conflict = None;
            }
            Saving::Conflict { theirs, records } => self.conflict = Some((theirs, records)),
            Saving::Saved => {}
        }
        Ok(())
    }

    /// Looks after the draft.
    pub(super) fn keep(&mut self, now_s: f64) {
        if now_s - self.drafted_s >= DRAFT_S && self.left_over.is_none() {
            self.drafted_s = now_s;
            let text = self.document.file_text();
            if let Err(error) = self.file.keep_draft(&text) {
                self.complain(format!("no draft is kept: {error}"));
            }
        }
    }

    /// Opens a file; whether that could be done.
    pub(super) fn open(&mut self, path: &Path) -> bool {
        match LayoutFile::open(path) {
            Ok((file, text)) => {
                let is_open = self.begin(&path.display().to_string(), &text, file, None);
                if is_open {
                    shelf::note_recent(&self.state, path);
                }
                is_open
            }
            Err(error) => {
                self.complain(format!("{} can't be opened: {error}", path.display()));
                false
            }
        }
    }

    /// Begins with a text that has no file yet.
    pub(super) fn begin_untitled(&mut self, name: &str, text: &str) -> bool {
        let (file, slot) = untitled(&self.state, text, false);
        self.begin(name, text, file, slot)
    }

    /// Begins with another text: a template, a file; whether it can be read.
    pub(super) fn begin(
        &mut self,
        name: &str,
        text: &str,
        file: LayoutFile,
        slot: Option<shelf::Slot>,
    ) -> bool {
        let floor = Arc::clone(self.document.floor());
        let read = (self.kinds_of)(file.path());
        match read.and_then(|kinds| Document::read(name, &begun(text, &floor), &kinds, &floor)) {
            Ok(document) => {
                self.message = None;
                if !self.is_saved() && self.left_over.is_none() {
                    match self.file.keep_draft(&self.document.file_text()) {
                        Ok(()) => self.say(format!(
                            "{} was not saved: its draft is kept and will be offered again",
                            self.file.name()
                        )),
                        Err(error) => {
                            self.complain(format!("{} is not saved, and {error}", self.file.name()));
                            return false;
                        }
                    }
                }
                let revision = self.document.revision() + 1;
                self.document = document;
                self.document.begin_at(revision);
                self.left_over = file.left_over().ok().flatten();
                (self.file, self.slot, self.seen, self.conflict) = (file, slot, None, None);
                self.selected.clear();
                self.locked.clear();
                self.hidden.clear();
                true
            }
            Err(problems) => {
                self.complain(problems.to_string());
                false
            }
        }
    }

    pub(super) fn ask_for(&mut self, to: Ask) {
        let path = self.file.path().map(|path| path.display().to_string());
        self.asking = Some(Asking { to, path: path.unwrap_or_else(|| self.file.name()) });
    }
}

/// A layout without a file, and where its draft is kept; with `left_over`, one that an earlier window has left.
pub(super) fn untitled(state: &Path, text: &str, left_over: bool) -> (LayoutFile, Option<shelf::Slot>) {
    let file = |slot: &shelf::Slot| LayoutFile::untitled(&slot.folder, text);
    let has_draft = |slot: &shelf::Slot| file(slot).draft_path().exists();
    let mut older = left_over.then(|| shelf::slots(state)).into_iter().flatten();
    let slot = older
        .find(|slot| file(slot).left_over().ok().flatten().is_some())
        .or_else(|| shelf::slots(state).find(|slot| !has_draft(slot)));
    // Without such a folder keeping a draft fails, and says so.
    let folder = slot.as_ref().map_or_else(|| state.join("untitled"), |slot| slot.folder.clone());
    (LayoutFile::untitled(&folder, text), slot)
}

/// What is designed in a file that says this: an empty one begins with an empty floor.
pub(super) fn begun<'t>(text: &'t str, floor: &Floor) -> Cow<'t, str> {
    if text.trim().is_empty() { Template::Empty.text(&floor.geometry).into() } else { text.into() }
}
