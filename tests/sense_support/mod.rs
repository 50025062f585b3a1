//! People on a floor, generated from a seed, and the accuracy with which contacts follow them.
//!
//! The soles here consist of heel, arch, ball and toes that are loaded and unloaded in sequence; they share no model
//! with the tracker.
#![allow(dead_code, unreachable_pub, reason = "each test and bench uses its own part")]
#![allow(clippy::expect_used, reason = "a scene that cannot be made fails its test")]

use std::collections::HashMap;
use std::f32::consts::{PI, TAU};

use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;
use underfoot::floor::{Corner, Geometry, TileId};
use underfoot::glam::Vec2;
use underfoot::sense::{Contact, ForceFrame, Method, Sensing, SensingConfig, SensorUncertainty};
use underfoot::units::Instant;

/// The true place of one foot at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Truth {
    /// The number of the step in the scene.
    pub foot: usize,
    pub force: f32,
    pub centre: Vec2,
}

/// Frames at 1 kHz and the truth from which they were made.
pub struct Scene {
    pub name: String,
    pub geometry: Geometry,
    pub frames: Vec<ForceFrame>,
    pub truth: Vec<Vec<Truth>>,
}

/// Errors of the sensors.
#[derive(Clone, Copy, Debug)]
pub struct Sensors {
    /// Standard deviation of the gain left after calibration.
    pub gain: f32,
    /// Standard deviation of the zero, in newtons.
    pub offset_n: f32,
}

impl Sensors {
    pub const PERFECT: Self = Self { gain: 0.0, offset_n: 0.0 };
    /// The errors after a calibration: 5 % and half a newton.
    pub const CALIBRATED: Self = Self { gain: 0.05, offset_n: 0.5 };
}

/// One foot put down for a while.
struct Step<'a> {
    from_s: f32,
    to_s: f32,
    place: Vec2,
    heading: f32,
    length: f32,
    /// Whether it rolls from heel to toe; otherwise it stands flat.
    rolls: bool,
    /// Force and shift at a time.
    load: Box<dyn Fn(f32) -> (f32, Vec2) + 'a>,
}

/// Smooth step from 0 to 1: `u^2 (3 - 2 u)` with `u = (x - from) / (to - from)`, clamped.
fn ease(x: f32, from: f32, to: f32) -> f32 {
    let u = ((x - from) / (to - from)).clamp(0.0, 1.0);
    u * u * (3.0 - 2.0 * u)
}

/// Vertical force over a stance as a share of body weight: two humps and a valley.
fn humps(phase: f32) -> f32 {
    let edges = ease(phase, 0.0, 0.17) * (1.0 - ease(phase, 0.83, 1.0));
    let valley = (0.5 * PI * ((phase - 0.5) / 0.34).clamp(-1.0, 1.0)).cos().powi(2);
    edges * (1.08 - 0.33 * valley)
}

/// Points of a sole at one phase of its stance: along and across the foot, and their share of the force.
fn sole(length: f32, phase: Option<f32>, points: &mut Vec<(Vec2, f32)>) {
    let [heel, arch, ball, toes] = match phase {
        None => [0.5, 0.1, 0.35, 0.05],
        Some(p) => [
            1.0 - ease(p, 0.15, 0.6),
            0.25 * ease(p, 0.06, 0.25) * (1.0 - ease(p, 0.5, 0.75)),
            ease(p, 0.08, 0.55) * (1.0 - 0.6 * ease(p, 0.85, 1.0)),
            0.05 + 0.6 * ease(p, 0.55, 0.95),
        ],
    };
    points.clear();
    // Middle along (share of the length) and across, extent along and across (m), points per side.
    let parts = [
        (heel, 0.12, 0.0, 0.05, 0.05, 4),
        (arch, 0.42, -0.012, 0.07, 0.04, 3),
        (ball, 0.70, 0.0, 0.05, 0.085, 5),
        (toes, 0.90, 0.008, 0.04, 0.06, 3),
    ];
    let whole: f32 = parts.iter().map(|part| part.0).sum();
    for (weight, along, across, long, wide, side) in parts {
        if weight < 1e-3 {
            continue;
        }
        let grid = |i: i32| (i as f32 + 0.5) / side as f32 - 0.5;
        for i in 0..side {
            for j in 0..side {
                let place = Vec2::new((along - 0.5) * length + long * grid(i), across + wide * grid(j));
                points.push((place, weight / whole / (side * side) as f32));
            }
        }
    }
}

