//! Pages that exhaust resources: repeated layouts, endless requests, all connections, unread answers.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::process::{Child, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tungstenite::client::IntoClientRequest;
use tungstenite::{Message, client};

use crate::end_to_end::{Served, terminate, underfoot};
use crate::ports::free_port;
use crate::web::{free_address, stream};

/// A layout of 290 kB with a problem in each of its controls.
fn bad_layout() -> String {
    let widget = |n: usize| {
        format!(
            "(id: \"w{}\", kind: \"buton\", at: ({}, {}), size: (0.5, 0.5), label: \"one of very many\"),\n",
            n % 7,
            n % 6,
            n / 6 % 6
        )
    };
    let widgets: String = (0..)
        .map(widget)
        .scan(0, |length, widget| {
            *length += widget.len();
            (*length < 290_000).then_some(widget)
        })
        .collect();
    format!("Layout(version: 1, regions: [(id: \"all\", at: (0, 0), size: (6, 6))], widgets: [\n{widgets}])")
}

/// Clients that send requests as fast as they can, until dropped.
struct Hostile {
    over: Arc<AtomicBool>,
    asked: Arc<AtomicU64>,
    threads: Vec<JoinHandle<()>>,
}

impl Hostile {
    /// Starts `clients` clients at `path`, each of which repeats `request`.
    fn start(web: SocketAddr, path: &str, clients: usize, request: &Value) -> Self {
        let (over, asked) = (Arc::<AtomicBool>::default(), Arc::<AtomicU64>::default());
        let repeat = |_| {
            let (over, asked) = (Arc::clone(&over), Arc::clone(&asked));
            let (request, url) = (request.to_string(), format!("ws://{web}{path}"));
            thread::spawn(move || {
                while !over.load(Ordering::Relaxed) {
                    let request_of = url.as_str().into_client_request().unwrap();
                    let Ok((mut socket, _)) = client(request_of, stream(web)) else { continue };
                    // It reads sometimes; otherwise the server would drop it.
                    socket.get_ref().set_read_timeout(Some(Duration::from_millis(1))).unwrap();
                    socket.get_ref().set_write_timeout(Some(Duration::from_millis(100))).unwrap();
                    while !over.load(Ordering::Relaxed) {
                        let written = socket.send(Message::text(request.as_str()));
                        asked.fetch_add(u64::from(written.is_ok()), Ordering::Relaxed);
                        let lost = |error: &tungstenite::Error| match error {
                            tungstenite::Error::Io(error) => error.kind() != std::io::ErrorKind::WouldBlock,
                            tungstenite::Error::WriteBufferFull(_) => false,
                            _ => true,
                        };
                        let read = (0..50).map(|_| socket.read()).find(Result::is_err);
                        if written.err().is_some_and(|error| lost(&error))
                            || read.and_then(Result::err).is_some_and(|error| lost(&error))
                        {
                            break;
                        }
                    }
                }
            })
        };
        let threads = (0..clients).map(repeat).collect();
        Self { over, asked, threads }
    }
}

impl Drop for Hostile {
    fn drop(&mut self) {
        self.over.store(true, Ordering::Relaxed);
        self.threads.drain(..).for_each(|thread| drop(thread.join()));
    }
}

/// The result of playing a session on a server's floor.
#[derive(Debug)]
struct Played {
    /// Control and kind of each event.
    events: Vec<String>,
    /// Number of packets that it lost, and that the system dropped.
    lost: u64,
    /// Memory at the beginning and at the end, in bytes.
    memory: [usize; 2],
}

fn resident(child: &Child) -> usize {
    let statm = std::fs::read_to_string(format!("/proc/{}/statm", child.id())).unwrap_or_default();
    4096 * statm.split(' ').nth(1).and_then(|pages| pages.parse::<usize>().ok()).unwrap_or_default()
}

