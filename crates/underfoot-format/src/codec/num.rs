//! Numbers: range, unit in files, tuning.

use std::ops::RangeInclusive;
use std::time::Duration;

use super::Codec;
use crate::describe::FieldType;
use crate::hand::Hand;
use crate::node::Node;
use crate::number::Number;
use crate::text::{Entry, RonText, number};

/// A number. The end of the field's name gives its unit.
#[derive(Clone, Copy, Debug)]
pub struct Num {
    /// Minimum and maximum in a file.
    range: (f64, f64),
    /// Range of a tuner.
    pub(crate) hand: (f64, f64),
    /// Factor from the value to the unit of files.
    pub(crate) scale: f64,
    /// Whether the number is written even where it equals its default, so that a file keeps its meaning when the
    /// default changes.
    explicit: bool,
    /// Whether the limits of the surrounding record apply as well ([`super::node::Within`]).
    pub(crate) bounded: bool,
}

/// A number within `range`, in the unit of files.
pub const fn num(range: RangeInclusive<f64>) -> Num {
    let range = (*range.start(), *range.end());
    Num { range, hand: range, scale: 1.0, explicit: false, bounded: false }
}

impl Num {
    /// Limits the range of a tuner.
    pub const fn hand(self, hand: RangeInclusive<f64>) -> Self {
        Self { hand: (*hand.start(), *hand.end()), ..self }
    }

    /// Milliseconds in files, seconds in values.
    pub const fn milli(self) -> Self {
        Self { scale: 1000.0, ..self }
    }

    /// Degrees in files, radians in values.
    pub const fn degrees(self) -> Self {
        Self { scale: 180.0 / std::f64::consts::PI, ..self }
    }

    /// Written even where it equals its default.
    pub const fn explicit(self) -> Self {
        Self { explicit: true, ..self }
    }

    /// Whether a file may hold `value`.
    pub fn holds(&self, value: f32) -> bool {
        (self.range.0..=self.range.1).contains(&f64::from(value))
    }

    /// Applies the limits of the surrounding record as well.
    pub const fn bounded(self) -> Self {
        Self { bounded: true, ..self }
    }
}

/// A type that files write as a number.
pub trait Scalar: Copy + PartialEq {
    /// Whether only whole numbers are values.
    const WHOLE: bool = false;

    /// Converts a written number to the value: `written / scale`.
    fn of(written: Number, scale: f64) -> Self;

    /// Returns the number that reads back as the same value.
    fn to_ron(self, scale: f64) -> RonText;

    /// Returns the value as a tuner shows it.
    fn shown(self) -> f32;

    /// Converts the number that a tuner set.
    fn turned(shown: f32) -> Self;
}

impl Scalar for f32 {
    fn of(written: Number, scale: f64) -> Self {
        written.single / scale as Self
    }

    fn to_ron(self, scale: f64) -> RonText {
        number(self, scale)
    }

    fn shown(self) -> f32 {
        self
    }

    fn turned(shown: f32) -> Self {
        shown
    }
}

/// Rounded to the microsecond.
impl Scalar for Duration {
    fn of(written: Number, scale: f64) -> Self {
        Self::from_micros((written.value / scale * 1e6).round() as u64)
    }

    fn to_ron(self, scale: f64) -> RonText {
        RonText::double((self.as_secs_f64() * scale * 1e6).round() / 1e6)
    }

    fn shown(self) -> f32 {
        self.as_secs_f32()
    }

    fn turned(shown: f32) -> Self {
        Self::try_from_secs_f32(shown).unwrap_or_default()
    }
}

/// Whole numbers; their range must fit into the type.
macro_rules! whole {
    ($($type:ty),*) => {
        $(impl Scalar for $type {
            const WHOLE: bool = true;

            fn of(written: Number, _: f64) -> Self {
                written.value as Self
            }

            fn to_ron(self, _: f64) -> RonText {
                RonText::Whole(self as i64)
            }

            fn shown(self) -> f32 {
                self as f32
            }

            fn turned(shown: f32) -> Self {
                shown.round() as Self
            }
        })*
    };
}

whole!(i16, u8, u16, u32, usize);

impl<T: Scalar> Codec<T> for Num {
    type Context = ();

    fn read(&self, node: Node<'_>, _: Option<&T>, (): &()) -> Option<T> {
        let range = self.range.0..=self.range.1;
        let number = if self.bounded { node.bounded(range) } else { node.number(range) }?;
        if T::WHOLE && !number.whole {
            node.report_fraction();
            return None;
        }
        Some(T::of(number, self.scale))
    }

    fn write(&self, value: &T) -> RonText {
        value.to_ron(self.scale)
    }

    fn shape(&self) -> FieldType {
        FieldType::Number { range: self.range, whole: T::WHOLE }
    }

    fn write_field(&self, value: &T, name: &'static str, default: Option<T>, entries: &mut Vec<Entry>) {
        if self.explicit || default.as_ref() != Some(value) {
            entries.push((name, self.write(value)));
        }
    }

    fn stand_in(&self) -> T {
        let least = self.range.0.max(0.0).min(self.range.1);
        T::of(Number { value: least, single: least as f32, whole: true }, self.scale)
    }

    fn turn(&self, value: &mut T, name: &'static str, hand: &mut Hand<'_>) {
        // A list is edited as a whole.
        if name.is_empty() {
            return;
        }
        let mut shown = value.shown();
        hand.show(self, T::WHOLE, name, &mut shown);
        if shown != value.shown() {
            *value = T::turned(shown);
        }
    }
}
