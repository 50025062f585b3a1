//! Minimum, median and maximum forces over time.

use crate::floor::{Floor, TileId};
use crate::sense::{ForceFrame, Quality};
use crate::units::Newtons;

/// Minimum, median and maximum of a force over time.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct ForceRange {
    /// Minimum, in newtons.
    pub least_n: f32,
    /// Median, in newtons.
    pub median_n: f32,
    /// Maximum, in newtons.
    pub greatest_n: f32,
}

/// Forces on one tile and its sensors over time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TileRange {
    /// The tile.
    pub tile: TileId,
    /// The whole tile.
    pub force: ForceRange,
    /// Its sensors, in [`crate::floor::Corner::ALL`] order.
    pub sensors: [ForceRange; 4],
    /// The worst quality of any of its values.
    pub quality: Quality,
}

/// Records forces over time, for the choice of thresholds on site.
///
/// Forces are corrected by the floor's position maps, as for controls. The extremes are exact; the median is that of
/// at most 1024 moments, evenly spread over the time.
#[derive(Clone, Debug)]
pub struct ForceWatch {
    floor: Floor,
    tiles: Vec<[Spread; 5]>,
    quality: Vec<Quality>,
    frames: u64,
    /// One of `stride` frames is kept for the medians.
    stride: u64,
}

/// Extremes and kept values of one force.
#[derive(Clone, Debug)]
struct Spread {
    least: f32,
    greatest: f32,
    kept: Vec<f32>,
}

/// Maximum number of moments for the medians.
const MOMENTS: usize = 1024;

impl ForceWatch {
    /// A watch over `floor` without any frames yet.
    #[must_use]
    pub fn new(floor: &Floor) -> Self {
        let nothing = Spread { least: f32::INFINITY, greatest: f32::NEG_INFINITY, kept: Vec::new() };
        let tiles = floor.geometry.tile_count();
        Self {
            floor: floor.clone(),
            tiles: vec![std::array::from_fn(|_| nothing.clone()); tiles],
            quality: vec![Quality::Live; tiles],
            frames: 0,
            stride: 1,
        }
    }

    /// Returns the number of frames so far.
    #[must_use]
    pub const fn frames(&self) -> u64 {
        self.frames
    }

    /// Adds one frame; ignores tiles without a usable value.
    pub fn take(&mut self, frame: &ForceFrame) {
        let keep = self.frames.is_multiple_of(self.stride);
        self.frames += 1;
        let values = frame.forces.iter().zip(&frame.quality).zip(&self.floor.position_maps);
        let watched = self.tiles.iter_mut().zip(&mut self.quality);
        for (((corners, quality), map), (spreads, worst)) in values.zip(watched) {
            let of_tile = quality.iter().copied().max().unwrap_or_default();
            *worst = (*worst).max(of_tile);
            if of_tile >= Quality::Stale {
                continue;
            }
            let corners = map.as_ref().map_or(*corners, |map| map.trimmed(*corners));
            let [whole, sensors @ ..] = spreads;
            whole.take(corners.iter().sum(), keep);
            for (spread, force) in sensors.iter_mut().zip(corners) {
                spread.take(force, keep);
            }
        }
        if keep && self.frames.div_ceil(self.stride) >= MOMENTS as u64 {
            // Keep every other moment; from now on the moments lie twice as far apart.
            self.stride *= 2;
            for spread in self.tiles.iter_mut().flatten() {
                let mut number = 0;
                spread.kept.retain(|_| {
                    number += 1;
                    number % 2 == 1
                });
            }
        }
    }

    /// Returns the tile with the greatest force in the last kept moment, and that force.
    #[must_use]
    pub fn heaviest(&self) -> Option<(TileId, Newtons)> {
        let now = |spreads: &[Spread; 5]| spreads[0].kept.last().copied().unwrap_or(0.0);
        let (index, force) = self.tiles.iter().map(now).enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
        Some((self.floor.geometry.tile_at_index(index), Newtons(force)))
    }

    /// Returns the forces on each tile in tile-index order; zero for a tile that never had a usable value.
    pub fn ranges(&self) -> impl Iterator<Item = TileRange> + '_ {
        let tiles = self.floor.geometry.tiles().zip(self.tiles.iter().zip(&self.quality));
        tiles.map(|(tile, (spreads, quality))| TileRange {
            tile,
            force: spreads[0].range(),
            sensors: std::array::from_fn(|corner| spreads[corner + 1].range()),
            quality: *quality,
        })
    }
}

impl Spread {
    fn take(&mut self, force: f32, keep: bool) {
        self.least = self.least.min(force);
        self.greatest = self.greatest.max(force);
        if keep {
            self.kept.push(force);
        }
    }

    fn range(&self) -> ForceRange {
        let mut kept = self.kept.clone();
        kept.sort_by(f32::total_cmp);
        match kept.get(kept.len() / 2) {
            Some(&median_n) => ForceRange { least_n: self.least, median_n, greatest_n: self.greatest },
            None => ForceRange::default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::floor::Geometry;

    #[test]
    fn extremes_are_exact_and_medians_close_however_long_it_takes() {
        let floor = Floor::of(Geometry::of_paper_tiles(2, 1).unwrap());
        for frames in [1_u16, 10, 1023, 1024, 5000, 60_000] {
            let mut watch = ForceWatch::new(&floor);
            let mut frame = ForceFrame::empty(&floor.geometry);
            for step in 0..frames {
                // A ramp up to 100 N on one sensor.
                frame.forces[1] = [0.0, 100.0 * f32::from(step + 1) / f32::from(frames), 0.0, 0.0];
                watch.take(&frame);
            }
            let range = watch.ranges().nth(1).unwrap();
            assert_eq!(range.force, range.sensors[1]);
            assert_eq!(range.force.greatest_n, 100.0);
            assert_eq!(range.force.least_n, 100.0 / f32::from(frames));
            let off = (range.force.median_n - 50.0).abs();
            // The upper of the two middle steps of the ramp, at most one step of the kept moments away.
            assert!(off <= 110.0 / f32::from(frames.min(500)), "{off} after {frames}");
            assert!(watch.tiles[1][0].kept.len() <= MOMENTS);
        }
    }

    #[test]
    fn what_cannot_be_trusted_is_not_measured_but_said() {
        let floor = Floor::of(Geometry::of_paper_tiles(1, 1).unwrap());
        let mut watch = ForceWatch::new(&floor);
        let mut frame = ForceFrame::empty(&floor.geometry);
        frame.forces[0] = [5.0; 4];
        watch.take(&frame);
        frame.forces[0] = [500.0; 4];
        frame.quality[0][2] = Quality::Stale;
        watch.take(&frame);
        let range = watch.ranges().next().unwrap();
        assert_eq!((range.force.greatest_n, range.quality), (20.0, Quality::Stale));
    }
}
