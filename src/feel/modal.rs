// Loops over lanes stay plain indexed loops: those are the ones that become vector instructions.
#![allow(clippy::needless_range_loop)]

use std::f64::consts::TAU;

use multiversion::multiversion;
use multiversion::target::target_cfg_f;

/// Samples that one table of powers spans: one AVX-512 register, two of AVX2.
const STEP: usize = 16;

/// Steps that are taken with one loading of the table.
const STEPS: usize = 4;

/// Samples that a bank renders in one go.
const BLOCK: usize = STEP * STEPS;

/// Modes that are summed up in one go.
const QUAD: usize = 4;

/// Rotations by 1, 2, 4, … [`BLOCK`] samples: enough to advance by any number up to a block.
const POWERS: usize = BLOCK.ilog2() as usize + 1;

/// A mode whose amplitude falls below this (-154 dB of full scale) has rung out.
const SILENCE: f64 = 2e-8;

/// How often, in samples, modes that have rung out are looked for.
const CHECK: usize = 512;

/// A bank of decaying sine modes, struck and left to ring.
///
/// Each mode is one complex number that turns and shrinks by a constant factor
/// `r` per sample; its output is the imaginary part. The state advances in
/// double precision once per 64 samples, and the samples in between are the
/// state times small tables of powers of `r`: faster than a recurrence per
/// sample, and without its rounding (a single-precision two-pole filter is off
/// by -23 dB for a 60 Hz mode at 96 kHz, this by less than -140 dB).
///
/// Modes of equal frequency and decay share one state, since the sum of two
/// such modes is again one. A silent bank costs nothing.
///
/// # Source
/// `s(t) = sum a_i exp(-b_i t) sin(2 pi f_i t)` (paper, section 4.1.1).
#[derive(Clone, Debug)]
pub struct ModalBank {
    sample_rate: f64,
    /// Which mode each slot holds; the first `active` slots ring.
    keys: Vec<Key>,
    quads: Vec<Quad>,
    active: usize,
    /// Samples since the last look for modes that have rung out.
    unchecked: usize,
    /// Where the last strike landed: clicks strike their modes in the same order every time.
    last: usize,
}

/// A mode's frequency and decay time, the two numbers that shape it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Key {
    frequency_hz: f32,
    decay_s: f32,
}

/// Four modes side by side.
#[derive(Clone, Debug)]
#[repr(align(64))]
struct Quad {
    /// `r` to the power of 1 to [`STEP`], for each mode.
    shapes: [Shape; QUAD],
    /// `r` to the power of 0, [`STEP`], 2 [`STEP`], and so on.
    strides: Points,
    /// The state at the start of each step of the block at hand.
    points: Points,
    /// `r` to the power of 1, 2, 4, … [`BLOCK`].
    powers: [Complexes; POWERS],
    /// The state one sample before the next one to be rendered.
    state: Complexes,
}

#[derive(Clone, Copy, Debug)]
struct Shape {
    re: [f32; STEP],
    im: [f32; STEP],
}

/// One complex number per step and mode.
#[derive(Clone, Copy, Debug)]
struct Points {
    re: [[f32; QUAD]; STEPS],
    im: [[f32; QUAD]; STEPS],
}

/// One complex number per mode.
#[derive(Clone, Copy, Debug)]
struct Complexes {
    re: [f64; QUAD],
    im: [f64; QUAD],
}

impl ModalBank {
    /// A silent bank for up to `modes` different modes (rounded up to a multiple of four) at `sample_rate` hertz.
    ///
    /// All memory is taken here.
    #[must_use]
    pub fn new(sample_rate: f64, modes: usize) -> Self {
        let quads = modes.div_ceil(QUAD).max(1);
        Self {
            sample_rate,
            keys: vec![Key::default(); quads * QUAD],
            quads: vec![Quad::SILENT; quads],
            active: 0,
            unchecked: 0,
            last: 0,
        }
    }

