//! Windows that join a server: sensing, the loss of the server, and permissions.

use std::io::{self, BufRead, BufReader, Write};
use std::net::{SocketAddr, TcpStream, UdpSocket};
use std::process::Stdio;
use std::sync::mpsc::Receiver;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tungstenite::client::IntoClientRequest;
use tungstenite::{Message, WebSocket, client};
use underfoot::engine::Snapshot;
use underfoot::floor::{Floor, Geometry};
use underfoot::mirror::{Follower, Greeting, MirrorLink, MirrorNews, MirrorSource};
use underfoot::runtime::Session;
use underfoot::schema::{Kinds, parse_layout};
use underfoot::sense::Method;
use underfoot::sink::JsonSink;
use underfoot::source::FloorInput;
use underfoot::units;
use underfoot::wire::{LinkState, Readings, SensorEncoder, SensorFormat, SensorPacket};

use super::end_to_end::{Served, terminate, underfoot};
use super::web::{free_address, signal, stream};
use crate::holds::client::Client as OtherClient;
use crate::holds::site::{Boards, Run, Site};
use crate::ports::free_port;
use crate::steady::while_time_is_kept;

/// Time-out for an event that must happen.
const AT_LAST: Duration = Duration::from_secs(30);

/// Interval at which a server checks layouts of one client, and a little more.
const A_SECOND: Duration = Duration::from_millis(1050);

fn wait_until(what: &str, mut happened: impl FnMut() -> bool) {
    let end = Instant::now() + AT_LAST;
    while !happened() {
        assert!(Instant::now() < end, "never happened: {what}");
        thread::sleep(Duration::from_millis(1));
    }
}

/// Lines of JSON in memory.
#[derive(Clone, Default)]
struct ClientLines(Arc<Mutex<Vec<u8>>>);

