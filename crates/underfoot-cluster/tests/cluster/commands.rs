//! Apps send requests to the gateway, as to a single floor; layouts go to all nodes or to none.

use std::net::UdpSocket;
use std::time::{Duration, Instant};

use rosc::{OscMessage, OscPacket, OscType, decoder, encoder};

use crate::hall::{AREAS, Hall, LAYOUT, Program, STANDS_STILL_MS};
use crate::steady::while_time_is_kept;

/// An app.
struct App {
    socket: UdpSocket,
}

impl App {
    fn of(hall: &Hall) -> Self {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        socket.connect(hall.commands).unwrap();
        socket.set_read_timeout(Some(Duration::from_millis(50))).unwrap();
        Self { socket }
    }

    fn ask(&self, path: &str, args: Vec<OscType>) {
        let message = OscPacket::Message(OscMessage { addr: format!("/underfoot/{path}"), args });
        self.socket.send(&encoder::encode(&message).unwrap()).unwrap();
    }

    /// The next answer at `path`: its arguments.
    fn answer(&self, path: &str) -> Vec<OscType> {
        self.answer_within(path, Duration::from_secs(10)).unwrap_or_else(|| panic!("no answer at {path}"))
    }

    fn answer_within(&self, path: &str, patience: Duration) -> Option<Vec<OscType>> {
        let (address, end) = (format!("/underfoot/{path}"), Instant::now() + patience);
        let mut buffer = [0; 4096];
        while Instant::now() < end {
            let Ok(length) = self.socket.recv(&mut buffer) else { continue };
            let (_, packet) = decoder::decode_udp(&buffer[..length]).unwrap();
            if let Some(args) = find(packet, &address) {
                return Some(args);
            }
        }
        None
    }
}

fn find(packet: OscPacket, address: &str) -> Option<Vec<OscType>> {
    match packet {
        OscPacket::Message(message) => (message.addr == address).then_some(message.args),
        OscPacket::Bundle(bundle) => bundle.content.into_iter().find_map(|packet| find(packet, address)),
    }
}

/// A hall with the boards of an empty floor.
fn running() -> (Hall, Vec<Program>, crate::hall::Boards) {
    let hall = Hall::open();
    let nodes = AREAS.iter().map(|area| hall.bare_node(area)).collect();
    let empty = r#"Scenario(title: "Empty", steps: [Wait(ms: 60000)])"#;
    let boards = hall.boards(hall.script(empty), &[]);
    AREAS.iter().for_each(|area| hall.await_live(area, 0));
    (hall, nodes, boards)
}

#[test]
fn a_request_reaches_the_node_of_its_control_and_is_answered_with_what_came_of_it() {
    while_time_is_kept(STANDS_STILL_MS, || {
        let (hall, mut nodes, _boards) = running();
        let app = App::of(&hall);
        // The nodes have no layout but the gateway's.
        hall.await_layout(1);
        app.ask("widget/level/set", vec![OscType::Float(0.5)]);
        hall.lines.find(0, "level at 0.5", |line| line.json["id"] == "level" && line.json["value"] == 0.5);
        app.ask("widget/level/get", vec![]);
        assert_eq!(app.answer("widget/level/value"), [OscType::Float(0.5)]);
        app.ask("widget/nothing/set", vec![OscType::Float(0.5)]);
        let why = app.answer("error");
        assert!(format!("{why:?}").contains("widget/nothing/set"), "{why:?}");
        // Patterns match the controls of all nodes.
        app.ask("widget/*/disable", vec![]);
        app.ask("widget/ticket/get", vec![]);
        let state = app.answer("widget/ticket/state");
        assert_eq!(state[0], OscType::Int(0), "{state:?}");
        app.ask("widget/*/enable", vec![]);
        app.ask("mute/set", vec![OscType::Bool(true)]);
        app.ask("mute/get", vec![]);
        assert_eq!(app.answer("mute")[0], OscType::Int(1));
        app.ask("widget/ticket/disable", vec![]);
        // The gateway does not keep a setting that its node has not confirmed.
        app.ask("widget/ticket/get", vec![]);
        assert_eq!(app.answer("widget/ticket/state")[0], OscType::Int(0));
        // A restarted node has the same state as before; a lost one is the reason for a refusal.
        nodes[0].0.kill().unwrap();
        nodes[0].0.wait().unwrap();
        let from = hall.lines.len();
        hall.lines.find(0, "lost", |line| line.area() == Some(("sw", "lost")));
        app.ask("widget/ticket/label", vec![OscType::String("New".into())]);
        let why = app.answer("error");
        assert!(format!("{why:?}").contains("\\\"sw\\\" is lost"), "{why:?}");
        nodes[0] = hall.bare_node("sw");
        hall.await_live("sw", from);
        let end = Instant::now() + Duration::from_secs(10);
        loop {
            app.ask("widget/ticket/get", vec![]);
            let state = app.answer_within("widget/ticket/state", Duration::from_millis(300));
            if state.as_ref().is_some_and(|state| state[0] == OscType::Int(0)) {
                break;
            }
            assert!(Instant::now() < end, "{state:?}");
        }
    });
}

#[test]
fn a_layout_that_changes_is_on_all_nodes_or_on_none() {
    while_time_is_kept(STANDS_STILL_MS, || {
        let (hall, mut nodes, _boards) = running();
        hall.await_layout(1);
        let app = App::of(&hall);
        let exists = |id: &str| {
            app.ask(&format!("widget/{id}/label"), vec![OscType::String("Here".into())]);
            app.ask(&format!("widget/{id}/get"), vec![]);
        };
        // No node receives a file with an error.
        hall.write_layout(&LAYOUT.replace("\"ticket\", kind: \"button\"", "\"ticket\", kind: \"buton\""));
        hall.await_notice("The last good layout stays");
        hall.write_layout(&LAYOUT.replace("\"ticket\"", "\"entry\"").replace("\"door\"", "\"gatehouse\""));
        hall.await_layout(2);
        for id in ["entry", "gatehouse"] {
            exists(id);
            assert_eq!(app.answer(&format!("widget/{id}/state"))[5], OscType::String("Here".into()));
        }
        // A node that starts later receives it.
        nodes[2].0.kill().unwrap();
        nodes[2].0.wait().unwrap();
        hall.lines.find(0, "lost", |line| line.area() == Some(("nw", "lost")));
        let from = hall.lines.len();
        nodes[2] = hall.bare_node("nw");
        hall.await_live("nw", from);
        hall.await_node_layout(2, 5);
        app.ask("widget/level/get", vec![]);
        assert_eq!(app.answer("widget/level/value").len(), 1);
    });
}
