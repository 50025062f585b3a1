//! What one shoe can cover.
//!
//! Everything that one foot presses lies under one shoe: within a rectangle of the shoe's length and breadth, at some
//! heading. The points pressed so far are kept as their extents along a fan of directions; a further point can belong
//! to the foot if some heading has room for all of them.

use std::f64::consts::FRAC_1_SQRT_2;

use glam::DVec2;
use multiversion::multiversion;

/// Directions of the fan, over half a turn: a shoe's breadth at 7.5 degrees off its heading is 4 mm too wide at most.
const DIRECTIONS: usize = 12;
const QUARTER: usize = DIRECTIONS / 2;

/// Extents of the pressed points along each direction of the fan, in metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outline {
    low: [f64; DIRECTIONS],
    high: [f64; DIRECTIONS],
}

/// Length and breadth of a shoe, in metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shoe {
    pub length: f64,
    pub breadth: f64,
}

/// The lesser of two numbers. `f64::min`, which ignores NaN, costs several times as much here.
#[inline(always)]
fn lesser(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

/// The greater of two numbers, as [`lesser`].
#[inline(always)]
fn greater(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

#[inline(always)]
fn projections(point: DVec2) -> [f64; DIRECTIONS] {
    std::array::from_fn(|which| FAN_X[which] * point.x + FAN_Y[which] * point.y)
}

/// Unit vectors at 0, 15, ... 165 degrees.
const FAN_X: [f64; DIRECTIONS] = [
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
];
const FAN_Y: [f64; DIRECTIONS] = [
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
];

/// [`Outline::renew`], compiled for what the processor offers, with the same bits.
#[multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn renew(outline: &mut Outline, centre: DVec2, others: &[DVec2], keep: f64) {
    let mut now = Outline::new(centre);
    others.iter().for_each(|&point| now.add(point));
    outline.relax(&now, keep);
    outline.unite(&now);
}

impl Outline {
    /// A foot that has pressed `point` only.
    #[inline(always)]
    pub(super) fn new(point: DVec2) -> Self {
        let at = projections(point);
        Self { low: at, high: at }
    }

    /// Takes in that `centre` and `others` are pressed now, keeping `keep` of what was known.
    pub(super) fn renew(&mut self, centre: DVec2, others: &[DVec2], keep: f64) {
        renew(self, centre, others, keep);
    }

    /// Adds a pressed point.
    #[inline(always)]
    fn add(&mut self, point: DVec2) {
        self.unite(&Self::new(point));
    }

    /// Adds all points of `other`.
    #[inline(always)]
    fn unite(&mut self, other: &Self) {
        for (low, &other) in self.low.iter_mut().zip(&other.low) {
            *low = lesser(*low, other);
        }
        for (high, &other) in self.high.iter_mut().zip(&other.high) {
            *high = greater(*high, other);
        }
    }

    /// Draws the extents towards those of `now`, keeping `keep` of their distance.
    #[inline(always)]
    fn relax(&mut self, now: &Self, keep: f64) {
        for which in 0..DIRECTIONS {
            self.low[which] = now.low[which] + keep * (self.low[which] - now.low[which]);
            self.high[which] = now.high[which] + keep * (self.high[which] - now.high[which]);
        }
    }

    /// How far `point` is beyond what `shoe` covers besides all points so far, in metres; negative within.
    pub(super) fn beyond(&self, point: DVec2, shoe: Shoe) -> f64 {
        let at = projections(point);
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

    const SHOE: Shoe = Shoe { length: 0.33, breadth: 0.13 };

    #[test]
    fn one_point_may_be_either_end_of_a_shoe() {
        let heel = Outline::new(DVec2::ZERO);
        for degrees in [0.0_f64, 20.0, 45.0, 100.0, 250.0] {
            let way = DVec2::from_angle(degrees.to_radians());
            assert!(heel.beyond(way * 0.31, SHOE) < 0.0, "toes at {degrees} degrees");
            assert!(heel.beyond(way * 0.4, SHOE) > 0.02, "beyond every shoe at {degrees} degrees");
        }
    }

    #[test]
    fn a_foot_that_has_rolled_covers_nothing_far_beside_its_line() {
        let mut foot = Outline::new(DVec2::ZERO);
        foot.add(DVec2::new(0.0, 0.2));
        assert!(foot.beyond(DVec2::new(0.05, 0.1), SHOE) < 0.0, "the ball beside the strip");
        assert!(foot.beyond(DVec2::new(0.18, 0.1), SHOE) > 0.02, "the other foot");
        assert!(foot.beyond(DVec2::new(0.0, 0.31), SHOE) < 0.0, "the toes");
        assert!(foot.beyond(DVec2::new(0.0, -0.2), SHOE) > 0.02, "behind the heel");
    }

    #[test]
    fn what_was_pressed_long_ago_is_forgotten() {
        let mut foot = Outline::new(DVec2::ZERO);
        foot.add(DVec2::new(0.3, 0.0));
        foot.relax(&Outline::new(DVec2::new(0.3, 0.0)), 0.1);
        assert!(foot.beyond(DVec2::new(0.55, 0.0), SHOE) < 0.0);
    }
}