    /// Number of different modes that can ring at once.
    #[must_use]
    pub fn capacity(&self) -> usize {
        self.keys.len()
    }

    /// Number of modes that ring.
    #[must_use]
    pub fn ringing(&self) -> usize {
        self.active
    }

    /// Whether nothing rings: the next samples are all zero.
    #[must_use]
    pub fn is_silent(&self) -> bool {
        self.active == 0
    }

    /// Stops every mode at once.
    pub fn clear(&mut self) {
        for slot in 0..self.active {
            self.quads[slot / QUAD].state.set(slot % QUAD, (0.0, 0.0));
        }
        self.active = 0;
    }

    /// Strikes a mode, so that the very next sample rendered is the first that moves.
    ///
    /// `frequency_hz` lies between 0 and half the sample rate, `decay_s` (the
    /// time to 1/e) above zero, `amplitude` is any finite number; the caller
    /// checks them. If the bank is full, the mode with the least energy makes
    /// room: then the answer is true.
    ///
    /// # Real-time
    /// No allocation. A mode that is not ringing yet costs one sine, cosine and
    /// exponential.
    pub fn strike(&mut self, frequency_hz: f32, decay_s: f32, amplitude: f32) -> bool {
        let key = Key { frequency_hz, decay_s };
        let (slot, stolen) = match self.find(key) {
            Some(slot) => (slot, false),
            None => self.claim(key),
        };
        self.last = slot;
        self.quads[slot / QUAD].state.re[slot % QUAD] += f64::from(amplitude);
        stolen
    }

    /// Adds the next `out.len()` samples to `out`.
    ///
    /// # Real-time
    /// No allocation; nothing at all to do if the bank is silent.
    pub fn render(&mut self, out: &mut [f32]) {
        if self.active == 0 || out.is_empty() {
            return;
        }
        render_quads(&mut self.quads[..self.active.div_ceil(QUAD)], out);
        self.unchecked += out.len();
        if self.unchecked >= CHECK {
            self.unchecked = 0;
            for slot in (0..self.active).rev() {
                if self.energy(slot) < SILENCE * SILENCE {
                    self.release(slot);
                }
            }
        }
    }

    fn find(&self, key: Key) -> Option<usize> {
        let ringing = &self.keys[..self.active];
        let next = self.last + 1;
        if ringing.get(next) == Some(&key) {
            return Some(next);
        }
        ringing.iter().position(|held| *held == key)
    }

    /// A slot for a mode that does not ring yet, and whether another had to give it up.
    fn claim(&mut self, key: Key) -> (usize, bool) {
        let stolen = self.active == self.keys.len();
        let slot = if stolen { self.weakest() } else { self.active };
        if !stolen {
            self.active += 1;
        }
        self.keys[slot] = key;
        self.quads[slot / QUAD].tune(slot % QUAD, key, self.sample_rate);
        (slot, stolen)
    }

    fn weakest(&self) -> usize {
        (0..self.active).min_by(|a, b| self.energy(*a).total_cmp(&self.energy(*b))).unwrap_or(0)
    }

    fn energy(&self, slot: usize) -> f64 {
        self.quads[slot / QUAD].state.energy(slot % QUAD)
    }

    /// Gives a slot back; the last ringing mode moves into its place.
    fn release(&mut self, slot: usize) {
        self.active -= 1;
        let last = self.active;
        self.keys[slot] = self.keys[last];
        let moved = self.quads[last / QUAD].clone();
        self.quads[slot / QUAD].copy(slot % QUAD, &moved, last % QUAD);
        self.quads[last / QUAD].state.set(last % QUAD, (0.0, 0.0));
    }
}

impl Quad {
    const SILENT: Self = Self {
        shapes: [Shape { re: [0.0; STEP], im: [0.0; STEP] }; QUAD],
        strides: Points::ZERO,
        points: Points::ZERO,
        powers: [Complexes::ZERO; POWERS],
        state: Complexes::ZERO,
    };

