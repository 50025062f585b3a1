//! The force and the centroid of one tile.

use glam::Vec2;

use super::corners::{self, known_corners};
use crate::floor::{Geometry, PositionMap, SensorPlaces, TileId};
use crate::sense::Quality;
use crate::units::Newtons;

/// The reading of one tile as a whole.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TileReading {
    /// Sum of its sensors.
    pub force: Newtons,
    /// Centroid of its load, in floor metres; `None` if the load is too light to locate, or too few sensors are
    /// known.
    pub centroid: Option<Vec2>,
    /// Quality of both.
    pub quality: Quality,
}

/// Force and moment of one tile: all that sensors under a rigid plate can measure.
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
    /// The wrench of a tile whose sensors at `places` read `corners`.
    ///
    /// # Source
    /// F = Σ fᵢ, F x_c = Σ fᵢ xᵢ over the sensors (paper, Eq. 2-3). The tare has subtracted the plate's own load f_p
    /// sensor by sensor, which is equivalent.
    #[inline]
    #[must_use]
    pub fn of_corners(corners: [f32; 4], places: &SensorPlaces) -> Self {
        let [sw, se, nw, ne] = corners;
        Self { force: (sw + se) + (nw + ne), moment: places.moment(corners) }
    }

    /// Position of the load relative to the tile's centre, limited to the cell of half size `half`.
    ///
    /// Noise may put the quotient beyond the cell, where no load can be. Meaningless for a force of zero or less.
    #[must_use]
    pub fn arm(&self, half: Vec2) -> Vec2 {
        (self.moment / self.force).clamp(-half, half)
    }
}

/// One tile with a load on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadedTile {
    /// Its identifier.
    pub tile: TileId,
    /// Its place in tile-index order.
    pub index: u32,
    /// Its centre, in floor metres.
    pub centre: Vec2,
    /// Readings of its sensors, in [`crate::floor::Corner::ALL`] order; an unknown one is estimated, and one that the
    /// plate does not have is zero.
    pub corners: [f32; 4],
    /// Its force and moment; the force is positive.
    pub wrench: Wrench,
    /// Standard deviation of each of `corners` beyond the general uncertainty of sensors, in newtons: zero except for
    /// a sensor that is estimated from the others, at the end of its range, or in contradiction to the others.
    pub extra_sigma: [f32; 4],
    /// Standard deviation of the white noise of each of `corners`, in newtons, as measured while the tile was idle;
    /// zero on a floor with negligible noise.
    pub noise_n: f32,
    /// Estimated part of `wrench` that remains from a recent load, in newtons; 0 under heavy loads.
    pub left_n: f32,
    /// Position of the load, in floor metres: on the tile's plate, or up to a few centimetres beside it if part of
    /// the load lies on surrounding tiles that are too light to count themselves.
    pub centroid: Vec2,
    /// [`Quality::Live`], or [`Quality::Degraded`] if a sensor is estimated or suspect.
    pub quality: Quality,
    /// Weight of the force in a centroid over several tiles.
    weight: f32,
    /// Standard deviation of the position along each axis after correction by the tile's map (m); `None` without a
    /// map.
    mapped_m: Option<f32>,
    /// Contribution of the zeros of surrounding tiles with a part of the load to a moment's variance, per variance of
    /// a sensor's zero: four times the squared distance from the centroid (m²).
    strayed_m2: f32,
    /// Sensors estimated from the others, one bit each.
    lost: u8,
    /// Remaining blend in `corners` from the readings before a sensor was lost or returned.
    lag: [f32; 4],
    /// Part of the force on surrounding tiles that are too light to be listed themselves.
    strayed: f32,
}

/// Noise of a loaded sensor, as a share of its load: a force that grows by `exp(1.34 v)` turns the 2 to 10 mV of its
/// converter into 0.3 to 1.3 % (the paper's parts). An idle tile does not show it, and the reported uncertainty
/// contains it as part of the gain. Twice as much would delay the separation of two close feet.
const LOADED_NOISE: f64 = 0.01;

/// Force below which a tile has no weight in a centroid, and above which it has full weight (N) (our choice: two and
/// eight deviations of the sum of four sensors on an empty floor with tracked zeros).
pub(in crate::sense) const NO_WEIGHT: f32 = 0.5;
pub(in crate::sense) const FULL_WEIGHT: f32 = 2.0;

