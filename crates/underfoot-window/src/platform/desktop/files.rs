//! Files.

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

/// Removes the file at `path`. One that cannot be removed stays without a message.
pub(crate) fn remove(path: &Path) {
    let _ = std::fs::remove_file(path);
}