/// A point load on a rigid plate over four corner supports; force and moments are exact.
fn press(frame: &mut ForceFrame, geometry: &Geometry, at: Vec2, force: f32) {
    let Some(tile) = geometry.tile_under(at) else { return };
    let Some(index) = geometry.index(tile) else { return };
    let Some(half) = geometry.sensor_places(tile).rectangle() else { return };
    let arm = (at - geometry.centre(tile)) / half;
    for corner in Corner::ALL {
        let way = corner.direction();
        frame.forces[index][corner.index()] += 0.25 * force * (1.0 + way.x * arm.x) * (1.0 + way.y * arm.y);
    }
}

fn play(
    name: String,
    geometry: Geometry,
    length_s: f32,
    steps: &[Step],
    sensors: Sensors,
    seed: u64,
) -> Scene {
    let mut rng = Pcg64Mcg::seed_from_u64(seed ^ 0x5ee);
    let mut normal = || -> f32 { StandardNormal.sample(&mut rng) };
    let errors: Vec<[(f32, f32); 4]> = (0..geometry.tile_count())
        .map(|_| std::array::from_fn(|_| (1.0 + sensors.gain * normal(), sensors.offset_n * normal())))
        .collect();
    let mut scene = Scene { name, geometry, frames: Vec::new(), truth: Vec::new() };
    let mut points = Vec::new();
    for ms in 0..(length_s * 1000.0) as u64 {
        let t = ms as f32 * 1e-3;
        let mut frame = ForceFrame::empty(&geometry);
        frame.at = Instant::from_millis(ms);
        frame.received = frame.at;
        let mut truth = Vec::new();
        for (foot, step) in steps.iter().enumerate().filter(|(_, step)| (step.from_s..step.to_s).contains(&t))
        {
            let (force, shift) = (step.load)(t);
            if force <= 0.5 {
                continue;
            }
            sole(
                step.length,
                step.rolls.then_some((t - step.from_s) / (step.to_s - step.from_s)),
                &mut points,
            );
            let turn = Vec2::from_angle(step.heading);
            let mut centre = Vec2::ZERO;
            for &(place, share) in &points {
                let at = step.place + shift + turn.rotate(place);
                press(&mut frame, &geometry, at, force * share);
                centre += at * share;
            }
            truth.push(Truth { foot, force, centre });
        }
        for (forces, errors) in frame.forces.iter_mut().zip(&errors) {
            for (force, (gain, offset)) in forces.iter_mut().zip(errors) {
                *force = *force * gain + offset;
            }
        }
        scene.frames.push(frame);
        scene.truth.push(truth);
    }
    scene
}

/// A person of 45 to 120 kg walks eight steps at 0.8 to 1.8 m/s; one in three turns while walking.
pub fn walk(seed: u64, sensors: Sensors) -> Scene {
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    let speed = rng.random_range(0.8..1.8_f32);
    let weight = rng.random_range(45.0..120.0_f32) * 9.81;
    let length = rng.random_range(0.22..0.30_f32);
    let stride = 0.30 + 0.28 * speed + rng.random_range(-0.04..0.04_f32);
    let step_s = stride / speed;
    let stance = 2.0 * step_s * rng.random_range(0.58..0.64_f32);
    let apart = rng.random_range(0.07..0.15_f32);
    let toe_out = rng.random_range(0.0..0.2_f32);
    let mut heading = rng.random_range(0.0..TAU);
    let turn = if seed.is_multiple_of(3) { rng.random_range(-0.5..0.5_f32) } else { 0.0 };
    let mut body = Vec2::splat(6.0) - Vec2::from_angle(heading) * 2.0
        + Vec2::new(rng.random_range(-0.15..0.15), rng.random_range(-0.15..0.15));
    let mut steps = Vec::new();
    for count in 0..8_u8 {
        let side = if count.is_multiple_of(2) { 1.0 } else { -1.0 };
        let from_s = 0.05 + f32::from(count) * step_s;
        steps.push(Step {
            from_s,
            to_s: from_s + stance,
            place: body + Vec2::from_angle(heading).perp() * side * 0.5 * apart,
            heading: heading + 0.5 * side * toe_out,
            length,
            rolls: true,
            load: Box::new(move |t| (weight * humps((t - from_s) / stance), Vec2::ZERO)),
        });
        heading += turn;
        body += Vec2::from_angle(heading) * (stride + rng.random_range(-0.03..0.03_f32));
    }
    let geometry = Geometry::of_paper_tiles(40, 40).expect("a floor of 40 x 40 tiles");
    let length_s = 0.2 + 7.0 * step_s + stance;
    play(format!("walk {seed} at {speed:.1} m/s"), geometry, length_s, &steps, sensors, seed)
}

