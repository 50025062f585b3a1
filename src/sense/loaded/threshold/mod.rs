//! Thresholds above which tiles count as loaded, adapted to their noise and their recent load.
//!
//! - **Noise floor.** While a tile is idle, the differences between readings [`VISIT_S`] apart give the standard
//!   deviation of the sum of its sensors. An offset or a slow drift is not noise, and outliers are clipped. Where the
//!   noise approaches the threshold, the deciding force (and only that one) is smoothed, as much as necessary and
//!   over [`SMOOTH_S`] at most; the remaining noise raises the threshold.
//! - **Residual load.** Force-sensing resistors creep, and release a load as slowly as it came: the possible
//!   remainder of a tile's recent load raises its thresholds, and decays with it.
//!
//! A quiet tile without recent load keeps the thresholds of [`LoadThreshold`].

use super::{BLOCK, LoadThreshold, NONE};
use crate::sense::centroid::tile::FULL_WEIGHT;
use crate::units::Newtons;

/// Interval between updates of a tile's noise and residual load (s).
///
/// It samples the mains' 50 and 60 Hz well: two visits are about half a cycle apart.
const VISIT_S: f32 = 0.012;

/// Number of consecutive visits after which a loaded tile carries a foot: hum that crosses the threshold does not
/// stay above it.
const SETTLED: u32 = 2;

/// Maximum time between two readings whose difference counts as noise (s).
const GAP_S: f32 = 0.5;

/// Number of standard deviations above which an idle tile counts as loaded: of 36 tiles with 200 independent readings
/// a second, one in three minutes exceeds it (normal distribution).
const DEVIATIONS: f32 = 4.9;

/// Mean absolute difference of two independent readings, in standard deviations of one (normal distribution: 2 / sqrt
/// pi).
const DIFFERENCE: f32 = 1.128;

/// Clipping limit of differences, in means, and its minimum (N) (M-estimate of scale; 3.5 means are 2.8 standard
/// deviations).
const CLIP: f32 = 3.5;
const CLIP_LEAST_N: f32 = 0.5;

/// Number of visits in the noise average once it is known, about 1.5 s, and initial weight of the first frame.
const VISITS: f32 = 128.0;
const FIRST_VISITS: f32 = 8.0;

/// Number of frames with a reading of an idle tile after which a table shows its noise: eight visits at 1 kHz.
const KNOWN_FRAMES: u32 = 100;

/// Maximum time constant of the smoothed deciding force (s): it delays the detection of a foot by as much.
const SMOOTH_S: f32 = 0.008;

/// Maximum threshold due to noise (N): a foot is detected at any noise level (our choice).
const MOST_N: f32 = 40.0;

/// Number of standard deviations by which the minimum of some hundred readings lies below their mean (normal
/// distribution: 2.5 of a hundred, 3.2 of a thousand).
const DEPTH: f32 = 3.0;

/// Time for which a tile with a possibly residual load stays loaded (s): it covers a foot that leaves by its toes
/// (recorded steps lose their last tenth of weight within 20 to 40 ms).
const HOLD_S: f32 = 0.03;

/// Time constants of the load averages (s), a decade apart as creep is specified.
const TIMES_S: [f32; 4] = [0.1, 1.0, 10.0, 100.0];

/// Creep of a force-sensing resistor, as a share of its load for each decade of time (maker's figure: 5 %).
const CREEP: f32 = 0.055;

/// Residual load too small to track (N).
const NOTHING_N: f32 = 0.2;

