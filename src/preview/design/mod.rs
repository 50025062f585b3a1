//! Design mode: the layout on the screen is edited, by mouse, keyboard and as text.
//!
//! What edits mean and which bytes they change is [`crate::edit`]'s; here is only what is seen and touched.

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
use crate::ergonomics::Finding;
use crate::floor::Floor;
use crate::layout::Layout;
use crate::letters;
use crate::scene::Scene;
use crate::schema::{Diagnostic, Diagnostics, Kinds};

pub use crate::schema::usual_state;
pub(super) use threshold::Threshold;

/// What Design mode begins with.
pub struct DesignInput {
    /// What messages call the layout.
    pub name: String,
    /// Its text; none for a file that is to be begun.
    pub text: String,
    /// Its file, which is there unless it is to be begun; `None` for a layout that has none, such as a shipped one.
    pub path: Option<PathBuf>,
    /// The kinds that controls can be made of.
    pub kinds_of: KindsOf,
    /// Where drafts of layouts without a file and the list of recent files are kept, as [`usual_state`].
    pub state: PathBuf,
}

/// Reads the kinds that the layout in this file can be made of; those of a layout without a file for `None`.
pub type KindsOf = Box<dyn Fn(Option<&Path>) -> Result<Arc<Kinds>, Diagnostics>>;

/// The layout that is edited, and what is selected and under way.
pub(super) struct Designer {
    pub(super) is_open: bool,
    document: Document,
    file: LayoutFile,
    /// The revision that `items`, `findings` and `text` belong to.
    seen: Option<u64>,
    items: Vec<Item>,
    findings: Vec<Finding>,
    /// Letters that the window can't draw, and the revision that they belong to.
    undrawn: Diagnostics,
    undrawn_of: Option<u64>,
    selected: Vec<Address>,
    /// The number of the page that is shown.
    page: usize,
    gesture: gestures::Gesture,
    /// What is put down with the next click.
    placing: Option<palette::Thing>,
    view: Zoom,
    scene: Scene,
    stroke: u64,
    /// What could not be done, or was.
    message: Option<Message>,
    text: text::Editor,
    /// The path that is asked for, while it is.
    asking: Option<Asking>,
    /// What is left of an earlier window, until it is taken up or put away.
    left_over: Option<String>,
    /// What another program has written where this one has as well.
    conflict: Option<(String, Vec<String>)>,
    drafted_s: f64,
    inspector: inspector::Inspector,
    kinds_of: KindsOf,
    state: PathBuf,
    /// Where the draft is while there is no file.
    slot: Option<shelf::Slot>,
    /// The file that the program watches.
    watched: Option<PathBuf>,
    /// What can't be taken hold of on the floor, and what is not drawn, by [`Designer::key_of`].
    locked: BTreeSet<String>,
    hidden: BTreeSet<String>,
    seen_to_scale: Scale,
    /// Which part of the window F6 led to, and the one that is to get the keyboard in this frame.
    pane: Option<Pane>,
    focus: Option<Pane>,
    /// Frames until the file is saved, and until the floor is tried: what is being typed counts first.
    saves_in: u8,
    leaves_in: u8,
    /// What the floor is asked to do.
    wish: Option<PreviewCommand>,
}

/// What else is drawn in its true size.
#[derive(Clone, Copy, Debug, Default)]
struct Scale {
    shoes: bool,
    reach: bool,
}

/// A part of the window that F6 leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Pane {
    Things,
    Floor,
    Fields,
    Text,
}

/// A sentence about what was done.
struct Message {
    text: String,
    is_bad: bool,
    /// The revision of the layout that it is about.
    of: u64,
}

/// A path that is being typed.
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
    /// `None` for a layout that can't be read: there is nothing to edit then.
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

    /// What is odd about the text, and the letters that can't be drawn.
    fn told(&self) -> impl Iterator<Item = &Diagnostic> {
        self.document.warnings().iter().chain(self.undrawn.iter())
    }

    /// Everything that the reader and the rules warn of, with its places.
    fn review(&self) -> Diagnostics {
        let mut all = self.document.review();
        all.merge(self.undrawn.clone());
        all
    }

    #[cfg(test)]
    pub(super) fn text_of_layout(&self) -> &str {
        self.document.text()
    }

    /// Whether everything is in the file.
    pub(super) fn is_saved(&self) -> bool {
        self.document.is_written_as(self.file.known())
    }

    /// What people call the layout: its file, or what it was begun with.
    pub(super) fn name(&self) -> String {
        if self.file.path().is_some() { self.file.name() } else { self.document.name().to_owned() }
    }

    fn say(&mut self, text: impl Into<String>) {
        self.message = Some(Message { text: text.into(), is_bad: false, of: self.document.revision() });
    }

    fn complain(&mut self, text: impl Into<String>) {
        self.message = Some(Message { text: text.into(), is_bad: true, of: self.document.revision() });
    }

    /// The last message, unless the layout has changed since then.
    fn message(&self) -> Option<&Message> {
        self.message.as_ref().filter(|message| message.of == self.document.revision())
    }

    /// Does `edits`, or says why not; whether they were done.
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

    /// What belongs to the present text.
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

    /// Looks for letters of the present text that the window's fonts lack.
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

    /// Whether this part of the window is to get the keyboard now.
    fn leads_to(&mut self, pane: Pane) -> bool {
        self.focus.take_if(|wanted| *wanted == pane).is_some()
    }
}
