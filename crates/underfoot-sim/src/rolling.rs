//! Roll of one foot over one step, drawn from the distribution of recorded steps.

use glam::Vec2;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

use super::rolling_fit::{
    ACROSS_MEAN, ACROSS_MODES, ACROSS_OF_PERSON, BREADTH, CONTACT_S, CONTACT_SPREAD, DWELL_MEAN, DWELL_MODES,
    DWELL_REST, DWELL_STEPS, FORCE_MEAN, FORCE_MODES, MIDDLE_SPEED_M_S, PLACES, RADIUS_ACROSS_MEAN,
    RADIUS_ACROSS_MODES, RADIUS_ACROSS_OF_PERSON, RADIUS_ALONG_MEAN, RADIUS_ALONG_MODES,
    RADIUS_ALONG_OF_PERSON, SPEEDS_M_S, TIMING_OF_PERSON, TURN_OUT, WAY,
};

/// Rolling pattern of one person's feet, common to all steps.
///
/// All values are drawn from figures fitted to recorded steps (see the tables' source in `rolling_fit`); the same
/// seed gives the same steps.
#[derive(Clone, Debug)]
pub struct RollingHabit {
    rng: Pcg64Mcg,
    timing: [f32; 6],
    across: [f32; 2],
    along_radius: [f32; 2],
    across_radius: [f32; 1],
    contact: f32,
    turn_out: f32,
    breadth: f32,
}

impl RollingHabit {
    /// A person drawn from a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let mut rng = Pcg64Mcg::seed_from_u64(seed ^ 0x5011_ed57);
        Self {
            timing: of_person(&mut rng, TIMING_OF_PERSON),
            across: of_person(&mut rng, ACROSS_OF_PERSON),
            along_radius: of_person(&mut rng, RADIUS_ALONG_OF_PERSON),
            across_radius: of_person(&mut rng, RADIUS_ACROSS_OF_PERSON),
            contact: CONTACT_SPREAD[0] * normal(&mut rng),
            turn_out: TURN_OUT[0] + TURN_OUT[1] * normal(&mut rng),
            breadth: BREADTH[0] + BREADTH[1] * normal(&mut rng),
            rng,
        }
    }

    /// Returns the mean contact time of a step at this speed, in seconds.
    ///
    /// Speeds outside the recorded range (0.75 to 2.15 m/s) are clamped to it; NaN counts as 1.4.
    #[must_use]
    pub fn contact_s(&self, speed_m_s: f32) -> f32 {
        CONTACT_S[0] * known(speed_m_s).powf(CONTACT_S[1]) * self.contact.exp()
    }

    /// Returns the mean outward angle of the feet, in radians.
    #[must_use]
    pub const fn turn_out(&self) -> f32 {
        self.turn_out
    }

    /// Draws the next step, at a speed in metres per second (limits as in [`RollingHabit::contact_s`]), for a foot of
    /// `length_m` with its outer side to its right (1) or left (-1).
    #[must_use]
    pub fn step(&mut self, speed_m_s: f32, length_m: f32, outward: f32) -> Rolling {
        let speed = known(speed_m_s);
        let contact_s = self.contact_s(speed) * (CONTACT_SPREAD[1] * normal(&mut self.rng)).exp();
        let faster = speed - MIDDLE_SPEED_M_S;
        let rng = &mut self.rng;
        let timing = of_step(rng, self.timing, TIMING_OF_PERSON);
        let mut dwell = spread(&DWELL_MEAN, faster, &DWELL_MODES, timing);
        for (dwell, rest) in dwell.iter_mut().zip(DWELL_REST) {
            *dwell = (*dwell + rest * normal(rng)).exp();
        }
        let whole: f32 = dwell.iter().sum();
        let mut crossed = [0.0; DWELL_STEPS + 1];
        for (step, dwell) in dwell.iter().enumerate() {
            crossed[step + 1] = crossed[step] + dwell / whole;
        }
        let inner = spread(&FORCE_MEAN, faster, &FORCE_MODES, timing);
        let mut force = [0.0; FORCE_NODES];
        force[1..FORCE_NODES - 1].copy_from_slice(&inner.map(|share| share.max(0.02)));

        let across = of_step(rng, self.across, ACROSS_OF_PERSON);
        let along_radius = of_step(rng, self.along_radius, RADIUS_ALONG_OF_PERSON);
        let across_radius = of_step(rng, self.across_radius, RADIUS_ACROSS_OF_PERSON);
        let width_m = self.breadth * length_m;
        let radii = |node: usize, along: &[f32; PLACES], across: &[f32; PLACES]| {
            Vec2::new(across[node].max(0.03) * width_m, along[node].max(0.01) * length_m)
        };
        let along_radius = spread(&RADIUS_ALONG_MEAN, faster, &RADIUS_ALONG_MODES, along_radius);
        let across_radius = spread(&RADIUS_ACROSS_MEAN, faster, &RADIUS_ACROSS_MODES, across_radius);
        let mut rolling = Rolling {
            contact_s,
            crossed,
            force,
            way_m: WAY.map(|[mean, deviation]| (mean + deviation * normal(rng)) * length_m),
            across_m: spread(&ACROSS_MEAN, faster, &ACROSS_MODES, across)
                .map(|share| share * width_m * outward),
            radii_m: std::array::from_fn(|node| radii(node, &along_radius, &across_radius)),
        };
        let peak = (0..=200).map(|step| rolling.force(step as f32 / 200.0)).fold(0.0, f32::max);
        rolling.force = rolling.force.map(|share| share / peak);
        rolling
    }
}

