//! Files that remain after a window closes: drafts of layouts without a file, and the list of recent files.

use std::fs::{self, File};
use std::path::{Path, PathBuf};

use underfoot::schema::write_over;

/// Maximum number of files in the list.
const RECENT: usize = 8;

/// Maximum number of drafts of layouts without a file that are kept side by side.
const SLOTS: usize = 32;

/// A folder for the draft of one layout without a file, reserved for this window. Without a draft, it is removed at
/// the end.
#[derive(Debug)]
pub(super) struct Slot {
    pub(super) folder: PathBuf,
    /// A locked file; the lock ends with the process, even after a crash.
    _lock: File,
}

impl Slot {
    fn folder(state: &Path, number: usize) -> PathBuf {
        state.join(format!("untitled-{number}"))
    }

    /// Locks the slot in an existing folder; `None` while another window uses it.
    fn take(folder: PathBuf) -> Option<Self> {
        let path = folder.join(LOCK);
        let lock = File::options().create(true).append(true).open(&path).ok()?;
        lock.try_lock().ok()?;
        // Another window may have removed the file since it was opened; such a lock protects nothing.
        is_at(&lock, &path).then_some(Self { folder, _lock: lock })
    }
}

impl Drop for Slot {
    fn drop(&mut self) {
        // A folder with a draft is not empty, so it stays.
        let _ = fs::remove_file(self.folder.join(LOCK));
        let _ = fs::remove_dir(&self.folder);
    }
}

const LOCK: &str = "lock";

/// Whether the open file is the one at `path`.
fn is_at(file: &File, path: &Path) -> bool {
    let (Ok(open), Ok(there)) = (file.metadata(), fs::metadata(path)) else { return false };
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        (open.dev(), open.ino()) == (there.dev(), there.ino())
    }
    // Other systems do not remove an open file.
    #[cfg(not(unix))]
    {
        let _ = (open, there);
        true
    }
}

/// Folders for drafts that no window uses, each created on demand.
pub(super) fn slots(state: &Path) -> impl Iterator<Item = Slot> {
    (1..=SLOTS).filter_map(move |number| {
        let folder = Slot::folder(state, number);
        fs::create_dir_all(&folder).ok()?;
        Slot::take(folder)
    })
}

/// The existing slots of earlier windows; dropping a slot removes its folder unless it holds a draft.
pub(super) fn left_slots(state: &Path) -> impl Iterator<Item = Slot> {
    let there = (1..=SLOTS).map(move |number| Slot::folder(state, number)).filter(|folder| folder.is_dir());
    there.filter_map(Slot::take)
}

fn list(state: &Path) -> PathBuf {
    state.join("recent")
}

/// The files that were opened last, the latest first, without those that no longer exist.
pub(super) fn recent(state: &Path) -> Vec<PathBuf> {
    let text = fs::read_to_string(list(state)).unwrap_or_default();
    text.lines().take(RECENT).map(PathBuf::from).filter(|path| path.is_file()).collect()
}

/// Puts a file first in the list. A failure to save the list only makes it shorter next time, so it is merely logged.
pub(super) fn note_recent(state: &Path, path: &Path) {
    let Ok(path) = fs::canonicalize(path) else { return };
    let mut all = recent(state);
    all.retain(|other| *other != path);
    all.insert(0, path);
    all.truncate(RECENT);
    let text: String = all.iter().filter_map(|path| Some(format!("{}\n", path.to_str()?))).collect();
    if let Err(error) = fs::create_dir_all(state)
        .map_err(|error| error.to_string())
        .and_then(|()| write_over(&text, &list(state)).map_err(|error| error.to_string()))
    {
        tracing::debug!("the list of recent files is not kept: {error}");
    }
}

#[cfg(test)]
mod tests {
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
    fn a_lock_that_another_window_has_removed_locks_nothing() {
        let state = tempfile::tempdir().unwrap();
        let path = state.path().join(LOCK);
        let lock = File::create(&path).unwrap();
        assert!(is_at(&lock, &path));
        fs::remove_file(&path).unwrap();
        assert!(!is_at(&lock, &path));
        File::create(&path).unwrap();
        assert!(!is_at(&lock, &path) || cfg!(not(unix)));
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
