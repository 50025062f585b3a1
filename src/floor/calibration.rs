//! Conversion of a sensor's counts to newtons.

use std::fmt;

use super::laws::{self, Divider, Exponential, Linear, Power};
use super::significant::Significant;
use crate::units::Newtons;
use underfoot_format::choices;

choices! {
    /// The law of one force sensor, with the part's own two numbers.
    pub enum Calibration: Copy;
    /// `f = a exp(b v)`, the paper's.
    Exponential(Exponential),
    /// `f = a v^b`.
    Power(Power),
    /// `f = a v / (s - v)`.
    Divider(Divider),
    /// `f = a (v - z)`.
    Linear(Linear),
}

/// The kind of a law, without its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LawKind {
    /// `f = a exp(b v)`.
    Exponential,
    /// `f = a v^b`.
    Power,
    /// `f = a v / (s - v)`.
    Divider,
    /// `f = a (v - z)`.
    Linear,
}

impl Calibration {
    /// The part that underfoot assumes without a measurement: exponential, 0.5 N at 0 V, 406 N at 5 V (our choice).
    pub const NOMINAL: Self = Self::Exponential(Exponential::NOMINAL);

    /// Voltage at the converter's full scale.
    pub const FULL_SCALE_VOLTS: f32 = 5.0;

    /// Counts above which every sensor is near the end of its range (98 %) and its reading is a lower bound.
    pub(crate) const SATURATED: u16 = 64_225;

    /// The exponential law with these numbers.
    #[must_use]
    pub const fn exponential(a_n: f32, b_per_volt: f32) -> Self {
        Self::Exponential(Exponential { a_n, b_per_volt })
    }

    /// The law of this kind with its two numbers, in the order of [`LawKind::number_names`].
    #[must_use]
    pub const fn of(kind: LawKind, [a, b]: [f32; 2]) -> Self {
        match kind {
            LawKind::Exponential => Self::exponential(a, b),
            LawKind::Power => Self::Power(Power { a_n: a, exponent: b }),
            LawKind::Divider => Self::Divider(Divider { a_n: a, supply_v: b }),
            LawKind::Linear => Self::Linear(Linear { a_n_per_volt: a, zero_v: b }),
        }
    }

    /// Returns the kind of the law.
    #[must_use]
    pub const fn kind(&self) -> LawKind {
        match self {
            Self::Exponential(_) => LawKind::Exponential,
            Self::Power(_) => LawKind::Power,
            Self::Divider(_) => LawKind::Divider,
            Self::Linear(_) => LawKind::Linear,
        }
    }

    /// Returns its two numbers, in the order of [`LawKind::number_names`].
    #[must_use]
    pub const fn numbers(&self) -> [f32; 2] {
        match *self {
            Self::Exponential(Exponential { a_n, b_per_volt }) => [a_n, b_per_volt],
            Self::Power(Power { a_n, exponent }) => [a_n, exponent],
            Self::Divider(Divider { a_n, supply_v }) => [a_n, supply_v],
            Self::Linear(Linear { a_n_per_volt, zero_v }) => [a_n_per_volt, zero_v],
        }
    }

    /// Whether a force sensor can have this law: both numbers within the ranges of floor files, and a finite force at
    /// the converter's full scale.
    #[must_use]
    pub(crate) fn is_plausible(&self) -> bool {
        let ranges = match self {
            Self::Exponential(_) => laws::EXPONENTIAL,
            Self::Power(_) => laws::POWER,
            Self::Divider(_) => laws::DIVIDER,
            Self::Linear(_) => laws::LINEAR,
        };
        ranges.iter().zip(self.numbers()).all(|(range, number)| range.holds(number))
            && self.force(u16::MAX).is_finite()
    }

    /// Returns the voltage of a raw 16-bit reading: 0 to 5 V.
    #[must_use]
    pub fn volts(counts: u16) -> f32 {
        f32::from(counts) * (Self::FULL_SCALE_VOLTS / f32::from(u16::MAX))
    }

