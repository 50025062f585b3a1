//! Quantities used in several modules: force and time.
//!
//! Lengths are plain metres in [`glam::Vec2`]; see [`crate::floor`] for the floor's axes.

use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};
use std::sync::Arc;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use underfoot_format::codec::Scalar;
use underfoot_format::number::Number;
use underfoot_format::text::RonText;

/// A force along the floor's normal, in newtons; positive presses the floor down.
///
/// Any `f32` is representable, NaN included: code that accepts outside numbers checks them with
/// [`Newtons::is_finite`].
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Newtons(pub f32);

impl Newtons {
    /// No force.
    pub const ZERO: Self = Self(0.0);

    /// Whether this is neither NaN nor infinite.
    #[must_use]
    pub fn is_finite(self) -> bool {
        self.0.is_finite()
    }

    /// Returns the greater of the two; the other one if either is NaN.
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }

    /// Returns the absolute value.
    #[must_use]
    pub fn abs(self) -> Self {
        Self(self.0.abs())
    }
}

/// Written in newtons.
impl Scalar for Newtons {
    fn of(written: Number, scale: f64) -> Self {
        Self(f32::of(written, scale))
    }

    fn to_ron(self, scale: f64) -> RonText {
        self.0.to_ron(scale)
    }

    fn shown(self) -> f32 {
        self.0
    }

    fn turned(shown: f32) -> Self {
        Self(shown)
    }
}

impl Add for Newtons {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl AddAssign for Newtons {
    fn add_assign(&mut self, other: Self) {
        self.0 += other.0;
    }
}

impl Sub for Newtons {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl SubAssign for Newtons {
    fn sub_assign(&mut self, other: Self) {
        self.0 -= other.0;
    }
}

impl Neg for Newtons {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Mul<f32> for Newtons {
    type Output = Self;
    fn mul(self, factor: f32) -> Self {
        Self(self.0 * factor)
    }
}

impl Div for Newtons {
    type Output = f32;
    fn div(self, other: Self) -> f32 {
        self.0 / other.0
    }
}

impl Sum for Newtons {
    fn sum<I: Iterator<Item = Self>>(forces: I) -> Self {
        forces.fold(Self::ZERO, Add::add)
    }
}

/// A moment on a monotonic clock, in whole microseconds since that clock's start.
///
/// The caller chooses the clock: the host's monotonic clock on a live floor, the scenario's own clock in a
/// simulation. Wall-clock time never becomes an `Instant`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Instant(u64);

impl Instant {
    /// The start of the clock.
    pub const START: Self = Self(0);

    /// The moment `micros` microseconds after the clock's start.
    #[must_use]
    pub const fn from_micros(micros: u64) -> Self {
        Self(micros)
    }

    /// The moment `millis` milliseconds after the clock's start.
    #[must_use]
    pub const fn from_millis(millis: u64) -> Self {
        Self(millis * 1000)
    }

    /// Microseconds since the clock's start.
    #[must_use]
    pub const fn micros(self) -> u64 {
        self.0
    }

    /// Seconds since the clock's start.
    #[must_use]
    pub fn secs(self) -> f64 {
        self.0 as f64 * 1e-6
    }

    /// Returns the time from `earlier` to `self`; zero if `earlier` is later.
    #[must_use]
    pub const fn since(self, earlier: Self) -> Duration {
        Duration::from_micros(self.0.saturating_sub(earlier.0))
    }

    /// Returns the moment `span` before `self`, or the clock's start if that is earlier.
    #[must_use]
    pub fn before(self, span: Duration) -> Self {
        Self(self.0.saturating_sub(micros(span)))
    }
}

impl Add<Duration> for Instant {
    type Output = Self;
    /// Returns the moment `span` later, at most the clock's end (584,000 years).
    fn add(self, span: Duration) -> Self {
        Self(self.0.saturating_add(micros(span)))
    }
}

/// A clock that several threads read.
pub type HostClock = Arc<dyn Fn() -> Instant + Send + Sync>;

fn micros(span: Duration) -> u64 {
    u64::try_from(span.as_micros()).unwrap_or(u64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_since_a_later_moment_is_zero() {
        let early = Instant::from_millis(5);
        let late = Instant::from_millis(7);
        assert_eq!(late.since(early), Duration::from_millis(2));
        assert_eq!(early.since(late), Duration::ZERO);
        assert_eq!(early.before(Duration::from_secs(1)), Instant::START);
    }

    #[test]
    fn forces_add_up() {
        let total: Newtons = [Newtons(1.0), Newtons(2.5)].into_iter().sum();
        assert_eq!(total, Newtons(3.5));
        assert_eq!(Newtons(1.0) / Newtons(4.0), 0.25);
    }
}
