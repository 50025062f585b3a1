//! Sensors, channels and tiles that are switched off, in the floor file and while the floor runs.

use std::net::UdpSocket;
use std::time::Duration;

use rosc::{OscMessage, OscPacket, OscType};
use underfoot::engine::{Engine, Snapshot};
use underfoot::floor::{Corner, Floor, SensorChoice, SensorId, TileId};
use underfoot::layout::Layout;
use underfoot::schema::{Kinds, parse_floor, parse_layout, write_floor};
use underfoot::sense::{Assembler, Method, Quality, SensorHealth, Trouble};
use underfoot::serve::Server;
use underfoot::source::UdpSource;
use underfoot::units::{Instant, Newtons};
use underfoot::widget::EventKind;
use underfoot::wire::SensorPacket;
use underfoot_sim::{self as sim, Foot, SimFloor};

use crate::sender::{ANY_PORT, Sender, simulated, small_floor, standing};

const TILE: TileId = TileId::new(1, 0);
const SENSOR: SensorId = SensorId { tile: TILE, corner: Corner::NorthWest };

/// A button on the whole of the tile.
const BUTTON: &str = r#"Layout(
    version: 1,
    regions: [(id: "all", at: (0, 0), size: (3, 2))],
    widgets: [(id: "middle", kind: "button", at: (1.05, 0.05), size: (0.9, 0.9))],
)"#;

fn button(floor: &Floor) -> Layout {
    parse_layout(BUTTON, "button", &Kinds::builtin(), &floor.geometry).unwrap().layout
}

/// A calibrated floor with a button.
struct Pad {
    floor: Floor,
    sim: SimFloor,
    assembler: Assembler,
    engine: Engine,
    ms: u32,
}

impl Pad {
    fn new(off: &[SensorId]) -> Self {
        let wired = small_floor();
        let sim = simulated(&wired);
        let mut floor = sim::calibrated(&wired, &sim, 7).unwrap();
        off.iter().for_each(|sensor| floor.switch(*sensor, false));
        let engine = Engine::new(floor.geometry, button(&floor), Method::default());
        let mut pad = Self { assembler: Assembler::new(&floor), engine, sim, floor, ms: 0 };
        pad.stand(300, false);
        pad
    }

    /// Runs for `ms` milliseconds, with a foot on the button or without; returns the events of the button and the
    /// greatest distance of the contact from the foot.
    fn stand(&mut self, ms: u32, is_down: bool) -> (Vec<EventKind>, f32) {
        let foot = Foot { force: Newtons(200.0), ..standing(self.floor.geometry.centre(TILE)) };
        let feet = if is_down { vec![foot] } else { Vec::new() };
        let (mut events, mut off_m) = (Vec::new(), 0.0_f32);
        for _ in 0..ms {
            self.ms += 1;
            let received = Instant::from_millis(self.ms.into());
            for (board, readings) in (0..).zip(self.sim.step(&feet)) {
                let readings = readings.clone();
                self.assembler.take(&SensorPacket { board, sequence: self.ms, received, readings });
            }
            while let Some(frame) = self.assembler.ready() {
                let step = self.engine.step(frame);
                events.extend(step.events.iter().map(|event| event.kind));
                let far = |contact: &underfoot::sense::Contact| {
                    contact.centroid.distance(foot.centre_of_pressure())
                };
                off_m = step.contacts.iter().map(far).fold(off_m, f32::max);
            }
        }
        (events, off_m)
    }

    /// Whether a tap presses the button.
    fn tap(&mut self) -> bool {
        let (events, _) = self.stand(300, true);
        self.stand(300, false);
        events.contains(&EventKind::Pressed)
    }

    fn health(&self) -> SensorHealth {
        let mut health = SensorHealth::default();
        self.assembler.health(&mut health);
        health
    }
}

#[test]
fn a_tile_goes_on_with_three_sensors_and_says_which_one_is_off() {
    for is_in_file in [true, false] {
        let mut pad = Pad::new(if is_in_file { &[SENSOR] } else { &[] });
        if !is_in_file {
            pad.assembler.switch(SensorChoice::Sensor(SENSOR), false).unwrap();
        }
        let (_, off_m) = pad.stand(500, true);
        assert!(off_m < 0.05, "in the file {is_in_file}: {off_m}");
        pad.stand(2000, false);
        assert_eq!(pad.health().troubles, [(SENSOR, Trouble::Off)], "it never heals by itself");
        assert_eq!(pad.health().count(Quality::Faulty), 1);
        pad.assembler.switch(SensorChoice::Sensor(SENSOR), true).unwrap();
        pad.stand(10, false);
        assert!(pad.health().is_well(), "{}", pad.health());
        assert!(pad.tap());
    }
}

#[test]
fn a_sensor_that_is_off_may_read_anything() {
    let mut pad = Pad::new(&[SENSOR]);
    for fault in [sim::SensorFault::Short, sim::SensorFault::Open, sim::SensorFault::Offset(Newtons(150.0))] {
        pad.sim.set_fault(SENSOR, Some(fault));
        let (events, _) = pad.stand(1500, false);
        assert_eq!(events, [], "{fault:?}");
        assert_eq!(pad.health().troubles, [(SENSOR, Trouble::Off)], "{fault:?}");
    }
}

