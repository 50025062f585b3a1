//! The hall: its files, its computers, and the boards under the feet in it.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Write};
use std::net::{IpAddr, Ipv4Addr, SocketAddr, UdpSocket};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use tempfile::TempDir;
use underfoot::floor::Floor;
use underfoot::layout::Layout;
use underfoot::runtime::Session;
use underfoot::schema::{self, Kinds};
use underfoot::sink::{EventSink, JsonSink, Rank, RealTime, Report};
use underfoot::source::{SensorSource, SourceError, UdpSource};
use underfoot::units::Instant;
use underfoot::widget::{EventKind, WidgetId};
use underfoot::wire::{SensorEncoder, SensorFormat};
use underfoot_cluster::auth::Key;
use underfoot_sim::{Pace, Scenario, Script, SimConfig, SimFloor, SimulatedSource, calibrated};

use crate::lines::Lines;
use crate::link::Link;
use crate::netns::Namespaces;
use crate::ports::free_port;
use crate::steady::note_overload;

/// Four areas of 6 x 6 tiles; their borders are at 6 tiles either way. Each has three boards of 6 x 2 tiles: few,
/// since one machine does the work of six here.
fn floor_text() -> String {
    let board = |number: u16| {
        let (west, south) = (number % 2 * 6, number / 2 * 2);
        let tiles = (0..12).map(|tile| format!("({}, {})", west + tile % 6, south + tile / 6));
        format!("(tiles: [{}])", tiles.collect::<Vec<_>>().join(", "))
    };
    let boards: Vec<String> = (0..12).map(board).collect();
    let areas = r#"[
        (id: "sw", at: (0, 0), size: (6, 6)),
        (id: "se", at: (6, 0), size: (6, 6)),
        (id: "nw", at: (0, 6), size: (6, 6)),
        (id: "ne", at: (6, 6), size: (6, 6)),
    ]"#;
    format!("Floor(columns: 12, rows: 12, areas: {areas}, boards: [{}])", boards.join(", "))
}

/// Two controls on borders, of which `drive` belongs to the south-east, and one in each other area.
pub(crate) const LAYOUT: &str = r#"Layout(
    version: 1,
    title: "Hall",
    regions: [
        (id: "west_desk", at: (1.5, 3), size: (2, 1)),
        (id: "drive_desk", at: (5, 3), size: (2, 1)),
        (id: "gate_desk", at: (3, 5.6), size: (1, 1)),
        (id: "door_desk", at: (8.5, 9), size: (2, 1)),
        (id: "level_desk", at: (1.5, 9), size: (2.5, 1)),
    ],
    widgets: [
        (id: "ticket", kind: "button", at: (2, 3), size: (0.8, 0.8), label: "Ticket"),
        (id: "drive", kind: "hold", at: (5.7, 3), size: (0.8, 0.8), label: "Drive"),
        (id: "gate", kind: "button", at: (3.1, 5.7), size: (0.8, 0.8), label: "Gate"),
        (id: "door", kind: "button", at: (9, 9), size: (0.8, 0.8), label: "Door"),
        (id: "level", kind: "slider", at: (1.8, 9.1), size: (1.8, 0.6), label: "Level"),
    ],
)"#;

/// Seed of the simulated floor.
const SEED: u64 = 1;

/// Time (ms) for which a machine stands still if it may take the floor from a program, which takes 100 ms.
pub(crate) const STANDS_STILL_MS: u64 = 50;

/// The areas' names.
pub(crate) const AREAS: [&str; 4] = ["sw", "se", "nw", "ne"];

/// A program that ends with the test.
pub(crate) struct Program(pub(crate) Child);

/// The messages of programs on standard error.
pub(crate) type Notices = Arc<Mutex<Vec<String>>>;

impl Drop for Program {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl Program {
    pub(crate) fn start(folder: &Path, args: &[&str], notices: &Notices) -> Self {
        Self::start_by(Command::new(env!("CARGO_BIN_EXE_underfoot-cluster")), folder, args, notices)
    }

    /// Starts it in a network namespace; `ip` replaces itself by the program, so that signals reach the program's own
    /// process.
    fn start_in(namespace: &str, folder: &Path, args: &[&str], notices: &Notices) -> Self {
        let mut ip = Command::new("ip");
        ip.args(["netns", "exec", namespace, env!("CARGO_BIN_EXE_underfoot-cluster")]);
        Self::start_by(ip, folder, args, notices)
    }

    /// The message of a program that refuses to start; its exit status is 1.
    pub(crate) fn refusal(folder: &Path, args: &[&str]) -> String {
        let mut command = Command::new(env!("CARGO_BIN_EXE_underfoot-cluster"));
        let done = command.args(args).current_dir(folder).output().unwrap();
        assert_eq!(done.status.code(), Some(1), "{done:?}");
        String::from_utf8(done.stderr).unwrap()
    }

