//! Texts in the browser's local storage, by path.
//!
//! A path is a name there: a folder exists while something is in it.

use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use underfoot::schema::{SaveError, Saved};
use wasm_bindgen::JsValue;
use web_sys::Storage;

/// The beginning of the names of all entries of this program: other pages of the same host have entries, too.
const OURS: &str = "underfoot:";

/// The local storage.
///
/// # Errors
/// [`ErrorKind::PermissionDenied`] in a page that may store nothing, such as one in some private windows.
fn storage() -> io::Result<Storage> {
    let storage = web_sys::window().and_then(|window| window.local_storage().ok().flatten());
    let refused = || io::Error::new(ErrorKind::PermissionDenied, "this browser lets the page store nothing");
    storage.ok_or_else(refused)
}

fn key(path: &Path) -> String {
    format!("{OURS}{}", path.display())
}

/// The text of the error of a browser.
fn words(error: &JsValue) -> io::Error {
    let message = js_sys::Reflect::get(error, &"message".into()).ok().and_then(|message| message.as_string());
    io::Error::other(message.unwrap_or_else(|| "the browser refuses it".into()))
}

/// Reads the text at `path`, `most` bytes at most.
///
/// # Errors
/// [`ErrorKind::NotFound`], [`ErrorKind::FileTooLarge`], or the error of the browser.
pub(crate) fn read(path: &Path, most: u64) -> io::Result<String> {
    let text = storage()?.get_item(&key(path)).map_err(|error| words(&error))?;
    let text = text.ok_or(ErrorKind::NotFound)?;
    if text.len() as u64 > most {
        return Err(io::Error::new(ErrorKind::FileTooLarge, format!("it is larger than {most} bytes")));
    }
    Ok(text)
}

/// Writes `text` to `path`; the text before it stays beside it, as `name.bak`.
///
/// # Errors
/// [`SaveError::File`]; the old text is then unchanged.
pub(crate) fn save(text: &str, path: &Path) -> Result<Saved, SaveError> {
    match read(path, u64::MAX) {
        Ok(old) if old == text => Ok(Saved::Unchanged),
        Ok(old) => {
            let backup = PathBuf::from(format!("{}.bak", path.display()));
            write_over(&old, &backup)?;
            write_over(text, path)?;
            Ok(Saved::Replaced { backup })
        }
        Err(_) => write_over(text, path).map(|()| Saved::New),
    }
}

/// Writes `text` to `path`.
///
/// # Errors
/// [`SaveError::File`], for example if the storage is full; the old text is then unchanged.
pub(crate) fn write_over(text: &str, path: &Path) -> Result<(), SaveError> {
    let written =
        storage().and_then(|storage| storage.set_item(&key(path), text).map_err(|error| words(&error)));
    written.map_err(|source| SaveError::File { path: path.into(), doing: "writing to the browser", source })
}

/// Removes the text at `path`.
pub(crate) fn remove(path: &Path) {
    let _ = storage().map(|storage| storage.remove_item(&key(path)));
}

/// Whether there is a text at `path`.
#[cfg(feature = "window")]
pub(crate) fn is_file(path: &Path) -> bool {
    storage().is_ok_and(|storage| storage.get_item(&key(path)).is_ok_and(|text| text.is_some()))
}

/// Whether there is a text below the folder at `path`.
#[cfg(feature = "window")]
pub(crate) fn is_folder(path: &Path) -> bool {
    let Ok(storage) = storage() else { return false };
    let below = format!("{}/", key(path));
    let names = 0..storage.length().unwrap_or(0);
    names.filter_map(|index| storage.key(index).ok().flatten()).any(|name| name.starts_with(&below))
}

/// Does nothing: a folder exists as soon as something is in it.
///
/// # Errors
/// [`ErrorKind::PermissionDenied`] in a page that may store nothing.
#[cfg(feature = "window")]
pub(crate) fn make_folder(_path: &Path) -> io::Result<()> {
    storage().map(drop)
}

/// Returns `path`, which has no other name here.
///
/// # Errors
/// [`ErrorKind::NotFound`] if there is no text at `path`.
#[cfg(feature = "window")]
pub(crate) fn canonical(path: &Path) -> io::Result<PathBuf> {
    if is_file(path) { Ok(path.into()) } else { Err(ErrorKind::NotFound.into()) }
}

/// Returns the folder for data that persist between visits of the page.
#[cfg(feature = "window")]
pub fn usual_state() -> PathBuf {
    PathBuf::from("state")
}
