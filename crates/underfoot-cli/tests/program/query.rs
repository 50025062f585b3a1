//! OSCQuery of a running floor, over real sockets: the requests of the proposal, and clients of others.

use std::io::{Read, Write};
use std::net::SocketAddr;
use std::time::{Duration, Instant};

use rosc::OscPacket;
use serde_json::{Value, json};
use tungstenite::{Message, WebSocket, client};

use crate::clients::try_script;
use crate::holds::client::Client;
use crate::holds::site::{Boards, Run, Site};
use crate::web::{answer, free_address, stream};

/// Time-out for an event that must happen.
const AT_LAST: Duration = Duration::from_secs(30);

fn run(site: &Site) -> (Run, SocketAddr) {
    let query = free_address();
    let others = Client::new();
    let run = site.run(&others, &[&format!("--discover={query}")]);
    (run, query)
}

/// The status of the answer and its body, which is null if it is no JSON.
fn get(query: SocketAddr, path: &str) -> (u16, Value) {
    let said = answer(query, path, "");
    let (head, body) = said.split_once("\r\n\r\n").unwrap_or_else(|| panic!("{path}: {said:?}"));
    let status = head.split(' ').nth(1).unwrap().parse().unwrap();
    (status, serde_json::from_str(body).unwrap_or_default())
}

#[test]
fn a_client_browses_the_addresses_of_the_layout() {
    let site = Site::new();
    let (run, query) = run(&site);
    let (status, root) = get(query, "/");
    assert_eq!((status, &root["FULL_PATH"], &root["ACCESS"]), (200, &json!("/"), &json!(0)));
    let zoom = &root["CONTENTS"]["underfoot"]["CONTENTS"]["widget"]["CONTENTS"]["zoom"]["CONTENTS"];
    assert_eq!((&zoom["value"]["TYPE"], &zoom["value"]["ACCESS"]), (&json!("f"), &json!(1)));
    assert_eq!(zoom["set"]["ACCESS"], 2);
    assert_eq!(zoom["set"]["RANGE"], json!([{"MIN": 0.0, "MAX": 1.0}]));
    assert_eq!(zoom["changed"]["UNIT"], json!([null, "N", "distance.m", "distance.m"]));
    // The whole tree has the very nodes that single requests have.
    let path = "/underfoot/widget/zoom/changed";
    assert_eq!(get(query, path), (200, zoom["changed"].clone()));
    assert_eq!(get(query, "/underfoot/widget/zoom/value?VALUE"), (200, json!({"VALUE": [0.0]})));
    // Without a value, an unknown attribute, an unknown address.
    assert_eq!(get(query, &format!("{path}?VALUE")).0, 204);
    assert_eq!(get(query, &format!("{path}?COLOUR")).0, 400);
    assert_eq!(get(query, "/underfoot/widget/zom").0, 404);
    let (_, info) = get(query, "/?HOST_INFO");
    assert_eq!((&info["OSC_PORT"], &info["OSC_TRANSPORT"]), (&json!(run.address.port()), &json!("UDP")));
    assert_eq!((&info["WS_PORT"], &info["EXTENSIONS"]["LISTEN"]), (&json!(query.port()), &json!(true)));
}

/// The next OSC message, within a time in which it must come.
fn next_message(socket: &mut WebSocket<std::net::TcpStream>) -> Option<rosc::OscMessage> {
    match socket.read() {
        Ok(Message::Binary(bytes)) => match rosc::decoder::decode_udp(&bytes).unwrap().1 {
            OscPacket::Message(message) => Some(message),
            OscPacket::Bundle(_) => panic!("a bundle is no message of one address"),
        },
        Ok(_) => None,
        Err(tungstenite::Error::Io(error)) if error.kind() == std::io::ErrorKind::WouldBlock => None,
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn a_client_hears_what_it_listens_to_and_the_value_that_a_foot_has_set() {
    let site = Site::new();
    let (run, query) = run(&site);
    let (mut socket, _) = client(format!("ws://{query}/"), stream(query)).unwrap();
    socket.get_ref().set_read_timeout(Some(Duration::from_millis(20))).unwrap();
    let command = |socket: &mut WebSocket<_>, command: &str, data: &str| {
        let text = json!({"COMMAND": command, "DATA": data}).to_string();
        socket.send(Message::text(text)).unwrap();
    };
    let pressed = "/underfoot/widget/drive/pressed";
    command(&mut socket, "LISTEN", pressed);
    command(&mut socket, "LISTEN", "/underfoot/alive");
    // None of these is an address that it could listen to.
    command(&mut socket, "LISTEN", "/underfoot/nothing");
    command(&mut socket, "FLY", "/underfoot/alive");
    socket.send(Message::text("no command")).unwrap();
    let boards = Boards::start(&site, run.address);
    let (end, mut heard) = (Instant::now() + AT_LAST, Vec::new());
    while !heard.iter().any(|address| address == pressed) {
        heard.extend(next_message(&mut socket).map(|message| message.addr));
        assert!(Instant::now() < end, "{heard:?}");
    }
    assert!(heard.iter().all(|address| address == pressed || address == "/underfoot/alive"), "{heard:?}");
    command(&mut socket, "IGNORE", "/underfoot/alive");
    let begun = Instant::now();
    let mut late = 0;
    while begun.elapsed() < Duration::from_secs(1) {
        let is_late = next_message(&mut socket).is_some() && begun.elapsed() > Duration::from_millis(300);
        late += usize::from(is_late);
    }
    assert_eq!(late, 0, "it had ignored the address");
    assert_eq!(get(query, "/underfoot/health?VALUE").1["VALUE"][0], "live");
    drop(boards);
}

// P13
#[test]
fn hostile_clients_of_osc_query_get_nothing_and_take_nothing() {
    let site = Site::new();
    let (run, query) = run(&site);
    let boards = Boards::start(&site, run.address);
    let slow: Vec<_> = (0..4)
        .map(|_| {
            let mut slow = stream(query);
            slow.write_all(b"GET / HTTP/1.1\r\nHost:").unwrap();
            slow
        })
        .collect();
    for path in ["/../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "/underfoot/../..", "/%ff", "/%", "//"] {
        let (status, _) = get(query, path);
        assert!(status == 404 || path == "//", "{path}: {status}");
    }
    let mut huge = stream(query);
    let _ = huge.write_all(format!("GET / HTTP/1.1\r\nX: {}\r\n\r\n", "x".repeat(20_000)).as_bytes());
    let mut said = Vec::new();
    // A connection that is cut is as good as one that is closed.
    let _ = huge.read_to_end(&mut said);
    assert!(said.is_empty(), "{}", String::from_utf8_lossy(&said));
    assert!(answer(query, "/", "Origin: https://evil.example\r\n").starts_with("HTTP/1.1 403"));
    let upgrade = "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n\
        Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nOrigin: https://evil.example\r\n";
    assert!(answer(query, "/", upgrade).starts_with("HTTP/1.1 403"));
    for mut slow in slow {
        slow.set_read_timeout(Some(AT_LAST)).unwrap();
        let _ = slow.read_to_end(&mut said);
        assert!(said.is_empty(), "a request without an end has no answer");
    }
    assert_eq!(get(query, "/underfoot/health?VALUE").1["VALUE"][0], "live", "the floor goes on");
    drop(boards);
}

/// `./dev test` prints beforehand whether this test will run: `pip install zeroconf`.
#[test]
fn zeroconf_of_python_finds_the_floor_and_sees_it_leave() {
    try_script("discover.py", &[]);
}
