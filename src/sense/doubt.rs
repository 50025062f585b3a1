use glam::Vec2;

use super::contact::Covariance;
use super::tile::LoadedTile;
use crate::floor::{Corner, Geometry};

/// What is not known about the sensors, however well they are calibrated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorDoubt {
    /// Standard deviation of a sensor's zero, in newtons.
    pub offset_n: f32,
    /// Standard deviation of a sensor's gain after calibration, as a share of the reading.
    pub gain: f32,
}

/// How far from the centroid the load acts that no tile is seen to carry, in metres, if it is as much as four
/// sensors' zeros may hide (by the coverage of feet of 50 N).
const UNSEEN_M: f32 = 0.07;

impl Default for SensorDoubt {
    /// A fifth of a newton of offset, 13.5 % of gain: what remains once an empty floor's zeros have been followed, and
    /// after a calibration.
    ///
    /// The paper's 5 % (section 2.2) are of full scale. Of a reading it is more, and the ellipses hold 95 % of
    /// the true places on simulated parts like the paper's with this much.
    fn default() -> Self {
        Self { offset_n: 0.2, gain: 0.135 }
    }
}

impl SensorDoubt {
    /// Covariance of a centroid at `point` that carries `force` in all, as far as the
    /// sensors of `tile` are to blame; those of all its tiles add up.
    ///
    /// `share` of the tile's load is the contact's own: its gain errors count for that part.
    ///
    /// # Source
    /// First-order propagation through c = Σ fᵢ xᵢ / Σ fᵢ:
    /// ∂c/∂fᵢ = (xᵢ − c) / F, var fᵢ = offset² + (gain fᵢ)² + vague², the
    /// last for a sensor that is estimated, not calibrated or at the end of its range. On a tile with a
    /// position map, what that leaves ([`crate::floor::PositionMap::residual_m`]) takes the place of the gain.
    #[must_use]
    pub fn covariance(
        &self,
        geometry: &Geometry,
        tile: &LoadedTile,
        share: f32,
        point: Vec2,
        force: f32,
    ) -> Covariance {
        let mut sum = Covariance::default();
        let reach = geometry.sensor_reach_m();
        let scale = 1.0 / (force * force).max(1e-6);
        let gain = if tile.mapped_m().is_some() { 0.0 } else { self.gain };
        // What a map leaves shifts the tile's own part of the load.
        let left = tile.mapped_m().unwrap_or_default() * share * tile.wrench.force;
        // Tiles that the load strays to are as uncertain as their sensors' zeros, and some load is not seen at all.
        let unseen = self.offset_n * self.offset_n * (tile.strayed_m2() + 4.0 * UNSEEN_M * UNSEEN_M);
        let all = (left * left + unseen) * scale;
        sum += Covariance { xx: all, xy: 0.0, yy: all };
        for corner in Corner::ALL {
            let arm = tile.centre + corner.direction() * reach - point;
            let gained = gain * share * tile.corners[corner.index()];
            let vague = share * tile.vague[corner.index()];
            let variance = (self.offset_n * self.offset_n + gained * gained + vague * vague) * scale;
            sum.xx += arm.x * arm.x * variance;
            sum.xy += arm.x * arm.y * variance;
            sum.yy += arm.y * arm.y * variance;
        }
        sum
    }
}

impl std::ops::AddAssign for Covariance {
    fn add_assign(&mut self, other: Self) {
        self.xx += other.xx;
        self.xy += other.xy;
        self.yy += other.yy;
    }
}
