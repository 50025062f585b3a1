//! The area that one shoe can cover.
//!
//! All points that one foot presses lie under one shoe: within a rectangle of the shoe's length and breadth, at some
//! heading. The outline keeps the extents of the points pressed so far along a fan of directions; a further point can
//! belong to the foot if some heading has room for all of them.

use std::f64::consts::FRAC_1_SQRT_2;

use glam::DVec2;
use multiversion::multiversion;

/// Number of directions of the fan, over half a turn: at 7.5 degrees off its heading a shoe appears at most 4 mm too
/// wide.
const DIRECTIONS: usize = 12;
const QUARTER: usize = DIRECTIONS / 2;

/// Extents of the pressed points along each direction of the fan, in metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct FanExtents {
    low: [f64; DIRECTIONS],
    high: [f64; DIRECTIONS],
}

/// Length and breadth of a shoe, in metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShoeSize {
    pub length: f64,
    pub breadth: f64,
}

/// The lesser of two numbers. `f64::min`, which ignores NaN, is several times slower here.
#[inline(always)]
fn lesser(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

/// The greater of two numbers; see [`lesser`].
#[inline(always)]
fn greater(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

/// Unit vectors at 0, 15, ... 165 degrees.
struct Fan {
    x: [f64; DIRECTIONS],
    y: [f64; DIRECTIONS],
}

static FAN: Fan = Fan {
    x: [
        1.0,
        0.965_925_826_289_068_3,
        0.866_025_403_784_438_6,
        FRAC_1_SQRT_2,
        0.5,
        0.258_819_045_102_520_74,
        0.0,
        -0.258_819_045_102_520_63,
        -0.5,
        -FRAC_1_SQRT_2,
        -0.866_025_403_784_438_7,
        -0.965_925_826_289_068_2,
    ],
    y: [
        0.0,
        0.258_819_045_102_520_74,
        0.5,
        FRAC_1_SQRT_2,
        0.866_025_403_784_438_6,
        0.965_925_826_289_068_3,
        1.0,
        0.965_925_826_289_068_3,
        0.866_025_403_784_438_7,
        FRAC_1_SQRT_2,
        0.5,
        0.258_819_045_102_521,
    ],
};

impl Fan {
    #[inline(always)]
    fn projections(&self, point: DVec2) -> [f64; DIRECTIONS] {
        std::array::from_fn(|which| self.x[which] * point.x + self.y[which] * point.y)
    }
}

/// [`FanExtents::renew`], compiled for each vector instruction set, with bit-identical results.
///
/// The fan is an argument: with constants the compiler optimises single products away and breaks the vectorisation.
#[multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn renew(outline: &mut FanExtents, fan: &Fan, centre: DVec2, others: &[DVec2], keep: f64) {
    let at = fan.projections(centre);
    let (mut low, mut high) = (at, at);
    for &point in others {
        let at = fan.projections(point);
        for which in 0..DIRECTIONS {
            low[which] = lesser(low[which], at[which]);
            high[which] = greater(high[which], at[which]);
        }
    }
    for (kept, now) in outline.low.iter_mut().zip(low) {
        *kept = lesser(now + keep * (*kept - now), now);
    }
    for (kept, now) in outline.high.iter_mut().zip(high) {
        *kept = greater(now + keep * (*kept - now), now);
    }
}

impl FanExtents {
    /// The outline of a foot that has pressed only `point`.
    pub(super) fn new(point: DVec2) -> Self {
        let at = FAN.projections(point);
        Self { low: at, high: at }
    }

    /// Updates the outline for a foot with its centre of pressure at `centre` that presses `others`. Each extent
    /// relaxes towards that of all these points, extent = now + `keep` (extent − now), and always includes them.
    pub(super) fn renew(&mut self, centre: DVec2, others: &[DVec2], keep: f64) {
        renew(self, &FAN, centre, others, keep);
    }

    /// Distance of `point` from the area that `shoe` can cover together with all points so far (m); negative within.
    pub(super) fn beyond(&self, point: DVec2, shoe: ShoeSize) -> f64 {
        let at = FAN.projections(point);
        let extent = |which: usize| greater(self.high[which], at[which]) - lesser(self.low[which], at[which]);
        (0..DIRECTIONS)
            .map(|along| {
                let across = (along + QUARTER) % DIRECTIONS;
                (extent(along) - shoe.length).max(extent(across) - shoe.breadth)
            })
            .fold(f64::INFINITY, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHOE: ShoeSize = ShoeSize { length: 0.33, breadth: 0.13 };

    #[test]
    fn one_point_may_be_either_end_of_a_shoe() {
        let heel = FanExtents::new(DVec2::ZERO);
        for degrees in [0.0_f64, 20.0, 45.0, 100.0, 250.0] {
            let way = DVec2::from_angle(degrees.to_radians());
            assert!(heel.beyond(way * 0.31, SHOE) < 0.0, "toes at {degrees} degrees");
            assert!(heel.beyond(way * 0.4, SHOE) > 0.02, "beyond every shoe at {degrees} degrees");
        }
    }

    #[test]
    fn a_foot_that_has_rolled_covers_nothing_far_beside_its_line() {
        let mut foot = FanExtents::new(DVec2::ZERO);
        foot.renew(DVec2::new(0.0, 0.1), &[DVec2::new(0.0, 0.2)], 1.0);
        assert!(foot.beyond(DVec2::new(0.05, 0.1), SHOE) < 0.0, "the ball beside the strip");
        assert!(foot.beyond(DVec2::new(0.18, 0.1), SHOE) > 0.02, "the other foot");
        assert!(foot.beyond(DVec2::new(0.0, 0.31), SHOE) < 0.0, "the toes");
        assert!(foot.beyond(DVec2::new(0.0, -0.2), SHOE) > 0.02, "behind the heel");
    }

    #[test]
    fn what_was_pressed_long_ago_is_forgotten() {
        let mut foot = FanExtents::new(DVec2::ZERO);
        foot.renew(DVec2::new(0.3, 0.0), &[], 0.1);
        assert!(foot.beyond(DVec2::new(0.55, 0.0), SHOE) < 0.0);
    }
}
