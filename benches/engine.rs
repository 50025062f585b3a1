//! The cost of one frame: `cargo bench -p underfoot --bench engine --no-default-features`.
//!
//! Also the cost of 500 controls against that of 20, on a floor of 24 x 24 tiles with ten people. Elsewhere two
//! people walk on the paper's floor with the map layout; the frames are recorded first, so that the bench measures
//! the engine only. The whole path adds decoding six datagrams and assembling them.
#![allow(missing_docs, clippy::unwrap_used)]

use std::hint::black_box;

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use underfoot::engine::Engine;
use underfoot::floor::{Floor, Geometry};
use underfoot::glam::Vec2;
use underfoot::layout::Layout;
use underfoot::schema::{self, Kinds};
use underfoot::sense::{Assembler, ForceFrame, Method};
use underfoot::units::Instant;
use underfoot::wire::{Batch, Decoder, SensorEncoder, SensorFormat, SensorPacket};
use underfoot_sim::{self as sim, FootDriver, Performance, Person, Scenario, Script, SimConfig, SimFloor};

/// Two walkers, up and down the floor for longer than the measurement.
const WALKERS: &str = r#"
Scenario(
    title: "Two walkers",
    steps: [
        Stand(at: (1.5, 0.5), facing: North),
        WalkTo(at: (1.5, 5.2)), WalkTo(at: (1.5, 0.5)), WalkTo(at: (1.5, 5.2)),
    ],
    others: [(person: (mass_kg: 90), steps: [
        Stand(at: (4.2, 5.3), facing: South),
        WalkTo(at: (4.2, 0.6)), WalkTo(at: (4.2, 5.3)), WalkTo(at: (4.2, 0.6)),
    ])],
)
"#;

/// Milliseconds recorded.
const MILLIS: u32 = 8000;

struct Recorded {
    floor: Floor,
    layout: Layout,
    datagrams: Vec<(Instant, Vec<Vec<u8>>)>,
    frames: Vec<ForceFrame>,
}

fn recorded() -> Recorded {
    let wired = Floor::default();
    let text = schema::builtin_layout("map").unwrap();
    let layout = schema::parse_layout(text, "map", &Kinds::builtin(), &wired.geometry).unwrap().layout;
    let mut sim = SimFloor::new(&wired, SimConfig::default(), 3);
    let floor = sim::calibrated(&wired, &sim, 3).unwrap();
    let mut script = Scenario::parse("walkers", WALKERS).unwrap().resolve(&layout, &floor.geometry).unwrap();
    let mut encoder = SensorEncoder::new(&floor, SensorFormat::Counts);
    let mut assembler = Assembler::new(&floor);
    let (mut datagrams, mut frames, mut feet) = (Vec::new(), Vec::new(), Vec::new());
    for millis in 0..MILLIS {
        let received = Instant::from_millis(millis.into());
        assert!(script.feet(received, &mut feet), "the walk is long enough");
        let mut sent = Vec::new();
        for (board, readings) in (0..).zip(sim.step(&feet)) {
            let packet = SensorPacket { board, sequence: millis, received, readings: readings.clone() };
            sent.push(encoder.encode(&packet).unwrap().to_vec());
            assembler.take(&packet);
        }
        while let Some(frame) = assembler.ready() {
            frames.push(frame.clone());
        }
        datagrams.push((received, sent));
    }
    Recorded { floor, layout, datagrams, frames }
}

