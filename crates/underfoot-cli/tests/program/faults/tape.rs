//! Floors on tape: a recording of the boards' packets while a test moves feet and breaks parts, which the program
//! replays.

use std::time::Duration;

use serde_json::Value;
use underfoot::floor::{Corner, Floor, Geometry, SensorId, TileId};
use underfoot::glam::Vec2;
use underfoot::layout::Layout;
use underfoot::recording::{Recorded, Recorder, WhenBehind};
use underfoot::schema::{Kinds, parse_layout};
use underfoot::sense::Method;
use underfoot::source::{SensorSource, SourceError};
use underfoot::units::{Instant, Newtons};
use underfoot::wire::{LinkCounters, SensorPacket};
use underfoot_sim::{self as sim, Foot, SensorFault, SimConfig, SimFloor, SimulatedSensors};

use crate::end_to_end::{said, underfoot};

/// A button of the shipped kind (60 N, 40 N, 20 ms) on the south-west tile.
pub const BUTTON: &str = r#"Layout(version: 1, regions: [(id: "all", at: (0, 0), size: (2, 2))],
    widgets: [(id: "it", kind: "button", at: (0, 0), size: (1, 1))])"#;

/// A dead man's pedal in its place.
pub const PEDAL: &str = r#"Layout(version: 1, regions: [(id: "all", at: (0, 0), size: (2, 2))],
    widgets: [(id: "it", kind: "dead_man", at: (0, 0), size: (1, 1))])"#;

/// The control's middle, which is the middle of its tile.
pub const MIDDLE: Vec2 = Vec2::splat(0.152);

/// The tile under the control.
pub const TILE: TileId = TileId::new(0, 0);

/// Names of the events of one deliberate press.
pub const CLICK: [&str; 3] = ["it pressed", "it released", "it clicked"];

/// Time in which a foot applies or removes its force: fast, but possible for a foot.
const RAMP_MS: u64 = 40;

/// Seed of the parts.
const SEED: u64 = 3;

/// A floor of two by two tiles on two boards, and the packets of its boards so far.
pub struct Tape {
    pub sim: SimFloor,
    pub feet: Vec<Foot>,
    /// The sequence number of the next packets.
    pub sequence: u32,
    floor: Floor,
    layout: Layout,
    now: Instant,
    packets: Vec<SensorPacket>,
}

impl Tape {
    /// A calibrated floor with the paper's parts that has been empty for a tenth of a second.
    pub fn on(page: &str) -> Self {
        Self::on_parts(page, SimulatedSensors::default(), true)
    }

    /// Like [`Tape::on`], with other parts, calibrated or not.
    pub fn on_parts(page: &str, sensing: SimulatedSensors, is_calibrated: bool) -> Self {
        let wired = Floor::of(Geometry::of_paper_tiles(2, 2).unwrap());
        let sim = SimFloor::new(&wired, SimConfig { sensing, ..SimConfig::default() }, SEED);
        let floor = if is_calibrated { sim::calibrated(&wired, &sim, SEED).unwrap() } else { wired };
        let layout = parse_layout(page, "a test's page", &Kinds::builtin(), &floor.geometry);
        let layout = layout.unwrap_or_else(|problems| panic!("{problems}")).layout;
        let (feet, packets) = (Vec::new(), Vec::new());
        let mut tape = Self { sim, feet, sequence: 1, floor, layout, now: Instant::START, packets };
        tape.wait(100);
        tape
    }

    pub fn wait(&mut self, millis: u64) {
        self.wait_while(millis, |_, packet| Some(packet));
    }

    /// Advances time; `change` gets each packet, with the milliseconds since the beginning, and returns the arriving
    /// one.
    pub fn wait_while(
        &mut self,
        millis: u64,
        mut change: impl FnMut(u64, SensorPacket) -> Option<SensorPacket>,
    ) {
        for ms in 0..millis {
            self.now = self.now + Duration::from_millis(1);
            let (sequence, received) = (self.sequence, self.now);
            for (board, readings) in (0..).zip(self.sim.step(&self.feet)) {
                let packet = SensorPacket { board, sequence, received, readings: readings.clone() };
                self.packets.extend(change(ms, packet));
            }
            self.sequence = self.sequence.wrapping_add(1);
        }
    }

    /// Brings one foot, with its pressure on `at`, to `force`.
    pub fn press(&mut self, at: Vec2, force: f32) {
        let before = self.feet.first().map_or(0.0, |foot| foot.force.0);
        for step in 1..=RAMP_MS {
            self.feet = vec![foot(at, before + (force - before) * step as f32 / RAMP_MS as f32)];
            self.wait(1);
        }
    }

    /// Takes the foot at `at` off the floor.
    pub fn lift(&mut self, at: Vec2) {
        self.press(at, 0.0);
        self.feet.clear();
    }

    /// Presses the control once, deliberately.
    pub fn tap(&mut self) {
        self.press(MIDDLE, 120.0);
        self.wait(200);
        self.lift(MIDDLE);
        self.wait(300);
    }