    fn start_by(mut command: Command, folder: &Path, args: &[&str], notices: &Notices) -> Self {
        let mut child = command
            .args(args)
            .current_dir(folder)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut chatter = BufReader::new(child.stderr.take().unwrap());
        let mut line = String::new();
        while !line.contains("Ctrl-C ends it") {
            let before = line.len();
            chatter.read_line(&mut line).unwrap();
            assert!(line.len() > before, "it has ended: {line}");
        }
        let name = args[0].to_owned();
        let said = Arc::clone(notices);
        // Its standard error goes to the test's own output.
        thread::spawn(move || {
            chatter.lines().map_while(Result::ok).for_each(|line| {
                println!("{name}: {line}");
                if line.contains("gives up its real-time priority") {
                    note_overload();
                }
                said.lock().unwrap().push(line);
            });
        });
        Self(child)
    }

    /// Sends SIGTERM and waits until it has ended.
    pub(crate) fn end(mut self) {
        self.signal("-TERM");
        self.0.wait().unwrap();
    }

    pub(crate) fn signal(&self, signal: &str) {
        let sent = Command::new("kill").args([signal, &self.0.id().to_string()]).status().unwrap();
        assert!(sent.success());
    }
}

/// The hall's floor, calibrated and tared, like one in use: computers that tare by themselves differ by the noise of
/// their sensors.
pub(crate) fn floor() -> Floor {
    let bare = schema::parse_floor(&floor_text(), "hall").unwrap();
    let sim = SimFloor::new(&bare, SimConfig::default(), SEED);
    calibrated(&bare, &sim, SEED).unwrap()
}

/// The same floor, with areas that listen on free ports.
pub(crate) fn listening() -> Floor {
    let mut floor = floor();
    floor.areas.iter_mut().for_each(|area| area.listen = Some(([127, 0, 0, 1], free_port()).into()));
    floor
}

/// The hall's controls.
pub(crate) fn layout(floor: &Floor) -> Layout {
    schema::parse_layout(LAYOUT, "controls", &Kinds::builtin(), &floor.geometry).unwrap().layout
}

/// The people of a scenario in the hall.
pub(crate) fn script(scenario: &str, floor: &Floor, layout: &Layout) -> Script {
    Scenario::parse("hall", scenario).unwrap().resolve(layout, &floor.geometry).unwrap()
}

/// The source of the hall's board packets.
pub(crate) fn source(floor: &Floor, script: Script, pace: Pace) -> SimulatedSource {
    SimulatedSource::new(SimFloor::new(floor, SimConfig::default(), SEED), Box::new(script), pace)
}

/// The hall and its gateway.
pub(crate) struct Hall {
    folder: TempDir,
    pub(crate) floor: Floor,
    pub(crate) layout: Layout,
    /// Between it and the nodes.
    pub(crate) links: [Link; 4],
    /// The address on which the gateway receives requests.
    pub(crate) commands: SocketAddr,
    notices: Notices,
    gateway: Program,
    pub(crate) lines: Lines,
    /// The namespaces of the nodes, if each has a network of its own.
    pub(crate) namespaces: Option<Namespaces>,
}

impl Hall {
    /// A hall with a key that its floor file names.
    pub(crate) fn open() -> Self {
        Self::with_key(Some("hall_of_tests.key"))
    }

