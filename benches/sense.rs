//! Nanoseconds per frame of sensing: Eq. 4 and the tracker on floors of three sizes, with two walkers on each,
//! and with walkers in proportion: two per 6 x 6 tiles. A frame is a millisecond of floor, so a thousand frames
//! per millisecond of work are a thousand times real time.
#![allow(missing_docs, clippy::expect_used, reason = "a bench")]

#[path = "../tests/sense_support/mod.rs"]
mod sense_support;

use std::hint::black_box;

use criterion::{BatchSize, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use sense_support::{Sensors, walk};
use underfoot::floor::{Geometry, TileId};
use underfoot::sense::{ForceFrame, Method, Sensing};

/// Frames of a floor of `side` x `side` tiles on which `walkers` people cross a stretch of 6 x 6 each, as many
/// milliseconds of it as `millis`.
fn crowd(side: u16, walkers: u16, millis: usize) -> (Geometry, Vec<ForceFrame>) {
    let geometry = Geometry::of_paper_tiles(side, side).expect("a square floor");
    let people = [walk(1, Sensors::PERFECT), walk(4, Sensors::PERFECT)];
    let stretches = side / 6;
    let frames = (500..500 + millis).map(|ms| {
        let mut frame = ForceFrame::empty(&geometry);
        frame.at = people[0].frames[ms].at;
        for walker in 0..walkers {
            let scene = &people[usize::from(walker % 2)];
            // Two on each stretch, and no two stretches in step.
            let stretch = walker / 2;
            let (east, north) = (6 * (stretch % stretches), 6 * (stretch / stretches));
            let ms = 500 + (ms - 500 + 37 * usize::from(stretch)) % 2000;
            for (index, forces) in scene.frames[ms].forces.iter().enumerate() {
                let tile = scene.geometry.tile_at_index(index);
                let column = (tile.column + 3 * (walker % 2)) % 6 + east;
                let here = TileId::new(column, tile.row % 6 + north);
                let here = geometry.index(here).expect("a tile of the floor");
                for (sum, force) in frame.forces[here].iter_mut().zip(forces) {
                    *sum += force;
                }
            }
        }
        frame
    });
    (geometry, frames.collect())
}

fn frames(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("sense");
    for (side, walkers, millis) in
        [(6, 2, 2000), (24, 2, 2000), (96, 2, 2000), (24, 32, 1000), (96, 512, 500)]
    {
        let (geometry, frames) = crowd(side, walkers, millis);
        group.throughput(Throughput::Elements(frames.len() as u64));
        for method in [Method::Eq4, Method::Tracker] {
            let id = BenchmarkId::new(format!("{method:?}"), format!("{side}x{side}, {walkers} walkers"));
            group.bench_function(id, |bencher| {
                bencher.iter_batched_ref(
                    || Sensing::new(geometry, method),
                    |sensing| {
                        for frame in &frames {
                            black_box(sensing.update(frame));
                        }
                    },
                    BatchSize::LargeInput,
                );
            });
        }
    }
    group.finish();
}

criterion_group!(benches, frames);
criterion_main!(benches);
