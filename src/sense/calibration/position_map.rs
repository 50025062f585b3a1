//! Fits a tile's position map to known points pressed on it.

use glam::Vec2;
use nalgebra::{DMatrix, DVector};
use thiserror::Error;

use crate::floor::{Corner, Geometry, PositionMap, SensorPlaces, TileId};
use crate::sense::Wrench;

/// One known point, pressed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressedPoint {
    /// True place, in metres from the tile's centre.
    pub at: Vec2,
    /// Readings of the tile's sensors, calibrated and tared, in newtons ([`Corner::ALL`] order).
    pub forces: [f32; 4],
    /// Pressing force in newtons, if known.
    pub force: Option<f32>,
}

impl PressedPoint {
    /// Place by Eq. 3 alone, in metres from the tile's centre.
    fn estimate(&self, on: MappedTile<'_>) -> Vec2 {
        Wrench::of_corners(self.forces, on.places()).arm(on.half_cell())
    }
}

/// The tile of a map.
#[derive(Clone, Copy, Debug)]
struct MappedTile<'a> {
    geometry: &'a Geometry,
    tile: TileId,
}

impl MappedTile<'_> {
    fn places(&self) -> &SensorPlaces {
        self.geometry.sensor_places(self.tile)
    }

    /// Half the size of its cell (m).
    fn half_cell(&self) -> Vec2 {
        0.5 * self.geometry.pitch_m()
    }

    /// Usual lever of its sensors along one axis (m).
    fn reach(&self) -> f32 {
        let mean = |sum: f32, count: usize| 0.5 * sum / count as f32;
        let places = self.places();
        let levers = |place: &Vec2| place.abs().element_sum();
        match places.rectangle() {
            Some(reach) => mean(reach.element_sum(), 1),
            None => mean(places.as_slice().iter().map(levers).sum(), places.count()),
        }
    }
}

/// A known point and its place as measured by the floor, without the readings of single sensors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sighting {
    /// True place, in metres from the tile's centre.
    pub at: Vec2,
    /// Measured place, in metres from the tile's centre.
    pub estimate: Vec2,
}

/// A fitted map and its effect on the points of the fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapFit {
    /// The map.
    pub map: PositionMap,
    /// Points used.
    pub points: usize,
    /// Errors without the map.
    pub before: Errors,
    /// Errors with it, each point by a map fitted without it and its neighbours.
    pub after: Errors,
}

/// Distances between the measured and the true places, in metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    /// Median.
    pub median_m: f32,
    /// 95th percentile.
    pub p95_m: f32,
    /// Maximum.
    pub worst_m: f32,
}

/// Reason for which no map fits a tile.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum MapError {
    /// Too few points.
    #[error("a map needs at least {min} points, not {points}", min = MapFit::MIN_POINTS)]
    TooFewPoints {
        /// Points that could be used.
        points: usize,
    },
    /// The points do not cover a part of the tile.
    #[error("the points leave the {side} of the tile out: press nearer to that edge")]
    NoSpread {
        /// The part.
        side: &'static str,
    },
    /// A point is not a number.
    #[error("point {index} is not a finite number")]
    NotFinite {
        /// Its index, from 0.
        index: usize,
    },
    /// No correction brings points outside of the fit closer to their true places.
    #[error("no map improves on none: {rms_mm:.1} mm are left of {before_mm:.1} mm")]
    NoBetter {
        /// Root mean square error with the best map.
        rms_mm: f32,
        /// Root mean square error without a map.
        before_mm: f32,
    },
}

impl MapFit {
    /// Minimum number of points of a map: the number of parameters of a bend, and some to check.
    pub const MIN_POINTS: usize = 16;

    /// Required reach of the points towards each edge, as a share of half the plate (our choice).
    const REACH: f32 = 0.6;

    /// Number of folds of the cross-validation, each tested on the map of the others.
    const FOLDS: usize = 5;

