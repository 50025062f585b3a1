//! Nanoseconds per frame of sensing: Eq. 4 and the tracker on floors of three sizes, with two walkers on each,
//! and with walkers in proportion: two per 6 x 6 tiles. A frame is a millisecond of floor, so a thousand frames
//! per millisecond of work are a thousand times real time.
#![allow(missing_docs, clippy::expect_used, reason = "a bench")]

#[path = "../tests/sense_support/mod.rs"]
mod sense_support;

use std::hint::black_box;
use std::num::NonZeroUsize;

use criterion::{BatchSize, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use sense_support::{Crowd, Moment};
use underfoot::parallel::ThreadPool;
use underfoot::sense::{ForceFrame, Method, Sensing};

/// Senses one frame for each of `moments`.
fn sense(sensing: &mut Sensing, frame: &mut ForceFrame, moments: &[Moment]) {
    let mut before = None;
    for moment in moments {
        moment.show(frame, before.replace(moment));
        black_box(sensing.update(frame));
    }
}

fn frames(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("sense");
    for (side, walkers, millis) in
        [(6, 2, 2000), (24, 2, 2000), (96, 2, 2000), (24, 32, 1000), (96, 512, 500)]
    {
        let Crowd { geometry, moments } = Crowd::of(side, walkers, millis);
        group.throughput(Throughput::Elements(moments.len() as u64));
        for method in [Method::Eq4, Method::Tracker] {
            let id = BenchmarkId::new(format!("{method:?}"), format!("{side}x{side}, {walkers} walkers"));
            let begin = || (Sensing::new(geometry, method), ForceFrame::empty(&geometry));
            group.bench_function(id, |bencher| {
                bencher.iter_batched_ref(
                    begin,
                    |(sensing, frame)| sense(sensing, frame, &moments),
                    BatchSize::LargeInput,
                );
            });
        }
    }
    group.finish();
}

/// The densest crowd on as many threads as there are cores, on half of them, and on one.
fn thread_pools(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("sense on several threads");
    let cores = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let Crowd { geometry, moments } = Crowd::of(96, 512, 500);
    group.throughput(Throughput::Elements(moments.len() as u64));
    let mut threads = vec![1, cores.div_ceil(2), cores];
    threads.dedup();
    for threads in threads.into_iter().filter_map(NonZeroUsize::new) {
        let pool = ThreadPool::new(threads).expect("threads");
        let id = BenchmarkId::new("Tracker/96x96, 512 walkers", threads);
        group.bench_function(id, |bencher| {
            bencher.iter_batched_ref(
                || (Sensing::new(geometry, Method::Tracker), ForceFrame::empty(&geometry)),
                |(sensing, frame)| pool.run(|| sense(sensing, frame, &moments)),
                BatchSize::LargeInput,
            );
        });
    }
    group.finish();
}

criterion_group!(benches, frames, thread_pools);
criterion_main!(benches);
