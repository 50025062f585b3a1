// Loops over lanes stay plain indexed loops: those are the ones that become vector instructions.
#![allow(clippy::needless_range_loop)]

mod basis;

use std::f64::consts::TAU;

use multiversion::multiversion;
use multiversion::target::target_cfg_f;

use super::mix::{LANES, transposed};
use basis::{Basis, TERMS};

pub(super) use basis::SPAN;

/// Modes that are moved on together: as many double-precision numbers as the widest register holds.
const EIGHT: usize = 8;

/// Sums that are kept apart, so that no addition has to wait for the one before.
const SUMS: usize = 4;

/// Below this rate a span lasts too long for its terms; there is little to compute then, and it is computed plainly.
const SLOW: f64 = 44_000.0;

/// A mode whose amplitude falls below this (-154 dB of full scale) has rung out.
const SILENCE: f64 = 2e-8;

/// How often, in samples, modes that have rung out are looked for.
const CHECK: usize = 512;

/// A bank of decaying sine modes, struck and left to ring.
///
/// Each mode is one complex number that turns and shrinks by a constant factor
/// `r` per sample; its output is the imaginary part. The state advances in
/// double precision once per span of 64 samples. What lies in between is a sum of
/// the same 16 polynomials for every mode: the bank adds up what its modes
/// give to each, and draws the sum once. That is faster than a recurrence per
/// sample, and without its rounding (a single-precision two-pole filter is off
/// by -23 dB for a 60 Hz mode at 96 kHz, this by less than -120 dB).
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
    eights: Vec<Eight>,
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

/// Eight modes side by side.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
struct Eight {
    /// The state one sample before the next one to be rendered.
    state: Complexes,
    /// `r`.
    turn: Complexes,
    /// `r` to the power of [`SPAN`].
    leap: Complexes,
    shapes: [Shape; EIGHT],
    /// The state once more, as precise as the shapes.
    rounded_re: [f32; EIGHT],
    rounded_im: [f32; EIGHT],
}

/// The terms of `r` to the power of 1 to [`SPAN`].
#[derive(Clone, Copy, Debug)]
struct Shape {
    re: [f32; TERMS],
    im: [f32; TERMS],
}

/// One complex number per mode.
#[derive(Clone, Copy, Debug)]
struct Complexes {
    re: [f64; EIGHT],
    im: [f64; EIGHT],
}