/// Plays the built-in session on a floor that is served with `--web-layouts`, beside the clients of `hostile`.
fn play(hostile: impl Fn(SocketAddr) -> Option<Hostile>) -> Played {
    let (web, sensors) = (free_address(), format!("127.0.0.1:{}", free_port()));
    let layout = concat!(env!("CARGO_MANIFEST_DIR"), "/../../layouts/map.ron");
    let mut server = underfoot()
        .args(["run", layout, "--listen", &sensors, "--json", "--no-osc", "--sound", "off"])
        .args(["--web", &web.to_string(), "--web-layouts"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map(Served)
        .unwrap();
    let mut log = BufReader::new(server.0.stderr.take().unwrap());
    let mut line = String::new();
    while !line.starts_with("Listening on") {
        line.clear();
        assert!(log.read_line(&mut line).unwrap() > 0, "it ended");
    }
    let said = thread::spawn(move || log.lines().map_while(Result::ok).collect::<Vec<String>>());
    let out = BufReader::new(server.0.stdout.take().unwrap());
    let told = thread::spawn(move || out.lines().map_while(Result::ok).collect::<Vec<String>>());
    let pages = hostile(web);
    thread::sleep(Duration::from_secs(2));
    let before = resident(&server.0);
    let simulated = underfoot().args(["simulate", "--send", &sensors]).output().unwrap();
    assert!(simulated.status.success());
    let after = resident(&server.0);
    if let Some(pages) = &pages {
        println!("{} requests", pages.asked.load(Ordering::Relaxed));
    }
    terminate(&server.0);
    server.0.wait().unwrap();
    drop(pages);
    let events = told.join().unwrap();
    let events = events.iter().map(|line| serde_json::from_str::<Value>(line).unwrap());
    let mut events: Vec<String> = events
        .filter(|line| line["id"].is_string() && line["force_n"].is_number())
        .map(|line| format!("{} {}", line["id"].as_str().unwrap(), line["event"].as_str().unwrap()))
        .collect();
    // The number of intermediate values of a slider depends on timing.
    events.dedup();
    let said = said.join().unwrap();
    Played { events, lost: lost(&said), memory: [before, after] }
}

/// Numbers of lost packets and of packets dropped by the system, in the final report.
fn lost(said: &[String]) -> u64 {
    let number = |line: &String, word: &str| {
        let at = line.find(word)?;
        line[at + word.len()..].trim_start().split([' ', ',', ';', '.']).next()?.parse::<u64>().ok()
    };
    said.iter().filter_map(|line| number(line, " lost ")).sum()
}

/// For an idle machine: eight pages that repeat a layout of 290 kB, which is refused.
#[test]
#[ignore = "takes a minute of an idle machine"]
fn eight_pages_that_repeat_a_refused_layout_cost_a_session_nothing() {
    let alone = play(|_| None);
    let layout = json!({"request": "layout", "args": [bad_layout()]});
    let beside = play(|web| Some(Hostile::start(web, "/mirror", 8, &layout)));
    println!("alone: {alone:?}\nbeside: {beside:?}");
    assert_eq!(beside.events, alone.events);
    assert!(beside.lost <= 50, "{} packets", beside.lost);
    let [before, after] = beside.memory;
    assert!(after < before + (16 << 20), "{} KiB more", after.saturating_sub(before) >> 10);
}

/// The same with eight pages that request everything endlessly.
#[test]
#[ignore = "takes a minute of an idle machine"]
fn eight_pages_that_ask_for_everything_cost_a_session_nothing() {
    let alone = play(|_| None);
    let beside = play(|web| Some(Hostile::start(web, "/", 8, &json!({"request": "get", "args": []}))));
    println!("alone: {alone:?}\nbeside: {beside:?}");
    assert_eq!(beside.events, alone.events);
    assert!(beside.lost <= 50, "{} packets", beside.lost);
}

/// A layout is checked at most once a second for each client, at any rate of requests.
#[test]
fn a_page_that_repeats_a_layout_is_told_so_and_served_all_the_same() {
    let web = free_address();
    let server = underfoot()
        .args(["run", "map", "--listen", &format!("127.0.0.1:{}", free_port()), "--no-osc", "--sound", "off"])
        .args(["--web", &web.to_string(), "--web-layouts"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .map(Served)
        .unwrap();
    let url = format!("ws://{web}/mirror");
    let (mut socket, _) = client(url.as_str().into_client_request().unwrap(), stream(web)).unwrap();
    let layout = json!({"request": "layout", "args": [bad_layout()]}).to_string();
    for _ in 0..3 {
        socket.send(Message::text(layout.as_str())).unwrap();
    }
    socket.send(Message::text(json!({"request": "widget/zoom/set", "args": [0.5]}).to_string())).unwrap();
    let (mut whys, mut is_set) = (Vec::new(), false);
    // Layouts are checked while a core is idle, which may take a while beside other tests.
    let end = Instant::now() + Duration::from_secs(300);
    while whys.len() < 3 || !is_set {
        assert!(Instant::now() < end, "{whys:?}, set: {is_set}");
        let Ok(Message::Text(text)) = socket.read() else { continue };
        let line: Value = serde_json::from_str(&text).unwrap();
        if line["event"] == "error" {
            whys.push(line["why"].as_str().unwrap().to_owned());
        }
        is_set |= line["event"] == "state" && line["id"] == "zoom" && line["value"] == json!(0.5);
    }
    let too_often = whys.iter().filter(|why| why.contains("one layout a second")).count();
    let checked: Vec<_> = whys.iter().filter(|why| why.contains("unknown kind \"buton\"")).collect();
    assert_eq!((too_often, checked.len()), (2, 1), "{whys:?}");
    assert!(checked[0].len() < 5000 && checked[0].contains("errors and"), "{} bytes", checked[0].len());
    drop(server);
}

/// A refused client that does not read the refusal delays no later client.
#[test]
fn places_that_are_taken_are_refused_at_once_and_free_again_when_somebody_goes() {
    let web = free_address();
    let server = underfoot()
        .args(["run", "map", "--listen", &format!("127.0.0.1:{}", free_port()), "--no-osc", "--sound", "off"])
        .args(["--web", &web.to_string()])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .map(Served)
        .unwrap();
    let join = || client(format!("ws://{web}/").as_str(), stream(web)).ok();
    let mut inside: Vec<_> = (0..16).map(|_| join().unwrap().0).collect();
    // They neither send a request nor read the answer.
    let idle: Vec<TcpStream> = (0..40).map(|_| stream(web)).collect();
    assert!(join().is_none(), "there were sixteen already");
    inside.pop();
    let begun = Instant::now();
    loop {
        match join() {
            Some((socket, _)) => break inside.push(socket),
            None => assert!(begun.elapsed() < Duration::from_secs(30), "nobody is let in any more"),
        }
        // The others stay, like pages.
        for socket in &mut inside {
            let _ = socket.get_ref().set_nonblocking(true);
            while socket.read().is_ok() {}
        }
        thread::sleep(Duration::from_millis(20));
    }
    let mut page = String::new();
    drop(inside);
    let end = Instant::now() + Duration::from_secs(30);
    while !page.contains("<canvas") {
        assert!(Instant::now() < end, "the page is not served: {page}");
        page.clear();
        let mut asked = stream(web);
        asked.set_read_timeout(Some(Duration::from_secs(2))).unwrap();
        write!(asked, "GET /plain HTTP/1.1\r\nHost: {web}\r\n\r\n").unwrap();
        let _ = asked.read_to_string(&mut page);
    }
    drop((idle, server));
}
