//! Design mode: edits the layout on the screen by mouse, by keyboard and as text.
//!
//! [`crate::edit`] defines the meaning of edits and the bytes that they change; this module holds the display and the
//! input.

mod arrivals;
mod bar;
mod canvas;
mod changes;
mod edited;
mod files;
mod findings;
mod gestures;
mod in_place;
mod inspector;
mod keys;
mod list;
mod list_keys;
mod marks;
mod menu;
mod modes;
mod palette;
mod putting;
mod several;
mod shelf;
mod shielded;
mod spacing_marks;
mod step_selections;
#[cfg(test)]
mod tests;
mod text;
mod threshold;
mod trial;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use canvas::Canvas;
use edited::{EditMessage, EditedLayout};

use crate::edit::{Document, LayoutFile};
use crate::platform::FileInbox;
use crate::preview::handheld::PanelSheet;
use crate::preview::share::LayoutToShare;
use underfoot::floor::Floor;
use underfoot::layout::Layout;
use underfoot::schema::{Diagnostics, Kinds};
use underfoot::widget::WidgetId;

pub use crate::platform::{texts_beside, usual_state};
pub(super) use threshold::{Threshold, set_threshold, undo_design};

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

/// Design mode.
pub(super) struct Designer {
    pub(super) is_open: bool,
    edited: EditedLayout,
    storage: Storage,
    canvas: Canvas,
    text: text::Editor,
    inspector: inspector::Inspector,
    /// The list of things to put down.
    things: palette::ThingList,
    panes: Panes,
    delays: Delays,
    /// The control that a foot had used last when Design mode was opened.
    used: Option<WidgetId>,
}

/// The file of the layout, and the questions about it.
struct Storage {
    file: LayoutFile,
    /// The path dialogue, while it is open.
    asking: Option<Asking>,
    /// The text of a draft of an earlier window, until the user restores or discards it.
    left_over: Option<String>,
    /// The text of another program where the file changed both outside and here.
    conflict: Option<(String, Vec<String>)>,
    drafted_s: f64,
    kinds_of: KindsOf,
    /// The folder for drafts of layouts without a file and for the list of recent files.
    state: PathBuf,
    /// The place of the draft while the layout has no file.
    slot: Option<shelf::Slot>,
    /// The file that the program watches for changes.
    watched: Option<PathBuf>,
    /// Files that the user drops on the window or chooses.
    inbox: FileInbox,
}

/// The panes that F6 reaches.
#[derive(Default)]
struct Panes {
    /// The pane to which F6 led.
    pane: Option<Pane>,
    /// The pane that gets the keyboard in this frame.
    focus: Option<Pane>,
    /// Whether F6 led to the pane, and not a press on the floor away from it.
    is_led: bool,
    /// Whether the window shows one panel at a time, at the right.
    is_narrow: bool,
    /// The place of the open panel in a window in a hand.
    sheet: Option<PanelSheet>,
    /// Whether a thing is in hand whose place is on the floor: the list folds, once the finger that took the thing is up.
    puts_down: bool,
    /// Whether the list of things is open, in a window in a hand.
    shows_things: bool,
}

impl Panes {
    /// Whether `pane` gets the keyboard now; clears the request.
    fn leads_to(&mut self, pane: Pane) -> bool {
        self.focus.take_if(|wanted| *wanted == pane).is_some()
    }
}

/// Frames until the file is saved, and until the floor is tried: a field that is being typed is applied first.
#[derive(Default)]
struct Delays {
    saves_in: u8,
    leaves_in: u8,
}

/// A pane of the window that F6 can reach.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Pane {
    Things,
    Floor,
    Fields,
    Text,
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
        let new = file.is_new().then(|| EditMessage {
            text: format!("{} is new: F2 designs it, Ctrl+S writes it", file.name()),
            is_bad: false,
            of: document.revision(),
        });
        let mut edited = EditedLayout::new(document);
        edited.message = new;
        Some(Self {
            is_open: false,
            edited,
            storage: Storage {
                file,
                asking: None,
                left_over,
                conflict: None,
                drafted_s: 0.0,
                kinds_of,
                state,
                slot,
                watched: path,
                inbox: FileInbox::new(),
            },
            canvas: Canvas::default(),
            text: text::Editor::default(),
            inspector: inspector::Inspector::default(),
            things: palette::ThingList::default(),
            panes: Panes::default(),
            delays: Delays::default(),
            used: None,
        })
    }

    pub(super) fn layout(&self) -> &Layout {
        self.edited.layout()
    }

    #[cfg(test)]
    pub(super) fn text_of_layout(&self) -> &str {
        self.edited.document.text()
    }

    /// Whether the file holds all edits.
    pub(super) fn is_saved(&self) -> bool {
        self.edited.document.is_written_as(self.storage.file.known())
    }

    /// The text for its file.
    pub(super) fn file_text(&self) -> String {
        self.edited.document.file_text()
    }

    /// The layout for a link.
    pub(super) fn to_share(&self) -> LayoutToShare {
        let path = self.storage.file.path().map(Path::to_path_buf);
        LayoutToShare { name: self.name(), text: self.file_text(), path, visit: None }
    }

    /// The name of the layout: its file name, or the name that it began with.
    pub(super) fn name(&self) -> String {
        let file = &self.storage.file;
        if file.path().is_some() { file.name() } else { self.edited.document.name().to_owned() }
    }
}
