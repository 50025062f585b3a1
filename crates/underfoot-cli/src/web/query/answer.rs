//! Requests over HTTP: a node, one attribute of it, or `HOST_INFO`.

use std::net::TcpStream;

use serde_json::{Value, json};
use underfoot::layout::Layout;
use underfoot::runtime::SessionSnapshot;
use underfoot::serve::Reference;

use super::super::http::{self, RequestHead, turn_away};
use super::super::origin::{may_be_named, may_connect};
use super::QueryShared;
use super::tree::{Attribute, QueryNode};
use super::values::CurrentValues;

/// The name under which the floor is found.
pub(super) fn name(layout: &Layout) -> String {
    if layout.title.is_empty() { "underfoot".into() } else { format!("underfoot: {}", layout.title) }
}

/// The addresses of the layout that is on the floor.
pub(super) fn tree(shared: &QueryShared, layout: &Layout) -> QueryNode {
    let reference = Reference::of(layout, &shared.floor, &shared.prefix);
    // Packets of sensors come from boards alone.
    let is_board = |address: &str| shared.floor.boards.iter().any(|board| board.address == address);
    QueryNode::tree(&reference, layout, is_board)
}

/// Answers one request.
pub(super) fn serve(stream: TcpStream, head: &RequestHead, shared: &QueryShared) {
    let origin = head.header("origin");
    let Ok(own) = stream.local_addr() else { return };
    if !may_be_named(head.header("host"), &[]) || !may_connect(origin, own, &[]) {
        return turn_away(stream, "403 Forbidden", "this host name or page is not let in\n");
    }
    if head.method != "GET" {
        return turn_away(stream, "405 Method Not Allowed", "this server answers GET only\n");
    }
    // A page of this machine may read the answer; others were refused.
    let admits = origin.map(|origin| format!("Access-Control-Allow-Origin: {origin}\r\nVary: Origin\r\n"));
    let headers = format!(
        "Content-Type: application/json\r\nCache-Control: no-store\r\n{}",
        admits.unwrap_or_default()
    );
    match answer(head, shared) {
        Answer::Json(value) => http::answer(stream, "200 OK", &headers, value.to_string()),
        // The status has no content by its definition.
        Answer::NoContent => http::answer(stream, "204 No Content", &headers, ""),
        Answer::NoAttribute => turn_away(stream, "400 Bad Request", "there is no such attribute\n"),
        Answer::NoNode => turn_away(stream, "404 Not Found", "there is no such address\n"),
    }
}

#[derive(Debug, PartialEq)]
enum Answer {
    Json(Value),
    NoContent,
    NoAttribute,
    NoNode,
}

fn answer(head: &RequestHead, shared: &QueryShared) -> Answer {
    let SessionSnapshot { layout, floor, .. } = shared.session.snapshot();
    if head.query.as_deref() == Some("HOST_INFO") {
        return Answer::Json(host_info(shared, &layout));
    }
    let root = tree(shared, &layout);
    let Some(node) = decoded(&head.path).and_then(|path| root.find(&path)) else { return Answer::NoNode };
    let values = CurrentValues::of_floor(&layout, &floor, &shared.prefix);
    match head.query.as_deref() {
        None | Some("") => Answer::Json(node.json(&values)),
        Some(name) => match node.attribute(name, &values) {
            Attribute::Unknown => Answer::NoAttribute,
            Attribute::Absent => Answer::NoContent,
            Attribute::Present(value) => Answer::Json(json!({ name: value })),
        },
    }
}

/// Extensions of the server, and the port to which the floor listens for OSC.
fn host_info(shared: &QueryShared, layout: &Layout) -> Value {
    let mut info = json!({
        "NAME": name(layout),
        "EXTENSIONS": {
            "ACCESS": true, "VALUE": true, "RANGE": true, "DESCRIPTION": true, "TAGS": true, "UNIT": true,
            "CRITICAL": false, "CLIPMODE": false, "EXTENDED_TYPE": false, "OVERLOADS": false, "HTML": false,
            "LISTEN": true, "IGNORE": true, "PATH_CHANGED": true, "PATH_RENAMED": false, "PATH_ADDED": false,
            "PATH_REMOVED": false,
        },
        "OSC_PORT": shared.requests.port(),
        "OSC_TRANSPORT": "UDP",
        "WS_PORT": shared.own.port(),
    });
    // Without an address, a client uses the one that it has asked.
    for (name, address) in [("OSC_IP", shared.requests), ("WS_IP", shared.own)] {
        if !address.ip().is_unspecified() {
            info[name] = json!(address.ip().to_string());
        }
    }
    info
}

/// The path with the bytes that `%` encodes; `None` for a malformed one.
fn decoded(path: &str) -> Option<String> {
    let (mut bytes, mut rest) = (Vec::with_capacity(path.len()), path.bytes());
    while let Some(byte) = rest.next() {
        if byte != b'%' {
            bytes.push(byte);
            continue;
        }
        let mut digit = || char::from(rest.next()?).to_digit(16);
        let (high, low) = (digit()?, digit()?);
        bytes.push(u8::try_from(high * 16 + low).ok()?);
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::decoded;

    #[test]
    fn encoded_bytes_of_a_path_are_decoded_and_broken_ones_are_no_path() {
        assert_eq!(decoded("/a%3ab/%C3%B6").as_deref(), Some("/a:b/ö"));
        for broken in ["/%", "/%4", "/%zz", "/%ff", "/%+1"] {
            assert_eq!(decoded(broken), None, "{broken}");
        }
    }
}