    /// Returns the voltage of a reading with fractions on the scale of 16 bits; negative below zero volts.
    #[must_use]
    pub(crate) fn volts_of(counts: f32) -> f32 {
        counts * (Self::FULL_SCALE_VOLTS / f32::from(u16::MAX))
    }

    /// Returns the force of a raw 16-bit reading, without subtracting the tare.
    #[must_use]
    #[inline]
    pub fn force(&self, counts: u16) -> Newtons {
        self.force_at(Self::volts(counts))
    }

    /// Returns the force at a voltage, without subtracting the tare.
    ///
    /// It is negative only below a linear part's zero. A force beyond single precision becomes infinite.
    #[must_use]
    #[inline]
    pub fn force_at(&self, volts: f32) -> Newtons {
        Newtons(match self {
            Self::Exponential(law) => law.newtons(volts),
            Self::Power(law) => law.newtons(volts),
            Self::Divider(law) => law.newtons(volts),
            Self::Linear(law) => law.newtons(volts),
        })
    }

    /// Returns the voltage at which the law gives `force`, possibly outside of the converter's range; NaN if there is
    /// none.
    #[must_use]
    pub fn volts_at(&self, force: Newtons) -> f32 {
        match self {
            Self::Exponential(law) => law.volts(force.0),
            Self::Power(law) => law.volts(force.0),
            Self::Divider(law) => law.volts(force.0),
            Self::Linear(law) => law.volts(force.0),
        }
    }

    /// Returns the counts above which this sensor is near the end of its range and its reading is a lower bound:
    /// 64,225, or the end of a divider with a supply below the converter's full scale.
    #[must_use]
    pub fn saturated(&self) -> u16 {
        match self {
            Self::Divider(Divider { supply_v, .. }) => {
                let end = Divider::END * supply_v / Self::FULL_SCALE_VOLTS * f32::from(u16::MAX);
                // The cast saturates at the ends of the range.
                (end as u16).min(Self::SATURATED)
            }
            Self::Exponential(_) | Self::Power(_) | Self::Linear(_) => Self::SATURATED,
        }
    }
}

impl From<Exponential> for Calibration {
    fn from(law: Exponential) -> Self {
        Self::Exponential(law)
    }
}

/// The usual notation of the law, with its numbers to four digits: `0.5 exp(1.34 v)`.
impl fmt::Display for Calibration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [a, b] = self.numbers().map(|number| Significant::new(number, 4));
        match self {
            Self::Exponential(_) => write!(f, "{a} exp({b} v)"),
            Self::Power(_) => write!(f, "{a} v^{b}"),
            Self::Divider(_) => write!(f, "{a} v / ({b} - v)"),
            Self::Linear(Linear { zero_v, .. }) if *zero_v < 0.0 => {
                write!(f, "{a} (v + {})", Significant::new(-zero_v, 4))
            }
            Self::Linear(_) => write!(f, "{a} (v - {b})"),
        }
    }
}

impl LawKind {
    /// All kinds, the paper's first.
    pub const ALL: [Self; 4] = [Self::Exponential, Self::Power, Self::Divider, Self::Linear];

