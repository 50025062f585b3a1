//! Four tiles with one button, for long runs: ten minutes of floor in a few seconds.

use std::time::Duration;

use underfoot::engine::{Engine, Snapshot};
use underfoot::feel::Cue;
use underfoot::floor::{Floor, Geometry, SensorId};
use underfoot::glam::Vec2;
use underfoot::sense::{Assembler, Contact, Method, Quality, Tare, TareRules};
use underfoot::units::{Instant, Newtons};
use underfoot::widget::EventKind;
use underfoot::wire::{Readings, SensorPacket};
use underfoot_sim::{self as sim, Foot, Load, SimConfig, SimFloor, SimulatedSensors};

use crate::support::page;

/// A button of the shipped kind (60 N, 40 N, 20 ms) on the whole south-west tile, including its sensors.
const PAGE: &str = r#"Layout(version: 1, title: "bench", regions: [(id: "all", at: (0, 0), size: (2, 2))],
    widgets: [(id: "it", kind: "button", at: (0, 0), size: (1, 1), label: "It")])"#;

pub struct Bench {
    pub engine: Engine,
    pub assembler: Assembler,
    pub sim: SimFloor,
    pub feet: Vec<Foot>,
    pub cues: Vec<Cue>,
    pub events: Vec<EventKind>,
    now: Instant,
}

impl Bench {
    pub fn new(sensing: SimulatedSensors) -> Self {
        Self::new_seed(sensing, 3)
    }

    /// Like [`Bench::new`], with other random parts.
    pub fn new_seed(sensing: SimulatedSensors, seed: u64) -> Self {
        let wired = Floor::of(Geometry::of_paper_tiles(2, 2).unwrap());
        let sim = SimFloor::new(&wired, SimConfig { sensing, ..SimConfig::default() }, seed);
        let floor = sim::calibrated(&wired, &sim, seed).unwrap();
        Self::with_floor(&floor, sim)
    }

    /// Like [`Bench::new`], with a tare that the assembler measures itself.
    pub fn tared_at_start(sensing: SimulatedSensors) -> Self {
        let mut bench = Self::new(sensing);
        let mut floor = Floor::of(*bench.sim.geometry());
        floor = sim::calibrated(&floor, &bench.sim, 3).unwrap();
        bench.assembler = Assembler::with_tare(&floor, Tare::AtStart(TareRules::default()));
        bench.run(1000);
        bench
    }

    pub fn with_floor(floor: &Floor, sim: SimFloor) -> Self {
        let mut bench = Self {
            engine: Engine::new(floor.geometry, page(PAGE), Method::default()),
            assembler: Assembler::new(floor),
            sim,
            feet: Vec::new(),
            cues: Vec::new(),
            events: Vec::new(),
            now: Instant::START,
        };
        bench.run(100);
        bench
    }

    /// Removes the button's dwell, so that a press by mistake is easiest.
    pub fn hasten(&mut self) {
        self.engine.set_layout(page(&PAGE.replace("label:", "dwell_ms: 0, label:")));
        self.run(100);
    }

    /// Replaces the button by a dead man's pedal.
    pub fn run_pedal(&mut self) {
        self.engine.set_layout(page(&PAGE.replace("button", "dead_man")));
        self.run(100);
    }

    pub fn now(&self) -> Instant {
        self.now
    }

    pub fn run(&mut self, millis: u64) {
        self.run_with(millis, |_, _, _| {});
    }

    /// A millisecond under loads that are not feet; the test ignores the events of controls.
    pub fn run_under(&mut self, loads: &[Load]) {
        self.now = self.now + Duration::from_millis(1);
        let (sequence, received) = ((self.now.micros() / 1000) as u32, self.now);
        for (board, readings) in (0..).zip(self.sim.step_under(loads.iter().copied())) {
            self.assembler.take(&SensorPacket { board, sequence, received, readings: readings.clone() });
        }
        while self.assembler.ready().is_some() {}
    }

    /// Advances time; `disturb` may change the reading of channel (board, number), in newtons.
    pub fn run_with(&mut self, millis: u64, mut disturb: impl FnMut(u64, (usize, usize), &mut f32)) {
        self.run_altered(millis, |ms, board, readings| {
            if let Readings::Newtons(forces) = readings {
                forces
                    .iter_mut()
                    .enumerate()
                    .for_each(|(at, force)| disturb(ms, (usize::from(board), at), force));
            }
        });
    }

    /// Advances time; `alter` may change the readings of a board.
    pub fn run_altered(&mut self, millis: u64, mut alter: impl FnMut(u64, u16, &mut Readings)) {
        for ms in 0..millis {
            self.now = self.now + Duration::from_millis(1);
            let sequence = (self.now.micros() / 1000) as u32;
            for (board, readings) in (0..).zip(self.sim.step(&self.feet)) {
                let mut readings = readings.clone();
                alter(ms, board, &mut readings);
                self.assembler.take(&SensorPacket { board, sequence, received: self.now, readings });
            }
            while let Some(frame) = self.assembler.ready() {
                let step = self.engine.step(frame);
                self.events.extend(step.events.iter().map(|event| event.kind));
                self.cues.extend_from_slice(step.cues);
            }
        }
    }

    /// Brings one foot, with its pressure on `at`, to `force` within 40 ms.
    pub fn press(&mut self, at: Vec2, force: f32) {
        let before = self.feet.first().map_or(0.0, |foot| foot.force.0);
        for step in 1..=40_u8 {
            self.feet = vec![foot(at, before + (force - before) * f32::from(step) / 40.0)];
            self.run(1);
        }
    }

    /// Advances time under one foot that stays, swaying by some millimetres like a standing person: a load that is
    /// perfectly still for a minute is not a foot (S10).
    pub fn stay(
        &mut self,
        at: Vec2,
        force: f32,
        seconds: u16,
        mut disturb: impl FnMut(u64, (usize, usize), &mut f32),
    ) {
        for tenth in 0..seconds * 10 {
            let sway = 0.008 * (0.08 * f32::from(tenth)).sin();
            self.feet = vec![foot(at + Vec2::new(0.0, sway), force)];
            self.run_with(100, |ms, channel, reading| disturb(u64::from(tenth) * 100 + ms, channel, reading));
        }
    }

    pub fn lift(&mut self, at: Vec2) {
        self.press(at, 0.0);
        self.feet.clear();
    }

    pub fn snapshot(&self) -> Snapshot {
        let mut snapshot = Snapshot::default();
        self.engine.snapshot(&mut snapshot);
        snapshot
    }

    pub fn quality(&self, sensor: SensorId) -> Quality {
        let tile = self.sim.geometry().index(sensor.tile).unwrap();
        self.snapshot().tiles[tile].quality[sensor.corner.index()]
    }

    pub fn contacts(&self) -> Vec<Contact> {
        self.snapshot().contacts
    }
}

/// The button's middle.
pub const BUTTON: Vec2 = Vec2::splat(0.152);

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
