//! Design mode: edits the layout on the screen by mouse, by keyboard and as text.
//!
//! [`crate::edit`] defines the meaning of edits and the bytes that they change; this module holds the display and the
//! input.

mod bar;
mod canvas;
mod changes;
mod fields;
mod files;
mod gestures;
mod inspector;
mod keys;
mod labels;
mod list;
mod marks;
mod modes;
mod palette;
mod saving;
mod shelf;
mod shielded;
#[cfg(test)]
mod tests;
mod text;
mod threshold;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui;

use super::feed::PreviewCommand;
use super::zoom::Zoom;
use crate::edit::{Address, Document, Edit, Item, LayoutFile, Refusal};
use underfoot::floor::Floor;
use underfoot::layout::Layout;
use underfoot::schema::{Diagnostic, Diagnostics, Kinds};
use underfoot_scene::ergonomics::Finding;
use underfoot_scene::letters;
use underfoot_scene::scene::Scene;

pub(super) use threshold::Threshold;
pub use underfoot::schema::usual_state;

/// The initial state of Design mode.
pub struct DesignInput {
    /// The name of the layout in messages.
    pub name: String,
    /// Its text; empty for a new file.
    pub text: String,
    /// Its file, which exists unless it is new; `None` for a layout without a file, such as a built-in one.
    pub path: Option<PathBuf>,
    /// Reads the kinds of which controls can be made.
    pub kinds_of: KindsOf,
    /// The folder for drafts of layouts without a file and for the list of recent files, as [`usual_state`].
    pub state: PathBuf,
}

/// Reads the kinds that the layout in this file can use; for `None`, those of a layout without a file.
pub type KindsOf = Box<dyn Fn(Option<&Path>) -> Result<Arc<Kinds>, Diagnostics>>;

/// The layout that is edited, the selection and the current gesture.
pub(super) struct Designer {
    pub(super) is_open: bool,
    document: Document,
    file: LayoutFile,
    /// The revision to which `items`, `findings` and `text` belong.
    seen: Option<u64>,
    items: Vec<Item>,
    findings: Vec<Finding>,
    /// Letters that the fonts of the window lack, and the revision to which the list belongs.
    undrawn: Diagnostics,
    undrawn_of: Option<u64>,
    selected: Vec<Address>,
    /// The index of the page on display.
    page: usize,
    gesture: gestures::Gesture,
    /// The thing that the next click puts down.
    placing: Option<palette::Thing>,
    view: Zoom,
    scene: Scene,
    stroke: u64,
    /// The last message about an action or a refusal.
    message: Option<Message>,
    text: text::Editor,
    /// The path dialogue, while it is open.
    asking: Option<Asking>,
    /// The text of a draft of an earlier window, until the user restores or discards it.
    left_over: Option<String>,
    /// The text of another program where the file changed both outside and here.
    conflict: Option<(String, Vec<String>)>,
    drafted_s: f64,
    inspector: inspector::Inspector,
    kinds_of: KindsOf,
    state: PathBuf,
    /// The place of the draft while the layout has no file.
    slot: Option<shelf::Slot>,
    /// The file that the program watches for changes.
    watched: Option<PathBuf>,
    /// The records that are locked on the floor, and those that are hidden, by [`Designer::key_of`].
    locked: BTreeSet<String>,
    hidden: BTreeSet<String>,
    seen_to_scale: Scale,
    /// The pane to which F6 led, and the pane that gets the keyboard in this frame.
    pane: Option<Pane>,
    focus: Option<Pane>,
    /// Frames until the file is saved, and until the floor is tried: a field that is being typed is applied first.
    saves_in: u8,
    leaves_in: u8,
    /// The command that waits to be sent to the floor.
    wish: Option<PreviewCommand>,
}

/// The optional marks that are drawn to scale.
#[derive(Clone, Copy, Debug, Default)]
struct Scale {
    shoes: bool,
    reach: bool,
}

/// A pane of the window that F6 can reach.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Pane {
    Things,
    Floor,
    Fields,
    Text,
}

/// A message about an action.
struct Message {
    text: String,
    is_bad: bool,
    /// The revision of the layout to which it refers.
    of: u64,
}

