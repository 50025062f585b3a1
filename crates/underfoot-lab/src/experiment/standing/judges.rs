//! Feet that judge a calibration.

use glam::Vec2;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use underfoot::floor::{Calibration, Floor, SensorId};
use underfoot::units::Newtons;
use underfoot::wire::Readings;
use underfoot_sim::{Foot, SimFloor};

/// Number of feet that judge each calibration.
const JUDGES: usize = 300;

/// Number of readings averaged for each of them.
const READINGS: u32 = 50;

/// The readings under a foot, and the load that the sensors bore.
pub(super) struct JudgedFoot {
    /// Sensor, its place and its output in volts.
    volts: Vec<(SensorId, Vec2, f32)>,
    pub(super) force: f32,
    pub(super) at: Vec2,
}

impl JudgedFoot {
    /// Force and place by these laws and tares.
    pub(super) fn felt(&self, laws: &dyn Fn(SensorId) -> (Calibration, Newtons)) -> (f32, Vec2) {
        let (mut sum, mut moment) = (0.0, Vec2::ZERO);
        for &(sensor, place, volts) in &self.volts {
            let (law, tare) = laws(sensor);
            let force = (law.force_at(volts) - tare).0;
            sum += force;
            moment += force * place;
        }
        (sum, moment / sum)
    }
}

/// Feet all over the floor, none of which saturates a sensor.
pub(super) fn judging_feet(wired: &Floor, sim: &mut SimFloor, seed: u64) -> Vec<JudgedFoot> {
    let mut rng = Pcg64Mcg::seed_from_u64(seed ^ 0x6a75_d6e5);
    let bounds = wired.geometry.bounds();
    let (low, high) = (bounds.min, bounds.max);
    let mut feet = Vec::with_capacity(JUDGES);
    for _ in 0..JUDGES {
        let foot = Foot {
            position: Vec2::new(
                rng.random_range(low.x + 0.1..high.x - 0.1),
                rng.random_range(low.y + 0.1..high.y - 0.1),
            ),
            heading: rng.random_range(0.0..std::f32::consts::TAU),
            length_m: rng.random_range(0.22..0.30),
            force: Newtons(rng.random_range(120.0..980.0)),
            roll: rng.random_range(0.2..0.8),
            left: false,
        };
        feet.extend(judged(wired, sim, &foot));
    }
    feet
}

/// The readings under a foot; `None` if a sensor is at the end of its range, or little of the foot is on the floor.
fn judged(wired: &Floor, sim: &mut SimFloor, foot: &Foot) -> Option<JudgedFoot> {
    let loads = |sim: &SimFloor| -> Vec<[f32; 4]> {
        let tiles = 0..wired.geometry.tile_count();
        tiles.map(|tile| sim.support_forces(tile).map_or([0.0; 4], |all| all.map(|one| one.0))).collect()
    };
    sim.step(&[]);
    let rest = loads(sim);
    sim.step(std::slice::from_ref(foot));
    let bore = loads(sim);
    let mut volts: Vec<(SensorId, Vec2, f32)> = Vec::new();
    for round in 0..READINGS {
        let boards = wired.boards.iter().zip(sim.step(std::slice::from_ref(foot)));
        let mut number = 0;
        for (board, readings) in boards {
            let Readings::Counts(counts) = readings else { return None };
            for (sensor, count) in board.channels.iter().flatten().zip(counts) {
                let output = Calibration::volts((*count)?);
                if round == 0 {
                    volts.push((*sensor, wired.geometry.sensor(sensor.tile, sensor.corner), 0.0));
                }
                volts.get_mut(number)?.2 += output / READINGS as f32;
                number += 1;
            }
        }
    }
    if volts.iter().any(|(.., volts)| *volts >= 0.97 * Calibration::FULL_SCALE_VOLTS) {
        return None;
    }
    let (mut force, mut moment) = (0.0, Vec2::ZERO);
    volts.retain(|(sensor, place, _)| {
        let Some(tile) = wired.geometry.index(sensor.tile) else { return false };
        let corner = sensor.corner.index();
        let net = bore[tile][corner] - rest[tile][corner];
        force += net;
        moment += net * *place;
        // As in sensing, tiles without a load do not count.
        bore[tile] != rest[tile]
    });
    (force > 100.0).then(|| JudgedFoot { volts, force, at: moment / force })
}
