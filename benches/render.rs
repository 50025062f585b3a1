//! How much faster than real time the renderer is, on one core.
//!
//! Each iteration renders one second, so criterion's "elem/s" is the real-time
//! factor, and 100 divided by it is the share of a core in percent.

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use underfoot::feel::{
    Click, Cue, CueSender, Friction, ModalBank, Mode, Renderer, RendererConfig, Rub, Rubs, Spot, renderer,
};
use underfoot::floor::Floor;
use underfoot::units::{Instant, Newtons};

/// Frames per block, as on a device set for low latency.
const BLOCK: usize = 64;

const CHANNELS: u16 = 36;

/// A floor on which every tile is struck again and again.
struct Busy {
    sender: CueSender,
    renderer: Renderer,
    /// The clicks that strike each tile together.
    clicks: Vec<Click>,
    strikes_per_second: u64,
    rubs: Rubs,
    frame: u64,
    next_strike: u64,
    out: Vec<f32>,
}

impl Busy {
    fn new(sample_rate: u32, modes: usize, strikes_per_second: u64, rubs: Rubs) -> Self {
        let (sender, renderer) = renderer(RendererConfig::of(&Floor::default(), sample_rate));
        let modes: Vec<Mode> = (0..modes).map(mode).collect();
        let clicks = modes
            .chunks(8)
            .map(|modes| Click { modes: modes.iter().copied().collect(), level: Newtons(4.0) })
            .collect();
        let out = vec![0.0; BLOCK * renderer.channels()];
        Self { sender, renderer, clicks, strikes_per_second, rubs, frame: 0, next_strike: 0, out }
    }

    /// Renders one second. The tiles are struck one after the other, evenly spread over time.
    fn second(&mut self) {
        let rate = u64::from(self.renderer.sample_rate());
        let strikes = self.strikes_per_second * u64::from(CHANNELS);
        for _ in 0..rate / BLOCK as u64 {
            let block_start = Instant::from_micros(self.frame * 1_000_000 / rate);
            self.frame += BLOCK as u64;
            let block_end = Instant::from_micros(self.frame * 1_000_000 / rate);
            while strikes > 0 && Instant::from_micros(self.next_strike * 1_000_000 / strikes) < block_end {
                let at = Instant::from_micros(self.next_strike * 1_000_000 / strikes);
                let spot = Spot { tile: (self.next_strike % u64::from(CHANNELS)) as u16, weight: 1.0 };
                for click in &self.clicks {
                    let spots = [spot].into_iter().collect();
                    self.sender.send(&Cue { at, received: at, spots, click: click.clone(), to_air: 0.0 });
                }
                self.next_strike += 1;
            }
            self.sender.rubs(&self.rubs);
            self.renderer.render(&mut self.out, block_start);
            black_box(&self.out);
        }
    }
}

/// One of up to 64 modes between 55 and 685 Hz that ring for some 50 ms.
fn mode(number: usize) -> Mode {
    Mode { frequency_hz: 55.0 + 10.0 * number as f32, decay_s: 0.03 + 0.001 * number as f32, amplitude: 0.1 }
}

/// Nine feet that between them rub on all 36 tiles.
fn nine_rubs() -> Rubs {
    (0..9_u32)
        .map(|foot| Rub {
            key: foot,
            spots: (0..4).map(|spot| Spot { tile: foot as u16 * 4 + spot, weight: 0.25 }).collect(),
            friction: Friction {
                level: Newtons(3.0),
                low_hz: 80.0,
                high_hz: 400.0,
                full_speed_m_s: 0.5,
                full_force: Newtons(400.0),
            },
            speed_m_s: 0.3,
            force: Newtons(300.0),
        })
        .collect()
}

fn whole_renderer(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("renderer, 36 channels");
    group.throughput(Throughput::Elements(1));
    for (name, rate, modes, strikes, rubs) in [
        ("48 kHz, a 3-mode click on every tile 10 times a second", 48_000, 3, 10, Rubs::new()),
        ("96 kHz, a 3-mode click on every tile 10 times a second", 96_000, 3, 10, Rubs::new()),
        ("96 kHz, 8 modes struck 20 times a second", 96_000, 8, 20, Rubs::new()),
        ("96 kHz, 64 modes struck 20 times a second", 96_000, 64, 20, Rubs::new()),
        ("96 kHz, 8 modes struck 20 times a second, friction on every tile", 96_000, 8, 20, nine_rubs()),
        ("96 kHz, silence", 96_000, 3, 0, Rubs::new()),
    ] {
        let mut busy = Busy::new(rate, modes, strikes, rubs);
        busy.second();
        group.bench_function(name, |bencher| bencher.iter(|| busy.second()));
        let counters = busy.sender.counters();
        assert_eq!((counters.dropped, counters.late, counters.stolen), (0, 0, 0), "{name}");
    }
    group.finish();
}

/// The banks alone, to memory: what other synthesis systems were measured by.
fn banks_alone(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("banks alone, 36 channels, 96 kHz");
    group.throughput(Throughput::Elements(1));
    for modes in [8, 64] {
        let mut banks = vec![ModalBank::new(96_000.0, modes); usize::from(CHANNELS)];
        let mut out = vec![0.0; BLOCK];
        group.bench_function(format!("{modes} modes struck 20 times a second"), |bencher| {
            bencher.iter(|| {
                // 75 blocks of 64 frames are 50 ms.
                for block in 0..1500 {
                    for bank in &mut banks {
                        if block % 75 == 0 {
                            for Mode { frequency_hz, decay_s, amplitude } in (0..modes).map(mode) {
                                bank.strike(frequency_hz, decay_s, amplitude);
                            }
                        }
                        out.fill(0.0);
                        bank.render(&mut out);
                        black_box(&out);
                    }
                }
            });
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
