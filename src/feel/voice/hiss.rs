//! The model of noise and tones.

// Loops over lanes stay plain indexed loops: those are the ones that become vector instructions.
#![allow(clippy::needless_range_loop)]

use std::f32::consts::{FRAC_PI_4, PI};

use multiversion::multiversion;

use super::chain::Chain;
use super::{LANES, Row, random, seeds, tangent};
use crate::feel::Band;

/// Sharpness of each of the two band-passes: as wide as possible with 95 % of the power inside 50 to 750 Hz.
const Q: f32 = 2.0;

/// Minimum distance of a noise's centre from the ends of its band, as factors, for the same reason.
const KEEP: (f32, f32) = (1.5, 1.55);

/// Noise and tones of eight voices: white noise and a turning phasor, narrowed by two band-passes.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(super) struct Hiss {
    bits: [u32; LANES],
    noise: Row,
    tone: Row,
    phasor: [Row; 2],
    turn: [Row; 2],
}

impl Hiss {
    pub(super) fn new(group: usize) -> Self {
        Self {
            bits: seeds(group),
            noise: [0.0; LANES],
            tone: [0.0; LANES],
            phasor: [[1.0; LANES], [0.0; LANES]],
            turn: [[1.0; LANES], [0.0; LANES]],
        }
    }

    /// Silences one lane; its next tone begins at zero.
    pub(super) fn rest(&mut self, lane: usize) {
        self.noise[lane] = 0.0;
        self.tone[lane] = 0.0;
        self.phasor[0][lane] = 1.0;
        self.phasor[1][lane] = 0.0;
    }

    /// Tunes one lane and its part of `chain`: as strong as a tone of amplitude 1, with `noise` (0 to 1) as the share
    /// of noise.
    pub(super) fn tune(
        &mut self,
        lane: usize,
        chain: &mut Chain,
        hz: f32,
        noise: f32,
        band: Band,
        rate: f32,
    ) {
        let noise = if noise > 0.0 { noise.min(1.0) } else { 0.0 };
        let narrow = Band {
            low_hz: band.low_hz * (1.0 + noise * (KEEP.0 - 1.0)),
            high_hz: band.high_hz / (1.0 + noise * (KEEP.1 - 1.0)),
        };
        let hz = narrow.clamp(hz);
        chain.narrow(lane, hz, Q, rate);
        // White noise in -1..1 has a mean square of 1/3; a pair of band-passes passes pi/4 * centre/Q hertz of it.
        let through = FRAC_PI_4 * hz / Q / (0.5 * rate) / 3.0;
        // A sine's root mean square is its amplitude over the root of two.
        self.noise[lane] = (0.5 * noise / through).sqrt();
        self.tone[lane] = (1.0 - noise).sqrt();
        // Rotation by an angle from the tangent of its half: of length 1 except for rounding.
        let t = tangent(PI * hz / rate);
        let norm = 1.0 / (1.0 + t * t);
        self.turn[0][lane] = (1.0 - t * t) * norm;
        self.turn[1][lane] = 2.0 * t * norm;
        let (c, s) = (self.phasor[0][lane], self.phasor[1][lane]);
        let length = 1.5 - 0.5 * (c * c + s * s);
        self.phasor[0][lane] = c * length;
        self.phasor[1][lane] = s * length;
    }

    #[inline(always)]
    fn next(&mut self) -> Row {
        let mut out = [0.0; LANES];
        for lane in 0..LANES {
            let white = 2.0 * random(&mut self.bits[lane]) - 1.0;
            let (c, s) = (self.phasor[0][lane], self.phasor[1][lane]);
            let (tc, ts) = (self.turn[0][lane], self.turn[1][lane]);
            self.phasor[0][lane] = c * tc - s * ts;
            self.phasor[1][lane] = s * tc + c * ts;
            out[lane] = white * self.noise[lane] + self.phasor[1][lane] * self.tone[lane];
        }
        out
    }
}

/// Fills `out` with the next samples, with the widest registers of this processor.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx2+fma", "x86_64+avx2+fma", "aarch64+neon"))]
pub(super) fn render(hiss: &mut Hiss, chain: &mut Chain, out: &mut [Row]) {
    for row in out {
        let force = hiss.next();
        *row = chain.step_narrow(force);
    }
}
