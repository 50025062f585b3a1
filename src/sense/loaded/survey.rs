//! Survey of the loads of all tiles: the one pass over all sensors.

use multiversion::multiversion;

use super::{BLOCK, TileSet};
use crate::floor::Geometry;
use crate::sense::centroid::tile::NO_WEIGHT;
use crate::sense::{ForceFrame, Quality};

/// Bit of [`Quality::Stale`] and [`Quality::Faulty`]; a sensor with it is replaced by an estimate.
const LOST: u8 = 2;

/// Result of one pass over all sensors.
#[derive(Clone, Debug)]
pub(super) struct Survey {
    /// Sum of each tile's sensors (N).
    pub sums: Vec<f32>,
    /// For each tile, the bits of membership in the next two sets; none behind the last tile.
    marks: Vec<[u8; BLOCK]>,
    /// Tiles with enough load to be examined.
    pub candidates: TileSet,
    /// Tiles with any load; the listed ones are removed later.
    pub light: TileSet,
    /// Per block of tiles, the bitwise OR of all its sensors' qualities.
    pub worst: Vec<u8>,
}

impl Survey {
    /// The survey of an empty floor.
    pub(super) fn new(geometry: &Geometry) -> Self {
        let tiles = geometry.tile_count();
        Self {
            sums: vec![0.0; tiles],
            marks: vec![[0; BLOCK]; tiles.div_ceil(BLOCK)],
            candidates: TileSet::new(geometry),
            light: TileSet::new(geometry),
            worst: vec![0; tiles.div_ceil(BLOCK)],
        }
    }

    /// Surveys a frame: candidates carry `off` or more, and tiles that the frame does not have carry nothing.
    pub(super) fn update(&mut self, frame: &ForceFrame, off: f32) {
        let Self { sums, marks, candidates, light, worst } = self;
        let there = frame.forces.len().min(frame.quality.len()).min(sums.len());
        let (here, missing) = sums.split_at_mut(there);
        missing.fill(0.0);
        marks.as_flattened_mut()[there..].fill(0);
        worst.fill(0);
        let forces = &frame.forces[..there];
        add_up(here, forces, &frame.quality[..there], worst);
        mark(marks, here, off, candidates.blocks_mut(), light.blocks_mut());
    }

    /// Whether a sensor of a block is lost.
    pub(super) fn has_lost(&self, block: usize) -> bool {
        self.worst[block] & LOST != 0
    }

    /// Whether every sensor of a block is live.
    pub(super) fn is_live(&self, block: usize) -> bool {
        self.worst[block] == Quality::Live as u8
    }
}

/// Sums each tile's forces, and combines the qualities of each block's sensors by bitwise OR.
///
/// Here and below: no branches, plain arrays, compiled for each vector instruction set.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512bw", "x86_64+avx2", "aarch64+neon"))]
fn add_up(sums: &mut [f32], forces: &[[f32; 4]], quality: &[[Quality; 4]], worst: &mut [u8]) {
    for (sum, [sw, se, nw, ne]) in sums.iter_mut().zip(forces) {
        *sum = (sw + se) + (nw + ne);
    }
    let (blocks, rest) = quality.as_chunks::<BLOCK>();
    let all =
        |quality: &[[Quality; 4]]| quality.as_flattened().iter().fold(0, |all, &quality| all | quality as u8);
    for (worst, quality) in worst.iter_mut().zip(blocks) {
        *worst = all(quality);
    }
    if let Some(worst) = worst.get_mut(blocks.len()) {
        *worst = all(rest);
    }
}

/// Finds the tiles that carry `off` or more, and those that carry any load; `marks` has room for one byte a tile.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512bw", "x86_64+avx2", "aarch64+neon"))]
fn mark(marks: &mut [[u8; BLOCK]], sums: &[f32], off: f32, candidates: &mut [u16], light: &mut [u16]) {
    for (mark, &sum) in marks.as_flattened_mut().iter_mut().zip(sums) {
        *mark = u8::from(sum >= off) | u8::from(sum > NO_WEIGHT) << 1;
    }
    for (marks, (candidates, light)) in marks.iter().zip(candidates.iter_mut().zip(light)) {
        let marks = u128::from_le_bytes(*marks);
        (*candidates, *light) = (low_bits(marks), low_bits(marks >> 1));
    }
}

/// The lowest bit of each byte, in the order of the bytes.
#[inline(always)]
fn low_bits(bytes: u128) -> u16 {
    // The factor moves the bit of byte i to place 56 + i; no two sums of positions are equal.
    let of_eight = |bytes: u64| (bytes & 0x0101_0101_0101_0101).wrapping_mul(0x0102_0408_1020_4080) >> 56;
    (of_eight(bytes as u64) | of_eight((bytes >> 64) as u64) << 8) as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lowest_bits_of_bytes_are_taken_in_order() {
        for bits in [0_u16, 1, 0x8000, 0x00ff, 0x5a3c, 0xffff] {
            let bytes = std::array::from_fn(|place| 0xfe | (bits >> place & 1) as u8);
            assert_eq!(low_bits(u128::from_le_bytes(bytes)), bits);
        }
    }
}
