//! The pressed patch of a foot, and its part on one tile.

use glam::DVec2;

/// The part of a patch within an interval along one axis, its first moment, and the derivatives of both.
///
/// # Source
/// The pressure along one axis is the parabola k(u) = 3/4 (1 − u²), u = (t − c) / h,
/// for |u| ≤ 1: smooth, of bounded width, close to the profile of a uniformly
/// pressed ellipse, and all its integrals are polynomials.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Slice {
    /// Share of the patch between the edges, 0 to 1.
    pub share: f64,
    /// First moment of that share about the interval's middle, in metres.
    pub moment: f64,
    /// Derivatives of `share` with respect to the patch's middle c and half width h (1/m).
    pub share_by: [f64; 2],
    /// Derivatives of `moment` with respect to c and h.
    pub moment_by: [f64; 2],
}

impl Slice {
    /// The part of the patch with its middle at `c` and half width `h` between `low` and `high`.
    #[inline]
    pub(super) fn new(low: f64, high: f64, c: f64, h: f64) -> Self {
        let middle = 0.5 * (low + high);
        // Most patches lie entirely on one tile.
        if low - c >= h || high - c <= -h {
            return Self::default();
        }
        if low - c <= -h && high - c >= h {
            return Self { share: 1.0, moment: c - middle, share_by: [0.0; 2], moment_by: [1.0, 0.0] };
        }
        let a = ((low - c) / h).clamp(-1.0, 1.0);
        let b = ((high - c) / h).clamp(-1.0, 1.0);
        // Density at the edges, and the integrals of the density and of u times the density.
        let density = |u: f64| 0.75 * (1.0 - u * u);
        let integral = |u: f64| 0.75 * (u - u * u * u / 3.0);
        let first = |u: f64| 0.375 * (u * u - 0.5 * u * u * u * u);
        let share = integral(b) - integral(a);
        let about_c = first(b) - first(a);
        let (at_a, at_b) = (density(a), density(b));
        let share_by = [-(at_b - at_a) / h, -(at_b * b - at_a * a) / h];
        let about_c_by = [-(at_b * b - at_a * a), about_c - (at_b * b * b - at_a * a * a)];
        Self {
            share,
            moment: (c - middle) * share + h * about_c,
            share_by,
            moment_by: [
                share + (c - middle) * share_by[0] + about_c_by[0],
                (c - middle) * share_by[1] + about_c_by[1],
            ],
        }
    }
}

impl Slice {
    /// The expected slice for a half width `h` with a standard deviation of `sigma`.
    ///
    /// A patch that just misses a seam has a zero derivative there, so that no load of the next tile could widen it.
    /// The mean of a narrower and a wider patch, and their difference quotient, give the derivative over the relevant
    /// range.
    pub(super) fn with_sigma(low: f64, high: f64, c: f64, h: f64, sigma: f64) -> Self {
        if sigma < 0.002 {
            return Self::new(low, high, c, h);
        }
        let narrow = (h - sigma).max(0.3 * h);
        let wide = h + sigma;
        let (a, b) = (Self::new(low, high, c, narrow), Self::new(low, high, c, wide));
        let run = wide - narrow;
        Self {
            share: 0.5 * (a.share + b.share),
            moment: 0.5 * (a.moment + b.moment),
            share_by: [0.5 * (a.share_by[0] + b.share_by[0]), (b.share - a.share) / run],
            moment_by: [0.5 * (a.moment_by[0] + b.moment_by[0]), (b.moment - a.moment) / run],
        }
    }
}

/// The part of a foot's patch on one tile.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct PatchOnTile {
    pub east: Slice,
    pub north: Slice,
}

impl PatchOnTile {
    /// The part on the cell from `low` to `high` of the patch around `centre` with half widths `half`.
    pub(super) fn new(low: DVec2, high: DVec2, centre: DVec2, half: DVec2) -> Self {
        Self {
            east: Slice::new(low.x, high.x, centre.x, half.x),
            north: Slice::new(low.y, high.y, centre.y, half.y),
        }
    }

    /// Share of the foot's force on the tile.
    pub(super) fn share(&self) -> f64 {
        self.east.share * self.north.share
    }

    /// First moment of that share about the tile's centre, in metres.
    pub(super) fn moment(&self) -> DVec2 {
        DVec2::new(self.east.moment * self.north.share, self.east.share * self.north.moment)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_and_moments_add_up_over_the_tiles() {
        let (c, h) = (0.29, 0.08);
        let west = Slice::new(0.0, 0.304, c, h);
        let east = Slice::new(0.304, 0.608, c, h);
        assert!((west.share + east.share - 1.0).abs() < 1e-12);
        let about_zero = west.moment + 0.152 * west.share + east.moment + 0.456 * east.share;
        assert!((about_zero - c).abs() < 1e-12);
    }

    #[test]
    fn slopes_are_those_of_the_values() {
        for (c, h) in [(0.29, 0.08), (0.02, 0.05), (0.15, 0.2), (0.35, 0.06)] {
            let at = |c, h| Slice::new(0.0, 0.304, c, h);
            let (step, here) = (1e-6, at(c, h));
            for (which, ahead) in [at(c + step, h), at(c, h + step)].iter().enumerate() {
                let share = (ahead.share - here.share) / step;
                let moment = (ahead.moment - here.moment) / step;
                assert!((share - here.share_by[which]).abs() < 1e-3, "share at {c} {h}");
                assert!((moment - here.moment_by[which]).abs() < 1e-3, "moment at {c} {h}");
            }
        }
    }

    #[test]
    fn a_patch_beside_the_tile_leaves_nothing_on_it() {
        let slice = Slice::new(0.0, 0.304, 0.5, 0.1);
        assert_eq!(slice, Slice { moment: 0.0, ..Slice::default() });
    }
}
