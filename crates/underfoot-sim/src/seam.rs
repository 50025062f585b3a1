//! Seams between tiles: plates of unequal height, and crosstalk to the adjacent tile.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use smallvec::SmallVec;

use super::foot::TilePart;
use underfoot::floor::{Corner, Geometry, TileId};

/// Seams of a simulated floor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SeamConfig {
    /// Maximum deviation of a tile's share of a load that several tiles carry, as a share (0 to 0.9).
    ///
    /// Plates differ in height. A person's sole compresses by some 10 mm (heel pads by 9 mm at one to two body
    /// weights, De Clercq et al. 1994); a plate that is 1 mm higher thus carries about a tenth more.
    pub unevenness: f32,
    /// Share (0 to 0.2) of a corner's force that each adjacent corner across a seam carries instead, because a
    /// covering or a filled seam bridges the gap. A corner has one such neighbour at the floor's edge and two inside
    /// it.
    pub crosstalk: f32,
}

impl SeamConfig {
    /// Plates of equal height that do not touch.
    #[must_use]
    pub const fn even() -> Self {
        Self { unevenness: 0.0, crosstalk: 0.0 }
    }
}

/// Corners of other tiles, by tile index and corner index.
type Across = SmallVec<[(usize, usize); 2]>;

/// The seams of one floor.
#[derive(Clone, Debug)]
pub(super) struct Seams {
    /// Relative stiffness of each tile, about 1; empty for a level floor.
    lift: Vec<f32>,
    crosstalk: f32,
    /// The corners across the seams, by tile and corner; empty without crosstalk.
    across: Vec<[Across; 4]>,
    /// Forces to move: tile and corner of the source, tile and corner of the destination, newtons.
    leaks: Vec<(usize, usize, usize, usize, f32)>,
}

impl Seams {
    /// Creates the seams of this floor; `seed` draws only the heights of the plates.
    pub(super) fn new(geometry: &Geometry, config: &SeamConfig, seed: u64) -> Self {
        let unevenness = config.unevenness.clamp(0.0, 0.9);
        let crosstalk = config.crosstalk.clamp(0.0, 0.2);
        let mut rng = Pcg64Mcg::seed_from_u64(seed ^ 0x0005_ea45);
        let lift = |_| 1.0 + unevenness * rng.random_range(-1.0f32..=1.0);
        Self {
            lift: if unevenness > 0.0 { geometry.tiles().map(lift).collect() } else { Vec::new() },
            crosstalk,
            across: if crosstalk > 0.0 {
                geometry
                    .tiles()
                    .map(|tile| Corner::ALL.map(|corner| across(geometry, tile, corner)))
                    .collect()
            } else {
                Vec::new()
            },
            leaks: Vec::new(),
        }
    }

    /// Distributes one load among its tiles by their heights; the total stays the same.
    pub(super) fn share(&self, parts: &mut [TilePart]) {
        if parts.len() < 2 || self.lift.is_empty() {
            return;
        }
        let lift = |part: &TilePart| self.lift.get(part.load.index).copied().unwrap_or(1.0);
        let (mut whole, mut lifted) = (0.0, 0.0);
        for part in parts.iter() {
            whole += part.load.force.0;
            lifted += part.load.force.0 * lift(part);
        }
        if lifted > 0.0 {
            for part in parts {
                part.load.force = part.load.force * (lift(part) * whole / lifted);
            }
        }
    }

    /// Moves the crosstalk from the corners of the `loaded` tiles to those across the seams, and adds their tiles to
    /// `loaded`.
    pub(super) fn leak(&mut self, forces: &mut [[f32; 4]], rest: &[[f32; 4]], loaded: &mut Vec<usize>) {
        if self.across.is_empty() {
            return;
        }
        self.leaks.clear();
        for &tile in loaded.iter() {
            for (corner, across) in self.across[tile].iter().enumerate() {
                let leaking = self.crosstalk * (forces[tile][corner] - rest[tile][corner]);
                self.leaks.extend(across.iter().map(|&(to, at)| (tile, corner, to, at, leaking)));
            }
        }
        for &(tile, corner, to, at, leaking) in &self.leaks {
            forces[tile][corner] -= leaking;
            forces[to][at] += leaking;
            if !loaded.contains(&to) {
                loaded.push(to);
            }
        }
    }
}

