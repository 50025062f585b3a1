//! A bank of decaying modes.

// Loops over lanes stay plain indexed loops: those are the ones that become vector instructions.
#![allow(clippy::needless_range_loop)]

mod basis;
mod eight;
#[cfg(test)]
mod tests;

use std::f64::consts::TAU;

use multiversion::multiversion;
use multiversion::target::target_cfg_f;

use super::mix::{LANES, LaneSet, transpose};
use basis::{Basis, FEW, TERMS};
use eight::{EIGHT, Eight, PowerTerms, SUMS, product, tune};

pub(super) use basis::SPAN;

/// Below this rate a span lasts too long for its terms; there is little to compute then, and it is computed sample by
/// sample.
const SLOW: f64 = 44_000.0;

/// A mode with an amplitude below this (-154 dB of full scale) has rung out.
const SILENCE: f64 = 2e-8;

/// Interval between the searches for modes that have rung out, in samples.
const CHECK: usize = 512;

/// A bank of decaying sine modes, struck and left to ring.
///
/// Each mode is one complex number that turns and shrinks by a constant factor `r` per sample; its output is the
/// imaginary part. The state advances in double precision once per span of 64 samples. The samples in between are a
/// sum of the same 16 polynomials for every mode: the bank adds up the contributions of its modes to each, and draws
/// the sum once. Smooth modes, those below 460 Hz at 96 kHz, need the first 8 only. That is faster than a recurrence
/// per sample, and without its rounding (a single-precision two-pole filter is off by -23 dB for a 60 Hz mode at 96
/// kHz, this by less than -120 dB).
///
/// Modes of equal frequency and decay share one state, since the sum of two
/// such modes is again one. A silent bank costs nothing.
///
/// # Source
/// `s(t) = sum a_i exp(-b_i t) sin(2 pi f_i t)` (paper, section 4.1.1).
#[derive(Clone, Debug)]
pub struct ModalBank {
    sample_rate: f64,
    /// The mode in each slot; the first `active` slots ring.
    keys: Vec<Key>,
    eights: Vec<Eight>,
    active: usize,
    /// Whether all modes of each eight are smooth, and whether all modes of the bank are.
    smooth: Vec<bool>,
    all_smooth: bool,
    /// Samples since the last search for modes that have rung out.
    unchecked: usize,
    /// Slot of the last strike: clicks strike their modes in the same order every time.
    last: usize,
}

/// A mode's frequency and decay time, which define its shape.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Key {
    frequency_hz: f32,
    decay_s: f32,
}

impl Key {
    /// The turn of the mode per sample, in radians, and its decay per sample, as a share.
    fn per_sample(&self, sample_rate: f64) -> (f64, f64) {
        let angle = TAU * f64::from(self.frequency_hz) / sample_rate;
        (angle, (f64::from(self.decay_s) * sample_rate).recip())
    }
}

