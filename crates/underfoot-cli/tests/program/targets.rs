//! A key that goes down comes up after any failure: messages of a held control, seen by an observer outside of the program.

use std::net::{SocketAddr, UdpSocket};
use std::path::PathBuf;
use std::process::Command;
use std::time::{Duration, Instant};

use rosc::{OscPacket, OscType, decoder};
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{ConnectionExt as _, KeyButMask};
use x11rb::rust_connection::RustConnection;

use crate::holds::client::Client;
use crate::holds::site::{BoardFault, Boards, Run, Site};
use crate::xvfb::Xvfb;

/// Longest time for which anything may stay down.
pub const SOON: Duration = Duration::from_millis(150);

/// Number of attempts on a machine that may be busy.
const TRIES: usize = 6;

/// Time within which the feet of new boards press on a machine that is not too busy.
const PRESSED: Duration = Duration::from_secs(5);

/// Time-out for an event that must happen.
const AT_LAST: Duration = Duration::from_secs(30);

/// The page of the other tests, with `send` for the pedal.
pub fn page(targets: &str, send: &str) -> String {
    format!(
        r#"Layout(
    version: 4,
    targets: [{targets}],
    regions: [(id: "left", at: (0, 0), size: (1, 2)), (id: "right", at: (1, 0), size: (2, 2))],
    widgets: [
        (id: "drive", kind: "dead_man", at: (0, 0), size: (0.9, 0.9), send: [{send}]),
        (id: "zoom", kind: "slider", at: (1.2, 0), size: (1.8, 0.9), press_n: 60, release_n: 40,
         send: [Value(Osc("desk", "/zoom", (from: 0, to: 1)))]),
    ],
)"#
    )
}

/// A receiver that nobody reads, for the slider of the page.
pub const NO_DESK: &str = "(name: \"desk\", to: Osc(\"127.0.0.1:9\"))";

/// An observer of what is down.
pub trait Observer {
    /// Whether it is down now.
    fn is_down(&mut self) -> bool;
}

/// A receiver of OSC.
struct OscDesk {
    socket: UdpSocket,
    is_down: bool,
    zooms: Vec<f32>,
}

impl OscDesk {
    fn new() -> Self {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        socket.set_nonblocking(true).unwrap();
        Self { socket, is_down: false, zooms: Vec::new() }
    }

    fn target(&self) -> String {
        format!("(name: \"desk\", to: Osc(\"{}\"))", self.socket.local_addr().unwrap())
    }
}

impl Observer for OscDesk {
    fn is_down(&mut self) -> bool {
        let mut bytes = [0; 512];
        while let Ok(length) = self.socket.recv(&mut bytes) {
            let Ok((_, OscPacket::Message(message))) = decoder::decode_udp(&bytes[..length]) else {
                continue;
            };
            match (message.addr.as_str(), message.args.as_slice()) {
                ("/drive", [OscType::Int(on)]) => self.is_down = *on == 1,
                ("/zoom", [OscType::Float(zoom)]) => self.zooms.push(*zoom),
                other => panic!("{other:?}"),
            }
        }
        self.is_down
    }
}

/// A key of a virtual display, or the left button of its mouse.
#[derive(Clone, Copy)]
enum Observed {
    /// The space bar, by its code.
    Space(u8),
    LeftButton,
}

/// A virtual X display, and the state of its space bar or of its mouse.
struct VirtualScreen {
    server: Xvfb,
    connection: RustConnection,
    observed: Observed,
}

impl VirtualScreen {
    /// A display of its own; `None`, with the reason printed, if there is no Xvfb.
    fn open() -> Option<Self> {
        let server = Xvfb::open("640x480x24")?;
        let (connection, _) = RustConnection::connect(Some(&server.display)).unwrap();
        let setup = connection.setup();
        let (first, last) = (setup.min_keycode, setup.max_keycode);
        let mapping = connection.get_keyboard_mapping(first, last - first + 1).unwrap().reply().unwrap();
        let per_key = usize::from(mapping.keysyms_per_keycode);
        let at = mapping.keysyms.chunks(per_key).position(|keysyms| keysyms[0] == 0x20).unwrap();
        let code = first + u8::try_from(at).unwrap();
        Some(Self { server, connection, observed: Observed::Space(code) })
    }

    /// Observes the left button of the mouse.
    fn with_button(self) -> Self {
        Self { observed: Observed::LeftButton, ..self }
    }

    fn target(&self) -> String {
        format!("(name: \"viewer\", to: Keyboard((display: \"{}\")))", self.server.display)
    }
}

impl Observer for VirtualScreen {
    fn is_down(&mut self) -> bool {
        match self.observed {
            Observed::Space(code) => {
                let keys = self.connection.query_keymap().unwrap().reply().unwrap().keys;
                keys[usize::from(code / 8)] & (1 << (code % 8)) != 0
            }
            Observed::LeftButton => {
                let root = self.connection.setup().roots[0].root;
                let pointer = self.connection.query_pointer(root).unwrap().reply().unwrap();
                pointer.mask.contains(KeyButMask::BUTTON1)
            }
        }
    }
}

