//! The force and the centroid of one tile.

use glam::Vec2;

use super::Quality;
use super::corners::{self, known_corners};
use crate::floor::{Geometry, PositionMap, TileId};
use crate::units::Newtons;

/// What one tile feels as a whole.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TileReading {
    /// Sum of its four sensors.
    pub force: Newtons,
    /// Where its load acts, in floor metres; `None` where it is too light to
    /// tell, or too few sensors are known.
    pub centroid: Option<Vec2>,
    /// How far both can be trusted.
    pub quality: Quality,
}

/// Force and moment of one tile, the whole of what four corner sensors under a rigid plate can say.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    /// Total force F, in newtons.
    pub force: f32,
    /// First moment of the load about the tile's centre, Σ fᵢ (xᵢ − x_p), in newton metres:
    /// east component for positions east of the centre, north for north.
    pub moment: Vec2,
}

impl TileReading {
    /// An empty tile with four live sensors.
    #[must_use]
    pub const fn live() -> Self {
        Self { force: Newtons::ZERO, centroid: None, quality: Quality::Live }
    }
}

impl Wrench {
    /// The wrench of a tile whose sensors, `reach_m` from its centre along both axes, read
    /// `corners` (sw, se, nw, ne).
    ///
    /// # Source
    /// F = Σ fᵢ, F x_c = Σ fᵢ xᵢ over the four sensors (paper, Eq. 2-3). The plate's
    /// own load f_p has been taken off sensor by sensor by the tare, which is the same thing.
    #[must_use]
    pub fn of_corners([sw, se, nw, ne]: [f32; 4], reach_m: f32) -> Self {
        Self {
            force: (sw + se) + (nw + ne),
            moment: Vec2::new((se - sw) + (ne - nw), (nw - sw) + (ne - se)) * reach_m,
        }
    }

    /// Where the load acts relative to the tile's centre, kept on the plate of half side `half_m`.
    ///
    /// Noise may put the quotient beyond the plate, where no load can be.
    /// Meaningless for a force of zero or less.
    #[must_use]
    pub fn arm(&self, half_m: f32) -> Vec2 {
        (self.moment / self.force).clamp(Vec2::splat(-half_m), Vec2::splat(half_m))
    }
}

/// One tile with a load on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadedTile {
    /// Which tile.
    pub tile: TileId,
    /// Its place in tile-index order.
    pub index: u32,
    /// Its centre, in floor metres.
    pub centre: Vec2,
    /// What its sensors read, in [`crate::floor::Corner::ALL`] order, one unknown filled in.
    pub corners: [f32; 4],
    /// Its force and moment; the force is positive.
    pub wrench: Wrench,
    /// Standard deviation of each of `corners` beyond what is unknown of any sensor, in newtons:
    /// zero but for one that is estimated from the others, at the end of its range, or contradicted by the others.
    pub extra_sigma: [f32; 4],
    /// Standard deviation of the white noise of each of `corners`, in newtons, as measured while the tile was idle;
    /// zero on a floor on which it is too small to matter.
    pub noise_n: f32,
    /// How much of `wrench` is taken to be left by a recent load, in newtons; 0 under heavy loads.
    pub left_n: f32,
    /// Where the load acts, in floor metres: on the tile's plate, or up to a few centimetres beside it
    /// if part of the load lies on tiles around it that are too light to count themselves.
    pub centroid: Vec2,
    /// [`Quality::Live`], or [`Quality::Degraded`] with a sensor estimated or suspect.
    pub quality: Quality,
    /// What the force counts for in a centroid over several tiles.
    weight: f32,
    /// Standard deviation of the position along each axis that the tile's map leaves, in metres; `None` without a map.
    mapped_m: Option<f32>,
    /// What the zeros of tiles that the load strays to add to a moment's variance, per variance of a sensor's zero:
    /// four times the squared distance from the centroid, in square metres.
    strayed_m2: f32,
    /// Which sensors are estimated from the others, one bit each.
    lost: u8,
    /// What is left in `corners` of what sensors read before they were lost or found again.
    lag: [f32; 4],
    /// What of the force lies on tiles around this one that are too light to be listed themselves.
    strayed: f32,
}

/// Noise of a loaded sensor, as a share of what it carries: a force that grows by `exp(1.34 v)` makes 0.3 to 1.3 % of
/// the 2 to 10 mV of its converter (the paper's parts). It is not seen while a tile is idle, and part of the gain where
/// uncertainty is told. With twice as much, two feet close together are told apart later.
const LOADED_NOISE: f64 = 0.01;

/// Below this force a tile counts for nothing in a centroid, from the other one on in full, in newtons (our
/// choice: two and eight deviations of what four sensors add up to on an empty floor whose zeros were followed).
pub(super) const NO_WEIGHT: f32 = 0.5;
pub(super) const FULL_WEIGHT: f32 = 2.0;

