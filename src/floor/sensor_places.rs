//! The places of the sensors under one plate.

use glam::{DMat3, DVec3, Vec2};
use thiserror::Error;

use super::Corner;

/// Minimum distance of a sensor from the line through two others (m): nearer ones tell nothing of the load across
/// that line (our choice).
const OFF_LINE_M: f32 = 0.01;

/// Tolerance for equal lengths (m): rounding errors of places that a file gives in metres.
const SAME_M: f32 = 1e-6;

/// The places of the sensors under one plate, in metres from the plate's centre.
///
/// Sensor arrays of this crate have four entries for each tile. A plate with three sensors leaves the last one
/// unused: its force is zero, and it has no place. Of four sensors, the first and the last lie opposite each other,
/// as do the second and the third.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorPlaces {
    /// The unused one of three lies in the centre, where a force has no moment.
    places: [Vec2; 4],
    form: Form,
    /// Weights `w` of the sensors in the balance of a rigid plate, `w0 f0 + w3 f3 = w1 f1 + w2 f2`; positive.
    weights: [f32; 4],
}

/// The arrangement of the sensors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    /// An upright rectangle around the centre, in the order of [`Corner::ALL`].
    Rectangle,
    /// Another parallelogram, such as the middles of the edges.
    Parallelogram,
    /// Another quadrilateral.
    Quadrilateral,
    /// Three sensors.
    Triangle,
}

/// Reason for which a plate cannot have sensors at some places.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum SensorPlacesError {
    /// A plate has another number of sensors.
    #[error("a plate has three or four sensors, not {0}")]
    Count(usize),
    /// A place is not a number.
    #[error("the place of sensor {0} is not a finite number")]
    NotFinite(usize),
    /// Three of the sensors lie on one line.
    #[error("sensors {0}, {1} and {2} lie on one line, within 1 cm")]
    OnOneLine(usize, usize, usize),
    /// A sensor lies between the other three.
    #[error("sensor {0} lies between the other three")]
    Inside(usize),
    /// Neighbours are written as opposite sensors.
    #[error("sensors {0} and {1} are neighbours, not opposite each other")]
    Order(usize, usize),
}

impl SensorPlacesError {
    /// Returns what to do about it.
    #[must_use]
    pub const fn help(&self) -> &'static str {
        match self {
            Self::Count(_) | Self::NotFinite(_) => "write three or four places, (east, north) in metres",
            Self::OnOneLine(..) => "move one of them across that line: they find no load beside it",
            Self::Inside(_) => "leave it out: the other three carry the plate",
            Self::Order(..) => {
                "write them row by row from the south-west: the first lies opposite the last, the second opposite the \
                 third"
            }
        }
    }
}

impl SensorPlaces {
    /// Sensors at the corners of a plate of this size, `inset_m` metres inside of its edges, in the order of
    /// [`Corner::ALL`].
    #[must_use]
    pub(super) fn in_corners(plate: Vec2, inset_m: f32) -> Self {
        let reach = 0.5 * plate - inset_m;
        let places = Corner::ALL.map(|corner| corner.direction() * reach);
        Self { places, form: Form::Rectangle, weights: [1.0; 4] }
    }

    /// Three or four sensors at `places`, in metres east and north of the plate's centre.
    ///
    /// # Errors
    /// [`SensorPlacesError`] for another number of places, for sensors that do not determine the place of a load, and
    /// for four in another order.
    pub fn at(places: &[Vec2]) -> Result<Self, SensorPlacesError> {
        if let Some(number) = places.iter().position(|place| !place.is_finite()) {
            return Err(SensorPlacesError::NotFinite(number));
        }
        match *places {
            [a, b, c] => {
                off_one_line([(0, a), (1, b), (2, c)])?;
                let places = [a, b, c, Vec2::ZERO];
                Ok(Self { places, form: Form::Triangle, weights: [1.0, 1.0, 1.0, 0.0] })
            }
            [a, b, c, d] => Self::of_four([a, b, c, d]),
            _ => Err(SensorPlacesError::Count(places.len())),
        }
    }

