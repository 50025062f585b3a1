//! Speed of the renderer: standard loads on the paper's 36 tiles.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use underfoot::feel::{
    Click, Cue, CueSender, FeelCounters, Friction, MAX_MODES, ModalBank, Mode, Renderer, RendererConfig,
    Spot, SustainedCue, SustainedCues, renderer,
};
use underfoot::floor::Floor;
use underfoot::units::{Instant, Newtons};

/// Frames per block, as on a device with low latency.
const BLOCK: usize = 64;

/// Strikes per second on each tile.
const STRIKES: u64 = 20;

/// A load for the renderer on the paper's 36 tiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RenderWork {
    /// Sample rate (Hz).
    pub sample_rate: u32,
    /// Number of modes in each tile's strike, 20 strikes per second; 0 for no strikes, at most 64.
    pub modes: usize,
    /// True if nine feet slide; together they cover all tiles.
    pub friction: bool,
    /// Force of each mode: with 0.4 N the limiters stay idle, with 20 N all of them work.
    pub level: Newtons,
}

impl RenderWork {
    /// A load of `modes` modes below the limiters' thresholds, at 96 kHz.
    #[must_use]
    pub const fn of_modes(modes: usize) -> Self {
        Self { sample_rate: 96_000, modes, friction: false, level: Newtons(0.4) }
    }

    /// Eight modes with friction, loud enough that every channel's limiters work, at 96 kHz.
    #[must_use]
    pub const fn with_friction_and_limiter() -> Self {
        Self { sample_rate: 96_000, modes: 8, friction: true, level: Newtons(20.0) }
    }
}

/// The whole path from cues to samples in memory, on the paper's 36 tiles.
#[derive(Debug)]
pub struct RenderLoad {
    sender: CueSender,
    renderer: Renderer,
    /// The clicks that together make one strike on a tile.
    clicks: Vec<Click>,
    strikes_per_second: u64,
    sustained: SustainedCues,
    frame: u64,
    next_strike: u64,
    out: Vec<f32>,
}

impl RenderLoad {
    /// Prepares the load for its first second.
    #[must_use]
    pub fn new(work: RenderWork) -> Self {
        let (sender, renderer) = renderer(RendererConfig::of(&Floor::default(), work.sample_rate));
        let modes: Vec<Mode> = (0..work.modes.min(64)).map(mode).collect();
        let clicks = modes.chunks(MAX_MODES).map(|modes| Click {
            modes: modes.iter().map(|mode| Mode { amplitude: 1.0, ..*mode }).collect(),
            level: work.level,
            ..Click::default()
        });
        Self {
            clicks: clicks.collect(),
            strikes_per_second: if work.modes == 0 { 0 } else { STRIKES * renderer.channels() as u64 },
            sustained: if work.friction { nine_sustained() } else { SustainedCues::new() },
            frame: 0,
            next_strike: 0,
            out: vec![0.0; BLOCK * renderer.channels()],
            sender,
            renderer,
        }
    }

    /// Renders one second in blocks of 64 frames. Strikes alternate between the tiles, evenly spread over time.
    pub fn second(&mut self) {
        let rate = u64::from(self.renderer.sample_rate());
        let tiles = self.renderer.channels() as u64;
        let strikes = self.strikes_per_second;
        for _ in 0..rate / BLOCK as u64 {
            let block_start = Instant::from_micros(self.frame * 1_000_000 / rate);
            self.frame += BLOCK as u64;
            let block_end = Instant::from_micros(self.frame * 1_000_000 / rate);
            while strikes > 0 && Instant::from_micros(self.next_strike * 1_000_000 / strikes) < block_end {
                let at = Instant::from_micros(self.next_strike * 1_000_000 / strikes);
                let spot = Spot { tile: (self.next_strike % tiles) as u16, weight: 1.0 };
                for click in &self.clicks {
                    let spots = [spot].into_iter().collect();
                    let click = click.clone();
                    self.sender.send(&Cue { at, received: at, spots, click, ..Cue::default() });
                }
                self.next_strike += 1;
            }
            self.sender.sustain(&self.sustained);
            self.renderer.render(&mut self.out, block_start);
            std::hint::black_box(&self.out);
        }
    }

    /// Returns the counters of cues that could not be rendered; if one is above 0, the measurement is not valid.
    #[must_use]
    pub fn counters(&self) -> FeelCounters {
        self.renderer.counters()
    }

    /// Returns the last rendered block, interleaved.
    #[must_use]
    pub fn samples(&self) -> &[f32] {
        &self.out
    }
}

/// The modal banks alone, rendered to memory: 36 of them at 96 kHz, each struck 20 times a second.
#[derive(Clone, Debug)]
pub struct BankLoad {
    banks: Vec<ModalBank>,
    modes: usize,
    out: [f32; BLOCK],
}

