//! Programs that reach the gateway's port without the floor's key: on an empty floor they hold nothing, and on a busy
//! one they disturb no foot.

use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::json;
use underfoot::units;
use underfoot_cluster::auth::{AuthSession, Key, MessageKind, Role};
use underfoot_cluster::message::{
    AreaStanding, GatewayMessage, NodeMessage, NodeRequest, ToNodes, VERSION, encode, fingerprint,
};
use underfoot_cluster::transport::TransportEnd;
use zenoh::Wait;

use crate::faults::holding;
use crate::hall::{AREAS, Boards, Hall, Program, STANDS_STILL_MS};
use crate::lines::{Line, Lines};
use crate::ports::free_port;
use crate::steady::while_time_is_kept;

/// Time between two messages of a forger, as of a node.
const EVERY: Duration = Duration::from_millis(2);

/// Messages of each sort that a forger sends.
const ROUNDS: usize = 50;

/// Number of them that must arrive: Zenoh drops messages while its queue is full.
const COME: u64 = 40;

const EMPTY: &str = r#"Scenario(title: "Empty", steps: [Wait(ms: 60000)])"#;

/// Another key than the hall's.
const OTHER: Key = Key::new([8; 32]);

/// A hall in which one node has a second gateway that records its messages. The recorder knows Zenoh's password and
/// not the floor's key.
struct Tapped {
    hall: Hall,
    nodes: Vec<Program>,
    recorder: TransportEnd,
    recorded: Arc<Mutex<Vec<Vec<u8>>>>,
    endpoint: String,
    boards: Option<Boards>,
}

impl Tapped {
    fn open(scenario: &str) -> Self {
        let hall = Hall::open();
        let endpoint = format!("tcp/127.0.0.1:{}", free_port());
        let recorded = Arc::<Mutex<Vec<Vec<u8>>>>::default();
        let heard = Arc::clone(&recorded);
        let record = move |bytes: &[u8]| heard.lock().unwrap().push(bytes.to_vec());
        let areas = AREAS.map(str::to_owned);
        let recorder =
            TransportEnd::gateway(std::slice::from_ref(&endpoint), &areas, &hall.key(), record).unwrap();
        let boards = Some(hall.boards(hall.script(scenario), &[]));
        let mut tapped = Self { hall, nodes: Vec::new(), recorder, recorded, endpoint, boards };
        tapped.nodes = AREAS.map(|area| tapped.node(area)).into();
        AREAS.iter().for_each(|area| tapped.hall.await_live(area, 0));
        tapped
    }

    fn node(&self, area: &str) -> Program {
        match area {
            "se" => {
                let (own, other) = (self.hall.endpoint(), self.endpoint.as_str());
                self.hall.start("se", &["controls.ron", "--gateway", &own, "--gateway", other])
            }
            other => self.hall.node(other),
        }
    }

    /// The latest messages of the south-east's node, as many as there are rounds.
    fn recording(&self) -> Vec<Vec<u8>> {
        let end = Instant::now() + Duration::from_secs(20);
        loop {
            let recorded = self.recorded.lock().unwrap();
            if recorded.len() >= ROUNDS {
                return recorded[recorded.len() - ROUNDS..].to_vec();
            }
            drop(recorded);
            assert!(Instant::now() < end, "nothing to record");
            thread::sleep(EVERY);
        }
    }

    /// The number of the first recorded message for which `wanted` holds, after waiting for it.
    fn find_recorded(&self, wanted: impl Fn(&Vec<u8>) -> bool) -> usize {
        let end = Instant::now() + Duration::from_secs(20);
        loop {
            if let Some(number) = self.recorded.lock().unwrap().iter().position(&wanted) {
                return number;
            }
            assert!(Instant::now() < end, "not recorded");
            thread::sleep(EVERY);
        }
    }

    /// A session with the real gateway for a forger that knows Zenoh's password.
    fn way_in(&self) -> TransportEnd {
        let way = TransportEnd::node(&[self.hall.endpoint()], "se", &self.hall.key(), |_| ()).unwrap();
        // Time to connect.
        thread::sleep(Duration::from_millis(500));
        way
    }
}

