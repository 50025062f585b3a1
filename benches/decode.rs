//! The cost of packets on their way from datagram to frame, and the cost of hostile ones.
//!
//! `cargo bench -p underfoot --bench decode --no-default-features`

#![allow(missing_docs, clippy::unwrap_used)]

#[path = "../tests/support/corrupt.rs"]
mod corrupt;

use std::hint::black_box;
use std::net::UdpSocket;
use std::time::Duration;

use corrupt::{bundle_bomb, hostile_address, tag_bomb};
use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use underfoot::floor::{Floor, Geometry};
use underfoot::sense::Assembler;
use underfoot::source::UdpSource;
use underfoot::units::Instant;
use underfoot::wire::{
    Batch, DatagramLimits, Decoder, Readings, SensorEncoder, SensorFormat, SensorPacket, check,
};

/// The packets of one millisecond, one per board.
fn millisecond(floor: &Floor, ms: u32) -> Vec<SensorPacket> {
    let packet = |(board, channels): (u16, usize)| SensorPacket {
        board,
        sequence: ms,
        received: Instant::from_millis(ms.into()),
        readings: Readings::Counts(
            (0..channels as u16).map(|n| Some(20_000 + (ms as u16 ^ n) % 512)).collect(),
        ),
    };
    (0..).zip(floor.boards.iter().map(|board| board.channels.len())).map(packet).collect()
}

fn decode(c: &mut Criterion) {
    let floor = Floor::default();
    let decoder = Decoder::new(&floor);
    let packet = &millisecond(&floor, 1)[3];
    let formats =
        [("counts", SensorFormat::Counts), ("newtons", SensorFormat::Newtons), ("blob", SensorFormat::Blob)];
    let mut group = c.benchmark_group("packet of 24 channels");
    for (name, format) in formats {
        let mut encoder = SensorEncoder::new(&floor, format);
        let datagram = encoder.encode(packet).unwrap().to_vec();
        let mut batch = Batch::default();
        group.bench_function(format!("decode {name}"), |b| {
            b.iter(|| decoder.decode(black_box(&datagram), Instant::START, &mut batch));
        });
        group.bench_function(format!("guard alone {name}"), |b| {
            b.iter(|| check(black_box(&datagram), &DatagramLimits::SENSORS));
        });
        group.bench_function(format!("encode {name}"), |b| {
            b.iter(|| encoder.encode(black_box(packet)).map(<[u8]>::len));
        });
    }
    group.finish();
}

fn refuse(c: &mut Criterion) {
    let decoder = Decoder::new(&Floor::default());
    // As large as the limits allow, so that the walk itself runs, and far larger.
    let roomy = DatagramLimits { bytes: 65_507, tags: 65_507, address: 65_507, ..DatagramLimits::SENSORS };
    let mut group = c.benchmark_group("refuse");
    let bombs = [
        ("bundle bomb 3000 deep, 60 kB", bundle_bomb(3000)),
        ("tag bomb 22000 deep, 22 kB", tag_bomb(22_000)),
        ("address of 60 kB", hostile_address(60_000)),
    ];
    for (name, bomb) in &bombs {
        let mut batch = Batch::default();
        group.bench_function(*name, |b| {
            b.iter(|| decoder.decode(black_box(bomb), Instant::START, &mut batch).is_err());
        });
        group.bench_function(format!("{name}, without the size limit"), |b| {
            b.iter(|| check(black_box(bomb), &roomy));
        });
    }
    let small = bundle_bomb(400);
    group.bench_function("bundle bomb 400 deep, 8 kB", |b| {
        b.iter(|| check(black_box(&small), &DatagramLimits::SENSORS).is_err());
    });
    group.finish();
}

/// Number of packets that are made before the measurement.
const PACKETS_AHEAD: usize = 1500;

fn assemble(c: &mut Criterion) {
    let mut group = c.benchmark_group("frame");
    for (columns, rows) in [(6, 6), (24, 24), (96, 96)] {
        let floor = Floor::of(Geometry::of_paper_tiles(columns, rows).unwrap());
        let mut assembler = Assembler::new(&floor);
        let mut ms = 0;
        // A decoder passes each packet on as soon as it is written. So the packets made ahead stay within a
        // processor's own cache (half a megabyte), and the result does not depend on the speed of the memory.
        let ahead = (PACKETS_AHEAD / floor.boards.len()).max(1) as u64;
        group.bench_function(format!("assemble {columns} x {rows}"), |b| {
            b.iter_batched_ref(
                || {
                    ms += 1;
                    millisecond(&floor, ms)
                },
                |packets| {
                    packets.iter().for_each(|packet| assembler.take(packet));
                    assembler.ready().is_some()
                },
                BatchSize::NumIterations(ahead),
            );
        });
    }
    group.finish();
}

fn receive(c: &mut Criterion) {
    // A sender may send twice as many packets as the floor's boards do; with so many boards, the limit is never
    // reached.
    let floor = Geometry::of_paper_tiles(6, 250).map(Floor::of).unwrap();
    let mut source = UdpSource::bind("127.0.0.1:0".parse().unwrap(), &floor).unwrap();
    let sender = UdpSocket::bind("127.0.0.1:0").unwrap();
    sender.connect(source.local_addr().unwrap()).unwrap();
    let datagram =
        SensorEncoder::new(&floor, SensorFormat::Counts).encode(&millisecond(&floor, 1)[3]).unwrap().to_vec();
    c.bench_function("send and receive one packet over loopback", |b| {
        b.iter(|| {
            sender.send(&datagram).unwrap();
            source.next(Duration::from_millis(10)).unwrap().is_some()
        });
    });
}

criterion_group!(benches, decode, refuse, assemble, receive);
criterion_main!(benches);
