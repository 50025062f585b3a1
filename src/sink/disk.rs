//! Disk care for a recorded file: syncs the data every few seconds, and warns before the disk is full.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant as HostInstant};

/// Interval between two syncs: the maximum loss in a power failure.
const SYNC_EVERY: Duration = Duration::from_secs(5);

/// Free space below which a warning is logged, in bytes: a minute and a half of a WAV file of 36 channels.
const LOW: u64 = 500_000_000;

/// Free space above which the warning may be repeated, in bytes.
const ENOUGH: u64 = 600_000_000;

/// Keeps one file safe while it is written.
#[derive(Debug)]
pub(crate) struct Disk {
    /// A second handle of the file.
    file: File,
    path: PathBuf,
    synced: HostInstant,
    space: Space,
}

impl Disk {
    /// Takes care of `file` at `path`.
    ///
    /// # Errors
    /// The error of the system if it gives no second handle.
    pub(crate) fn of(file: &File, path: &Path) -> io::Result<Self> {
        let mut disk = Self {
            file: file.try_clone()?,
            path: path.into(),
            synced: HostInstant::now(),
            space: Space::default(),
        };
        disk.look();
        Ok(disk)
    }

    /// Takes care of `file` at `path` from now on, the next file of the recording.
    ///
    /// # Errors
    /// The error of the system if it gives no second handle.
    #[cfg(feature = "wav")]
    pub(crate) fn go_on(&mut self, file: &File, path: &Path) -> io::Result<()> {
        self.file = file.try_clone()?;
        self.path = path.into();
        self.look();
        Ok(())
    }

    /// Syncs and checks the disk if that is due. Called after each flush, from a thread that may block.
    ///
    /// # Errors
    /// The error of the system if the sync fails.
    pub(crate) fn tend(&mut self) -> io::Result<()> {
        if self.synced.elapsed() < SYNC_EVERY {
            return Ok(());
        }
        self.look();
        let synced = self.file.sync_data();
        self.synced = HostInstant::now();
        synced
    }

    fn look(&mut self) {
        if let Some(left) = free(&self.path).filter(|left| self.space.is_news(*left)) {
            let (path, left) = (self.path.display(), left / 1_000_000);
            tracing::warn!("{left} MB are left on the disk of {path}: make room, or end the recording");
        }
    }
}

/// Whether low space has been reported.
#[derive(Clone, Copy, Debug, Default)]
struct Space {
    told: bool,
}

impl Space {
    /// Whether `left` bytes must be reported: once, until there is enough space again.
    const fn is_news(&mut self, left: u64) -> bool {
        let is_low = left < LOW;
        let is_news = is_low && !self.told;
        self.told = is_low || (self.told && left < ENOUGH);
        is_news
    }
}

/// Returns the free bytes of the disk of `path` for programs without privileges; `None` if unknown.
#[cfg(unix)]
#[allow(clippy::useless_conversion, reason = "macOS counts blocks in 32 bits")]
fn free(path: &Path) -> Option<u64> {
    let disk = nix::sys::statvfs::statvfs(path).ok()?;
    u64::from(disk.blocks_available()).checked_mul(disk.fragment_size())
}

#[cfg(not(unix))]
fn free(_path: &Path) -> Option<u64> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Row F4. The space falls, hovers around the limit, is freed, and falls again.
    #[test]
    fn little_space_is_told_once_until_there_was_enough() {
        let mut space = Space::default();
        let told: Vec<bool> = [900, 501, 499, 503, 498, 300, 601, 550, 499, 0]
            .map(|megabytes| space.is_news(megabytes * 1_000_000))
            .into();
        let news: Vec<usize> = (0..).zip(&told).filter(|(_, told)| **told).map(|(at, _)| at).collect();
        assert_eq!(news, [2, 8], "{told:?}");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn the_system_tells_what_is_left() {
        let folder = tempfile::tempdir().unwrap();
        assert!(free(folder.path()).is_some());
        assert_eq!(free(&folder.path().join("missing")), None);
    }
}
