//! The screen of a desktop: its reports as files; a mouse uses it.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The environment variable with the folder of the reports.
const VARIABLE: &str = "UNDERFOOT_SCREEN_REPORT";

/// The place for reports of the screen; `None` if nobody asks for them.
pub(crate) fn report_place() -> Option<PathBuf> {
    std::env::var_os(VARIABLE).map(PathBuf::from)
}

/// Puts the report of a window into a file of the folder `place`: the number of the process, and for all but the main
/// window the number `window`. It replaces the last one at once: a script never reads half of it.
///
/// # Errors
/// The error of the system.
pub(crate) fn put_report(report: &str, place: &Path, window: Option<u64>) -> io::Result<()> {
    let number = window.map_or_else(String::new, |window| format!("-{window:016x}"));
    let path = place.join(format!("{}{number}.json", std::process::id()));
    let new = path.with_extension("new");
    fs::write(&new, report)?;
    fs::rename(&new, path)
}

/// Whether fingers are the usual pointers of this screen; a mouse is on a desktop, until a finger comes.
pub(crate) const fn has_coarse_pointer() -> bool {
    false
}
