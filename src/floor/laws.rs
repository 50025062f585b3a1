//! The laws of force sensors: newtons as a function of the voltage.

use super::exp::exp;
use underfoot_format::{Num, num, record};

record! {
    /// `f = a exp(b v)`: the law of the paper's conditioned force-sensing resistors.
    ///
    /// # Source
    /// Paper, section 2.2; v in volts, f in newtons.
    pub struct Exponential = "Exponential", Copy;
    /// Factor a, the force at no voltage, in newtons; positive.
    pub a_n: f32 = "a_n", EXPONENTIAL[0] => Exponential::NOMINAL.a_n;
    /// Exponent b, per volt; positive.
    pub b_per_volt: f32 = "b_per_volt", EXPONENTIAL[1] => Exponential::NOMINAL.b_per_volt;
}

record! {
    /// `f = a v^b`: a force-sensing resistor with an amplifier that measures its current; the conductance is a power of
    /// the force.
    ///
    /// # Source
    /// Resistance over force is close to a straight line on two logarithmic axes (Interlink Electronics, FSR
    /// Integration Guide, force against resistance); the current through it, and the amplifier's voltage, are then a
    /// power of the force.
    pub struct Power = "Power", Copy;
    /// Factor a, the force at one volt, in newtons; positive.
    pub a_n: f32 = "a_n", POWER[0];
    /// Exponent b; positive.
    pub exponent: f32 = "exponent", POWER[1];
}

record! {
    /// `f = a v / (s - v)`: a resistor with a conductance proportional to the force, in a voltage divider.
    ///
    /// # Source
    /// `v = s R_m / (R_m + R)` (Interlink Electronics, FSR Integration Guide, voltage divider), with the supply s, the
    /// measuring resistor `R_m`, and `R = k / f`: solved for the force, `f = a v / (s - v)` with `a = k / R_m`.
    pub struct Divider = "Divider", Copy;
    /// Factor a, the force at half of the supply, in newtons; positive.
    pub a_n: f32 = "a_n", DIVIDER[0];
    /// Supply s of the divider, in volts; positive.
    pub supply_v: f32 = "supply_v", DIVIDER[1];
}

record! {
    /// `f = a (v - z)`: a load cell with its amplifier, or any linear part.
    pub struct Linear = "Linear", Copy;
    /// Slope a, in newtons per volt; positive.
    pub a_n_per_volt: f32 = "a_n_per_volt", LINEAR[0];
    /// Zero z, the voltage at no force.
    pub zero_v: f32 = "zero_v", LINEAR[1];
}

// Ranges of a part's numbers; beyond them there is no known force sensor, or single precision ends.

/// Parts with hardly any force at 0 V have a small a and a large b: 10 N at 5 V with b = 14 is 4e-30 N.
pub(super) const EXPONENTIAL: [Num; 2] = [num(1e-30..=1e3).explicit(), num(1e-3..=20.0).explicit()];

pub(super) const POWER: [Num; 2] = [num(1e-30..=1e6), num(1e-2..=50.0)];

/// With a supply far beyond the converter's range, the law is a straight line.
pub(super) const DIVIDER: [Num; 2] = [num(1e-3..=1e6), num(0.1..=1e3)];

pub(super) const LINEAR: [Num; 2] = [num(1e-3..=1e6), num(-100.0..=100.0)];

impl Exponential {
    /// The part that underfoot assumes without a measurement: 0.5 N at 0 V, 406 N at 5 V (our choice).
    pub const NOMINAL: Self = Self { a_n: 0.5, b_per_volt: 1.34 };

    /// Returns the force in newtons at `volts`.
    #[must_use]
    #[inline]
    pub fn newtons(&self, volts: f32) -> f32 {
        self.a_n * exp(self.b_per_volt * volts)
    }

    /// Returns the voltage at which the law gives `force` newtons; NaN for a negative force.
    #[must_use]
    pub fn volts(&self, force: f32) -> f32 {
        (force / self.a_n).ln() / self.b_per_volt
    }
}

impl Power {
    /// Returns the force in newtons at `volts`; zero for a negative voltage.
    #[must_use]
    #[inline]
    pub fn newtons(&self, volts: f32) -> f32 {
        self.a_n * volts.max(0.0).powf(self.exponent)
    }

    /// Returns the voltage at which the law gives `force` newtons; NaN for a negative force.
    #[must_use]
    pub fn volts(&self, force: f32) -> f32 {
        (force / self.a_n).powf(1.0 / self.exponent)
    }
}

impl Divider {
    /// Share of the supply that counts as the end of a divider's range: within another half percent of the supply,
    /// its force grows without bounds (our choice).
    pub(crate) const END: f32 = 0.995;

    /// Returns the force in newtons at `volts`; constant from 0.995 of the supply on.
    #[must_use]
    #[inline]
    pub fn newtons(&self, volts: f32) -> f32 {
        let volts = volts.min(Self::END * self.supply_v);
        self.a_n * volts / (self.supply_v - volts)
    }

    /// Returns the voltage at which the law gives `force` newtons; below the supply for every force of at least 0.
    #[must_use]
    pub fn volts(&self, force: f32) -> f32 {
        self.supply_v * force / (self.a_n + force)
    }
}

impl Linear {
    /// Returns the force in newtons at `volts`; negative below the zero.
    #[must_use]
    #[inline]
    pub fn newtons(&self, volts: f32) -> f32 {
        self.a_n_per_volt * (volts - self.zero_v)
    }

    /// Returns the voltage at which the law gives `force` newtons.
    #[must_use]
    pub fn volts(&self, force: f32) -> f32 {
        self.zero_v + force / self.a_n_per_volt
    }
}
