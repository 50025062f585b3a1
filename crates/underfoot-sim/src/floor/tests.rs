//! Simulated floors under known loads.

use super::*;
use crate::Print;
use underfoot::floor::TileId;

fn foot(position: Vec2, force: f32) -> Foot {
    Foot { position, heading: 0.2, length_m: 0.27, force: Newtons(force), roll: 0.4, left: false }
}

/// Total force and centroid of everything on the floor, from the readings in newtons.
fn sensed(floor: &Floor, readings: &[Readings]) -> (f32, Vec2) {
    let (mut force, mut moment) = (0.0, Vec2::ZERO);
    for (board, readings) in floor.boards.iter().zip(readings) {
        let Readings::Newtons(newtons) = readings else { panic!("a board that sends newtons") };
        for (sensor, newtons) in board.channels.iter().flatten().zip(newtons) {
            force += newtons;
            moment += floor.geometry.sensor(sensor.tile, sensor.corner) * *newtons;
        }
    }
    (force, moment / force)
}

fn all_counts(readings: &[Readings]) -> Vec<u16> {
    let counts = |board: &Readings| match board {
        Readings::Counts(counts) => counts.iter().map(|count| count.unwrap()).collect::<Vec<_>>(),
        Readings::Scaled(_) | Readings::Newtons(_) => panic!("a board that sends counts"),
    };
    readings.iter().flat_map(counts).collect()
}

#[test]
fn an_ideal_floor_places_a_point_within_a_tenth_of_a_millimetre_wherever_it_presses() {
    let floor = Floor::of(Geometry::of_paper_tiles(1, 1).unwrap());
    let mut sim = SimFloor::new(&floor, SimConfig::ideal(), 1);
    for x in 0..=30 {
        for y in 0..=30 {
            let position = Vec2::new(x as f32, y as f32) * (0.3039 / 30.0);
            let point = Load { print: Print::Point, position, heading: 0.0, force: Newtons(100.0) };
            let (force, at) = sensed(&floor, sim.step_under([point]));
            assert!((force - 100.0).abs() < 1e-3, "{force}");
            assert!(at.distance(position) < 1e-4, "{at} for {position}");
        }
    }
}

#[test]
fn an_ideal_floor_feels_a_foot_across_four_tiles_as_one_centre_of_pressure() {
    let floor = Floor::default();
    let mut sim = SimFloor::new(&floor, SimConfig::ideal(), 1);
    let foot = foot(Vec2::new(0.62, 0.59), 700.0);
    let (force, at) = sensed(&floor, sim.step(&[foot]));
    assert!((force - 700.0).abs() < 0.01);
    assert!(at.distance(foot.centre_of_pressure()) < 1e-4, "{at}");
    let (force, _) = sensed(&floor, sim.step(&[]));
    assert!(force.abs() < 1e-3, "nothing is left behind: {force}");
}

#[test]
fn two_feet_on_one_tile_press_together() {
    let floor = Floor::default();
    let mut sim = SimFloor::new(&floor, SimConfig::ideal(), 1);
    let feet = [foot(Vec2::new(0.86, 1.0), 300.0), foot(Vec2::new(0.97, 1.0), 500.0)];
    let (force, at) = sensed(&floor, sim.step(&feet));
    let expected = (feet[0].centre_of_pressure() * 300.0 + feet[1].centre_of_pressure() * 500.0) / 800.0;
    assert!((force - 800.0).abs() < 0.01 && at.distance(expected) < 1e-4, "{force} at {at}");
}

#[test]
fn standing_fits_the_converters_and_stamping_on_a_corner_saturates() {
    let floor = Floor::default();
    let mut sim = SimFloor::new(&floor, SimConfig::default(), 4);
    // 70 kg on one foot at the centre of a tile.
    let middle = floor.geometry.centre(TileId::new(2, 2));
    let counts = all_counts(sim.step(&[foot(middle, 690.0)]));
    assert!(counts.iter().all(|&count| count < u16::MAX));
    // A stamp of twice the body weight with the forefoot on a corner.
    let corner = floor.geometry.sensor(TileId::new(2, 2), Corner::NorthEast);
    let stamp = Load {
        print: Print::Disc { radius_m: 0.03 },
        position: corner - 0.02,
        heading: 0.0,
        force: Newtons(1400.0),
    };
    let counts = all_counts(sim.step_under([stamp]));
    assert_eq!(counts.iter().filter(|&&count| count == u16::MAX).count(), 1);
}

#[test]
fn same_seed_same_counts_other_seed_other_floor() {
    let floor = Floor::default();
    let run = |seed| {
        let mut sim = SimFloor::new(&floor, SimConfig::default(), seed);
        (0..50)
            .map(|step| all_counts(sim.step(&[foot(Vec2::new(0.3 + 0.02 * step as f32, 0.9), 700.0)])))
            .collect::<Vec<_>>()
    };
    assert_eq!(run(9), run(9));
    assert_ne!(run(9), run(10));
}

