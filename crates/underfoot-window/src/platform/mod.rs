//! The computer under the window: its files, and work beside the frames of the window.
//!
//! A browser differs from a desktop in this module and in the start of the window alone; the rest of the crate uses
//! the same names on both:
//!
//! | name | desktop | browser |
//! |---|---|---|
//! | `read`, `save`, `write_over` and the like | files | entries of the browser's local storage |
//! | `FolderLock` | a locked file | an entry that the page renews |
//! | `FileInbox`, `give` | paths | files and folders copied into the storage, and downloads |
//! | `note_saved` | nothing | the file from which an entry was copied, where the browser can write it |
//! | `texts_beside` | the texts in a folder | entries of the storage |
//! | `repeat` | a thread | the frames of the page |
//! | `put_report` | a file | a name in the page |
//! | `has_coarse_pointer` | false | as the browser says |

#[cfg(target_arch = "wasm32")]
mod browser;
#[cfg(not(target_arch = "wasm32"))]
mod desktop;
#[cfg(any(test, all(feature = "window", target_arch = "wasm32")))]
mod incoming;

#[cfg(feature = "window")]
use std::path::PathBuf;

#[cfg(all(feature = "window", target_arch = "wasm32"))]
pub(crate) use incoming::{Incoming, placed};

#[cfg(target_arch = "wasm32")]
pub(crate) use browser::files::{read, remove, save, write_over};
#[cfg(not(target_arch = "wasm32"))]
pub(crate) use desktop::files::{read, remove, save, write_over};

#[cfg(all(feature = "window", target_arch = "wasm32"))]
pub(crate) use browser::{
    files::{canonical, is_file, is_folder, make_folder},
    inbox::{FileInbox, GIVES, give, note_saved},
    lock::FolderLock,
    repeat::repeat,
    screen::{has_coarse_pointer, put_report, report_place},
};
#[cfg(all(feature = "window", not(target_arch = "wasm32")))]
pub(crate) use desktop::{
    files::{canonical, is_file, is_folder, make_folder},
    inbox::{FileInbox, GIVES, give, note_saved},
    lock::FolderLock,
    repeat::repeat,
    screen::{has_coarse_pointer, put_report, report_place},
};

#[cfg(all(feature = "window", target_arch = "wasm32"))]
pub use browser::files::{texts_beside, usual_state};
#[cfg(all(feature = "window", not(target_arch = "wasm32")))]
pub use desktop::files::{texts_beside, usual_state};

/// A file that has come into a `FileInbox`.
#[cfg(feature = "window")]
#[derive(Clone, Debug, PartialEq, Eq)]
#[allow(dead_code, reason = "a desktop has the files already, and a browser has their texts alone")]
pub(crate) enum Arrival {
    /// A layout to open, which has its file.
    Layout(PathBuf),
    /// The text of a layout to keep at this path and open, if it can be read.
    LayoutText(PathBuf, String),
    /// The texts of kinds of controls and of effects to keep at these paths, beside the layouts, if they can be read.
    Parts(Vec<(PathBuf, String)>),
    /// The reason why a file did not come.
    Refused(String),
    /// A message of the page about a file.
    Told(String),
}
