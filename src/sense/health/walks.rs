//! Walks over plates from rigid to limp: no fault is reported for sound sensors, and broken ones are found within two
//! steps.

use glam::Vec2;
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_pcg::Pcg64Mcg;

use super::{Health, LOUD_N, Trouble};
use crate::floor::{Corner, Floor};
use crate::sense::ForceFrame;
use crate::units::Instant;

/// Flexibility of plates under twist: a steel tile; 20 mm and 12 mm of plywood on soft feet; 12 mm on stiff ones;
/// limp.
const TWISTS: [f32; 5] = [0.0, 0.2, 0.45, 0.7, 0.95];

/// Weight of the plate on each corner (N): the reading drops by that much when the corner lifts.
const RESTS_N: f32 = 11.0;

#[derive(Clone, Copy, Debug)]
enum Fault {
    Dead,
    Stuck,
    Drifts,
    Noisy,
}

struct Step {
    at: Vec2,
    heading: f32,
    peak_n: f32,
    /// Milliseconds.
    start: u32,
    stance: u32,
}

impl Step {
    /// Ten points along the sole at the time `now`.
    fn points(&self, now: u32) -> impl Iterator<Item = (f32, Vec2)> + '_ {
        let phase = now.wrapping_sub(self.start) as f32 / self.stance as f32;
        let is_down = (0.0..1.0).contains(&phase);
        let rise = (phase.min(1.0 - phase) / 0.15).clamp(0.0, 1.0);
        let whole = if is_down {
            self.peak_n * rise * (0.8 + 0.2 * (4.0 * std::f32::consts::PI * phase).cos())
        } else {
            0.0
        };
        let weight = move |share: f32| (-0.5 * ((share - phase) / 0.35).powi(2)).exp();
        let sum: f32 = (0..10_u8).map(|point| weight(f32::from(point) / 9.0)).sum();
        (0..10_u8).map(move |point| {
            let share = f32::from(point) / 9.0;
            (whole * weight(share) / sum, self.at + Vec2::from_angle(self.heading) * 0.24 * (share - 0.5))
        })
    }
}

struct Walk {
    health: Health,
    frame: ForceFrame,
    rng: Pcg64Mcg,
    noise: Vec<f32>,
    gains: Vec<[f32; 4]>,
    twist: f32,
    now: u32,
    steps: Vec<Step>,
    /// The broken sensor, its fault, its start, and the reading then.
    fault: Option<(usize, usize, Fault, u32, f32)>,
    floor: Floor,
}

impl Walk {
    fn new(twist: f32, seed: u64) -> Self {
        let floor = Floor::default();
        let mut rng = Pcg64Mcg::seed_from_u64(seed);
        let noise = (0..997).map(|_| 0.3 * rng.sample::<f32, _>(StandardNormal)).collect();
        let gain = |rng: &mut Pcg64Mcg| 1.0 + 0.05 * rng.sample::<f32, _>(StandardNormal);
        let gains =
            (0..floor.geometry.tile_count()).map(|_| std::array::from_fn(|_| gain(&mut rng))).collect();
        let health = Health::new(&floor);
        let frame = ForceFrame::empty(&floor.geometry);
        Self { health, frame, rng, noise, gains, twist, now: 0, steps: Vec::new(), fault: None, floor }
    }

    fn millisecond(&mut self) {
        self.now += 1;
        let geometry = self.floor.geometry;
        self.frame.quality.fill([crate::sense::Quality::Live; 4]);
        let mut forces = vec![[0.0_f32; 4]; geometry.tile_count()];
        for (force, at) in self.steps.iter().flat_map(|step| step.points(self.now)) {
            let Some(tile) = geometry.tile_under(at) else { continue };
            let reach = geometry.sensor_places(tile).rectangle().unwrap();
            let arm = (at - geometry.centre(tile)) / reach;
            let Some(tile) = geometry.index(tile).and_then(|index| forces.get_mut(index)) else { continue };
            for (sensor, corner) in tile.iter_mut().zip(Corner::ALL) {
                let side = corner.direction();
                let bent = self.twist * side.x * side.y * arm.x * arm.y;
                *sensor += 0.25 * force * (1.0 + side.dot(arm) + bent);
            }
        }
        for (tile, forces) in forces.iter_mut().enumerate() {
            let least = (0..4).min_by(|&a, &b| forces[a].total_cmp(&forces[b])).unwrap();
            let lifts = (-RESTS_N - forces[least]).max(0.0);
            for (corner, &force) in forces.iter().enumerate() {
                // Force and moments stay the same; the load shifts to the diagonal.
                let sign = if corner == least || corner == least ^ 3 { 1.0 } else { -1.0 };
                let noise = self.noise[(self.now as usize * 31 + tile * 4 + corner) % self.noise.len()];
                let mut reads = (force + sign * lifts) * self.gains[tile][corner] + noise;
                if let Some((at, which, fault, since, held)) = self.fault
                    && (at, which) == (tile, corner)
                {
                    reads = match fault {
                        Fault::Dead => 0.0,
                        Fault::Stuck => held,
                        Fault::Drifts => reads + 0.02 * (self.now - since) as f32,
                        Fault::Noisy => reads + 20.0 * noise,
                    };
                }
                self.frame.forces[tile][corner] = reads - self.health.zero(tile, corner);
                self.health.jumps.news()[4 * tile + corner] = true;
                if self.frame.forces[tile][corner].abs() > LOUD_N {
                    self.health.note_loud(4 * tile + corner);
                }
            }
        }
        self.health.inspect(&mut self.frame, Instant::from_millis(self.now.into()));
    }