#[test]
fn noise_is_two_millivolts_on_every_sensor() {
    let floor = Floor::default();
    let mut sim = SimFloor::new(&floor, SimConfig::default(), 2);
    let samples: Vec<f32> = (0..2000).map(|_| Calibration::volts(all_counts(sim.step(&[]))[17])).collect();
    let mean = samples.iter().sum::<f32>() / 2000.0;
    let deviation = (samples.iter().map(|v| (v - mean).powi(2)).sum::<f32>() / 2000.0).sqrt();
    assert!((deviation - 0.002).abs() < 0.0002, "{deviation}");
}

#[test]
fn boards_that_know_their_parts_send_tared_newtons_within_a_few_percent() {
    let floor = Floor::default();
    let config =
        SimConfig { sensing: SimulatedSensors::Newtons(PartConfig::default()), ..SimConfig::default() };
    let mut sim = SimFloor::new(&floor, config, 2);
    let (empty, _) = sensed(&floor, sim.step(&[]));
    // 144 sensors with 2 mV of noise at 11 N: about 0.03 N each.
    assert!(empty.abs() < 2.0, "{empty}");
    let foot = foot(Vec2::new(0.9, 0.75), 400.0);
    let (force, at) = sensed(&floor, sim.step(&[foot]));
    assert!((force / 400.0 - 1.0).abs() < 0.15, "{force}");
    assert!(at.distance(foot.centre_of_pressure()) < 0.03, "{at}");
}

#[test]
fn broken_sensors_read_what_their_fault_says_until_repaired() {
    let floor = Floor::default();
    let mut sim = SimFloor::new(&floor, SimConfig::default(), 2);
    let tile = TileId::new(1, 0);
    let on_tile = foot(floor.geometry.centre(tile), 600.0);
    let sensor = |corner| SensorId { tile, corner };
    let before = all_counts(sim.step(&[]));
    sim.set_fault(sensor(Corner::SouthWest), Some(SensorFault::Stuck));
    sim.set_fault(sensor(Corner::SouthEast), Some(SensorFault::Open));
    sim.set_fault(sensor(Corner::NorthWest), Some(SensorFault::Short));
    sim.set_fault(sensor(Corner::NorthEast), Some(SensorFault::Offset(Newtons(50.0))));
    let read = |counts: &[u16]| [counts[4], counts[5], counts[6], counts[7]];
    let empty = read(&all_counts(sim.step(&[])));
    let loaded = read(&all_counts(sim.step(&[on_tile])));
    assert!(loaded[0].abs_diff(before[4]) < 200, "stuck, apart from noise: {loaded:?}, was {}", before[4]);
    assert!(loaded[1] < 200 && loaded[2] == u16::MAX, "{loaded:?}");
    assert!(empty[3] > before[7] + 5000, "50 N more on the empty floor: {empty:?}");
    for corner in Corner::ALL {
        sim.set_fault(sensor(corner), None);
    }
    let repaired = read(&all_counts(sim.step(&[])));
    assert!(repaired.iter().zip(&before[4..]).all(|(now, then)| now.abs_diff(*then) < 200));
    sim.set_fault(SensorId { tile: TileId::new(99, 0), corner: Corner::NorthEast }, Some(SensorFault::Open));
}

#[test]
fn parts_with_memory_keep_a_trace_of_the_foot_that_left() {
    let floor = Floor::of(Geometry::of_paper_tiles(1, 1).unwrap());
    let parts = PartConfig { noise_v: 0.0, ..PartConfig::default() }.with_memory();
    let mut sim = SimFloor::new(
        &floor,
        SimConfig { sensing: SimulatedSensors::Counts(parts), ..SimConfig::default() },
        2,
    );
    let before = all_counts(sim.step(&[]));
    for _ in 0..3000 {
        sim.step(&[foot(Vec2::splat(0.152), 700.0)]);
    }
    let after = all_counts(sim.step(&[]));
    assert!(after.iter().zip(&before).all(|(after, before)| after > before), "{after:?} after {before:?}");
}

#[test]
fn channels_without_a_sensor_read_zero() {
    let mut floor = Floor::of(Geometry::of_paper_tiles(2, 1).unwrap());
    floor.boards[0].channels[3] = None;
    floor.boards[0].channels[4] = Some(SensorId { tile: TileId::new(9, 9), corner: Corner::SouthWest });
    let mut sim = SimFloor::new(&floor, SimConfig::default(), 2);
    let counts = all_counts(sim.step(&[foot(Vec2::splat(0.304), 700.0)]));
    assert_eq!((counts[3], counts[4]), (0, 0));
    assert_eq!(counts.len(), 8);
    assert_ne!(counts[6], 0);
}
