//! Ten minutes of a visited floor with rubbish on its network: the events are the same as without it.

use std::time::Duration;

use crate::corrupt::Corruptor;
use crate::support::layout;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use underfoot::engine::Engine;
use underfoot::floor::Floor;
use underfoot::layout::Layout;
use underfoot::sense::{Assembler, Method};
use underfoot::units::Instant;
use underfoot::widget::WidgetEvent;
use underfoot::wire::{Batch, Decoder, LinkCounters, SensorEncoder, SensorFormat, SensorPacket};
use underfoot_sim::{self as sim, Foot, FootDriver, Scenario, Script, SimConfig, SimFloor};

/// Ten simulated minutes.
const MILLIS: u32 = 600_000;

/// One receiving side: a server's processing of each datagram, without the socket.
struct Listener {
    decoder: Decoder,
    assembler: Assembler,
    engine: Engine,
    batch: Batch,
    refused: LinkCounters,
    events: Vec<WidgetEvent>,
}

impl Listener {
    fn new(floor: &Floor, layout: Layout) -> Self {
        Self {
            decoder: Decoder::new(floor),
            assembler: Assembler::new(floor),
            engine: Engine::new(floor.geometry, layout, Method::default()),
            batch: Batch::default(),
            refused: LinkCounters::default(),
            events: Vec::new(),
        }
    }

    fn hear(&mut self, datagram: &[u8], now: Instant) {
        match self.decoder.decode(datagram, now, &mut self.batch) {
            Ok(()) => self.batch.packets.iter().for_each(|packet| self.assembler.take(packet)),
            Err(error) => error.count(&mut self.refused),
        }
        while let Some(frame) = self.assembler.ready() {
            self.events.extend_from_slice(self.engine.step(frame).events);
        }
    }
}

/// The built-in session, repeated.
struct Visits {
    script: Script,
    begun: Instant,
    length: Duration,
}

impl Visits {
    fn feet(&mut self, at: Instant, feet: &mut Vec<Foot>) {
        if at.since(self.begun) > self.length {
            self.begun = at;
        }
        self.script.feet(Instant::START + at.since(self.begun), feet);
    }
}

#[test]
fn ten_minutes_with_rubbish_on_the_network_give_the_same_events() {
    let page = layout("map");
    let wired = Floor::default();
    let mut sim = SimFloor::new(&wired, SimConfig::default(), 5);
    let floor = sim::calibrated(&wired, &sim, 5).unwrap();
    let scenario = Scenario::parse("session", Scenario::SESSION).unwrap();
    let script = scenario.resolve(&page, &floor.geometry).unwrap();
    let mut visits = Visits { length: script.duration(), script, begun: Instant::START };

    let mut clean = Listener::new(&floor, page.clone());
    let mut noisy = Listener::new(&floor, page);
    let mut encoder = SensorEncoder::new(&floor, SensorFormat::Counts);
    let mut corruptor = Corruptor::new(11);
    let mut dice = Pcg64Mcg::seed_from_u64(12);
    let mut before: Vec<Vec<u8>> = Vec::new();
    let mut sent: Vec<Vec<u8>> = Vec::new();
    let mut rubbish = 0_u64;
    let mut feet = Vec::new();
    let mut memory = None;
    for millis in 0..MILLIS {
        let now = Instant::from_millis(millis.into());
        visits.feet(now, &mut feet);
        std::mem::swap(&mut before, &mut sent);
        sent.clear();
        for (board, readings) in (0..).zip(sim.step(&feet)) {
            let packet = SensorPacket { board, sequence: millis, received: now, readings: readings.clone() };
            let datagram = encoder.encode(&packet).unwrap().to_vec();
            clean.hear(&datagram, now);
            noisy.hear(&datagram, now);
            // About one datagram in three is rubbish, derived from one sent a millisecond ago.
            if dice.random_bool(0.5)
                && let Some(model) = before.get(usize::from(board))
            {
                rubbish += 1;
                noisy.hear(&corruptor.corrupt(model), now);
            }
            sent.push(datagram);
        }
        // After a minute all memory has reached its size.
        if millis == 60_000 {
            memory = resident_kib();
        }
    }
    assert!(clean.events.len() > 1000, "the floor was visited: {} events", clean.events.len());
    assert!(rubbish > 1_000_000, "{rubbish} pieces of rubbish");
    assert!(noisy.refused.refused() > rubbish / 2, "most of it was refused by name: {:?}", noisy.refused);
    assert_eq!(clean.refused, LinkCounters::default());
    assert_eq!(clean.events.len(), noisy.events.len());
    for (clean, noisy) in clean.events.iter().zip(&noisy.events) {
        assert_eq!((clean.at, &clean.id, clean.kind), (noisy.at, &noisy.id, noisy.kind));
    }
    if let Some((early, late)) = memory.zip(resident_kib()) {
        // The two event lists grow by some 100 bytes an event.
        let listed = (clean.events.len() + noisy.events.len()) / 4;
        let grown = late.saturating_sub(early);
        assert!(grown < 2048 + listed as u64, "memory grew by {grown} KiB in nine minutes");
        println!("{rubbish} pieces of rubbish, {:?}; memory grew by {grown} KiB", noisy.refused);
    }
}

/// Memory of this process, if the system reports it.
fn resident_kib() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?.split_whitespace().next()?.parse().ok()
}