    /// A hall with a floor file that names the new key `key`, or none.
    pub(crate) fn with_key(key: Option<&str>) -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("controls.ron"), LAYOUT).unwrap();
        let namespaces = Namespaces::asked_for();
        let mut floor = floor();
        for area in &mut floor.areas {
            let address = namespaces.as_ref().map_or(Ipv4Addr::LOCALHOST, |all| all.address(&area.id));
            area.listen = Some((address, free_port()).into());
        }
        let here = namespaces.as_ref().map_or(Ipv4Addr::LOCALHOST, Namespaces::here);
        if namespaces.is_some() {
            // Boards are on the bridge, and those of the single computer on this machine.
            floor.allow = [here, Ipv4Addr::LOCALHOST].map(|address| IpAddr::from(address).into()).into();
        }
        let address = SocketAddr::from((here, free_port()));
        floor.gateway = Some(address);
        if let Some(key) = key {
            Key::make(&folder.path().join(key)).unwrap();
            floor.key = Some(key.to_owned());
        }
        std::fs::write(folder.path().join("hall.ron"), schema::write_floor(&floor)).unwrap();
        let layout = layout(&floor);
        let links = AREAS.map(|_| Link::to(address.port()));
        let commands: SocketAddr = ([127, 0, 0, 1], free_port()).into();
        let notices = Notices::default();
        let (gateway, lines) = start_gateway(folder.path(), commands, &notices);
        Self { folder, floor, layout, links, commands, notices, gateway, lines, namespaces }
    }

    /// Kills the gateway.
    pub(crate) fn kill_gateway(&mut self) {
        self.gateway.0.kill().unwrap();
        self.gateway.0.wait().unwrap();
    }

    /// Starts another gateway in place of a killed one; line numbers start again.
    pub(crate) fn start_gateway(&mut self) {
        (self.gateway, self.lines) = start_gateway(self.folder.path(), self.commands, &self.notices);
    }

    /// Ends the gateway; returns all notices of programs so far, with its last report.
    pub(crate) fn end_gateway(&mut self) -> Vec<String> {
        self.gateway.signal("-TERM");
        self.gateway.0.wait().unwrap();
        self.await_notice("messages of nodes;");
        // One line for each reason of refusals follows.
        thread::sleep(Duration::from_millis(200));
        self.said()
    }

    /// All notices of programs so far.
    pub(crate) fn said(&self) -> Vec<String> {
        self.notices.lock().unwrap().clone()
    }

    /// A file of the hall.
    pub(crate) fn file(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// The key of the floor file.
    pub(crate) fn key(&self) -> Key {
        Key::read(&self.file(self.floor.key.as_deref().unwrap())).unwrap()
    }

    /// The gateway's endpoint.
    pub(crate) fn endpoint(&self) -> String {
        format!("tcp/{}", self.floor.gateway.unwrap())
    }

    /// Starts the node of one area with the settings of the floor file only.
    pub(crate) fn node(&self, area: &str) -> Program {
        self.start(area, &["controls.ron"])
    }

    /// Starts the node of one area without a layout of its own.
    pub(crate) fn bare_node(&self, area: &str) -> Program {
        self.start(area, &[])
    }

    /// Writes another layout for the gateway.
    pub(crate) fn write_layout(&self, text: &str) {
        std::fs::write(self.folder.path().join("controls.ron"), text).unwrap();
    }

    /// Waits until all nodes have the gateway's layout of that number.
    pub(crate) fn await_layout(&self, revision: u64) {
        self.await_node_layout(revision, AREAS.len());
    }

    /// Waits until `times` nodes have reported the gateway's layout of that number.
    pub(crate) fn await_node_layout(&self, revision: u64, times: usize) {
        self.await_notices(&format!("Layout {revision} is on the floor"), times);
    }

    /// Waits until a program prints `text`.
    pub(crate) fn await_notice(&self, text: &str) {
        self.await_notices(text, 1);
    }

    fn await_notices(&self, text: &str, times: usize) {
        let end = std::time::Instant::now() + Duration::from_secs(20);
        loop {
            let count = self.notices.lock().unwrap().iter().filter(|line| line.contains(text)).count();
            if count >= times {
                return;
            }
            assert!(std::time::Instant::now() < end, "{text}: {count} times");
            thread::sleep(Duration::from_millis(10));
        }
    }

    /// Starts the node of one area at the end of a link that can be cut, with a clock that can be set.
    pub(crate) fn frail_node(&self, area: &str) -> Program {
        self.start(area, &["controls.ron", "--gateway", &self.links[number(area)].endpoint(), "--step-clock"])
    }

    /// Starts the node of one area with additional options.
    pub(crate) fn start(&self, area: &str, more: &[&str]) -> Program {
        let node = ["node", "--floor", "hall.ron", "--area", area];
        let (folder, args) = (self.folder.path(), [&node[..], more].concat());
        match &self.namespaces {
            Some(all) => Program::start_in(&all.name(area), folder, &args, &self.notices),
            None => Program::start(folder, &args, &self.notices),
        }
    }

    /// Waits until an area is live, by the lines from number `from` on.
    pub(crate) fn await_live(&self, area: &str, from: usize) {
        self.lines.find(from, "live", |line| line.area() == Some((area, "live")));
    }

    /// The people of a scenario.
    pub(crate) fn script(&self, scenario: &str) -> Script {
        script(scenario, &self.floor, &self.layout)
    }

    /// Makes each board send its readings of `script` to the node of its area and to `others`.
    pub(crate) fn boards(&self, script: Script, others: &[u16]) -> Boards {
        let others = others.iter().map(|port| SocketAddr::from(([127, 0, 0, 1], *port)));
        let home = |board| self.floor.home(board).and_then(|area| area.listen);
        let targets =
            self.floor.boards.iter().map(|board| home(board).into_iter().chain(others.clone()).collect());
        Boards::start(&self.floor, script, targets.collect())
    }

    /// One computer for the whole floor, in this process: its session, port, lines and frames.
    pub(crate) fn single(&self) -> (Session, u16, Lines, Frames) {
        let source = UdpSource::bind(([127, 0, 0, 1], 0).into(), &self.floor).unwrap();
        let (port, clock, lines) = (source.local_addr().unwrap().port(), source.clock(), Lines::default());
        let frames = Frames::default();
        let session = Session::source(source, clock)
            .floor(self.floor.clone())
            .layout(self.layout.clone())
            .sink(JsonSink::new(lines.clone()).unwrap())
            .sink(frames.clone())
            .realtime()
            .start()
            .unwrap();
        (session, port, lines, frames)
    }
}

