//! Nanoseconds per frame of sensing: Eq. 4 and the tracker on floors of three sizes, two walkers on each.
#![allow(missing_docs, clippy::expect_used, reason = "a bench")]

#[path = "../tests/sense_support/mod.rs"]
mod sense_support;

use std::hint::black_box;

use criterion::{BatchSize, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use sense_support::{Sensors, walk};
use underfoot::floor::{Geometry, TileId};
use underfoot::sense::{ForceFrame, Method, Sensing};

/// Two walkers who cross a floor of `side` x `side` tiles for a second, over and over.
fn crowd(side: u16) -> (Geometry, Vec<ForceFrame>) {
    let geometry = Geometry::of_paper_tiles(side, side).expect("a square floor");
    let people = [walk(1, Sensors::PERFECT), walk(4, Sensors::PERFECT)];
    let frames = (500..2500).map(|ms| {
        let mut frame = ForceFrame::empty(&geometry);
        frame.at = people[0].frames[ms].at;
        for (person, scene) in people.iter().enumerate() {
            for (index, forces) in scene.frames[ms].forces.iter().enumerate() {
                let tile = scene.geometry.tile_at_index(index);
                // Each walks a stretch of the small floor again and again.
                let column = (tile.column + 3 * person as u16) % side;
                let here = geometry.index(TileId::new(column, tile.row % side)).expect("a tile of the floor");
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
    for side in [6, 24, 96] {
        let (geometry, frames) = crowd(side);
        group.throughput(Throughput::Elements(frames.len() as u64));
        for method in [Method::Eq4, Method::Tracker] {
            let id = BenchmarkId::new(format!("{method:?}"), format!("{side}x{side}"));
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
