//! A layout that is being edited.

use std::ops::Range;
use std::sync::Arc;

use super::address::{Address, List, list_of};
use super::change::{Edit, is_record};
use super::history::History;
use super::refusal::Refusal;
use super::splice::Piece;
use crate::ergonomics::{self, Finding};
use crate::floor::Floor;
use crate::format::outline::Outline;
use crate::layout::Layout;
use crate::schema::{Diagnostics, Kinds, Loaded, parse_layout};

/// What a file may begin with that is not part of its text.
const MARK: &str = "\u{feff}";

/// A layout that is being edited: its text, which alone counts, and what the reader makes of it.
///
/// Each edit changes the text where it must and is read again as a file is: the layout is always what the file would
/// say. An edit after which the layout could not be used is refused.
#[derive(Clone, Debug)]
pub struct Document {
    name: String,
    /// Whether the file begins with a byte-order mark.
    marked: bool,
    text: Arc<str>,
    loaded: Arc<Loaded>,
    root: Arc<Outline>,
    history: History,
    kinds: Arc<Kinds>,
    floor: Arc<Floor>,
    /// Counts the texts that it has had.
    revision: u64,
}

impl Document {
    /// The layout that `file` describes, made of `kinds` and placed on `floor`; `name` is what messages call it.
    ///
    /// # Errors
    /// Everything wrong with the text.
    pub fn read(name: &str, file: &str, kinds: &Arc<Kinds>, floor: &Arc<Floor>) -> Result<Self, Diagnostics> {
        let bare = file.strip_prefix(MARK).unwrap_or(file);
        let (loaded, root) = read(name, bare, kinds, floor)?;
        Ok(Self {
            name: name.into(),
            marked: bare.len() < file.len(),
            text: bare.into(),
            loaded: Arc::new(loaded),
            root: Arc::new(root),
            history: History::default(),
            kinds: Arc::clone(kinds),
            floor: Arc::clone(floor),
            revision: 0,
        })
    }

    /// What messages call it.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Calls it `name` from now on.
    pub fn rename(&mut self, name: &str) {
        name.clone_into(&mut self.name);
    }

    /// Its text, without a byte-order mark; all places count from its start.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether its file is to hold exactly `text`.
    #[must_use]
    pub fn is_written_as(&self, text: &str) -> bool {
        match text.strip_prefix(MARK) {
            Some(bare) => self.marked && *bare == *self.text,
            None => !self.marked && *text == *self.text,
        }
    }

    /// What its file is to hold: the text, behind a byte-order mark if it had one.
    #[must_use]
    pub fn file_text(&self) -> String {
        if self.marked { format!("{MARK}{}", self.text) } else { self.text.to_string() }
    }

    /// The layout it describes.
    #[must_use]
    pub fn layout(&self) -> &Layout {
        &self.loaded.layout
    }

    /// What the reader finds odd about it.
    #[must_use]
    pub fn warnings(&self) -> &Diagnostics {
        &self.loaded.warnings
    }

    /// What feet or eyes will have trouble with.
    #[must_use]
    pub fn findings(&self) -> Vec<Finding> {
        ergonomics::review(self.layout(), &self.floor)
    }

    /// Everything that `underfoot check` would warn of, with its places.
    #[must_use]
    pub fn review(&self) -> Diagnostics {
        let mut all = self.warnings().clone();
        all.merge(self.loaded.places.locate(&self.findings()));
        all
    }

    /// A warning for each text of which some letters can't be drawn; `missing` tells which those are.
    #[must_use]
    pub fn undrawn(&self, missing: impl FnMut(&str) -> Vec<char>) -> Diagnostics {
        self.loaded.places.undrawn(missing)
    }

    /// The kinds that its controls can be made of.
    #[must_use]
    pub fn kinds(&self) -> &Arc<Kinds> {
        &self.kinds
    }

    /// Makes its controls of other kinds from now on; whether they differ.
    ///
    /// # Errors
    /// What is wrong with the layout when it is made of them; nothing is changed then.
    pub fn make_of(&mut self, kinds: &Arc<Kinds>) -> Result<bool, Diagnostics> {
        if *self.kinds == **kinds {
            return Ok(false);
        }
        let read = read(&self.name, &self.text, kinds, &self.floor)?;
        self.kinds = Arc::clone(kinds);
        self.show(self.text.to_string(), read);
        Ok(true)
    }

    /// The floor it is placed on.
    #[must_use]
    pub fn floor(&self) -> &Arc<Floor> {
        &self.floor
    }

    /// Grows with every change of the text, also one that is taken back.
    #[must_use]
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Counts from `revision` on: what belonged to another document's texts is not taken for this one's.
    pub fn begin_at(&mut self, revision: u64) {
        self.revision = revision;
    }

    pub(super) fn root(&self) -> &Outline {
        &self.root
    }

    pub(super) fn loaded(&self) -> &Loaded {
        &self.loaded
    }

    /// Does `edits`, as one step.
    ///
    /// # Errors
    /// [`Refusal`]; nothing is changed then.
    pub fn edit(&mut self, edits: &[Edit]) -> Result<(), Refusal> {
        self.edit_in(edits, None)
    }

