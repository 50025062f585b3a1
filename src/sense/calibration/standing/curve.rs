//! One kind of law during the search, in two parameters that hardly depend on each other.

use crate::floor::{Calibration, LawKind};

/// Share of a divider's supply below which all outputs of the search stay.
const DIVIDER_END: f64 = 0.99;

/// A kind of law with its parameters `(p, q)`: `p` is the logarithm of the force at the output `at_v`, `q` that of the
/// curve's second number (exponent per volt, exponent, inverse of the supply; the straight line has none).
#[derive(Clone, Copy, Debug)]
pub(super) struct LawCurve {
    pub(super) kind: LawKind,
    /// A usual output under load (V).
    pub(super) at_v: f64,
    /// Greatest output that the search uses (V).
    pub(super) most_v: f64,
}

/// A force, and its derivatives with respect to `p` and `q`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct ForceSlope {
    pub(super) force: f64,
    pub(super) by_p: f64,
    pub(super) by_q: f64,
}

impl std::ops::Sub for ForceSlope {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self { force: self.force - other.force, by_p: self.by_p - other.by_p, by_q: self.by_q - other.by_q }
    }
}

impl ForceSlope {
    /// Adds `other`, `times` times.
    pub(super) fn add(&mut self, other: Self, times: f64) {
        self.force += times * other.force;
        self.by_p += times * other.by_p;
        self.by_q += times * other.by_q;
    }
}

impl LawCurve {
    /// Values of `q` from which the search may start.
    pub(super) fn starts(&self) -> Vec<f64> {
        let numbers: &[f64] = match self.kind {
            LawKind::Exponential => &[0.3, 0.5, 0.8, 1.1, 1.4, 1.8, 2.3, 3.0, 4.0],
            LawKind::Power => &[0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0, 6.0, 9.0],
            LawKind::Divider => &[0.1, 0.4, 0.6, 0.75, 0.85, 0.92, 0.96, 0.98],
            LawKind::Linear => &[1.0],
        };
        let unit = if self.kind == LawKind::Divider { self.most_v } else { 1.0 };
        numbers.iter().map(|number| (number / unit).ln()).collect()
    }

    /// Whether the curve rises over all outputs with this `q`.
    pub(super) fn holds(&self, q: f64) -> bool {
        match self.kind {
            LawKind::Divider => q.exp() * self.most_v < DIVIDER_END,
            LawKind::Exponential | LawKind::Power => q.exp() < 40.0,
            LawKind::Linear => true,
        }
    }

    /// The force at `volts`, without subtracting that of the empty floor.
    pub(super) fn slope(&self, volts: f64, [p, q]: [f64; 2]) -> ForceSlope {
        let (force, along) = match self.kind {
            LawKind::Exponential => {
                let exponent = q.exp() * (volts - self.at_v);
                ((p + exponent).exp(), exponent)
            }
            LawKind::Power if volts > 0.0 => {
                let exponent = q.exp() * (volts / self.at_v).ln();
                ((p + exponent).exp(), exponent)
            }
            LawKind::Power => (0.0, 0.0),
            LawKind::Divider => {
                let inverse = q.exp();
                let rise = |volts: f64| volts / (1.0 - inverse * volts);
                let (here, there) = (rise(volts), rise(self.at_v));
                (p.exp() * here / there, inverse * (here - there))
            }
            LawKind::Linear => (p.exp() * volts / self.at_v, 0.0),
        };
        ForceSlope { force, by_p: force, by_q: force * along }
    }

    /// The law with these parameters, for a sensor with the output `empty_v` on the empty floor: a straight line is
    /// zero there, because differences of forces tell nothing about its zero.
    pub(super) fn law(&self, [p, q]: [f64; 2], empty_v: f64) -> Calibration {
        let (force, number) = (p.exp(), q.exp());
        let numbers = match self.kind {
            LawKind::Exponential => [force * (-number * self.at_v).exp(), number],
            LawKind::Power => [force * self.at_v.powf(-number), number],
            LawKind::Divider => [force * (1.0 - number * self.at_v) / (self.at_v * number), number.recip()],
            LawKind::Linear => [force / self.at_v, empty_v],
        };
        Calibration::of(self.kind, numbers.map(|number| number as f32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_are_those_of_the_law_that_is_kept_and_derivatives_those_of_the_forces() {
        for (kind, q) in [
            (LawKind::Exponential, 1.3_f64.ln()),
            (LawKind::Power, 2.9_f64.ln()),
            (LawKind::Divider, 0.2_f64.ln()),
            (LawKind::Linear, 0.0),
        ] {
            let curve = LawCurve { kind, at_v: 3.2, most_v: 4.6 };
            assert!(curve.holds(q));
            let at = [4.7, q];
            let law = curve.law(at, 0.0);
            for volts in [0.4, 1.9, 3.2, 4.5] {
                let slope = curve.slope(volts, at);
                let kept = f64::from(law.force_at(volts as f32).0);
                assert!(
                    (slope.force / kept - 1.0).abs() < 1e-4,
                    "{law} at {volts}: {} or {kept}",
                    slope.force
                );
                let step = 1e-6;
                let by_p = (curve.slope(volts, [at[0] + step, q]).force - slope.force) / step;
                let by_q = (curve.slope(volts, [at[0], q + step]).force - slope.force) / step;
                assert!((slope.by_p - by_p).abs() < 1e-3 * slope.force, "{kind:?}");
                assert!((slope.by_q - by_q).abs() < 1e-2 + 1e-3 * slope.force, "{kind:?} {by_q} {slope:?}");
            }
        }
    }

    #[test]
    fn a_divider_keeps_its_supply_above_all_outputs() {
        let curve = LawCurve { kind: LawKind::Divider, at_v: 3.0, most_v: 4.8 };
        assert!(curve.holds(4.9_f64.recip().ln()) && !curve.holds(4.82_f64.recip().ln()));
        assert!(curve.starts().into_iter().all(|q| curve.holds(q)));
    }
}
