//! Mean and range of all sensors' readings over 64 ms, computed with vector operations.

use std::ops::Range;

use multiversion::multiversion;

use super::RangeEnd;

/// Number of frames between two visits to a tile.
pub(super) const SHARES: usize = 8;

/// Visits averaged into one block: 64 ms.
const VISITS: u8 = 8;

/// The blocks in progress of all tiles. Those of one share of the floor begin and end together.
#[derive(Clone, Debug)]
pub(super) struct Averages {
    /// Number of visits to each share for its block.
    visits: [u8; SHARES],
    sums: Vec<[f32; 4]>,
    lows: Vec<[f32; 4]>,
    highs: Vec<[f32; 4]>,
    /// Last position of each sensor in its converter's range; the high end if it was ever there.
    ends: Vec<[RangeEnd; 4]>,
    /// Whether each tile's sensors were all connected at every visit.
    is_whole: Vec<bool>,
}

/// The readings of one tile's sensors in a block.
#[derive(Clone, Copy, Debug)]
pub(super) struct BlockReadings {
    pub(super) means: [f32; 4],
    /// Lowest reading.
    pub(super) lows: [f32; 4],
    /// Highest less lowest reading.
    pub(super) spreads: [f32; 4],
    pub(super) ends: [RangeEnd; 4],
}

impl Averages {
    pub(super) fn new(tiles: usize) -> Self {
        Self {
            visits: [0; SHARES],
            sums: vec![[0.0; 4]; tiles],
            lows: vec![[0.0; 4]; tiles],
            highs: vec![[0.0; 4]; tiles],
            ends: vec![[RangeEnd::Within; 4]; tiles],
            is_whole: vec![true; tiles],
        }
    }

    /// Adds the readings and connection states of the sensors of `tiles`, which form `share`; returns true if their
    /// blocks are complete.
    pub(super) fn add(
        &mut self,
        share: usize,
        tiles: Range<usize>,
        forces: &[[f32; 4]],
        ends: &[[RangeEnd; 4]],
        connected: &[bool],
    ) -> bool {
        let (forces, ends) = (&forces[tiles.clone()], &ends[tiles.clone()]);
        let (sums, lows) = (&mut self.sums[tiles.clone()], &mut self.lows[tiles.clone()]);
        let (highs, block_ends) = (&mut self.highs[tiles.clone()], &mut self.ends[tiles.clone()]);
        let is_whole = &mut self.is_whole[tiles.clone()];
        let connected = &connected[tiles];
        if self.visits[share] == 0 {
            sums.fill([0.0; 4]);
            lows.copy_from_slice(forces);
            highs.copy_from_slice(forces);
            block_ends.copy_from_slice(ends);
            is_whole.fill(true);
        }
        add_forces(
            sums.as_flattened_mut(),
            lows.as_flattened_mut(),
            highs.as_flattened_mut(),
            forces.as_flattened(),
        );
        add_ends(block_ends.as_flattened_mut(), ends.as_flattened());
        is_whole.iter_mut().zip(connected).for_each(|(whole, connected)| *whole &= connected);
        self.visits[share] = (self.visits[share] + 1) % VISITS;
        self.visits[share] == 0
    }

    /// The readings of a tile's sensors in the complete block; `None` if they were not connected throughout.
    pub(super) fn block(&self, tile: usize) -> Option<BlockReadings> {
        let (lows, highs) = (self.lows[tile], self.highs[tile]);
        self.is_whole[tile].then(|| BlockReadings {
            means: self.sums[tile].map(|sum| sum / f32::from(VISITS)),
            lows,
            spreads: std::array::from_fn(|corner| highs[corner] - lows[corner]),
            ends: self.ends[tile],
        })
    }
}

/// Without branches, over plain numbers, compiled for each vector instruction set.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512bw+avx512dq", "x86_64+avx2", "aarch64+neon"))]
fn add_forces(sums: &mut [f32], lows: &mut [f32], highs: &mut [f32], forces: &[f32]) {
    for ((sum, force), (low, high)) in sums.iter_mut().zip(forces).zip(lows.iter_mut().zip(highs)) {
        *sum += force;
        *low = if force < low { *force } else { *low };
        *high = if force > high { *force } else { *high };
    }
}

/// Likewise.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512bw+avx512dq", "x86_64+avx2", "aarch64+neon"))]
fn add_ends(block: &mut [RangeEnd], ends: &[RangeEnd]) {
    for (kept, end) in block.iter_mut().zip(ends) {
        *kept = if *kept as u8 == RangeEnd::High as u8 { *kept } else { *end };
    }
}