/// Corners of other tiles directly across the seams from one corner, by tile index and corner index; none where sensors
/// are not near corners.
fn across(geometry: &Geometry, tile: TileId, corner: Corner) -> Across {
    if !geometry.has_corners() || geometry.is_missing(tile) {
        return Across::new();
    }
    let direction = corner.direction();
    let mirrored = |x: f32, y: f32| {
        Corner::ALL.into_iter().find(|other| other.direction() == glam::Vec2::new(x, y)).map(Corner::index)
    };
    let beside = |index: u16, step: f32| {
        if step > 0.0 { index.checked_add(1) } else { index.checked_sub(1) }
    };
    let sideways = beside(tile.column, direction.x).map(|column| TileId::new(column, tile.row));
    let lengthways = beside(tile.row, direction.y).map(|row| TileId::new(tile.column, row));
    [(sideways, mirrored(-direction.x, direction.y)), (lengthways, mirrored(direction.x, -direction.y))]
        .into_iter()
        .filter(|(tile, _)| tile.is_some_and(|tile| geometry.has(tile)))
        .filter_map(|(tile, corner)| Some((geometry.index(tile?)?, corner?)))
        .collect()
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::{Load, Print, SimConfig, SimFloor};
    use underfoot::floor::Floor;
    use underfoot::units::Newtons;

    fn floor(seam: SeamConfig) -> SimFloor {
        SimFloor::new(&Floor::default(), SimConfig { seam, ..SimConfig::ideal() }, 4)
    }

    fn disc(position: Vec2) -> Load {
        Load { print: Print::Disc { radius_m: 0.05 }, position, heading: 0.0, force: Newtons(600.0) }
    }

    fn net(sim: &SimFloor, tile: usize) -> f32 {
        sim.support_forces(tile).unwrap().iter().map(|force| force.0).sum()
    }

    #[test]
    fn a_higher_tile_carries_more_of_what_stands_on_the_seam_and_nothing_is_lost() {
        let (level, uneven) =
            (floor(SeamConfig::even()), floor(SeamConfig { unevenness: 0.3, ..SeamConfig::even() }));
        let seam = disc(Vec2::new(0.608, 0.456));
        let [level, uneven] = [&level, &uneven].map(|sim| sim.carried(&seam));
        assert!((level[0].force.0 - 300.0).abs() < 1.0, "{level:?}");
        assert!((uneven[0].force.0 - 300.0).abs() > 5.0, "{uneven:?}");
        assert!((uneven[0].force.0 + uneven[1].force.0 - 600.0).abs() < 0.1);
        let alone =
            floor(SeamConfig { unevenness: 0.3, ..SeamConfig::even() }).carried(&disc(Vec2::splat(0.456)));
        assert_eq!((alone.len(), alone[0].force), (1, Newtons(600.0)), "one tile carries all of its load");
    }

    #[test]
    fn a_filled_seam_hands_on_its_share_and_takes_it_back() {
        let mut sim = floor(SeamConfig { crosstalk: 0.02, ..SeamConfig::even() });
        // The centre of tile (1, 1): each corner carries 150 N, and two corners lie across its seams.
        sim.step_under([disc(Vec2::splat(0.456))]);
        let tile = |column: usize, row: usize| 6 * row + column;
        assert!((net(&sim, tile(1, 1)) - 600.0 * 0.96).abs() < 0.1, "{}", net(&sim, tile(1, 1)));
        for (column, row) in [(0, 1), (2, 1), (1, 0), (1, 2)] {
            assert!((net(&sim, tile(column, row)) - 6.0).abs() < 0.05, "{}", net(&sim, tile(column, row)));
        }
        assert_eq!(net(&sim, tile(0, 0)), 0.0);
        sim.step_under([]);
        assert_eq!(net(&sim, tile(0, 1)), 0.0);
    }
}