    /// Advances time under one foot that sways by some millimetres, like a standing person.
    pub fn stay(&mut self, at: Vec2, force: f32, seconds: u16) {
        for tenth in 0..seconds * 10 {
            let sway = 0.008 * (0.08 * f32::from(tenth)).sin();
            self.feet = vec![foot(at + Vec2::new(0.0, sway), force)];
            self.wait(100);
        }
    }

    /// Sets or clears the fault of the sensor in that corner of the control's tile.
    pub fn set_fault(&mut self, corner: Corner, fault: Option<SensorFault>) {
        self.sim.set_fault(SensorId { tile: TILE, corner }, fault);
    }

    /// The floor's time so far, in seconds.
    pub fn seconds(&self) -> f64 {
        self.now.secs()
    }

    /// Replays it in the program.
    pub fn play(self) -> Played {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("tape.mcap");
        let source = Packets { rest: self.packets.into_iter(), now: Instant::START };
        let (method, behind) = (Method::default(), WhenBehind::Wait);
        let recorded =
            Recorder::around(Some(&path), source, self.floor, self.layout, method, behind).unwrap();
        let Recorded { recorder, mut input, .. } = recorded;
        while input.source.next(Duration::ZERO).is_ok() {}
        drop((input, recorder));
        let arguments = ["--speed", "max", "--no-osc", "--json", "--json-contacts"];
        let output = underfoot().arg("replay").arg(&path).args(arguments).output().unwrap();
        assert!(output.status.success(), "{}", said(&output));
        let lines = String::from_utf8(output.stdout).unwrap();
        Played { lines: lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect() }
    }
}

/// A foot with its centre of pressure at `at`.
pub fn foot(at: Vec2, force: f32) -> Foot {
    let mut foot = Foot {
        position: Vec2::ZERO,
        heading: 0.0,
        length_m: 0.24,
        force: Newtons(force),
        roll: 0.5,
        left: false,
    };
    foot.position = at - foot.centre_of_pressure();
    foot
}

/// Packets as a source.
struct Packets {
    rest: std::vec::IntoIter<SensorPacket>,
    now: Instant,
}

impl SensorSource for Packets {
    fn next(&mut self, _: Duration) -> Result<Option<SensorPacket>, SourceError> {
        let packet = self.rest.next().ok_or(SourceError::Ended)?;
        self.now = self.now.max(packet.received);
        Ok(Some(packet))
    }

    fn now(&self) -> Instant {
        self.now
    }

    fn counters(&self) -> LinkCounters {
        LinkCounters::default()
    }
}

/// JSON lines of a program.
pub struct Played {
    pub lines: Vec<Value>,
}

impl Played {
    /// The events of controls, in order, such as `it pressed`; without intermediate values.
    pub fn events(&self) -> Vec<String> {
        events(&self.lines)
    }

    /// Every reported trouble of a sensor, once: its corner, if it is on the control's tile, and its name.
    pub fn troubles(&self) -> Vec<(Option<String>, String)> {
        let all = self.lines.iter().filter(|line| line["event"] == "health");
        let all = all.flat_map(|line| line["troubles"].as_array().cloned().unwrap_or_default());
        let mut found: Vec<_> = all
            .map(|trouble| {
                let is_there = trouble["col"] == TILE.column && trouble["row"] == TILE.row;
                let corner = trouble["corner"].as_str().filter(|_| is_there).map(str::to_owned);
                (corner, trouble["trouble"].as_str().unwrap_or_default().to_owned())
            })
            .collect();
        found.sort();
        found.dedup();
        found
    }

    /// The greatest number of sensors that a health line counts as `quality`, such as `degraded`.
    pub fn most(&self, quality: &str) -> u64 {
        self.lines.iter().filter_map(|line| line[quality].as_u64()).max().unwrap_or_default()
    }

    /// The places of contacts from second `from` to second `until`, for each report of them.
    pub fn contacts(&self, from: f64, until: f64) -> Vec<Vec<Vec2>> {
        let is_then = |line: &&Value| line["t_s"].as_f64().is_some_and(|at| (from..until).contains(&at));
        let lists = self.lines.iter().filter(is_then).filter_map(|line| line["contacts"].as_array());
        let number = |contact: &Value, name: &str| contact[name].as_f64().unwrap() as f32;
        let place = |contact: &Value| Vec2::new(number(contact, "x_m"), number(contact, "y_m"));
        lists.map(|contacts| contacts.iter().map(place).collect()).collect()
    }

    /// The second of the first event such as `it pressed`.
    pub fn time_of(&self, event: &str) -> Option<f64> {
        let (id, kind) = event.split_once(' ')?;
        self.lines.iter().find(|line| line["id"] == id && line["event"] == kind)?["t_s"].as_f64()
    }
}

/// The events of controls, in order, such as `it pressed`; without intermediate values and ignored feet.
pub fn events(lines: &[Value]) -> Vec<String> {
    let named = lines.iter().filter_map(|line| Some((line["id"].as_str()?, line["event"].as_str()?)));
    let told = named.filter(|(_, event)| !["state", "changed", "ticked", "ignored"].contains(event));
    told.map(|(id, event)| format!("{id} {event}")).collect()
}