/// The thresholds of each tile, in tile-index order.
#[derive(Clone, Debug)]
pub(super) struct LoadThresholds {
    base: LoadThreshold,
    /// Mean absolute difference of each tile's readings at two consecutive visits, idle at both (N).
    differences: Vec<f32>,
    /// Reading at the last visit; NaN if the tile was not idle.
    read: Vec<f32>,
    /// Number of consecutive visits at which it was loaded; short for an idle tile.
    loaded: Vec<u32>,
    /// Blocks with a noisy tile.
    noisy: Vec<bool>,
    is_any_noisy: bool,
    /// Whether a tile without load may have no reading, as in a table that leaves it out.
    skips_zeros: bool,
    /// The same for the smoothed force of noisy tiles, and that force.
    smoothed_differences: Vec<f32>,
    smoothed_read: Vec<f32>,
    smoothed: Vec<f32>,
    /// Smoothing gain.
    gains: Vec<f32>,
    tiles: Vec<TileThreshold>,
    memories: Vec<[f32; TIMES_S.len()]>,
    /// Tiles with a load average.
    with_memory: Vec<u32>,
    /// Time since the last visit (s).
    since_s: f32,
    visits: f32,
    /// The last time between two visits, and the gain of each load average over it.
    parts: (f32, [f32; TIMES_S.len()]),
}

/// Threshold state of one tile.
#[derive(Clone, Copy, Debug)]
struct TileThreshold {
    /// Threshold due to noise (N).
    on: f32,
    /// Possible remainder of its recent load (N).
    residual: f32,
    /// Minimum reading since it was last clearly loaded: the remainder of that load cannot exceed it, except for
    /// noise.
    lowest: f32,
    /// Time for which it has been loaded with no more than the possible remainder of its recent load (s).
    left_s: f32,
}

impl TileThreshold {
    /// Possible remainder of its recent load, limited by the minimum reading since (N).
    fn left(&self, is_noisy: bool) -> f32 {
        let depth = if is_noisy { DEPTH / DEVIATIONS * self.on } else { 0.0 };
        // Neither is NaN, so a comparison suffices.
        let most = self.lowest + depth;
        if self.residual < most { self.residual } else { most }
    }

    /// Notes that it is not loaded at the reading `sum`.
    fn note_low(&mut self, sum: f32) {
        self.lowest = self.lowest.min(sum.max(0.0));
    }
}

impl LoadThresholds {
    pub(super) fn new(tiles: usize, base: LoadThreshold) -> Self {
        Self {
            base,
            differences: vec![0.0; tiles],
            read: vec![f32::NAN; tiles],
            loaded: vec![0; tiles],
            noisy: vec![false; tiles.div_ceil(BLOCK)],
            is_any_noisy: false,
            skips_zeros: false,
            smoothed_differences: vec![0.0; tiles],
            smoothed_read: vec![f32::NAN; tiles],
            smoothed: vec![0.0; tiles],
            gains: vec![1.0; tiles],
            tiles: vec![
                TileThreshold { on: base.on.0, residual: 0.0, lowest: f32::INFINITY, left_s: 0.0 };
                tiles
            ],
            memories: vec![Default::default(); tiles],
            with_memory: Vec::with_capacity(tiles),
            since_s: 0.0,
            visits: 0.0,
            parts: (0.0, [0.0; TIMES_S.len()]),
        }
    }

    /// Minimum of all tiles' thresholds.
    pub(super) const fn least(&self) -> f32 {
        self.base.off.0
    }

    /// Threshold in this frame of the tile at `index` with the reading `sum`, `dt` seconds after the last frame.
    ///
    /// Where the smoothed force decides, it is either the smallest load that can be located, or infinite.
    #[inline]
    pub(super) fn least_of(&mut self, index: usize, sum: f32, was_loaded: bool, dt: f32) -> Newtons {
        let LoadThreshold { on, off } = self.base;
        let is_noisy = self.is_noisy(index / BLOCK);
        let decides = if is_noisy { self.smoothed[index] } else { sum };
        let tile = &mut self.tiles[index];
        let residual = tile.left(is_noisy);
        let least = if was_loaded { tile.on * (off.0 / on.0) } else { tile.on };
        let is_left = decides < least + residual;
        if decides >= least + tile.residual {
            tile.lowest = f32::INFINITY;
        } else if is_left {
            tile.note_low(decides);
        }
        tile.left_s = if was_loaded && is_left { tile.left_s + dt } else { 0.0 };
        let is_held = was_loaded && tile.left_s < HOLD_S;
        let least = if is_held { least } else { least + residual };
        Newtons(match is_noisy {
            false => least,
            true if decides >= least => FULL_WEIGHT,
            true => f32::INFINITY,
        })
    }

