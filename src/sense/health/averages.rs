//! What the sensors of all tiles read on average, from least to most, over 64 ms: many added side by side.

use std::ops::Range;

use multiversion::multiversion;

use super::End;

/// Every how many frames a tile is visited.
pub(super) const SHARES: usize = 8;

/// Visits averaged into one block: 64 ms.
const VISITS: u8 = 8;

/// The blocks of all tiles that are under way. Those of one share of the floor begin and end together.
#[derive(Clone, Debug)]
pub(super) struct Averages {
    /// How often each share has been visited for its block.
    visits: [u8; SHARES],
    sums: Vec<[f32; 4]>,
    lows: Vec<[f32; 4]>,
    highs: Vec<[f32; 4]>,
    /// The end of its converter that each sensor was at last; the high one if it ever was there.
    ends: Vec<[End; 4]>,
    /// Whether each tile's sensors were all connected at every visit.
    is_whole: Vec<bool>,
}

/// What one tile's sensors have read in a block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Readings {
    pub(super) means: [f32; 4],
    /// Lowest reading.
    pub(super) lows: [f32; 4],
    /// Highest less lowest reading.
    pub(super) spreads: [f32; 4],
    pub(super) ends: [End; 4],
}

impl Averages {
    pub(super) fn new(tiles: usize) -> Self {
        Self {
            visits: [0; SHARES],
            sums: vec![[0.0; 4]; tiles],
            lows: vec![[0.0; 4]; tiles],
            highs: vec![[0.0; 4]; tiles],
            ends: vec![[End::Within; 4]; tiles],
            is_whole: vec![true; tiles],
        }
    }

    /// Adds what the sensors of all tiles read, of which those of `share` are `tiles`, and which tiles are connected;
    /// true if the blocks of these are complete.
    pub(super) fn add(
        &mut self,
        share: usize,
        tiles: Range<usize>,
        forces: &[[f32; 4]],
        ends: &[[End; 4]],
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

    /// What a tile's sensors have read in the block that is complete; `None` if they were not connected throughout.
    pub(super) fn block(&self, tile: usize) -> Option<Readings> {
        let (lows, highs) = (self.lows[tile], self.highs[tile]);
        self.is_whole[tile].then(|| Readings {
            means: self.sums[tile].map(|sum| sum / f32::from(VISITS)),
            lows,
            spreads: std::array::from_fn(|corner| highs[corner] - lows[corner]),
            ends: self.ends[tile],
        })
    }
}

/// Without branches, over plain numbers: compiled for what the processor offers.
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
fn add_ends(block: &mut [End], ends: &[End]) {
    for (kept, end) in block.iter_mut().zip(ends) {
        *kept = if *kept as u8 == End::High as u8 { *kept } else { *end };
    }
}
