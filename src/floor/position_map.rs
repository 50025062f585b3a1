//! Corrections of the position of a load on one tile.

use glam::Vec2;

use super::Geometry;

/// Position errors measured on one tile, and their correction.
///
/// It has two corrections, both fitted to known points pressed on the tile. *Trims* correct the residual of a
/// sensor's exponential law: they multiply its reading by a factor that depends on the load on it. *Bends* move the
/// centroid where the plate itself distorts, near the edges. With all zeros it corrects nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PositionMap {
    /// Per sensor ([`super::Corner::ALL`] order), the number added to a factor of one at each of
    /// [`PositionMap::TRIM_LOADS_N`]; a smooth curve between them, constant outside.
    pub trims: [[f32; PositionMap::TRIMS]; 4],
    /// For the shift east and north, the coefficient of each of [`PositionMap::terms`], in half pitches along its axis.
    pub bends: [[f32; PositionMap::BENDS]; 2],
    /// Residual: the position error with the map that 95 % of known points do not exceed, in metres.
    pub residual_m: f32,
}

impl PositionMap {
    /// Tared loads on one sensor at which its trim is stored, in newtons.
    ///
    /// A part deviates from its law in waves that are shorter at lighter loads (our choice, by trial). The loads
    /// below zero occur when a load beyond the sensors' square lifts the plate off a sensor, down to the plate's own
    /// weight.
    pub const TRIM_LOADS_N: [f32; Self::TRIMS] = [
        -12.0, -9.0, -6.0, -3.0, 0.0, 5.0, 11.0, 20.0, 32.0, 47.0, 64.0, 82.0, 102.0, 122.0, 145.0, 170.0,
        200.0, 240.0, 290.0, 340.0, 400.0,
    ];

    /// Number of trims of one sensor.
    pub const TRIMS: usize = 21;

    /// Number of terms of the shift along one axis.
    pub const BENDS: usize = 10;

    /// Maximum trim: a part that deviates more from its law should be replaced (our choice).
    pub(crate) const MOST_TRIM: f32 = 0.6;

    /// Maximum coefficient of a bend in files.
    pub(crate) const MOST_BEND: f32 = 2.0;

    /// Maximum shift, in half pitches: 3.8 cm on the paper's tiles (our choice).
    pub(crate) const MOST_SHIFT: f32 = 0.25;

    /// The map that corrects nothing.
    pub const NONE: Self = Self {
        trims: [[0.0; Self::TRIMS]; 4],
        bends: [[0.0; Self::BENDS]; 2],
        residual_m: Self::SOME_RESIDUAL_M,
    };

    /// Residual of a map with an unknown residual, in metres: a little more than most (our choice).
    pub const SOME_RESIDUAL_M: f32 = 0.004;

    /// Returns the weights of four neighbouring trims at a load of `force` newtons, and the index of the first of
    /// them.
    ///
    /// # Source
    /// Cubic Hermite interpolation; the slope at each load is that of the parabola through it and its two neighbours.
    #[inline]
    pub(crate) fn shares(force: f32) -> (usize, [f32; 4]) {
        let loads = &Self::TRIM_LOADS_N;
        let below = loads[1..Self::TRIMS - 1].partition_point(|&load| load <= force);
        let along = ((force - loads[below]) / (loads[below + 1] - loads[below])).clamp(0.0, 1.0);
        let cubic = &CUBICS[below];
        let share = |trim: usize| {
            let [c0, c1, c2, c3] = cubic[trim];
            c0 + along * (c1 + along * (c2 + along * c3))
        };
        (first_of(below), std::array::from_fn(share))
    }

    /// Returns the terms of the cubic polynomial at `u`, in half pitches from the tile's centre.
    #[must_use]
    pub fn terms(u: Vec2) -> [f32; Self::BENDS] {
        let Vec2 { x, y } = u;
        [1.0, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y]
    }

    /// Returns the sensors' forces, each times `max(1 + trim, 0)`, in newtons. NaN stays NaN.
    ///
    /// # Real-time
    /// Some hundred operations; allocates nothing.
    #[must_use]
    pub(crate) fn trimmed(&self, mut corners: [f32; 4]) -> [f32; 4] {
        for (force, trims) in corners.iter_mut().zip(&self.trims) {
            let (first, shares) = Self::shares(*force);
            let trim: f32 =
                trims[first..first + 4].iter().zip(shares).map(|(trim, share)| trim * share).sum();
            *force *= (1.0 + trim).max(0.0);
        }
        corners
    }