/// A person steps onto the floor, one foot after the other, 15 to 60 cm apart, and sways for five seconds.
pub fn stand(seed: u64, sensors: Sensors) -> Scene {
    let mut rng = Pcg64Mcg::seed_from_u64(seed + 1000);
    let weight = rng.random_range(45.0..120.0_f32) * 9.81;
    let length = rng.random_range(0.22..0.30_f32);
    let apart = rng.random_range(0.15..0.60_f32);
    let heading = rng.random_range(0.0..TAU);
    let middle = Vec2::splat(1.8) + Vec2::new(rng.random_range(-0.15..0.15), rng.random_range(-0.15..0.15));
    let (shifts, sways) = (rng.random_range(1.0..3.0_f32), rng.random_range(0.5..1.5_f32));
    let phase = rng.random_range(0.0..6.0_f32);
    let ahead = Vec2::from_angle(heading);
    let across = ahead.perp() * 0.5 * apart;
    let second = move |t: f32| {
        let there = ease(t, 0.6, 0.85);
        0.5 * there + 0.25 * there * (shifts * t + phase).sin() * ease(t, 0.9, 1.5)
    };
    let leaving = |t: f32| 1.0 - ease(t, 5.8, 6.0);
    let sway = move |t: f32, foot: f32| ahead * 0.012 * (sways * t + phase + foot).sin();
    let one = |t: f32| (weight * (1.0 - second(t)) * ease(t, 0.05, 0.2) * leaving(t), sway(t, 0.0));
    let other = |t: f32| (weight * second(t) * leaving(t), sway(t, 1.0));
    let foot =
        |place, heading, load| Step { from_s: 0.05, to_s: 6.0, place, heading, length, rolls: false, load };
    let steps = [
        foot(middle + across, heading + 0.1, Box::new(one)),
        foot(middle - across, heading - 0.1, Box::new(other)),
    ];
    let geometry = Geometry::of_paper_tiles(12, 12).expect("a floor of 12 x 12 tiles");
    play(format!("stand {seed}, {apart:.2} m apart"), geometry, 6.0, &steps, sensors, seed)
}

/// The west edge of the region that [`tap`] taps into, in metres.
pub const REGION_WEST: f32 = 6.0 * 0.304;

/// A stance foot of 350 to 700 N stands 0 to 15 cm beside a region; the other foot taps and slides in it with 30 to
/// 150 N.
pub fn tap(seed: u64, sensors: Sensors) -> Scene {
    let mut rng = Pcg64Mcg::seed_from_u64(seed + 5000);
    let stance = rng.random_range(350.0..700.0_f32);
    let gap = rng.random_range(0.0..0.15_f32);
    let length = rng.random_range(0.22..0.30_f32);
    let tapping = rng.random_range(30.0..150.0_f32);
    let heading = 0.5 * PI + rng.random_range(-0.2..0.2_f32);
    let place = Vec2::new(REGION_WEST - gap - 0.05, 1.8 + rng.random_range(-0.15..0.15_f32));
    let target =
        Vec2::new(REGION_WEST + rng.random_range(0.06..0.35_f32), 1.9 + rng.random_range(-0.15..0.15_f32));
    let slide = Vec2::from_angle(rng.random_range(0.0..TAU)) * 0.08;
    let phase = rng.random_range(0.0..6.0_f32);
    let tap_force = move |t: f32, count: u8| {
        let from_s = 1.0 + f32::from(count) * 1.3;
        let to_s = from_s + if count.is_multiple_of(2) { 0.25 } else { 1.0 };
        tapping * ease(t, from_s, from_s + 0.04) * (1.0 - ease(t, to_s - 0.04, to_s))
    };
    let mut steps = vec![Step {
        from_s: 0.05,
        to_s: 8.0,
        place,
        heading,
        length,
        rolls: false,
        load: Box::new(move |t| {
            let taken: f32 = (0..5).map(|count| tap_force(t, count)).sum();
            let sway = Vec2::new(0.003 * (1.3 * t + phase).sin(), 0.006 * (0.9 * t + phase).cos());
            (stance * ease(t, 0.05, 0.3) - 0.9 * taken, sway)
        }),
    }];
    for count in 0..5_u8 {
        let from_s = 1.0 + f32::from(count) * 1.3;
        let slides = !count.is_multiple_of(2);
        steps.push(Step {
            from_s,
            to_s: from_s + if slides { 1.0 } else { 0.25 },
            place: target,
            heading,
            length,
            rolls: false,
            load: Box::new(move |t| {
                let way = if slides { slide * ease(t - from_s, 0.15, 0.85) } else { Vec2::ZERO };
                (tap_force(t, count), way)
            }),
        });
    }
    let geometry = Geometry::of_paper_tiles(12, 12).expect("a floor of 12 x 12 tiles");
    play(format!("tap {seed} with {tapping:.0} N"), geometry, 8.0, &steps, sensors, seed)
}

