//! The files of the server's pages, with the policies under which browsers show them.

use std::net::TcpStream;

use super::http::{self, RequestHead, turn_away};

/// The policy of a page that loads its own files and asks this server alone, without inline scripts and styles; no other
/// page may frame it.
pub(super) const POLICY: &str = "Content-Security-Policy: default-src 'none'; script-src 'self'; style-src 'self'; \
    img-src data:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r\n\
    Referrer-Policy: no-referrer\r\n";

/// The bytes of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum FileContent {
    /// Sent as they are.
    Text(&'static str),
    /// Compressed by gzip, of this version of the web edition: a browser that has the same version keeps its own.
    #[cfg_attr(
        not(feature = "web-edition"),
        allow(dead_code, reason = "the web edition alone is compressed")
    )]
    Packed(&'static [u8], &'static str),
}

/// A file of a page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PageFile {
    /// Its type, as in the header of that name.
    pub(super) kind: &'static str,
    /// Headers with its policy, each with a line break.
    pub(super) policy: &'static str,
    /// Its content.
    pub(super) content: FileContent,
}

impl PageFile {
    /// A file of this type under the strict policy.
    pub(super) const fn text(kind: &'static str, text: &'static str) -> Self {
        Self { kind, policy: POLICY, content: FileContent::Text(text) }
    }

    /// Sends it.
    pub(super) fn answer(self, stream: TcpStream, asked: &RequestHead) {
        let Self { kind, policy, content } = self;
        let head = |more: &str| {
            format!(
                "Content-Type: {kind}\r\n{more}X-Content-Type-Options: nosniff\r\n\
                 Cross-Origin-Resource-Policy: same-origin\r\n{policy}"
            )
        };
        let (bytes, version) = match content {
            FileContent::Text(text) => {
                return http::answer(stream, "200 OK", &head("Cache-Control: no-store\r\n"), text);
            }
            FileContent::Packed(bytes, version) => (bytes, version),
        };
        let tag = format!("\"{}\"", version.trim());
        let caching = format!("Cache-Control: no-cache\r\nETag: {tag}\r\n");
        if asked.header("if-none-match").is_some_and(|known| known.contains(&tag)) {
            return http::answer(stream, "304 Not Modified", &head(&caching), "");
        }
        if !asked.header("accept-encoding").is_some_and(|known| known.contains("gzip")) {
            let why =
                "this page is kept compressed: ask for it with `Accept-Encoding: gzip`, as browsers do\n";
            return turn_away(stream, "406 Not Acceptable", why);
        }
        http::answer(stream, "200 OK", &head(&(caching + "Content-Encoding: gzip\r\n")), bytes);
    }
}