/// One foot over one step: its force, and the centre and spread of its pressure.
///
/// Phases are shares of the contact, from touchdown (0) to lift-off (1); others are clamped, and NaN counts as 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Rolling {
    contact_s: f32,
    /// Phases at which the centre of pressure completes each part of its path.
    crossed: [f32; DWELL_STEPS + 1],
    /// Force as a share of the peak, at equal steps of the phase.
    force: [f32; FORCE_NODES],
    /// Position along the foot from its centre, at touchdown and at lift-off.
    way_m: [f32; 2],
    /// Position to the right of the middle line, along the path.
    across_m: [f32; PLACES],
    /// Radii of the pressure across and along, along the path.
    radii_m: [Vec2; PLACES],
}

impl Rolling {
    /// Returns the duration of the contact, in seconds.
    #[must_use]
    pub const fn contact_s(&self) -> f32 {
        self.contact_s
    }

    /// Returns the vertical force as a share of its peak; zero at touchdown and lift-off.
    #[must_use]
    pub fn force(&self, phase: f32) -> f32 {
        smooth(&self.force, phase).max(0.0)
    }

    /// Returns the mean force over the contact, as a share of its peak.
    #[must_use]
    pub fn mean_force(&self) -> f32 {
        (0..200).map(|step| self.force((step as f32 + 0.5) / 200.0)).sum::<f32>() / 200.0
    }

    /// Returns the centre of pressure (x to the foot's right, y towards its toes) from the centre of the foot, and
    /// the root mean square radii of the pressure in the same directions, in metres.
    #[must_use]
    pub fn pressure(&self, phase: f32) -> (Vec2, Vec2) {
        let run = self.run(phase);
        let along = self.way_m[0] + (self.way_m[1] - self.way_m[0]) * run;
        (Vec2::new(between(&self.across_m, run), along), between(&self.radii_m, run))
    }

    /// Completed share of the path of the centre of pressure.
    fn run(&self, phase: f32) -> f32 {
        let phase = if phase.is_nan() { 0.0 } else { phase.clamp(0.0, 1.0) };
        let step = self.crossed.partition_point(|&crossed| crossed <= phase).clamp(1, DWELL_STEPS) - 1;
        let (from, to) = (self.crossed[step], self.crossed[step + 1]);
        let part = if to > from { ((phase - from) / (to - from)).clamp(0.0, 1.0) } else { 1.0 };
        (step as f32 + part) / DWELL_STEPS as f32
    }
}

/// Forces at 0, 1/20 ... 1 of the contact.
const FORCE_NODES: usize = 21;

/// Draws from the standard normal distribution, clamped to 1.7 deviations: five people and 294 steps give no
/// information about rarer values, and extreme dwell times would make feet faster than any recorded.
fn normal(rng: &mut Pcg64Mcg) -> f32 {
    let draw: f32 = StandardNormal.sample(rng);
    draw.clamp(-1.7, 1.7)
}

/// Draws the part of each mode that all steps of one person share.
fn of_person<const N: usize>(rng: &mut Pcg64Mcg, part: [f32; N]) -> [f32; N] {
    part.map(|part| part.sqrt() * normal(rng))
}

/// Draws the modes of one step, given the person's shared part.
fn of_step<const N: usize>(rng: &mut Pcg64Mcg, person: [f32; N], part: [f32; N]) -> [f32; N] {
    std::array::from_fn(|mode| person[mode] + (1.0 - part[mode]).max(0.0).sqrt() * normal(rng))
}

