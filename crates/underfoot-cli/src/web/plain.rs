//! The plain page: controls, values, holds and feet, without WebAssembly; in three files, so that its policy admits no
//! inline script.

use super::file::PageFile;

/// The page itself.
pub(super) const PAGE: PageFile = PageFile::text("text/html; charset=utf-8", include_str!("plain.html"));

/// The file of the plain page at this path.
pub(super) fn file(path: &str) -> Option<PageFile> {
    match path {
        "/plain" => Some(PAGE),
        "/plain.css" => Some(PageFile::text("text/css; charset=utf-8", include_str!("plain.css"))),
        "/plain.js" => Some(PageFile::text("text/javascript; charset=utf-8", include_str!("plain.js"))),
        _ => None,
    }
}
