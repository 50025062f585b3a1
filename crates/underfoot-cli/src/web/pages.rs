//! Requests without a WebSocket: the web edition, the plain page, the dashboard, health and metrics.

use std::net::TcpStream;

use super::http::{RequestHead, turn_away};
use super::origin::{may_be_named, may_connect};
use super::watch::{Watched, dashboard};
use super::{Shared, edition, leftover, plain};

/// Answers one request.
pub(super) fn answer(stream: TcpStream, head: &RequestHead, shared: &Shared) {
    if head.method != "GET" {
        return turn_away(stream, "405 Method Not Allowed", "this server answers GET only\n");
    }
    // Also the pages, which tell nothing of the floor: there they could not connect, and would not say why.
    if !may_read(&stream, head, shared) {
        return turn_away(
            stream,
            "403 Forbidden",
            "this host name or page is not let in; use the numeric address, or --web-origin\n",
        );
    }
    let path = head.path.as_str();
    let pages = edition::file(path).or_else(|| plain::file(path)).or_else(|| dashboard::file(path));
    let file = pages.or_else(|| leftover::file(path));
    if let Some(file) = file.or((path == "/").then_some(plain::PAGE)) {
        return file.answer(stream, head);
    }
    match Watched::at(path) {
        Some(watched) => watched.answer(stream, shared),
        None => {
            let paths = "there are /, /plain, /dashboard, /health and /metrics here\n";
            turn_away(stream, "404 Not Found", paths);
        }
    }
}

/// Whether the server has the web edition.
pub(super) fn has_edition() -> bool {
    edition::file("/").is_some()
}

/// Whether the client may read the state of the floor: by the rules for clients that read its events.
fn may_read(stream: &TcpStream, head: &RequestHead, shared: &Shared) -> bool {
    stream.local_addr().is_ok_and(|own| {
        may_be_named(head.header("host"), &shared.origins)
            && may_connect(head.header("origin"), own, &shared.origins)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::web::file::FileContent;

    fn text(path: &str) -> &'static str {
        let file = plain::file(path).or_else(|| dashboard::file(path));
        match file.map(|file| file.content) {
            Some(FileContent::Text(text)) => text,
            _ => "",
        }
    }

    #[test]
    fn pages_have_nothing_that_their_policy_refuses() {
        for page in ["/plain", "/dashboard"] {
            let (html, script) = (text(page), text(&format!("{page}.js")));
            assert!(html.contains(&format!(r#"src="{page}.js""#)), "{page}");
            assert!(html.contains(&format!(r#"href="{page}.css""#)), "{page}");
            for inline in ["<style", " style=", "onclick", "onload", "http:", "https:", "<script>"] {
                assert!(!html.contains(inline), "{page}: {inline}");
            }
            // Texts come from files and boards: none becomes markup.
            for dangerous in
                ["innerHTML", "outerHTML", "insertAdjacentHTML", "document.write", "eval(", ".style"]
            {
                assert!(!script.contains(dangerous), "{page}: {dangerous}");
            }
        }
    }
}