    /// Notes the reading `sum` of the tile at `index`, which was loaded. If it is below the threshold, the possible
    /// remainder of the last load decreases and does not grow again.
    pub(super) fn note(&mut self, index: usize, sum: f32) {
        if sum < self.least() {
            self.tiles[index].note_low(sum);
        }
    }

    /// Whether some tile of a block is noisy, so that [`Self::deciding`] applies.
    pub(super) fn is_noisy(&self, block: usize) -> bool {
        self.is_any_noisy && self.noisy[block]
    }

    /// The force that decides whether the tile at `index` with the reading `sum` is loaded.
    pub(super) fn deciding(&self, index: usize, sum: f32) -> f32 {
        if self.is_noisy(index / BLOCK) { self.smoothed[index] } else { sum }
    }

    /// Part of the deciding force of the tile at `index` that may be noise or a remainder of its recent load (N).
    pub(super) fn unsure(&self, index: usize) -> f32 {
        let is_noisy = self.is_noisy(index / BLOCK);
        let tile = &self.tiles[index];
        let noise = if is_noisy { 0.5 * tile.on } else { 0.0 };
        noise + tile.left(is_noisy)
    }

    /// Estimated remainder of a recent load on the loaded tile at `index`, which carries `force` (N): all of its
    /// residual load as long as that alone would keep it loaded, none above twice as much.
    pub(super) fn left_n(&self, index: usize, force: f32) -> f32 {
        let tile = &self.tiles[index];
        let residual = tile.left(self.is_noisy(index / BLOCK));
        residual * (2.0 - force / (tile.on + residual)).clamp(0.0, 1.0)
    }

    /// Standard deviation of the noise of each sensor of the tile at `index`, in newtons.
    pub(super) fn noise_n(&self, index: usize) -> f32 {
        if self.is_any_noisy { 0.5 / DIFFERENCE * self.differences[index] } else { 0.0 }
    }

    /// Initialises the noise from the first frame, unless it is known already: only the disagreement of each plate's
    /// corners is known.
    pub(super) fn begin(&mut self, forces: &[[f32; 4]]) {
        if self.visits == 0.0 {
            // No load twists a rigid plate much; at least half of the tiles are similar.
            self.begin_from(forces.iter());
        }
    }