    fn of_four(places: [Vec2; 4]) -> Result<Self, SensorPlacesError> {
        let others = |left_out: usize| {
            let mut others = [(0, Vec2::ZERO); 3];
            let kept = places.into_iter().enumerate().filter(|(number, _)| *number != left_out);
            others.iter_mut().zip(kept).for_each(|(other, one)| *other = one);
            others
        };
        for left_out in (0..4).rev() {
            off_one_line(others(left_out))?;
        }
        // The only weights with which all forces of a plate on equal springs cancel, whatever the load: for each
        // sensor twice the area between the other three, with alternating signs.
        let signed = |number: usize| {
            let area = doubled_area(others(number).map(|(_, place)| place));
            if number.is_multiple_of(2) { -area } else { area }
        };
        let all = [0, 1, 2, 3].map(signed);
        let same = |number: usize| all.iter().filter(|one| (**one > 0.0) == (all[number] > 0.0)).count();
        if let Some(inside) = (0..4).find(|&number| same(number) == 1) {
            return Err(SensorPlacesError::Inside(inside));
        }
        if (all[0] > 0.0) != (all[3] > 0.0) {
            return Err(SensorPlacesError::Order(0, 3));
        }
        let mean = 0.25 * all.iter().map(|area| area.abs()).sum::<f32>();
        let [a, b, c, d] = places;
        let is_parallelogram = ((a + d) - (b + c)).abs().max_element() < SAME_M;
        let weights = if is_parallelogram { [1.0; 4] } else { all.map(|area| area.abs() / mean) };
        let corners = Corner::ALL.map(|corner| corner.direction() * d);
        let form = match is_parallelogram {
            true if corners == places && d.cmpgt(Vec2::ZERO).all() => Form::Rectangle,
            true => Form::Parallelogram,
            false => Form::Quadrilateral,
        };
        Ok(Self { places, form, weights })
    }

    /// Returns the number of sensors, 3 or 4.
    #[must_use]
    pub const fn count(&self) -> usize {
        match self.form {
            Form::Triangle => 3,
            _ => 4,
        }
    }

    /// Returns the sensors, by the names of their positions in every sensor array.
    #[must_use]
    pub fn sensors(&self) -> &'static [Corner] {
        &Corner::ALL[..self.count()]
    }

    /// Returns the places in metres from the plate's centre, in the order of the sensors.
    #[must_use]
    pub fn as_slice(&self) -> &[Vec2] {
        &self.places[..self.count()]
    }

    /// Returns the place of one sensor in metres from the plate's centre; the centre for a sensor that the plate does
    /// not have.
    #[must_use]
    pub const fn place(&self, sensor: Corner) -> Vec2 {
        self.places[sensor.index()]
    }

    /// Returns half the distances between the sensors, in metres east and north, if they lie at the corners of an
    /// upright rectangle around the plate's centre, in the order of [`Corner::ALL`].
    #[must_use]
    pub fn rectangle(&self) -> Option<Vec2> {
        (self.form == Form::Rectangle).then_some(self.places[3])
    }

    /// Whether the four sensors are the corners of a parallelogram, so that under a rigid plate on equal supports
    /// both diagonals carry the same.
    #[must_use]
    pub const fn is_parallelogram(&self) -> bool {
        matches!(self.form, Form::Rectangle | Form::Parallelogram)
    }

    /// Returns the first moment of `forces` about the plate's centre (N m).
    ///
    /// # Source
    /// `sum(f_i x_i)` of the paper's Eq. 3.
    #[inline]
    #[must_use]
    pub fn moment(&self, forces: [f32; 4]) -> Vec2 {
        let [sw, se, nw, ne] = forces;
        if self.form == Form::Rectangle {
            // Two products instead of eight, on nearly all floors.
            return Vec2::new((se - sw) + (ne - nw), (nw - sw) + (ne - se)) * self.places[3];
        }
        self.places.iter().zip(forces).map(|(place, force)| *place * force).sum()
    }

    /// Returns the force of `sensor` (by its position) on a rigid plate on equal springs, from the `forces` of the
    /// other three; `None` for a plate on three supports, whose forces do not depend on each other.
    #[must_use]
    pub fn balanced(&self, forces: [f32; 4], sensor: usize) -> Option<f32> {
        let of = |other: usize| forces[other] * (self.weights[other] / self.weights[sensor]);
        (self.form != Form::Triangle).then(|| of(sensor ^ 1) + of(sensor ^ 2) - of(sensor ^ 3))
    }

    /// Returns the share of each sensor of a load `at` metres from the plate's centre, on a rigid plate on equal
    /// springs. The shares add up to 1; beyond the sensors some are negative.
    ///
    /// # Source
    /// `f_i = z + t . x_i` with force and both moments in balance.
    #[must_use]
    pub fn shares(&self, at: Vec2) -> [f32; 4] {
        if let Some(reach) = self.rectangle() {
            let arm = at / reach;
            return Corner::ALL.map(|corner| 0.25 * (1.0 + corner.direction().dot(arm)));
        }
        let modes = |place: Vec2| DVec3::new(1.0, place.x.into(), place.y.into());
        let mut springs = DMat3::ZERO;
        for &place in self.as_slice() {
            let modes = modes(place);
            springs += DMat3::from_cols(modes, modes * modes.y, modes * modes.z);
        }
        let sinks = springs.inverse() * modes(at);
        let mut shares = [0.0; 4];
        for (share, &place) in shares.iter_mut().zip(self.as_slice()) {
            *share = modes(place).dot(sinks) as f32;
        }
        shares
    }
}