/// People on a large floor, two on each block of 6 x 6 tiles, no two blocks in phase.
pub struct Crowd {
    pub geometry: Geometry,
    pub moments: Vec<Moment>,
}

/// One millisecond of a crowd.
pub struct Moment {
    at: Instant,
    /// The readings of the loaded tiles.
    loads: Vec<(usize, [f32; 4])>,
}

impl Moment {
    /// Updates `frame`, which shows `before`, like the assembler: only where a reading changes.
    pub fn show(&self, frame: &mut ForceFrame, before: Option<&Self>) {
        let loads = before.map_or(&[][..], |before| &before.loads);
        loads.iter().for_each(|(index, _)| frame.forces[*index] = [0.0; 4]);
        self.loads.iter().for_each(|(index, forces)| frame.forces[*index] = *forces);
        frame.at = self.at;
    }
}

impl Crowd {
    /// A floor of `side` x `side` tiles on which `walkers` people walk for `millis` milliseconds.
    pub fn of(side: u16, walkers: u16, millis: usize) -> Self {
        let geometry = Geometry::of_paper_tiles(side, side).expect("a square floor");
        let people = [walk(1, Sensors::PERFECT), walk(4, Sensors::PERFECT)];
        let stretches = side / 6;
        let moments = (0..millis).map(|ms| {
            let mut loads: Vec<(usize, [f32; 4])> = Vec::new();
            for walker in 0..walkers {
                let scene = &people[usize::from(walker % 2)];
                let stretch = walker / 2;
                let (east, north) = (6 * (stretch % stretches), 6 * (stretch / stretches));
                let ms = 500 + (ms + 37 * usize::from(stretch)) % 2000;
                for (index, forces) in scene.frames[ms].forces.iter().enumerate() {
                    if forces.iter().all(|force| *force == 0.0) {
                        continue;
                    }
                    let tile = scene.geometry.tile_at_index(index);
                    let column = (tile.column + 3 * (walker % 2)) % 6 + east;
                    let here = TileId::new(column, tile.row % 6 + north);
                    let here = geometry.index(here).expect("a tile of the floor");
                    match loads.iter_mut().find(|(index, _)| *index == here) {
                        Some((_, sum)) => sum.iter_mut().zip(forces).for_each(|(sum, force)| *sum += force),
                        None => loads.push((here, *forces)),
                    }
                }
            }
            Moment { at: people[0].frames[500 + ms].at, loads }
        });
        Self { geometry, moments: moments.collect() }
    }
}

/// The accuracy with which contacts followed people, at 100 Hz.
#[derive(Clone, Debug, Default)]
pub struct Score {
    /// Errors in cm of a foot alone, of feet while two are down, and of the lighter one then.
    pub one: Vec<f32>,
    pub two: Vec<f32>,
    pub lighter: Vec<f32>,
    pub both_within_5cm: usize,
    pub two_foot_samples: usize,
    pub feet: usize,
    pub missed: usize,
    pub extra: usize,
    pub id_changes: usize,
    pub steps: usize,
    pub inside_ellipse: usize,
    pub matched: usize,
    pub ambiguous: usize,
}

/// Least force of a foot that must be found, in newtons.
const LIGHT_N: f32 = 30.0;

