//! A simulated floor whose boards send, and a program that serves the requests of the set-up, for tests.

use std::collections::VecDeque;
use std::time::Duration;

use underfoot::floor::{Day, Floor, TileId};
use underfoot::glam::Vec2;
use underfoot::serve::take_tare;
use underfoot::source::{SensorSource, SourceError};
use underfoot::units::{Instant, Newtons};
use underfoot::wire::{LinkCounters, Readings, SensorEncoder, SensorFormat, SensorPacket};
use underfoot_sim::{Foot, Load, PartConfig, SimConfig, SimFloor, SimulatedSensors};

use super::{SetupAnswer, SetupBench, SetupInput, SetupOrder, SetupRequest};

/// The boards of a floor, with the steps of the set-up behind them.
pub(super) struct Site {
    /// The floor as it is wired.
    pub(super) wired: Floor,
    sim: SimFloor,
    encoder: SensorEncoder,
    pub(super) bench: SetupBench,
    input: SetupInput,
    /// The floors that were written.
    pub(super) saved: Vec<Floor>,
    /// Number of times that a layout was opened.
    pub(super) opened: usize,
    pub(super) ms: u32,
    /// Whether the boards send.
    pub(super) is_on: bool,
}

impl Site {
    /// The boards of `wired`, without a floor file.
    pub(super) fn new(wired: Floor) -> Self {
        let parts = PartConfig { deviation: 0.0, ..PartConfig::default() };
        let config = SimConfig { sensing: SimulatedSensors::Counts(parts), ..SimConfig::default() };
        Self {
            sim: SimFloor::new(&wired, config, 5),
            encoder: SensorEncoder::new(&wired, SensorFormat::Counts),
            wired,
            bench: SetupBench::new(None),
            input: SetupInput::Nobody,
            saved: Vec::new(),
            opened: 0,
            ms: 0,
            is_on: true,
        }
    }

    /// Gives an order, as the window does.
    pub(super) fn order(&mut self, order: &SetupOrder) {
        self.bench.order(order);
        self.serve();
    }

    /// Advances by a millisecond with these loads on the floor.
    pub(super) fn step(&mut self, loads: impl IntoIterator<Item = Load>) {
        self.ms += 1;
        let received = Instant::from_millis(self.ms.into());
        let readings: Vec<Readings> = self.sim.step_under(loads).to_vec();
        if self.is_on {
            for (board, readings) in (0_u16..).zip(readings) {
                self.send(board, readings, received);
            }
        }
        self.bench.set_now(received);
        self.serve();
    }

    fn send(&mut self, board: u16, readings: Readings, received: Instant) {
        let packet = SensorPacket { board, sequence: self.ms, received, readings };
        match &self.input {
            SetupInput::Nobody => {}
            SetupInput::Anybody => {
                let datagram = self.encoder.encode(&packet).unwrap();
                self.bench.heard().take_datagram(datagram, "127.0.0.1".parse().unwrap(), received);
            }
            SetupInput::Floor(floor) => {
                if let Some(packet) = arrived(&self.wired, floor, packet) {
                    self.bench.take(&packet);
                }
            }
        }
    }

    /// Advances by `ms` milliseconds with a person's foot at `at`.
    pub(super) fn hold(&mut self, ms: u32, at: Option<Vec2>) {
        (0..ms).for_each(|_| self.step(at.map(|at| foot(at).as_load())));
    }

    /// The middle of a tile.
    pub(super) fn middle(&self, tile: TileId) -> Vec2 {
        self.wired.geometry.centre(tile)
    }

