//! The screen of a page: its reports for scripts, and whether fingers use it.

use std::io;
use std::path::{Path, PathBuf};

/// The part of the address behind `?` that asks for reports.
const QUERY: &str = "?screen_report";

/// The name in the page under which scripts find the latest report.
const NAME: &str = "underfootScreen";

/// The place for reports of the screen; `None` if nobody asks for them.
pub(crate) fn report_place() -> Option<PathBuf> {
    let query = web_sys::window().and_then(|window| window.location().search().ok());
    query.is_some_and(|query| query == QUERY).then(|| PathBuf::from(NAME))
}

/// Puts the report of the window into the page; a page has one window.
///
/// # Errors
/// None in a page; outside of one, an error.
pub(crate) fn put_report(report: &str, place: &Path, _window: Option<u64>) -> io::Result<()> {
    let name = place.display().to_string();
    let put = js_sys::Reflect::set(&js_sys::global(), &name.into(), &report.into());
    put.map(drop).map_err(|_| io::Error::other("there is no page"))
}

/// Whether fingers are the usual pointers of this screen.
pub(crate) fn has_coarse_pointer() -> bool {
    let asked = web_sys::window().and_then(|window| window.match_media("(pointer: coarse)").ok().flatten());
    asked.is_some_and(|query| query.matches())
}
