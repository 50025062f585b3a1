//! Files that the user drops on the window or chooses: readable ones are kept and opened, the others are refused with
//! their problems, and the files before them stay.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::Designer;
use crate::edit::Document;
use crate::link::{EFFECTS, KINDS, ReadableParts, SharedLayout};
use crate::platform::{self, Arrival};
use crate::preview::feed::LayoutCause;
use crate::preview::shown::ShownFloor;
use underfoot::schema::{Diagnostic, Diagnostics, Effects};

/// Maximum number of refused files of which one message shows the problems.
const MOST_TOLD: usize = 3;

/// The kinds and effects of one drop that were kept, and messages about the others.
#[derive(Debug, Default)]
pub(super) struct TakenParts {
    pub(super) kept: usize,
    pub(super) refused: Vec<String>,
}

/// Takes in the next file that has come, if any.
pub(super) fn receive_file(designer: &mut Designer, shown: &mut ShownFloor, next: Option<Arrival>) {
    match next {
        Some(Arrival::Layout(path)) => {
            let is_open = designer.open(&path);
            show_opened(designer, shown, is_open);
        }
        Some(Arrival::LayoutText(path, text)) => {
            let is_open = take_layout(designer, &path, &text);
            show_opened(designer, shown, is_open);
        }
        Some(Arrival::Parts(parts)) => {
            let taken = take_parts(designer, parts);
            if let Some(told) = several(&taken.refused) {
                shown.messages.note(told);
            }
            let is = match taken.kept {
                0 => return,
                1 => "1 kind or effect is",
                count => &format!("{count} kinds and effects are"),
            };
            shown.messages.note(format!("{is} beside the layouts now"));
            shown.messages.files_changed = true;
        }
        Some(Arrival::Refused(text) | Arrival::Told(text)) => shown.messages.note(text),
        None => {}
    }
}

fn show_opened(designer: &Designer, shown: &mut ShownFloor, is_open: bool) {
    if is_open {
        designer.try_layout(shown, LayoutCause::Opened);
    } else if let Some(message) = &designer.edited.message {
        shown.messages.note(message.text.clone());
    }
}

/// Keeps the text of a layout at `path` and opens it, if it can be read; returns whether it is open.
pub(super) fn take_layout(designer: &mut Designer, path: &Path, text: &str) -> bool {
    let name = path.display().to_string();
    let floor = designer.edited.document.floor();
    let read = (designer.storage.kinds_of)(Some(path));
    // An empty file begins with an empty floor.
    let problems = match text.trim().is_empty() {
        true => None,
        false => read.and_then(|kinds| Document::read(&name, text, &kinds, floor)).err(),
    };
    let kept = match problems {
        Some(problems) => Err(problems.to_string()),
        None => keep(path, text),
    };
    match kept {
        Ok(()) => designer.open(path),
        Err(wrong) => {
            designer.edited.complain(refusal(&name, &wrong));
            false
        }
    }
}

/// Keeps the kinds and effects among `parts` that can be read with those that are there.
pub(super) fn take_parts(designer: &Designer, parts: Vec<(PathBuf, String)>) -> TakenParts {
    let mut homes: BTreeMap<PathBuf, SharedLayout> = BTreeMap::new();
    for (path, text) in parts {
        let (folder, file) = (path.parent().unwrap_or(Path::new("")), path.file_name().unwrap_or_default());
        let home = homes.entry(folder.parent().unwrap_or(Path::new("")).into()).or_default();
        let is_effect = folder.file_name().is_some_and(|name| name == EFFECTS);
        let texts = if is_effect { &mut home.effects } else { &mut home.kinds };
        texts.insert(file.to_string_lossy().into_owned(), text);
    }
    let below = (designer.storage.kinds_of)(None).map(|kinds| Effects::clone(kinds.effects()));
    let below = below.unwrap_or_else(|_| Effects::builtin());
    let mut taken = TakenParts::default();
    for (home, new) in homes {
        take_beside(&home, &new, &below, &mut taken);
    }
    taken
}

/// Keeps the kinds and effects of `new` that can be read in the folders of `home`.
fn take_beside(home: &Path, new: &SharedLayout, below: &Effects, taken: &mut TakenParts) {
    let layout = home.join("layout.ron");
    let beside = |folder| platform::texts_beside(&layout, folder);
    let stored = SharedLayout { kinds: beside(KINDS), effects: beside(EFFECTS), ..SharedLayout::default() };
    let before = ReadableParts::of(below, &stored, &SharedLayout::default());
    let parts = ReadableParts::of(below, &stored, new);
    for wrong in parts.unreadable.iter().filter(|wrong| !before.unreadable.contains(wrong)) {
        let path = home.join(wrong.folder).join(&wrong.file).display().to_string();
        taken.refused.push(refusal(&path, &placed_problems(&wrong.problems, &path)));
    }
    let both = [(KINDS, &new.kinds, &parts.texts.kinds), (EFFECTS, &new.effects, &parts.texts.effects)];
    for (folder, new, readable) in both {
        for (file, text) in new.iter().filter(|(file, text)| readable.get(*file) == Some(text)) {
            let path = home.join(folder).join(file);
            match keep(&path, text) {
                Ok(()) => taken.kept += 1,
                Err(wrong) => taken.refused.push(refusal(&path.display().to_string(), &wrong)),
            }
        }
    }
}

/// Writes `text` to `path`, whose folder may be new.
fn keep(path: &Path, text: &str) -> Result<(), String> {
    let folder = path.parent().map_or(Ok(()), platform::make_folder);
    folder.map_err(|error| error.to_string())?;
    platform::save(text, path).map(drop).map_err(|error| error.to_string())
}

fn refusal(path: &str, wrong: &str) -> String {
    format!("{path} is not opened: {wrong}")
}

/// The problems of the file at `path`, which were found by its name alone.
fn placed_problems(problems: &Diagnostics, path: &str) -> String {
    let at = |problem: &Diagnostic| {
        let mut placed = problem.clone();
        path.clone_into(&mut placed.path);
        placed.to_string()
    };
    problems.iter().map(at).collect()
}

/// One message of several; those that it leaves out are counted.
fn several(told: &[String]) -> Option<String> {
    let more = told.len().saturating_sub(MOST_TOLD);
    let mut text = told.get(..told.len() - more)?.join("\n");
    if more > 0 {
        text.push_str(&format!("\nand {more} more files"));
    }
    (!told.is_empty()).then_some(text)
}