    /// Serves all requests, as the program does.
    fn serve(&mut self) {
        while let Some(request) = self.bench.next_request() {
            let answer = match request {
                SetupRequest::Listen(input) => {
                    self.input = input;
                    SetupAnswer::Listening(Ok(()))
                }
                SetupRequest::Save(floor) => {
                    self.saved.push(*floor);
                    SetupAnswer::Saved(Ok("Written to floor.ron.".into()))
                }
                SetupRequest::TakeTare(floor) => {
                    let (sim, wired) = (self.sim.clone(), self.wired.clone());
                    let (waiting, listened) = (VecDeque::new(), Floor::clone(&floor));
                    let mut source = EmptyFloor { sim, wired, listened, waiting, ms: 0 };
                    let tare = take_tare(&mut source, &floor, Duration::from_secs(5), true);
                    SetupAnswer::Tared(tare.map(|tare| (tare, today())).map_err(|error| error.to_string()))
                }
                SetupRequest::Fit(job) => SetupAnswer::Fitted(Box::new(job.run()), today()),
                SetupRequest::Open => {
                    self.opened += 1;
                    SetupAnswer::Opened(Ok("first_layout.ron is open on the floor.".into()))
                }
            };
            self.bench.answer(answer);
        }
    }

    /// Error of the force of a foot near the middle of each tile by the laws of the floor file, the greatest, as a
    /// share.
    pub(super) fn force_error(&mut self) -> f32 {
        let file = self.saved.last().unwrap().clone();
        let mut worst = 0.0_f32;
        for tile in self.wired.geometry.tiles() {
            let foot = foot(self.middle(tile) + Vec2::new(0.02, 0.03));
            let readings = self.sim.step_under([foot.as_load()]).to_vec();
            let mut sum = 0.0;
            for (board, readings) in self.wired.boards.iter().zip(readings) {
                let Readings::Counts(counts) = readings else { panic!("counts") };
                let known = file.boards.iter().find(|known| known.address == board.address).unwrap();
                for (sensor, count) in known.channels.iter().zip(counts) {
                    let sensor = sensor.unwrap();
                    let tare = file.tare[file.geometry.index(sensor.tile).unwrap()][sensor.corner.index()];
                    sum += (file.law(sensor).force(count.unwrap()) - tare).0;
                }
            }
            worst = worst.max((sum / foot.force.0 - 1.0).abs());
        }
        worst
    }
}

/// The day of all tests.
fn today() -> Day {
    Day::new(2026, 11, 27).unwrap()
}

/// A foot at `at` that carries a person.
pub(super) fn foot(at: Vec2) -> Foot {
    let force = Newtons(500.0);
    let mut foot = Foot { position: at, heading: 0.0, length_m: 0.1, force, roll: 0.5, left: false };
    foot.position += at - foot.centre_of_pressure();
    foot
}

/// A packet of the floor `wired` as a program receives it that reads the floor file `file`: boards are known by their
/// addresses.
fn arrived(wired: &Floor, file: &Floor, packet: SensorPacket) -> Option<SensorPacket> {
    let address = &wired.boards[usize::from(packet.board)].address;
    let board = file.boards.iter().position(|board| board.address == *address)?;
    Some(SensorPacket { board: board as u16, ..packet })
}

/// The same boards without anybody on the floor.
struct EmptyFloor {
    sim: SimFloor,
    wired: Floor,
    listened: Floor,
    waiting: VecDeque<SensorPacket>,
    ms: u32,
}

impl SensorSource for EmptyFloor {
    fn next(&mut self, _: Duration) -> Result<Option<SensorPacket>, SourceError> {
        if self.waiting.is_empty() {
            let received = Instant::from_millis(self.ms.into());
            for (board, readings) in (0_u16..).zip(self.sim.step(&[]).to_vec()) {
                let packet = SensorPacket { board, sequence: self.ms, received, readings };
                self.waiting.extend(arrived(&self.wired, &self.listened, packet));
            }
            self.ms += 1;
        }
        Ok(self.waiting.pop_front())
    }

    fn now(&self) -> Instant {
        Instant::from_millis(self.ms.into())
    }

    fn counters(&self) -> LinkCounters {
        LinkCounters::default()
    }
}
