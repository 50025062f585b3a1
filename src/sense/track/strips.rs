//! Columns and rows of tiles: the observations of a group of feet.
//!
//! The division of a foot between two neighbouring columns depends only on its width eastwards, not on its northward
//! shape; and the moment of a whole column about an eastward axis shows the northward place of its load without any
//! patch model. The loads of a group's tiles are therefore summed by column and by row, and each sum depends on one
//! unknown half width only.

use super::params::associate::NOISE_ARM_M;
use std::f64::consts::FRAC_1_SQRT_2;

use arrayvec::ArrayVec;
use glam::DVec2;

use super::patch::Slice;
use super::state::{EAST, HALF_EAST, HALF_NORTH, NORTH};
use crate::sense::centroid::tile::LoadedTile;

/// Maximum number of columns and rows of one group that the filter observes.
pub(super) const MOST_STRIPS: usize = 24;

/// The axis along which strips are numbered: columns eastwards, rows northwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StripAxis {
    East,
    North,
}

impl StripAxis {
    pub(super) const BOTH: [Self; 2] = [Self::East, Self::North];

    /// Index in a foot's state of its centre along the axis.
    pub(super) fn place(self) -> usize {
        match self {
            Self::East => EAST,
            Self::North => NORTH,
        }
    }

    /// Index in a foot's state of its half width along the axis.
    pub(super) fn half(self) -> usize {
        match self {
            Self::East => HALF_EAST,
            Self::North => HALF_NORTH,
        }
    }

    /// Number of the column or row of `tile`.
    fn number(self, tile: &LoadedTile) -> i32 {
        match self {
            Self::East => tile.tile.column.into(),
            Self::North => tile.tile.row.into(),
        }
    }

    /// The component along the axis.
    pub(super) fn along(self, point: DVec2) -> f64 {
        match self {
            Self::East => point.x,
            Self::North => point.y,
        }
    }

    /// The component across the axis.
    pub(super) fn across(self, point: DVec2) -> f64 {
        match self {
            Self::East => point.y,
            Self::North => point.x,
        }
    }
}

/// The load of one column or row of tiles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Strip {
    pub axis: StripAxis,
    pub number: i32,
    pub force: f64,
    /// First moment along the axis about the strip's middle.
    pub moment: f64,
    /// First moment across the axis about the group's middle.
    pub cross: f64,
    /// Variance of each of the three due to sensor noise (N², N² m²).
    pub noise: [f64; 3],
}

impl Strip {
    /// A strip without load.
    pub(super) fn empty(axis: StripAxis, number: i32) -> Self {
        Self { axis, number, force: 0.0, moment: 0.0, cross: 0.0, noise: [0.0; 3] }
    }

    /// Its middle along the axis (m), in cells of size `pitch`.
    pub(super) fn middle(&self, pitch: DVec2) -> f64 {
        (f64::from(self.number) + 0.5) * self.axis.along(pitch)
    }

    /// The part on the strip of a patch with its middle at `c` and half width `h` along the axis.
    pub(super) fn slice(&self, pitch: DVec2, c: f64, h: f64) -> Slice {
        let pitch = self.axis.along(pitch);
        let low = f64::from(self.number) * pitch;
        Slice::new(low, low + pitch, c, h)
    }

    /// Whether the strip's edges divide no patch with its middle at `c` and a half width of at most `h`: all of the
    /// patch is on the strip, or none of it.
    pub(super) fn is_divided_by_none(&self, pitch: DVec2, c: f64, h: f64) -> bool {
        let pitch = self.axis.along(pitch);
        let low = f64::from(self.number) * pitch;
        let (low, high) = (low - c, low + pitch - c);
        low >= h || high <= -h || low <= -h && high >= h
    }

    /// Like [`Self::slice`], for a half width with a standard deviation of `sigma`.
    pub(super) fn slice_with_sigma(&self, pitch: DVec2, c: f64, h: f64, sigma: f64) -> Slice {
        let pitch = self.axis.along(pitch);
        let low = f64::from(self.number) * pitch;
        Slice::with_sigma(low, low + pitch, c, h, sigma)
    }
}

/// Standard deviation of the centroid of `tiles`, of `force` newtons together, due to sensors at the end of their
/// range or estimated from others (m); `side` is the usual distance between tiles.
pub(super) fn centroid_sigma<'a>(tiles: impl Iterator<Item = &'a LoadedTile>, force: f64, side: f64) -> f64 {
    let vague =
        tiles.flat_map(|tile| tile.extra_sigma).map(|vague| f64::from(vague * vague)).sum::<f64>().sqrt();
    // The sensors are about half a diagonal away from the load.
    FRAC_1_SQRT_2 * side * vague / force
}

/// The load of some tiles together.
pub(super) struct Whole {
    pub force: f64,
    /// Their centroid; NaN without force.
    pub middle: DVec2,
}

