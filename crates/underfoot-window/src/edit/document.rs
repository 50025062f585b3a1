//! A layout that is being edited.

use std::ops::Range;
use std::sync::Arc;

use super::address::{Address, RecordList, list_of};
use super::change::{Edit, is_record};
use super::history::UndoHistory;
use super::refusal::EditRefusal;
use super::splice::RecordText;
use underfoot::floor::Floor;
use underfoot::layout::Layout;
use underfoot::schema::{Diagnostics, Kinds, Loaded, parse_layout};
use underfoot_format::outline::Outline;
use underfoot_scene::ergonomics::{self, Finding};

/// The byte-order mark, with which a file may begin; it is not part of the text.
const MARK: &str = "\u{feff}";

/// A layout that is being edited: its text, which is authoritative, and the result of reading it.
///
/// Each edit changes only the necessary bytes, and the text is then parsed like a file: the layout always equals the
/// content of the file. An edit with an invalid result is refused.
#[derive(Clone, Debug)]
pub struct Document {
    name: String,
    /// Whether the file begins with a byte-order mark.
    marked: bool,
    text: Arc<str>,
    loaded: Arc<Loaded>,
    root: Arc<Outline>,
    history: UndoHistory,
    kinds: Arc<Kinds>,
    floor: Arc<Floor>,
    /// The number of texts so far.
    revision: u64,
}

impl Document {
    /// Reads the layout in `file`, made of `kinds` and placed on `floor`; `name` is its name in messages.
    ///
    /// # Errors
    /// All problems of the text.
    pub fn read(name: &str, file: &str, kinds: &Arc<Kinds>, floor: &Arc<Floor>) -> Result<Self, Diagnostics> {
        let bare = file.strip_prefix(MARK).unwrap_or(file);
        let (loaded, root) = read(name, bare, kinds, floor)?;
        Ok(Self {
            name: name.into(),
            marked: bare.len() < file.len(),
            text: bare.into(),
            loaded: Arc::new(loaded),
            root: Arc::new(root),
            history: UndoHistory::default(),
            kinds: Arc::clone(kinds),
            floor: Arc::clone(floor),
            revision: 0,
        })
    }

    /// Its name in messages.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Changes its name in messages to `name`.
    pub fn rename(&mut self, name: &str) {
        name.clone_into(&mut self.name);
    }

    /// Its text, without a byte-order mark; all offsets count from its start.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether its file must hold exactly `text`.
    #[must_use]
    pub fn is_written_as(&self, text: &str) -> bool {
        match text.strip_prefix(MARK) {
            Some(bare) => self.marked && *bare == *self.text,
            None => !self.marked && *text == *self.text,
        }
    }

    /// The content for its file: the text, behind a byte-order mark if it had one.
    #[must_use]
    pub fn file_text(&self) -> String {
        if self.marked { format!("{MARK}{}", self.text) } else { self.text.to_string() }
    }

    /// The layout in the text.
    #[must_use]
    pub fn layout(&self) -> &Layout {
        &self.loaded.layout
    }

    /// The warnings of the reader.
    #[must_use]
    pub fn warnings(&self) -> &Diagnostics {
        &self.loaded.warnings
    }

    /// The problems of the layout that affect feet or eyes.
    #[must_use]
    pub fn findings(&self) -> Vec<Finding> {
        ergonomics::review(self.layout(), &self.floor)
    }

    /// All warnings of `underfoot check`, with their places.
    #[must_use]
    pub fn review(&self) -> Diagnostics {
        let mut all = self.warnings().clone();
        all.merge(underfoot_scene::ergonomics::locate(&self.loaded.places, &self.findings()));
        all
    }

    /// A warning for each text with letters that cannot be drawn; `missing` returns those letters.
    #[must_use]
    pub fn undrawn(&self, missing: impl FnMut(&str) -> Vec<char>) -> Diagnostics {
        self.loaded.places.undrawn(missing)
    }

    /// The kinds of which its controls can be made.
    #[must_use]
    pub fn kinds(&self) -> &Arc<Kinds> {
        &self.kinds
    }

    /// Replaces the kinds of its controls; returns whether the new ones differ.
    ///
    /// # Errors
    /// The problems of the layout with the new kinds; nothing changes then.
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

    /// A counter that increases with every change of the text, undo included.
    #[must_use]
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Sets the counter to `revision`, so that no revision of another document equals one of this document.
    pub fn begin_at(&mut self, revision: u64) {
        self.revision = revision;
    }

    pub(super) fn root(&self) -> &Outline {
        &self.root
    }

