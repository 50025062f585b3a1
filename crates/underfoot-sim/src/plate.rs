//! One plate, rigid or twisting, on elastic supports that push but do not pull.

use glam::{Mat2, Vec2};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use super::legs::Legs;
use underfoot::floor::{Corner, Geometry, SensorPlaces, TileId};

/// Construction and mounting of the plates of a simulated floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlateConfig {
    /// Mass of a plate with its actuator, in kilograms.
    pub mass_kg: f32,
    /// Force with which the mounting holds each corner down on its support, in newtons.
    pub mount_preload_n: f32,
    /// Largest deviation of a support's stiffness from the mean, as a share (0 to 0.5).
    pub stiffness_spread: f32,
    /// True if supports also pull, as if the plate were screwed to its sensors: no corner ever lifts off.
    pub pulls: bool,
    /// Compliance of the plate in twist, from 0 (rigid) to 1 (no stiffness of its own): the share `4 k / (4 k + K)`
    /// for supports of stiffness `k` and a plate with the twisting stiffness `K`.
    ///
    /// A load off both middle lines then also increases the force on the corners of its own diagonal and decreases it
    /// on the other one, unlike on a rigid plate; the force and both moments stay the same.
    ///
    /// # Source
    /// `K = G h^3 A / (3 r^4)` of a plate in pure twist (Timoshenko and Woinowsky-Krieger, Theory of Plates
    /// and Shells), shear modulus `G` 0.7 GPa of birch plywood, thickness `h`, area `A`, supports `r` from
    /// the middle lines: 12 mm of plywood, 0.30 m wide, give 120 kN/m. On soft feet of 20 to 50 kN/m that
    /// makes 0.4 to 0.6, on feet of 200 kN/m nearly 0.9; 20 mm on soft feet 0.12 to 0.26.
    pub twist: f32,
    /// Maximum deviation of each plate's twist from `twist`, as a share (0 to 0.5).
    pub twist_spread: f32,
}

impl Default for PlateConfig {
    /// The paper's birch plate (30.4 x 30.4 x 2 cm) with its actuator, lightly held down on rubber mounts that differ
    /// in stiffness by up to a tenth (mass from its measures, the rest our choice).
    fn default() -> Self {
        Self {
            mass_kg: 2.6,
            mount_preload_n: 5.0,
            stiffness_spread: 0.1,
            pulls: false,
            twist: 0.0,
            twist_spread: 0.0,
        }
    }
}

impl PlateConfig {
    /// A weightless plate screwed to equal supports.
    #[must_use]
    pub const fn ideal() -> Self {
        Self {
            mass_kg: 0.0,
            mount_preload_n: 0.0,
            stiffness_spread: 0.0,
            pulls: true,
            twist: 0.0,
            twist_spread: 0.0,
        }
    }
}

/// Standard gravity, in metres per second squared.
pub(super) const GRAVITY: f32 = 9.81;

/// One plate with its supports; positions are relative to its centre, in metres.
#[derive(Clone, Debug)]
pub(super) struct Plate {
    supports: Supports,
    /// Downward force of weight and mounting together, acting at the centre.
    preload: f32,
    /// Support forces per unit of force, of moment / reach about either axis and of twist / reach squared.
    sharing: [[f32; 4]; 4],
    pulls: bool,
}

/// The places of a plate's supports.
#[derive(Clone, Copy, Debug)]
enum Supports {
    /// At the corners of an upright rectangle around the centre.
    Rectangle {
        /// Distance from the middle lines.
        reach: Vec2,
        /// Half the plate's size, in units of `reach`.
        edge: Vec2,
    },
    /// At the corners of another parallelogram: a rectangle in coordinates of its own.
    Parallelogram {
        centre: Vec2,
        /// From metres to coordinates in which the supports lie at -1 and 1.
        to_own: Mat2,
        /// Largest coordinates of the plate.
        edge: Vec2,
    },
    Other(Legs),
}

impl Supports {
    fn new(places: SensorPlaces, plate: Vec2, stiffness: [f32; 4]) -> Self {
        if let Some(reach) = places.rectangle() {
            return Self::Rectangle { reach, edge: 0.5 * plate / reach };
        }
        let half = 0.5 * plate;
        if !places.is_parallelogram() {
            return Self::Other(Legs::new(places, stiffness, half));
        }
        let [sw, se, nw, ne] = Corner::ALL.map(|corner| places.place(corner));
        let to_own = Mat2::from_cols(0.5 * (se - sw), 0.5 * (nw - sw)).inverse();
        let centre = 0.5 * (sw + ne);
        let corner = |corner: Corner| (to_own * (half * corner.direction() - centre)).abs();
        let edge = Corner::ALL.map(corner).into_iter().fold(Vec2::ONE, Vec2::max);
        Self::Parallelogram { centre, to_own, edge }
    }
}

