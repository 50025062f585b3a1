//! Thresholds of tiles with noise, hum and creep.

use std::time::Duration;

use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_pcg::Pcg64Mcg;

use crate::floor::Geometry;
use crate::sense::ForceFrame;
use crate::sense::loaded::{LoadThreshold, LoadedTiles};

/// A floor of 5 x 5 tiles with noise, hum and creep.
struct Floor {
    tiles: LoadedTiles,
    frame: ForceFrame,
    rng: Pcg64Mcg,
    /// Per sensor (N).
    noise_n: f32,
    hum_n: f32,
    creep: f32,
    memories: [[f32; 4]; 25],
    at_s: f32,
}

impl Floor {
    fn new(noise_n: f32, hum_n: f32, creep: f32) -> Self {
        let geometry = Geometry::of_paper_tiles(5, 5).unwrap();
        Self {
            tiles: LoadedTiles::new(geometry, LoadThreshold::default()),
            frame: ForceFrame::empty(&geometry),
            rng: Pcg64Mcg::seed_from_u64(7),
            noise_n,
            hum_n,
            creep,
            memories: [[0.0; 4]; 25],
            at_s: 0.0,
        }
    }

    /// Runs `frames` frames, `dt_s` apart, with these loads; returns the number of unloaded tiles that counted as
    /// loaded, summed over the frames, and the number of loaded tiles that did not.
    fn run(&mut self, frames: u32, dt_s: f32, loads: &[(usize, f32)]) -> (u32, u32) {
        let (mut ghosts, mut missed) = (0, 0);
        for _ in 0..frames {
            self.at_s += dt_s;
            self.frame.at = self.frame.at + Duration::from_secs_f32(dt_s);
            let hum = self.hum_n * (std::f32::consts::TAU * 50.0 * self.at_s).sin();
            for (index, forces) in self.frame.forces.iter_mut().enumerate() {
                let load = loads.iter().find(|load| load.0 == index).map_or(0.0, |load| load.1);
                let memory = &mut self.memories[index];
                for (memory, time_s) in memory.iter_mut().zip(super::TIMES_S) {
                    *memory += (load - *memory) * (1.0 - (-dt_s / time_s).exp());
                }
                let sum = load + self.creep * memory.iter().sum::<f32>();
                *forces = std::array::from_fn(|_| {
                    0.25 * sum + hum + self.noise_n * self.rng.sample::<f32, _>(StandardNormal)
                });
            }
            self.tiles.update(&self.frame);
            let is_loaded = |index| self.tiles.position(index as u32).is_some();
            let is_light = |index| loads.iter().all(|load| load.0 != index);
            ghosts += (0..25).filter(|&index| is_light(index) && is_loaded(index)).count() as u32;
            missed += loads.iter().filter(|load| !is_loaded(load.0)).count() as u32;
        }
        (ghosts, missed)
    }
}

#[test]
fn a_tile_that_hisses_is_empty_and_a_light_foot_on_it_is_seen() {
    for noise_n in [0.3, 1.0, 2.0, 3.0] {
        let mut floor = Floor::new(noise_n, 0.0, 0.0);
        let (at_first, _) = floor.run(200, 0.001, &[]);
        assert!(at_first <= 2, "{noise_n} N: {at_first} at first");
        let (ghosts, _) = floor.run(5000, 0.001, &[]);
        assert!(ghosts <= 10, "{noise_n} N: {ghosts} in 5 s");
        // The tile counts within 20 ms, and then in nearly every frame.
        floor.run(20, 0.001, &[(12, 30.0)]);
        let (_, missed) = floor.run(500, 0.001, &[(12, 30.0)]);
        assert!(missed <= 15, "{noise_n} N: {missed} ms of 500 without the foot");
    }
}

#[test]
fn hum_that_all_sensors_share_is_noise_too() {
    let mut floor = Floor::new(0.1, 5.0, 0.0);
    floor.run(500, 0.001, &[]);
    assert_eq!(floor.run(5000, 0.001, &[]).0, 0);
    floor.run(20, 0.001, &[(12, 90.0)]);
    assert_eq!(floor.run(500, 0.001, &[(12, 90.0)]).1, 0);
}

#[test]
fn noise_is_known_at_any_rate_and_after_gaps() {
    for dt_s in [0.05, 0.018, 0.01, 0.002] {
        let mut floor = Floor::new(2.0, 0.0, 0.0);
        floor.run(100, dt_s, &[]);
        floor.run(1, 0.4, &[]);
        let (ghosts, _) = floor.run(1000, dt_s, &[]);
        assert!(ghosts <= 10, "every {dt_s} s: {ghosts} of 25,000");
        floor.run(5, dt_s, &[(12, 60.0)]);
        assert_eq!(floor.run(100, dt_s, &[(12, 60.0)]).1, 0, "every {dt_s} s");
    }
}