    /// A step with its middle at `at`, until its weight has shifted to the next one.
    fn step(&mut self, at: Vec2) {
        let stance = self.rng.random_range(550..750);
        let step = Step {
            at,
            heading: self.rng.random_range(0.0..std::f32::consts::TAU),
            peak_n: self.rng.random_range(350.0..950.0),
            start: self.now,
            stance,
        };
        self.steps.retain(|step| step.start + step.stance > self.now);
        self.steps.push(step);
        (0..stance * 4 / 5).for_each(|_| self.millisecond());
    }

    /// People walk about; returns the first sensor reported as faulty.
    fn walk(&mut self, minutes: u32) -> Option<(u32, String)> {
        let size = self.floor.geometry.bounds().size();
        let until = self.now + minutes * 60_000;
        while self.now < until {
            for _ in 0..20 {
                let at = Vec2::new(self.rng.random_range(0.0..1.0), self.rng.random_range(0.0..1.0)) * size;
                self.step(at);
                if let Some(found) = self.health.troubles().next() {
                    return Some((self.now, format!("{found:?}")));
                }
            }
            (0..2500).for_each(|_| self.millisecond());
        }
        None
    }

    /// Number of steps on its tile until a broken sensor is found; three if it is not found after two.
    fn steps_until_found(&mut self, tile: usize, corner: usize, fault: Fault) -> usize {
        let centre = self.floor.geometry.centre(self.floor.geometry.tile_at_index(tile));
        // It breaks in the middle of a step that does not count, if that matters.
        let near = |walk: &mut Self| {
            centre + Vec2::new(walk.rng.random_range(-0.07..0.07), walk.rng.random_range(-0.07..0.07))
        };
        let at = near(self);
        self.step(at);
        let held = self.frame.forces[tile][corner];
        self.fault = Some((tile, corner, fault, self.now, held));
        (0..1000).for_each(|_| self.millisecond());
        for step in 1..=2 {
            let at = near(self);
            self.step(at);
            (0..1200).for_each(|_| self.millisecond());
            let troubles: Vec<_> = self.health.troubles().collect();
            let is_it = |(sensor, _): &(crate::floor::SensorId, Trouble)| {
                self.floor.geometry.index(sensor.tile) == Some(tile) && sensor.corner.index() == corner
            };
            assert!(troubles.iter().all(is_it), "{fault:?} at {tile}.{corner}: {troubles:?}");
            if !troubles.is_empty() {
                return step;
            }
        }
        3
    }
}

fn assert_none_accused(minutes: u32) {
    for (seed, twist) in (1..).zip(TWISTS) {
        let mut walk = Walk::new(twist, seed);
        let accused = walk.walk(minutes);
        println!("twist {twist}: {accused:?}, learnt {:?}", walk.health.twist.range());
        assert_eq!(accused, None, "twist {twist}");
    }
}

#[test]
fn on_plates_of_any_stiffness_no_sound_sensor_is_accused() {
    assert_none_accused(1);
}

#[test]
#[ignore = "an hour of walking on five floors takes minutes"]
fn on_plates_of_any_stiffness_no_sound_sensor_is_accused_in_an_hour() {
    assert_none_accused(60);
}

#[test]
fn broken_sensors_are_found_within_two_steps_on_plates_of_any_stiffness() {
    let mut late = Vec::new();
    let mut steps = 0;
    for (seed, twist) in (11..).zip(TWISTS) {
        for fault in [Fault::Dead, Fault::Stuck, Fault::Drifts, Fault::Noisy] {
            for learns in [false, true] {
                // After a minute of walking one corner is enough: the minute takes most of the test's time.
                for corner in 0..if learns { 1 } else { 4 } {
                    let mut walk = Walk::new(twist, seed + 100 * corner as u64);
                    if learns {
                        assert_eq!(walk.walk(1), None);
                    }
                    let found = walk.steps_until_found(14, corner, fault);
                    steps += found;
                    if found > 2 {
                        late.push((twist, fault, learns, corner));
                    }
                }
            }
        }
    }
    println!("{steps} steps for 100 sensors; late: {late:?}");
    assert!(late.len() <= 3, "{} of 100: {late:?}", late.len());
}
