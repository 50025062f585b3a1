//! W2, W3, W5 and W6: web clients that send too much, are too many, or send invalid messages.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tungstenite::{Message, WebSocket, client};

use super::live::Live;
use super::tape::BUTTON;
use crate::web::{free_address, stream};

/// Time-out for an event that must happen.
const AT_LAST: Duration = Duration::from_secs(60);

/// A floor with a web server.
fn serve() -> (Live, SocketAddr) {
    let web = free_address();
    (Live::start(BUTTON, &["--web", &web.to_string()]), web)
}

/// A connection that the server has answered, or its refusal.
fn connect(web: SocketAddr) -> Result<WebSocket<TcpStream>, String> {
    let stream = stream(web);
    stream.set_read_timeout(Some(Duration::from_secs(5))).unwrap();
    client(format!("ws://{web}/"), stream).map(|(socket, _)| socket).map_err(|error| error.to_string())
}

/// A connection, retried while the places of other clients are not free yet.
fn connected(web: SocketAddr) -> WebSocket<TcpStream> {
    let end = Instant::now() + AT_LAST;
    loop {
        match connect(web) {
            Ok(socket) => return socket,
            Err(why) => assert!(Instant::now() < end, "{why}"),
        }
        std::thread::sleep(Duration::from_millis(50));
    }
}

fn ask(socket: &mut WebSocket<TcpStream>, request: &str, args: &Value) {
    socket.send(Message::text(json!({"request": request, "args": args}).to_string())).unwrap();
}

/// Reads until a line for which `wanted` holds.
fn hear_until(socket: &mut WebSocket<TcpStream>, what: &str, wanted: impl Fn(&Value) -> bool) {
    let end = Instant::now() + AT_LAST;
    loop {
        assert!(Instant::now() < end, "never heard: {what}");
        match socket.read() {
            Ok(Message::Text(text)) if wanted(&serde_json::from_str(&text).unwrap()) => return,
            Ok(_) => {}
            Err(error) => panic!("{what}: {error}"),
        }
    }
}

/// Checks that a client is served: it sends a request, which is done.
fn is_served(socket: &mut WebSocket<TcpStream>, label: &str) {
    ask(socket, "widget/it/label", &json!([label]));
    hear_until(socket, label, |line| line["event"] == "state" && line["label"] == label);
}

/// Checks that the floor works: no press so far, a press by a foot, and a normal end of the program.
fn works_still(live: Live) {
    assert_eq!(live.count("it pressed"), 0);
    live.tap_until_it_clicks();
    let (code, said) = live.end();
    assert_eq!(code, Some(0), "{said}");
    assert!(!said.contains("panicked"), "{said}");
}

// W2
#[test]
fn a_page_that_asks_too_much_takes_nothing_from_others() {
    let (live, web) = serve();
    let mut loud = connected(web);
    let mut quiet = connected(web);
    let flood = std::thread::spawn(move || {
        let request = json!({"request": "widget/it/label", "args": ["loud"]}).to_string();
        let end = Instant::now() + Duration::from_secs(3);
        let mut sent = 0_u32;
        // It reads nothing, and is dropped for that at last.
        while Instant::now() < end && loud.send(Message::text(request.clone())).is_ok() {
            sent += 1;
        }
        sent
    });
    for number in 0..20 {
        is_served(&mut quiet, &format!("quiet {number}"));
    }
    let sent = flood.join().unwrap();
    assert!(sent > 500, "{sent}");
    is_served(&mut quiet, "and afterwards");
    works_still(live);
}

// W3
#[test]
fn clients_beyond_the_room_there_is_are_refused_until_one_leaves() {
    let (live, web) = serve();
    let mut inside = Vec::new();
    let mut refused = Vec::new();
    for _ in 0..40 {
        match connect(web) {
            Ok(socket) => inside.push(socket),
            Err(why) => refused.push(why),
        }
    }
    assert!((2..=16).contains(&inside.len()), "{} are let in", inside.len());
    assert!(refused.iter().all(|why| why.contains("503") || why.contains("reset")), "{refused:?}");
    drop(inside);
    let mut socket = connected(web);
    is_served(&mut socket, "one of few");
    works_still(live);
}

// W5
#[test]
fn a_client_that_never_says_what_it_wants_is_closed() {
    let (live, web) = serve();
    let slow: Vec<TcpStream> = (0..4).map(|_| stream(web)).collect();
    let mut long = stream(web);
    // Longer than a head may be; the server may close before all of it is sent.
    let _ = long.write_all(format!("GET / HTTP/1.1\r\nX: {}\r\n", "x".repeat(100_000)).as_bytes());
    for mut stream in slow.into_iter().chain([long]) {
        stream.set_read_timeout(Some(AT_LAST)).unwrap();
        let mut answer = Vec::new();
        // Closed, with or without a message, well before the test's time-out.
        if let Err(error) = stream.read_to_end(&mut answer) {
            assert_eq!(error.kind(), std::io::ErrorKind::ConnectionReset);
        }
        assert!(!answer.starts_with(b"HTTP/1.1 200"), "{}", String::from_utf8_lossy(&answer));
    }
    is_served(&mut connected(web), "somebody polite");
    works_still(live);
}

// W6
#[test]
fn requests_that_are_none_end_at_most_their_own_connection() {
    let (live, web) = serve();
    let mut other = connected(web);
    let mut bad = vec![
        Message::text("no JSON"),
        Message::text("{\"request\": 7}"),
        Message::text("[".repeat(4000)),
        Message::text(json!({"request": "widget/it/label", "args": ["x".repeat(3000)]}).to_string()),
        Message::text(json!({"request": "widget/it/set", "args": [1e308, -1e308, null]}).to_string()),
        Message::text(json!({"request": "../../etc/passwd", "args": []}).to_string()),
        Message::text("x".repeat(1 << 20)),
        Message::binary(vec![0xff; 4000]),
    ];
    for message in bad.drain(..) {
        let mut socket = connected(web);
        // The server may close while it is sent.
        let _ = socket.send(message);
        let _ = socket.get_mut().write_all(&[0x81, 0xff, 0xff]);
    }
    let mut raw = connected(web);
    // A text frame that is not UTF-8, and an incomplete one.
    let _ = raw.get_mut().write_all(&[0x81, 0x84, 0, 0, 0, 0, 0xff, 0xfe, 0xfd, 0xfc]);
    let _ = raw.get_mut().write_all(&[0x81, 0xff, 0x7f, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff]);
    is_served(&mut other, "somebody polite");
    works_still(live);
}