fn start_gateway(folder: &Path, commands: SocketAddr, notices: &Notices) -> (Program, Lines) {
    let at = commands.to_string();
    let outputs = ["--json", "--json-contacts", "--commands", &at];
    let args = [&["gateway", "controls.ron", "--floor", "hall.ron"][..], &outputs].concat();
    let mut gateway = Program::start(folder, &args, notices);
    let lines = Lines::of(gateway.0.stdout.take().unwrap());
    (gateway, lines)
}

/// Every contact of every frame, and every event.
#[derive(Clone, Debug, Default)]
pub(crate) struct Frames(Arc<Mutex<Seen>>);

#[derive(Debug, Default)]
struct Seen {
    tracks: Tracks,
    events: Vec<(Instant, WidgetId, EventKind)>,
}

/// Times and positions of each contact, by its number.
pub(crate) type Tracks = BTreeMap<u64, Vec<(f64, f64, f64)>>;

impl Frames {
    /// Times and positions of each contact.
    pub(crate) fn tracks(&self) -> Tracks {
        self.0.lock().unwrap().tracks.clone()
    }

    /// The events of all controls, control by control, each in order.
    pub(crate) fn events(&self) -> Vec<(Instant, WidgetId, EventKind)> {
        let mut events = self.0.lock().unwrap().events.clone();
        events.sort_by(|(_, one, _), (_, other, _)| one.cmp(other));
        events
    }
}

impl EventSink for Frames {
    fn report(&mut self, report: &Report<'_>) {
        let mut seen = self.0.lock().unwrap();
        match report {
            Report::Event(event) => seen.events.push((event.at, event.id.clone(), event.kind)),
            Report::Contacts(at, contacts) => {
                for contact in contacts.iter() {
                    let [x, y] = contact.centroid.to_array().map(f64::from);
                    seen.tracks.entry(contact.id.0.into()).or_default().push((at.secs(), x, y));
                }
            }
            _ => {}
        }
    }
}

fn number(area: &str) -> usize {
    AREAS.iter().position(|one| *one == area).unwrap()
}

/// The hall's boards, which send on a thread of their own.
pub(crate) struct Boards {
    stop: Arc<AtomicBool>,
    /// Number of lost packets of a thousand to each computer.
    lost: Arc<AtomicU64>,
    thread: Option<JoinHandle<()>>,
}

impl Boards {
    /// Makes each board of `floor` send its readings of `script` to its `targets`.
    pub(crate) fn start(floor: &Floor, script: Script, targets: Vec<Vec<SocketAddr>>) -> Self {
        let (stop, lost) = (Arc::<AtomicBool>::default(), Arc::<AtomicU64>::default());
        let loss = Arc::clone(&lost);
        // Any sequence without a pattern.
        let mut random = 1_u64;
        // Like boards, from any address that has a route to the targets.
        let socket = UdpSocket::bind("0.0.0.0:0").unwrap();
        let mut encoder = SensorEncoder::new(floor, SensorFormat::Blob);
        let mut source = source(floor, script, Pace::RealTime);
        let until = Arc::clone(&stop);
        let thread = thread::spawn(move || {
            // Boards are punctual.
            let mut realtime = RealTime::claim(Rank::Sensing);
            while !until.load(Ordering::Relaxed) {
                realtime.look();
                if realtime.given_up() > 0 {
                    note_overload();
                }
                match source.next(Duration::from_millis(10)) {
                    Ok(Some(packet)) => {
                        let datagram = encoder.encode(&packet).unwrap();
                        for target in &targets[usize::from(packet.board)] {
                            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                            if (random >> 33) % 1000 < loss.load(Ordering::Relaxed) {
                                continue;
                            }
                            // Boards ignore an absent node.
                            let _ = socket.send_to(datagram, target);
                        }
                    }
                    Ok(None) => {}
                    Err(SourceError::Ended) => break,
                    Err(error) => panic!("{error}"),
                }
            }
        });
        Self { stop, lost, thread: Some(thread) }
    }

    /// Drops `per_mille` of a thousand packets from now on.
    pub(crate) fn lose(&self, per_mille: u64) {
        self.lost.store(per_mille, Ordering::Relaxed);
    }

    /// Waits until the people have left.
    pub(crate) fn finish(mut self) {
        self.thread.take().unwrap().join().unwrap();
    }
}

impl Drop for Boards {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Prints a line for a measurement.
pub(crate) fn say(text: &str) {
    let _ = writeln!(std::io::stdout(), "{text}");
}
