//! The mass on a damped spring below each tile.

use underfoot_format::{num, record};

record! {
    /// The elastic sheet under one tile.
    pub struct Body = "Body", Copy;
    /// Moving mass, in kilograms; positive.
    pub mass_kg: f32 = "mass_kg", num(0.01..=10_000.0);
    /// Viscous damping, in newton seconds per metre; not negative.
    pub damping_n_s_m: f32 = "damping_n_s_m", num(0.0..=10_000_000.0);
    /// Stiffness, in newtons per metre; positive.
    pub stiffness_n_m: f32 = "stiffness_n_m", num(100.0..=1_000_000_000.0);
}

/// The virtual displacement of the sheet under one tile.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Displacement, in metres; positive is down.
    pub x_m: f64,
    /// Velocity, in metres per second.
    pub v_m_s: f64,
    /// The last force, in newtons.
    pub force_n: f64,
}

/// Advances sheets by one step of fixed length, exactly.
///
/// Between two instants the force is taken to change linearly, the best assumption for a sampled force. For such a
/// force the differential equation has a closed solution, so the step does not drift, does not ring on the samples'
/// stairs, and is stable for every mass, damping and stiffness.
///
/// # Source
/// `f = m x'' + b x' + K x` (paper, section 4.1.1). With `f = f0 + r t` one solution is
/// `x = (f0 + r t - b r / K) / K`; the rest decays by the matrix exponential.
#[derive(Clone, Copy, Debug)]
pub struct Elastic {
    mass: f64,
    damping: f64,
    stiffness: f64,
    step_s: f64,
    /// Row by row: the effect of one step on displacement and speed.
    decay: [[f64; 2]; 2],
}

impl Elastic {
    /// Steps of `step_s` seconds for sheets like `body`.
    #[must_use]
    pub fn new(body: Body, step_s: f64) -> Self {
        let (mass, damping, stiffness) =
            (f64::from(body.mass_kg), f64::from(body.damping_n_s_m), f64::from(body.stiffness_n_m));
        let rate = damping / (2.0 * mass);
        let square = rate * rate - stiffness / mass;
        // Of exp(A t) = e^(-rate t) (C I + S (A + rate I)): C and S include the decay, so that nothing overflows.
        let (c, s) = if square.abs() < 1e-9 * (stiffness / mass) {
            let left = (-rate * step_s).exp();
            (left, left * step_s)
        } else if square < 0.0 {
            let (turn, left) = ((-square).sqrt(), (-rate * step_s).exp());
            (left * (turn * step_s).cos(), left * (turn * step_s).sin() / turn)
        } else {
            let split = square.sqrt();
            // rate - split without cancellation.
            let slow = (-(stiffness / mass) / (rate + split) * step_s).exp();
            let fast = (-(rate + split) * step_s).exp();
            (0.5 * (slow + fast), 0.5 * (slow - fast) / split)
        };
        let decay = [[c + s * rate, s], [-s * stiffness / mass, c - s * rate]];
        Self { mass, damping, stiffness, step_s, decay }
    }

    /// Length of one step, in seconds.
    #[must_use]
    pub const fn step_s(&self) -> f64 {
        self.step_s
    }

    /// A sheet at rest under `force_n`.
    #[must_use]
    pub fn settled(&self, force_n: f64) -> Motion {
        Motion { x_m: force_n / self.stiffness, v_m_s: 0.0, force_n }
    }

    /// Advances `motion` by one step; `force_n` acts at its end.
    pub fn step(&self, motion: &mut Motion, force_n: f64) {
        let slope = (force_n - motion.force_n) / self.step_s;
        let (lag, speed) = (self.damping * slope / self.stiffness, slope / self.stiffness);
        let x = motion.x_m - (motion.force_n - lag) / self.stiffness;
        let v = motion.v_m_s - speed;
        motion.x_m = self.decay[0][0] * x + self.decay[0][1] * v + (force_n - lag) / self.stiffness;
        motion.v_m_s = self.decay[1][0] * x + self.decay[1][1] * v + speed;
        motion.force_n = force_n;
    }

    /// The one-sided kinetic energy, in joules: zero while the sheet moves up.
    ///
    /// # Source
    /// `kappa+ = 0.5 m x'^2` where `x' > 0` (paper, section 4.1.1).
    #[must_use]
    pub fn kinetic_j(&self, motion: &Motion) -> f64 {
        0.5 * self.mass * motion.v_m_s.max(0.0).powi(2)
    }

    /// The power dissipated by the damping, in watts, in both directions of motion.
    #[must_use]
    pub fn lost_w(&self, motion: &Motion) -> f64 {
        self.damping * motion.v_m_s * motion.v_m_s
    }