impl Score {
    /// Runs `method` over `scene` and adds the result.
    pub fn add(&mut self, scene: &Scene, method: Method) {
        // The uncertainty of these sensors is that with which they were made.
        let uncertainty =
            SensorUncertainty { offset_n: 0.5, gain: 0.05, ..SensorUncertainty::without_memory() };
        let config = SensingConfig { uncertainty, ..SensingConfig::default() };
        let mut sensing = Sensing::with_config(scene.geometry, method, config);
        let mut last: HashMap<usize, u32> = HashMap::new();
        for (ms, (frame, truth)) in scene.frames.iter().zip(&scene.truth).enumerate() {
            let contacts = sensing.update(frame);
            assert!(contacts.iter().all(|contact| contact.centroid.is_finite() && contact.force.0 >= 0.0));
            if ms % 10 == 0 {
                let down: Vec<Truth> = truth.iter().filter(|foot| foot.force >= LIGHT_N).copied().collect();
                self.compare(&down, contacts, &mut last);
            }
        }
    }

    fn compare(&mut self, down: &[Truth], contacts: &[Contact], last: &mut HashMap<usize, u32>) {
        if down.is_empty() {
            return;
        }
        let pairs = closest(down, contacts);
        self.feet += down.len();
        self.missed += down.len() - pairs.len();
        self.extra +=
            contacts.iter().filter(|contact| contact.force.0 >= LIGHT_N).count().saturating_sub(down.len());
        let lightest = down.iter().map(|foot| foot.force).fold(f32::INFINITY, f32::min);
        for &(foot, contact) in &pairs {
            let offset = foot.centre - contact.centroid;
            let error = 100.0 * offset.length();
            if down.len() == 1 {
                self.one.push(error);
            } else {
                self.two.push(error);
                self.ambiguous += usize::from(contact.ambiguous);
                if foot.force == lightest {
                    self.lighter.push(error);
                }
            }
            self.matched += 1;
            self.inside_ellipse += usize::from(contact.covariance.mahalanobis_squared(offset) <= 5.991);
            match last.insert(foot.foot, contact.id.0) {
                None => self.steps += 1,
                Some(id) => self.id_changes += usize::from(id != contact.id.0),
            }
        }
        if down.len() == 2 {
            self.two_foot_samples += 1;
            let near = pairs.iter().filter(|(foot, contact)| foot.centre.distance(contact.centroid) <= 0.05);
            self.both_within_5cm += usize::from(near.count() == 2);
        }
    }

    /// One line of the accuracy table.
    pub fn line(&self, name: &str) -> String {
        let share = |part: usize, whole: usize| 100.0 * part as f32 / whole.max(1) as f32;
        let two = |errors: &[f32]| format!("{:5.1} {:5.1}", quantile(errors, 0.5), quantile(errors, 0.95));
        format!(
            "{name:<14} {} {} {} {:6.1} {:6.1} {:6.1} {:3}/{:<3} {:6.1}",
            two(&self.one),
            two(&self.two),
            two(&self.lighter),
            share(self.both_within_5cm, self.two_foot_samples),
            share(self.missed, self.feet),
            share(self.extra, self.feet),
            self.id_changes,
            self.steps,
            share(self.inside_ellipse, self.matched),
        )
    }

    /// The columns of [`Score::line`].
    pub const HEAD: &str = "               one foot    two feet    lighter     both   missed extra  ids     in 95 %\n\
         cm              50    95    50    95    50    95  <5 cm %     %      % /steps ellipse";
}

/// The error below which `share` of all lie; NaN for none.
pub fn quantile(errors: &[f32], share: f32) -> f32 {
    let mut sorted = errors.to_vec();
    sorted.sort_by(f32::total_cmp);
    let place = (sorted.len().saturating_sub(1) as f32 * share).round() as usize;
    sorted.get(place).copied().unwrap_or(f32::NAN)
}

/// The one-to-one pairing of feet and contacts with the least total distance; at most two feet.
fn closest<'a>(down: &[Truth], contacts: &'a [Contact]) -> Vec<(Truth, &'a Contact)> {
    let mut best = Vec::new();
    let mut least = f32::INFINITY;
    let single = down.len() == 1 || contacts.len() == 1;
    for &foot in down {
        for contact in contacts {
            let near = foot.centre.distance(contact.centroid);
            if single {
                if near < least {
                    (least, best) = (near, vec![(foot, contact)]);
                }
                continue;
            }
            let Some(&other) = down.iter().find(|other| other.foot != foot.foot) else { continue };
            for rival in contacts.iter().filter(|rival| rival.id != contact.id) {
                let both = near + other.centre.distance(rival.centroid);
                if both < least {
                    (least, best) = (both, vec![(foot, contact), (other, rival)]);
                }
            }
        }
    }
    best
}