    /// Makes `lane` a silent mode of this frequency and decay.
    fn tune(&mut self, lane: usize, key: Key, sample_rate: f64) {
        let angle = TAU * f64::from(key.frequency_hz) / sample_rate;
        let shrink = (-1.0 / (f64::from(key.decay_s) * sample_rate)).exp();
        let mut power = (shrink * angle.cos(), shrink * angle.sin());

        // r; then r^2; then r^3 and r^4 as r^2 times both, and so on.
        let mut table = [power; BLOCK];
        for (exponent, powers) in self.powers.iter_mut().enumerate() {
            powers.set(lane, power);
            let known = 1 << exponent;
            for n in known..BLOCK.min(2 * known) {
                table[n] = product(table[n - known], power);
            }
            power = product(power, power);
        }
        self.shapes[lane] = Shape {
            re: std::array::from_fn(|n| table[n].0 as f32),
            im: std::array::from_fn(|n| table[n].1 as f32),
        };
        self.strides.set(lane, 0, (1.0, 0.0));
        for step in 1..STEPS {
            let (re, im) = table[step * STEP - 1];
            self.strides.set(lane, step, (re as f32, im as f32));
        }
        self.state.set(lane, (0.0, 0.0));
    }

    /// Makes `lane` the mode that `from` holds in another lane.
    fn copy(&mut self, lane: usize, from: &Self, other: usize) {
        self.shapes[lane] = from.shapes[other];
        for step in 0..STEPS {
            self.strides.set(lane, step, (from.strides.re[step][other], from.strides.im[step][other]));
        }
        for (power, of_other) in self.powers.iter_mut().zip(&from.powers) {
            power.set(lane, of_other.get(other));
        }
        self.state.set(lane, from.state.get(other));
    }

    /// Works out the points of the next block and moves the state on by `samples`, at most a block.
    #[inline(always)]
    fn advance(&mut self, samples: usize) {
        let re = self.state.re.map(|x| x as f32);
        let im = self.state.im.map(|x| x as f32);
        for step in 0..STEPS {
            for lane in 0..QUAD {
                let (c, s) = (self.strides.re[step][lane], self.strides.im[step][lane]);
                self.points.re[step][lane] = c * re[lane] - s * im[lane];
                self.points.im[step][lane] = c * im[lane] + s * re[lane];
            }
        }
        for (exponent, power) in self.powers.iter().enumerate() {
            if samples & (1 << exponent) != 0 {
                self.state = self.state.times(power);
            }
        }
    }

    /// Adds the block that was last advanced over to `out`.
    #[inline(always)]
    fn emit<const FUSED: bool>(&self, out: &mut [f32; BLOCK]) {
        for n in 0..STEP {
            let mut sums = [0.0; STEPS];
            for lane in 0..QUAD {
                let (c, s) = (self.shapes[lane].re[n], self.shapes[lane].im[n]);
                for step in 0..STEPS {
                    sums[step] = multiply_add::<FUSED>(self.points.re[step][lane], s, sums[step]);
                    sums[step] = multiply_add::<FUSED>(self.points.im[step][lane], c, sums[step]);
                }
            }
            for step in 0..STEPS {
                out[step * STEP + n] += sums[step];
            }
        }
    }
}

impl Points {
    const ZERO: Self = Self { re: [[0.0; QUAD]; STEPS], im: [[0.0; QUAD]; STEPS] };

    fn set(&mut self, lane: usize, step: usize, (re, im): (f32, f32)) {
        self.re[step][lane] = re;
        self.im[step][lane] = im;
    }
}

impl Complexes {
    const ZERO: Self = Self { re: [0.0; QUAD], im: [0.0; QUAD] };

    fn get(&self, lane: usize) -> (f64, f64) {
        (self.re[lane], self.im[lane])
    }