/// Sum of the loads on one plate; positions are relative to its centre.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct PlatePress {
    /// Total force, in newtons.
    pub(super) force: f32,
    /// Position of the total force, in metres.
    pub(super) at: Vec2,
    /// Sum of force times x times y, in newton square metres, which twists the plate.
    pub(super) twist: f32,
}

impl PlatePress {
    /// One load at a point.
    pub(super) fn at(force: f32, at: Vec2) -> Self {
        Self { force, at, twist: force * at.x * at.y }
    }
}

impl Plate {
    /// Creates a plate of this floor; `rng` draws the stiffness of its supports.
    pub(super) fn new(geometry: &Geometry, tile: TileId, config: &PlateConfig, rng: &mut Pcg64Mcg) -> Self {
        let spread = config.stiffness_spread.clamp(0.0, 0.5);
        let stiffness = Corner::ALL.map(|_| 1.0 + rng.random_range(-1.0f32..=1.0) * spread);
        let twist = if config.twist > 0.0 {
            let spread = config.twist_spread.clamp(0.0, 0.5);
            (config.twist * (1.0 + rng.random_range(-1.0f32..=1.0) * spread)).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let places = *geometry.sensor_places(tile);
        Self {
            supports: Supports::new(places, geometry.plate_size(tile), stiffness),
            preload: config.mass_kg * GRAVITY + places.count() as f32 * config.mount_preload_n,
            sharing: elastic_sharing(stiffness, twist),
            pulls: config.pulls,
        }
    }

    /// Returns the forces of the supports under a load, in [`Corner::ALL`] order.
    ///
    /// They balance force and both moments exactly if the line of action of the load, including the preload, is
    /// inside the square of the supports. A corner that would have to pull lifts off instead. A load further out tips
    /// the plate until its edge rests on the frame. The sensors do not measure the force on the frame, so the load
    /// appears lighter and further inside than it is.
    ///
    /// # Source
    /// Plate on springs: corner forces `k_i (z + p x_i + q y_i + t x_i y_i)` with z, p, q from balance, and t from
    /// the work of the load in twist against the stiffness of supports and plate. A plate with one corner in the air
    /// rests on three, and balance alone determines their forces. A parallelogram is the same in coordinates along its
    /// sides; without the load's own twist, which is known about upright axes only.
    pub(super) fn supports(&self, load: PlatePress) -> [f32; 4] {
        let total = load.force + self.preload;
        let (moment, twist, edge) = match &self.supports {
            Supports::Rectangle { reach, edge } => {
                (load.at * (load.force / *reach), load.twist / (reach.x * reach.y), *edge)
            }
            Supports::Parallelogram { centre, to_own, edge } => {
                let (at, rest) = (*to_own * (load.at - *centre), *to_own * -*centre);
                (at * load.force + rest * self.preload, load.force * at.x * at.y, *edge)
            }
            Supports::Other(legs) => {
                let line = if total == 0.0 { Vec2::ZERO } else { load.at * (load.force / total) };
                return legs.supports(total, line, self.pulls);
            }
        };
        let elastic = self.sharing.map(|[z, x, y, xy]| z * total + x * moment.x + y * moment.y + xy * twist);
        if self.pulls || elastic.iter().all(|&support| support >= 0.0) {
            return elastic;
        }
        if total <= 0.0 {
            return [0.0; 4];
        }
        let line = moment / total;
        if line.abs().max_element() > 1.0 {
            tipped(total, line, edge)
        } else {
            on_three(elastic, total, line)
        }
    }
}

/// Support forces if the line of action is outside the supports, on one side or beyond a corner; `edge` is half the
/// plate's size.
fn tipped(total: f32, line: Vec2, edge: Vec2) -> [f32; 4] {
    // Along an axis on which the plate tips, support and frame share the force like a lever.
    let carried = |line: f32, edge: f32| {
        let lever = edge - 1.0;
        if line.abs() <= 1.0 || lever < 1e-6 { 1.0 } else { ((edge - line.abs()) / lever).clamp(0.0, 1.0) }
    };
    let seen = total * carried(line.x, edge.x) * carried(line.y, edge.y);
    let line = line.clamp(Vec2::NEG_ONE, Vec2::ONE);
    Corner::ALL.map(|corner| {
        let share = (corner.direction() * line + 1.0) * 0.5;
        seen * share.x * share.y
    })
}

/// Support forces after the corner with the most negative force has lifted off: balance determines the other three.
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

/// Rows of `k_i (1, x_i, y_i, x_i y_i) A^-1`. A sums the springs' resistance to sinking, tilting and twisting, and
/// the plate's own resistance to twisting; the last column is zero for a rigid plate.
fn elastic_sharing(stiffness: [f32; 4], twist: f32) -> [[f32; 4]; 4] {
    let columns = |weight: fn(Vec2) -> glam::Vec3| {
        Corner::ALL.map(|corner| stiffness[corner.index()] * weight(corner.direction())).into_iter().sum()
    };
    let rigid = glam::Mat3::from_cols(
        columns(|at| glam::Vec3::new(1.0, at.x, at.y)),
        columns(|at| glam::Vec3::new(at.x, 1.0, at.x * at.y)),
        columns(|at| glam::Vec3::new(at.y, at.x * at.y, 1.0)),
    );
    if twist <= 0.0 {
        let compliance = rigid.inverse();
        return Corner::ALL.map(|corner| {
            let at = corner.direction();
            let shares = compliance * glam::Vec3::new(1.0, at.x, at.y) * stiffness[corner.index()];
            shares.extend(0.0).to_array()
        });
    }
    let supports: f32 = stiffness.iter().sum();
    let modes = |at: Vec2| glam::Vec4::new(1.0, at.x, at.y, at.x * at.y);
    let mut resistance = glam::Mat4::ZERO;
    for corner in Corner::ALL {
        let modes = modes(corner.direction());
        for column in 0..4 {
            *resistance.col_mut(column) += modes * (modes[column] * stiffness[corner.index()]);
        }
    }
    // The plate's own stiffness in twist, from the compliance `twist`.
    resistance.col_mut(3).w += supports * (1.0 / twist - 1.0);
    let compliance = resistance.inverse();
    Corner::ALL.map(|corner| (compliance * modes(corner.direction()) * stiffness[corner.index()]).to_array())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use rand::SeedableRng;

    use super::*;

    const REACH: f32 = 0.132;

    fn plate(config: PlateConfig) -> Plate {
        Plate::new(&Geometry::default(), TileId::new(0, 0), &config, &mut Pcg64Mcg::seed_from_u64(3))
    }

    /// Force and position of the load as the sensors report it, without tare.
    fn sensed(plate: &Plate, force: f32, at: Vec2) -> (f32, Vec2) {
        let (loaded, empty) =
            (plate.supports(PlatePress::at(force, at)), plate.supports(PlatePress::default()));
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
            // Heavy loads near a corner lift the opposite one off; balance must hold even so.
            let plate = plate(PlateConfig::default());
            let at = Vec2::new(x, y);
            let (felt, place) = sensed(&plate, force, at);
            prop_assert!((felt - force).abs() < 1e-3 * force + 1e-3, "{felt} for {force}");
            prop_assert!(place.distance(at) * force < 1e-4 * force + 1e-4, "{place} for {at}");
            prop_assert!(plate.supports(PlatePress::at(force, at)).iter().all(|&support| support >= 0.0));
        }

        #[test]
        fn no_load_on_the_plate_makes_a_support_pull_or_gain(
            force in 0.0f32..3000.0, x in -0.152f32..0.152, y in -0.152f32..0.152,
        ) {
            let plate = plate(PlateConfig::default());
            let supports = plate.supports(PlatePress::at(force, Vec2::new(x, y)));
            prop_assert!(supports.iter().all(|&support| support >= 0.0));
            let sum: f32 = supports.iter().sum();
            prop_assert!(sum <= (force + plate.preload) * 1.001);
        }
    }

