//! States of the files of a layout, without their contents.

use std::collections::BTreeMap;
use std::fs::Metadata;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use underfoot::schema::read_bounded;

use super::super::layout_args::LayoutArgs;

/// Maximum number of watched files: several times as many as are read.
const MOST_FILES: usize = 10_000;

/// Maximum size of a file for the comparison of contents, in bytes; as large as any layout.
const MOST_BYTES: u64 = 16 << 20;

/// States of all files of a layout: its own, and those of its kinds and effects.
#[derive(Clone, Debug, Default)]
pub(super) struct Stamps(BTreeMap<PathBuf, Stamp>);

/// State of one file, after all links.
#[derive(Clone, Debug)]
enum Stamp {
    Missing,
    There {
        length: u64,
        modified: Option<SystemTime>,
        identity: Identity,
        /// Hash of its contents, if they are compared.
        contents: Option<u64>,
    },
}

/// Device and number of a file, or its time of creation on systems without them: a file that replaces another
/// differs.
type Identity = (u64, u64, Option<SystemTime>);

impl Stamps {
    /// The current states of the files. With `contents`, includes their contents: two saves may follow each other
    /// within one step of a file system's clock, which is up to 2 s.
    pub(super) fn of(files: &LayoutArgs, contents: bool) -> Self {
        let mut stamps = BTreeMap::new();
        let mut add = |path: PathBuf| {
            let stamp = Stamp::of(&path, contents);
            stamps.insert(path, stamp);
        };
        if let Some(path) = files.path() {
            add(path.to_path_buf());
        }
        for folder in [files.kinds_folder(), files.effects_folder()].into_iter().flatten() {
            let entries = folder.read_dir().into_iter().flatten().flatten().map(|entry| entry.path());
            let is_ron = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "ron");
            entries.filter(is_ron).take(MOST_FILES).for_each(&mut add);
        }
        Self(stamps)
    }

    /// Whether these are the states of the same files with the same contents.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        self.0.len() == other.0.len()
            && self
                .0
                .iter()
                .zip(&other.0)
                .all(|((path, stamp), (other_path, other))| path == other_path && stamp.is_same(other))
    }

    /// Whether a file of `before` is missing now.
    pub(super) fn lacks_any_of(&self, before: &Self) -> bool {
        let is_there = |stamp: Option<&Stamp>| matches!(stamp, Some(Stamp::There { .. }));
        before.0.iter().any(|(path, stamp)| is_there(Some(stamp)) && !is_there(self.0.get(path)))
    }
}

impl Stamp {
    fn of(path: &Path, contents: bool) -> Self {
        let Ok(metadata) = path.metadata() else { return Self::Missing };
        let hash = |text: String| {
            let mut hasher = DefaultHasher::new();
            text.hash(&mut hasher);
            hasher.finish()
        };
        Self::There {
            length: metadata.len(),
            modified: metadata.modified().ok(),
            identity: identity(&metadata),
            contents: contents.then(|| read_bounded(path, MOST_BYTES).ok().map(hash)).flatten(),
        }
    }

    fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Missing, Self::Missing) => true,
            (
                Self::There { length, modified, identity, contents },
                Self::There {
                    length: other_length,
                    modified: other_modified,
                    identity: other_identity,
                    contents: other_contents,
                },
            ) => {
                let are_compared = contents.is_some() && other_contents.is_some();
                length == other_length
                    && modified == other_modified
                    && identity == other_identity
                    && (!are_compared || contents == other_contents)
            }
            _ => false,
        }
    }
}

#[cfg(unix)]
fn identity(metadata: &Metadata) -> Identity {
    use std::os::unix::fs::MetadataExt;
    (metadata.dev(), metadata.ino(), None)
}

#[cfg(not(unix))]
fn identity(metadata: &Metadata) -> Identity {
    (0, 0, metadata.created().ok())
}
