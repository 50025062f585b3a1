//! The model of stick-slip friction (elasto-plastic bristles).

// Loops over lanes stay plain indexed loops: those are the ones that become vector instructions.
#![allow(clippy::needless_range_loop)]

use std::f32::consts::TAU;

use multiversion::multiversion;

use super::chain::Chain;
use super::{LANES, Row, random, seeds, within};
use crate::feel::StickSlip;

/// Stretch of the sole's spring in units of the bristles' bend at the breakaway (our choice).
const BEND: f32 = 16.0;

/// Up to this share of the breakaway, bristles only bend, without creep (our choice, as in the paper's figures).
const ELASTIC: f32 = 0.7;

/// Damping of the sole on its spring, as a share of the critical one (our choice: a foot is soft).
const DAMPING: f32 = 0.08;

/// Damping of the bristles, in the same units (our choice: so that a sole that sticks does not ring on).
const BRISTLE_DAMPING: f32 = 0.3;

/// Maximum of forces, stretches and bends, in static frictions: this model does not exceed it; larger values are cut
/// off.
const BOUND: f32 = 4.0;

/// Soles of eight voices that stick to the plate and slip.
///
/// All values are without dimension: forces in static frictions, stretches in those of a static friction, so that
/// every foot's numbers are near 1.
///
/// ```text
/// stretch' = drive - slip
/// slip'    = w^2 (stretch - force) + 2 d w (drive - slip)          the sole on its spring
/// bend'    = BEND * slip * (1 - creep(bend, slip) * bend / G(slip))      the bristles
/// force    = bend + damping * bend'
/// G(slip)  = glide + (1 - glide) / (1 + (slip / let_go)^2)              the Stribeck curve
/// ```
///
/// The bend is stepped implicitly, so that it cannot overshoot at any slip; the sole takes the resulting force; all
/// values are bounded. So it is stable for every input.
///
/// # Source
/// See [`StickSlip`]. Ours differs in three points: the creep rises by a cubic instead of a sine, the Stribeck curve
/// is the rational one of D. P. Hess and A. Soom (1990) instead of an exponential (neither needs a transcendental
/// function per sample), and the friction varies at random with the roughness.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(super) struct Stick {
    bits: [u32; LANES],
    stretch: Row,
    slip: Row,
    bend: Row,
    force: Row,
    waver: Row,
    /// Per second, times the time of a sample.
    drive: Row,
    let_go: Row,
    glide: Row,
    rough: Row,
    /// Of the sole: the square of its angle per sample, and twice its damping.
    spring: Row,
    damping: Row,
    bristle: Row,
}

impl Stick {
    pub(super) fn new(group: usize) -> Self {
        Self {
            bits: seeds(group),
            stretch: [0.0; LANES],
            slip: [0.0; LANES],
            bend: [0.0; LANES],
            force: [0.0; LANES],
            waver: [0.0; LANES],
            drive: [0.0; LANES],
            let_go: [1.0; LANES],
            glide: [1.0; LANES],
            rough: [0.0; LANES],
            spring: [0.0; LANES],
            damping: [0.0; LANES],
            bristle: [0.0; LANES],
        }
    }

    /// Sets a sole at rest.
    pub(super) fn rest(&mut self, lane: usize) {
        for row in [&mut self.stretch, &mut self.slip, &mut self.bend, &mut self.force, &mut self.waver] {
            row[lane] = 0.0;
        }
        self.drive[lane] = 0.0;
    }

    /// Sets one lane: the foot moves at `speed` metres per second and presses with a `share` of the full force.
    pub(super) fn tune(&mut self, lane: usize, stick: &StickSlip, speed: f32, share: f32, rate: f32) {
        // A foot that presses harder drags the sole farther before it breaks away.
        let stretch_m = (within(stick.stretch_m, 1e-4, 0.1) * within(share, 0.05, 1.0)).max(1e-4);
        let per_sample = (stretch_m * rate).recip();
        self.drive[lane] = if speed > 0.0 { (speed * per_sample).min(1.0) } else { 0.0 };
        self.let_go[lane] = (within(stick.let_go_m_s, 1e-3, 10.0) * per_sample).recip();
        self.glide[lane] = within(stick.glide / stick.grip, 0.05, 1.0);
        self.rough[lane] = within(stick.rough, 0.0, 1.0);
        let angle = TAU * within(stick.sole_hz, 20.0, 500.0) / rate;
        self.spring[lane] = angle * angle;
        self.damping[lane] = 2.0 * DAMPING * angle;
        self.bristle[lane] = 2.0 * BRISTLE_DAMPING / (angle * BEND.sqrt());
    }