    #[test]
    fn a_panel_on_the_middles_of_its_edges_carries_a_foot_where_it_stands() {
        let places = [(0.0, -0.13), (0.13, 0.0), (-0.13, 0.0), (0.0, 0.13)].map(Vec2::from);
        let places = SensorPlaces::at(&places).unwrap();
        let geometry = Geometry::of_paper_tiles(1, 1).unwrap().with_sensors(places).unwrap();
        let mut rng = Pcg64Mcg::seed_from_u64(3);
        let plate = Plate::new(&geometry, geometry.first(), &PlateConfig::default(), &mut rng);
        let rest = plate.supports(PlatePress::default());
        for at in [Vec2::ZERO, Vec2::new(0.06, -0.02), Vec2::new(0.0, 0.12), Vec2::new(-0.05, 0.07)] {
            let loaded = plate.supports(PlatePress::at(400.0, at));
            let net = [0, 1, 2, 3].map(|leg| loaded[leg] - rest[leg]);
            let felt: f32 = net.iter().sum();
            assert!((felt - 400.0).abs() < 0.5, "{felt} at {at}");
            assert!((places.moment(net) / felt).distance(at) < 1e-4, "{net:?} at {at}");
            assert!(loaded.iter().all(|support| *support >= 0.0));
        }
        // A corner of the panel has nothing below it: the foot tips the panel onto its frame.
        let corner: f32 = plate.supports(PlatePress::at(400.0, Vec2::splat(0.14))).iter().sum();
        assert!(corner < 420.0, "{corner}");
    }