/// Sends each message, as often as a node would.
fn send(way: &TransportEnd, messages: impl IntoIterator<Item = Vec<u8>>) {
    for message in messages {
        assert!(way.send(message));
        thread::sleep(EVERY);
    }
}

/// A recorded message with another counter and a hold of `drive`: only its MAC is wrong.
fn held(recorded: &[u8], counter: impl Fn(u64) -> u64) -> Vec<u8> {
    let before = b"\"held\":[";
    let at = recorded.windows(before.len()).position(|part| part == before).unwrap() + before.len();
    let mut forged = [&recorded[..at], b"\"drive\"", &recorded[at..]].concat();
    let own = u64::from_be_bytes(forged[12..20].try_into().unwrap());
    forged[12..20].copy_from_slice(&counter(own).to_be_bytes());
    forged
}

/// A node's message with a press and a hold of `drive`, in an envelope of another key.
fn pressed_by_another_key(session: &mut AuthSession, hall: &Hall, ms: u64) -> Vec<u8> {
    let now = units::Instant::from_millis(ms);
    let text = json!({
        "at": now.micros(), "id": "drive", "kind": "pressed",
        "value": null, "contact": null, "force": 110.0, "position": [1.8, 1.0],
    });
    let message = NodeMessage {
        version: VERSION,
        floor: fingerprint(&hall.floor),
        area: "se".into(),
        frame: Some(now.micros()),
        events: vec![serde_json::from_value(text).unwrap()],
        held: vec!["drive".into()],
        ..NodeMessage::default()
    };
    let mut sealed = Vec::new();
    session.seal(MessageKind::Node, &encode(&message), now, &mut sealed);
    sealed
}

/// Checks that no event and no hold was reported.
fn check_untouched(lines: &Lines) {
    for line in lines.all() {
        assert_eq!(line.done(), None);
        assert!(line.json["held"].as_array().is_none_or(Vec::is_empty), "{line:?}");
    }
}

/// The number before these words in the reports of programs.
fn count(said: &[String], words: &str) -> u64 {
    let numbers = said.iter().filter_map(|line| line.strip_suffix(words)?.trim().parse().ok());
    numbers.max().unwrap_or(0)
}

// C5
#[test]
fn a_plain_session_of_zenoh_is_shut_out() {
    while_time_is_kept(STANDS_STILL_MS, || {
        let tapped = Tapped::open(EMPTY);
        let recording = tapped.recording();
        for mode in ["client", "peer"] {
            let settings = json!({
                "mode": mode,
                "scouting": { "multicast": { "enabled": false }, "gossip": { "enabled": false } },
                "listen": { "endpoints": [] },
                "connect": { "endpoints": [tapped.hall.endpoint()], "timeout_ms": 1000 },
            });
            let config = zenoh::Config::from_json5(&settings.to_string()).unwrap();
            let Ok(session) = zenoh::open(config).wait() else { continue };
            let all = session.declare_subscriber("**").wait().unwrap();
            thread::sleep(EVERY * 150);
            let overheard = std::iter::from_fn(|| all.try_recv().ok().flatten()).count();
            assert_eq!(overheard, 0, "{mode}");
            for recorded in &recording {
                for bytes in [recorded.clone(), held(recorded, |own| own + 1), held(recorded, |_| u64::MAX)] {
                    session.put("underfoot/cluster/node/se", bytes).wait().unwrap();
                }
                thread::sleep(EVERY);
            }
        }
        check_untouched(&tapped.hall.lines);
        let mut hall = tapped.hall;
        let said = hall.end_gateway();
        assert!(
            !said.iter().any(|line| line.contains("refused")),
            "messages have reached the gateway: {said:?}"
        );
    });
}