    /// Learns the noise of each tile from a table's first `frames`, of which each has the seconds since the last one, the
    /// sums of its tiles and their forces. A tile without a reading while idle takes the median of the others.
    pub(super) fn learn<'a>(&mut self, frames: impl Iterator<Item = (f32, &'a [f32], &'a [[f32; 4]])>) {
        self.skips_zeros = true;
        let tiles = self.differences.len();
        let (mut place, mut idle) = (vec![NONE; tiles], vec![0_u32; tiles]);
        for (dt, sums, forces) in frames {
            let on = self.base.on.0;
            if self.visits == 0.0 {
                let is_idle = |forces: &&[f32; 4]| **forces != [0.0; 4] && forces.iter().sum::<f32>() < on;
                self.begin_from(forces.iter().filter(is_idle));
            }
            self.smooth(sums);
            for (index, place) in place.iter_mut().enumerate() {
                let sum = sums.get(index).copied().unwrap_or_default();
                let is_loaded = self.deciding(index, sum) >= self.tiles[index].on;
                *place = if is_loaded { 0 } else { NONE };
                idle[index] += u32::from(!is_loaded && sum != 0.0);
            }
            self.visit(sums, &place, std::iter::empty(), dt);
        }
        let known = |count: &u32| *count >= KNOWN_FRAMES;
        let mut learnt: Vec<f32> = idle
            .iter()
            .zip(&self.differences)
            .filter(|(count, _)| known(count))
            .map(|(_, noise)| *noise)
            .collect();
        if let Some(middle) = learnt.len().checked_sub(1).map(|last| last / 2) {
            let median = *learnt.select_nth_unstable_by(middle, f32::total_cmp).1;
            let unknown = idle.iter().zip(&mut self.differences).filter(|(count, _)| !known(count));
            unknown.for_each(|(_, noise)| *noise = median);
        }
        self.loaded.fill(0);
        self.read.fill(f32::NAN);
        self.smoothed_read.fill(f32::NAN);
        self.smoothed.fill(0.0);
        self.find_noisy(0.0, 0.0);
    }

    /// Initialises the noise from the disagreement of these plates' corners.
    fn begin_from<'a>(&mut self, forces: impl Iterator<Item = &'a [f32; 4]>) {
        self.read.clear();
        self.read.extend(forces.map(|[sw, se, nw, ne]| (sw - se - nw + ne).abs()));
        self.read.retain(|twist| twist.is_finite());
        let middle = self.read.len() / 2;
        let median = if self.read.is_empty() {
            0.0
        } else {
            *self.read.select_nth_unstable_by(middle, f32::total_cmp).1
        };
        // The median of a normal distribution's absolute values is 0.6745 standard deviations.
        let difference = (DIFFERENCE * median / 0.6745).min(MOST_N / DEVIATIONS);
        self.differences.fill(difference);
        let tiles = self.differences.len();
        self.read.clear();
        self.read.resize(tiles, f32::NAN);
        self.visits = FIRST_VISITS;
        self.find_noisy(0.0, 0.0);
    }

    /// Smooths the deciding force s of noisy tiles with a frame's readings x: s += gain (x − s).
    pub(super) fn smooth(&mut self, sums: &[f32]) {
        if !self.is_any_noisy {
            return;
        }
        let tiles = self.smoothed.chunks_mut(BLOCK).zip(self.gains.chunks(BLOCK)).zip(sums.chunks(BLOCK));
        for (((smoothed, gains), sums), _) in tiles.zip(&self.noisy).filter(|(_, noisy)| **noisy) {
            for ((smoothed, gain), sum) in smoothed.iter_mut().zip(gains).zip(sums) {
                if sum.is_finite() {
                    *smoothed += gain * (sum - *smoothed);
                }
            }
        }
    }

    /// Updates noise and residual load, `dt` seconds after the last frame, at each visit; `place` marks the loaded
    /// tiles.
    pub(super) fn visit(&mut self, sums: &[f32], place: &[u32], list: impl Iterator<Item = u32>, dt: f32) {
        self.since_s += dt;
        if self.since_s < VISIT_S - 0.5 * dt.min(VISIT_S) && self.visits > FIRST_VISITS {
            return;
        }
        let elapsed = std::mem::take(&mut self.since_s);
        if elapsed > GAP_S {
            self.read.fill(f32::NAN);
            self.smoothed_read.fill(f32::NAN);
        }
        self.visits = (self.visits + 1.0).min(VISITS);
        self.remember(sums, list, elapsed);
        let share = 1.0 / self.visits;
        for (loaded, &place) in self.loaded.iter_mut().zip(place) {
            *loaded = if place == NONE { 0 } else { (*loaded + 1).min(SETTLED) };
        }
        follow(&mut self.differences, &mut self.read, sums, &self.loaded, share, self.skips_zeros);
        self.find_noisy(dt, share);
    }

    fn find_noisy(&mut self, dt: f32, share: f32) {
        let limit = DIFFERENCE * self.base.on.0 / DEVIATIONS;
        self.is_any_noisy = false;
        for block in 0..self.noisy.len() {
            let from = block * BLOCK;
            let upto = (from + BLOCK).min(self.differences.len());
            let is_noisy =
                self.differences[from..upto].iter().fold(false, |is, &difference| is | (difference > limit));
            let was_noisy = std::mem::replace(&mut self.noisy[block], is_noisy);
            self.is_any_noisy |= is_noisy;
            if !is_noisy {
                if was_noisy {
                    self.tiles[from..upto].iter_mut().for_each(|tile| tile.on = self.base.on.0);
                }
                continue;
            }
            if !was_noisy {
                self.smoothed[from..upto].fill(0.0);
                self.smoothed_read[from..upto].fill(f32::NAN);
            }
            for index in from..upto {
                // White noise decreases by this factor; other noise, such as hum, is measured.
                let q = (limit / self.differences[index].max(f32::MIN_POSITIVE)).powi(2);
                let gain = (2.0 * q / (1.0 + q)).clamp(1.0 - (-dt / SMOOTH_S).exp(), 1.0);
                self.gains[index] = gain;
                let white = self.differences[index] * (gain / (2.0 - gain)).sqrt();
                if !was_noisy {
                    self.smoothed_differences[index] = white;
                }
            }
            let range = from..upto;
            follow(
                &mut self.smoothed_differences[range.clone()],
                &mut self.smoothed_read[range.clone()],
                &self.smoothed[range.clone()],
                &self.loaded[range.clone()],
                share,
                self.skips_zeros,
            );
            for index in range {
                let noise = DEVIATIONS / DIFFERENCE * self.smoothed_differences[index];
                self.tiles[index].on = noise.clamp(self.base.on.0, MOST_N.max(self.base.on.0));
            }
        }
    }

    /// Updates the load averages over the last `elapsed` seconds: m += (1 − exp(−elapsed/τ)) (sum − m).
    fn remember(&mut self, sums: &[f32], list: impl Iterator<Item = u32>, elapsed: f32) {
        if self.parts.0 != elapsed {
            self.parts = (elapsed, TIMES_S.map(|time_s| 1.0 - (-elapsed / time_s).exp()));
        }
        let Self { memories, tiles, with_memory, parts, .. } = self;
        for index in list {
            let residual = &mut tiles[index as usize].residual;
            if *residual == 0.0 {
                // A tiny value marks it as tracked.
                *residual = f32::MIN_POSITIVE;
                with_memory.push(index);
            }
        }
        with_memory.retain(|&index| {
            let index = index as usize;
            let sum = if sums[index].is_finite() { sums[index].clamp(0.0, 1e6) } else { 0.0 };
            for (memory, part) in memories[index].iter_mut().zip(parts.1) {
                *memory += part * (sum - *memory);
            }
            let left = CREEP * memories[index].iter().sum::<f32>();
            let stays = left > NOTHING_N || sum > NOTHING_N;
            tiles[index].residual = if stays { left.max(f32::MIN_POSITIVE) } else { 0.0 };
            if !stays {
                memories[index] = Default::default();
            }
            stays
        });
    }
}

/// Updates the mean with the difference of each idle tile's reading from its last one: mean += `share` (difference −
/// mean). With `skips_zeros`, a sum of exactly zero is no reading.
///
/// Without branches, over plain arrays.
fn follow(
    differences: &mut [f32],
    read: &mut [f32],
    now: &[f32],
    loaded: &[u32],
    share: f32,
    skips_zeros: bool,
) {
    let tiles = differences.iter_mut().zip(read).zip(now.iter().zip(loaded));
    for ((mean, read), (&now, &loaded)) in tiles {
        let is_read = (loaded < SETTLED) & ((now != 0.0) | !skips_zeros);
        let now = if is_read { now } else { f32::NAN };
        let difference = (now - *read).abs();
        let clipped = difference.min((CLIP * *mean).max(CLIP_LEAST_N));
        *mean = if difference.is_nan() { *mean } else { *mean + share * (clipped - *mean) };
        *read = now;
    }
}

#[cfg(test)]
mod tests;
