//! Simulated walkers on a square floor, and their loads at each millisecond.

use std::time::Duration;

use glam::Vec2;

use underfoot::floor::{Floor, Geometry};
use underfoot::units::Instant;
use underfoot_sim::{Performance, Person, Script, SimConfig, SimFloor};

/// Side (tiles) of the stretch of floor that two people cross.
const STRETCH: u16 = 6;

/// Tile index and corner forces of each loaded tile at one millisecond.
pub(super) type TileLoads = Vec<(usize, [f32; 4])>;

/// A floor of `side` x `side` tiles, and the loads of `walkers` people on it, two on each stretch of 6 x 6 tiles.
///
/// `side` is clamped to 6 and the largest side of a floor; the number of walkers is limited to two for each stretch.
pub(super) fn walkers_on(side: u16, walkers: u16) -> (Geometry, Vec<TileLoads>) {
    let side = side.clamp(STRETCH, Geometry::MAX_SIDE);
    let geometry = Geometry::of_paper_tiles(side, side).unwrap_or_default();
    let small = crossing();
    let stretches = geometry.columns() / STRETCH;
    let moments = (0..small.len()).map(|ms| {
        let mut loads = TileLoads::new();
        for pair in 0..walkers.div_ceil(2).min(stretches * stretches) {
            let (east, north) = (STRETCH * (pair % stretches), STRETCH * (pair / stretches));
            // A different phase for each stretch.
            let ms = (ms + 37 * usize::from(pair)) % small.len();
            loads.extend(small[ms].iter().map(|(index, forces)| {
                let (column, row) = (*index as u16 % STRETCH, *index as u16 / STRETCH);
                let index =
                    usize::from(north + row) * usize::from(geometry.columns()) + usize::from(east + column);
                (index, *forces)
            }));
        }
        loads
    });
    let moments = moments.collect();
    (geometry, moments)
}

/// Loads of two people on 6 x 6 tiles as they walk to and fro, one entry per millisecond.
fn crossing() -> Vec<TileLoads> {
    let floor = Floor::default();
    let size = floor.geometry.bounds().max;
    let walker = |mass_kg, seed, from: Vec2, to: Vec2| {
        let mut walker = Performance::new(Person { mass_kg, ..Person::default() }, seed);
        // The person is on the floor before the walk begins, so neither call fails.
        let _ = walker.appear(from, 0.0);
        let _ = walker.walk(&[to, from]);
        walker
    };
    let script = Script::new(
        vec![
            walker(62.0, 1, Vec2::new(0.45, 0.3), Vec2::new(0.45, size.y - 0.3)),
            walker(85.0, 2, Vec2::new(size.x - 0.45, size.y - 0.3), Vec2::new(size.x - 0.45, 0.3)),
        ],
        floor.geometry.bounds(),
    );
    let mut sim = SimFloor::new(&floor, SimConfig::ideal(), 1);
    sim.step(&[]);
    let tiles = floor.geometry.tile_count();
    let forces = |sim: &SimFloor, index| sim.support_forces(index).unwrap_or_default().map(|force| force.0);
    let empty: Vec<[f32; 4]> = (0..tiles).map(|index| forces(&sim, index)).collect();
    let mut feet = Vec::new();
    let length = script.duration().max(Duration::from_secs(2)).as_millis() as u64;
    (0..length)
        .map(|ms| {
            feet.clear();
            script.feet_at(Instant::from_millis(ms), &mut feet);
            sim.step(&feet);
            let loads = (0..tiles).filter_map(|index| {
                let (now, empty) = (forces(&sim, index), empty[index]);
                let load = std::array::from_fn(|corner| now[corner] - empty[corner]);
                load.iter().any(|force: &f32| force.abs() > 1e-3).then_some((index, load))
            });
            loads.collect()
        })
        .collect()
}
