//! One rigid plate on four elastic supports that can push but not pull.

use glam::Vec2;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use crate::floor::{Corner, Geometry};

/// How the plates of a simulated floor are built and mounted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlateConfig {
    /// Mass of a plate with its actuator, in kilograms.
    pub mass_kg: f32,
    /// Force with which the mounting holds each corner down on its support, in newtons.
    pub mount_preload_n: f32,
    /// Largest deviation of a support's stiffness from the mean, as a share (0 to 0.5).
    pub stiffness_spread: f32,
    /// Whether supports also pull, as if the plate were screwed to its sensors: no corner ever lifts off.
    pub pulls: bool,
}

impl Default for PlateConfig {
    /// The paper's birch plate (30.4 x 30.4 x 2 cm) with its actuator, lightly
    /// held down on rubber mounts whose stiffness differs by up to a tenth (mass
    /// from its measures, the rest our choice).
    fn default() -> Self {
        Self { mass_kg: 2.6, mount_preload_n: 5.0, stiffness_spread: 0.1, pulls: false }
    }
}

impl PlateConfig {
    /// A weightless plate screwed to equal supports.
    #[must_use]
    pub const fn ideal() -> Self {
        Self { mass_kg: 0.0, mount_preload_n: 0.0, stiffness_spread: 0.0, pulls: true }
    }
}

/// Standard gravity, in metres per second squared.
pub(super) const GRAVITY: f32 = 9.81;

/// One plate with its supports; places are relative to its centre, in metres.
#[derive(Clone, Debug)]
pub(super) struct Plate {
    /// Distance of the supports from the centre line.
    reach: f32,
    /// Half the plate's side, in units of `reach`.
    edge: f32,
    /// Downward force of weight and mounting together, acting at the centre.
    preload: f32,
    /// Support forces per unit of force and of moment / reach about either axis.
    sharing: [[f32; 3]; 4],
    pulls: bool,
}

impl Plate {
    /// A plate of this floor; `rng` draws the stiffness of its supports.
    pub(super) fn new(geometry: &Geometry, config: &PlateConfig, rng: &mut Pcg64Mcg) -> Self {
        let spread = config.stiffness_spread.clamp(0.0, 0.5);
        let stiffness = Corner::ALL.map(|_| 1.0 + rng.random_range(-1.0f32..=1.0) * spread);
        let reach = geometry.sensor_reach_m();
        Self {
            reach,
            edge: 0.5 * geometry.tile_m() / reach,
            preload: config.mass_kg * GRAVITY + 4.0 * config.mount_preload_n,
            sharing: elastic_sharing(stiffness),
            pulls: config.pulls,
        }
    }

    /// The forces of the supports under a load of `force` newtons at `at`, in [`Corner::ALL`] order.
    ///
    /// They balance force and both moments exactly as long as the load's line,
    /// preload included, stays inside the square of the supports. A corner that
    /// would have to pull lifts off instead. A load further out tips the plate
    /// until its edge rests on the frame: what the frame carries, no sensor
    /// sees, so the load looks lighter and further inside than it is.
    ///
    /// # Source
    /// Rigid plate on springs: corner forces `k_i (z + p x_i + q y_i)` with z, p, q from balance.
    pub(super) fn supports(&self, force: f32, at: Vec2) -> [f32; 4] {
        let total = force + self.preload;
        let moment = at * (force / self.reach);
        let elastic = self.sharing.map(|[z, x, y]| z * total + x * moment.x + y * moment.y);
        if self.pulls || elastic.iter().all(|&support| support >= 0.0) {
            return elastic;
        }
        if total <= 0.0 {
            return [0.0; 4];
        }
        let line = moment / total;
        if line.abs().max_element() > 1.0 { self.tipped(total, line) } else { on_three(elastic, total, line) }
    }

    /// The load's line lies outside the supports, on one side or beyond a corner.
    fn tipped(&self, total: f32, line: Vec2) -> [f32; 4] {
        // Along an axis on which the plate tips, support and frame share like a lever.
        let carried = |line: f32| {
            let lever = self.edge - 1.0;
            if line.abs() <= 1.0 || lever < 1e-6 {
                1.0
            } else {
                ((self.edge - line.abs()) / lever).clamp(0.0, 1.0)
            }
        };
        let seen = total * carried(line.x) * carried(line.y);
        let line = line.clamp(Vec2::NEG_ONE, Vec2::ONE);
        Corner::ALL.map(|corner| {
            let share = (corner.direction() * line + 1.0) * 0.5;
            seen * share.x * share.y
        })
    }
}

/// The corner that would pull most has lifted off; balance fixes the other three.
fn on_three(elastic: [f32; 4], total: f32, line: Vec2) -> [f32; 4] {
    let lifted = Corner::ALL
        .into_iter()
        .min_by(|a, b| elastic[a.index()].total_cmp(&elastic[b.index()]))
        .unwrap_or(Corner::SouthWest);
    let away = lifted.direction() * line;
    Corner::ALL.map(|corner| {
        let side = corner.direction() * lifted.direction();
        let share = match (side.x > 0.0, side.y > 0.0) {
            (true, true) => 0.0,
            (true, false) => 0.5 * (1.0 + away.x),
            (false, true) => 0.5 * (1.0 + away.y),
            (false, false) => -0.5 * (away.x + away.y),
        };
        (total * share).max(0.0)
    })
}