// C5
#[test]
fn messages_without_the_floor_s_key_hold_nothing() {
    while_time_is_kept(STANDS_STILL_MS, || {
        let mut tapped = Tapped::open(EMPTY);
        let way = tapped.way_in();
        let recording = tapped.recording();
        send(&way, recording.iter().map(|recorded| held(recorded, |own| own + 1)));
        send(&way, recording.iter().map(|recorded| held(recorded, |_| u64::MAX)));
        let mut forger = AuthSession::new(Role::Node, &OTHER, 77, 8);
        send(&way, (0..ROUNDS as u64).map(|ms| pressed_by_another_key(&mut forger, &tapped.hall, ms)));
        // Plain JSON, as in earlier versions.
        send(&way, (0..ROUNDS).map(|_| br#"{"version":2,"area":"se","held":["drive"]}"#.to_vec()));
        // A lost area would show after 100 ms.
        thread::sleep(Duration::from_millis(300));
        check_untouched(&tapped.hall.lines);
        let is_lost = |line: &Line| matches!(line.area(), Some((_, "lost" | "disputed")));
        assert!(!tapped.hall.lines.all().iter().any(is_lost));
        let said = tapped.hall.end_gateway();
        let forged = count(&said, "messages to the gateway not written with this floor's key, refused.");
        let malformed = count(&said, "messages to the gateway of another format, refused.");
        assert!((3 * COME..=3 * ROUNDS as u64).contains(&forged), "{forged} forged: {said:?}");
        assert!((COME..=ROUNDS as u64).contains(&malformed), "{malformed} of another format: {said:?}");
    });
}

// C5
#[test]
fn requests_without_the_floor_s_key_change_nothing_on_a_node() {
    while_time_is_kept(STANDS_STILL_MS, || {
        let mut tapped = Tapped::open(EMPTY);
        // The node has connected to the recorder by itself.
        let mut forger = AuthSession::new(Role::Gateway, &OTHER, 77, 8);
        let mut beat = |number: u64| {
            let request = NodeRequest {
                number,
                area: "se".into(),
                path: "widget/drive/disable".into(),
                args: Vec::new(),
            };
            let beat = GatewayMessage {
                version: VERSION,
                areas: vec![("se".into(), AreaStanding::Disputed)],
                requests: vec![request],
                ..GatewayMessage::default()
            };
            let mut sealed = Vec::new();
            let now = units::Instant::from_millis(number);
            forger.seal(MessageKind::Gateway, &encode(&ToNodes::Beat(beat)), now, &mut sealed);
            sealed
        };
        send(&tapped.recorder, (1..=ROUNDS as u64).map(&mut beat));
        thread::sleep(Duration::from_millis(200));
        check_untouched(&tapped.hall.lines);
        let se = tapped.nodes.remove(1);
        se.end();
        tapped.hall.await_notice("messages of gateways not written with this floor's key, refused.");
        let said = tapped.hall.said();
        let forged = count(&said, "messages of gateways not written with this floor's key, refused.");
        assert!((COME..=ROUNDS as u64).contains(&forged), "{forged} forged");
        assert!(!said.iter().any(|line| line.contains("Another node serves this area too")), "{said:?}");
    });
}

// C6
#[test]
fn a_recording_from_before_a_restart_holds_nothing() {
    while_time_is_kept(STANDS_STILL_MS, || {
        let press = r#"Scenario(title: "One hold", steps: [Wait(ms: 1500), Enter(from: South, at: (6.1, 2.2)),
        Wait(ms: 500), Press(widget: "drive", force_n: 110, hold_ms: 2500), Leave(to: South), Wait(ms: 60000)])"#;
        let mut tapped = Tapped::open(press);
        let says = |recorded: &Vec<u8>, text: &str| String::from_utf8_lossy(recorded).contains(text);
        let press = tapped.find_recorded(|recorded| says(recorded, "\"pressed\""));
        tapped.find_recorded(|recorded| says(recorded, "\"held\":[\"drive\"]"));
        thread::sleep(Duration::from_millis(500));
        let from = press.saturating_sub(ROUNDS);
        let recording: Vec<_> =
            tapped.recorded.lock().unwrap().iter().skip(from).take(4 * ROUNDS).cloned().collect();
        assert!(recording.iter().any(|recorded| says(recorded, "\"held\":[\"drive\"]")));
        let released = |line: &Line| line.json["held"].as_array().is_some_and(Vec::is_empty);
        let over = tapped.hall.lines.len();
        tapped.hall.lines.find(over, "held: []", released);
        // Only the node starts again: its old messages answer the same gateway.
        tapped.nodes[1].0.kill().unwrap();
        tapped.nodes[1].0.wait().unwrap();
        let from = tapped.hall.lines.len();
        tapped.nodes[1] = tapped.node("se");
        tapped.hall.await_live("se", from);
        let way = tapped.way_in();
        send(&way, recording.iter().cloned());
        let nothing = |hall: &Hall, from: usize| {
            for line in hall.lines.all().iter().skip(from) {
                assert_eq!(line.done(), None);
                assert!(line.json["held"].as_array().is_none_or(Vec::is_empty), "{line:?}");
            }
        };
        nothing(&tapped.hall, from);
        let said = tapped.hall.end_gateway();
        // The youngest of them may be refused for having come before.
        let old = count(&said, "messages to the gateway older than 250 ms, refused.");
        let again = count(&said, "messages to the gateway that had come before, refused.");
        assert!(old + again >= COME, "{old} are old, {again} had come before: {said:?}");
        // The gateway starts again: no recorded message answers it.
        tapped.hall.start_gateway();
        AREAS.iter().for_each(|area| tapped.hall.await_live(area, 0));
        let way = tapped.way_in();
        send(&way, recording.iter().cloned());
        nothing(&tapped.hall, 0);
        let before = tapped.hall.said().len();
        let said = tapped.hall.end_gateway();
        let words = "messages to the gateway recorded before this start, or from a program that receives nothing, refused.";
        let unanswered = count(&said[before..], words);
        assert!(unanswered >= COME, "{unanswered} answer nothing: {said:?}");
    });
}