/// Mean at a speed, plus the modes.
fn spread<const N: usize, const M: usize>(
    mean: &[[f32; N]],
    faster: f32,
    modes: &[[f32; N]; M],
    scores: [f32; M],
) -> [f32; N] {
    std::array::from_fn(|place| {
        let at_speed = mean.iter().rev().fold(0.0, |sum, power| sum * faster + power[place]);
        at_speed + modes.iter().zip(scores).map(|(mode, score)| mode[place] * score).sum::<f32>()
    })
}

/// The speed, clamped to the recorded range.
fn known(speed_m_s: f32) -> f32 {
    if speed_m_s.is_nan() { MIDDLE_SPEED_M_S } else { speed_m_s.clamp(SPEEDS_M_S[0], SPEEDS_M_S[1]) }
}

/// Index of the node before `share` of the whole range, and the fraction towards the next node.
fn around(nodes: usize, share: f32) -> (usize, f32) {
    let at = if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) } * (nodes - 1) as f32;
    let before = (at as usize).min(nodes.saturating_sub(2));
    (before, at - before as f32)
}

/// Linear interpolation between equally spaced nodes.
fn between<T, const N: usize>(nodes: &[T; N], share: f32) -> T
where
    T: Copy + std::ops::Sub<Output = T> + std::ops::Mul<f32, Output = T> + std::ops::Add<Output = T>,
{
    let (before, part) = around(N, share);
    nodes[before] + (nodes[before + 1] - nodes[before]) * part
}

