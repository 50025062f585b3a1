//! Muting over OSC: a real socket, feet on a simulated floor that sends real datagrams, and the samples in a file.

use std::net::UdpSocket;
use std::path::Path;
use std::time::Duration;

use rosc::{OscMessage, OscPacket, OscType};
use underfoot::feel::{RendererConfig, renderer};
use underfoot::floor::{Floor, Geometry};
use underfoot::glam::Vec2;
use underfoot::layout::Layout;
use underfoot::schema::{Kinds, parse_layout};
use underfoot::sense::Method;
use underfoot::serve::Server;
use underfoot::sink::{OscSink, WavOptions, WavSink, WhenFull};
use underfoot::source::UdpSource;
use underfoot::units::{HostClock, Instant, Newtons};
use underfoot::wire::Prefix;
use underfoot_sim::{self as sim, Foot};

use crate::sender::{ANY_PORT, Sender, simulated, small_floor, standing};

/// A button on each of two tiles at opposite ends: a foot cannot reach both.
const TWO_BUTTONS: &str = r#"Layout(
    version: 1,
    regions: [(id: "all", at: (0, 0), size: (3, 2))],
    widgets: [
        (id: "west", kind: "button", at: (0.05, 0.05), size: (0.9, 0.9)),
        (id: "east", kind: "button", at: (2.05, 0.05), size: (0.9, 0.9)),
    ],
)"#;

/// Samples per second of the recording.
const RATE: u32 = 8000;

fn two_buttons(geometry: &Geometry) -> Layout {
    parse_layout(TWO_BUTTONS, "two.ron", &Kinds::builtin(), geometry).unwrap().layout
}

/// In each half second a foot stands for 150 ms: on the west button, then on the east one.
fn tapping(geometry: &Geometry, ms: u32) -> Option<Foot> {
    let column = ms / 500 % 2 * 2;
    let middle = geometry.centre(geometry.tile_under(Vec2::new(0.1 + 0.304 * column as f32, 0.1)).unwrap());
    // The force of a press and not of a step.
    (150..300).contains(&(ms % 500)).then(|| Foot { force: Newtons(150.0), ..standing(middle) })
}

/// A running floor, an app that sends requests, and another that listens.
struct Room {
    server: Server,
    clock: HostClock,
    app: UdpSocket,
    listener: UdpSocket,
    /// Start of the recording.
    start: Instant,
}

impl Room {
    fn new(wav: &Path, floor: &Floor) -> Self {
        let source = UdpSource::bind(ANY_PORT, floor).unwrap();
        let (clock, app, listener) =
            (source.clock(), UdpSocket::bind(ANY_PORT).unwrap(), UdpSocket::bind(ANY_PORT).unwrap());
        app.connect(source.local_addr().unwrap()).unwrap();
        for socket in [&app, &listener] {
            socket.set_read_timeout(Some(Duration::from_secs(5))).unwrap();
        }
        let (feel, renderer) = renderer(RendererConfig::of(floor, RATE));
        let start = clock();
        let options = WavOptions::default().with_start(start).with_when_full(WhenFull::Wait);
        let wav = WavSink::create(wav, renderer, options).unwrap();
        let told = OscSink::under(listener.local_addr().unwrap(), Prefix::default()).unwrap();
        let server = Server::new(floor, two_buttons(&floor.geometry), Method::default(), source)
            .with_feel(feel, Box::new(wav))
            .with_events(Box::new(told));
        Self { server, clock, app, listener, start }
    }

    /// Sends a message from the app.
    fn ask(&self, path: &str, args: &[i32]) {
        let args = args.iter().map(|number| OscType::Int(*number)).collect();
        let message = OscPacket::Message(OscMessage { addr: format!("/underfoot/mute/{path}"), args });
        self.app.send(&rosc::encoder::encode(&message).unwrap()).unwrap();
    }