/// The guardian of the running program: its only child.
pub fn guardian(run: &Run) -> u32 {
    *children(run).last().expect("a guardian")
}

fn children(run: &Run) -> Vec<u32> {
    let threads = PathBuf::from(format!("/proc/{}/task", run.child.id()));
    let of_each = threads.read_dir().unwrap().flatten().flat_map(|thread| {
        let children = std::fs::read_to_string(thread.path().join("children")).unwrap_or_default();
        children.split_whitespace().filter_map(|id| id.parse().ok()).collect::<Vec<u32>>()
    });
    of_each.collect()
}

pub fn kill(id: u32, signal: &str) {
    assert!(Command::new("kill").args(["-s", signal, &id.to_string()]).status().unwrap().success());
}

pub fn until(what: &str, mut is_so: impl FnMut() -> bool) -> Duration {
    let begun = Instant::now();
    while !is_so() {
        assert!(begun.elapsed() < AT_LAST, "never: {what}");
        std::thread::sleep(Duration::from_millis(1));
    }
    begun.elapsed()
}

/// An end of a hold: what happens to the program, its guardian or its boards.
pub type End = (&'static str, fn(&Run, &Boards));

pub const ENDS: [End; 9] = [
    ("server SIGTERM", |run, _| kill(run.child.id(), "TERM")),
    ("server kill -9", |run, _| kill(run.child.id(), "KILL")),
    ("server SIGSTOP", |run, _| kill(run.child.id(), "STOP")),
    ("guardian SIGTERM, then server kill -9", |run, _| {
        kill(guardian(run), "TERM");
        kill(run.child.id(), "KILL");
    }),
    ("guardian kill -9", |run, _| kill(guardian(run), "KILL")),
    ("guardian SIGSTOP", |run, _| kill(guardian(run), "STOP")),
    ("cable cut", |_, boards| boards.suffer(BoardFault::Silent)),
    ("a row jumps", |_, boards| boards.suffer(BoardFault::Jumped)),
    ("frozen values", |_, boards| boards.suffer(BoardFault::Frozen)),
];

/// Boards whose feet hold what `is_down` sees. A machine that stands still for a moment at their landing takes the press:
/// then they land again.
pub fn holding(site: &Site, address: SocketAddr, mut is_down: impl FnMut() -> bool) -> Boards {
    for _ in 0..TRIES {
        let boards = Boards::start(site, address);
        let begun = Instant::now();
        while begun.elapsed() < PRESSED {
            if is_down() {
                return boards;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
    }
    panic!("it never goes down");
}

/// Holds the pedal, does `end`, and returns the time until the observer sees it up.
pub fn held_for(site: &Site, observer: &mut impl Observer, end: fn(&Run, &Boards)) -> Duration {
    let client = Client::new();
    let run = site.run(&client, &[]);
    let boards = holding(site, run.address, || observer.is_down());
    // The guardian is in the middle of its work.
    std::thread::sleep(Duration::from_millis(100));
    assert!(observer.is_down(), "a foot that stays holds it");
    let begun = Instant::now();
    end(&run, &boards);
    until("it comes up", || !observer.is_down());
    let took = begun.elapsed();
    // It stays up until a foot presses again.
    std::thread::sleep(Duration::from_millis(50));
    assert!(!observer.is_down());
    drop(boards);
    took
}

/// Holds the pedal until the server panics, and returns the time from its end until the observer sees it up.
fn held_after_a_panic(site: &Site, observer: &mut impl Observer) -> Duration {
    let client = Client::new();
    // The foot stands since the second second.
    let mut run = site.run(&client, &["--fault", "panic=4s"]);
    let boards = Boards::start(site, run.address);
    until("the key goes down", || observer.is_down());
    until("the panic ends the program", || {
        observer.is_down();
        run.child.try_wait().unwrap().is_some()
    });
    let took = until("it comes up", || !observer.is_down());
    drop(boards);
    took
}

pub fn comes_up_soon(site: &Site, observer: &mut impl Observer) {
    for (name, end) in ENDS {
        let mut times: Vec<Duration> = Vec::new();
        // An X server may lose the last requests of a client that ends: once is not enough there.
        let rounds = if name.starts_with("server") { 4 } else { 1 };
        while times.iter().filter(|took| **took <= SOON).count() < rounds {
            assert!(times.len() < TRIES + rounds, "{name}: never within {SOON:?}: {times:?}");
            times.push(held_for(site, observer, end));
        }
        println!("{name}: up after {times:?}");
    }
    let after_a_panic = held_after_a_panic(site, observer);
    assert!(after_a_panic <= SOON, "server panics: {after_a_panic:?}");
}

#[test]
fn an_osc_address_that_is_held_comes_up_whatever_dies() {
    let mut desk = OscDesk::new();
    let site = Site::new();
    let page = page(&desk.target(), r#"While(pressed, Osc("desk", "/drive"))"#);
    std::fs::write(site.folder().join("page.ron"), page).unwrap();
    comes_up_soon(&site, &mut desk);
    assert!(!desk.zooms.is_empty() && desk.zooms.iter().all(|zoom| (0.0..=1.0).contains(zoom)));
}

#[test]
fn a_key_that_is_held_comes_up_whatever_dies() {
    let Some(mut screen) = VirtualScreen::open() else { return };
    let (site, _desk) = site_with(&screen, r#"While(pressed, Key("viewer", "space"))"#);
    comes_up_soon(&site, &mut screen);
}

#[test]
fn a_mouse_button_that_is_held_comes_up_whatever_dies() {
    let Some(mut screen) = VirtualScreen::open().map(VirtualScreen::with_button) else { return };
    let (site, _desk) = site_with(&screen, r#"While(pressed, Button("viewer", left))"#);
    comes_up_soon(&site, &mut screen);
}

/// An update removes or replaces the file of a program that runs for months.
#[test]
fn a_guardian_that_dies_has_a_successor_of_the_same_version_after_an_update() {
    let mut desk = OscDesk::new();
    let mut site = Site::new();
    let page = page(&desk.target(), r#"While(pressed, Osc("desk", "/drive"))"#);
    std::fs::write(site.folder().join("page.ron"), page).unwrap();
    let file = site.copy_program().to_owned();
    let client = Client::new();
    let run = site.run(&client, &[]);
    let boards = holding(&site, run.address, || desk.is_down());
    std::fs::remove_file(&file).unwrap();
    // The new version knows no guardian.
    std::fs::write(&file, "#!/bin/sh\nexit 1\n").unwrap();
    let first = guardian(&run);
    kill(first, "KILL");
    until("it comes up", || !desk.is_down());
    let serves = |id: u32| {
        let words = std::fs::read_to_string(format!("/proc/{id}/cmdline")).unwrap_or_default();
        id != first && words.contains("guardian")
    };
    until("another guardian serves", || children(&run).into_iter().any(serves));
    drop(boards);
}

/// A site whose pedal sends `send` to `screen`, and whose slider sends to a desk.
fn site_with(screen: &VirtualScreen, send: &str) -> (Site, OscDesk) {
    let (site, desk) = (Site::new(), OscDesk::new());
    let targets = format!("{}, {}", screen.target(), desk.target());
    std::fs::write(site.folder().join("page.ron"), page(&targets, send)).unwrap();
    (site, desk)
}

/// Twenty rounds of each end, the median and the longest time: for an idle machine, in a release build.
#[test]
#[ignore = "takes ten minutes; figures of a machine that is busy say nothing"]
fn twenty_rounds_of_each_end_of_a_key() {
    let Some(mut screen) = VirtualScreen::open() else { return };
    let (site, _desk) = site_with(&screen, r#"While(pressed, Key("viewer", "space"))"#);
    twenty_rounds(&site, &mut screen);
}

/// Twenty rounds of each end, the median and the longest time: for an idle machine, in a release build.
#[test]
#[ignore = "takes ten minutes; figures of a machine that is busy say nothing"]
fn twenty_rounds_of_each_end_of_a_mouse_button() {
    let Some(mut screen) = VirtualScreen::open().map(VirtualScreen::with_button) else { return };
    let (site, _desk) = site_with(&screen, r#"While(pressed, Button("viewer", left))"#);
    twenty_rounds(&site, &mut screen);
}

/// Plays twenty rounds of each end and prints the median and the longest time.
pub fn twenty_rounds(site: &Site, observer: &mut impl Observer) {
    let mut late = Vec::new();
    let ends = ENDS.map(|(name, end)| (name, Some(end))).into_iter().chain([("server panics", None)]);
    for (name, end) in ends {
        let mut round = || match end {
            Some(end) => held_for(site, observer, end),
            None => held_after_a_panic(site, observer),
        };
        let mut times: Vec<Duration> = (0..20).map(|_| round()).collect();
        times.sort();
        println!("{name}: median {:?}, longest {:?}", times[10], times[19]);
        late.extend((times[19] > SOON).then(|| format!("{name}: {times:?}")));
    }
    assert!(late.is_empty(), "{late:#?}");
}

#[test]
fn a_target_that_the_layout_lacks_is_refused_by_name() {
    let desk = OscDesk::new();
    let site = Site::new();
    let page = page(&desk.target(), r#"While(pressed, Osc("desk", "/drive"))"#);
    std::fs::write(site.folder().join("page.ron"), page).unwrap();
    let output = crate::end_to_end::underfoot()
        .current_dir(site.folder())
        .args(["run", "page.ron", "--floor", "floor.ron", "--listen", "127.0.0.1:0"])
        .args(["--target", "disk=127.0.0.1:9"])
        .output()
        .unwrap();
    assert!(!output.status.success());
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("no target \"disk\"; it has desk"), "{said}");
}
