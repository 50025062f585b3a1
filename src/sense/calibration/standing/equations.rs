//! The equations that a person on the floor gives, and their errors for assumed laws.

use glam::{DVec2, DVec3, Vec3Swizzles};
use nalgebra::{DMatrix, DVector};

use super::curve::{ForceSlope, LawCurve};
use super::data::{Crossing, MeasuredStand, StandData, is_saturated};
use crate::floor::TileId;

/// Standard error of the sum of all forces under a person who stands or walks, as a share of the weight: real parts
/// follow their laws within a few per cent of full scale, scales and clothes are half a kilogram off (our choice).
pub(super) const WEIGHT_ERROR: f64 = 0.01;

/// Standard error of a person's place along each axis (m): shoes beside a mark, and the sway of two seconds (1 cm and
/// 2 mm).
pub(super) const PLACE_ERROR_M: f64 = 0.012;

/// Standard deviation of the person's lean, as a distance of the centre of pressure from the middle between the
/// feet (m).
const LEAN_M: f64 = 0.05;

/// Standard deviation of `p` among the parts of one floor: the force of an equal output differs by a quarter (paper,
/// section 2.2).
pub(super) const P_SPREAD: f64 = 0.25;

/// Standard deviation of `q` among the parts of one floor: twice that of the parts of a good maker (our choice).
pub(super) const Q_SPREAD: f64 = 0.06;

/// Standard deviation of the common law's parameters around the start of the search; a formality that keeps the
/// equations regular without any stand.
const START_SPREAD: f64 = 1.0;

/// The origin of an equation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum EquationKind {
    /// The sum of all forces of a stand, by its position.
    Sum(usize),
    /// A coordinate of a stand's centroid.
    Place(usize),
    /// A moment of a stand about its sensors of unknown force.
    Moment(usize),
    /// The mean force of a crossing, by its position.
    Crossing(usize),
    /// Knowledge from before the measurements.
    Prior,
}

/// The stands and crossings that count.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Used {
    /// Weight of each stand; 0 if it does not count.
    pub(super) stands: Vec<f64>,
    pub(super) crossings: Vec<bool>,
}

/// The equations of one kind of law.
///
/// Unknowns: `p, q` of each sensor, the lean to the right and forwards (m), and `p, q` of the floor's common law.
#[derive(Clone, Debug)]
pub(super) struct Equations<'a> {
    pub(super) curve: LawCurve,
    pub(super) data: &'a StandData,
    /// Place of each sensor, in floor metres.
    pub(super) places: &'a [DVec2],
    /// As [`StandData::silent`].
    pub(super) silent: &'a [bool],
    /// Weight of the person (N).
    pub(super) weight_n: f64,
    pub(super) used: &'a Used,
    /// Start of the common law.
    pub(super) start: [f64; 2],
}

/// An equation of a stand: its weighted error and derivatives.
type StandEquation = (f64, Vec<(usize, f64)>);

/// Half the gradient and half the Hessian (by Gauss) of the sum of squares.
pub(super) struct NormalEquations {
    pub(super) gradient: DVector<f64>,
    pub(super) matrix: DMatrix<f64>,
}

