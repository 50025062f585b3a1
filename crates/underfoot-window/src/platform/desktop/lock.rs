//! A folder that one window uses alone.

use std::fs::{self, File};
use std::path::{Path, PathBuf};

const LOCK: &str = "lock";

/// A folder that only this window uses. Once nothing else is in it, it is removed at the end.
#[derive(Debug)]
pub(crate) struct FolderLock {
    folder: PathBuf,
    /// A locked file; the lock ends with the process, even after a crash.
    _lock: File,
}

impl FolderLock {
    /// Locks an existing folder; `None` while another window uses it, and for a missing one.
    pub(crate) fn take(folder: &Path) -> Option<Self> {
        let path = folder.join(LOCK);
        let lock = File::options().create(true).append(true).open(&path).ok()?;
        lock.try_lock().ok()?;
        // Another window may have removed the file since it was opened; such a lock protects nothing.
        is_at(&lock, &path).then_some(Self { folder: folder.into(), _lock: lock })
    }
}

impl Drop for FolderLock {
    fn drop(&mut self) {
        // A folder with a draft is not empty, so it stays.
        let _ = fs::remove_file(self.folder.join(LOCK));
        let _ = fs::remove_dir(&self.folder);
    }
}

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

#[cfg(test)]
mod tests {
    use super::*;

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
}