    pub(super) fn loaded(&self) -> &Loaded {
        &self.loaded
    }

    /// Applies `edits` as one undo step.
    ///
    /// # Errors
    /// [`EditRefusal`]; nothing changes then.
    pub fn edit(&mut self, edits: &[Edit]) -> Result<(), EditRefusal> {
        self.edit_in(edits, None)
    }

    /// Applies `edits`; consecutive edits with the same `stroke`, such as those of a drag, are one undo step.
    ///
    /// # Errors
    /// [`EditRefusal`]; nothing changes then.
    pub fn edit_in(&mut self, edits: &[Edit], stroke: Option<u64>) -> Result<(), EditRefusal> {
        let text = self.edited(edits)?;
        self.take(text, stroke).map_err(EditRefusal::Unreadable)
    }

    /// Replaces the text by `text`; consecutive changes with the same `stroke` are one undo step.
    ///
    /// # Errors
    /// All problems of the text; nothing changes then.
    pub fn write(&mut self, text: &str, stroke: Option<u64>) -> Result<(), Diagnostics> {
        self.take(text.strip_prefix(MARK).unwrap_or(text).to_owned(), stroke)
    }

    /// The layout that `edits` would produce.
    ///
    /// # Errors
    /// [`EditRefusal`], as [`Document::edit`].
    pub fn trial(&self, edits: &[Edit]) -> Result<Layout, EditRefusal> {
        let text = self.edited(edits)?;
        let read = parse_layout(&text, &self.name, &self.kinds, &self.floor.geometry);
        read.map(|loaded| loaded.layout).map_err(EditRefusal::Unreadable)
    }

    fn edited(&self, edits: &[Edit]) -> Result<String, EditRefusal> {
        let mut text = self.text.to_string();
        let mut root: Option<Outline> = None;
        for edit in edits {
            if let Edit::Insert { text, .. } = edit
                && !RecordText::parse(text)
                    .is_some_and(|piece| Outline::parse(&piece.text).as_ref().is_some_and(is_record))
            {
                return Err(EditRefusal::NotARecord);
            }
            text = edit.done(&text, root.as_ref().unwrap_or(&self.root))?;
            match Outline::parse(&text) {
                Some(outline) => root = Some(outline),
                // The reader reports the reason.
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

    /// The number of steps that [`Document::undo`] can undo now.
    #[must_use]
    pub fn step(&self) -> usize {
        self.history.done()
    }

    /// Whether there is a step to undo.
    #[must_use]
    pub fn can_undo(&self) -> bool {
        self.history.last().is_some()
    }

    /// Whether there is a step to redo.
    #[must_use]
    pub fn can_redo(&self) -> bool {
        self.history.next().is_some()
    }

    /// Undoes the last step; returns whether there was one.
    ///
    /// # Errors
    /// The problems of the older text, which are only possible after a change of kinds; nothing changes then.
    pub fn undo(&mut self) -> Result<bool, Diagnostics> {
        let Some(text) = self.history.last().map(|step| step.undone(&self.text)) else { return Ok(false) };
        let read = read(&self.name, &text, &self.kinds, &self.floor)?;
        self.history.go_back();
        self.show(text, read);
        Ok(true)
    }

    /// Redoes the last undone step; returns whether there was one.
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

    /// The number of records in the list of `parent`.
    #[must_use]
    pub fn count(&self, parent: &Address, list: RecordList) -> usize {
        parent.find(&self.root).and_then(|parent| list_of(parent, list)).map_or(0, |list| list.elements.len())
    }

    /// The bytes of a record; `None` if there is no such record.
    #[must_use]
    pub fn span(&self, record: &Address) -> Option<Range<usize>> {
        Some(record.find(&self.root)?.span.clone())
    }

    /// The written value of a field, with a dotted name for a field within a field, such as `look.face`; `None` if
    /// absent.
    #[must_use]
    pub fn written(&self, record: &Address, field: &str) -> Option<&str> {
        let record = record.find(&self.root)?;
        let value = field.split('.').try_fold(record, |record, name| Some(&record.field(name)?.value))?;
        self.text.get(value.span.clone())
    }
}

fn read(name: &str, text: &str, kinds: &Kinds, floor: &Floor) -> Result<(Loaded, Outline), Diagnostics> {
    let loaded = parse_layout(text, name, kinds, &floor.geometry)?;
    // A text that the reader accepts has an outline; otherwise its records could not be edited.
    let root = Outline::parse(text).or_else(|| Outline::parse("()"));
    root.map(|root| (loaded, root)).ok_or_else(Diagnostics::default)
}