    /// The map of `tile` from the points pressed on it, in any order, with any forces.
    ///
    /// Points pressed with several forces each, from a light foot's to a person's weight, give the best map. Leave
    /// out saturated readings. The known force, where given, also corrects the measured weight.
    ///
    /// # Errors
    /// [`MapError`]; all but [`MapError::NoBetter`] require more points.
    ///
    /// # Source
    /// Balance of moments of each point, `Σ gᵢ(fᵢ) (xᵢ − x) = 0`, linear in the trims of `gᵢ`, and a cubic polynomial
    /// for the remaining error, both by ridge regression; five-fold cross-validation selects trims, bends or both.
    pub fn of_presses(presses: &[PressedPoint], geometry: &Geometry, tile: TileId) -> Result<Self, MapError> {
        let on = MappedTile { geometry, tile };
        let usable = |press: &PressedPoint| {
            press.at.is_finite() && press.forces.iter().chain(&press.force).all(|force| force.is_finite())
        };
        if let Some(index) = presses.iter().position(|press| !usable(press)) {
            return Err(MapError::NotFinite { index });
        }
        let pressed: Vec<PressedPoint> =
            presses.iter().copied().filter(|press| press.forces.iter().sum::<f32>() > LEAST_N).collect();
        let found = |map: &PositionMap, press: &PressedPoint| placed(map, press, on);
        let candidates = |presses: &[PressedPoint]| {
            let bent = |map: PositionMap| {
                let sighting = |press: &PressedPoint| Sighting { at: press.at, estimate: found(&map, press) };
                let sightings: Vec<_> = presses.iter().map(sighting).collect();
                PositionMap { bends: bends(&sightings, on), ..map }
            };
            let trimmed = PositionMap { trims: trims(presses, on), ..PositionMap::NONE };
            [bent(trimmed), trimmed, bent(PositionMap::NONE)]
        };
        best(&pressed, |press| press.at, on, candidates, found)
    }

    /// The map of `tile` from points measured through the whole floor; they determine bends only.
    ///
    /// # Errors
    /// As [`MapFit::of_presses`].
    pub fn of_sightings(sightings: &[Sighting], geometry: &Geometry, tile: TileId) -> Result<Self, MapError> {
        let on = MappedTile { geometry, tile };
        let usable = |sighting: &Sighting| sighting.at.is_finite() && sighting.estimate.is_finite();
        if let Some(index) = sightings.iter().position(|sighting| !usable(sighting)) {
            return Err(MapError::NotFinite { index });
        }
        let found = |map: &PositionMap, sighting: &Sighting| map.unbent(sighting.estimate, geometry);
        let candidates =
            |sightings: &[Sighting]| [PositionMap { bends: bends(sightings, on), ..PositionMap::NONE }];
        best(sightings, |sighting| sighting.at, on, candidates, found)
    }
}

impl Errors {
    /// The errors of these distances; zero for none.
    fn of(mut distances: Vec<f32>) -> Self {
        distances.sort_by(f32::total_cmp);
        let at = |share: f32| {
            let last = distances.len().saturating_sub(1) as f32;
            distances.get((last * share).round() as usize).copied().unwrap_or_default()
        };
        Self { median_m: at(0.5), p95_m: at(0.95), worst_m: at(1.0) }
    }
}

/// Force below which a press shows no place (N).
const LEAST_N: f32 = 10.0;

/// Place of a press by a map.
fn placed(map: &PositionMap, press: &PressedPoint, on: MappedTile<'_>) -> Vec2 {
    let forces = map.trimmed(press.forces);
    map.unbent(PressedPoint { forces, ..*press }.estimate(on), on.geometry)
}

