//! Smooth curves over time for the motion of feet.

/// A value at a moment, and its rate of change there.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Knot {
    at_s: f64,
    value: f32,
    per_s: f32,
}

/// A smooth curve through knots: cubic between them, constant before the first and after the last.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Curve {
    knots: Vec<Knot>,
}

impl Curve {
    /// Appends a knot with `value` and zero slope at `at_s`; the curve stays constant after it unless more knots
    /// follow.
    ///
    /// Knots must be in order: a knot at the time of the last one makes a jump, and an earlier time is moved to the
    /// last one.
    pub(super) fn rest(&mut self, at_s: f64, value: f32) {
        self.pass(at_s, value, 0.0);
    }

    /// Appends a knot with `value` and the slope `per_s` (1/s) at `at_s`.
    pub(super) fn pass(&mut self, at_s: f64, value: f32, per_s: f32) {
        let at_s = self.knots.last().map_or(at_s, |last| at_s.max(last.at_s));
        self.knots.push(Knot { at_s, value, per_s });
    }

    /// Holds the curve's last value until `at_s`.
    pub(super) fn hold(&mut self, at_s: f64) {
        let value = self.knots.last().map_or(0.0, |last| last.value);
        self.rest(at_s, value);
    }

    /// Returns the value at `at_s`; zero for a curve without knots.
    pub(super) fn at(&self, at_s: f64) -> f32 {
        let next = self.knots.partition_point(|knot| knot.at_s <= at_s);
        match (next.checked_sub(1).and_then(|last| self.knots.get(last)), self.knots.get(next)) {
            (Some(from), Some(to)) => between(from, to, at_s),
            (Some(only), None) | (None, Some(only)) => only.value,
            (None, None) => 0.0,
        }
    }
}

/// The cubic with both knots' values and slopes (Hermite's form).
fn between(from: &Knot, to: &Knot, at_s: f64) -> f32 {
    let span = (to.at_s - from.at_s) as f32;
    let share = ((at_s - from.at_s) / (to.at_s - from.at_s)) as f32;
    let left = 1.0 - share;
    // This form keeps equal values exactly equal between the knots.
    from.value
        + (to.value - from.value) * share * share * (3.0 - 2.0 * share)
        + span * share * left * (from.per_s * left - to.per_s * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_its_knots_without_a_kink_and_rests_outside() {
        let mut curve = Curve::default();
        curve.rest(0.0, 1.0);
        curve.pass(2.0, 3.0, 4.0);
        curve.rest(3.0, 0.0);
        assert_eq!((curve.at(-1.0), curve.at(2.0), curve.at(9.0)), (1.0, 3.0, 0.0));
        let slope = |at: f64| (curve.at(at + 1e-4) - curve.at(at - 1e-4)) / 2e-4;
        assert!((slope(2.0) - 4.0).abs() < 0.05, "{}", slope(2.0));
        assert!(slope(0.0).abs() < 0.01 && slope(3.0).abs() < 0.01);
    }

    #[test]
    fn two_knots_at_one_moment_jump() {
        let mut curve = Curve::default();
        curve.rest(0.0, 1.0);
        curve.rest(1.0, 1.0);
        curve.rest(1.0, 5.0);
        assert_eq!((curve.at(0.999), curve.at(1.0)), (1.0, 5.0));
        curve.hold(2.0);
        assert_eq!(curve.at(2.0), 5.0);
        assert_eq!(Curve::default().at(1.0), 0.0);
    }
}