    /// Returns its name: `exponential`, `power`, `divider` or `linear`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Exponential => "exponential",
            Self::Power => "power",
            Self::Divider => "divider",
            Self::Linear => "linear",
        }
    }

    /// Returns the names of its two numbers in floor files, in the order of the formula.
    #[must_use]
    pub const fn number_names(self) -> [&'static str; 2] {
        match self {
            Self::Exponential => ["a_n", "b_per_volt"],
            Self::Power => ["a_n", "exponent"],
            Self::Divider => ["a_n", "supply_v"],
            Self::Linear => ["a_n_per_volt", "zero_v"],
        }
    }

    /// Returns its formula: newtons as a function of volts.
    #[must_use]
    pub const fn formula(self) -> &'static str {
        match self {
            Self::Exponential => "f = a exp(b v)",
            Self::Power => "f = a v^b",
            Self::Divider => "f = a v / (s - v)",
            Self::Linear => "f = a (v - z)",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One part of each law, with typical numbers.
    const PARTS: [Calibration; 4] = [
        Calibration::NOMINAL,
        Calibration::Power(Power { a_n: 2.2, exponent: 3.1 }),
        Calibration::Divider(Divider { a_n: 35.0, supply_v: 5.0 }),
        Calibration::Linear(Linear { a_n_per_volt: 82.0, zero_v: 0.4 }),
    ];

    #[test]
    fn forces_are_those_of_the_formulas_worked_out_by_hand() {
        // At 2 V: 0.5 e^2.68, 2.2 * 2^3.1, 35 * 2 / 3, 82 * 1.6.
        for (part, force) in PARTS.into_iter().zip([7.2925, 18.863, 23.333, 131.2]) {
            let read = part.force_at(2.0).0;
            assert!((read / force - 1.0).abs() < 1e-4, "{part}: {read}");
        }
    }

    #[test]
    fn a_force_leads_to_its_voltage_and_back() {
        for part in PARTS {
            for volts in [0.5, 1.0, 2.5, 4.5, 4.9] {
                let back = part.volts_at(part.force_at(volts));
                assert!((back - volts).abs() < 1e-4, "{part}: {back} for {volts}");
            }
        }
    }

    #[test]
    fn every_law_rises_and_is_finite_over_the_converter_s_whole_range() {
        for part in PARTS {
            let forces: Vec<f32> = (0..=u16::MAX).step_by(257).map(|counts| part.force(counts).0).collect();
            assert!(forces.iter().all(|force| force.is_finite()), "{part}");
            // A divider of 5 V is constant in the last half percent.
            let (rising, end) = forces.split_at(253);
            assert!(rising.windows(2).all(|pair| pair[1] > pair[0]), "{part}");
            assert!(end.windows(2).all(|pair| pair[1] >= pair[0]), "{part}");
        }
    }

    #[test]
    fn a_divider_of_a_lower_supply_ends_where_its_supply_does() {
        let part = Calibration::Divider(Divider { a_n: 30.0, supply_v: 3.3 });
        assert_eq!(part.saturated(), (0.995 * 3.3 / 5.0 * 65_535.0) as u16);
        assert!(part.force(part.saturated()).0 > 190.0 * 30.0);
        assert_eq!(part.force(u16::MAX), part.force(50_000));
        for part in PARTS {
            assert_eq!(part.saturated(), Calibration::SATURATED, "{part}");
        }
    }

    #[test]
    fn laws_are_written_so_that_small_numbers_can_be_read() {
        let shown: Vec<String> = PARTS.iter().map(ToString::to_string).collect();
        assert_eq!(shown, ["0.5 exp(1.34 v)", "2.2 v^3.1", "35 v / (5 - v)", "82 (v - 0.4)"]);
        assert_eq!(Calibration::exponential(4.4e-6, 3.711_26).to_string(), "4.4e-6 exp(3.711 v)");
        let below = Calibration::Linear(Linear { a_n_per_volt: 82.123_45, zero_v: -0.000_12 });
        assert_eq!(below.to_string(), "82.12 (v + 1.2e-4)");
    }

    #[test]
    fn what_no_file_may_hold_is_told() {
        assert!(PARTS.iter().all(Calibration::is_plausible));
        assert!(Calibration::exponential(4.4e-6, 3.7).is_plausible());
        for part in [
            Calibration::exponential(-1.0, 1.3),
            Calibration::exponential(0.5, f32::NAN),
            Calibration::exponential(10.0, 19.0),
            Calibration::Divider(Divider { a_n: 30.0, supply_v: 2e3 }),
            Calibration::Linear(Linear { a_n_per_volt: -3.0, zero_v: 0.0 }),
        ] {
            assert!(!part.is_plausible(), "{part}");
        }
    }

    #[test]
    fn nominal_part_spans_half_a_newton_to_400() {
        let part = Calibration::NOMINAL;
        assert!((part.force(0).0 - 0.5).abs() < 1e-6);
        assert!((400.0..410.0).contains(&part.force(u16::MAX).0));
    }
}