    /// Whether the sheet is at rest without a load, within the noise of the sensors.
    #[must_use]
    pub fn is_still(&self, motion: &Motion) -> bool {
        let kinetic = 0.5 * self.mass * motion.v_m_s * motion.v_m_s;
        motion.force_n.abs() < 5.0 && motion.x_m.abs() * self.stiffness < 10.0 && kinetic < 1e-6
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BODY: Body = Body { mass_kg: 60.0, damping_n_s_m: 5000.0, stiffness_n_m: 200_000.0 };

    /// The same with 1000 small Runge-Kutta steps per millisecond.
    fn reference(body: Body, force: impl Fn(f64) -> f64, seconds: f64) -> (f64, f64) {
        let (m, b, k) =
            (f64::from(body.mass_kg), f64::from(body.damping_n_s_m), f64::from(body.stiffness_n_m));
        let (mut x, mut v, h) = (0.0, 0.0, 1e-5);
        let slope = |t: f64, x: f64, v: f64| (v, (force(t) - b * v - k * x) / m);
        for n in 0..(seconds / h).round() as usize {
            let t = n as f64 * h;
            let (x1, v1) = slope(t, x, v);
            let (x2, v2) = slope(t + 0.5 * h, x + 0.5 * h * x1, v + 0.5 * h * v1);
            let (x3, v3) = slope(t + 0.5 * h, x + 0.5 * h * x2, v + 0.5 * h * v2);
            let (x4, v4) = slope(t + h, x + h * x3, v + h * v3);
            x += h / 6.0 * (x1 + 2.0 * x2 + 2.0 * x3 + x4);
            v += h / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
        }
        (x, v)
    }

    #[test]
    fn a_step_is_the_differential_equation_s_own() {
        // Under-, critically and overdamped; a foot that lands within 50 ms and stands.
        let critical = 2.0 * (200_000.0_f32 * 60.0).sqrt();
        for damping in [300.0, 5000.0, critical, 40_000.0] {
            let body = Body { damping_n_s_m: damping, ..BODY };
            let elastic = Elastic::new(body, 1e-3);
            // Linear between whole milliseconds, as the floor's samples are.
            let force = |t: f64| 700.0 * (t / 0.05).min(1.0);
            for millis in [20, 50, 70, 200] {
                let mut motion = Motion::default();
                for n in 1..=millis {
                    elastic.step(&mut motion, force(f64::from(n) * 1e-3));
                }
                let (x, v) = reference(body, force, f64::from(millis) * 1e-3);
                assert!((motion.x_m - x).abs() < 1e-7, "{damping}: {} and {x}", motion.x_m);
                assert!((motion.v_m_s - v).abs() < 1e-6, "{damping}: {} and {v}", motion.v_m_s);
            }
        }
    }

    #[test]
    fn no_sheet_explodes_however_stiff_light_or_damped() {
        for mass_kg in [0.01, 60.0, 1e4] {
            for damping_n_s_m in [0.0, 1.0, 1e7] {
                for stiffness_n_m in [100.0, 1e5, 1e9] {
                    let elastic = Elastic::new(Body { mass_kg, damping_n_s_m, stiffness_n_m }, 1e-3);
                    let mut motion = Motion::default();
                    for n in 0..20_000 {
                        elastic.step(&mut motion, if n % 7 < 3 { 2000.0 } else { 0.0 });
                    }
                    // A force that alternates can drive a resonance to at most a few times the static displacement
                    // per period without damping; growth without bound would be far beyond this.
                    assert!(motion.x_m.abs() < 2000.0 / f64::from(stiffness_n_m) * 1e5, "{motion:?}");
                    assert!(motion.v_m_s.is_finite());
                }
            }
        }
    }

    #[test]
    fn what_has_settled_stays_and_what_rises_has_no_energy() {
        let elastic = Elastic::new(BODY, 1e-3);
        let mut motion = elastic.settled(350.0);
        for _ in 0..1000 {
            elastic.step(&mut motion, 350.0);
        }
        assert!(motion.v_m_s.abs() < 1e-12 && elastic.kinetic_j(&motion) < 1e-20);
        for n in 0..100 {
            elastic.step(&mut motion, 350.0 - f64::from(n) * 3.5);
            assert_eq!(elastic.kinetic_j(&motion), 0.0, "unloading cracks nothing");
        }
        for _ in 0..3000 {
            elastic.step(&mut motion, 0.0);
        }
        assert!(elastic.is_still(&motion), "{motion:?}");
    }
}
