//! The computer under the window: its files, and work beside the frames of the window.
//!
//! A browser differs from a desktop in this module and in the start of the window alone; the rest of the crate uses
//! the same names on both:
//!
//! | name | desktop | browser |
//! |---|---|---|
//! | `read`, `save`, `write_over` and the like | files | entries of the browser's local storage |
//! | `FolderLock` | a locked file | an entry that the page renews |
//! | `FileInbox`, `give` | paths | files copied into the storage, and downloads |
//! | `repeat` | a thread | the frames of the page |
//! | `put_report` | a file | a name in the page |

#[cfg(target_arch = "wasm32")]
mod browser;
#[cfg(not(target_arch = "wasm32"))]
mod desktop;

#[cfg(target_arch = "wasm32")]
pub(crate) use browser::files::{read, remove, save, write_over};
#[cfg(not(target_arch = "wasm32"))]
pub(crate) use desktop::files::{read, remove, save, write_over};

#[cfg(all(feature = "window", target_arch = "wasm32"))]
pub(crate) use browser::{
    files::{canonical, is_file, is_folder, make_folder},
    inbox::{FileInbox, GIVES, give},
    lock::FolderLock,
    repeat::repeat,
    screen::{put_report, report_place},
};
#[cfg(all(feature = "window", not(target_arch = "wasm32")))]
pub(crate) use desktop::{
    files::{canonical, is_file, is_folder, make_folder},
    inbox::{FileInbox, GIVES, give},
    lock::FolderLock,
    repeat::repeat,
    screen::{put_report, report_place},
};

#[cfg(all(feature = "window", target_arch = "wasm32"))]
pub use browser::files::usual_state;
#[cfg(all(feature = "window", not(target_arch = "wasm32")))]
pub use desktop::files::usual_state;