#[test]
fn nothing_is_pressed_on_a_tile_that_is_off_and_what_is_held_there_ends() {
    let mut pad = Pad::new(&[]);
    assert!(pad.tap());
    let (events, _) = pad.stand(300, true);
    assert!(events.contains(&EventKind::Pressed));
    pad.assembler.switch(SensorChoice::Tile(TILE), false).unwrap();
    let (events, _) = pad.stand(300, true);
    assert!(events.contains(&EventKind::Cancelled) && !events.contains(&EventKind::Clicked), "{events:?}");
    pad.stand(300, false);
    assert!(!pad.tap() && pad.health().count(Quality::Faulty) == 4);
    // The channels of the same tile, one after the other.
    for channel in 4..8 {
        pad.assembler.switch(SensorChoice::Channel { board: 0, channel }, true).unwrap();
    }
    pad.stand(200, false);
    assert!(pad.tap());
    for none in [SensorChoice::Tile(TileId::new(3, 0)), SensorChoice::Channel { board: 0, channel: 12 }] {
        assert!(pad.assembler.switch(none, false).unwrap_err().to_string().contains("the floor has no"));
    }
}

#[test]
fn a_floor_file_names_them_by_tile_sensor_or_channel() {
    let text = r"Floor(
        version: 3,
        columns: 3,
        rows: 2,
        off: [(tile: (2, 1)), (tile: (0, 0), corner: Se), (board: 0, channel: 6)],
    )";
    let floor = parse_floor(text, "floor.ron").unwrap();
    let mut off: Vec<String> = floor.off.iter().map(ToString::to_string).collect();
    off.sort();
    assert_eq!(off.len(), 6, "{off:?}");
    assert!(
        floor.off.contains(&SENSOR) && !floor.off.contains(&SensorId { corner: Corner::NorthEast, ..SENSOR })
    );
    let written = write_floor(&floor);
    let again = parse_floor(&written, "floor.ron").unwrap();
    assert!(floor.off.iter().all(|sensor| again.off.contains(sensor)) && again.off.len() == 6, "{written}");
    assert!(written.contains("(tile: (2, 1))"), "{written}");
    for (wrong, why) in [
        ("(tile: (3, 0))", "column"),
        ("(board: 2, channel: 0)", "the floor has no sensor on channel 0 of board 2"),
        ("(board: 1)", "channel"),
        ("(corner: Sw)", "this corner needs its tile"),
        ("()", "this names no sensor"),
        ("(tile: (0, 0), board: 0, channel: 0)", "by its tile or by its channel"),
    ] {
        let text = format!("Floor(version: 3, columns: 3, rows: 2, off: [{wrong}])");
        let problems = parse_floor(&text, "floor.ron").unwrap_err().to_string();
        assert!(problems.contains(why), "{wrong}: {problems}");
    }
    let older = "Floor(version: 2, columns: 3, rows: 2, off: [(tile: (0, 0))])";
    assert!(parse_floor(older, "floor.ron").unwrap_err().to_string().contains("need version 3"));
}

#[test]
fn a_request_switches_a_tile_off_on_a_running_floor_and_a_wrong_one_is_answered() {
    let wired = small_floor();
    let sim = simulated(&wired);
    let floor = sim::calibrated(&wired, &sim, 7).unwrap();
    let source = UdpSource::bind(ANY_PORT, &floor).unwrap();
    let port = source.local_addr().unwrap();
    let app = UdpSocket::bind(ANY_PORT).unwrap();
    app.connect(port).unwrap();
    app.set_read_timeout(Some(Duration::from_secs(5))).unwrap();
    let mut server = Server::new(&floor, button(&floor), Method::default(), source);
    let _boards = Sender::start(&floor, sim, port, |sim, _| _ = sim.step(&[]));
    let ask = |path: &str, args: Vec<OscType>| {
        let message = OscMessage { addr: format!("/underfoot/{path}"), args };
        app.send(&rosc::encoder::encode(&OscPacket::Message(message)).unwrap()).unwrap();
    };
    let int = |numbers: &[i32]| numbers.iter().map(|number| OscType::Int(*number)).collect::<Vec<_>>();
    // Whether so many sensors are faulty within some seconds.
    let mut snapshot = Snapshot::default();
    let mut faulty = |wanted: u32| {
        (0..5000).any(|_| {
            server.turn().unwrap();
            server.snapshot(&mut snapshot);
            snapshot.health.count(Quality::Faulty) == wanted
        })
    };
    assert!(faulty(0));
    ask("sensor/tile", int(&[1, 0, 0]));
    assert!(faulty(4));
    ask("sensor/set", [int(&[1, 0]), vec![OscType::String("nw".into()), OscType::Int(1)]].concat());
    assert!(faulty(3));
    ask("sensor/channel", int(&[0, 4, 1]));
    assert!(faulty(2));
    ask("sensor/tile", int(&[9, 9, 0]));
    assert!(!faulty(3), "nothing has changed");
    let mut buffer = [0; 1024];
    let length = app.recv(&mut buffer).unwrap();
    let (_, OscPacket::Message(answer)) = rosc::decoder::decode_udp(&buffer[..length]).unwrap() else {
        panic!("one message")
    };
    let why = OscType::String("the floor has no tile (9, 9) with sensors".into());
    assert_eq!((answer.addr.as_str(), &answer.args[1]), ("/underfoot/error", &why));
}
