//! Contacts: feet and objects that press the floor in one place.

mod cursor;
pub(super) mod pool;

use glam::Vec2;
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

pub use cursor::Cursor;

use super::Quality;
pub use crate::floor::ContactId;
use crate::floor::TileId;
use crate::units::Newtons;

pub use cursor::{CursorPicker, Stickiness};

/// The part of a contact that one tile carries.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TileLoad {
    /// The tile.
    pub tile: TileId,
    /// Its place in tile-index order.
    pub index: usize,
    /// Force of the contact on this tile, positive.
    pub force: Newtons,
    /// Centroid of that part, in floor metres.
    pub centroid: Vec2,
}

/// Uncertainty of a position: the symmetric 2 x 2 covariance matrix, in square metres.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Covariance {
    /// Variance eastwards.
    pub xx: f32,
    /// Covariance of east and north.
    pub xy: f32,
    /// Variance northwards.
    pub yy: f32,
}

impl Covariance {
    /// The same variance in every direction, from a standard deviation in metres.
    #[must_use]
    pub fn isotropic(deviation_m: f32) -> Self {
        let variance = deviation_m * deviation_m;
        Self { xx: variance, xy: 0.0, yy: variance }
    }

    /// Half axes of the ellipse that contains the true point in 95 of 100 cases, longer one first, in metres.
    ///
    /// # Source
    /// Square roots of the eigenvalues times sqrt(5.991), the 95 % quantile of
    /// chi-squared with two degrees of freedom.
    #[must_use]
    pub fn ellipse_95_m(self) -> (f32, f32) {
        let mean = 0.5 * (self.xx + self.yy);
        let spread = (0.25 * (self.xx - self.yy).powi(2) + self.xy * self.xy).sqrt();
        let half = |variance: f32| 2.4477 * variance.max(0.0).sqrt();
        (half(mean + spread), half(mean - spread))
    }

    /// Squared distance of `offset` (metres) from the middle in units of the standard
    /// deviation along it: at most 5.991 inside the 95 % ellipse; infinite for a singular matrix.
    #[must_use]
    pub fn mahalanobis_squared(self, offset: Vec2) -> f32 {
        let det = self.xx * self.yy - self.xy * self.xy;
        if det <= 0.0 {
            return f32::INFINITY;
        }
        (self.yy * offset.x * offset.x - 2.0 * self.xy * offset.x * offset.y + self.xx * offset.y * offset.y)
            / det
    }
}

/// One foot (or other object) on the floor.
///
/// `Contact::default()` is a contact without name and force at the origin, as a default for the other fields.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contact {
    /// Its identifier, constant as long as it stays down.
    pub id: ContactId,
    /// Force-weighted centroid, in floor metres; always finite.
    pub centroid: Vec2,
    /// Total normal force, positive.
    pub force: Newtons,
    /// Velocity of the centroid, in metres per second.
    pub velocity: Vec2,
    /// The tiles that carry it, heaviest first, at least one.
    pub tiles: SmallVec<[TileLoad; 4]>,
    /// Uncertainty of `centroid`. A contact of a few newtons may be uncertain by several centimetres, and should then
    /// operate nothing.
    pub covariance: Covariance,
    /// Whether it shares its tiles with another contact so that the forces do not determine the division: the sum of
    /// the two is reliable, each one's part is an estimate.
    pub ambiguous: bool,
    /// Whether it may be a part of another contact: it was split from that one, or other explanations of their loads
    /// are likely, and it has carried no tile by itself since. It is `ambiguous` as well, and operates no control with
    /// a guard.
    pub split: bool,
    /// The worst quality among the tiles that carry it; never worse than [`Quality::Degraded`], since worse tiles
    /// carry no contact.
    pub quality: Quality,
    /// The paper's difference vector between the centroids of its two heaviest tiles,
    /// heavier minus lighter; `None` on a single tile.
    ///
    /// Its direction indicates that of the foot: along the foot where that is a line, turned towards the seam's
    /// normal the rounder the foot is (a disc always gives the normal). Its sign contains no information about heel
    /// and toe.
    ///
    /// # Source
    /// Paper, section 3.2 and figure 7.
    pub difference: Option<Vec2>,
}

impl Contact {
    /// The paper's difference vector of `tiles`, heaviest first; see [`Contact::difference`].
    #[must_use]
    pub(super) fn difference_of(tiles: &[TileLoad]) -> Option<Vec2> {
        match tiles {
            [first, second, ..] => Some(first.centroid - second.centroid),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ellipse_of_a_round_covariance_is_a_circle_of_2_45_deviations() {
        let (long, short) = Covariance::isotropic(0.01).ellipse_95_m();
        assert!((long - 0.024_477).abs() < 1e-5 && (short - long).abs() < 1e-5);
        let on_the_rim = Covariance::isotropic(0.01).mahalanobis_squared(Vec2::new(long, 0.0));
        assert!((on_the_rim - 5.991).abs() < 0.01, "{on_the_rim}");
        assert_eq!(Covariance::default().mahalanobis_squared(Vec2::X), f32::INFINITY);
    }

    #[test]
    fn a_slanted_covariance_keeps_its_long_axis() {
        let slanted = Covariance { xx: 2.0, xy: 1.9, yy: 2.0 };
        let (long, short) = slanted.ellipse_95_m();
        assert!(long > 4.0 * short);
        assert!(slanted.mahalanobis_squared(Vec2::ONE) < slanted.mahalanobis_squared(Vec2::new(1.0, -1.0)));
    }
}
