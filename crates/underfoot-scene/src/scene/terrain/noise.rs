//! Deterministic noise: pseudo-random numbers that depend only on seed and place.

use glam::{IVec2, Vec2};

/// Deterministic noise with a seed.
#[derive(Clone, Copy, Debug)]
pub(super) struct TerrainNoise(pub(super) u32);

impl TerrainNoise {
    /// A number from 0 up to 1 for element `n` of a kind.
    pub(super) fn at(self, kind: u32, n: u32) -> f32 {
        // Two rounds of a well-mixing integer hash.
        let mut x = self.0 ^ kind.wrapping_mul(0x9e37_79b9) ^ n.wrapping_mul(0x85eb_ca6b);
        for _ in 0..2 {
            x = (x ^ (x >> 16)).wrapping_mul(0x7feb_352d);
            x = (x ^ (x >> 15)).wrapping_mul(0x846c_a68b);
            x ^= x >> 16;
        }
        (x >> 8) as f32 / (1 << 24) as f32
    }

    /// A number from -1 to 1 for element `n` of a kind.
    pub(super) fn signed(self, kind: u32, n: u32) -> f32 {
        2.0 * self.at(kind, n) - 1.0
    }

    /// A random point in the unit square.
    pub(super) fn place(self, kind: u32, n: u32) -> Vec2 {
        Vec2::new(self.at(kind, 2 * n), self.at(kind, 2 * n + 1))
    }

    /// Smooth value noise between -1 and 1, with a grid of `grain_m` metres.
    pub(super) fn hills(self, kind: u32, at: Vec2, grain_m: f32) -> f32 {
        let scaled = at / grain_m;
        let cell = scaled.floor();
        let share = scaled - cell;
        let share = share * share * (Vec2::splat(3.0) - 2.0 * share);
        let cell = cell.as_ivec2();
        let corner = |x: i32, y: i32| {
            let IVec2 { x, y } = cell + IVec2::new(x, y);
            self.signed(kind, (x as u32).wrapping_mul(0x27d4_eb2f) ^ (y as u32).wrapping_mul(0x1656_67b1))
        };
        let south = corner(0, 0) + (corner(1, 0) - corner(0, 0)) * share.x;
        let north = corner(0, 1) + (corner(1, 1) - corner(0, 1)) * share.x;
        south + (north - south) * share.y
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_spread_evenly_and_hills_are_smooth() {
        let noise = TerrainNoise(7);
        let mean = (0..10_000).map(|n| noise.at(1, n)).sum::<f32>() / 10_000.0;
        assert!((mean - 0.5).abs() < 0.02, "{mean}");
        assert!(noise.at(1, 5) != noise.at(2, 5) && noise.at(1, 5) != TerrainNoise(8).at(1, 5));
        for step in 0..1000 {
            let at = Vec2::new(step as f32 * 0.003, 1.0);
            let (here, there) = (noise.hills(3, at, 0.3), noise.hills(3, at + 0.003, 0.3));
            assert!((here - there).abs() < 0.1 && here.abs() <= 1.0);
        }
    }
}