impl ModalBank {
    /// A silent bank for up to `modes` different modes (rounded up to a multiple of eight) at `sample_rate` hertz.
    ///
    /// Allocates all memory.
    #[must_use]
    pub fn new(sample_rate: f64, modes: usize) -> Self {
        let eights = modes.div_ceil(EIGHT).max(1);
        // Built here rather than at the first strike.
        Basis::get();
        Self {
            sample_rate,
            keys: vec![Key::default(); eights * EIGHT],
            eights: vec![Eight::SILENT; eights],
            active: 0,
            smooth: vec![true; eights],
            all_smooth: true,
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
    pub fn active_modes(&self) -> usize {
        self.active
    }

    /// Whether no mode rings: the next samples are all zero.
    #[must_use]
    pub fn is_silent(&self) -> bool {
        self.active == 0
    }

    /// Frequency of the highest mode that can be struck, in hertz: 1000 at 44.1 kHz, 2180 at 96 kHz.
    fn highest_hz(&self) -> f64 {
        if self.is_slow() { self.sample_rate / 2.0 } else { self.sample_rate / 44.0 }
    }

    /// Stops every mode at once.
    pub fn clear(&mut self) {
        self.eights[..self.active.div_ceil(EIGHT)].fill(Eight::SILENT);
        self.active = 0;
        self.smooth.fill(true);
        self.all_smooth = true;
    }

    /// Strikes a mode; the very next sample rendered is the first to move.
    ///
    /// `frequency_hz` lies between 0 and the highest frequency of the bank (1000 Hz at 44.1 kHz, 2180 Hz at 96 kHz),
    /// `decay_s` (the time to 1/e) is 0.001 or more, `amplitude` any finite number; other values have no effect. If
    /// the bank is full, the new mode steals the slot of the mode with the least energy, and the function returns
    /// true.
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
    /// No allocation; no work if the bank is silent.
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

    /// Whether it needs rendering sample by sample, rather than side by side with others.
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

    /// The first or the other terms of the next span, each in two parts to be added.
    #[inline(always)]
    fn terms<const FUSED: bool>(&self, part: usize) -> PowerTerms {
        let mut sums = [[0.0; 2 * FEW]; SUMS];
        for (eight, smooth) in self.eights[..self.active.div_ceil(EIGHT)].iter().zip(&self.smooth) {
            if part == 0 || !smooth {
                eight.add_terms::<FUSED>(part, &mut sums);
            }
        }
        let mut terms = [0.0; 2 * FEW];
        for n in 0..2 * FEW {
            terms[n] = (sums[0][n] + sums[1][n]) + (sums[2][n] + sums[3][n]);
        }
        terms
    }

    /// Advances by up to a span.
    #[inline(always)]
    fn advance(&mut self, samples: usize) {
        for eight in &mut self.eights[..self.active.div_ceil(EIGHT)] {
            eight.advance(samples);
        }
    }

    /// Counts samples, and at intervals searches for modes that have rung out.
    #[inline(always)]
    fn grow_older(&mut self, samples: usize) {
        self.unchecked += samples;
        if self.unchecked >= CHECK {
            self.unchecked = 0;
            self.release_silent();
        }
    }

    #[inline(never)]
    fn release_silent(&mut self) {
        for slot in (0..self.active).rev() {
            if self.energy(slot) < SILENCE * SILENCE {
                self.release(slot);
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

    /// A slot for a new mode, and whether it was stolen from another.
    fn claim(&mut self, key: Key) -> (usize, bool) {
        let stolen = self.active == self.keys.len();
        let slot = if stolen { self.weakest() } else { self.active };
        if !stolen {
            self.active += 1;
        }
        self.keys[slot] = key;
        self.note_smooth(slot / EIGHT);
        tune(&mut self.eights[slot / EIGHT], slot % EIGHT, key, self.sample_rate, Basis::get());
        (slot, stolen)
    }

    /// Updates whether the modes of an eight are smooth, after a change of its modes.
    fn note_smooth(&mut self, eight: usize) {
        let (first, last) = (eight * EIGHT, self.active.min((eight + 1) * EIGHT));
        self.smooth[eight] = self.keys[first..last.max(first)].iter().all(|key| {
            let (angle, fade) = key.per_sample(self.sample_rate);
            Basis::is_smooth(angle, fade)
        });
        self.all_smooth = self.smooth.iter().all(|smooth| *smooth);
    }

    fn weakest(&self) -> usize {
        (0..self.active).min_by(|a, b| self.energy(*a).total_cmp(&self.energy(*b))).unwrap_or(0)
    }

    fn energy(&self, slot: usize) -> f64 {
        let (re, im) = self.eights[slot / EIGHT].state.get(slot % EIGHT);
        re * re + im * im
    }

    /// Frees a slot; the last ringing mode moves into its place.
    fn release(&mut self, slot: usize) {
        self.active -= 1;
        let last = self.active;
        self.keys[slot] = self.keys[last];
        let moved = self.eights[last / EIGHT];
        self.eights[slot / EIGHT].copy(slot % EIGHT, &moved, last % EIGHT);
        self.eights[last / EIGHT].set_state(last % EIGHT, (0.0, 0.0));
        self.note_smooth(slot / EIGHT);
        self.note_smooth(last / EIGHT);
    }
}

/// Writes the next `samples` of several banks, at most a span, to the columns of `out`, and silence to the other
/// lanes.
///
/// `ringing` selects up to [`LANES`] banks; returns those that ring on. Columns beyond `samples` are undefined.
pub(super) fn ring_side_by_side(
    banks: &mut [ModalBank],
    ringing: LaneSet,
    samples: usize,
    out: &mut [[f32; LANES]; SPAN],
) -> LaneSet {
    draw_banks(banks, ringing, samples, out, Basis::get());
    let mut silent = 0;
    for (lane, bank) in banks.iter_mut().enumerate() {
        if has(ringing, lane) {
            bank.grow_older(samples);
        }
        silent |= LaneSet::from(bank.is_silent()) << lane;
    }
    ringing & !silent
}

fn has(set: LaneSet, lane: usize) -> bool {
    set >> lane & 1 == 1
}

/// `a * b + c`, in one instruction where the processor has it: elsewhere `mul_add` is a slow library call.
#[inline(always)]
pub(super) fn multiply_add<const FUSED: bool>(a: f32, b: f32, c: f32) -> f32 {
    if FUSED { a.mul_add(b, c) } else { a * b + c }
}

/// Adds a bank's next samples to `out`, with the widest registers of this processor.
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
        render_span::<FUSED>(bank, SPAN, span, basis);
    }
    if !rest.is_empty() {
        let mut span = [0.0; SPAN];
        render_span::<FUSED>(bank, rest.len(), &mut span, basis);
        for (sample, more) in rest.iter_mut().zip(&span) {
            *sample += more;
        }
    }
}

#[inline(always)]
fn render_span<const FUSED: bool>(
    bank: &mut ModalBank,
    samples: usize,
    span: &mut [f32; SPAN],
    basis: &Basis,
) {
    let mut terms = [0.0; TERMS];
    let parts = if bank.all_smooth { 1 } else { 2 };
    for (part, terms) in terms.as_chunks_mut::<FEW>().0[..parts].iter_mut().enumerate() {
        let parts = bank.terms::<FUSED>(part);
        for (term, [re, im]) in terms.iter_mut().zip(parts.as_chunks::<2>().0) {
            *term = re + im;
        }
    }
    basis.draw::<FUSED>(&terms[..parts * FEW], span);
    bank.advance(samples);
}

/// Writes the banks' next samples side by side, with the widest registers of this processor.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx2+fma", "x86_64+avx2+fma", "aarch64+neon"))]
fn draw_banks(
    banks: &mut [ModalBank],
    ringing: LaneSet,
    samples: usize,
    out: &mut [[f32; LANES]; SPAN],
    basis: &Basis,
) {
    if target_cfg_f!(any(target_feature = "fma", target_arch = "aarch64")) {
        draw_banks_with::<true>(banks, ringing, samples, out, basis);
    } else {
        draw_banks_with::<false>(banks, ringing, samples, out, basis);
    }
}

#[inline(always)]
fn draw_banks_with<const FUSED: bool>(
    banks: &mut [ModalBank],
    ringing: LaneSet,
    samples: usize,
    out: &mut [[f32; LANES]; SPAN],
    basis: &Basis,
) {
    let mut terms = [[0.0; LANES]; TERMS];
    let (few, others) = terms.split_at_mut(FEW);
    let smooth = add_side_by_side::<FUSED>(banks, ringing, 0, few);
    if !smooth {
        add_side_by_side::<FUSED>(banks, ringing, 1, others);
    }
    for (lane, bank) in banks.iter_mut().enumerate() {
        if has(ringing, lane) {
            bank.advance(samples);
        }
    }
    match terms.first_chunk::<FEW>() {
        Some(few) if smooth => basis.draw_side_by_side::<FUSED, LANES, FEW>(few, out),
        _ => basis.draw_side_by_side::<FUSED, LANES, TERMS>(&terms, out),
    }
}

/// Adds the first or the other terms of the banks, one bank per lane; returns whether all are smooth.
#[inline(always)]
fn add_side_by_side<const FUSED: bool>(
    banks: &[ModalBank],
    ringing: LaneSet,
    part: usize,
    terms: &mut [[f32; LANES]],
) -> bool {
    let (mut rows, mut smooth) = ([[0.0; 2 * FEW]; LANES], true);
    for (lane, (bank, row)) in banks.iter().zip(&mut rows).enumerate() {
        if has(ringing, lane) {
            *row = bank.terms::<FUSED>(part);
            smooth &= bank.all_smooth;
        }
    }
    let mut columns = [[0.0; LANES]; 2 * FEW];
    transpose(&rows.each_ref(), &mut columns);
    for (term, [re, im]) in terms.iter_mut().zip(columns.as_chunks::<2>().0) {
        for lane in 0..LANES {
            term[lane] += re[lane] + im[lane];
        }
    }
    smooth
}