impl Whole {
    pub(super) fn of<'a>(tiles: impl Iterator<Item = &'a LoadedTile>) -> Self {
        let (mut force, mut sum) = (0.0, DVec2::ZERO);
        for tile in tiles {
            force += f64::from(tile.wrench.force);
            sum += tile.centroid.as_dvec2() * f64::from(tile.wrench.force);
        }
        Self { force, middle: sum / force }
    }
}

/// Variances of a group's force and moments due to sensor noise (N², N² m²).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct NoiseVariances {
    pub force: f64,
    pub east: f64,
    pub north: f64,
}

/// The columns and rows of some tiles.
#[derive(Clone, Debug, Default)]
pub(super) struct Strips {
    pub strips: ArrayVec<Strip, MOST_STRIPS>,
    /// Force of all the tiles.
    pub force: f64,
    /// Their centroid.
    pub middle: DVec2,
    /// Width and depth of a cell.
    pitch: DVec2,
}

impl Strips {
    /// Sums the loads of `tiles`; strips beyond [`MOST_STRIPS`] contribute to `force` and `middle` only.
    pub(super) fn of<'a>(tiles: impl Iterator<Item = &'a LoadedTile> + Clone, pitch: DVec2) -> Self {
        let mut sums = Self::about(&Whole::of(tiles.clone()), pitch);
        sums.add(tiles);
        sums
    }

    /// Starts without strips, for tiles that carry `whole` together. Adding in place avoids a copy.
    #[inline]
    pub(super) fn about(whole: &Whole, pitch: DVec2) -> Self {
        Self { strips: ArrayVec::new(), force: whole.force, middle: whole.middle, pitch }
    }

    /// Adds the loads of `tiles`.
    #[inline]
    pub(super) fn add<'a>(&mut self, tiles: impl Iterator<Item = &'a LoadedTile>) {
        for tile in tiles {
            let force = f64::from(tile.wrench.force);
            let at = tile.centroid.as_dvec2();
            for axis in StripAxis::BOTH {
                let number = axis.number(tile);
                let middle = (f64::from(number) + 0.5) * axis.along(self.pitch);
                let cross = axis.across(self.middle);
                if let Some(strip) = self.strip(axis, number) {
                    strip.force += force;
                    strip.moment += force * (axis.along(at) - middle);
                    strip.cross += force * (axis.across(at) - cross);
                }
            }
        }
    }

    /// Adds the variances of each strip due to the noise of the tiles' sensors.
    pub(super) fn add_noise<'a>(&mut self, tiles: impl Iterator<Item = &'a LoadedTile>) {
        for tile in tiles {
            let noise = tile.loaded_noise_n().powi(2);
            let [own, arm] = [4.0 * noise, NOISE_ARM_M * NOISE_ARM_M * noise];
            for axis in StripAxis::BOTH {
                let offset = axis.across(tile.centre.as_dvec2()) - axis.across(self.middle);
                if let Some(strip) = self.strip(axis, axis.number(tile)) {
                    strip.noise[0] += own;
                    strip.noise[1] += arm;
                    strip.noise[2] += own * offset * offset + arm;
                }
            }
        }
    }

    /// Variance of the total force and of its moments about the middle, due to sensor noise.
    pub(super) fn noise(&self) -> NoiseVariances {
        let mut noise = NoiseVariances::default();
        for strip in &self.strips {
            let [force, moment, _] = strip.noise;
            match strip.axis {
                StripAxis::East => {
                    noise.force += force;
                    noise.east += moment + force * (strip.middle(self.pitch) - self.middle.x).powi(2);
                }
                StripAxis::North => {
                    noise.north += moment + force * (strip.middle(self.pitch) - self.middle.y).powi(2);
                }
            }
        }
        noise
    }

    /// The strip `number`, created if there is room; `None` otherwise.
    pub(super) fn strip(&mut self, axis: StripAxis, number: i32) -> Option<&mut Strip> {
        let known = self.strips.iter().position(|strip| strip.axis == axis && strip.number == number);
        let position = match known {
            Some(position) => position,
            None => {
                self.strips.try_push(Strip::empty(axis, number)).ok()?;
                self.strips.len() - 1
            }
        };
        self.strips.get_mut(position)
    }
}

/// Difference between a foot's true division over a strip and that of its model patch.
///
/// Learnt while the foot stands alone, where the division is measured; in shares of the foot's force.
#[derive(Clone, Copy, Debug)]
pub(super) struct Residual {
    pub axis: StripAxis,
    pub number: i32,
    pub share: f64,
    pub moment: f64,
    pub cross: f64,
    pub seen: bool,
}

impl Residual {
    /// No difference from the model.
    pub(super) fn none(axis: StripAxis, number: i32) -> Self {
        Self { axis, number, share: 0.0, moment: 0.0, cross: 0.0, seen: false }
    }

    /// Moves by `weight` towards the difference `now` in share, moment and cross moment.
    pub(super) fn learn(&mut self, now: [f64; 3], weight: f64) {
        self.share += weight * (now[0] - self.share);
        self.moment += weight * (now[1] - self.moment);
        self.cross += weight * (now[2] - self.cross);
        self.seen = true;
    }
}