fn engine(criterion: &mut Criterion) {
    let Recorded { floor, layout, datagrams, frames } = recorded();
    let mut group = criterion.benchmark_group("6x6, two walkers");
    group.sample_size(20);
    group.throughput(Throughput::Elements(frames.len() as u64));
    for method in [Method::Eq4, Method::Tracker] {
        group.bench_function(format!("engine, {method:?}, per frame"), |bencher| {
            bencher.iter_batched_ref(
                || Engine::new(floor.geometry, layout.clone(), method),
                |engine| {
                    frames.iter().for_each(|frame| {
                        black_box(engine.step(frame));
                    });
                },
                BatchSize::LargeInput,
            );
        });
    }
    group.bench_function("datagrams to events, per frame", |bencher| {
        let decoder = Decoder::new(&floor);
        bencher.iter_batched_ref(
            || {
                let engine = Engine::new(floor.geometry, layout.clone(), Method::Tracker);
                (Assembler::new(&floor), engine, Batch::default())
            },
            |(assembler, engine, batch)| {
                for (now, sent) in &datagrams {
                    for datagram in sent {
                        decoder.decode(datagram, *now, batch).unwrap();
                        batch.packets.iter().for_each(|packet| assembler.take(packet));
                    }
                    while let Some(frame) = assembler.ready() {
                        black_box(engine.step(frame));
                    }
                }
            },
            BatchSize::LargeInput,
        );
    });
    group.finish();
}

/// Tiles each way of the large floor, number of people on it, and milliseconds of their walk.
const SIDE: u16 = 24;
const PEOPLE: usize = 10;
const WALKED_MS: u32 = 3000;

/// The given number of buttons of six tenths of a tile in rows over the whole floor, all in one region of each
/// contact.
fn page_of(controls: usize, geometry: &Geometry) -> Layout {
    let mut text = format!(
        "Layout(version: 1, title: \"{controls} controls\",
         regions: [(id: \"all\", at: (0, 0), size: ({SIDE}, {SIDE}), cursor: Each)], widgets: ["
    );
    for number in 0..controls {
        // Spread over the floor's tiles, with the same density everywhere.
        let tile = number * usize::from(SIDE) * usize::from(SIDE) / controls;
        let (column, row) = (tile % usize::from(SIDE), tile / usize::from(SIDE));
        text.push_str(&format!(
            "(id: \"c{number}\", kind: \"button\", at: ({column}.2, {row}.2), size: (0.6, 0.6)),"
        ));
    }
    text.push_str("])");
    schema::parse_layout(&text, "bench", &Kinds::builtin(), geometry).unwrap().layout
}

/// Ten walkers on 24 x 24 tiles with 20 and with 500 controls: the same frames for both.
fn large(criterion: &mut Criterion) {
    let geometry = Geometry::of_paper_tiles(SIDE, SIDE).unwrap();
    let cast = (0..PEOPLE).map(|number| {
        let column = 0.9 + 0.6 * number as f32;
        let (from, to) = (Vec2::new(column, 1.0), Vec2::new(column, 6.3));
        let mut person = Performance::new(Person::default(), number as u64);
        person.appear(from, 0.0).unwrap();
        person.walk(&[to]).unwrap();
        person
    });
    let script = Script::new(cast.collect(), geometry.bounds());
    let mut feet = Vec::new();
    let frames: Vec<ForceFrame> = (0..WALKED_MS)
        .map(|millis| {
            let at = Instant::from_millis(millis.into());
            feet.clear();
            script.feet_at(at, &mut feet);
            let mut frame = ForceFrame::empty(&geometry);
            (frame.at, frame.received) = (at, at);
            for load in feet.iter().flat_map(|foot| foot.on_tiles(&geometry)) {
                frame.add_load(&geometry, load.centroid, load.force);
            }
            frame
        })
        .collect();
    let mut group = criterion.benchmark_group("24x24, ten walkers");
    group.sample_size(10);
    group.throughput(Throughput::Elements(frames.len() as u64));
    for controls in [20, 500] {
        let layout = page_of(controls, &geometry);
        group.bench_function(format!("engine, {controls} controls, per frame"), |bencher| {
            bencher.iter_batched_ref(
                || Engine::new(geometry, layout.clone(), Method::Tracker),
                |engine| {
                    frames.iter().for_each(|frame| {
                        black_box(engine.step(frame));
                    });
                },
                BatchSize::LargeInput,
            );
        });
    }
    group.finish();
}

criterion_group!(benches, engine, large);
criterion_main!(benches);
