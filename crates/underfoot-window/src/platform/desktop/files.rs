//! Files.

#[cfg(feature = "window")]
use std::collections::BTreeMap;
use std::path::Path;

#[cfg(feature = "window")]
pub(crate) use std::fs::{canonicalize as canonical, create_dir_all as make_folder};
#[cfg(feature = "window")]
pub use underfoot::schema::usual_state;
pub(crate) use underfoot::schema::{save_text as save, write_over};
pub(crate) use underfoot_format::file::read_bounded as read;

/// Whether there is a file at `path`.
#[cfg(feature = "window")]
pub(crate) fn is_file(path: &Path) -> bool {
    path.is_file()
}

/// Whether there is a folder at `path`.
#[cfg(feature = "window")]
pub(crate) fn is_folder(path: &Path) -> bool {
    path.is_dir()
}

/// Returns the texts of all files named `*.ron` in the folder called `name` next to the layout at `path` or next to its
/// folder, by their names: the user's kinds or effects. Skips files that cannot be read.
#[cfg(feature = "window")]
#[must_use]
pub fn texts_beside(path: &Path, name: &str) -> BTreeMap<String, String> {
    let folder = underfoot::schema::folder_beside(path, name);
    let files = folder.and_then(|folder| std::fs::read_dir(folder).ok()).into_iter().flatten().flatten();
    let texts = files.filter_map(|file| {
        let name = file.file_name().into_string().ok().filter(|name| name.ends_with(".ron"))?;
        Some((name, read(&file.path(), underfoot_format::source::MAX_BYTES as u64).ok()?))
    });
    texts.collect()
}

/// Removes the file at `path`. One that cannot be removed stays without a message.
pub(crate) fn remove(path: &Path) {
    let _ = std::fs::remove_file(path);
}