    fn set(&mut self, lane: usize, (re, im): (f64, f64)) {
        self.re[lane] = re;
        self.im[lane] = im;
    }

    fn energy(&self, lane: usize) -> f64 {
        self.re[lane] * self.re[lane] + self.im[lane] * self.im[lane]
    }

    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        let mut result = Self::ZERO;
        for lane in 0..QUAD {
            result.set(lane, product(self.get(lane), other.get(lane)));
        }
        result
    }
}

#[inline(always)]
fn product(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

/// `a * b + c`, in one instruction where there is one: without it, `mul_add` is a slow library call.
#[inline(always)]
fn multiply_add<const FUSED: bool>(a: f32, b: f32, c: f32) -> f32 {
    if FUSED { a.mul_add(b, c) } else { a * b + c }
}

/// Adds all quads to `out` with the widest registers this processor has.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx2+fma", "x86_64+avx2+fma", "aarch64+neon"))]
fn render_quads(quads: &mut [Quad], out: &mut [f32]) {
    if target_cfg_f!(any(target_feature = "fma", target_arch = "aarch64")) {
        render_quads_with::<true>(quads, out);
    } else {
        render_quads_with::<false>(quads, out);
    }
}

#[inline(always)]
fn render_quads_with<const FUSED: bool>(quads: &mut [Quad], out: &mut [f32]) {
    let (blocks, rest) = out.as_chunks_mut::<BLOCK>();
    for block in blocks {
        render_block::<FUSED>(quads, block, BLOCK);
    }
    if !rest.is_empty() {
        let mut block = [0.0; BLOCK];
        render_block::<FUSED>(quads, &mut block, rest.len());
        for (sample, more) in rest.iter_mut().zip(&block) {
            *sample += more;
        }
    }
}

/// Adds a block to `out`, of which only the first `samples` count.
///
/// In two passes, so that no quad has to wait for the rounding of its points.
#[inline(always)]
fn render_block<const FUSED: bool>(quads: &mut [Quad], out: &mut [f32; BLOCK], samples: usize) {
    for quad in &mut *quads {
        quad.advance(samples);
    }
    for quad in quads {
        quad.emit::<FUSED>(out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f64 = 96_000.0;

    /// What the bank ought to give, in double precision from the definition.
    fn reference(modes: &[(f32, f32, f32)], samples: usize) -> Vec<f64> {
        (1..=samples)
            .map(|n| {
                let t = n as f64 / RATE;
                modes
                    .iter()
                    .map(|&(f, d, a)| {
                        f64::from(a) * (-t / f64::from(d)).exp() * (TAU * f64::from(f) * t).sin()
                    })
                    .sum()
            })
            .collect()
    }

    fn error_db(got: &[f32], wanted: &[f64]) -> f64 {
        let error: f64 = got.iter().zip(wanted).map(|(g, w)| (f64::from(*g) - w).powi(2)).sum();
        let signal: f64 = wanted.iter().map(|w| w * w).sum();
        10.0 * (error / signal).log10()
    }

    /// Blocks of 441 end in the middle of a quantum, as a 44.1 kHz device's do.
    #[test]
    fn error_stays_below_minus_100_db_whatever_the_block() {
        for modes in [
            vec![(60.0, 2.0, 1.0)],
            vec![
                (20.0, 2.0, 0.5),
                (60.0, 0.3, 1.0),
                (231.7, 0.05, -0.4),
                (999.0, 0.01, 0.3),
                (500.0, 1.0, 0.1),
            ],
        ] {
            let wanted = reference(&modes, 96_000);
            for block in [1, 7, 64, 441, 96_000] {
                let mut bank = ModalBank::new(RATE, 8);
                for &(f, d, a) in &modes {
                    bank.strike(f, d, a);
                }
                let mut got = vec![0.0; wanted.len()];
                got.chunks_mut(block).for_each(|out| bank.render(out));
                let error = error_db(&got, &wanted);
                assert!(error < -130.0, "{} modes in blocks of {block}: {error:.1} dB", modes.len());
            }
        }
    }

    /// The kernel that processors without fused multiplication get, which this machine would not choose.
    #[test]
    fn the_plainest_kernel_is_as_exact() {
        let mut bank = ModalBank::new(RATE, 4);
        bank.strike(60.0, 0.5, 1.0);
        bank.strike(417.0, 0.03, -0.7);
        let mut got = vec![0.0; 9600];
        got.chunks_mut(100).for_each(|out| render_quads_with::<false>(&mut bank.quads, out));
        let error = error_db(&got, &reference(&[(60.0, 0.5, 1.0), (417.0, 0.03, -0.7)], 9600));
        assert!(error < -100.0, "{error:.1} dB");
    }

    #[test]
    fn the_sample_after_a_strike_is_the_first_that_moves() {
        let mut bank = ModalBank::new(RATE, 4);
        let mut out = [0.0; 10];
        bank.render(&mut out[..3]);
        bank.strike(100.0, 0.1, 1.0);
        bank.render(&mut out[3..]);
        assert_eq!(out[..3], [0.0; 3]);
        assert!((out[3] - 0.00654).abs() < 1e-5, "{}", out[3]);
    }

    #[test]
    fn equal_modes_share_a_slot_and_add_up() {
        let mut twice = ModalBank::new(RATE, 4);
        let mut once = ModalBank::new(RATE, 4);
        let mut out = [[0.0; 500]; 2];
        twice.strike(120.0, 0.05, 0.25);
        twice.strike(120.0, 0.05, 0.25);
        once.strike(120.0, 0.05, 0.5);
        assert_eq!(twice.ringing(), 1);
        twice.render(&mut out[0]);
        once.render(&mut out[1]);
        assert_eq!(out[0], out[1]);
    }

    #[test]
    fn a_mode_that_has_rung_out_frees_its_slot_and_leaves_the_others_alone() {
        let mut bank = ModalBank::new(RATE, 8);
        for (f, d) in [(300.0, 0.002), (60.0, 1.0), (500.0, 0.002), (80.0, 1.0), (90.0, 1.0)] {
            bank.strike(f, d, 0.2);
        }
        let wanted = reference(&[(60.0, 1.0, 0.2), (80.0, 1.0, 0.2), (90.0, 1.0, 0.2)], 19_200);
        let mut out = vec![0.0; 19_200];
        out.chunks_mut(96).for_each(|block| bank.render(block));
        assert_eq!(bank.ringing(), 3);
        // The short ones are gone after 0.05 s; what is left is the three long ones.
        assert!(error_db(&out[9600..], &wanted[9600..]) < -100.0);
    }

    #[test]
    fn a_full_bank_gives_up_its_weakest_mode() {
        let mut bank = ModalBank::new(RATE, 4);
        for (f, a) in [(100.0, 0.5), (200.0, 0.1), (300.0, 0.5), (400.0, 0.5)] {
            assert!(!bank.strike(f, 1.0, a));
        }
        assert!(bank.strike(500.0, 1.0, 0.5));
        assert_eq!(bank.ringing(), 4);
        assert!(!bank.keys.iter().any(|key| key.frequency_hz == 200.0));
    }

    #[test]
    fn silence_is_exact_and_reached() {
        let mut bank = ModalBank::new(RATE, 4);
        bank.strike(150.0, 0.01, 1.0);
        let mut out = vec![0.0; 96_000];
        out.chunks_mut(64).for_each(|block| bank.render(block));
        assert!(bank.is_silent());
        assert_eq!(out[90_000..], vec![0.0; 6000]);
        // No sample is a denormal number, which would be slow to compute with.
        assert!(out.iter().all(|x| *x == 0.0 || x.is_normal()));
    }
}
