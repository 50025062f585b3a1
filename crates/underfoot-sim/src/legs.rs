//! A rigid plate on three supports, or on four that form no parallelogram.

use glam::{DMat3, DVec3, Vec2};

use underfoot::floor::{Corner, SensorPlaces};

/// Tolerance of shares of a load that count as zero.
const NOTHING: f32 = 1e-5;

/// The supports of a rigid plate; positions are relative to its centre, in metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Legs {
    places: SensorPlaces,
    /// Stiffness of each support, relative to the mean.
    stiffness: [f32; 4],
    /// Half the size of the plate.
    half: Vec2,
}

impl Legs {
    pub(super) const fn new(places: SensorPlaces, stiffness: [f32; 4], half: Vec2) -> Self {
        Self { places, stiffness, half }
    }

    /// Returns the forces of the supports under the force `total` that acts at `line`.
    ///
    /// A support that would have to pull lifts off, unless supports pull. A force beyond the supports tips the plate
    /// until its edge rests on the frame, which carries the rest.
    ///
    /// # Source
    /// Plate on springs: forces `k_i (z + p x_i + q y_i)` with force and both moments in balance.
    pub(super) fn supports(&self, total: f32, line: Vec2, pulls: bool) -> [f32; 4] {
        let all = self.places.sensors();
        let Some(shares) = self.shares(all, line) else { return [0.0; 4] };
        if pulls || are_borne(&shares) {
            return shares.map(|share| total * share);
        }
        if total <= 0.0 {
            return [0.0; 4];
        }
        let inside = self.nearest_inside(line);
        let beyond = inside.distance(line);
        let carried = if beyond > 0.0 { self.carried(inside, (line - inside) / beyond, beyond) } else { 1.0 };
        let borne = self.borne(&shares, inside).unwrap_or_default();
        borne.map(|share| (total * carried * share).max(0.0))
    }

    /// The shares of a force at `inside`, with the support lifted off that pulls most among those that can: the others
    /// must stand around the force.
    fn borne(&self, elastic: &[f32; 4], inside: Vec2) -> Option<[f32; 4]> {
        let all = self.places.sensors();
        let whole = self.shares(all, inside)?;
        if are_borne(&whole) {
            return Some(whole);
        }
        let without = |lifted: Corner| {
            let mut three = Corner::ALL;
            let mut others = all.iter().copied().filter(|corner| *corner != lifted);
            let three = &mut three[..3];
            three.fill_with(|| others.next().unwrap_or(lifted));
            self.shares(three, inside).filter(are_borne)
        };
        let candidates = all.iter().filter_map(|&lifted| Some((elastic[lifted.index()], without(lifted)?)));
        candidates.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, shares)| shares)
    }

    /// The shares of a force at `line` among these supports; `None` if they lie on one line.
    fn shares(&self, among: &[Corner], line: Vec2) -> Option<[f32; 4]> {
        let modes = |place: Vec2| DVec3::new(1.0, place.x.into(), place.y.into());
        let mut springs = DMat3::ZERO;
        for &corner in among {
            let (stiffness, modes) = (self.stiffness[corner.index()], modes(self.places.place(corner)));
            springs += DMat3::from_cols(modes, modes * modes.y, modes * modes.z) * f64::from(stiffness);
        }
        if springs.determinant().abs() < 1e-12 {
            return None;
        }
        let sinks = springs.inverse() * modes(line);
        let mut shares = [0.0; 4];
        for &corner in among {
            let sunk = modes(self.places.place(corner)).dot(sinks) as f32;
            shares[corner.index()] = self.stiffness[corner.index()] * sunk;
        }
        Some(shares)
    }

    /// The point between the supports that is nearest to `point`: `point` itself if it lies there.
    fn nearest_inside(&self, point: Vec2) -> Vec2 {
        // Around the plate; the third and the fourth of four are the north-western and the north-eastern one.
        let order: &[usize] = if self.places.count() == 3 { &[0, 1, 2] } else { &[0, 1, 3, 2] };
        let places = self.places.as_slice();
        let corner = |at: usize| places[order[at % order.len()]];
        let edges = || (0..order.len()).map(|at| (corner(at), corner(at + 1)));
        let sides = || edges().map(|(from, to)| (to - from).perp_dot(point - from));
        if sides().all(|side| side >= 0.0) || sides().all(|side| side <= 0.0) {
            return point;
        }
        let nearest = edges().map(|(from, to)| {
            let way = to - from;
            from + way * ((point - from).dot(way) / way.length_squared()).clamp(0.0, 1.0)
        });
        let distance = |place: &Vec2| place.distance_squared(point);
        nearest.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(point)
    }

    /// The share of a force that the supports carry if it acts `beyond` metres from the outermost point `from` between
    /// them, in the direction `way`: support and frame share it like a lever.
    fn carried(&self, from: Vec2, way: Vec2, beyond: f32) -> f32 {
        let along = |from: f32, way: f32, half: f32| {
            if way.abs() < 1e-6 { f32::INFINITY } else { (half.copysign(way) - from) / way }
        };
        let lever = along(from.x, way.x, self.half.x).min(along(from.y, way.y, self.half.y));
        if lever < 1e-6 { 1.0 } else { (1.0 - beyond / lever).clamp(0.0, 1.0) }
    }
}