/// Weight of `force` on one tile in a centroid over several.
///
/// It rises continuously from zero to the full force, so that a foot sliding over a seam gains its next tile
/// gradually.
pub(in crate::sense) fn counted(force: f32) -> f32 {
    // Most loads have full weight and need no division.
    if force >= FULL_WEIGHT {
        return force;
    }
    force * ((force - NO_WEIGHT) / (FULL_WEIGHT - NO_WEIGHT)).clamp(0.0, 1.0)
}

/// The 95th percentile of a distance in the plane over its standard deviation along each axis.
const P95_PER_DEVIATION: f32 = 2.4477;

/// Blends a tile from a sensor's reading to the estimate from the others, or back, without a jump of its centroid
/// that could look like another foot.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::sense) struct Lag {
    /// Sensors estimated now, one bit each.
    lost: u8,
    /// The tile's corners before, the last lag, and the sensors estimated then.
    before: Option<([f32; 4], [f32; 4], u8)>,
    /// Decay factor of the last lag.
    fade: f32,
}

/// Time constant of the blend (s) (our choice: a slow shift of weight).
const LAG_S: f32 = 0.08;

/// Lag below which the blend ends (N).
const NO_LAG_N: f32 = 0.05;

impl Lag {
    /// The lag of a tile with sensors of `quality`, `dt` seconds after the state `before`.
    pub(in crate::sense) fn new(quality: [Quality; 4], before: Option<&LoadedTile>, dt: f32) -> Self {
        let bit = |(corner, quality): (usize, Quality)| u8::from(quality >= Quality::Stale) << corner;
        let lost = quality.into_iter().enumerate().map(bit).sum();
        let before = before.filter(|tile| tile.lost != lost || !tile.is_settled());
        Self {
            lost,
            before: before.map(|tile| (tile.corners, tile.lag, tile.lost)),
            fade: before.map_or(0.0, |_| (-dt / LAG_S).exp()),
        }
    }

    /// Lag to add to `corners`.
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
    /// Weight of the tile's force in a centroid over several tiles.
    pub(in crate::sense) fn weight(&self) -> f32 {
        self.weight
    }

    /// Standard deviation along each axis after correction by its map (m); `None` without one.
    pub(in crate::sense) fn mapped_m(&self) -> Option<f32> {
        self.mapped_m
    }

    /// Standard deviation of the noise of each of its sensors under this load (N).
    pub(in crate::sense) fn loaded_noise_n(&self) -> f64 {
        let under_load = LOADED_NOISE * 0.25 * f64::from(self.wrench.force);
        // As on most floors: saves a square root.
        if self.noise_n == 0.0 { under_load.abs() } else { f64::from(self.noise_n).hypot(under_load) }
    }

    pub(in crate::sense) fn strayed_m2(&self) -> f32 {
        self.strayed_m2
    }

    /// The reading of the tile itself.
    pub(in crate::sense) fn reading(&self, geometry: &Geometry) -> TileReading {
        let half = 0.5 * geometry.pitch_m();
        TileReading {
            force: Newtons(self.wrench.force - self.strayed),
            centroid: Some(self.centroid.clamp(self.centre - half, self.centre + half)),
            quality: self.quality,
        }
    }

    /// Adds `force` at `point` of a surrounding tile that is too light to be listed itself.
    pub(in crate::sense) fn add_strayed(&mut self, force: f32, point: Vec2) {
        self.weight += force;
        self.strayed += force;
        self.strayed_m2 += 4.0 * point.distance_squared(self.centroid);
        self.centroid += (point - self.centroid) * (force / self.weight);
        self.wrench.force += force;
        self.wrench.moment = (self.centroid - self.centre) * self.wrench.force;
    }

    /// Widens the standard deviations of its corners by the quality of its sensors; `may_start` as in
    /// [`crate::sense::ForceFrame::may_start`].
    pub(in crate::sense) fn judge(&mut self, places: &SensorPlaces, sensors: [Quality; 4], may_start: bool) {
        let extra = corners::extra_sigma(places, self.corners, sensors, may_start);
        self.extra_sigma = std::array::from_fn(|corner| extra[corner].max(self.extra_sigma[corner]));
    }

