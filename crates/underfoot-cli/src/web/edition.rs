//! The web edition, the whole window in a browser, if it was built in; without it, the plain page takes its place.
//!
//! `./dev web` makes the files, and `./dev run` and the packages build them in: with the feature `web-edition`, and the
//! folder of the compressed files in the variable `UNDERFOOT_WEB_PACKED`. A plain build thus needs no WebAssembly.

use super::file::PageFile;

/// The file of the web edition at this path, if it was built in.
#[cfg(not(feature = "web-edition"))]
pub(super) const fn file(_path: &str) -> Option<PageFile> {
    None
}

#[cfg(feature = "web-edition")]
pub(super) use built_in::file;

#[cfg(feature = "web-edition")]
mod built_in {
    use super::PageFile;
    use crate::web::file::FileContent;

    /// As that of the other pages, and with WebAssembly.
    const POLICY: &str = "Content-Security-Policy: default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; \
        style-src 'self'; img-src 'self' data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; \
        frame-ancestors 'none'\r\nReferrer-Policy: no-referrer\r\n";

    /// Where the page joins the floor; in the files of a static server, this module says that there is none.
    const SERVED: &str = "export const mirror = \"/mirror\";\n";

    /// The bytes of a file that `./dev web` has compressed.
    macro_rules! packed {
        ($name:literal) => {
            FileContent::Packed(
                include_bytes!(concat!(
                    env!("UNDERFOOT_WEB_PACKED", "the feature `web-edition` needs the files of `./dev web`, and \
                        their folder target/web-packed in UNDERFOOT_WEB_PACKED, from the root of the system"),
                    "/",
                    $name,
                    ".gz"
                )),
                include_str!(concat!(env!("UNDERFOOT_WEB_PACKED"), "/version")),
            )
        };
    }

    /// The file of the web edition at this path.
    pub(in crate::web) fn file(path: &str) -> Option<PageFile> {
        const SCRIPT: &str = "text/javascript; charset=utf-8";
        let (kind, content) = match path {
            "/" => ("text/html; charset=utf-8", packed!("index.html")),
            "/page.css" => ("text/css; charset=utf-8", packed!("page.css")),
            "/page.js" => (SCRIPT, packed!("page.js")),
            "/files.js" => (SCRIPT, packed!("files.js")),
            "/served.js" => (SCRIPT, FileContent::Text(SERVED)),
            "/underfoot.js" => (SCRIPT, packed!("underfoot.js")),
            "/underfoot.wasm" => ("application/wasm", packed!("underfoot.wasm")),
            _ => return None,
        };
        Some(PageFile { kind, policy: POLICY, content })
    }
}
