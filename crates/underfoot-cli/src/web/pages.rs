//! Requests without a WebSocket: the page, the dashboard, health and metrics.

use std::net::TcpStream;

use super::http::{self, RequestHead, turn_away};
use super::origin::{may_be_named, may_connect};
use super::{Shared, watch};

const PAGE: &str = include_str!("page.html");

/// The page loads nothing from elsewhere, and no other page may frame it.
const PAGE_HEAD: &str = "Content-Type: text/html; charset=utf-8\r\nCache-Control: no-cache\r\n\
    Content-Security-Policy: default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; \
    connect-src 'self' ws:; frame-ancestors 'none'\r\nX-Content-Type-Options: nosniff\r\n";

/// Answers one request.
pub(super) fn answer(stream: TcpStream, head: &RequestHead, shared: &Shared) {
    if head.method != "GET" {
        return turn_away(stream, "405 Method Not Allowed", "this server answers GET only\n");
    }
    match head.path.as_str() {
        "/" => http::answer(stream, "200 OK", PAGE_HEAD, PAGE),
        path => match watch::Watched::at(path) {
            Some(_) if !may_read(&stream, head, shared) => turn_away(
                stream,
                "403 Forbidden",
                "this host name or page is not let in; use the numeric address, or --web-origin\n",
            ),
            Some(watched) => watched.answer(stream, shared),
            None => {
                turn_away(stream, "404 Not Found", "there are /, /dashboard, /health and /metrics here\n");
            }
        },
    }
}

/// Whether the client may read the state of the floor: by the rules for clients that read its events.
fn may_read(stream: &TcpStream, head: &RequestHead, shared: &Shared) -> bool {
    stream.local_addr().is_ok_and(|own| {
        may_be_named(head.header("host"), &shared.origins)
            && may_connect(head.header("origin"), own, &shared.origins)
    })
}