/// The best of the maps that `candidates` fits to points, each kind evaluated on points outside of the fit.
fn best<T: Copy, const KINDS: usize>(
    points: &[T],
    at: impl Fn(&T) -> Vec2,
    on: MappedTile<'_>,
    candidates: impl Fn(&[T]) -> [PositionMap; KINDS],
    found: impl Fn(&PositionMap, &T) -> Vec2,
) -> Result<MapFit, MapError> {
    if points.len() < MapFit::MIN_POINTS {
        return Err(MapError::TooFewPoints { points: points.len() });
    }
    spread(points.iter().map(&at), on)?;
    let folds = folds(points.iter().map(&at));
    let distance = |map: &PositionMap, point: &T| found(map, point).distance(at(point));
    let before: Vec<f32> = points.iter().map(|point| distance(&PositionMap::NONE, point)).collect();
    let mut judged = [(); KINDS].map(|()| Vec::with_capacity(points.len()));
    for fold in 0..MapFit::FOLDS {
        let chosen = |inside: bool| {
            let pairs = points.iter().zip(&folds);
            pairs.filter(move |(_, own)| (**own == fold) == inside).map(|(point, _)| *point)
        };
        let maps = candidates(&chosen(false).collect::<Vec<_>>());
        for (left, map) in judged.iter_mut().zip(maps) {
            left.extend(chosen(true).map(|point| distance(&map, &point)));
        }
    }
    let least = judged.into_iter().zip(candidates(points)).min_by(|a, b| rms(&a.0).total_cmp(&rms(&b.0)));
    match least {
        Some((left, map)) if rms(&left) < WORTH_IT * rms(&before) => {
            let after = Errors::of(left);
            Ok(MapFit {
                map: PositionMap { residual_m: after.p95_m, ..map },
                points: points.len(),
                before: Errors::of(before),
                after,
            })
        }
        least => Err(MapError::NoBetter {
            rms_mm: 1e3 * least.map_or(0.0, |(left, _)| rms(&left)),
            before_mm: 1e3 * rms(&before),
        }),
    }
}

/// Maximum share of the error that a useful map leaves, so that no map is fitted to noise (our choice).
const WORTH_IT: f32 = 0.97;

fn rms(distances: &[f32]) -> f32 {
    (distances.iter().map(|distance| distance * distance).sum::<f32>() / distances.len().max(1) as f32).sqrt()
}

/// The fold of each point; points of one place share one.
fn folds(places: impl Iterator<Item = Vec2>) -> Vec<usize> {
    let mut seen: Vec<(i32, i32)> = Vec::new();
    places
        .map(|place| {
            // Places closer than a centimetre count as one.
            let key = ((place.x * 100.0).round() as i32, (place.y * 100.0).round() as i32);
            let number = seen.iter().position(|&other| other == key).unwrap_or_else(|| {
                seen.push(key);
                seen.len() - 1
            });
            number % MapFit::FOLDS
        })
        .collect()
}

/// Checks that the points reach all four sides.
fn spread(places: impl Iterator<Item = Vec2>, on: MappedTile<'_>) -> Result<(), MapError> {
    let least = MapFit::REACH * 0.5 * on.geometry.plate_size(on.tile);
    let (low, high) =
        places.fold((Vec2::MAX, Vec2::MIN), |(low, high), place| (low.min(place), high.max(place)));
    let reached = [
        ("east", high.x, least.x),
        ("west", -low.x, least.x),
        ("north", high.y, least.y),
        ("south", -low.y, least.y),
    ];
    match reached.into_iter().find(|&(_, reached, least)| reached < least) {
        Some((side, ..)) => Err(MapError::NoSpread { side }),
        None => Ok(()),
    }
}

/// The trims that balance the moments of all presses best, by least squares.
fn trims(presses: &[PressedPoint], on: MappedTile<'_>) -> [[f32; PositionMap::TRIMS]; 4] {
    const COUNT: usize = 4 * PositionMap::TRIMS;
    let (places, reach) = (on.places(), on.reach());
    let mut sums = Normal::new(COUNT);
    for press in presses {
        let total: f32 = press.forces.iter().sum();
        // An unbalanced moment divided by the force is a displacement of the centroid.
        let weight = f64::from(1.0 / (reach * total.max(FULL_N)));
        // Each row: the four trims in effect at each sensor.
        let mut rows = [[(0, 0.0); 16]; 3];
        let mut left = [0.0; 3];
        for (corner, &force) in Corner::ALL.iter().zip(&press.forces) {
            let lever = places.place(*corner) - press.at;
            let (first, shares) = PositionMap::shares(force);
            let first = corner.index() * PositionMap::TRIMS + first;
            for (row, lever) in [lever.x, lever.y, reach].into_iter().enumerate() {
                let moment = f64::from(force * lever) * weight;
                for (number, share) in shares.into_iter().enumerate() {
                    rows[row][4 * corner.index() + number] = (first + number, moment * f64::from(share));
                }
                left[row] -= moment;
            }
        }
        if let Some(force) = press.force {
            left[2] += f64::from(force * reach) * weight;
        }
        let known = if press.force.is_some() { 3 } else { 2 };
        for (row, left) in rows.iter().zip(left).take(known) {
            sums.add(row, left);
        }
    }
    for sensor in 0..4 {
        let first = sensor * PositionMap::TRIMS;
        for trim in first..first + PositionMap::TRIMS {
            sums.hold(&[(trim, 1.0)], TRIM_SIZE);
        }
        for trim in first + 1..first + PositionMap::TRIMS - 1 {
            sums.hold(&[(trim - 1, 1.0), (trim, -2.0), (trim + 1, 1.0)], TRIM_BEND);
        }
    }
    let solved = sums.solve();
    std::array::from_fn(|sensor| {
        std::array::from_fn(|trim| {
            let trim = solved[sensor * PositionMap::TRIMS + trim] as f32;
            rounded(trim.clamp(-PositionMap::MOST_TRIM, PositionMap::MOST_TRIM))
        })
    })
}

