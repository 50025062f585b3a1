//! Layouts from files: read at the start, and again after each change.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, sync_channel};
use std::thread;
use std::time::{Duration, SystemTime};

use underfoot::floor::Geometry;
use underfoot::layout::Layout;
use underfoot::schema::{self, Diagnostics, Effects, Kinds};

use super::ClusterFailure;

/// Interval between two checks of the files.
const LOOK_EVERY: Duration = Duration::from_millis(250);

/// The layout at `path`, or the built-in one of that name; its warnings are logged.
pub(super) fn load(path: &Path, geometry: &Geometry) -> Result<Layout, ClusterFailure> {
    let builtin = path.to_str().filter(|_| !path.exists()).and_then(schema::builtin_layout);
    let loaded = match builtin {
        Some(text) => schema::parse_layout(
            text,
            &path.to_string_lossy(),
            &Kinds::shipped(Effects::builtin())?,
            geometry,
        )?,
        None => schema::load_layout_and_kinds(path, geometry)?,
    };
    Ok(loaded.log_warnings())
}

/// The layout that a gateway has sent as `text`.
pub(super) fn parse(text: &str, geometry: &Geometry) -> Result<Layout, Diagnostics> {
    schema::parse_layout(text, "the gateway's layout", &Kinds::builtin(), geometry)
        .map(|loaded| loaded.layout)
}

/// The modification time and length of each file.
type Stamp = Vec<(PathBuf, Option<SystemTime>, u64)>;

/// Reads the layout at `path` again each time its file, or one of a kind or an effect beside it, has changed and has
/// then stayed the same until the next check.
pub(super) fn watch(path: PathBuf, geometry: Geometry) -> Receiver<Result<Layout, ClusterFailure>> {
    let (changes, changed) = sync_channel(1);
    thread::spawn(move || {
        let mut read = stamp(&path);
        let mut last = read.clone();
        loop {
            thread::sleep(LOOK_EVERY);
            let now = stamp(&path);
            if now != read && now == last {
                read.clone_from(&now);
                if changes.send(load(&path, &geometry)).is_err() {
                    return;
                }
            }
            last = now;
        }
    });
    changed
}

fn stamp(path: &Path) -> Stamp {
    let folders = ["widgets", "effects"].into_iter().filter_map(|name| schema::folder_beside(path, name));
    let inside = folders.filter_map(|folder| fs::read_dir(folder).ok()).flatten();
    let files = inside.filter_map(|entry| Some(entry.ok()?.path()));
    let mut all: Stamp = std::iter::once(path.to_owned())
        .chain(files)
        .map(|file| {
            let about = fs::metadata(&file).ok();
            let length = about.as_ref().map_or(0, fs::Metadata::len);
            (file, about.and_then(|about| about.modified().ok()), length)
        })
        .collect();
    all.sort();
    all
}
