//! R1 a sensing thread that panics, and every other end of a server: all holds are cancelled first.

use std::net::UdpSocket;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use rosc::{OscPacket, OscType, decoder};
use underfoot::feel::{RendererConfig, renderer};
use underfoot::floor::Floor;
use underfoot::glam::Vec2;
use underfoot::sense::Method;
use underfoot::serve::Server;
use underfoot::sink::{OscSink, SilentSink};
use underfoot::source::{SensorSource, SourceError};
use underfoot::units::Instant;
use underfoot::wire::{LinkCounters, SensorPacket};
use underfoot_sim::{self as sim, SimConfig, SimFloor};

use super::bench::foot;
use crate::support::page;

const PAGE: &str = r#"Layout(version: 1, regions: [(id: "all", at: (0, 0), size: (2, 2))],
    widgets: [(id: "zoom", kind: "slider", at: (0, 0), size: (2, 1))])"#;

/// The cause that ends the packets of [`Drag`].
#[derive(Clone, Copy, Debug, PartialEq)]
enum End {
    /// A program sets the flag that stops the server.
    Stopped,
    /// The recording is over.
    Ended,
    /// The socket is closed.
    Failed,
    /// A program error.
    Panic,
}

/// A foot that lands on the slider and drags it, until the end.
struct Drag {
    sim: SimFloor,
    millis: u32,
    waiting: Vec<SensorPacket>,
    end: End,
    stop: Arc<AtomicBool>,
}

/// Time at which the packets end.
const END_MS: u32 = 900;

impl SensorSource for Drag {
    fn next(&mut self, _: Duration) -> Result<Option<SensorPacket>, SourceError> {
        if let Some(packet) = self.waiting.pop() {
            return Ok(Some(packet));
        }
        self.millis += 1;
        if self.millis >= END_MS {
            match self.end {
                End::Stopped => self.stop.store(true, Ordering::Relaxed),
                End::Ended => return Err(SourceError::Ended),
                End::Failed => {
                    let source = std::io::ErrorKind::ConnectionReset.into();
                    return Err(SourceError::Socket { message: "gone".into(), source });
                }
                End::Panic => panic!("a mistake of ours, for this test"),
            }
        }
        let share = |since: u32, span: f32| (self.millis.saturating_sub(since) as f32 / span).min(1.0);
        let at = Vec2::new(0.1 + 0.25 * share(400, 300.0), 0.15);
        let feet: Vec<_> =
            (self.millis > 200).then(|| foot(at, 120.0 * share(200, 50.0))).into_iter().collect();
        let (received, sequence) = (self.now(), self.millis);
        let boards = (0..).zip(self.sim.step(&feet));
        self.waiting.extend(boards.map(|(board, readings)| SensorPacket {
            board,
            sequence,
            received,
            readings: readings.clone(),
        }));
        Ok(self.waiting.pop())
    }

    fn now(&self) -> Instant {
        Instant::from_millis(self.millis.into())
    }

    fn counters(&self) -> LinkCounters {
        LinkCounters::default()
    }
}

/// All messages until none has come for some time.
fn hear(app: &UdpSocket) -> Vec<(String, Vec<OscType>)> {
    let mut told = Vec::new();
    let mut bytes = [0; 2048];
    while let Ok(length) = app.recv(&mut bytes) {
        let mut packets = vec![decoder::decode_udp(&bytes[..length]).unwrap().1];
        while let Some(packet) = packets.pop() {
            match packet {
                OscPacket::Bundle(bundle) => packets.extend(bundle.content.into_iter().rev()),
                OscPacket::Message(message) => told.push((message.addr, message.args)),
            }
        }
    }
    told
}

/// All reports about controls and contacts, in order, contacts by their number only.
fn told(end: End) -> Vec<(String, Vec<OscType>)> {
    let app = UdpSocket::bind("127.0.0.1:0").unwrap();
    app.set_read_timeout(Some(Duration::from_secs(2))).unwrap();
    let wired = Floor::of(underfoot::floor::Geometry::of_paper_tiles(2, 2).unwrap());
    let sim = SimFloor::new(&wired, SimConfig::default(), 3);
    let floor = sim::calibrated(&wired, &sim, 3).unwrap();
    let target = app.local_addr().unwrap();
    let told = std::thread::spawn(move || hear(&app));
    let stop = Arc::new(AtomicBool::new(false));
    let source = Drag { sim, millis: 0, waiting: Vec::new(), end, stop: Arc::clone(&stop) };
    let (feel, renderer) = renderer(RendererConfig::of(&floor, 8000));
    let played = SilentSink::new(renderer, Instant::START, None);
    let mut server = Server::new(&floor, page(PAGE), Method::default(), source)
        .with_feel(feel, Box::new(played))
        .with_events(Box::new(OscSink::new(target).unwrap()));
    let served = catch_unwind(AssertUnwindSafe(move || server.run(&stop).is_ok()));
    match end {
        End::Stopped | End::Ended => assert!(served.unwrap()),
        End::Failed => assert!(!served.unwrap()),
        End::Panic => assert!(served.is_err()),
    }
    let mut told = told.join().unwrap();
    told.retain(|(address, _)| address.contains("/widget/") || address == "/underfoot/contacts");
    told
}

#[test]
fn r1_every_end_of_a_server_cancels_what_is_held_then_says_so_then_goodbye() {
    for end in [End::Stopped, End::Ended, End::Failed, End::Panic] {
        let told = told(end);
        let place = |what: &str| {
            let address = format!("/underfoot/widget/zoom/{what}");
            told.iter().rposition(|(told, _)| *told == address)
        };
        assert_eq!(place("released"), None, "{end:?}");
        let (changed, cancelled) = (place("changed").unwrap(), place("cancelled").unwrap());
        let held = place("held").unwrap();
        let goodbye = told.iter().rposition(|(address, _)| address == "/underfoot/contacts").unwrap();
        assert!(changed < cancelled && cancelled < held && held < goodbye, "{end:?}: {:?}", &told[changed..]);
        assert_eq!(told[changed].1[0], OscType::Float(0.0), "{end:?}: back to where it was");
        assert_eq!(told[held].1[0], OscType::Int(0), "{end:?}");
        assert_eq!(told[goodbye].1[0], OscType::Int(0), "{end:?}");
        let holds = told
            .iter()
            .filter(|(address, args)| address == "/underfoot/widget/zoom/held" && args[0] == OscType::Int(1));
        // Pressed at about 230 ms of simulated time: 50 reports a second until 900 ms. Time runs faster here than
        // datagrams are sent, and a repetition that finds the queue full is left out.
        let count = holds.count();
        assert!((10..=36).contains(&count), "{end:?}: {count} times held");
    }
}
