//! A client that receives OSC and TUIO, reads JSON lines, and ends each hold 100 ms after its last report.

use std::io::{BufRead, BufReader};
use std::net::{SocketAddr, UdpSocket};
use std::process::Child;
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

use rosc::{OscMessage, OscPacket, OscType, decoder};
use serde_json::Value;

#[path = "../../../../../examples/held/mod.rs"]
mod held;

use held::{BELIEVED_FOR, Held};

/// Time-out for an event that must happen.
const AT_LAST: Duration = Duration::from_secs(30);

/// An address and its arguments.
type Heard = (String, Vec<OscType>);

pub struct Client {
    osc: UdpSocket,
    tuio: UdpSocket,
    /// Every message but `alive`, `held` and `contact`, in order, and the number of the last two.
    heard: Vec<Heard>,
    pub alive: Vec<i32>,
    held: Held,
    /// Whether the last TUIO frame had no contact.
    tuio_is_empty: bool,
    lines: Option<Receiver<Value>>,
    json: Vec<Value>,
    json_held: (Vec<String>, Instant),
    /// The program's standard error, once it has ended.
    pub chatter: Option<Vec<String>>,
}

impl Client {
    pub fn new() -> Self {
        let socket = || {
            let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
            socket.set_nonblocking(true).unwrap();
            socket
        };
        Self {
            osc: socket(),
            tuio: socket(),
            heard: Vec::new(),
            alive: Vec::new(),
            held: Held::default(),
            tuio_is_empty: true,
            lines: None,
            json: Vec::new(),
            json_held: (Vec::new(), Instant::now()),
            chatter: None,
        }
    }

    pub fn addresses(&self) -> [SocketAddr; 2] {
        [&self.osc, &self.tuio].map(|socket| socket.local_addr().unwrap())
    }

    /// Reads the program's output from now on.
    pub fn watch_json(&mut self, child: &mut Child) {
        let out = BufReader::new(child.stdout.take().unwrap());
        let (tell, lines) = channel();
        thread::spawn(move || {
            for line in out.lines().map_while(Result::ok) {
                if tell.send(serde_json::from_str(&line).unwrap()).is_err() {
                    break;
                }
            }
        });
        self.lines = Some(lines);
    }

    pub fn wait_until(&mut self, what: &str, mut happened: impl FnMut(&mut Self) -> bool) {
        let end = Instant::now() + AT_LAST;
        loop {
            self.hear();
            if happened(self) {
                return;
            }
            assert!(Instant::now() < end, "never happened: {what}; heard {:?}", self.heard);
            thread::sleep(Duration::from_millis(1));
        }
    }

    /// Receives the messages that are still on their way after all others have ended.
    pub fn hear_the_rest(&mut self) {
        self.hear();
        // The thread that reads ends with the pipe.
        let rest: Vec<Value> = self.lines.take().into_iter().flatten().collect();
        rest.into_iter().for_each(|line| self.read(line));
    }

    fn hear(&mut self) {
        let now = Instant::now();
        let mut bytes = [0; 2048];
        while let Ok(length) = self.osc.recv(&mut bytes) {
            for message in messages(decoder::decode_udp(&bytes[..length]).unwrap().1) {
                if self.held.take(&message, now) {
                    continue;
                }
                match (message.addr.as_str(), message.args.as_slice()) {
                    ("/underfoot/alive", [OscType::Int(sequence)]) => self.alive.push(*sequence),
                    ("/underfoot/contact", _) => {}
                    _ => self.heard.push((message.addr, message.args)),
                }
            }
        }
        while let Ok(length) = self.tuio.recv(&mut bytes) {
            for message in messages(decoder::decode_udp(&bytes[..length]).unwrap().1) {
                if message.args.first() == Some(&OscType::String("alive".into())) {
                    self.tuio_is_empty = message.args.len() == 1;
                }
            }
        }
        let lines: Vec<Value> = self.lines.iter().flat_map(Receiver::try_iter).collect();
        lines.into_iter().for_each(|line| self.read(line));
    }

    fn read(&mut self, line: Value) {
        if let Some(held) = line["held"].as_array() {
            let mut held: Vec<String> = held.iter().map(|id| id.as_str().unwrap().to_string()).collect();
            held.sort();
            self.json_held = (held, Instant::now());
        }
        self.json.push(line);
    }

    /// The holds of an app that listens to OSC.
    pub fn holds(&mut self) -> Vec<String> {
        self.held.at(Instant::now())
    }

    /// The holds of an app that reads JSON lines, by the same rule.
    pub fn json_holds(&self) -> Vec<String> {
        let (held, at) = &self.json_held;
        if at.elapsed() < BELIEVED_FOR { held.clone() } else { Vec::new() }
    }

    /// Number of such OSC messages about a control.
    pub fn said(&self, id: &str, what: &str) -> usize {
        let address = format!("/underfoot/widget/{id}/{what}");
        self.heard.iter().filter(|(heard, _)| *heard == address).count()
    }

    /// Checks that both controls were cancelled and not released, on every output with events of controls, and that
    /// the slider returned to its old value.
    pub fn expect_cancelled(&self, after: &str) {
        for id in ["drive", "zoom"] {
            assert_eq!(self.said(id, "cancelled"), 1, "{after}: {id}, heard {:?}", self.heard);
            assert_eq!(self.said(id, "released"), 0, "{after}: {id}");
            let in_json = |what: &str| {
                self.json.iter().filter(|line| line["id"] == id && line["event"] == what).count()
            };
            assert_eq!((in_json("cancelled"), in_json("released")), (1, 0), "{after}: {id}");
        }
        let changed = |(address, args): &Heard| {
            (address == "/underfoot/widget/zoom/changed").then(|| args[0].clone().float().unwrap())
        };
        let values: Vec<f32> = self.heard.iter().filter_map(changed).collect();
        assert!(values.iter().any(|value| *value > 0.1), "{after}: it was dragged, {values:?}");
        assert_eq!(values.last(), Some(&0.0), "{after}: and went back");
    }

    /// Like [`Client::expect_cancelled`], followed by a report of an empty floor.
    pub fn expect_an_orderly_end(&self, after: &str) {
        self.expect_cancelled(after);
        let place = |wanted: &dyn Fn(&Heard) -> bool| self.heard.iter().rposition(wanted);
        let goodbye = place(&|(address, args)| {
            address == "/underfoot/contacts" && args.as_slice() == [OscType::Int(0)]
        });
        let cancelled = place(&|(address, _)| address.ends_with("/cancelled"));
        assert!(cancelled < goodbye, "{after}: cancelled {cancelled:?}, goodbye {goodbye:?}");
        assert!(self.tuio_is_empty, "{after}: TUIO still shows somebody");
        assert_eq!(
            self.json.iter().rfind(|line| line["held"].is_array()).unwrap()["held"],
            Value::Array(vec![])
        );
        assert!(self.alive.is_sorted_by(|a, b| a < b) && self.alive.len() > 3, "{after}: {:?}", self.alive);
    }
}

/// The messages of a packet, with bundles unpacked.
fn messages(packet: OscPacket) -> Vec<OscMessage> {
    match packet {
        OscPacket::Message(message) => vec![message],
        OscPacket::Bundle(bundle) => bundle.content.into_iter().flat_map(messages).collect(),
    }
}
