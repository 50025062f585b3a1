//! Boards at 20 to 4000 Hz, with each source of time: presses at the right moments, the time of the floor, and the end
//! of a hold when the board is lost.
//!
//! A tile is empty, carries a foot from 4 to 7 s, and is empty again; all in virtual time.

use underfoot::engine::Engine;
use underfoot::floor::{Board, Floor, Geometry, PortName, SerialWire, TextLines, TextNumbers};
use underfoot::layout::Layout;
use underfoot::schema::{self, Kinds};
use underfoot::sense::{Assembler, Method, Quality, Tare, TimeBase};
use underfoot::units::Instant;
use underfoot::widget::{EventKind, OffReason};
use underfoot::wire::{LinkState, Readings, SensorPacket};

const RATES: [u64; 10] = [20, 50, 80, 100, 200, 500, 900, 1000, 2000, 4000];
const BASES: [TimeBase; 3] = [TimeBase::Packets, TimeBase::Milliseconds, TimeBase::Arrival];

/// Most boards are polled as a program does.
const POLL_US: u64 = 1000;

/// Time for which the force must be there for a press.
const DWELL_S: f64 = 0.02;

fn chance(at: u64) -> f64 {
    let mixed = (at + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    ((mixed ^ mixed >> 29).wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 11) as f64 / (1_u64 << 53) as f64
}

/// The load at a time, 0 to 1.
fn load(seconds: f64) -> f64 {
    ((seconds - 4.0) / 0.12).min((7.0 - seconds) / 0.12).clamp(0.0, 1.0)
}

/// Four counts of 16 bits at a time, with noise of this range.
fn counts(seconds: f64, salt: u64, noise: f64) -> Readings {
    let count = |corner: u64| {
        let noise = noise * (chance(salt * 4 + corner) - 0.5);
        Some((64.0 * (120.0 + 560.0 * load(seconds)) + noise) as u16)
    };
    Readings::Counts((0..4).map(count).collect())
}

/// A board under one tile.
#[derive(Clone, Copy)]
struct Sender {
    board: u16,
    hz: u64,
    base: TimeBase,
    /// Time from a sample to its packet's arrival, at least and at most more, in seconds.
    way_s: [f64; 2],
    /// Time at which its cable is pulled, in seconds.
    until_s: f64,
    /// Time for which the tile has been empty before, in seconds.
    empty_s: f64,
    /// Range of the noise, in counts.
    noise: f64,
}

impl Sender {
    fn new(hz: u64, base: TimeBase) -> Self {
        // At 4000 Hz the network keeps the order: one that changed it would lose a third of the packets as late.
        let jitter_s = if hz > 2000 { 0.0002 } else { 0.001 };
        Self {
            board: 0,
            hz,
            base,
            way_s: [0.0003, jitter_s],
            until_s: f64::INFINITY,
            empty_s: 0.0,
            noise: 40.0,
        }
    }

    /// Its packets up to `end_s`, by arrival.
    fn packets(self, end_s: f64) -> Vec<SensorPacket> {
        let count = (end_s.min(self.until_s) * self.hz as f64) as u64;
        let packet = |n: u64| {
            let seconds = n as f64 / self.hz as f64;
            let way_s = self.way_s[0] + self.way_s[1] * chance(n * 7 + 3);
            let sequence = match self.base {
                TimeBase::Packets => n as u32,
                TimeBase::Milliseconds => (n * 1000 / self.hz) as u32,
                TimeBase::Arrival => 0,
            };
            let received = Instant::from_micros((1e6 * (seconds + way_s)) as u64 + 1000);
            let readings = counts(seconds - self.empty_s, n * 2 + u64::from(self.board), self.noise);
            SensorPacket { board: self.board, sequence, received, readings }
        };
        let mut packets: Vec<SensorPacket> = (0..count).map(packet).collect();
        packets.sort_by_key(|packet| packet.received);
        packets
    }
}

/// A floor of one column with a control on each tile.
struct Bench {
    assembler: Assembler,
    engine: Engine,
    /// Time and kind of each event, and its control.
    events: Vec<(f64, EventKind, String)>,
    /// Intervals between frames that are not a millisecond, in microseconds.
    uneven: Vec<u64>,
    /// Qualities of the first tile that were not live, after the start, and when.
    ill: Vec<(f64, Quality)>,
    /// Largest age of the first tile's force, in seconds.
    oldest_s: f64,
    lost_s: Option<f64>,
    frames: u64,
    at: Instant,
}

fn floor(rows: u16, written: &[Option<f32>]) -> Floor {
    let mut floor = Floor::of(Geometry::of_paper_tiles(1, rows).unwrap());
    let law = underfoot::floor::Calibration::exponential(0.5, 1.34 + 1e-3);
    floor.calibration.fill([law; 4]);
    for (board, hz) in floor.boards.iter_mut().zip(written) {
        *board = Board { rate_hz: *hz, ..board.clone() };
    }
    floor
}

fn layout(floor: &Floor, kind: &str) -> Layout {
    let rows = floor.geometry.rows();
    let controls: String = (0..rows)
        .map(|row| format!(r#"(id: "b{row}", kind: "{kind}", at: (0.1, {row}.1), size: (0.8, 0.8)),"#))
        .collect();
    let text = format!(
        r#"Layout(version: 1, regions: [(id: "r", at: (0, 0), size: (1, {rows}))], widgets: [{controls}])"#
    );
    match schema::parse_layout(&text, "rates", &Kinds::builtin(), &floor.geometry) {
        Ok(loaded) => loaded.layout,
        Err(problems) => panic!("{problems}"),
    }
}

impl Bench {
    fn new(floor: &Floor, kind: &str) -> Self {
        Self {
            assembler: Assembler::with_tare(floor, Tare::suited_to(floor)),
            engine: Engine::new(floor.geometry, layout(floor, kind), Method::Tracker),
            events: Vec::new(),
            uneven: Vec::new(),
            ill: Vec::new(),
            oldest_s: 0.0,
            lost_s: None,
            frames: 0,
            at: Instant::START,
        }
    }

    /// Runs the floor for `end_s` with the packets of these boards.
    fn run(&mut self, senders: &[Sender], end_s: f64) {
        let mut packets: Vec<SensorPacket> =
            senders.iter().flat_map(|sender| sender.packets(end_s)).collect();
        packets.sort_by_key(|packet| packet.received);
        self.run_packets(packets, end_s);
    }

    /// Runs the floor for `end_s` with these packets.
    fn run_packets(&mut self, packets: Vec<SensorPacket>, end_s: f64) {
        let mut packets = packets.into_iter().peekable();
        for poll_us in (0..(1e6 * end_s) as u64).step_by(POLL_US as usize) {
            let poll = Instant::from_micros(poll_us);
            while let Some(packet) = packets.next_if(|packet| packet.received <= poll) {
                self.assembler.take(&packet);
                self.step(packet.received);
            }
            self.assembler.poll(poll);
            self.step(poll);
        }
    }

    fn step(&mut self, now: Instant) {
        while let Some(frame) = self.assembler.ready() {
            let seconds = frame.at.secs();
            if seconds > 2.5 {
                let step = frame.at.since(self.at).as_micros() as u64;
                if !(998..=1002).contains(&step) {
                    self.uneven.push(step);
                }
                let worst = *frame.quality[0].iter().max().unwrap();
                if worst != Quality::Live {
                    self.ill.push((seconds, worst));
                }
                let age = frame.samples.first().map_or(0.0, |sample| sample.age.as_secs_f64());
                self.oldest_s = self.oldest_s.max(age);
                let error_s = (seconds - now.secs()).abs();
                assert!(error_s < 0.006, "the floor's time is {error_s} s off the clock at {seconds} s");
            }
            self.at = frame.at;
            self.frames += 1;
            let results = self.engine.step(frame);
            let events = results.events.iter();
            self.events.extend(events.map(|event| (event.at.secs(), event.kind, event.id.to_string())));
        }
        if self.assembler.link_state() == LinkState::Lost && self.lost_s.is_none() {
            self.lost_s = Some(now.secs());
        }
    }

    fn at(&self, kind: EventKind) -> Vec<f64> {
        self.events.iter().filter(|(_, one, _)| *one == kind).map(|(at, ..)| *at).collect()
    }
}

/// The time at which the foot is heavy enough to press, and the time at which it is light enough to release.
fn expected() -> [f64; 2] {
    let newtons = |seconds: f64| {
        let volts = |share: f64| 64.0 * (120.0 + 560.0 * share) / 65_535.0 * 5.0;
        let force = |share: f64| 4.0 * 0.5 * (1.341 * volts(share)).exp();
        force(load(seconds)) - force(0.0)
    };
    let times = || (0..8000).map(|ms| f64::from(ms) / 1000.0);
    let pressed = times().find(|at| newtons(*at) >= 60.0).unwrap();
    [pressed, times().find(|at| *at > 5.0 && newtons(*at) < 40.0).unwrap()]
}

/// Checks a press and its release by a board at this rate.
fn check(bench: &Bench, hz: u64, name: &str) {
    let (period_s, [down_s, up_s]) = (1.0 / hz as f64, expected());
    let [pressed, released] = [EventKind::Pressed, EventKind::Released].map(|kind| bench.at(kind));
    let ([pressed], [released]) = (&pressed[..], &released[..]) else {
        panic!("{name}: {:?} {:?}", bench.events, bench.assembler.counters())
    };
    let late_s = [pressed - down_s - DWELL_S, released - up_s];
    assert!(
        late_s.iter().all(|late| (-0.003..=2.0 * period_s + 0.012).contains(late)),
        "{name}: {late_s:?} s late"
    );
    assert_eq!(bench.at(EventKind::Cancelled), Vec::<f64>::new(), "{name}");
    assert!(bench.uneven.is_empty(), "{name}: {:?}", bench.uneven);
    assert!(bench.ill.is_empty(), "{name}: {:?}", bench.ill);
    assert_eq!(bench.assembler.troubles().count(), 0, "{name}");
    let counters = bench.assembler.counters();
    let told = [counters.lost, counters.out_of_order, counters.bad_readings, counters.frozen, counters.jumps];
    assert_eq!(told, [0; 5], "{name}: {counters:?}");
}

#[test]
fn a_foot_presses_at_every_rate_by_every_time_base() {
    for hz in RATES {
        for base in BASES {
            for written in [None, Some(hz as f32)] {
                // A clock of milliseconds near 1000 Hz looks like a number that loses packets.
                if hz == 900 && base == TimeBase::Milliseconds {
                    continue;
                }
                let mut bench = Bench::new(&floor(1, &[written]), "button");
                bench.run(&[Sender::new(hz, base)], 8.0);
                let name = format!("{hz} Hz, {base:?}, written {written:?}");
                check(&bench, hz, &name);
                let timing = bench.assembler.board(0).unwrap().timing;
                assert!((timing.hz / hz as f32 - 1.0).abs() < 0.02, "{name}: {} Hz", timing.hz);
                if hz != 1000 {
                    assert_eq!(timing.base, base, "{name}");
                    let most_s = if hz < 1000 { 1.0 / hz as f64 + 0.004 } else { 0.004 };
                    assert!(bench.oldest_s < most_s, "{name}: {} s old", bench.oldest_s);
                }
            }
        }
    }
}

#[test]
fn jitter_of_half_a_period_presses_nothing_else() {
    for hz in [20, 50, 100, 200, 500] {
        for base in BASES {
            let way_s = [0.002, 0.5 / hz as f64];
            let mut bench = Bench::new(&floor(1, &[None]), "button");
            bench.run(&[Sender { way_s, ..Sender::new(hz, base) }], 8.0);
            let kinds: Vec<EventKind> = bench.events.iter().map(|(_, kind, _)| *kind).collect();
            assert!(bench.at(EventKind::Pressed).len() == 1, "{hz} Hz, {base:?}: {kinds:?}");
            assert!(bench.at(EventKind::Released).len() == 1, "{hz} Hz, {base:?}: {kinds:?}");
            assert!(bench.ill.is_empty(), "{hz} Hz, {base:?}: {:?}", bench.ill);
        }
    }
}

#[test]
fn a_slow_board_whose_noise_is_known_well_repeats_nothing() {
    // After a minute no reading has ever repeated: the noise is much larger than a count.
    for hz in [20, 25, 50, 100] {
        let mut bench = Bench::new(&floor(1, &[None]), "button");
        let sender = Sender { empty_s: 60.0, noise: 2000.0, ..Sender::new(hz, TimeBase::Packets) };
        bench.run(&[sender], 68.0);
        assert_eq!(bench.at(EventKind::Released).len(), 1, "{hz} Hz: {:?}", bench.events);
        assert_eq!(bench.assembler.counters().repeats, 0, "{hz} Hz");
    }
}

/// Packets of a board that is asked for each one, `pace` times a second at most, from a busy computer: the intervals
/// change, and after each tenth of a second an answer takes 5 ms.
fn asked(pace: u64, end_s: f64) -> Vec<SensorPacket> {
    let mut at_us = 1000_u64;
    let mut packets = Vec::new();
    while (at_us as f64) < 1e6 * end_s {
        let n = packets.len() as u64;
        // From second to second the computer is busier or less busy.
        let busy = 1.0 + 0.3 * chance(at_us / 1_000_000);
        at_us += (1e6 / pace as f64 * busy) as u64 + if n.is_multiple_of(pace / 10) { 5000 } else { 0 };
        let readings = counts(at_us as f64 / 1e6, n, 40.0);
        packets.push(SensorPacket {
            board: 0,
            sequence: n as u32,
            received: Instant::from_micros(at_us),
            readings,
        });
    }
    packets
}

#[test]
fn a_board_that_is_asked_holds_whatever_the_pace_of_its_answers() {
    for pace in [50, 200, 1000] {
        let mut floor = floor(1, &[None]);
        floor.serial.push(SerialWire {
            lines: Some(TextLines {
                board: 0,
                request: b"v".to_vec(),
                separators: " ".to_owned(),
                columns: vec![1, 2, 3, 4],
                width: 4,
                numbers: TextNumbers::Newtons,
            }),
            ..SerialWire::slip(PortName::System("/dev/ttyACM0".to_owned()))
        });
        let mut bench = Bench::new(&floor, "button");
        bench.run_packets(asked(pace, 8.0), 8.0);
        assert_eq!(bench.at(EventKind::Released).len(), 1, "{pace} Hz: {:?}", bench.events);
        assert!(bench.ill.is_empty(), "{pace} Hz: {:?}", bench.ill);
        let timing = bench.assembler.board(0).unwrap().timing;
        assert_eq!(timing.base, TimeBase::Arrival, "{pace} Hz");
        assert_eq!(bench.assembler.counters().lost, 0, "{pace} Hz");
    }
}

#[test]
fn boards_at_different_rates_share_a_floor() {
    let senders = [(0, 1000), (1, 50), (2, 2000), (3, 200)];
    let senders = senders.map(|(board, hz)| Sender { board, ..Sender::new(hz, TimeBase::Packets) });
    let mut bench = Bench::new(&floor(4, &[None; 4]), "button");
    bench.run(&senders, 8.0);
    assert!(bench.uneven.is_empty(), "{:?}", bench.uneven);
    assert!(bench.ill.is_empty(), "{:?}", bench.ill);
    assert_eq!(bench.assembler.link_state(), LinkState::Live);
    assert_eq!(bench.assembler.troubles().count(), 0);
}

#[test]
fn a_hold_ends_100_ms_after_the_cable_is_pulled_and_150_at_the_latest() {
    for (hz, most_s) in [(20, 0.15), (25, 0.12), (50, 0.1), (100, 0.1), (500, 0.1), (1000, 0.1), (4000, 0.1)]
    {
        for base in BASES {
            let sender = Sender { until_s: 5.5, ..Sender::new(hz, base) };
            let mut bench = Bench::new(&floor(1, &[None]), "button");
            bench.run(&[sender], 8.0);
            let last_s = 5.5 - 1.0 / hz as f64;
            let cancelled = bench.at(EventKind::Cancelled);
            let name = format!("{hz} Hz, {base:?}: {:?}", bench.events);
            let [at] = cancelled[..] else { panic!("{name}") };
            assert!((last_s..last_s + most_s + 0.006).contains(&at), "{name}");
            let lost_s = bench.lost_s.unwrap();
            assert!((last_s..last_s + most_s + 0.008).contains(&lost_s), "{name}: lost at {lost_s} s");
            assert_eq!(bench.at(EventKind::Released), Vec::<f64>::new(), "{name}");
        }
    }
}

#[test]
fn controls_that_act_while_held_need_50_hz() {
    for (hz, off) in
        [(20, Some(OffReason::SlowReadings)), (45, Some(OffReason::SlowReadings)), (50, None), (100, None)]
    {
        let mut bench = Bench::new(&floor(1, &[None]), "dead_man");
        bench.run(&[Sender::new(hz, TimeBase::Packets)], 3.5);
        let state = bench.engine.control_state("b0").unwrap();
        assert_eq!(state.off.map(|off| off.reason), off, "{hz} Hz");
        let sender = Sender::new(hz, TimeBase::Packets);
        let mut bench = Bench::new(&floor(1, &[None]), "dead_man");
        bench.run(&[sender], 8.0);
        assert_eq!(bench.at(EventKind::Pressed).is_empty(), off.is_some(), "{hz} Hz: {:?}", bench.events);
    }
}