impl Equations<'_> {
    /// Number of unknowns.
    pub(super) fn unknowns(&self) -> usize {
        2 * self.places.len() + 4
    }

    /// The unknowns before any measurement: the common law for all.
    pub(super) fn first(&self) -> DVector<f64> {
        let (lean, count) = (2 * self.places.len(), self.unknowns());
        let value =
            |index: usize| if index == lean || index == lean + 1 { 0.0 } else { self.start[index % 2] };
        DVector::from_iterator(count, (0..count).map(value))
    }

    fn parameters(unknowns: &DVector<f64>, sensor: usize) -> [f64; 2] {
        [unknowns[2 * sensor], unknowns[2 * sensor + 1]]
    }

    /// Whether all curves rise over all outputs.
    pub(super) fn holds(&self, unknowns: &DVector<f64>) -> bool {
        let curves = (0..=self.places.len() + 1).filter(|sensor| *sensor != self.places.len());
        unknowns.iter().all(|unknown| unknown.is_finite())
            && curves.into_iter().all(|sensor| self.curve.holds(unknowns[2 * sensor + 1]))
    }

    /// Sum of the squares of all weighted errors; infinite for curves that do not rise.
    pub(super) fn squares(&self, unknowns: &DVector<f64>) -> f64 {
        if !self.holds(unknowns) {
            return f64::INFINITY;
        }
        let mut squares = 0.0;
        self.visit(unknowns, |_, error, _| squares += error * error);
        if squares.is_finite() { squares } else { f64::INFINITY }
    }

    /// The normal equations at `unknowns`.
    pub(super) fn normal(&self, unknowns: &DVector<f64>) -> NormalEquations {
        let count = self.unknowns();
        let (mut gradient, mut matrix) = (DVector::zeros(count), DMatrix::zeros(count, count));
        self.visit(unknowns, |_, error, slopes| {
            for &(row, slope) in slopes {
                gradient[row] += slope * error;
                for &(column, other) in slopes {
                    matrix[(row, column)] += slope * other;
                }
            }
        });
        NormalEquations { gradient, matrix }
    }

    /// Calls `see` with each equation: its origin, its weighted error, and the derivatives of that by unknowns.
    pub(super) fn visit(
        &self,
        unknowns: &DVector<f64>,
        mut see: impl FnMut(EquationKind, f64, &[(usize, f64)]),
    ) {
        let empty: Vec<ForceSlope> = self
            .data
            .empty
            .iter()
            .enumerate()
            .map(|(sensor, rest)| self.curve.slope(f64::from(rest.volts), Self::parameters(unknowns, sensor)))
            .collect();
        let lean = 2 * self.places.len();
        let leaning = DVec2::new(unknowns[lean], unknowns[lean + 1]);
        let stands = self.data.stands.iter().zip(&self.used.stands).enumerate();
        for (number, (stand, &weight)) in stands.filter(|(_, (_, weight))| **weight > 0.0) {
            let mut see = |kind: EquationKind, (error, slopes): StandEquation| see(kind, error, &slopes);
            self.see_stand((number, stand, weight), (unknowns, &empty), leaning, &mut see);
        }
        let crossings = self.data.crossings.iter().zip(&self.used.crossings).enumerate();
        for (number, (crossing, _)) in crossings.filter(|(_, (_, used))| **used) {
            self.see_crossing((number, crossing), (unknowns, &empty), &mut see);
        }
        for sensor in 0..self.places.len() {
            for (parameter, spread) in [P_SPREAD, Q_SPREAD].into_iter().enumerate() {
                let (own, common) = (2 * sensor + parameter, lean + 2 + parameter);
                let error = (unknowns[own] - unknowns[common]) / spread;
                see(EquationKind::Prior, error, &[(own, spread.recip()), (common, -spread.recip())]);
            }
        }
        for axis in [lean, lean + 1] {
            see(EquationKind::Prior, unknowns[axis] / LEAN_M, &[(axis, LEAN_M.recip())]);
        }
        for (parameter, start) in self.start.into_iter().enumerate() {
            let common = lean + 2 + parameter;
            let error = (unknowns[common] - start) / START_SPREAD;
            see(EquationKind::Prior, error, &[(common, START_SPREAD.recip())]);
        }
    }

    /// The sum of a stand's forces is the weight; their moments about the mark are those of the weight, displaced by
    /// the lean. The forces of saturated and of silent sensors are unknown, so only combinations of these three
    /// equations count that do not contain them: the moments about such a sensor, or about the line through two.
    fn see_stand(
        &self,
        (number, stand, weight): (usize, &MeasuredStand, f64),
        (unknowns, empty): (&DVector<f64>, &[ForceSlope]),
        leaning: DVec2,
        see: &mut impl FnMut(EquationKind, StandEquation),
    ) {
        let place_unit = (self.weight_n * PLACE_ERROR_M).recip();
        let units = DVec3::new((self.weight_n * WEIGHT_ERROR).recip(), place_unit, place_unit);
        let effect = |place: DVec2| units * (place - stand.mark.at.as_dvec2()).extend(1.0).zxy();
        let body = self.weight_n * units;
        let turn = DVec2::from_angle(stand.mark.facing.into());
        let lean = 2 * self.places.len();
        let mut error = -body * turn.rotate(leaning).extend(1.0).zxy();
        let mut slopes =
            vec![(lean, -body * turn.extend(0.0).zxy()), (lean + 1, -body * turn.perp().extend(0.0).zxy())];
        let silent = self.data.empty.iter().zip(self.silent).zip(self.places);
        let mut unknown: Vec<DVec3> = silent
            .filter(|((rest, silent), _)| **silent && rest.sensor.tile == stand.mark.tile)
            .map(|(_, place)| effect(*place))
            .collect();
        for &(sensor, volts) in &stand.loaded {
            let (Some(rest), Some(place)) = (empty.get(sensor), self.places.get(sensor)) else { continue };
            let effect = effect(*place);
            if is_saturated(volts) {
                unknown.push(effect);
                continue;
            }
            let force = self.curve.slope(volts.into(), Self::parameters(unknowns, sensor)) - *rest;
            error += force.force * effect;
            slopes.push((2 * sensor, force.by_p * effect));
            slopes.push((2 * sensor + 1, force.by_q * effect));
        }
        for (kind, direction) in free_directions(&unknown, number) {
            let direction = weight.sqrt() * direction;
            let slopes = slopes.iter().map(|(unknown, slope)| (*unknown, direction.dot(*slope))).collect();
            see(kind, (direction.dot(error), slopes));
        }
    }

    /// The mean force of a crossing is the weight.
    fn see_crossing(
        &self,
        (number, crossing): (usize, &Crossing),
        (unknowns, empty): (&DVector<f64>, &[ForceSlope]),
        see: &mut impl FnMut(EquationKind, f64, &[(usize, f64)]),
    ) {
        let unit = (self.weight_n * WEIGHT_ERROR * f64::from(crossing.moments.max(1))).recip();
        let (mut sum, mut slopes) = (0.0, Vec::with_capacity(2 * crossing.loaded.len()));
        for (&sensor, moments) in &crossing.loaded {
            let Some(rest) = empty.get(sensor) else { continue };
            let mut force = ForceSlope::default();
            for (volts, times) in moments.outputs() {
                force.add(self.curve.slope(volts, Self::parameters(unknowns, sensor)) - *rest, times);
            }
            sum += unit * force.force;
            slopes.push((2 * sensor, unit * force.by_p));
            slopes.push((2 * sensor + 1, unit * force.by_q));
        }
        see(EquationKind::Crossing(number), sum - WEIGHT_ERROR.recip(), &slopes);
    }
}