/// Twice the area of a triangle, negative for corners in clockwise order (m²).
fn doubled_area([a, b, c]: [Vec2; 3]) -> f32 {
    (b - a).perp_dot(c - a)
}

/// Checks that three sensors lie off one line.
fn off_one_line(three: [(usize, Vec2); 3]) -> Result<(), SensorPlacesError> {
    let [a, b, c] = three.map(|(_, place)| place);
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    if doubled_area([a, b, c]).abs() < OFF_LINE_M * longest.max(OFF_LINE_M) {
        let [a, b, c] = three.map(|(number, _)| number);
        return Err(SensorPlacesError::OnOneLine(a, b, c));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places(places: &[(f32, f32)]) -> Result<SensorPlaces, SensorPlacesError> {
        SensorPlaces::at(&places.iter().copied().map(Vec2::from).collect::<Vec<_>>())
    }

    /// Three legs, the middles of the edges, a trapezium, and a rectangle.
    fn forms() -> [SensorPlaces; 4] {
        [
            places(&[(-0.2, -0.15), (0.2, -0.15), (0.0, 0.18)]),
            places(&[(0.0, -0.14), (0.14, 0.0), (-0.14, 0.0), (0.0, 0.14)]),
            places(&[(-0.2, -0.1), (0.2, -0.1), (-0.1, 0.12), (0.1, 0.12)]),
            places(&[(-0.2165, -0.119), (0.2165, -0.119), (-0.2165, 0.119), (0.2165, 0.119)]),
        ]
        .map(Result::unwrap)
    }

    #[test]
    fn a_foot_on_any_plate_is_found_where_it_stands() {
        for form in forms() {
            for at in [Vec2::ZERO, Vec2::new(0.03, -0.05), Vec2::new(-0.06, 0.04)] {
                let forces = form.shares(at).map(|share| 600.0 * share);
                let whole: f32 = forces.iter().sum();
                assert!((whole - 600.0).abs() < 1e-3, "{form:?}");
                assert!((form.moment(forces) / whole).distance(at) < 1e-6, "{form:?}");
            }
        }
    }

    #[test]
    fn one_of_four_is_known_from_the_others_and_one_of_three_is_not() {
        for form in forms() {
            let forces = form.shares(Vec2::new(0.02, -0.03)).map(|share| 600.0 * share);
            for sensor in 0..4 {
                let known = form.balanced(forces, sensor).map(|force| (force - forces[sensor]).abs() < 1e-2);
                assert_eq!(known, (form.count() == 4).then_some(true), "{form:?}");
            }
        }
        assert_eq!(forms()[0].sensors().len(), 3);
    }

    #[test]
    fn corners_are_known_as_such_in_whichever_way_they_are_written() {
        let plate = Vec2::new(0.511, 0.316);
        let corners = SensorPlaces::in_corners(plate, 0.039);
        assert_eq!(SensorPlaces::at(corners.as_slice()), Ok(corners));
        assert!(corners.rectangle().unwrap().distance(Vec2::new(0.2165, 0.119)) < 1e-6);
        assert!(forms()[1].is_parallelogram() && forms()[1].rectangle().is_none());
        assert!(!forms()[2].is_parallelogram());
    }

    #[test]
    fn sensors_that_find_no_load_are_refused() {
        use SensorPlacesError::{Count, Inside, NotFinite, OnOneLine, Order};
        assert_eq!(places(&[(0.0, 0.0), (0.1, 0.0)]), Err(Count(2)));
        assert_eq!(places(&[(0.0, 0.0), (f32::NAN, 0.0), (0.1, 0.2)]), Err(NotFinite(1)));
        assert_eq!(places(&[(-0.1, -0.1), (0.0, 0.004), (0.1, 0.1)]), Err(OnOneLine(0, 1, 2)));
        assert_eq!(places(&[(0.1, 0.1), (0.1, 0.1), (-0.1, 0.0)]), Err(OnOneLine(0, 1, 2)));
        assert_eq!(places(&[(-0.1, 0.0), (0.0, 0.0), (0.1, 0.0), (0.0, 0.1)]), Err(OnOneLine(0, 1, 2)));
        assert_eq!(places(&[(-0.2, -0.2), (0.2, -0.2), (0.0, 0.0), (0.0, 0.3)]), Err(Inside(2)));
        // Around the plate instead of row by row.
        assert_eq!(places(&[(-0.1, -0.1), (0.1, -0.1), (0.1, 0.1), (-0.1, 0.1)]), Err(Order(0, 3)));
    }
}