/// Force below which presses have less weight, since their errors are the sensors' zeros (N).
const FULL_N: f32 = 30.0;

/// Ridge weights that hold trims near zero, and near straight lines from load to load (our choice, by trying).
const TRIM_SIZE: f64 = 0.002;
const TRIM_BEND: f64 = 0.01;

/// The bends that bring all sightings closest to their true places, by least squares.
fn bends(sightings: &[Sighting], on: MappedTile<'_>) -> [[f32; PositionMap::BENDS]; 2] {
    let half = on.half_cell();
    let of_axis = |along: fn(Vec2) -> f32| {
        let mut sums = Normal::new(PositionMap::BENDS);
        for sighting in sightings {
            let terms = PositionMap::terms(sighting.estimate / half).map(f64::from);
            let factors: [_; PositionMap::BENDS] = std::array::from_fn(|term| (term, terms[term]));
            sums.add(&factors, f64::from(along((sighting.at - sighting.estimate) / half)));
        }
        for term in 0..PositionMap::BENDS {
            sums.hold(&[(term, 1.0)], BEND_SIZE);
        }
        let solved = sums.solve();
        std::array::from_fn(|term| {
            rounded((solved[term] as f32).clamp(-PositionMap::MOST_BEND, PositionMap::MOST_BEND))
        })
    };
    [of_axis(|shift| shift.x), of_axis(|shift| shift.y)]
}

/// Ridge weight that holds bends near zero (our choice).
const BEND_SIZE: f64 = 0.3;

/// Rounds to four decimals: files stay short, and a hundredth of a per cent is negligible.
fn rounded(number: f32) -> f32 {
    (f64::from(number * 1e4).round() / 1e4) as f32
}

/// The normal equations of a linear least-squares problem.
struct Normal {
    /// Its lower triangle; it is symmetric.
    matrix: DMatrix<f64>,
    right: DVector<f64>,
}

impl Normal {
    fn new(unknowns: usize) -> Self {
        Self { matrix: DMatrix::zeros(unknowns, unknowns), right: DVector::zeros(unknowns) }
    }

    /// Adds the equation: the sum of these unknowns, each times its factor, is `value`.
    fn add(&mut self, factors: &[(usize, f64)], value: f64) {
        for &(i, a) in factors {
            self.right[i] += a * value;
        }
        self.hold(factors, 1.0);
    }

    /// Adds a penalty of this `strength` on the squared sum of these unknowns, each times its factor.
    fn hold(&mut self, factors: &[(usize, f64)], strength: f64) {
        for &(i, a) in factors {
            for &(j, b) in factors.iter().filter(|&&(j, _)| j <= i) {
                self.matrix[(i, j)] += strength * a * b;
            }
        }
    }

