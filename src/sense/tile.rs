use glam::Vec2;

use super::Quality;
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

/// The forces of a tile's sensors, one unknown filled in, and how far they can be trusted.
///
/// With one sensor out, its force is estimated from the other three: four equal
/// springs under a rigid plate carry f_sw + f_ne = f_se + f_nw. The tile is then
/// [`Quality::Degraded`]. With two out, or numbers no floor can produce (NaN,
/// above 1 MN), `None`: such a tile carries no contact.
#[must_use]
pub fn known_corners(forces: [f32; 4], quality: [Quality; 4]) -> Option<([f32; 4], Quality)> {
    let mut forces = forces;
    let mut out = None;
    let mut worst = Quality::Live;
    for (corner, &quality) in quality.iter().enumerate() {
        match quality {
            Quality::Live | Quality::Degraded => worst = worst.max(quality),
            Quality::Stale | Quality::Faulty if out.is_none() => out = Some(corner),
            Quality::Stale | Quality::Faulty => return None,
        }
    }
    if let Some(corner) = out {
        // In the order sw, se, nw, ne: side neighbours differ in one bit, the diagonal in both.
        let sides: f32 = forces[corner ^ 1] + forces[corner ^ 2];
        forces[corner] = (sides - forces[corner ^ 3]).max(0.0);
        worst = Quality::Degraded;
    }
    forces.iter().all(|force| force.abs() <= 1e6).then_some((forces, worst))
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
    /// zero but for one that is estimated from the others, or at the end of its range.
    pub vague: [f32; 4],
    /// Where the load acts, in floor metres, always on the tile's plate.
    pub centroid: Vec2,
    /// [`Quality::Live`], or [`Quality::Degraded`] with a sensor estimated or doubtful.
    pub quality: Quality,
}

/// Force from which on a tile has its full weight among others (our choice: three times the least that counts as load).
const FULL_WEIGHT: f32 = 12.0;

/// How far a corner's force estimated from the other three is off, as a share of the tile's force (one
/// standard deviation; measured on simulated floors of parts and supports as the paper's).
const ESTIMATED: f32 = 0.12;

/// How far the force at a sensor that reads "at least" may be above its reading, as a share of it (our choice).
const AT_LEAST: f32 = 0.5;

impl LoadedTile {
    /// What the tile's force weighs in a centroid over several tiles: all of it from 12 N on, ever
    /// less below, so that a foot sliding over a seam gains its next tile gradually, not with a
    /// jump when that tile first counts as loaded.
    pub(super) fn weight(&self) -> f32 {
        self.wrench.force * (self.wrench.force / FULL_WEIGHT).min(1.0)
    }

    /// This tile, its vagueness judged by the quality of its sensors; `may_start` as in [`super::ForceFrame::may_start`].
    pub(super) fn judged(mut self, sensors: [Quality; 4], may_start: bool) -> Self {
        for (vague, (corner, quality)) in self.vague.iter_mut().zip(sensors.into_iter().enumerate()) {
            *vague = match quality {
                Quality::Live => 0.0,
                Quality::Degraded if may_start => 0.0,
                Quality::Degraded => AT_LEAST * self.corners[corner].abs(),
                Quality::Stale | Quality::Faulty => {
                    // Once the diagonal has lifted off, all that this corner bears beyond is unseen.
                    let lifted = (-self.corners[corner ^ 3]).max(0.0);
                    ESTIMATED * self.wrench.force + lifted
                }
            };
        }
        self
    }

    /// The tile at `index` of the floor, with sensors that read `corners`; `None` unless
    /// they add up to at least `least` and more than nothing. `map` corrects them and the place.
    pub(super) fn new(
        geometry: &Geometry,
        index: usize,
        (corners, quality): ([f32; 4], Quality),
        least: Newtons,
        map: Option<&PositionMap>,
    ) -> Option<Self> {
        let corners = map.map_or(corners, |map| map.trimmed(corners));
        let mut wrench = Wrench::of_corners(corners, geometry.sensor_reach_m());
        if wrench.force < least.0.max(f32::MIN_POSITIVE) {
            return None;
        }
        let tile = geometry.tile_at_index(index);
        let centre = geometry.centre(tile);
        let mut arm = wrench.arm(0.5 * geometry.pitch_m());
        if let Some(map) = map {
            let unbent = map.unbent(arm, geometry);
            wrench.moment += (unbent - arm) * wrench.force;
            arm = unbent;
        }
        let centroid = centre + arm;
        Some(Self { tile, index: index as u32, centre, corners, wrench, vague: [0.0; 4], centroid, quality })
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
            let (known, doubt) = known_corners(forces, quality).unwrap();
            assert_eq!(doubt, Quality::Degraded);
            let wrench = Wrench::of_corners(known, REACH);
            assert!(wrench.arm(0.152).distance(at) < 1e-5, "corner {corner}: {wrench:?}");
        }
    }

    #[test]
    fn two_sensors_are_too_few_and_nonsense_is_no_load() {
        let two_out = [Quality::Live, Quality::Stale, Quality::Live, Quality::Faulty];
        assert_eq!(known_corners([1.0; 4], two_out), None);
        assert_eq!(known_corners([f32::NAN; 4], LIVE), None);
        assert_eq!(known_corners([f32::INFINITY; 4], LIVE), None);
        assert_eq!(known_corners([3e38; 4], LIVE), None);
    }

    #[test]
    fn noise_cannot_put_a_light_load_off_the_plate() {
        let wrench = Wrench::of_corners([-3.0, 4.0, -3.0, 4.0], REACH);
        assert_eq!(wrench.arm(0.152).x, 0.152);
    }
}
