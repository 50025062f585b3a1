//! The layout that is edited: its text, all that derives from it, the selection, and the last message about it.

use std::collections::BTreeSet;

use eframe::egui;

use super::findings::Problems;
use super::step_selections::StepSelections;
use crate::edit::{Address, Document, Edit, EditRefusal, Facet, Item};
use underfoot::layout::Layout;
use underfoot::schema::{Diagnostic, Diagnostics};
use underfoot_scene::ergonomics::Finding;
use underfoot_scene::letters;

/// A message about an action.
pub(super) struct EditMessage {
    pub(super) text: String,
    pub(super) is_bad: bool,
    /// The revision of the layout to which it refers.
    pub(super) of: u64,
}

/// The layout that is edited.
pub(super) struct EditedLayout {
    pub(super) document: Document,
    /// The revision to which `items` and `findings` belong.
    pub(super) seen: Option<u64>,
    pub(super) items: Vec<Item>,
    pub(super) findings: Vec<Finding>,
    /// Letters that the fonts of the window lack, and the revision to which the list belongs.
    undrawn: Diagnostics,
    undrawn_of: Option<u64>,
    /// The selected records.
    pub(super) selected: Vec<Address>,
    /// The index of the page on display.
    pub(super) page: usize,
    /// The records that are locked on the floor, and those that are hidden, by [`EditedLayout::key_of`].
    pub(super) locked: BTreeSet<String>,
    pub(super) hidden: BTreeSet<String>,
    /// The number of the drag, or of the held key, that edits now: its edits are one undo step.
    pub(super) stroke: u64,
    /// The last message about an action or a refusal.
    pub(super) message: Option<EditMessage>,
    /// The selection at each step of undo.
    pub(super) steps: StepSelections,
    /// The problems with their repairs, for the list of them.
    pub(super) problems: Problems,
    /// The part of a control that the text of the clipboard gives, and the frame in which the menu asked for that
    /// text.
    pub(super) pasting: Option<(Option<Facet>, u64)>,
}

impl EditedLayout {
    pub(super) fn new(document: Document) -> Self {
        Self {
            document,
            seen: None,
            items: Vec::new(),
            findings: Vec::new(),
            undrawn: Diagnostics::default(),
            undrawn_of: None,
            selected: Vec::new(),
            page: 0,
            locked: BTreeSet::new(),
            hidden: BTreeSet::new(),
            stroke: 0,
            message: None,
            steps: StepSelections::default(),
            problems: Problems::default(),
            pasting: None,
        }
    }

    pub(super) fn layout(&self) -> &Layout {
        self.document.layout()
    }

    /// The warnings about the text, and the letters that cannot be drawn.
    pub(super) fn told(&self) -> impl Iterator<Item = &Diagnostic> {
        self.document.warnings().iter().chain(self.undrawn.iter())
    }

    /// All warnings of the reader and of the rules, with their places.
    pub(super) fn review(&self) -> Diagnostics {
        let mut all = self.document.review();
        all.merge(self.undrawn.clone());
        all
    }

    pub(super) fn say(&mut self, text: impl Into<String>) {
        self.message = Some(EditMessage { text: text.into(), is_bad: false, of: self.document.revision() });
    }

    pub(super) fn complain(&mut self, text: impl Into<String>) {
        self.message = Some(EditMessage { text: text.into(), is_bad: true, of: self.document.revision() });
    }

    /// The last message, unless the layout has changed since.
    pub(super) fn message(&self) -> Option<&EditMessage> {
        self.message.as_ref().filter(|message| message.of == self.document.revision())
    }

    /// Applies `edits` or shows the reason for a refusal; returns whether they were applied.
    pub(super) fn edit(&mut self, edits: &[Edit]) -> bool {
        self.edit_in(edits, None)
    }

    pub(super) fn edit_in(&mut self, edits: &[Edit], stroke: Option<u64>) -> bool {
        let renamed: Vec<(String, &String)> = edits
            .iter()
            .filter_map(|edit| match edit {
                Edit::Rename { record, id } => Some((self.key_of(record), id)),
                _ => None,
            })
            .collect();
        let done = self.document.edit_in(edits, stroke);
        if done.is_ok() {
            for (old, new) in renamed {
                for keys in [&mut self.locked, &mut self.hidden] {
                    if keys.remove(&old) {
                        keys.insert(new.clone());
                    }
                }
            }
        }
        self.tell(done)
    }

    pub(super) fn tell(&mut self, done: Result<(), EditRefusal>) -> bool {
        match done {
            Ok(()) => self.message = None,
            Err(refusal) => self.complain(refusal.short()),
        }
        self.message.is_none()
    }

    /// Updates everything that derives from the present text.
    pub(super) fn refresh(&mut self) {
        self.steps.note(self.document.step(), &self.selected);
        if self.seen == Some(self.document.revision()) {
            return;
        }
        self.seen = Some(self.document.revision());
        self.items = self.document.items();
        self.findings = self.document.findings();
        self.selected.retain(|address| self.document.span(address).is_some());
        self.page = self.page.min(self.layout().pages.len().saturating_sub(1));
    }

    /// Looks for letters of the present text that the fonts of the window lack. In a page, the browser draws those.
    pub(super) fn refresh_undrawn(&mut self, ctx: &egui::Context) {
        if self.undrawn_of == Some(self.document.revision()) {
            return;
        }
        self.undrawn_of = Some(self.document.revision());
        let font = egui::FontId::proportional(12.0);
        let has = |letter: char| {
            cfg!(target_arch = "wasm32") || ctx.fonts_mut(|fonts| fonts.has_glyph(&font, letter))
        };
        self.undrawn = self.document.undrawn(|text| letters::missing_by(text, has));
    }

    pub(super) fn item(&self, record: &Address) -> Option<&Item> {
        self.items.iter().find(|item| item.record == *record)
    }

    pub(super) fn selected_items(&self) -> Vec<&Item> {
        let inner = |one: &&Address| !self.selected.iter().any(|other| other != *one && one.is_within(other));
        self.selected.iter().filter(inner).filter_map(|record| self.item(record)).collect()
    }

    pub(super) fn select_only(&mut self, record: Address) {
        if let Some(page) = record.page() {
            self.page = page;
        }
        self.selected = vec![record];
    }
}