#[test]
fn a_table_shows_the_noise_before_the_first_foot_and_what_it_leaves_out_is_no_silence() {
    // A foot stands on tile 7 from the first instant; tile 9 is never in the table.
    let mut floor = Floor::new(2.0, 0.0, 0.0);
    let frames: Vec<ForceFrame> = (0..1000)
        .map(|_| {
            floor.run(1, 0.001, &[(7, 400.0)]);
            let mut frame = floor.frame.clone();
            frame.forces[9] = [0.0; 4];
            frame
        })
        .collect();
    let geometry = Geometry::of_paper_tiles(5, 5).unwrap();
    let mut tiles = LoadedTiles::new(geometry, LoadThreshold::default());
    tiles.learn_noise(&frames);
    for tile in [0, 7, 9, 24] {
        let noise = tiles.thresholds.noise_n(tile);
        assert!((1.5..2.5).contains(&noise), "tile {tile}: {noise} N of noise");
    }
    // The rest of the table has rows of loaded tiles only.
    for milli in 1..5000 {
        let mut frame = ForceFrame::empty(&geometry);
        frame.at = floor.frame.at + Duration::from_millis(milli);
        frame.forces[7] = [100.0; 4];
        tiles.update(&frame);
    }
    assert!(tiles.thresholds.noise_n(3) > 1.5);
    assert_eq!(tiles.list().len(), 1);
}

#[test]
fn noise_that_ends_leaves_no_threshold_behind() {
    let mut floor = Floor::new(2.0, 0.0, 0.0);
    floor.run(2000, 0.001, &[]);
    floor.noise_n = 0.01;
    floor.run(12_000, 0.001, &[]);
    assert_eq!(floor.run(10, 0.001, &[(12, 6.5)]).1, 0);
}

#[test]
fn what_rests_or_rises_slowly_is_not_noise() {
    let mut floor = Floor::new(0.05, 0.0, 0.0);
    for tenths in 0..55_u8 {
        floor.run(100, 0.001, &[(12, 0.1 * f32::from(tenths))]);
    }
    assert_eq!(floor.run(10, 0.001, &[(12, 6.5)]), (0, 0));
}

#[test]
fn a_floor_that_creeps_and_hisses_is_empty_once_it_is_left() {
    for (dt_s, noise_n) in [(0.001, 1.0), (0.01, 1.0), (0.01, 2.0)] {
        let frames = |seconds: f32| (seconds / dt_s).round() as u32;
        let mut floor = Floor::new(noise_n, 0.0, 0.05);
        floor.run(frames(2.0), dt_s, &[]);
        let mut ghosts = 0;
        for _ in 0..5 {
            floor.run(frames(0.7), dt_s, &[(12, 700.0)]);
            // The toes: an unloaded tile stays loaded for 30 ms more.
            floor.run(frames(0.05), dt_s, &[]);
            ghosts += floor.run(frames(2.0), dt_s, &[]).0;
        }
        // For 25 tiles in ten seconds; as many as on tiles without any earlier load.
        println!("{ghosts} every {dt_s} s at {noise_n} N");
        assert!(ghosts <= 10, "{ghosts} every {dt_s} s at {noise_n} N");
    }
}

#[test]
fn a_floor_that_creeps_is_empty_once_it_is_left_and_its_other_tiles_feel_a_toe() {
    let mut floor = Floor::new(0.0, 0.0, 0.05);
    for _ in 0..5 {
        assert_eq!(floor.run(700, 0.001, &[(12, 700.0)]), (0, 0));
        // A clean tile is as sensitive as before; the unloaded one is empty 31 ms later.
        let (ghosts, missed) = floor.run(1000, 0.001, &[(7, 6.5)]);
        assert!(ghosts <= 31 && missed == 0, "{ghosts} ms, {missed}");
    }
    // A foot of 60 N is detected right after a step of ten times as much, one of 6.5 N after a minute.
    floor.run(700, 0.001, &[(12, 700.0)]);
    floor.run(200, 0.001, &[]);
    assert_eq!(floor.run(100, 0.001, &[(12, 60.0)]).1, 0);
    let mut sound = Floor::new(0.0, 0.0, 0.0);
    sound.run(700, 0.001, &[(12, 700.0)]);
    sound.run(6000, 0.01, &[]);
    assert_eq!(sound.run(10, 0.001, &[(12, 6.5)]).1, 0);
}

#[test]
fn light_loads_right_after_heavy_ones_are_taken_to_be_left_by_them_in_part() {
    let mut floor = Floor::new(0.0, 0.0, 0.0);
    let mut left = |force: f32, millis: u32| {
        floor.run(millis, 0.001, &[(12, force)]);
        floor.tiles.list().first().map(|tile| tile.left_n)
    };
    assert_eq!(left(60.0, 50), Some(0.0), "nothing came before");
    assert_eq!(left(700.0, 700), Some(0.0), "far more than can be left");
    // 5.5 % a decade of 700 N over 0.7 s is some 50 N.
    assert!(left(60.0, 10).is_some_and(|left| (25.0..60.0).contains(&left)));
}

#[test]
fn a_foot_that_gives_up_its_weight_within_a_tenth_of_a_second_is_followed_to_its_toes() {
    let mut floor = Floor::new(0.0, 0.0, 0.0);
    floor.run(700, 0.001, &[(12, 900.0)]);
    let missed: u32 = (0..22).map(|step| floor.run(4, 0.001, &[(12, 900.0 - 40.0 * step as f32)]).1).sum();
    assert_eq!(missed, 0);
}