impl Write for ClientLines {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().unwrap().extend(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl ClientLines {
    fn text(&self) -> String {
        String::from_utf8(self.0.lock().unwrap().clone()).unwrap()
    }
}

/// A floor that has joined a server, as a window does, with its reports.
struct Joined {
    greeting: Box<Greeting>,
    session: Session,
    lines: ClientLines,
    left_out: Box<dyn Fn() -> u64 + Send>,
}

impl Joined {
    fn of(greeting: Box<Greeting>, source: MirrorSource) -> Self {
        let (lines, clock, left_out) = (ClientLines::default(), source.clock(), source.left_out());
        let session = Session::source(source, clock)
            .floor(greeting.floor.clone())
            .layout(greeting.layout.clone())
            .method(greeting.method)
            .sink(JsonSink::new(lines.clone()).unwrap())
            .start()
            .unwrap();
        Self { greeting, session, lines, left_out: Box::new(left_out) }
    }

    fn held(&self) -> Vec<String> {
        let mut held: Vec<String> =
            self.session.snapshot().floor.held.iter().map(|id| id.as_str().to_owned()).collect();
        held.sort();
        held
    }

    fn link(&self) -> LinkState {
        self.session.snapshot().floor.link
    }

    /// Ends it and returns all its reports.
    fn end(self) -> Vec<Value> {
        drop(self.session);
        self.lines.text().lines().map(|line| serde_json::from_str(line).unwrap()).collect()
    }
}

/// The next joined floor.
fn joined(news: &Receiver<MirrorNews>) -> Joined {
    let end = Instant::now() + AT_LAST;
    loop {
        if let Ok(MirrorNews::Joined(greeting, source)) = news.recv_timeout(Duration::from_secs(1)) {
            return Joined::of(greeting, source);
        }
        assert!(Instant::now() < end, "never joined");
    }
}

fn join(web: SocketAddr) -> (MirrorLink, Receiver<MirrorNews>, Joined) {
    let (link, news) = MirrorLink::start(web).unwrap();
    let joined = joined(&news);
    (link, news, joined)
}

fn run_at(site: &Site, web: SocketAddr, more: &[&str]) -> Run {
    site.run(&OtherClient::new(), &[&["--web", &web.to_string()], more].concat())
}

/// The events of controls: time, control, kind, value and force.
fn about_controls(lines: Vec<Value>) -> Vec<Value> {
    lines.into_iter().filter(|line| line["force_n"].is_number() && line["id"].is_string()).collect()
}

/// Whether both report the same event. A layout that is read again may differ by a rounding, and a busy server reads
/// its clock at other times: so numbers may differ, and times by some microseconds. Where these decide whether a time
/// limit is over, the event is of the next frame, with the force of that one: walking changes it by 14 N in a
/// millisecond at most.
fn is_same(there: &Value, here: &Value) -> bool {
    let same = |field: &str| there[field] == here[field];
    let near = |field: &str, tolerance: f64| match (there[field].as_f64(), here[field].as_f64()) {
        (Some(there), Some(here)) => (there - here).abs() <= tolerance,
        _ => there[field] == here[field],
    };
    let is_next_frame = !near("t_s", 5e-4);
    same("event")
        && same("id")
        && same("contact")
        && near("t_s", 1.1e-3)
        && near("value", 1e-3)
        && near("force_n", if is_next_frame { 14.1 } else { 0.1 })
        && near("x_m", 1e-3)
        && near("y_m", 1e-3)
}

/// Whether both report the same events, as far as both lists go.
fn begin_alike(there: &[Value], here: &[Value]) -> bool {
    there.iter().zip(here).all(|(there, here)| is_same(there, here))
}

/// A layout without controls that act while they are held.
const HARMLESS: &str = r#"Layout(
    version: 1,
    regions: [(id: "all", at: (0, 0), size: (3, 2))],
    widgets: [(id: "zoom", kind: "slider", at: (1.2, 0), size: (1.8, 0.9))],
)"#;

// J1, J2
#[test]
fn a_window_that_joins_senses_what_the_server_tells_and_loses_it_with_the_server() {
    let site = Site::new();
    let web = free_address();
    let mut run = run_at(&site, web, &[]);
    let out = BufReader::new(run.child.stdout.take().unwrap());
    let told = thread::spawn(move || out.lines().map_while(Result::ok).collect::<Vec<String>>());
    let (_link, news, window) = join(web);
    assert_eq!(window.greeting.floor.tare, site.floor.tare);
    let boards = Boards::start(&site, run.address);
    wait_until("both are held here", || window.held() == ["drive", "zoom"]);
    wait_until("two feet", || window.session.snapshot().floor.contacts.len() == 2);

    // Killed, without a closing message.
    signal(&run, "KILL");
    wait_until("the link is lost", || window.link() == LinkState::Lost);
    assert!(window.held().is_empty() && window.session.snapshot().floor.contacts.is_empty());
    wait_until("it is told why", || matches!(news.try_recv(), Ok(MirrorNews::Lost(_))));
    run.child.wait().unwrap();
    let told: Vec<Value> =
        told.join().unwrap().iter().filter_map(|line| serde_json::from_str(line).ok()).collect();
    assert_eq!((window.left_out)(), 0);
    let (there, here) = (about_controls(told), about_controls(window.end()));
    let pressed = there.iter().filter(|line| line["event"] == "pressed").count();
    assert!(pressed == 2 && there.len() > 3, "{there:?}");
    // Holds at the time of the server's end are cancelled here.
    let same = there.len().min(here.len());
    assert!(same > 3 && begin_alike(&there, &here), "{there:#?}\n{here:#?}");
    assert!(
        here[same..].iter().all(|line| line["event"] == "cancelled" || line["event"] == "changed"),
        "{here:#?}"
    );

    // After a restart, the window joins again by itself.
    let run = run_at(&site, web, &[]);
    drop(boards);
    let _boards = Boards::start(&site, run.address);
    let window = joined(&news);
    wait_until("packets come again", || window.link() == LinkState::Live);
}

#[test]
fn the_papers_floor_at_a_thousand_hertz_comes_over_whole() {
    // A server that stands still sees some frames later than a window does.
    while_time_is_kept(15, || {
        let (web, sensors) = (free_address(), format!("127.0.0.1:{}", free_port()));
        let layout = concat!(env!("CARGO_MANIFEST_DIR"), "/../../layouts/map.ron");
        let mut server = underfoot()
            .args(["run", layout, "--listen", &sensors, "--json", "--no-osc", "--web", &web.to_string()])
            .args(["--sound", "off"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .map(Served)
            .unwrap();
        let out = BufReader::new(server.0.stdout.take().unwrap());
        let told = thread::spawn(move || out.lines().map_while(Result::ok).collect::<Vec<String>>());
        let (_link, _news, window) = join(web);
        let simulated = underfoot().args(["simulate", "--send", &sensors]).output().unwrap();
        assert!(simulated.status.success());
        wait_until("the link is lost", || window.link() == LinkState::Lost);
        let (counters, left_out) = (window.session.snapshot().floor.counters, (window.left_out)());
        terminate(&server.0);
        let told: Vec<Value> =
            told.join().unwrap().iter().filter_map(|line| serde_json::from_str(line).ok()).collect();
        let (there, here) = (about_controls(told), about_controls(window.end()));
        assert!(there.len() > 10, "{there:?}");
        assert!(here.len() == there.len() && begin_alike(&there, &here), "{there:#?}\n{here:#?}");
        assert!(counters.packets > 100_000 && left_out == 0, "{counters:?}");
        assert_eq!((counters.malformed, counters.lost), (0, 0), "{counters:?}");
    });
}

fn raw(web: SocketAddr) -> WebSocket<TcpStream> {
    client(format!("ws://{web}/mirror"), stream(web)).unwrap().0
}

// J3
#[test]
fn a_window_that_does_not_read_is_dropped_and_counted_and_others_go_on() {
    let site = Site::new();
    let web = free_address();
    let mut run = run_at(&site, web, &[]);
    let stalled = raw(web);
    let (_link, _news, window) = join(web);
    let _boards = Boards::start(&site, run.address);
    // A page that receives the number of clients.
    let mut page = client(format!("ws://{web}/"), stream(web)).unwrap().0;
    let end = Instant::now() + AT_LAST;
    loop {
        let Message::Text(line) = page.read().unwrap() else { continue };
        let line: Value = serde_json::from_str(&line).unwrap();
        if line["event"] == "clients" && line["dropped"] == json!(1) {
            break;
        }
        assert!(Instant::now() < end, "it is never dropped");
    }
    let seen = window.session.snapshot().floor.counters.packets;
    wait_until("who reads is served", || window.session.snapshot().floor.counters.packets > seen + 1000);
    signal(&run, "TERM");
    run.child.wait().unwrap();
    let said = run.end();
    assert!(said.iter().any(|line| line.contains("does not read and was dropped; 1 so far")), "{said:?}");
    drop(stalled);
}

/// The server's refusal and its reason.
fn refused(news: &Receiver<MirrorNews>) -> String {
    let end = Instant::now() + AT_LAST;
    loop {
        if let Ok(MirrorNews::Line(line)) = news.recv_timeout(Duration::from_secs(1))
            && let underfoot::outgoing::json::Message::Error(refusal) = line.message
        {
            return refusal.why.0;
        }
        assert!(Instant::now() < end, "nothing is refused");
    }
}

// J4
#[test]
fn a_layout_from_a_window_is_checked_and_taken_only_where_that_is_allowed() {
    let site = Site::new();
    let other = json!(HARMLESS.replace("zoom", "volume"));
    let web = free_address();
    let run = run_at(&site, web, &[]);
    let (link, news, window) = join(web);
    assert!(!window.greeting.takes_layouts);
    link.ask("layout", std::slice::from_ref(&other));
    assert!(refused(&news).contains("--web-layouts"));
    drop((window, link, run));

    // Others may neither change nor bring a layout with a dead man's pedal.
    let run = run_at(&site, web, &["--web-layouts"]);
    let (link, news, window) = join(web);
    link.ask("layout", std::slice::from_ref(&other));
    let why = refused(&news);
    assert!(why.contains("\"drive\" with the guard HoldToRun"), "{why}");
    drop((window, link, run));

    let page = site.folder().join("page.ron");
    let dangerous = std::fs::read_to_string(&page).unwrap();
    std::fs::write(&page, HARMLESS).unwrap();
    let run = run_at(&site, web, &["--web-layouts"]);
    let (link, news, window) = join(web);
    assert!(window.greeting.takes_layouts);
    // Both within a second, however long the first is checked.
    link.ask("layout", &[json!(dangerous)]);
    link.ask("layout", &[json!(HARMLESS.replace("slider", "slidr"))]);
    let whys = [refused(&news), refused(&news)];
    for expected in ["HoldToRun", "one layout a second"] {
        assert!(whys.iter().any(|why| why.contains(expected)), "{whys:?}");
    }
    thread::sleep(A_SECOND);
    link.ask("layout", &[json!(HARMLESS.replace("slider", "slidr"))]);
    let why = refused(&news);
    assert!(why.contains("slidr") && why.contains("slider"), "{why}");
    thread::sleep(A_SECOND);
    link.ask("layout", &[other]);
    wait_until("it comes back with the packets", || {
        window.session.snapshot().floor.layout_revision == 1
            && window.session.snapshot().floor.widgets.len() == 1
    });
    drop(run);
}

// J4
#[test]
fn pages_from_elsewhere_can_t_join_and_a_window_may_keep_controls_off_while_it_is_there() {
    let site = Site::new();
    let web = free_address();
    let run = run_at(&site, web, &[]);
    let mut request = format!("ws://{web}/mirror").into_client_request().unwrap();
    request.headers_mut().insert("Origin", "https://evil.example".parse().unwrap());
    let refused = client(request, stream(web)).unwrap_err().to_string();
    assert!(refused.contains("403"), "{refused}");

    let _boards = Boards::start(&site, run.address);
    let (link, _news, window) = join(web);
    let off =
        || window.session.snapshot().floor.widgets.iter().map(|widget| widget.disabled).collect::<Vec<_>>();
    let (checking, _told, other) = join(web);
    checking.ask("controls_off", &[json!(true)]);
    wait_until("they are off", || off() == [true, true]);
    // In any way of leaving.
    drop((checking, other));
    wait_until("they are on again", || off() == [false, false]);
    link.ask("widget/zoom/set", &[json!(0.25)]);
    wait_until("a request is done there and comes here", || {
        let value = window.session.snapshot().value("zoom");
        value == Some(underfoot::widget::Value::Number(0.25))
    });
}

/// Resident memory of this process, in bytes.
#[cfg(target_os = "linux")]
fn resident() -> usize {
    let pages = std::fs::read_to_string("/proc/self/statm").unwrap();
    4096 * pages.split(' ').nth(1).unwrap().parse::<usize>().unwrap()
}

/// A server that greets like one of this program, and then sends data that takes memory, until the reader is gone or
/// `most` bytes are sent: unknown controls, endless texts, lists, invalid frames.
#[cfg(target_os = "linux")]
fn hostile(greeting: String, most: usize) -> (SocketAddr, thread::JoinHandle<usize>) {
    let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    let serve = move || {
        let (stream, _) = listener.accept().unwrap();
        let mut socket = tungstenite::accept(stream).unwrap();
        let (long, list) = ("x".repeat(20_000), vec!["[1,2]"; 4000].join(","));
        let mut said = 0;
        socket.send(Message::text(greeting.as_str())).unwrap();
        for number in 0.. {
            let line = match number % 6 {
                0 => format!(
                    r#"{{"event":"state","id":"c{number}","value":"{long}","label":"{long}","range":[{list}]}}"#
                ),
                1 => format!(
                    r#"{{"event":"state","id":"zoom","label":"{number}{long}","indicator":[{list}]}}"#
                ),
                2 => format!(r#"{{"event":"page","page":"p{number}{long}"}}"#),
                3 => format!(r#"{{"event":"error","request":"r{number}{long}","why":"{number}{long}"}}"#),
                4 => format!(r#"{{"event":"health","troubles":[{list}],"n":{number}}}"#),
                _ => format!(r#"{{"event":"changed","id":"c{number}","value":[{list}]}}"#),
            };
            said += line.len();
            let bad = Message::binary(line.clone().into_bytes());
            if said > most || socket.send(Message::text(line)).is_err() || socket.send(bad).is_err() {
                return said;
            }
        }
        said
    };
    (address, thread::spawn(serve))
}

/// A window keeps only the state of its own layout, for any messages of its server.
#[cfg(target_os = "linux")]
#[test]
fn a_hostile_server_takes_no_memory_of_a_window_that_joins_it() {
    const SAID: usize = 300 << 20;
    let floor = Floor::of(Geometry::of_paper_tiles(3, 2).unwrap());
    let layout = parse_layout(HARMLESS, "it", &Kinds::builtin(), &floor.geometry).unwrap().layout;
    let greeting = Greeting::line(&floor, &layout, &Snapshot::default(), Method::default(), true);
    let (address, served) = hostile(greeting, SAID);
    let (_link, news, window) = join(address);
    let mut follower = Follower::default();
    follower.begin(&window.greeting, Duration::ZERO);
    let before = resident();
    let (mut lines, mut most) = (Vec::new(), before);
    let begun = Instant::now();
    while !served.is_finished() {
        assert!(begun.elapsed() < 10 * AT_LAST, "the server is held up");
        let Ok(MirrorNews::Line(line)) = news.recv_timeout(Duration::from_millis(100)) else { continue };
        follower.hear(&line.message, begun.elapsed());
        let seen = window.session.snapshot();
        follower.corrections(&seen.layout, &seen.floor, begun.elapsed());
        // As many sentences as a window shows.
        lines.push(line);
        lines.drain(..lines.len().saturating_sub(20));
        most = most.max(resident());
    }
    assert!(served.join().unwrap() >= SAID);
    println!("{} MiB said, {} KiB more in memory", SAID >> 20, (most - before) >> 10);
    assert!(most - before < 48 << 20, "{} KiB", (most - before) >> 10);
}

/// The delay of packets through the server, and its load. For an idle machine.
#[test]
#[ignore = "a measurement"]
fn what_a_mirror_of_the_papers_floor_takes() {
    let (web, sensors) = (free_address(), format!("127.0.0.1:{}", free_port()));
    let layout = concat!(env!("CARGO_MANIFEST_DIR"), "/../../layouts/map.ron");
    let _server = underfoot()
        .args(["run", layout, "--listen", &sensors, "--no-osc", "--sound", "off", "--web", &web.to_string()])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .map(Served)
        .unwrap();
    let mut counted = raw(web);
    let (_link, news) = MirrorLink::start(web).unwrap();
    let (greeting, source) = loop {
        if let MirrorNews::Joined(greeting, source) = news.recv_timeout(AT_LAST).unwrap() {
            break (greeting, source);
        }
    };
    let bytes = thread::spawn(move || {
        let (mut bytes, begun) = (0_usize, Instant::now());
        while begun.elapsed() < Duration::from_secs(10) {
            if let Message::Binary(frame) = counted.read().unwrap() {
                bytes += frame.len();
            }
        }
        bytes as f64 / begun.elapsed().as_secs_f64()
    });
    let sent: Arc<Mutex<Vec<Instant>>> = Arc::default();
    let noted = Arc::clone(&sent);
    let floor = greeting.floor.clone();
    thread::spawn(move || {
        let mut encoder = SensorEncoder::new(&floor, SensorFormat::Counts);
        let (socket, begun) = (UdpSocket::bind("127.0.0.1:0").unwrap(), Instant::now());
        for sequence in 0..11_000_u32 {
            noted.lock().unwrap().push(Instant::now());
            for (board, channels) in (0..).zip(&floor.boards) {
                let readings = Readings::Counts(channels.channels.iter().map(|_| Some(3000)).collect());
                let packet = SensorPacket { board, sequence, received: units::Instant::START, readings };
                socket.send_to(encoder.encode(&packet).unwrap(), &sensors).unwrap();
            }
            let due = Duration::from_millis(u64::from(sequence) + 1);
            thread::sleep(due.saturating_sub(begun.elapsed()));
        }
    });
    let mut source = FloorInput::from(source).source;
    let (mut late, begun) = (Vec::new(), Instant::now());
    while begun.elapsed() < Duration::from_secs(10) {
        if let Some(packet) = source.next(Duration::from_millis(5)).unwrap() {
            let sent = sent.lock().unwrap()[packet.sequence as usize];
            late.push(sent.elapsed());
        }
    }
    late.sort();
    let part = |share: f64| late[(share * (late.len() - 1) as f64) as usize];
    println!(
        "{} packets, {:.0} kB/s; later by: median {:?}, 99 % {:?}, at most {:?}",
        late.len(),
        bytes.join().unwrap() / 1e3,
        part(0.5),
        part(0.99),
        part(1.0)
    );
}

/// The time until the floor of a killed server is lost here. For an idle machine.
#[test]
#[ignore = "a measurement"]
fn how_soon_a_killed_server_is_lost() {
    let site = Site::new();
    let mut took: Vec<Duration> = (0..10)
        .map(|_| {
            let web = free_address();
            let run = run_at(&site, web, &[]);
            let (_link, _news, window) = join(web);
            let _boards = Boards::start(&site, run.address);
            wait_until("both are held here", || window.held() == ["drive", "zoom"]);
            signal(&run, "KILL");
            let begun = Instant::now();
            wait_until("the link is lost", || window.link() == LinkState::Lost);
            begun.elapsed()
        })
        .collect();
    took.sort();
    println!("lost after: median {:?}, at most {:?}", took[5], took[9]);
}
