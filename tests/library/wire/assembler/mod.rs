//! Packets of several boards become frames, after any disturbance on the way.
//!
//! The floor here has three rows of two tiles, so three boards of eight channels. Every channel of a packet carries
//! its sequence number as newtons: a frame then shows which sample of each board it holds.

mod clocks;
mod losses;
mod properties;
mod readings;
mod tare;

use underfoot::floor::{Floor, Geometry};
use underfoot::sense::{Assembler, ForceFrame, Quality};
use underfoot::units::Instant;
use underfoot::wire::{Readings, SensorPacket};

const BOARDS: u16 = 3;

fn floor() -> Floor {
    Floor::of(Geometry::of_paper_tiles(2, BOARDS).unwrap())
}

fn assembler() -> Assembler {
    Assembler::new(&floor())
}

fn at_us(board: u16, sequence: u32, received_us: u64) -> SensorPacket {
    // Up to 40 kN and down again: readings beyond 50 kN are invalid, and loads do not jump.
    let newtons = sequence.min(80_000_u32.saturating_sub(sequence));
    let readings = Readings::Newtons([newtons as f32; 8].into_iter().collect());
    SensorPacket { board, sequence, received: Instant::from_micros(received_us), readings }
}

fn packet(board: u16, sequence: u32, received_ms: u64) -> SensorPacket {
    at_us(board, sequence, received_ms * 1000)
}

/// The content of a frame for each board: its sample and quality.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Shown {
    at_us: u64,
    samples: [f32; 3],
    quality: [Quality; 3],
}

fn shown(frame: &ForceFrame) -> Shown {
    // A board's tiles are a row; its first sensor represents all.
    let rows = [0, 2, 4];
    Shown {
        at_us: frame.at.micros(),
        samples: rows.map(|tile| frame.forces[tile][0]),
        quality: rows.map(|tile| frame.quality[tile][0]),
    }
}

fn drain(assembler: &mut Assembler, frames: &mut Vec<Shown>) {
    while let Some(frame) = assembler.ready() {
        frames.push(shown(frame));
    }
}

fn feed(assembler: &mut Assembler, packets: impl IntoIterator<Item = SensorPacket>) -> Vec<Shown> {
    let mut frames = Vec::new();
    for packet in packets {
        assembler.take(&packet);
        drain(assembler, &mut frames);
    }
    frames
}

fn poll(assembler: &mut Assembler, now_ms: u64) -> Vec<Shown> {
    let mut frames = Vec::new();
    assembler.poll(Instant::from_millis(now_ms));
    drain(assembler, &mut frames);
    frames
}

/// Packets of all boards, from millisecond `from` to before `until`, numbered like the milliseconds.
fn steady(from: u64, until: u64) -> impl Iterator<Item = SensorPacket> + Clone {
    (from..until).flat_map(|ms| (0..BOARDS).map(move |board| packet(board, ms as u32, ms)))
}

const LIVE: [Quality; 3] = [Quality::Live; 3];