    #[test]
    fn equal_supports_share_a_central_load_equally() {
        let plate = plate(PlateConfig::ideal());
        assert_eq!(plate.supports(PlatePress::at(400.0, Vec2::ZERO)), [100.0; 4]);
        // Half way to a corner: half of the load on that corner, a quarter on each beside it, none opposite.
        let supports = plate.supports(PlatePress::at(400.0, Vec2::splat(REACH / 2.0)));
        for (support, expected) in supports.iter().zip([0.0, 100.0, 100.0, 200.0]) {
            assert!((support - expected).abs() < 1e-3, "{supports:?}");
        }
    }

    #[test]
    fn a_heavy_foot_near_one_corner_lifts_the_opposite_one() {
        let plate = plate(PlateConfig { stiffness_spread: 0.0, ..PlateConfig::default() });
        let light = plate.supports(PlatePress::at(20.0, Vec2::splat(0.1)));
        assert!(light[0] > 0.0, "preload holds it down: {light:?}");
        let heavy = plate.supports(PlatePress::at(700.0, Vec2::splat(0.1)));
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
        let mut before = plate.supports(PlatePress::at(700.0, Vec2::new(0.0, 0.06)));
        for step in 1..=1000 {
            let at = Vec2::new(0.152, 0.092) * (step as f32 / 1000.0) + Vec2::new(0.0, 0.06);
            let now = plate.supports(PlatePress::at(700.0, at));
            for (now, before) in now.iter().zip(before) {
                assert!((now - before).abs() < 12.0, "at {at}: {before} to {now}");
            }
            before = now;
        }
    }

    #[test]
    fn a_twisting_plate_keeps_force_and_moments_and_presses_its_own_diagonal_harder() {
        let at = Vec2::new(0.08, 0.06);
        let [rigid, soft] = [0.0, 0.6].map(|twist| {
            plate(PlateConfig { stiffness_spread: 0.0, twist, pulls: true, ..PlateConfig::default() })
        });
        for plate in [&rigid, &soft] {
            let (force, place) = sensed(plate, 400.0, at);
            assert!((force - 400.0).abs() < 0.1 && place.distance(at) < 1e-4, "{force} at {place}");
        }
        let twist = |plate: &Plate| {
            let [sw, se, nw, ne] = plate.supports(PlatePress::at(400.0, at));
            sw + ne - se - nw
        };
        assert!(twist(&rigid).abs() < 0.01, "{}", twist(&rigid));
        // On equal supports the twist is the compliance times force, x and y in units of the reach.
        let expected = 0.6 * 400.0 * at.x * at.y / (REACH * REACH);
        assert!((twist(&soft) - expected).abs() < 0.5, "{} for {expected}", twist(&soft));
    }

    #[test]
    fn a_plate_without_stiffness_shares_a_load_as_a_loose_cloth_would() {
        let plate = plate(PlateConfig { twist: 1.0, ..PlateConfig::ideal() });
        // At a support: all of the load on it. Half way between two: half on each.
        let supports = plate.supports(PlatePress::at(100.0, Vec2::new(REACH, -REACH)));
        for (support, expected) in supports.iter().zip([0.0, 100.0, 0.0, 0.0]) {
            assert!((support - expected).abs() < 1e-3, "{supports:?}");
        }
        let supports = plate.supports(PlatePress::at(100.0, Vec2::splat(0.5 * REACH)));
        for (support, expected) in supports.iter().zip([6.25, 18.75, 18.75, 56.25]) {
            assert!((support - expected).abs() < 1e-3, "{supports:?}");
        }
    }
}
