//! Files that remain after a window closes: drafts of layouts without a file, and the list of recent files.

use std::path::{Path, PathBuf};

use crate::platform::{self, FolderLock};

/// Maximum number of files in the list.
const RECENT: usize = 8;

/// Maximum length of the list, in bytes.
const LONGEST: u64 = 1 << 20;

/// Maximum number of drafts of layouts without a file that are kept side by side.
const SLOTS: usize = 32;

/// A folder for the draft of one layout without a file, reserved for this window. Without a draft, it is removed at
/// the end.
#[derive(Debug)]
pub(super) struct Slot {
    pub(super) folder: PathBuf,
    _lock: FolderLock,
}

impl Slot {
    fn folder(state: &Path, number: usize) -> PathBuf {
        state.join(format!("untitled-{number}"))
    }

    /// Locks the slot in an existing folder; `None` while another window uses it.
    fn take(folder: PathBuf) -> Option<Self> {
        let lock = FolderLock::take(&folder)?;
        Some(Self { folder, _lock: lock })
    }
}

/// Folders for drafts that no window uses, each created on demand.
pub(super) fn slots(state: &Path) -> impl Iterator<Item = Slot> {
    (1..=SLOTS).filter_map(move |number| {
        let folder = Slot::folder(state, number);
        platform::make_folder(&folder).ok()?;
        Slot::take(folder)
    })
}

/// The existing slots of earlier windows; dropping a slot removes its folder unless it holds a draft.
pub(super) fn left_slots(state: &Path) -> impl Iterator<Item = Slot> {
    let there = (1..=SLOTS)
        .map(move |number| Slot::folder(state, number))
        .filter(|folder| platform::is_folder(folder));
    there.filter_map(Slot::take)
}

fn list(state: &Path) -> PathBuf {
    state.join("recent")
}

/// The files that were opened last, the latest first, without those that no longer exist.
pub(super) fn recent(state: &Path) -> Vec<PathBuf> {
    let text = platform::read(&list(state), LONGEST).unwrap_or_default();
    text.lines().take(RECENT).map(PathBuf::from).filter(|path| platform::is_file(path)).collect()
}

/// Puts a file first in the list. A failure to save the list only makes it shorter next time, so it is merely logged.
pub(super) fn note_recent(state: &Path, path: &Path) {
    let Ok(path) = platform::canonical(path) else { return };
    let mut all = recent(state);
    all.retain(|other| *other != path);
    all.insert(0, path);
    all.truncate(RECENT);
    let text: String = all.iter().filter_map(|path| Some(format!("{}\n", path.to_str()?))).collect();
    if let Err(error) = platform::make_folder(state)
        .map_err(|error| error.to_string())
        .and_then(|()| platform::write_over(&text, &list(state)).map_err(|error| error.to_string()))
    {
        tracing::debug!("the list of recent files is not kept: {error}");
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn two_windows_never_share_a_draft_and_one_that_ended_leaves_its_own() {
        let state = tempfile::tempdir().unwrap();
        let first = slots(state.path()).next().unwrap();
        let second = slots(state.path()).next().unwrap();
        assert_ne!(first.folder, second.folder);
        let folder = first.folder.clone();
        drop(first);
        assert_eq!(slots(state.path()).next().unwrap().folder, folder);
    }

    #[test]
    fn a_window_leaves_nothing_behind_but_its_draft() {
        let state = tempfile::tempdir().unwrap();
        for _ in 0..20 {
            drop(slots(state.path()).next().unwrap());
        }
        assert_eq!(fs::read_dir(state.path()).unwrap().count(), 0);
        let kept = slots(state.path()).next().unwrap();
        fs::write(kept.folder.join("draft"), "Layout()").unwrap();
        let folder = kept.folder.clone();
        drop(kept);
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "the draft");
        // Looking at the empty folders of older versions removes them.
        for number in 2..=SLOTS {
            fs::create_dir(Slot::folder(state.path(), number)).unwrap();
        }
        assert_eq!(left_slots(state.path()).count(), SLOTS);
        assert_eq!(fs::read_dir(state.path()).unwrap().count(), 1);
    }

    #[test]
    fn the_latest_file_is_first_and_those_that_are_gone_are_left_out() {
        let state = tempfile::tempdir().unwrap();
        let files: Vec<PathBuf> = (0..RECENT + 3).map(|n| state.path().join(format!("{n}.ron"))).collect();
        for file in &files {
            fs::write(file, "").unwrap();
            note_recent(state.path(), file);
        }
        note_recent(state.path(), &files[5]);
        let listed = recent(state.path());
        assert_eq!(listed.len(), RECENT);
        assert_eq!(listed[0].file_name(), files[5].file_name());
        fs::remove_file(&files[5]).unwrap();
        assert_eq!(recent(state.path()).len(), RECENT - 1);
    }
}
