//! The service worker of a page from static files, where a floor now serves its own page at the same address.

use super::file::PageFile;

/// The script that removes that worker. Browsers ask for it each time that the worker has shown a page; the pages of
/// this server register none.
pub(super) fn file(path: &str) -> Option<PageFile> {
    let script = PageFile::text("text/javascript; charset=utf-8", include_str!("leftover.js"));
    (path == "/offline.js").then_some(script)
}
