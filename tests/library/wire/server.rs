//! A server without sockets: its handling of packets, silence and requests.

use std::collections::VecDeque;
use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::mpsc;
use std::time::Duration;

use crate::support::layout;
use underfoot::engine::Snapshot;
use underfoot::feel::{Gesture, RendererConfig, renderer};
use underfoot::floor::{Corner, Floor, SensorId, TileId};
use underfoot::schema::Effects;
use underfoot::sense::{Method, Quality};
use underfoot::serve::{Ended, FloorCommand, Server};
use underfoot::sink::{ActuatorSink, EventSink, ManualSink, Report, SinkError, wait_free_shared};
use underfoot::source::{FloorInput, Port, SensorSource, SourceError};
use underfoot::units::{Instant, Newtons};
use underfoot::widget::{EventKind, Value, WidgetId};
use underfoot::wire::{ControlMessage, LinkCause, LinkCounters, LinkState, Request, SensorPacket};
use underfoot_sim::{self as sim, Foot, SensorFault, SimConfig, SimFloor};

/// Packets of a foot on `home`, with silences in between, in which only the clock advances.
struct Visit {
    sim: SimFloor,
    /// Milliseconds with (`Some`) or without packets, and the force on `home`.
    acts: VecDeque<(u32, Option<f32>)>,
    millis: u32,
    waiting: VecDeque<SensorPacket>,
    foot: Foot,
    /// Sensors that break, with their times.
    breaks: VecDeque<(u32, SensorId, Option<SensorFault>)>,
}

/// Requests that arrive beside the visit, without a network.
struct Requests(VecDeque<ControlMessage>);

impl Port for Requests {
    fn take_request(&mut self) -> Option<Request> {
        self.0.pop_front().map(Request::from)
    }

    fn answer(&mut self, _: SocketAddr, _: &[u8]) {}

    fn local_addr(&self) -> Option<SocketAddr> {
        None
    }

    fn last_refused(&self) -> Option<LinkCause> {
        None
    }
}

impl SensorSource for Visit {
    fn next(&mut self, _: Duration) -> Result<Option<SensorPacket>, SourceError> {
        if let Some(packet) = self.waiting.pop_front() {
            return Ok(Some(packet));
        }
        let Some((left, force)) = self.acts.front_mut() else { return Err(SourceError::Ended) };
        *left -= 1;
        let (over, force) = (*left == 0, *force);
        if over {
            self.acts.pop_front();
        }
        self.millis += 1;
        while let Some((_, sensor, fault)) = self.breaks.pop_front_if(|(at, ..)| *at <= self.millis) {
            self.sim.set_fault(sensor, fault);
        }
        let Some(force) = force else { return Ok(None) };
        self.foot.force = Newtons(force);
        let received = self.now();
        let sequence = self.millis;
        for (board, readings) in (0..).zip(self.sim.step(&[self.foot])) {
            self.waiting.push_back(SensorPacket { board, sequence, received, readings: readings.clone() });
        }
        Ok(self.waiting.pop_front())
    }

    fn now(&self) -> Instant {
        Instant::from_millis(self.millis.into())
    }

    fn counters(&self) -> LinkCounters {
        LinkCounters::default()
    }
}

/// Records all reports with their times in milliseconds.
struct Notes(mpsc::Sender<(u64, String)>);

impl EventSink for Notes {
    fn report(&mut self, report: &Report<'_>) {
        let (at, what) = match report {
            Report::Event(event) => (event.at, format!("{} {}", event.id, event.kind.name())),
            Report::Link(at, state) => (*at, format!("link {state:?}")),
            Report::Health(at, health) => (*at, format!("health {health}")),
            _ => return,
        };
        self.0.send((at.micros() / 1000, what)).unwrap();
    }
}

fn server(
    acts: &[(u32, Option<f32>)],
    requests: &[ControlMessage],
) -> (Server, mpsc::Receiver<(u64, String)>) {
    let wired = Floor::default();
    let sim = SimFloor::new(&wired, SimConfig::default(), 9);
    let floor = sim::calibrated(&wired, &sim, 9).unwrap();
    server_on(&floor, sim, acts, requests, &[])
}

fn server_on(
    floor: &Floor,
    sim: SimFloor,
    acts: &[(u32, Option<f32>)],
    requests: &[ControlMessage],
    breaks: &[(u32, SensorId, Option<SensorFault>)],
) -> (Server, mpsc::Receiver<(u64, String)>) {
    let page = layout("map");
    let home = page.widgets[page.widget_index("home").unwrap()].area.centre();
    let mut foot =
        Foot { position: home, heading: 0.0, length_m: 0.26, force: Newtons::ZERO, roll: 0.6, left: false };
    foot.position += home - foot.centre_of_pressure();
    let visit = Visit {
        sim,
        acts: acts.iter().copied().collect(),
        millis: 0,
        waiting: VecDeque::new(),
        foot,
        breaks: breaks.iter().copied().collect(),
    };
    let requests = Requests(requests.iter().cloned().collect());
    let input = FloorInput { port: Some(Box::new(requests)), ..visit.into() };
    let (tell, told) = mpsc::channel();
    let server = Server::new(floor, page, Method::default(), input).with_events(Box::new(Notes(tell)));
    (server, told)
}