impl ModalBank {
    /// A silent bank for up to `modes` different modes (rounded up to a multiple of eight) at `sample_rate` hertz.
    ///
    /// All memory is taken here.
    #[must_use]
    pub fn new(sample_rate: f64, modes: usize) -> Self {
        let eights = modes.div_ceil(EIGHT).max(1);
        // Built now rather than with the first strike.
        Basis::get();
        Self {
            sample_rate,
            keys: vec![Key::default(); eights * EIGHT],
            eights: vec![Eight::SILENT; eights],
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

    /// Frequency of the highest mode that can be struck, in hertz: 1000 at 44.1 kHz, 2180 at 96 kHz.
    #[must_use]
    pub fn highest_hz(&self) -> f64 {
        if self.is_slow() { self.sample_rate / 2.0 } else { self.sample_rate / 44.0 }
    }

    /// Stops every mode at once.
    pub fn clear(&mut self) {
        self.eights[..self.active.div_ceil(EIGHT)].fill(Eight::SILENT);
        self.active = 0;
    }

    /// Strikes a mode, so that the very next sample rendered is the first that moves.
    ///
    /// `frequency_hz` lies between 0 and [`ModalBank::highest_hz`], `decay_s` (the
    /// time to 1/e) is 0.001 or more, `amplitude` any finite number; nothing is struck otherwise.
    /// If the bank is full, the mode with the least energy makes
    /// room: then the answer is true.
    ///
    /// # Real-time
    /// No allocation. A mode that is not ringing yet costs about as much as the
    /// rendering of a span of thirty modes.
    pub fn strike(&mut self, frequency_hz: f32, decay_s: f32, amplitude: f32) -> bool {
        let frequency = f64::from(frequency_hz);
        let playable = frequency > 0.0
            && frequency <= self.highest_hz()
            && (0.001..f32::INFINITY).contains(&decay_s)
            && amplitude.is_finite();
        if !playable {
            return false;
        }
        let key = Key { frequency_hz, decay_s };
        let (slot, stolen) = match self.find(key) {
            Some(slot) => (slot, false),
            None => self.claim(key),
        };
        self.last = slot;
        let eight = &mut self.eights[slot / EIGHT];
        let (re, im) = eight.state.get(slot % EIGHT);
        eight.set_state(slot % EIGHT, (re + f64::from(amplitude), im));
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
        if self.is_slow() {
            self.render_plainly(out);
        } else {
            render_spans(self, out, Basis::get());
        }
        self.grow_older(out.len());
    }

    /// Whether it has to be rendered sample by sample, and can't be one of many side by side.
    pub(super) fn is_slow(&self) -> bool {
        self.sample_rate < SLOW
    }

    fn render_plainly(&mut self, out: &mut [f32]) {
        for slot in 0..self.active {
            let eight = &mut self.eights[slot / EIGHT];
            let (mut state, turn) = (eight.state.get(slot % EIGHT), eight.turn.get(slot % EIGHT));
            for sample in &mut *out {
                state = product(state, turn);
                *sample += state.1 as f32;
            }
            eight.set_state(slot % EIGHT, state);
        }
    }

    /// The terms of the next span; the bank moves on by its first `samples`.
    #[inline(always)]
    fn terms<const FUSED: bool>(&mut self, samples: usize) -> [f32; TERMS] {
        let mut sums = [[0.0; TERMS]; SUMS];
        for eight in &mut self.eights[..self.active.div_ceil(EIGHT)] {
            eight.add_terms::<FUSED>(&mut sums);
            eight.advance(samples);
        }
        let mut terms = [0.0; TERMS];
        for term in 0..TERMS {
            terms[term] = (sums[0][term] + sums[1][term]) + (sums[2][term] + sums[3][term]);
        }
        terms
    }

    /// Counts samples, and looks for modes that have rung out now and then.
    fn grow_older(&mut self, samples: usize) {
        self.unchecked += samples;
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
        tune(&mut self.eights[slot / EIGHT], slot % EIGHT, key, self.sample_rate, Basis::get());
        (slot, stolen)
    }

    fn weakest(&self) -> usize {
        (0..self.active).min_by(|a, b| self.energy(*a).total_cmp(&self.energy(*b))).unwrap_or(0)
    }

    fn energy(&self, slot: usize) -> f64 {
        let (re, im) = self.eights[slot / EIGHT].state.get(slot % EIGHT);
        re * re + im * im
    }

    /// Gives a slot back; the last ringing mode moves into its place.
    fn release(&mut self, slot: usize) {
        self.active -= 1;
        let last = self.active;
        self.keys[slot] = self.keys[last];
        let moved = self.eights[last / EIGHT];
        self.eights[slot / EIGHT].copy(slot % EIGHT, &moved, last % EIGHT);
        self.eights[last / EIGHT].set_state(last % EIGHT, (0.0, 0.0));
    }
}

/// Writes the next `samples` of several banks, at most a span, to the columns of `out`, and silence to the other lanes.
///
/// `rings` says which of up to [`LANES`] banks are asked. Columns beyond `samples` are of no meaning.
///
/// # Panics
/// If more than [`LANES`] banks are given.
pub(super) fn ring_side_by_side(
    banks: &mut [ModalBank],
    rings: &[bool],
    samples: usize,
    out: &mut [[f32; LANES]; SPAN],
) {
    draw_banks(banks, rings, samples, out, Basis::get());
    for (bank, _) in banks.iter_mut().zip(rings).filter(|(_, rings)| **rings) {
        bank.grow_older(samples);
    }
}

impl Eight {
    const SILENT: Self = Self {
        state: Complexes::ZERO,
        turn: Complexes::ZERO,
        leap: Complexes::ZERO,
        shapes: [Shape { re: [0.0; TERMS], im: [0.0; TERMS] }; EIGHT],
        rounded_re: [0.0; EIGHT],
        rounded_im: [0.0; EIGHT],
    };

    /// Makes `lane` the mode that `from` holds in another lane.
    fn copy(&mut self, lane: usize, from: &Self, other: usize) {
        self.shapes[lane] = from.shapes[other];
        self.turn.set(lane, from.turn.get(other));
        self.leap.set(lane, from.leap.get(other));
        self.set_state(lane, from.state.get(other));
    }

    /// Adds the terms of its modes; a lane that holds none adds nothing.
    #[inline(always)]
    fn add_terms<const FUSED: bool>(&self, sums: &mut [[f32; TERMS]; SUMS]) {
        for lane in 0..EIGHT {
            let (of_re, of_im) = (2 * (lane % 2), 2 * (lane % 2) + 1);
            for term in 0..TERMS {
                sums[of_re][term] = multiply_add::<FUSED>(
                    self.rounded_re[lane],
                    self.shapes[lane].im[term],
                    sums[of_re][term],
                );
                sums[of_im][term] = multiply_add::<FUSED>(
                    self.rounded_im[lane],
                    self.shapes[lane].re[term],
                    sums[of_im][term],
                );
            }
        }
    }

    /// Moves on by up to a span.
    #[inline(always)]
    fn advance(&mut self, samples: usize) {
        if samples == SPAN {
            self.state = self.state.times(&self.leap);
        } else {
            let mut power = self.turn;
            for exponent in 0..SPAN.ilog2() {
                if samples & (1 << exponent) != 0 {
                    self.state = self.state.times(&power);
                }
                power = power.times(&power);
            }
        }
        for lane in 0..EIGHT {
            self.rounded_re[lane] = self.state.re[lane] as f32;
            self.rounded_im[lane] = self.state.im[lane] as f32;
        }
    }

    fn set_state(&mut self, lane: usize, state: (f64, f64)) {
        self.state.set(lane, state);
        (self.rounded_re[lane], self.rounded_im[lane]) = (state.0 as f32, state.1 as f32);
    }
}

/// Makes `lane` a silent mode of this frequency and decay.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx2+fma", "x86_64+avx2+fma", "aarch64+neon"))]
fn tune(eight: &mut Eight, lane: usize, key: Key, sample_rate: f64, basis: &Basis) {
    let angle = TAU * f64::from(key.frequency_hz) / sample_rate;
    let shrink = (-1.0 / (f64::from(key.decay_s) * sample_rate)).exp();
    let turn = (shrink * angle.cos(), shrink * angle.sin());

    // r; then r^2; then r^3 and r^4 as r^2 times both, and so on.
    let (mut re, mut im) = ([turn.0; SPAN], [turn.1; SPAN]);
    let mut known = 1;
    while known < SPAN {
        let power = (re[known - 1], im[known - 1]);
        for n in known..2 * known {
            (re[n], im[n]) = product((re[n - known], im[n - known]), power);
        }
        known *= 2;
    }
    // What is next to nothing is nothing, lest faint modes end in denormal numbers.
    let rounded = |x: f64| if x.abs() < 1e-11 { 0.0 } else { x as f32 };
    let [of_re, of_im] = basis.terms_of(&re, &im);
    eight.shapes[lane] = Shape { re: of_re.map(rounded), im: of_im.map(rounded) };
    eight.turn.set(lane, turn);
    eight.leap.set(lane, (re[SPAN - 1], im[SPAN - 1]));
    eight.set_state(lane, (0.0, 0.0));
}

impl Complexes {
    const ZERO: Self = Self { re: [0.0; EIGHT], im: [0.0; EIGHT] };

    fn get(&self, lane: usize) -> (f64, f64) {
        (self.re[lane], self.im[lane])
    }

    fn set(&mut self, lane: usize, (re, im): (f64, f64)) {
        self.re[lane] = re;
        self.im[lane] = im;
    }

    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        let mut result = Self::ZERO;
        for lane in 0..EIGHT {
            result.re[lane] = self.re[lane] * other.re[lane] - self.im[lane] * other.im[lane];
            result.im[lane] = self.re[lane] * other.im[lane] + self.im[lane] * other.re[lane];
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
pub(super) fn multiply_add<const FUSED: bool>(a: f32, b: f32, c: f32) -> f32 {
    if FUSED { a.mul_add(b, c) } else { a * b + c }
}

/// Adds a bank's next samples to `out` with the widest registers this processor has.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx2+fma", "x86_64+avx2+fma", "aarch64+neon"))]
fn render_spans(bank: &mut ModalBank, out: &mut [f32], basis: &Basis) {
    if target_cfg_f!(any(target_feature = "fma", target_arch = "aarch64")) {
        render_spans_with::<true>(bank, out, basis);
    } else {
        render_spans_with::<false>(bank, out, basis);
    }
}

#[inline(always)]
fn render_spans_with<const FUSED: bool>(bank: &mut ModalBank, out: &mut [f32], basis: &Basis) {
    let (spans, rest) = out.as_chunks_mut::<SPAN>();
    for span in spans {
        basis.draw::<FUSED>(&bank.terms::<FUSED>(SPAN), span);
    }
    if !rest.is_empty() {
        let mut span = [0.0; SPAN];
        basis.draw::<FUSED>(&bank.terms::<FUSED>(rest.len()), &mut span);
        for (sample, more) in rest.iter_mut().zip(&span) {
            *sample += more;
        }
    }
}

/// Writes the banks' next samples side by side with the widest registers this processor has.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx2+fma", "x86_64+avx2+fma", "aarch64+neon"))]
fn draw_banks(
    banks: &mut [ModalBank],
    rings: &[bool],
    samples: usize,
    out: &mut [[f32; LANES]; SPAN],
    basis: &Basis,
) {
    if target_cfg_f!(any(target_feature = "fma", target_arch = "aarch64")) {
        draw_banks_with::<true>(banks, rings, samples, out, basis);
    } else {
        draw_banks_with::<false>(banks, rings, samples, out, basis);
    }
}

#[inline(always)]
fn draw_banks_with<const FUSED: bool>(
    banks: &mut [ModalBank],
    rings: &[bool],
    samples: usize,
    out: &mut [[f32; LANES]; SPAN],
    basis: &Basis,
) {
    let mut terms = [[0.0; TERMS]; LANES];
    for ((bank, rings), terms) in banks.iter_mut().zip(rings).zip(&mut terms) {
        if *rings {
            *terms = bank.terms::<FUSED>(samples);
        }
    }
    basis.draw_side_by_side::<FUSED, LANES>(&transposed(&terms.each_ref()), out);
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::*;

    const RATE: f64 = 96_000.0;

    /// What the bank ought to give, in double precision from the definition.
    fn reference(modes: &[(f32, f32, f32)], samples: usize) -> Vec<f64> {
        reference_at(RATE, modes, samples)
    }

    fn reference_at(rate: f64, modes: &[(f32, f32, f32)], samples: usize) -> Vec<f64> {
        (1..=samples)
            .map(|n| {
                let t = n as f64 / rate;
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

    /// A bank of eight modes drawn at random, struck twice, alone and side by side with others, in blocks of 64.
    #[test]
    fn random_modes_are_exact_at_both_rates_alone_and_side_by_side() {
        let mut random = Pcg64Mcg::seed_from_u64(7);
        let mut worst = [f64::NEG_INFINITY; 2];
        for rate in [48_000.0, 96_000.0] {
            for _ in 0..20 {
                let modes: Vec<(f32, f32, f32)> = (0..8)
                    .map(|_| {
                        let decay_s = 0.001 * 2000_f32.powf(random.random_range(0.0..=1.0));
                        (random.random_range(20.0..=1000.0), decay_s, random.random_range(-1.0..=1.0))
                    })
                    .collect();
                let mut banks = vec![ModalBank::new(rate, 8); LANES];
                let mut alone = vec![0.0; 9600];
                let mut together = Vec::new();
                for number in 0..150 {
                    if number == 0 || number == 70 {
                        modes.iter().for_each(|&(f, d, a)| _ = banks[0].strike(f, d, a));
                        modes.iter().for_each(|&(f, d, a)| _ = banks[5].strike(f, d, a));
                    }
                    banks[0].render(&mut alone[number * 64..][..64]);
                    let mut columns = [[0.0; LANES]; SPAN];
                    ring_side_by_side(
                        &mut banks,
                        &[[false; 5].as_slice(), &[true; 11]].concat(),
                        64,
                        &mut columns,
                    );
                    together.extend(columns.map(|column| column[5]));
                    assert!(columns.iter().all(|column| column[4] == 0.0 && column[6] == 0.0));
                }
                let mut wanted = reference_at(rate, &modes, 9600);
                for (n, again) in reference_at(rate, &modes, 9600 - 70 * 64).into_iter().enumerate() {
                    wanted[70 * 64 + n] += again;
                }
                for (worst, got) in worst.iter_mut().zip([&alone, &together]) {
                    *worst = worst.max(error_db(got, &wanted));
                }
            }
        }
        assert!(worst.iter().all(|worst| *worst < -115.0), "{worst:?} dB");
    }

    #[test]
    fn a_slow_device_gets_the_same_modes() {
        let modes = [(20.0, 2.0, 0.5), (231.7, 0.05, -0.4), (999.0, 0.01, 0.3)];
        let mut bank = ModalBank::new(8000.0, 8);
        modes.iter().for_each(|&(f, d, a)| _ = bank.strike(f, d, a));
        let mut got = vec![0.0; 8000];
        got.chunks_mut(100).for_each(|out| bank.render(out));
        assert!(error_db(&got, &reference_at(8000.0, &modes, 8000)) < -115.0);
    }

    #[test]
    fn what_is_no_mode_is_not_struck() {
        let mut bank = ModalBank::new(RATE, 8);
        for (f, d, a) in [
            (f32::NAN, 0.1, 1.0),
            (-100.0, 0.1, 1.0),
            (5000.0, 0.1, 1.0),
            (100.0, 0.0, 1.0),
            (100.0, f32::NAN, 1.0),
            (100.0, f32::INFINITY, 1.0),
            (100.0, 0.1, f32::NAN),
            (100.0, 0.1, f32::INFINITY),
        ] {
            assert!(!bank.strike(f, d, a));
        }
        assert!(bank.is_silent());
    }

    /// After minutes nothing is left in any number of the bank: what it computes then is what silence costs, nothing.
    #[test]
    fn a_bank_that_has_decayed_for_minutes_is_all_exact_zeros() {
        let mut bank = ModalBank::new(RATE, 16);
        for number in 0..16_u8 {
            bank.strike(20.0 + 60.0 * f32::from(number), 2.0, 1.0);
        }
        let mut out = [0.0; 960];
        // Two minutes of a mode that takes 2 s to fall to 1/e.
        for _ in 0..12_000 {
            out.fill(0.0);
            bank.render(&mut out);
            assert!(out.iter().all(|sample| !sample.is_subnormal()));
            for eight in &bank.eights {
                let states = eight.state.re.iter().chain(&eight.state.im);
                assert!(states.copied().all(|state| state == 0.0 || state.is_normal()));
                let tables = eight.shapes.iter().flat_map(|shape| shape.re.iter().chain(&shape.im));
                assert!(tables.copied().all(|number| number == 0.0 || number.is_normal()));
            }
        }
        assert!(bank.is_silent());
        assert_eq!(out, [0.0; 960]);
        let left = bank.eights.iter().flat_map(|eight| eight.state.re.into_iter().chain(eight.state.im));
        assert_eq!(left.filter(|state| *state != 0.0).count(), 0);
    }

    /// The kernel that processors without fused multiplication get, which this machine would not choose.
    #[test]
    fn the_plainest_kernel_is_as_exact() {
        let mut bank = ModalBank::new(RATE, 4);
        bank.strike(60.0, 0.5, 1.0);
        bank.strike(417.0, 0.03, -0.7);
        let mut got = vec![0.0; 9600];
        got.chunks_mut(100).for_each(|out| render_spans_with::<false>(&mut bank, out, Basis::get()));
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
        for number in 1..=8_u8 {
            let amplitude = if number == 2 { 0.1 } else { 0.5 };
            assert!(!bank.strike(100.0 * f32::from(number), 1.0, amplitude));
        }
        assert!(bank.strike(900.0, 1.0, 0.5));
        assert_eq!(bank.ringing(), 8);
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