/// Rows of `k_i (1, x_i, y_i) A^-1`, where A sums the springs' resistance to sinking and tilting.
fn elastic_sharing(stiffness: [f32; 4]) -> [[f32; 3]; 4] {
    let columns = |weight: fn(Vec2) -> glam::Vec3| {
        Corner::ALL.map(|corner| stiffness[corner.index()] * weight(corner.direction())).into_iter().sum()
    };
    let resistance = glam::Mat3::from_cols(
        columns(|at| glam::Vec3::new(1.0, at.x, at.y)),
        columns(|at| glam::Vec3::new(at.x, 1.0, at.x * at.y)),
        columns(|at| glam::Vec3::new(at.y, at.x * at.y, 1.0)),
    );
    let compliance = resistance.inverse();
    Corner::ALL.map(|corner| {
        let at = corner.direction();
        (compliance * glam::Vec3::new(1.0, at.x, at.y) * stiffness[corner.index()]).to_array()
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use rand::SeedableRng;

    use super::*;

    const REACH: f32 = 0.132;

    fn plate(config: PlateConfig) -> Plate {
        Plate::new(&Geometry::default(), &config, &mut Pcg64Mcg::seed_from_u64(3))
    }

    /// Force and place of the load that the sensors report, tare taken off.
    fn sensed(plate: &Plate, force: f32, at: Vec2) -> (f32, Vec2) {
        let (loaded, empty) = (plate.supports(force, at), plate.supports(0.0, Vec2::ZERO));
        let net: Vec<f32> = loaded.iter().zip(empty).map(|(loaded, empty)| loaded - empty).collect();
        let sum: f32 = net.iter().sum();
        let moment: Vec2 =
            Corner::ALL.iter().zip(&net).map(|(corner, net)| corner.direction() * REACH * *net).sum();
        (sum, moment / sum)
    }

    proptest! {
        #[test]
        fn force_and_moments_balance_anywhere_inside_the_supports(
            force in 1.0f32..1500.0, x in -REACH..REACH, y in -REACH..REACH,
        ) {
            // Heavy loads near a corner lift the opposite one off; balance must still hold.
            let plate = plate(PlateConfig::default());
            let at = Vec2::new(x, y);
            let (felt, place) = sensed(&plate, force, at);
            prop_assert!((felt - force).abs() < 1e-3 * force + 1e-3, "{felt} for {force}");
            prop_assert!(place.distance(at) * force < 1e-4 * force + 1e-4, "{place} for {at}");
            prop_assert!(plate.supports(force, at).iter().all(|&support| support >= 0.0));
        }

        #[test]
        fn no_load_on_the_plate_makes_a_support_pull_or_gain(
            force in 0.0f32..3000.0, x in -0.152f32..0.152, y in -0.152f32..0.152,
        ) {
            let plate = plate(PlateConfig::default());
            let supports = plate.supports(force, Vec2::new(x, y));
            prop_assert!(supports.iter().all(|&support| support >= 0.0));
            let sum: f32 = supports.iter().sum();
            prop_assert!(sum <= (force + plate.preload) * 1.001);
        }
    }

    #[test]
    fn equal_supports_share_a_central_load_equally() {
        let plate = plate(PlateConfig::ideal());
        assert_eq!(plate.supports(400.0, Vec2::ZERO), [100.0; 4]);
        // Half way to a corner: three quarters of the way up to half the load there, none opposite.
        let supports = plate.supports(400.0, Vec2::splat(REACH / 2.0));
        for (support, expected) in supports.iter().zip([0.0, 100.0, 100.0, 200.0]) {
            assert!((support - expected).abs() < 1e-3, "{supports:?}");
        }
    }

    #[test]
    fn a_heavy_foot_near_one_corner_lifts_the_opposite_one() {
        let plate = plate(PlateConfig { stiffness_spread: 0.0, ..PlateConfig::default() });
        let light = plate.supports(20.0, Vec2::splat(0.1));
        assert!(light[0] > 0.0, "preload holds it down: {light:?}");
        let heavy = plate.supports(700.0, Vec2::splat(0.1));
        assert_eq!(heavy[0], 0.0, "{heavy:?}");
        assert!(heavy[3] > 400.0, "{heavy:?}");
    }

    #[test]
    fn a_load_on_the_rim_tips_the_plate_and_looks_lighter_and_further_inside() {
        let plate = plate(PlateConfig::default());
        let rim = Vec2::new(0.15, 0.0);
        let (felt, place) = sensed(&plate, 100.0, rim);
        assert!((felt - 100.0).abs() < 0.1 && place.distance(rim) < 1e-4, "preload balances a light load");
        let (felt, place) = sensed(&plate, 700.0, rim);
        assert!(felt < 600.0, "{felt}");
        assert!((0.125..0.149).contains(&place.x), "{place}");
    }

    #[test]
    fn tipping_sets_in_without_a_jump() {
        let plate = plate(PlateConfig::default());
        let mut before = plate.supports(700.0, Vec2::new(0.0, 0.06));
        for step in 1..=1000 {
            let at = Vec2::new(0.152, 0.092) * (step as f32 / 1000.0) + Vec2::new(0.0, 0.06);
            let now = plate.supports(700.0, at);
            for (now, before) in now.iter().zip(before) {
                assert!((now - before).abs() < 12.0, "at {at}: {before} to {now}");
            }
            before = now;
        }
    }
}
