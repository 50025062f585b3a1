//! The speed of sustained voices relative to real time, on one core: 36 voices of each model, one on every tile.
//!
//! Each iteration renders one second, so criterion's "elem/s" is the real-time factor.

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use underfoot::feel::{Hum, Lasting, RendererConfig, Spot, SustainedCue, SustainedCues, renderer};
use underfoot::floor::Floor;
use underfoot::schema::Effects;
use underfoot::units::{Instant, Newtons};

const RATE: u64 = 96_000;
const BLOCK: usize = 64;

fn voices(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("36 voices on 36 channels, 96 kHz");
    group.throughput(Throughput::Elements(1));
    let effects = Effects::builtin();
    for name in ["smooth", "rubber", "wood", "gravel", "a hum"] {
        let hum = Lasting::Hum(Hum { level: Newtons(2.0), hz: 90.0, noise: 0.3 });
        let effect = effects.get(name).and_then(|named| named.effect.kind.lasting()).unwrap_or(hum);
        let sustained_cue = |tile: u16| SustainedCue {
            key: u32::from(tile),
            spots: [Spot { tile, weight: 1.0 }].into_iter().collect(),
            effect,
            speed_m_s: 0.3,
            force: Newtons(150.0),
            ..SustainedCue::default()
        };
        let sustained: SustainedCues = (0..36).map(sustained_cue).collect();
        let (mut sender, mut renderer) = renderer(RendererConfig::of(&Floor::default(), RATE as u32));
        let mut out = vec![0.0; BLOCK * renderer.channels()];
        let mut frame = 0_u64;
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                for _ in 0..RATE / BLOCK as u64 {
                    sender.sustain(&sustained);
                    renderer.render(&mut out, Instant::from_micros(frame * 1_000_000 / RATE));
                    frame += BLOCK as u64;
                    black_box(&out);
                }
            });
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10).measurement_time(Duration::from_secs(2)).without_plots();
    targets = voices
}
criterion_main!(benches);