// C6
#[test]
fn a_message_that_is_repeated_at_once_counts_once() {
    while_time_is_kept(STANDS_STILL_MS, || {
        let mut tapped = Tapped::open(EMPTY);
        let way = tapped.way_in();
        send(&way, tapped.recording());
        let said = tapped.hall.end_gateway();
        let repeated = count(&said, "messages to the gateway that had come before, refused.");
        // If the copy overtakes the original, the original is refused.
        assert!(repeated >= COME, "{repeated} repeated: {said:?}");
    });
}

// C5
#[test]
fn a_forger_changes_no_event_of_a_foot() {
    while_time_is_kept(STANDS_STILL_MS, || {
        let mut tapped = Tapped::open(&holding(2));
        let way = tapped.way_in();
        let is_over = Arc::<Mutex<bool>>::default();
        let forging = {
            let (is_over, recorded) = (Arc::clone(&is_over), Arc::clone(&tapped.recorded));
            thread::spawn(move || {
                while !*is_over.lock().unwrap() {
                    let latest = recorded.lock().unwrap().last().cloned();
                    if let Some(latest) = latest {
                        let forged = [held(&latest, |own| own + 1), held(&latest, |_| u64::MAX), latest];
                        send(&way, forged);
                    }
                }
            })
        };
        tapped.boards.take().unwrap().finish();
        *is_over.lock().unwrap() = true;
        forging.join().unwrap();
        let done: Vec<String> = tapped
            .hall
            .lines
            .all()
            .iter()
            .filter_map(|line| line.done())
            .map(|(id, done)| format!("{id} {done}"))
            .collect();
        let hold = ["drive pressed", "drive changed", "drive changed", "drive released"];
        assert_eq!(done, hold.repeat(2));
        let said = tapped.hall.end_gateway();
        assert!(
            count(&said, "messages to the gateway not written with this floor's key, refused.") > 1000,
            "{said:?}"
        );
    });
}

/// A program with the floor's key that poses as the node of an area.
struct Impostor {
    transport: TransportEnd,
    session: Arc<Mutex<AuthSession>>,
    started: Instant,
}

impl Impostor {
    fn new(hall: &Hall, area: &str) -> Self {
        let (key, started) = (hall.key(), Instant::now());
        let session = Arc::new(Mutex::new(AuthSession::new(Role::Node, &key, 99, 8)));
        let hearing = Arc::clone(&session);
        let hear = move |bytes: &[u8]| {
            let _ = hearing.lock().unwrap().open(bytes, now(started));
        };
        let transport = TransportEnd::node(&[hall.endpoint()], area, &key, hear).unwrap();
        Self { transport, session, started }
    }