/// Smooth interpolation through equally spaced nodes (Catmull and Rom's cubic).
fn smooth<const N: usize>(nodes: &[f32; N], share: f32) -> f32 {
    let (before, part) = around(N, share);
    let (from, to) = (nodes[before], nodes[before + 1]);
    let slope = |node: usize| 0.5 * (nodes[(node + 1).min(N - 1)] - nodes[node.saturating_sub(1)]);
    let left = 1.0 - part;
    from + (to - from) * part * part * (3.0 - 2.0 * part)
        + part * left * (slope(before) * left - slope(before + 1) * part)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps of 300 people, each with a speed near `speed`, four steps each.
    fn steps(speed: f32) -> Vec<Rolling> {
        (0..300)
            .flat_map(|seed| {
                let mut habit = RollingHabit::new(seed);
                let own = speed + 0.12 * ((seed % 7) as f32 / 3.0 - 1.0);
                (0..4).map(move |_| habit.step(own, 0.275, 1.0)).collect::<Vec<_>>()
            })
            .collect()
    }

    fn quantile(mut values: Vec<f32>, share: f32) -> f32 {
        values.sort_by(f32::total_cmp);
        values[((values.len() - 1) as f32 * share).round() as usize]
    }

    /// Fastest 20 ms of the centre of pressure in metres per second, as measured for the recorded steps: not within
    /// 60 ms of touchdown or 80 ms of lift-off, and with more than 40 % of the peak force.
    fn fastest(step: &Rolling) -> Option<f32> {
        let millis = (1000.0 * step.contact_s()) as i32;
        let phase = |ms: i32| ms as f32 / millis as f32;
        let loaded = |ms: i32| step.force(phase(ms)) > 0.4;
        (60..millis - 100)
            .filter(|&ms| loaded(ms) && loaded(ms + 20))
            .map(|ms| (step.pressure(phase(ms + 20)).0.y - step.pressure(phase(ms)).0.y) / 0.02)
            .max_by(f32::total_cmp)
    }

    /// Compares a simulated figure with the recorded one.
    #[track_caller]
    fn near(found: f32, recorded: f32, slack: f32) {
        assert!((found / recorded - 1.0).abs() < slack, "{found} simulated, {recorded} recorded");
    }

    #[test]
    fn the_centre_of_pressure_is_as_fast_as_in_recorded_steps() {
        // Median and quartiles of 104, 96 and 94 recorded steps. Fast walkers fall into two groups, which modes about
        // a single mean merge: their quartiles agree less well.
        for (speed, recorded, slack) in [
            (1.00, [0.80, 0.94, 1.06], 0.15),
            (1.42, [0.95, 1.10, 1.30], 0.15),
            (1.99, [0.65, 0.85, 1.33], 0.45),
        ] {
            let speeds: Vec<f32> = steps(speed).iter().filter_map(fastest).collect();
            println!(
                "{speed}: {:?}",
                [0.05, 0.25, 0.5, 0.75, 0.95].map(|share| quantile(speeds.clone(), share))
            );
            for (share, recorded) in [0.25, 0.5, 0.75].into_iter().zip(recorded) {
                near(quantile(speeds.clone(), share), recorded, slack);
            }
            assert!(quantile(speeds, 0.99) < 4.5, "3.2 m/s is the fastest of 294 recorded steps");
        }
    }

    #[test]
    fn contact_and_travel_are_those_of_recorded_steps() {
        for (speed, contact_s) in
            [(1.00, [0.666, 0.758, 0.850]), (1.42, [0.573, 0.630, 0.678]), (1.99, [0.470, 0.514, 0.555])]
        {
            let steps = steps(speed);
            for (share, recorded) in [0.05, 0.5, 0.95].into_iter().zip(contact_s) {
                near(quantile(steps.iter().map(Rolling::contact_s).collect(), share), recorded, 0.08);
            }
            let travel = |step: &Rolling| (step.pressure(1.0).0.y - step.pressure(0.0).0.y) / 0.275;
            near(quantile(steps.iter().map(travel).collect(), 0.5), 0.907, 0.02);
            assert!(steps.iter().all(|step| (0.85..0.96).contains(&travel(step))));
        }
    }

    #[test]
    fn the_force_has_two_peaks_and_the_valley_of_recorded_steps() {
        // Medians of first peak, valley, second peak and mean, each over the step's highest.
        for (speed, recorded) in [
            (1.00, [0.907, 0.725, 0.994, 0.697]),
            (1.42, [0.965, 0.522, 0.992, 0.673]),
            (1.99, [0.982, 0.216, 0.787, 0.558]),
        ] {
            let steps = steps(speed);
            let extreme = |from: i32, to: i32, pick: fn(f32, f32) -> f32| {
                let forces = |step: &Rolling| {
                    (from..=to).map(|node| step.force(node as f32 / 20.0)).reduce(pick).unwrap()
                };
                quantile(steps.iter().map(forces).collect(), 0.5)
            };
            let mean = quantile(steps.iter().map(Rolling::mean_force).collect(), 0.5);
            let found = [extreme(2, 7, f32::max), extreme(7, 13, f32::min), extreme(11, 18, f32::max), mean];
            for (found, recorded) in found.into_iter().zip(recorded) {
                assert!(
                    (found - recorded).abs() < 0.08,
                    "{speed} m/s: {found} simulated, {recorded} recorded"
                );
            }
        }
    }

    #[test]
    fn the_pressure_is_spread_as_under_recorded_feet() {
        // Force-weighted means over the contact, in foot lengths and breadths: quantiles of all 294 steps.
        let steps: Vec<Rolling> = [1.00, 1.42, 1.99].into_iter().flat_map(steps).collect();
        let mean = |step: &Rolling, axis: fn(Vec2) -> f32| {
            let phases = || (0..100).map(|step| (step as f32 + 0.5) / 100.0);
            let sum: f32 = phases().map(|phase| step.force(phase) * axis(step.pressure(phase).1)).sum();
            sum / phases().map(|phase| step.force(phase)).sum::<f32>()
        };
        for (share, along, across) in [(0.05, 0.121, 0.169), (0.5, 0.142, 0.187), (0.95, 0.167, 0.202)] {
            near(
                quantile(steps.iter().map(|step| mean(step, |r| r.y) / 0.275).collect(), share),
                along,
                0.12,
            );
            let breadth = 0.275 * BREADTH[0];
            near(
                quantile(steps.iter().map(|step| mean(step, |r| r.x) / breadth).collect(), share),
                across,
                0.12,
            );
        }
    }

    #[test]
    fn steps_follow_from_the_seed_and_left_feet_mirror_right_ones() {
        let step = |outward| RollingHabit::new(9).step(1.3, 0.27, outward);
        assert_eq!(step(1.0), step(1.0));
        let ((right, _), (left, _)) = (step(1.0).pressure(0.9), step(-1.0).pressure(0.9));
        assert_eq!((right.x, right.y), (-left.x, left.y));
        assert_ne!(RollingHabit::new(10).step(1.3, 0.27, 1.0), step(1.0));
    }

    #[test]
    fn nonsense_is_some_step() {
        for speed in [f32::NAN, -1.0, 50.0] {
            let step = RollingHabit::new(1).step(speed, 0.27, 1.0);
            for phase in [f32::NAN, -3.0, 0.0, 0.5, 1.0, 7.0] {
                let (at, radii) = step.pressure(phase);
                assert!(at.is_finite() && radii.min_element() > 0.0 && step.force(phase) >= 0.0, "{phase}");
            }
            assert!((0.3..1.2).contains(&step.contact_s()));
        }
    }
}