    /// Returns the place of a load, in metres from the tile's centre; `arm` is the place given by the trimmed forces.
    /// The place is `arm` plus half a pitch times the sum of bends and terms, the latter limited to
    /// [`PositionMap::MOST_SHIFT`].
    ///
    /// Stays on the cell of the tile. NaN stays NaN.
    #[must_use]
    pub(crate) fn unbent(&self, arm: Vec2, geometry: &Geometry) -> Vec2 {
        let half = 0.5 * geometry.pitch_m();
        let terms = Self::terms((arm / half).clamp(Vec2::NEG_ONE, Vec2::ONE));
        let shift = self.bends.map(|bend| bend.iter().zip(terms).map(|(bend, term)| bend * term).sum());
        let most = Vec2::splat(Self::MOST_SHIFT);
        let shift = Vec2::from_array(shift).clamp(-most, most);
        (arm + shift * half).clamp(-half, half)
    }
}

/// Returns the index of the first of the four trims with a weight between load `below` and the next.
const fn first_of(below: usize) -> usize {
    match below {
        0 => 0,
        below if below > PositionMap::TRIMS - 3 => PositionMap::TRIMS - 4,
        below => below - 1,
    }
}

/// Weight of each of the four trims, for each gap between neighbouring loads, as a cubic of the position in the gap
/// (0 to 1), lowest power first.
static CUBICS: [[[f32; 4]; 4]; PositionMap::TRIMS - 1] = {
    let mut cubics = [[[0.0; 4]; 4]; PositionMap::TRIMS - 1];
    let mut below = 0;
    while below < cubics.len() {
        let first = first_of(below);
        let step = PositionMap::TRIM_LOADS_N[below + 1] - PositionMap::TRIM_LOADS_N[below];
        let (start, end) = (slope(below), slope(below + 1));
        let mut trim = 0;
        while trim < 4 {
            let (from, to) = ((first + trim == below) as u8 as f32, (first + trim == below + 1) as u8 as f32);
            let (start, end) = (start[first + trim] * step, end[first + trim] * step);
            cubics[below][trim] =
                [from, start, 3.0 * (to - from) - 2.0 * start - end, 2.0 * (from - to) + start + end];
            trim += 1;
        }
        below += 1;
    }
    cubics
};

/// Returns the weight of each trim in the curve's slope at load number `at`, per newton.
const fn slope(at: usize) -> [f32; PositionMap::TRIMS] {
    let loads = &PositionMap::TRIM_LOADS_N;
    let last = PositionMap::TRIMS - 1;
    let mut slope = [0.0; PositionMap::TRIMS];
    // Weights of the chord before and of the one after.
    let (before, after) = match at {
        0 => (0.0, 1.0),
        at if at == last => (1.0, 0.0),
        at => {
            let share = (loads[at + 1] - loads[at]) / (loads[at + 1] - loads[at - 1]);
            (share, 1.0 - share)
        }
    };
    if at > 0 {
        let per = before / (loads[at] - loads[at - 1]);
        slope[at] += per;
        slope[at - 1] -= per;
    }
    if at < last {
        let per = after / (loads[at + 1] - loads[at]);
        slope[at + 1] += per;
        slope[at] -= per;
    }
    slope
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
    fn trims_hold_at_their_loads_and_are_smooth_between() {
        let mut map = PositionMap::NONE;
        // The interpolation is exact for a parabola over the load, except next to the ends, where there is no third
        // load.
        let trim = |load: f32| 0.1 - 0.001 * load + 2e-6 * load * load;
        map.trims[1] = PositionMap::TRIM_LOADS_N.map(trim);
        let factor = |force: f32| map.trimmed([0.0, force, force, 0.0])[1] / force;
        for load in [-10.0, -9.0, -4.5, 3.0, 5.0, 27.0, 64.0, 73.0, 139.0, 200.0, 333.0, 340.0, 400.0] {
            let expected = 1.0 + trim(load);
            assert!((factor(load) - expected).abs() < 1e-4, "{load}: {}", factor(load));
        }
        assert_eq!(map.trimmed([0.0, 73.0, 73.0, 0.0])[2], 73.0);
        // Constant outside.
        assert_eq!(factor(1000.0), 1.0 + trim(400.0));
        assert_eq!(factor(-30.0), 1.0 + trim(-12.0));
    }

    proptest! {
        #[test]
        fn no_trims_turn_a_load_around(
            trims in proptest::array::uniform4(proptest::array::uniform21(-0.6f32..=0.6)),
            force in -20.0f32..500.0,
        ) {
            let map = PositionMap { trims, ..PositionMap::NONE };
            for trimmed in map.trimmed([force; 4]) {
                prop_assert!(trimmed * force >= 0.0 && trimmed.abs() < 2.0 * force.abs() + 1e-3, "{trimmed}");
            }
        }

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
