//! `/dashboard`: a page that shows `/health`, in three files of its own so that its policy admits no inline script.

use crate::web::file::PageFile;

/// The dashboard's file at this path.
pub(in crate::web) fn file(path: &str) -> Option<PageFile> {
    match path {
        "/dashboard" => Some(PageFile::text("text/html; charset=utf-8", include_str!("dashboard.html"))),
        "/dashboard.css" => Some(PageFile::text("text/css; charset=utf-8", include_str!("dashboard.css"))),
        "/dashboard.js" => {
            Some(PageFile::text("text/javascript; charset=utf-8", include_str!("dashboard.js")))
        }
        _ => None,
    }
}
