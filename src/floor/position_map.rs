use glam::Vec2;

use super::Geometry;

/// What one tile's sensors and plate were found to do to positions, and how to undo it.
///
/// Two corrections, both learnt from known points pressed on the tile. *Trims*
/// undo what a sensor's exponential law leaves over: its reading times a factor
/// that follows the load on it. *Bends* move the centroid where the plate
/// itself distorts, near the edges. All zero corrects nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PositionMap {
    /// Per sensor ([`super::Corner::ALL`] order), what is added to a factor of one at each of
    /// [`PositionMap::TRIM_LOADS_N`]; straight lines between, constant outside.
    pub trims: [[f32; PositionMap::TRIMS]; 4],
    /// For the shift east and north, what each of [`PositionMap::terms`] counts, in half pitches.
    pub bends: [[f32; PositionMap::BENDS]; 2],
    /// What it leaves: the error that all but 5 % of known points keep to with it, in metres.
    pub residual_m: f32,
}

impl PositionMap {
    /// Loads on one sensor, tared, at which its trim is known, in newtons.
    ///
    /// Closer where feet work: a part strays from its law in about two waves over its range (our choice).
    pub const TRIM_LOADS_N: [f32; Self::TRIMS] =
        [0.0, 10.0, 25.0, 45.0, 70.0, 100.0, 140.0, 190.0, 250.0, 320.0, 400.0];

    /// Trims of one sensor.
    pub const TRIMS: usize = 11;

    /// Terms of the shift along one axis.
    pub const BENDS: usize = 10;

    /// The greatest trim: a part that misses its law by more should be replaced (our choice).
    pub const MOST_TRIM: f32 = 0.6;

    /// The greatest number of a bend that files may hold.
    pub const MOST_BEND: f32 = 2.0;

    /// The farthest shift, in half pitches: 3.8 cm on the paper's tiles (our choice).
    pub const MOST_SHIFT: f32 = 0.25;

    /// The map that corrects nothing.
    pub const NONE: Self = Self {
        trims: [[0.0; Self::TRIMS]; 4],
        bends: [[0.0; Self::BENDS]; 2],
        residual_m: Self::SOME_RESIDUAL_M,
    };

    /// What a map leaves of which that is not known, in metres: a little more than most (our choice).
    pub const SOME_RESIDUAL_M: f32 = 0.004;

    /// Where `force` lies between two of [`PositionMap::TRIM_LOADS_N`]: the lower one's place and how far on, 0 to 1.
    pub(crate) fn between(force: f32) -> (usize, f32) {
        let loads = &Self::TRIM_LOADS_N;
        let below = loads[1..Self::TRIMS - 1].partition_point(|&load| load <= force);
        let share = (force - loads[below]) / (loads[below + 1] - loads[below]);
        (below, share.clamp(0.0, 1.0))
    }

    /// The cubic polynomial's terms at `u`, in half pitches from the tile's centre.
    #[must_use]
    pub fn terms(u: Vec2) -> [f32; Self::BENDS] {
        let Vec2 { x, y } = u;
        [1.0, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y]
    }

    /// The sensors' forces with their trims, in newtons. A force that is not a number stays so.
    ///
    /// # Real-time
    /// Some forty operations; allocates nothing.
    #[must_use]
    pub fn trimmed(&self, mut corners: [f32; 4]) -> [f32; 4] {
        for (force, trims) in corners.iter_mut().zip(&self.trims) {
            let (below, share) = Self::between(*force);
            *force *= 1.0 + trims[below] + (trims[below + 1] - trims[below]) * share;
        }
        corners
    }

    /// The place of a load that trimmed forces put at `arm` from the tile's centre, in metres.
    ///
    /// Stays on the square of one pitch around the tile. A place that is not a number stays so.
    #[must_use]
    pub fn unbent(&self, arm: Vec2, geometry: &Geometry) -> Vec2 {
        let half = 0.5 * geometry.pitch_m();
        let terms = Self::terms((arm / half).clamp(Vec2::NEG_ONE, Vec2::ONE));
        let shift = self.bends.map(|bend| bend.iter().zip(terms).map(|(bend, term)| bend * term).sum());
        let most = Vec2::splat(Self::MOST_SHIFT);
        let shift = Vec2::from_array(shift).clamp(-most, most);
        (arm + shift * half).clamp(Vec2::splat(-half), Vec2::splat(half))
    }
}

impl Default for PositionMap {
    fn default() -> Self {
        Self::NONE
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn the_empty_map_changes_nothing() {
        let geometry = Geometry::default();
        let corners = [0.0, -3.0, 57.0, 900.0];
        assert_eq!(PositionMap::NONE.trimmed(corners), corners);
        let arm = Vec2::new(0.05, -0.151);
        assert_eq!(PositionMap::NONE.unbent(arm, &geometry), arm);
    }

    #[test]
    fn trims_go_straight_from_load_to_load() {
        let mut map = PositionMap::NONE;
        map.trims[1][4] = 0.1;
        let read = |force: f32| map.trimmed([0.0, force, force, 0.0]);
        assert_eq!(read(70.0)[2], 70.0);
        assert!((read(70.0)[1] - 77.0).abs() < 1e-4);
        assert!((read(85.0)[1] - 85.0 * 1.05).abs() < 1e-4);
        assert!((read(45.0)[1] - 45.0).abs() < 1e-4);
        map.trims[1][PositionMap::TRIMS - 1] = 0.2;
        assert!((map.trimmed([0.0, 1000.0, 0.0, 0.0])[1] - 1200.0).abs() < 1e-2);
    }

    proptest! {
        #[test]
        fn no_map_puts_a_load_off_its_tile_or_makes_numbers_of_none(
            bends in proptest::array::uniform2(proptest::array::uniform10(-2.0f32..2.0)),
            x in -0.2f32..0.2, y in -0.2f32..0.2,
        ) {
            let map = PositionMap { bends, ..PositionMap::NONE };
            let geometry = Geometry::default();
            let arm = map.unbent(Vec2::new(x, y), &geometry);
            prop_assert!(arm.abs().max_element() <= 0.1521, "{arm}");
            prop_assert!(map.trimmed([f32::NAN; 4]).iter().all(|force| force.is_nan()));
        }
    }
}