/// The combinations of a stand's sum and two moments without the effects of sensors of `unknown` force.
fn free_directions(unknown: &[DVec3], number: usize) -> Vec<(EquationKind, DVec3)> {
    let moment = |direction: DVec3| (EquationKind::Moment(number), direction);
    match *unknown {
        [] => vec![
            (EquationKind::Sum(number), DVec3::X),
            (EquationKind::Place(number), DVec3::Y),
            (EquationKind::Place(number), DVec3::Z),
        ],
        [one] => {
            let (first, second) = one.normalize().any_orthonormal_pair();
            vec![moment(first), moment(second)]
        }
        [one, other] => one.cross(other).try_normalize().map(moment).into_iter().collect(),
        _ => Vec::new(),
    }
}

impl Used {
    /// The stands that leave an equation, and the crossings without a saturated sensor. Each sensor of unknown force
    /// takes one of a stand's three equations.
    pub(super) fn of(data: &StandData, silent: &[bool]) -> Self {
        let silent = |tile: TileId| {
            let sensors = data.empty.iter().zip(silent);
            sensors.filter(|(rest, silent)| **silent && rest.sensor.tile == tile).count()
        };
        let free = |crossing: &Crossing| {
            let mut outputs = crossing.loaded.values().flat_map(|moments| moments.outputs());
            !outputs.any(|(volts, _)| is_saturated(volts as f32))
        };
        Self {
            stands: data
                .stands
                .iter()
                .map(|stand| if stand.saturated() + silent(stand.mark.tile) < 3 { 1.0 } else { 0.0 })
                .collect(),
            crossings: data.crossings.iter().map(free).collect(),
        }
    }

    /// Number of stands that count.
    pub(super) fn stands(&self) -> usize {
        self.stands.iter().filter(|weight| **weight > 0.0).count()
    }
}