/// Whether no support pulls.
fn are_borne(shares: &[f32; 4]) -> bool {
    shares.iter().all(|share| *share >= -NOTHING)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn legs(places: &[(f32, f32)]) -> Legs {
        let places: Vec<Vec2> = places.iter().copied().map(Vec2::from).collect();
        Legs::new(SensorPlaces::at(&places).unwrap(), [1.1, 0.95, 1.0, 0.9], Vec2::splat(0.2))
    }

    fn all() -> [Legs; 2] {
        [
            legs(&[(-0.17, -0.15), (0.17, -0.15), (0.0, 0.17)]),
            legs(&[(-0.18, -0.15), (0.18, -0.15), (-0.1, 0.17), (0.1, 0.17)]),
        ]
    }

    #[test]
    fn a_foot_between_the_legs_is_carried_whole_and_in_its_place() {
        for legs in all() {
            for (x, y) in [(0.0, 0.0), (0.05, -0.1), (-0.02, 0.09), (0.12, -0.13)] {
                let at = Vec2::new(x, y);
                let forces = legs.supports(700.0, at, false);
                let whole: f32 = forces.iter().sum();
                assert!(
                    (whole - 700.0).abs() < 0.1 && forces.iter().all(|force| *force >= 0.0),
                    "{forces:?}"
                );
                assert!((legs.places.moment(forces) / whole).distance(at) < 1e-4, "{forces:?} at {at}");
            }
        }
    }

    #[test]
    fn a_foot_beyond_the_legs_looks_lighter_and_further_inside() {
        for legs in all() {
            let forces = legs.supports(700.0, Vec2::new(0.19, 0.15), false);
            let whole: f32 = forces.iter().sum();
            assert!((10.0..690.0).contains(&whole), "{forces:?}");
            assert!((legs.places.moment(forces) / whole).x < 0.15);
            assert_eq!(legs.supports(700.0, Vec2::new(0.2, 0.3), false).iter().sum::<f32>(), 0.0);
        }
    }

    #[test]
    fn tipping_sets_in_without_a_jump() {
        for legs in all() {
            let mut before = legs.supports(700.0, Vec2::ZERO, false);
            for step in 1..=1000 {
                let now = legs.supports(700.0, Vec2::new(0.2, 0.15) * (step as f32 / 1000.0), false);
                let most =
                    now.iter().zip(before).map(|(now, before)| (now - before).abs()).fold(0.0, f32::max);
                assert!(most < 12.0, "{step}: {before:?} to {now:?}");
                before = now;
            }
        }
    }
}
