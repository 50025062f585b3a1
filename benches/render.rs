//! The speed of the renderer relative to real time, on one core, with the loads of `underfoot capacity`.
//!
//! Each iteration renders one second, so criterion's "elem/s" is the real-time
//! factor, and 100 divided by it is the share of a core in percent.
#![allow(missing_docs, reason = "a bench")]

use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use underfoot_lab::capacity::{BankLoad, RenderLoad, RenderWork};

fn whole_renderer(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("renderer, 36 channels");
    group.throughput(Throughput::Elements(1));
    for (name, work) in [
        ("96 kHz, 8 modes struck 20 times a second", RenderWork::of_modes(8)),
        ("96 kHz, 64 modes struck 20 times a second", RenderWork::of_modes(64)),
        ("96 kHz, 8 modes, friction and limiter", RenderWork::with_friction_and_limiter()),
        (
            "48 kHz, 8 modes struck 20 times a second",
            RenderWork { sample_rate: 48_000, ..RenderWork::of_modes(8) },
        ),
        ("96 kHz, silence", RenderWork::of_modes(0)),
    ] {
        let mut load = RenderLoad::new(work);
        load.second();
        group.bench_function(name, |bencher| bencher.iter(|| load.second()));
        let counters = load.counters();
        assert_eq!((counters.dropped, counters.late, counters.stolen), (0, 0, 0), "{name}");
    }
    group.finish();
}

/// The banks alone, into memory, as in measurements of other synthesis systems.
fn banks_alone(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("banks alone, 36 channels, 96 kHz");
    group.throughput(Throughput::Elements(1));
    for modes in [8, 64] {
        let mut load = BankLoad::new(modes);
        group.bench_function(format!("{modes} modes struck 20 times a second"), |bencher| {
            bencher.iter(|| load.second());
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20).measurement_time(Duration::from_secs(3)).without_plots();
    targets = whole_renderer, banks_alone
}
criterion_main!(benches);