fn play(server: &mut Server) {
    while server.turn().unwrap() == Ended::No {}
}

const EMPTY: Option<f32> = Some(0.0);
const PRESSED: Option<f32> = Some(150.0);

#[test]
fn silence_is_a_lost_floor_within_120_ms_and_the_return_wants_a_lift() {
    // 200 ms empty, 200 ms pressed, 500 ms of silence, pressed again, lifted, pressed.
    let acts = [(200, EMPTY), (200, PRESSED), (500, None), (400, PRESSED), (200, EMPTY), (200, PRESSED)];
    let (mut server, told) = server(&acts, &[]);
    play(&mut server);
    drop(server);
    let told: Vec<_> = told.iter().collect();
    let words: Vec<_> = told.iter().map(|(_, what)| what.as_str()).collect();
    let expected = [
        "link Live",
        "home pressed",
        "link Lost",
        "home cancelled",
        "link Live",
        "home pressed",
        "home cancelled",
    ];
    assert_eq!(words, expected, "{told:?}");
    let cancelled = told.iter().find(|(_, what)| what == "home cancelled").unwrap().0;
    assert!((500..=520).contains(&cancelled), "silent from 400 ms on, released at {cancelled} ms");
    assert!(told.last().unwrap().0 > 1500, "not before it was lifted");
}

#[test]
fn apps_set_disable_and_enable_controls_over_the_wire_and_over_the_channel() {
    let id = |name: &str| WidgetId::new(name);
    let requests = [
        ControlMessage::Set { id: id("zoom"), value: Value::Number(0.75) },
        // Some apps can only send numbers.
        ControlMessage::Set { id: id("satellite"), value: Value::Number(1.0) },
        ControlMessage::Disable { id: id("home") },
        ControlMessage::Enable { id: id("nowhere") },
    ];
    let (server, told) = server(&[(200, EMPTY), (200, PRESSED), (100, EMPTY)], &requests);
    let (commands, received) = wait_free_shared(8);
    let mut server = server.with_commands(received);
    commands
        .send(FloorCommand::Control(ControlMessage::Set { id: id("zoom"), value: Value::Number(0.5) }))
        .unwrap();
    play(&mut server);
    assert_eq!(server.engine().value("zoom"), Some(Value::Number(0.5)), "the channel came last");
    assert_eq!(server.engine().value("satellite"), Some(Value::Switch(true)));
    drop(server);
    assert_eq!(told.iter().map(|(_, what)| what).collect::<Vec<_>>(), ["link Live"]);
}

#[test]
fn a_new_layout_is_on_the_floor_at_once_and_shown_with_its_revision() {
    let (server, _told) = server(&[(300, EMPTY)], &[]);
    let (commands, received) = wait_free_shared(8);
    let (input, mut snapshots) = triple_buffer::triple_buffer(&Snapshot::default());
    let mut server = server.with_commands(received).with_snapshots(input);
    commands.send(FloorCommand::SetLayout(Box::new(layout("surgical")))).unwrap();
    play(&mut server);
    assert_eq!(server.engine().layout().title, layout("surgical").title);
    let snapshot = snapshots.read();
    assert_eq!(snapshot.layout_revision, 1);
    assert_eq!(snapshot.widgets.len(), layout("surgical").widgets.len());
    assert_eq!(snapshot.link, LinkState::Live);
}

/// A sink with a full disk from the start.
struct Broken;

impl ActuatorSink for Broken {
    fn advance(&mut self, _: Instant) -> Result<(), SinkError> {
        Err(SinkError::Device { message: "it is gone".into() })
    }
}

#[test]
fn controls_go_on_without_actuators() {
    let (server, told) = server(&[(200, EMPTY), (200, PRESSED), (100, EMPTY)], &[]);
    let (feel, _renderer) = renderer(RendererConfig::of(&Floor::default(), 48_000));
    let mut server = server.with_feel(feel, Box::new(Broken));
    play(&mut server);
    drop(server);
    assert!(told.iter().any(|(_, what)| what == "home clicked"));
}

/// A manual sink that the test examines while the server owns it.
struct Watched(ManualSink, mpsc::Sender<(u64, Instant)>);

impl ActuatorSink for Watched {
    fn advance(&mut self, now: Instant) -> Result<(), SinkError> {
        self.0.advance(now)
    }
}