/// What `force` on one tile counts for in a centroid over several.
///
/// Between nothing and all there is no jump, so that a foot sliding over a seam gains its next tile gradually.
pub(super) fn counted(force: f32) -> f32 {
    // Most loads count in full, and need no division.
    if force >= FULL_WEIGHT {
        return force;
    }
    force * ((force - NO_WEIGHT) / (FULL_WEIGHT - NO_WEIGHT)).clamp(0.0, 1.0)
}

/// The 95th percentile of a distance in the plane over its standard deviation along each axis.
const P95_PER_DEVIATION: f32 = 2.4477;

/// How a tile gets from what a sensor read to what the others say of it, or back, without a jump of its
/// centroid that could be taken for another foot.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Lag {
    /// Sensors that are estimated now, one bit each.
    lost: u8,
    /// What the tile's sensors read before, the last lag, and which sensors were estimated then.
    before: Option<([f32; 4], [f32; 4], u8)>,
    /// What is left of the last lag.
    fade: f32,
}

/// How long the way from one to the other takes, in seconds (e-fold; our choice: a slow shift of weight).
const LAG_S: f32 = 0.08;

/// Lag that is over, in newtons.
const NO_LAG_N: f32 = 0.05;

impl Lag {
    /// The lag of a tile whose sensors have `quality`, `dt` seconds after it was as `before`.
    pub(super) fn new(quality: [Quality; 4], before: Option<&LoadedTile>, dt: f32) -> Self {
        let bit = |(corner, quality): (usize, Quality)| u8::from(quality >= Quality::Stale) << corner;
        let lost = quality.into_iter().enumerate().map(bit).sum();
        let before = before.filter(|tile| tile.lost != lost || !tile.is_settled());
        Self {
            lost,
            before: before.map(|tile| (tile.corners, tile.lag, tile.lost)),
            fade: before.map_or(0.0, |_| (-dt / LAG_S).exp()),
        }
    }

    /// What to add to `corners`.
    fn of(&self, corners: [f32; 4]) -> [f32; 4] {
        let Some((read, lag, lost)) = self.before else { return [0.0; 4] };
        std::array::from_fn(|corner| {
            let has_changed = (self.lost ^ lost) >> corner & 1 == 1;
            let lag = if has_changed { read[corner] - corners[corner] } else { lag[corner] };
            let left = lag * self.fade;
            if left.abs() > NO_LAG_N { left } else { 0.0 }
        })
    }
}

impl LoadedTile {
    /// What the tile's force counts for in a centroid over several tiles.
    pub(super) fn weight(&self) -> f32 {
        self.weight
    }

    /// What its map leaves along each axis, in metres (standard deviation); `None` without one.
    pub(super) fn mapped_m(&self) -> Option<f32> {
        self.mapped_m
    }

    /// Standard deviation of the noise of each of its sensors under this load, in newtons.
    pub(super) fn loaded_noise_n(&self) -> f64 {
        let under_load = LOADED_NOISE * 0.25 * f64::from(self.wrench.force);
        // As on most floors: not worth a square root.
        if self.noise_n == 0.0 { under_load.abs() } else { f64::from(self.noise_n).hypot(under_load) }
    }

    pub(super) fn strayed_m2(&self) -> f32 {
        self.strayed_m2
    }

    /// What the tile itself feels.
    pub(super) fn reading(&self, geometry: &Geometry) -> TileReading {
        let half = Vec2::splat(0.5 * geometry.pitch_m());
        TileReading {
            force: Newtons(self.wrench.force - self.strayed),
            centroid: Some(self.centroid.clamp(self.centre - half, self.centre + half)),
            quality: self.quality,
        }
    }

    /// Adds `force` at `point` of a tile around this one that is too light to be listed itself.
    pub(super) fn add_strayed(&mut self, force: f32, point: Vec2) {
        self.weight += force;
        self.strayed += force;
        self.strayed_m2 += 4.0 * point.distance_squared(self.centroid);
        self.centroid += (point - self.centroid) * (force / self.weight);
        self.wrench.force += force;
        self.wrench.moment = (self.centroid - self.centre) * self.wrench.force;
    }

    /// Widens the standard deviations of its corners by the quality of its sensors; `may_start` as in
    /// [`super::ForceFrame::may_start`].
    pub(super) fn judge(&mut self, sensors: [Quality; 4], may_start: bool) {
        let extra = corners::extra_sigma(self.corners, sensors, may_start);
        self.extra_sigma = std::array::from_fn(|corner| extra[corner].max(self.extra_sigma[corner]));
    }

    /// Whether nothing of its past has to be remembered: every sensor was live, and none has just been found or lost.
    #[inline]
    pub(super) fn is_settled(&self) -> bool {
        self.lost == 0 && self.lag == [0.0; 4]
    }

    /// The tile at `place` with live sensors that read `corners`; `None` unless they add up to at
    /// least `least` and more than nothing. `map` corrects them and the place.
    ///
    /// The corners are read in place: handed over by value, the copy cost plain Eq. 4 a sixth of its time.
    #[inline]
    pub(super) fn new(
        place: Place,
        geometry: &Geometry,
        corners: &[f32; 4],
        least: Newtons,
        map: Option<&PositionMap>,
    ) -> Option<Self> {
        match map {
            Some(map) => Self::of_corners(place, geometry, map.trimmed(*corners), least, Some(map)),
            None => Self::of_corners(place, geometry, *corners, least, None),
        }
    }

