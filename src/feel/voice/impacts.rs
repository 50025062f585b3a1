//! The model of ridges and grains.

// Loops over lanes stay plain indexed loops: those are the ones that become vector instructions.
#![allow(clippy::needless_range_loop)]

use multiversion::multiversion;

use super::chain::Chain;
use super::{LANES, Row, random, seeds, within};

/// Maximum number of impacts per sample: beyond it no single impact can be felt.
const FASTEST: f32 = 0.5;

/// Ridges and grains of eight voices: pushes of a certain length, at even or at random distances.
///
/// A push is an impulse through two equal low-passes of first order, `y += soft * (x - y)`: it has an area of 1, and
/// overlapping pushes add up.
///
/// # Source
/// Grains as random impulses into resonances are the idea of P. R. Cook, "Physically informed sonic modeling
/// (PhISM)", Computer Music Journal 21(3), 1997; his decaying energy has no counterpart here, since a sliding foot
/// drives it all the time.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(super) struct Impacts {
    bits: [u32; LANES],
    /// Distance since the last impact and up to the next one, in mean distances, and distance per sample.
    way: Row,
    next: Row,
    speed: Row,
    /// Gain of the two low-passes.
    soft: Row,
    strike: [Row; 2],
    smooth: [[Row; 2]; 2],
    nature: [Nature; LANES],
}

/// The distribution of the impacts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Nature {
    /// At even distances, varied by this share.
    Ridges(f32),
    /// At random, with this spread of sizes.
    Grains(f32),
}

impl Impacts {
    pub(super) fn new(group: usize) -> Self {
        Self {
            bits: seeds(group),
            way: [0.0; LANES],
            next: [1.0; LANES],
            speed: [0.0; LANES],
            soft: [1.0; LANES],
            strike: [[0.0; LANES]; 2],
            smooth: [[[0.0; LANES]; 2]; 2],
            nature: [Nature::Ridges(0.0); LANES],
        }
    }

    /// Silences one lane; a foot that begins to slide soon meets the first impact.
    pub(super) fn rest(&mut self, lane: usize) {
        self.way[lane] = 0.0;
        self.next[lane] = 0.5;
        self.speed[lane] = 0.0;
        for side in 0..2 {
            self.strike[side][lane] = 0.0;
            self.smooth[side][0][lane] = 0.0;
            self.smooth[side][1][lane] = 0.0;
        }
    }

    /// Sets one lane: impacts per sample, and the length of each in samples.
    pub(super) fn tune(&mut self, lane: usize, nature: Nature, per_sample: f32, width: f32) {
        self.nature[lane] = nature;
        self.speed[lane] = if per_sample > 0.0 { per_sample.min(FASTEST) } else { 0.0 };
        // Both low-passes together push for about four of their time constants.
        self.soft[lane] = 4.0 / within(width, 4.0, 1e4);
    }

    #[inline(always)]
    fn next(&mut self) -> [Row; 2] {
        let mut due = false;
        for lane in 0..LANES {
            self.way[lane] += self.speed[lane];
            due |= self.way[lane] >= self.next[lane];
        }
        if due {
            self.hit();
        }
        for side in 0..2 {
            for lane in 0..LANES {
                let soft = self.soft[lane];
                let first = &mut self.smooth[side][0][lane];
                *first += soft * (self.strike[side][lane] - *first);
                let first = *first;
                let second = &mut self.smooth[side][1][lane];
                *second += soft * (first - *second);
            }
        }
        if due {
            self.strike = [[0.0; LANES]; 2];
        }
        [self.smooth[0][1], self.smooth[1][1]]
    }

    /// Strikes the lanes that are due; rare.
    #[cold]
    fn hit(&mut self) {
        for lane in 0..LANES {
            if self.way[lane] < self.next[lane] {
                continue;
            }
            self.way[lane] = (self.way[lane] - self.next[lane]).min(1.0);
            let bits = &mut self.bits[lane];
            let (a, b, c) = (random(bits), random(bits), random(bits));
            let (next, strikes) = match self.nature[lane] {
                Nature::Ridges(uneven) => (1.0 + 0.8 * uneven * (2.0 * a - 1.0), [1.0 - 0.7 * uneven * b; 2]),
                Nature::Grains(spread) => {
                    // Between equal sizes and few large ones: the fourth power of a random number has a mean of a
                    // fifth.
                    let size = 1.0 - spread + spread * 5.0 * b * b * b * b;
                    // Each grain strikes one resonance more and the other less.
                    (-(1.0 - a).ln(), [size * 2.0 * c, size * 2.0 * (1.0 - c)])
                }
            };
            self.next[lane] = next.max(0.05);
            for (row, strike) in self.strike.iter_mut().zip(strikes) {
                row[lane] = strike;
            }
        }
    }

    /// Sets tiny states to zero before they become denormal numbers.
    pub(super) fn settle(&mut self) {
        for value in self.smooth.iter_mut().flatten().flatten() {
            if *value < 1e-15 {
                *value = 0.0;
            }
        }
    }
}

/// Fills `out` with the next samples, with the widest registers of this processor.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx2+fma", "x86_64+avx2+fma", "aarch64+neon"))]
pub(super) fn render(impacts: &mut Impacts, chain: &mut Chain, out: &mut [Row]) {
    for row in out {
        let forces = impacts.next();
        *row = chain.step(forces, forces[0]);
    }
}