impl Drop for Watched {
    fn drop(&mut self) {
        for onset in self.0.onsets() {
            self.1.send(onset).unwrap();
        }
    }
}

#[test]
fn a_click_starts_with_the_sample_of_its_press() {
    let (server, told) = server(&[(200, EMPTY), (200, PRESSED), (100, EMPTY)], &[]);
    let (feel, renderer) = renderer(RendererConfig::of(&Floor::default(), 48_000));
    let (tell, onsets) = mpsc::channel();
    let sink = Watched(ManualSink::new(renderer, Instant::START), tell);
    let mut server = server.with_feel(feel, Box::new(sink));
    play(&mut server);
    drop(server);
    let pressed =
        told.iter().find(|(_, what)| *what == format!("home {}", EventKind::Pressed.name())).unwrap().0;
    let first = onsets.iter().next().unwrap().0;
    assert_eq!(first, pressed * 48, "48 samples a millisecond");
}

/// An effect tried in the window is played like a control's answer, and the floor continues meanwhile.
#[test]
fn an_effect_can_be_tried_while_the_floor_works() {
    let (server, told) = server(&[(300, EMPTY), (200, PRESSED), (400, EMPTY)], &[]);
    let (feel, renderer) = renderer(RendererConfig::of(&Floor::default(), 48_000));
    let (tell, onsets) = mpsc::channel();
    let sink = Watched(ManualSink::new(renderer, Instant::START), tell);
    let (commands, received) = wait_free_shared(8);
    let mut server = server.with_feel(feel, Box::new(sink)).with_commands(received);
    let effect = Arc::clone(&Effects::builtin().get("double_click").unwrap().effect);
    let gesture = Box::new(Gesture::usual(&effect));
    commands.send(FloorCommand::Audition { effect, gesture, tile: 30 }).unwrap();
    play(&mut server);
    drop(server);
    assert!(told.iter().any(|(_, what)| what == "home clicked"));
    let frames: Vec<u64> = onsets.iter().map(|(frame, _)| frame).collect();
    // The two clicks of the effect, 70 ms apart, and those of the button.
    assert!(frames.len() >= 4, "{frames:?}");
    assert!(frames[1].abs_diff(frames[0] + 70 * 48) <= 1, "{frames:?}");
}

#[test]
fn the_sensors_health_is_told_when_it_changes_and_once_a_second_at_most() {
    let wired = Floor::default();
    let sim = SimFloor::new(&wired, SimConfig::default(), 9);
    let floor = sim::calibrated(&wired, &sim, 9).unwrap();
    let sensor = |column| SensorId { tile: TileId::new(column, 1), corner: Corner::SouthWest };
    // Two break in the first second, one of them is repaired later.
    let open = Some(SensorFault::Open);
    let breaks = [(1500, sensor(0), open), (1700, sensor(3), open), (4000, sensor(0), None)];
    let (mut server, told) = server_on(&floor, sim, &[(8000, Some(0.0))], &[], &breaks);
    play(&mut server);
    let mut snapshot = Snapshot::default();
    server.snapshot(&mut snapshot);
    assert_eq!((snapshot.health.count(Quality::Faulty), snapshot.counters.sensor_troubles), (1, 2));
    drop(server);
    let told: Vec<_> = told.iter().filter(|(_, what)| what.starts_with("health")).collect();
    let what: Vec<_> = told.iter().map(|(_, what)| what.trim_start_matches("health ")).collect();
    // A healthy state at the start is not reported.
    assert_eq!(what, ["1 faulty, 143 live", "2 faulty, 142 live", "1 faulty, 143 live"]);
    assert!(told.windows(2).all(|pair| pair[1].0 - pair[0].0 >= 1000), "{told:?}");
    assert!((1500..1650).contains(&told[0].0), "at once, if the last was a second ago: {told:?}");
}

#[test]
fn s9_the_floor_file_of_another_floor_is_noticed_and_nothing_is_trusted() {
    let wired = Floor::default();
    for (seed, foreign) in [(9, false), (10, true), (11, true), (12, true)] {
        let sim = SimFloor::new(&wired, SimConfig::default(), 9);
        let other = SimFloor::new(&wired, SimConfig::default(), seed);
        let floor = sim::calibrated(&wired, &other, seed).unwrap();
        let (mut server, _told) = server_on(&floor, sim, &[(1000, Some(0.0))], &[], &[]);
        play(&mut server);
        let mut snapshot = Snapshot::default();
        server.snapshot(&mut snapshot);
        assert_eq!(snapshot.health.foreign, foreign, "floor {seed}");
        let degraded = if foreign { 144 } else { 0 };
        assert_eq!(snapshot.health.counts, [144 - degraded, degraded, 0, 0], "floor {seed}");
    }
}