impl BankLoad {
    /// Prepares banks of `modes` modes, at most 64.
    #[must_use]
    pub fn new(modes: usize) -> Self {
        let modes = modes.min(64);
        Self { banks: vec![ModalBank::new(96_000.0, modes); 36], modes, out: [0.0; BLOCK] }
    }

    /// Renders one second in blocks of 64 samples.
    pub fn second(&mut self) {
        for block in 0..96_000 / BLOCK {
            for bank in &mut self.banks {
                // 75 blocks are 50 ms.
                if block % 75 == 0 {
                    for Mode { frequency_hz, decay_s, amplitude } in (0..self.modes).map(mode) {
                        bank.strike(frequency_hz, decay_s, amplitude);
                    }
                }
                self.out.fill(0.0);
                bank.render(&mut self.out);
                std::hint::black_box(&self.out);
            }
        }
    }
}

/// One of up to 64 modes between 55 and 685 Hz with a decay time of some 50 ms.
fn mode(number: usize) -> Mode {
    Mode { frequency_hz: 55.0 + 10.0 * number as f32, decay_s: 0.03 + 0.001 * number as f32, amplitude: 0.1 }
}

/// Nine sliding feet that together cover all 36 tiles.
fn nine_sustained() -> SustainedCues {
    (0..9_u32)
        .map(|foot| SustainedCue {
            key: foot,
            spots: (0..4).map(|spot| Spot { tile: foot as u16 * 4 + spot, weight: 0.25 }).collect(),
            effect: Friction {
                level: Newtons(3.0),
                low_hz: 80.0,
                high_hz: 400.0,
                full_speed_m_s: 0.5,
                full_force: Newtons(400.0),
            }
            .into(),
            speed_m_s: 0.3,
            force: Newtons(300.0),
            ..SustainedCue::default()
        })
        .collect()
}

/// Returns the largest error of a bank of eight modes, drawn at random from `seed`, against double precision, in
/// decibels relative to the signal.
///
/// Renders twenty banks of modes of 20 to 1000 Hz with decay times of 1 ms to 2 s, a second of each in blocks of 64
/// samples.
#[must_use]
pub fn modal_error_db(sample_rate: u32, seed: u64) -> f64 {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let rate = f64::from(sample_rate);
    (0..20)
        .map(|_| {
            let mut bank = ModalBank::new(rate, 8);
            let modes: Vec<(f32, f32, f32)> = (0..8)
                .map(|_| {
                    let decay_s = 0.001 * 2000_f32.powf(random.random_range(0.0..=1.0));
                    (random.random_range(20.0..=1000.0), decay_s, random.random_range(-1.0..=1.0))
                })
                .collect();
            for &(frequency_hz, decay_s, amplitude) in &modes {
                bank.strike(frequency_hz, decay_s, amplitude);
            }
            let mut samples = vec![0.0; sample_rate as usize];
            samples.chunks_mut(BLOCK).for_each(|out| bank.render(out));
            let (mut error, mut signal) = (0.0, 0.0);
            for (n, sample) in (1_u32..).zip(&samples) {
                let t = f64::from(n) / rate;
                let wanted: f64 = modes
                    .iter()
                    .map(|&(f, d, a)| {
                        f64::from(a)
                            * (-t / f64::from(d)).exp()
                            * (std::f64::consts::TAU * f64::from(f) * t).sin()
                    })
                    .sum();
                error += (f64::from(*sample) - wanted).powi(2);
                signal += wanted * wanted;
            }
            10.0 * (error / signal).log10()
        })
        .fold(f64::NEG_INFINITY, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_load_does_what_it_says() {
        for work in
            [RenderWork::of_modes(8), RenderWork::of_modes(64), RenderWork::with_friction_and_limiter()]
        {
            let mut load = RenderLoad::new(work);
            load.second();
            let FeelCounters { dropped, late, unfelt, refused, stolen, .. } = load.counters();
            assert_eq!((dropped, late, unfelt, refused, stolen), (0, 0, 0, 0, 0), "{work:?}");
            let moving = load.samples().iter().filter(|sample| **sample != 0.0).count();
            assert_eq!(moving, 36 * BLOCK, "every tile moves");
            let loudest = load.samples().iter().fold(0.0_f32, |most, sample| most.max(sample.abs()));
            assert_eq!(loudest > 0.8, work.friction, "{loudest}");
        }
        let mut silent = RenderLoad::new(RenderWork::of_modes(0));
        silent.second();
        assert!(silent.samples().iter().all(|sample| *sample == 0.0));
    }

    #[test]
    fn modes_are_exact_to_100_db_and_more() {
        for rate in [48_000, 96_000] {
            let error = modal_error_db(rate, 3);
            assert!(error < -110.0, "{error:.1} dB at {rate} Hz");
        }
    }
}