    /// Sends this message for half a second, with the time of each.
    fn tell(&self, message: &NodeMessage) {
        for _ in 0..250 {
            let now = now(self.started);
            let message = NodeMessage { frame: Some(now.micros()), ..message.clone() };
            let mut sealed = Vec::new();
            self.session.lock().unwrap().seal(MessageKind::Node, &encode(&message), now, &mut sealed);
            self.transport.send(sealed);
            thread::sleep(EVERY);
        }
    }
}

fn now(started: Instant) -> units::Instant {
    units::Instant::START + started.elapsed()
}

// C7
#[test]
fn a_node_of_another_version_is_refused_by_name() {
    while_time_is_kept(STANDS_STILL_MS, || {
        let mut hall = Hall::open();
        let impostor = Impostor::new(&hall, "se");
        let other = NodeMessage {
            version: VERSION + 1,
            floor: fingerprint(&hall.floor),
            area: "se".into(),
            name: "of tomorrow\u{1b}[2J".into(),
            held: vec!["drive".into()],
            ..NodeMessage::default()
        };
        impostor.tell(&other);
        impostor.tell(&NodeMessage { version: VERSION, floor: other.floor + 1, ..other.clone() });
        check_untouched(&hall.lines);
        let said = hall.end_gateway();
        let notice = format!(
            "the node at of tomorrow[2J for area \"se\" is not heard: it speaks version {} of the messages, this gateway {VERSION}",
            VERSION + 1
        );
        assert_eq!(said.iter().filter(|line| **line == notice).count(), 1, "{said:?}");
        assert!(count_refused(&said) >= 400, "{said:?}");
        assert!(!hall.lines.all().iter().any(|line| matches!(line.area(), Some(("se", "live")))));
    });
}

/// Number of authentic messages that the gateway has refused, by its last report.
fn count_refused(said: &[String]) -> u64 {
    let counts = said.iter().flat_map(|line| line.split([';', ',', '.']));
    let refused = counts.filter_map(|part| part.trim().strip_suffix(" messages refused")?.parse().ok());
    refused.max().unwrap_or(0)
}

// C10
#[test]
fn of_two_computers_that_serve_one_area_neither_is_believed() {
    while_time_is_kept(STANDS_STILL_MS, || {
        let tapped = Tapped::open(EMPTY);
        let hall = &tapped.hall;
        let from = hall.lines.len();
        let impostor = Impostor::new(hall, "se");
        let idle = NodeMessage {
            version: VERSION,
            floor: fingerprint(&hall.floor),
            area: "se".into(),
            name: "the other".into(),
            ..NodeMessage::default()
        };
        impostor.tell(&idle);
        impostor.tell(&NodeMessage { held: vec!["drive".into()], ..idle });
        hall.lines.find(from, "disputed", |line| line.area() == Some(("se", "disputed")));
        hall.await_notice("Another node serves this area too: neither is believed, and nothing is felt.");
        check_untouched(&hall.lines);
        // The other node has stopped.
        hall.await_live("se", from);
        hall.await_notice("The other node has stopped: this one works again.");
    });
}

// C5
#[test]
fn a_hold_without_its_own_press_is_refused_also_from_a_node() {
    while_time_is_kept(STANDS_STILL_MS, || {
        let mut hall = Hall::open();
        let impostor = Impostor::new(&hall, "se");
        let idle = NodeMessage {
            version: VERSION,
            floor: fingerprint(&hall.floor),
            area: "se".into(),
            ..NodeMessage::default()
        };
        impostor.tell(&idle);
        hall.await_live("se", 0);
        impostor.tell(&NodeMessage { held: vec!["drive".into()], ..idle.clone() });
        check_untouched(&hall.lines);
        let said = hall.end_gateway();
        let words = "1 holds refused, since their controls were not pressed";
        assert!(said.iter().any(|line| line.contains(words)), "{said:?}");
    });
}