    /// Serves the floor until both buttons were tapped once more; returns that part of the recording.
    fn serve_a_second(&mut self) -> std::ops::Range<usize> {
        let begun = (self.clock)();
        while (self.clock)().since(begun) < Duration::from_secs(1) {
            self.server.turn().unwrap();
        }
        let sample = |at: Instant| (at.since(self.start).as_secs_f64() * f64::from(RATE)) as usize;
        // A request takes a moment to arrive, and 5 ms to fade; the latest tap rings out.
        sample(begun + Duration::from_millis(60))..sample((self.clock)())
    }

    fn answer(&self) -> (String, Vec<OscType>) {
        message(&self.app).expect("an answer")
    }

    /// The mute reports to listeners so far.
    fn told(&self) -> Vec<Vec<i32>> {
        self.listener.set_read_timeout(Some(Duration::from_millis(200))).unwrap();
        let all = std::iter::from_fn(|| message(&self.listener));
        let mutes = all.filter(|(address, _)| address == "/underfoot/mute");
        mutes.map(|(_, args)| args.into_iter().map(|arg| arg.int().unwrap()).collect()).collect()
    }
}

/// The next message; the first one of a bundle.
fn message(socket: &UdpSocket) -> Option<(String, Vec<OscType>)> {
    let mut buffer = [0; 2048];
    let length = socket.recv(&mut buffer).ok()?;
    match rosc::decoder::decode_udp(&buffer[..length]).unwrap().1 {
        OscPacket::Message(message) => Some((message.addr, message.args)),
        OscPacket::Bundle(_) => Some((String::new(), Vec::new())),
    }
}

#[test]
fn a_muted_tile_is_silent_and_the_others_play_until_all_are() {
    let folder = tempfile::tempdir().unwrap();
    let wav = folder.path().join("out.wav");
    let wired = small_floor();
    let sim = simulated(&wired);
    let floor = sim::calibrated(&wired, &sim, 7).unwrap();
    let mut room = Room::new(&wav, &floor);
    let geometry = floor.geometry;
    let target = room.app.peer_addr().unwrap();
    let sender = Sender::start(&floor, sim, target, move |sim, ms| {
        sim.step(tapping(&geometry, ms).as_slice());
    });

    let open = room.serve_a_second();
    let before = room.server.feel_counters().muted;
    room.ask("tile", &[0, 0, 1]);
    let west_muted = room.serve_a_second();
    let counted = room.server.feel_counters().muted;
    room.ask("get", &[]);
    room.ask("set", &[1]);
    let all_muted = room.serve_a_second();
    assert_eq!(room.answer(), ("/underfoot/mute".into(), [0, 0, 0].map(OscType::Int).into()));
    room.ask("tile", &[0, 0, 0]);
    room.ask("set", &[0]);
    room.ask("tile", &[7, 0, 1]);
    let open_again = room.serve_a_second();
    let (address, args) = room.answer();
    assert_eq!(address, "/underfoot/error");
    assert_eq!(args[1], OscType::String("the floor has no such tile".into()));
    assert_eq!(room.server.counters().denied, 1);
    drop(sender);
    let told = room.told();
    drop(room);

    assert_eq!(before, 0);
    assert!(counted >= 2, "press and release of the west button are counted: {counted}");
    // All apps receive the answer to one app's request.
    assert_eq!(told, [vec![0, 0, 0], vec![0, 0, 0], vec![1, 0, 0], vec![1], vec![0]]);

    let mut reader = hound::WavReader::open(&wav).unwrap();
    let samples: Vec<i32> = reader.samples::<i32>().map(Result::unwrap).collect();
    let peak = |tile: usize, part: &std::ops::Range<usize>| {
        let frames = samples.chunks_exact(6).take(part.end).skip(part.start);
        frames.map(|frame| frame[tile].unsigned_abs()).max().unwrap() as f32 / (1 << 23) as f32
    };
    let (west, east) = (0, 2);
    for part in [&open, &open_again] {
        assert!(
            peak(west, part) > 0.02 && peak(east, part) > 0.02,
            "{} {}",
            peak(west, part),
            peak(east, part)
        );
    }
    assert_eq!(peak(west, &west_muted), 0.0);
    assert!(peak(east, &west_muted) > 0.02);
    for tile in 0..6 {
        assert_eq!(peak(tile, &all_muted), 0.0, "tile {tile}");
    }
}