/// A dialogue that asks for a path.
struct Asking {
    to: Ask,
    path: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Ask {
    Open,
    SaveAs,
}

impl Designer {
    /// Returns `None` for a layout that cannot be read, because there is nothing to edit.
    pub(super) fn new(input: DesignInput, floor: &Arc<Floor>) -> Option<Self> {
        let DesignInput { name, text, path, kinds_of, state } = input;
        let kinds = kinds_of(path.as_deref()).ok()?;
        let (file, text, slot) = match &path {
            Some(path) => files::opened(path, floor, text.trim().is_empty())
                .map(|(file, text)| (file, text, None))
                .ok()?,
            None => {
                let (file, slot) = files::untitled(&state, &text, true);
                (file, text, slot)
            }
        };
        let document = Document::read(&name, &text, &kinds, floor).ok()?;
        let left_over = file.left_over().ok().flatten();
        if let Some(path) = path.as_deref().filter(|_| !file.is_new()) {
            shelf::note_recent(&state, path);
        }
        let new = file.is_new().then(|| Message {
            text: format!("{} is new: F2 designs it, Ctrl+S writes it", file.name()),
            is_bad: false,
            of: document.revision(),
        });
        Some(Self {
            is_open: false,
            document,
            file,
            seen: None,
            items: Vec::new(),
            findings: Vec::new(),
            undrawn: Diagnostics::default(),
            undrawn_of: None,
            selected: Vec::new(),
            page: 0,
            gesture: gestures::Gesture::None,
            placing: None,
            view: Zoom::default(),
            scene: Scene::new(),
            stroke: 0,
            message: new,
            text: text::Editor::default(),
            asking: None,
            left_over,
            conflict: None,
            drafted_s: 0.0,
            inspector: inspector::Inspector::default(),
            kinds_of,
            state,
            slot,
            watched: path,
            locked: BTreeSet::new(),
            hidden: BTreeSet::new(),
            seen_to_scale: Scale::default(),
            pane: None,
            focus: None,
            saves_in: 0,
            leaves_in: 0,
            wish: None,
        })
    }

    pub(super) fn layout(&self) -> &Layout {
        self.document.layout()
    }

    /// The warnings about the text, and the letters that cannot be drawn.
    fn told(&self) -> impl Iterator<Item = &Diagnostic> {
        self.document.warnings().iter().chain(self.undrawn.iter())
    }

    /// All warnings of the reader and of the rules, with their places.
    fn review(&self) -> Diagnostics {
        let mut all = self.document.review();
        all.merge(self.undrawn.clone());
        all
    }

    #[cfg(test)]
    pub(super) fn text_of_layout(&self) -> &str {
        self.document.text()
    }

    /// Whether the file holds all edits.
    pub(super) fn is_saved(&self) -> bool {
        self.document.is_written_as(self.file.known())
    }

    /// The name of the layout: its file name, or the name that it began with.
    pub(super) fn name(&self) -> String {
        if self.file.path().is_some() { self.file.name() } else { self.document.name().to_owned() }
    }

    fn say(&mut self, text: impl Into<String>) {
        self.message = Some(Message { text: text.into(), is_bad: false, of: self.document.revision() });
    }

    fn complain(&mut self, text: impl Into<String>) {
        self.message = Some(Message { text: text.into(), is_bad: true, of: self.document.revision() });
    }

    /// The last message, unless the layout has changed since.
    fn message(&self) -> Option<&Message> {
        self.message.as_ref().filter(|message| message.of == self.document.revision())
    }

    /// Applies `edits` or shows the reason for a refusal; returns whether they were applied.
    fn edit(&mut self, edits: &[Edit]) -> bool {
        self.edit_in(edits, None)
    }

    fn edit_in(&mut self, edits: &[Edit], stroke: Option<u64>) -> bool {
        let done = self.document.edit_in(edits, stroke);
        self.tell(done)
    }

    fn tell(&mut self, done: Result<(), Refusal>) -> bool {
        match done {
            Ok(()) => self.message = None,
            Err(refusal) => self.complain(refusal.short()),
        }
        self.message.is_none()
    }

    /// Updates everything that derives from the present text.
    fn refresh(&mut self) {
        if self.seen == Some(self.document.revision()) {
            return;
        }
        self.seen = Some(self.document.revision());
        self.items = self.document.items();
        self.findings = self.document.findings();
        self.selected.retain(|address| self.document.span(address).is_some());
        self.page = self.page.min(self.layout().pages.len().saturating_sub(1));
    }

    /// Looks for letters of the present text that the fonts of the window lack.
    fn refresh_undrawn(&mut self, ctx: &egui::Context) {
        if self.undrawn_of == Some(self.document.revision()) {
            return;
        }
        self.undrawn_of = Some(self.document.revision());
        let font = egui::FontId::proportional(12.0);
        let has = |letter: char| ctx.fonts_mut(|fonts| fonts.has_glyph(&font, letter));
        self.undrawn = self.document.undrawn(|text| letters::missing_by(text, has));
    }

    fn item(&self, record: &Address) -> Option<&Item> {
        self.items.iter().find(|item| item.record == *record)
    }

    fn selected_items(&self) -> Vec<&Item> {
        let inner = |one: &&Address| !self.selected.iter().any(|other| other != *one && one.is_within(other));
        self.selected.iter().filter(inner).filter_map(|record| self.item(record)).collect()
    }

    fn select_only(&mut self, record: Address) {
        if let Some(page) = record.page() {
            self.page = page;
        }
        self.selected = vec![record];
    }

    /// Whether `pane` gets the keyboard now; clears the request.
    fn leads_to(&mut self, pane: Pane) -> bool {
        self.focus.take_if(|wanted| *wanted == pane).is_some()
    }
}