    /// The unknowns; zero if the equations have no solution, which the penalties rule out.
    fn solve(self) -> DVector<f64> {
        let unknowns = self.right.len();
        let solved = self.matrix.cholesky().map(|cholesky| cholesky.solve(&self.right));
        solved.filter(|x| x.iter().all(|x| x.is_finite())).unwrap_or_else(|| DVector::zeros(unknowns))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const REACH: f32 = 0.132;
    const TILE: TileId = TileId::new(0, 0);

    /// A raster of 9 x 9 points, each pressed with some forces; `gain` is the gain of each sensor at a force.
    fn presses(share: f32, gain: impl Fn(usize, f32) -> f32) -> Vec<PressedPoint> {
        let mut presses = Vec::new();
        for step in 0..81_u8 {
            let at = Vec2::new(f32::from(step % 9) - 4.0, f32::from(step / 9) - 4.0) * (share * 0.152 / 4.0);
            for force in [40.0, 90.0, 200.0, 300.0] {
                let forces = Corner::ALL.map(|corner| {
                    let load = 0.25 * force * (1.0 + corner.direction().dot(at / REACH));
                    load * gain(corner.index(), load)
                });
                presses.push(PressedPoint { at, forces, force: None });
            }
        }
        presses
    }

    fn fit(presses: &[PressedPoint]) -> Result<MapFit, MapError> {
        MapFit::of_presses(presses, &Geometry::default(), TILE)
    }

    #[test]
    fn gains_that_follow_the_load_are_found_without_knowing_the_force() {
        // Each part deviates by up to 15 % in a wave of its own over its load.
        let gain = |sensor: usize, load: f32| 1.0 + 0.15 * (load / 60.0 + sensor as f32).sin();
        let found = fit(&presses(0.9, gain)).unwrap();
        assert_eq!(found.points, 324);
        assert!(found.before.p95_m > 0.012, "{found:?}");
        assert!(found.after.p95_m < 0.003, "{found:?}");
        // The same between the places and forces of the fit.
        let at = Vec2::new(0.031, -0.067);
        let forces = Corner::ALL.map(|corner| {
            let load = 0.25 * 140.0 * (1.0 + corner.direction().dot(at / REACH));
            load * gain(corner.index(), load)
        });
        let on = MappedTile { geometry: &Geometry::default(), tile: TILE };
        let seen = placed(&found.map, &PressedPoint { at, forces, force: None }, on);
        assert!(seen.distance(at) < 0.003, "{seen}");
    }

    #[test]
    fn a_known_force_mends_the_weight_as_well() {
        // All sensors read a tenth too low: places are right, weights are not.
        let mut pressed = presses(0.9, |sensor, load| 0.9 + 0.05 * (load / 80.0 + sensor as f32).sin());
        for press in &mut pressed {
            let load: f32 = press.forces.iter().sum();
            let known = [40.0, 90.0, 200.0, 300.0]
                .into_iter()
                .min_by(|a, b| (a - load / 0.9).abs().total_cmp(&(b - load / 0.9).abs()));
            press.force = known;
        }
        let map = fit(&pressed).unwrap().map;
        for press in pressed.iter().filter(|press| press.force > Some(80.0)) {
            let weight: f32 = map.trimmed(press.forces).iter().sum();
            assert!((weight / press.force.unwrap() - 1.0).abs() < 0.03, "{weight} of {press:?}");
        }
    }

    #[test]
    fn each_reason_against_a_map_has_its_name() {
        let good = presses(0.9, |sensor, load| 1.0 + 0.1 * (load / 60.0 + sensor as f32).sin());
        assert_eq!(fit(&good[..15]), Err(MapError::TooFewPoints { points: 15 }));
        let western: Vec<_> = good.iter().copied().filter(|press| press.at.x < 0.05).collect();
        assert_eq!(fit(&western), Err(MapError::NoSpread { side: "east" }));
        assert_eq!(fit(&presses(0.4, |_, _| 1.0)), Err(MapError::NoSpread { side: "east" }));
        let mut broken = good.clone();
        broken[3].forces[1] = f32::NAN;
        assert_eq!(fit(&broken), Err(MapError::NotFinite { index: 3 }));
        // Places unrelated to the presses give no map.
        let mut swapped = presses(0.9, |_, _| 1.0);
        let places: Vec<_> = swapped.iter().map(|press| press.at).collect();
        for (number, press) in swapped.iter_mut().enumerate() {
            press.at = places[(number * 89 + 31) % places.len()];
            press.forces = [25.0; 4];
        }
        assert!(matches!(fit(&swapped), Err(MapError::NoBetter { .. })), "{:?}", fit(&swapped));
    }
}