    /// The next friction force of each lane, and its change.
    #[inline(always)]
    fn next(&mut self) -> (Row, Row) {
        let (mut force, mut change) = ([0.0; LANES], [0.0; LANES]);
        for lane in 0..LANES {
            let chance = 2.0 * random(&mut self.bits[lane]) - 1.0;
            self.waver[lane] += 0.25 * (chance - self.waver[lane]);
            let (slip, bend) = (self.slip[lane], self.bend[lane]);
            let fast = slip * self.let_go[lane];
            let glide = self.glide[lane];
            // Only a slipping sole feels the surface change beneath it.
            let moves = fast.abs().min(1.0);
            let rough = 1.0 + 1.5 * self.rough[lane] * self.waver[lane] * moves;
            let curve = (glide + (1.0 - glide) / (1.0 + fast * fast)) * rough.max(0.2);
            let share = ((bend.abs() / curve - ELASTIC) * (1.0 / (1.0 - ELASTIC))).clamp(0.0, 1.0);
            let creep = if bend * slip >= 0.0 { share * share * (3.0 - 2.0 * share) } else { 0.0 };
            let bent = (bend + BEND * slip) / (1.0 + BEND * slip.abs() * creep / curve);
            let pull = (bent + self.bristle[lane] * (bent - bend)).clamp(-BOUND, BOUND);
            let drive = self.drive[lane];
            let slip =
                slip + self.spring[lane] * (self.stretch[lane] - pull) + self.damping[lane] * (drive - slip);
            let slip = slip.clamp(-1.0, 1.0);
            self.slip[lane] = slip;
            self.bend[lane] = bent.clamp(-BOUND, BOUND);
            self.stretch[lane] = (self.stretch[lane] + drive - slip).clamp(-BOUND, BOUND);
            change[lane] = pull - self.force[lane];
            force[lane] = pull;
            self.force[lane] = pull;
        }
        (force, change)
    }

    /// Sets tiny states to zero before they become denormal numbers.
    pub(super) fn settle(&mut self) {
        for row in [&mut self.slip, &mut self.bend, &mut self.waver] {
            for value in row {
                if value.abs() < 1e-15 {
                    *value = 0.0;
                }
            }
        }
    }
}

/// Fills `out` with the next samples, with the widest registers of this processor.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx2+fma", "x86_64+avx2+fma", "aarch64+neon"))]
pub(super) fn render(stick: &mut Stick, chain: &mut Chain, out: &mut [Row]) {
    for row in out {
        let (force, change) = stick.next();
        *row = chain.step([change; 2], force);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::feel::{Material, Resonance};
    use crate::units::Newtons;

    const RATE: f32 = 12_000.0;

    fn sole() -> StickSlip {
        StickSlip {
            material: Material {
                level: Newtons(5.0),
                resonances: [Resonance::NONE; 2],
                bare: 1.0,
                full_speed_m_s: 0.6,
                full_force: Newtons(200.0),
                trim: 1.0,
            },
            grip: 1.0,
            glide: 0.5,
            let_go_m_s: 0.05,
            stretch_m: 0.002,
            sole_hz: 180.0,
            rough: 0.0,
        }
    }

    /// The friction force over one second at this speed and share of the full force.
    fn forces(stick: &StickSlip, speed: f32, share: f32) -> Vec<f32> {
        let mut lanes = Stick::new(0);
        lanes.tune(2, stick, speed, share, RATE);
        (0..RATE as usize).map(|_| lanes.next().0[2]).collect()
    }

    /// Number of breakaways per second: falls of the force through the middle between its extremes.
    fn slips(forces: &[f32]) -> usize {
        let steady = &forces[forces.len() / 2..];
        let (low, high) =
            steady.iter().fold((f32::MAX, f32::MIN), |(low, high), x| (low.min(*x), high.max(*x)));
        if high - low < 0.05 {
            return 0;
        }
        let middle = 0.5 * (low + high);
        2 * steady.windows(2).filter(|pair| pair[0] >= middle && pair[1] < middle).count()
    }

    #[test]
    fn a_slow_sole_sticks_and_slips_faster_with_speed_and_slower_with_force() {
        let stick = sole();
        let rates: Vec<usize> =
            [0.02, 0.05, 0.1, 0.2].iter().map(|speed| slips(&forces(&stick, *speed, 1.0))).collect();
        assert!(rates.windows(2).all(|pair| pair[1] > pair[0]) && rates[0] > 2, "{rates:?}");
        let (light, hard) = (slips(&forces(&stick, 0.05, 0.4)), slips(&forces(&stick, 0.05, 1.0)));
        assert!(light > hard, "{light} and {hard} slips a second");
    }

    #[test]
    fn a_sole_at_rest_stays_and_one_that_is_drawn_reaches_its_static_friction() {
        assert!(forces(&sole(), 0.0, 1.0).iter().all(|force| *force == 0.0));
        let most = forces(&sole(), 0.02, 1.0).into_iter().fold(0.0, f32::max);
        assert!((0.85..1.3).contains(&most), "{most}");
    }

    #[test]
    fn it_stays_finite_and_bounded_for_whatever_it_is_driven_with() {
        let absurd = [0.0, -1.0, 1e-30, 1e9, f32::MAX, f32::INFINITY, f32::NAN];
        for value in absurd {
            for field in 0..6 {
                let mut stick = sole();
                stick.rough = 1.0;
                let (mut speed, mut share) = (0.3, 0.7);
                *match field {
                    0 => &mut speed,
                    1 => &mut share,
                    2 => &mut stick.grip,
                    3 => &mut stick.let_go_m_s,
                    4 => &mut stick.stretch_m,
                    _ => &mut stick.sole_hz,
                } = value;
                for force in forces(&stick, speed, share) {
                    assert!(force.abs() <= BOUND, "{field}: {value}: {force}");
                }
            }
        }
    }
}