    /// Whether it needs no state from its past: every sensor was live, and none has just been lost or returned.
    #[inline]
    pub(in crate::sense) fn is_settled(&self) -> bool {
        self.lost == 0 && self.lag == [0.0; 4]
    }

    /// The tile at `place` with live sensors that read `corners`; `None` unless their sum is at least `least` and
    /// positive. `map` corrects the corners and the position.
    ///
    /// The corners are passed by reference: by value, the copy took a sixth of plain Eq. 4's time.
    #[inline]
    pub(in crate::sense) fn new(
        place: PlacedTile,
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

    /// Like [`Self::new`], with sensors of any quality, `dt` seconds after the state `before`; also returns the
    /// tile's load if some of its sensors' readings do not count.
    #[cold]
    #[inline(never)]
    pub(in crate::sense) fn of_any_quality(
        place: PlacedTile,
        geometry: &Geometry,
        (forces, quality, may_start): ([f32; 4], [Quality; 4], bool),
        least: Newtons,
        map: Option<&PositionMap>,
        before: Option<&Self>,
        dt: f32,
    ) -> (Option<f32>, Option<Self>) {
        // The map applies first: the estimate of a sensor from the others requires corrected readings.
        let places = geometry.sensor_places(place.tile);
        let known = known_corners(places, map.map_or(forces, |map| map.trimmed(forces)), quality);
        let is_lost = quality.iter().any(|&quality| quality >= Quality::Stale);
        let carried = is_lost.then(|| known.map_or(0.0, |(corners, _)| corners.iter().sum()));
        let Some((corners, worst)) = known else { return (carried, None) };
        let corners = if may_start { corners } else { corners::mended(places, corners, quality) };
        let lag = Lag::new(quality, before, dt);
        let lag_n = lag.of(corners);
        let corners = std::array::from_fn(|corner| corners[corner] + lag_n[corner]);
        let tile = Self::of_corners(place, geometry, corners, least, map).map(|mut tile| {
            (tile.quality, tile.lost, tile.lag) = (worst, lag.lost, lag_n);
            tile.judge(places, quality, may_start);
            tile
        });
        (carried, tile)
    }

    #[inline(always)]
    fn of_corners(
        PlacedTile { tile, index, centre }: PlacedTile,
        geometry: &Geometry,
        corners: [f32; 4],
        least: Newtons,
        map: Option<&PositionMap>,
    ) -> Option<Self> {
        let places = geometry.sensor_places(tile);
        let mut wrench = Wrench::of_corners(corners, places);
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
            extra_sigma: if places.is_parallelogram() { corners::contradicted(corners) } else { [0.0; 4] },
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

/// A tile and its position.
#[derive(Clone, Copy, Debug)]
pub(in crate::sense) struct PlacedTile {
    tile: TileId,
    index: u32,
    centre: Vec2,
}

impl PlacedTile {
    pub(in crate::sense) fn of(geometry: &Geometry, index: usize) -> Self {
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

    const HALF: Vec2 = Vec2::splat(0.152);

    fn places() -> SensorPlaces {
        *Geometry::default().sensor_places(TileId::new(0, 0))
    }

    /// Corner forces of a point load: four equal springs under a rigid plate.
    fn springs(force: f32, at: Vec2) -> [f32; 4] {
        Corner::ALL.map(|corner| 0.25 * force * (1.0 + corner.direction().dot(at / REACH)))
    }

    #[test]
    fn a_point_load_is_found_exactly() {
        for (x, y) in [(0.0, 0.0), (0.1, -0.02), (-0.06, 0.06)] {
            let at = Vec2::new(x, y);
            let wrench = Wrench::of_corners(springs(100.0, at), &places());
            assert!((wrench.force - 100.0).abs() < 1e-4);
            assert!(wrench.arm(HALF).distance(at) < 1e-6, "{wrench:?}");
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
            let (known, quality) = known_corners(&places(), forces, quality).unwrap();
            assert_eq!(quality, Quality::Degraded);
            let wrench = Wrench::of_corners(known, &places());
            assert!(wrench.arm(HALF).distance(at) < 1e-5, "corner {corner}: {wrench:?}");
        }
    }

    #[test]
    fn noise_cannot_put_a_light_load_off_the_plate() {
        let wrench = Wrench::of_corners([-3.0, 4.0, -3.0, 4.0], &places());
        assert_eq!(wrench.arm(HALF).x, 0.152);
    }
}