    /// Does `edits`, as one step with all others that have the same `stroke` and follow each other: a drag.
    ///
    /// # Errors
    /// [`Refusal`]; nothing is changed then.
    pub fn edit_in(&mut self, edits: &[Edit], stroke: Option<u64>) -> Result<(), Refusal> {
        let text = self.edited(edits)?;
        self.take(text, stroke).map_err(Refusal::Unreadable)
    }

    /// Takes `text` in place of its own, as one step with the others of the same `stroke`.
    ///
    /// # Errors
    /// Everything wrong with the text; nothing is changed then.
    pub fn write(&mut self, text: &str, stroke: Option<u64>) -> Result<(), Diagnostics> {
        self.take(text.strip_prefix(MARK).unwrap_or(text).to_owned(), stroke)
    }

    /// What would come of `edits`.
    ///
    /// # Errors
    /// [`Refusal`], as [`Document::edit`].
    pub fn trial(&self, edits: &[Edit]) -> Result<Layout, Refusal> {
        let text = self.edited(edits)?;
        let read = parse_layout(&text, &self.name, &self.kinds, &self.floor.geometry);
        read.map(|loaded| loaded.layout).map_err(Refusal::Unreadable)
    }

    fn edited(&self, edits: &[Edit]) -> Result<String, Refusal> {
        let mut text = self.text.to_string();
        let mut root: Option<Outline> = None;
        for edit in edits {
            if let Edit::Insert { text, .. } = edit
                && !Piece::parse(text)
                    .is_some_and(|piece| Outline::parse(&piece.text).as_ref().is_some_and(is_record))
            {
                return Err(Refusal::NotARecord);
            }
            text = edit.done(&text, root.as_ref().unwrap_or(&self.root))?;
            match Outline::parse(&text) {
                Some(outline) => root = Some(outline),
                // The reader says why.
                None => break,
            }
        }
        Ok(text)
    }

    fn take(&mut self, text: String, stroke: Option<u64>) -> Result<(), Diagnostics> {
        if *text == *self.text {
            return Ok(());
        }
        let read = read(&self.name, &text, &self.kinds, &self.floor)?;
        self.history.note(&self.text, &text, stroke);
        self.show(text, read);
        Ok(())
    }

    fn show(&mut self, text: String, (loaded, root): (Loaded, Outline)) {
        (self.text, self.loaded, self.root) = (text.into(), Arc::new(loaded), Arc::new(root));
        self.revision += 1;
    }

    /// Whether there is a step to take back.
    #[must_use]
    pub fn can_undo(&self) -> bool {
        self.history.last().is_some()
    }

    /// Whether there is a step to do again.
    #[must_use]
    pub fn can_redo(&self) -> bool {
        self.history.next().is_some()
    }

    /// Takes the last step back; whether there was one.
    ///
    /// # Errors
    /// What is wrong with the older text, which can only be if kinds changed; nothing is changed then.
    pub fn undo(&mut self) -> Result<bool, Diagnostics> {
        let Some(text) = self.history.last().map(|step| step.undone(&self.text)) else { return Ok(false) };
        let read = read(&self.name, &text, &self.kinds, &self.floor)?;
        self.history.go_back();
        self.show(text, read);
        Ok(true)
    }

    /// Does the step again that was taken back last; whether there was one.
    ///
    /// # Errors
    /// As [`Document::undo`].
    pub fn redo(&mut self) -> Result<bool, Diagnostics> {
        let Some(text) = self.history.next().map(|step| step.redone(&self.text)) else { return Ok(false) };
        let read = read(&self.name, &text, &self.kinds, &self.floor)?;
        self.history.go_on();
        self.show(text, read);
        Ok(true)
    }

    /// How many records the list of `parent` has.
    #[must_use]
    pub fn count(&self, parent: &Address, list: List) -> usize {
        parent.find(&self.root).and_then(|parent| list_of(parent, list)).map_or(0, |list| list.elements.len())
    }

    /// Where the record is written; `None` if there is none.
    #[must_use]
    pub fn span(&self, record: &Address) -> Option<Range<usize>> {
        Some(record.find(&self.root)?.span.clone())
    }

    /// What is written for a field of a record, that of a field within a field as `look.face`; `None` if nothing is.
    #[must_use]
    pub fn written(&self, record: &Address, field: &str) -> Option<&str> {
        let record = record.find(&self.root)?;
        let value = field.split('.').try_fold(record, |record, name| Some(&record.field(name)?.value))?;
        self.text.get(value.span.clone())
    }
}

fn read(name: &str, text: &str, kinds: &Kinds, floor: &Floor) -> Result<(Loaded, Outline), Diagnostics> {
    let loaded = parse_layout(text, name, kinds, &floor.geometry)?;
    // What the reader could read has an outline; should it not, nothing of it can be edited.
    let root = Outline::parse(text).or_else(|| Outline::parse("()"));
    root.map(|root| (loaded, root)).ok_or_else(Diagnostics::default)
}