    /// As [`Self::new`], with sensors of any quality, `dt` seconds after it was as `before`; beside it
    /// what the tile carries, if some of what its sensors read is not to be counted.
    #[cold]
    #[inline(never)]
    pub(super) fn of_any_quality(
        place: Place,
        geometry: &Geometry,
        (forces, quality, may_start): ([f32; 4], [Quality; 4], bool),
        least: Newtons,
        map: Option<&PositionMap>,
        before: Option<&Self>,
        dt: f32,
    ) -> (Option<f32>, Option<Self>) {
        // What one sensor tells of another holds as well as both are known.
        let known = known_corners(map.map_or(forces, |map| map.trimmed(forces)), quality);
        let is_lost = quality.iter().any(|&quality| quality >= Quality::Stale);
        let carried = is_lost.then(|| known.map_or(0.0, |(corners, _)| corners.iter().sum()));
        let Some((corners, worst)) = known else { return (carried, None) };
        let corners = if may_start { corners } else { corners::mended(corners, quality) };
        let lag = Lag::new(quality, before, dt);
        let lag_n = lag.of(corners);
        let corners = std::array::from_fn(|corner| corners[corner] + lag_n[corner]);
        let tile = Self::of_corners(place, geometry, corners, least, map).map(|mut tile| {
            (tile.quality, tile.lost, tile.lag) = (worst, lag.lost, lag_n);
            tile.judge(quality, may_start);
            tile
        });
        (carried, tile)
    }

    #[inline(always)]
    fn of_corners(
        Place { tile, index, centre }: Place,
        geometry: &Geometry,
        corners: [f32; 4],
        least: Newtons,
        map: Option<&PositionMap>,
    ) -> Option<Self> {
        let mut wrench = Wrench::of_corners(corners, geometry.sensor_reach_m());
        if wrench.force < least.0.max(f32::MIN_POSITIVE) {
            return None;
        }
        let mut arm = wrench.arm(0.5 * geometry.pitch_m());
        if let Some(map) = map {
            let unbent = map.unbent(arm, geometry);
            wrench.moment += (unbent - arm) * wrench.force;
            arm = unbent;
        }
        Some(Self {
            tile,
            index,
            centre,
            corners,
            wrench,
            extra_sigma: corners::contradicted(corners),
            noise_n: 0.0,
            left_n: 0.0,
            centroid: centre + arm,
            quality: Quality::Live,
            weight: counted(wrench.force),
            strayed: 0.0,
            mapped_m: map.map(|map| map.residual_m / P95_PER_DEVIATION),
            strayed_m2: 0.0,
            lost: 0,
            lag: [0.0; 4],
        })
    }
}

/// Which tile, and where.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    tile: TileId,
    index: u32,
    centre: Vec2,
}

impl Place {
    pub(super) fn of(geometry: &Geometry, index: usize) -> Self {
        let tile = geometry.tile_at_index(index);
        Self { tile, index: index as u32, centre: geometry.centre(tile) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::floor::Corner;

    const REACH: f32 = 0.132;
    const LIVE: [Quality; 4] = [Quality::Live; 4];

    /// Corner forces of a point load: four equal springs under a rigid plate.
    fn springs(force: f32, at: Vec2) -> [f32; 4] {
        Corner::ALL.map(|corner| 0.25 * force * (1.0 + corner.direction().dot(at / REACH)))
    }

    #[test]
    fn a_point_load_is_found_exactly() {
        for (x, y) in [(0.0, 0.0), (0.1, -0.02), (-0.06, 0.06)] {
            let at = Vec2::new(x, y);
            let wrench = Wrench::of_corners(springs(100.0, at), REACH);
            assert!((wrench.force - 100.0).abs() < 1e-4);
            assert!(wrench.arm(0.152).distance(at) < 1e-6, "{wrench:?}");
        }
    }

    #[test]
    fn three_sensors_do_where_the_plate_is_rigid() {
        let at = Vec2::new(0.03, -0.05);
        for corner in 0..4 {
            let mut quality = LIVE;
            quality[corner] = Quality::Faulty;
            let mut forces = springs(400.0, at);
            forces[corner] = 9999.0;
            let (known, quality) = known_corners(forces, quality).unwrap();
            assert_eq!(quality, Quality::Degraded);
            let wrench = Wrench::of_corners(known, REACH);
            assert!(wrench.arm(0.152).distance(at) < 1e-5, "corner {corner}: {wrench:?}");
        }
    }

    #[test]
    fn noise_cannot_put_a_light_load_off_the_plate() {
        let wrench = Wrench::of_corners([-3.0, 4.0, -3.0, 4.0], REACH);
        assert_eq!(wrench.arm(0.152).x, 0.152);
    }
}
