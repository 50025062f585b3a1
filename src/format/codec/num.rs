//! Numbers: within a range, in the unit of files, turned by hand.

use std::ops::RangeInclusive;
use std::time::Duration;

use super::Codec;
use crate::format::describe::FieldType;
use crate::format::hand::Hand;
use crate::format::node::Node;
use crate::format::number::Number;
use crate::format::text::{Entry, Text as RonText, number};
use crate::units::Newtons;

/// A number. Its unit follows from the end of its field's name.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Num {
    /// Least and greatest that a file may hold.
    range: (f64, f64),
    /// What a hand reaches.
    pub(in crate::format) hand: (f64, f64),
    /// What a value is multiplied with to be in the unit of files.
    pub(in crate::format) scale: f64,
    /// Whether it is written even where it is as its default: a file is to mean the same should that change.
    explicit: bool,
    /// Whether it keeps to what bounds such numbers ([`super::node::Within`]).
    pub(in crate::format) bounded: bool,
}

/// A number within `range`, in the unit of files.
pub(crate) const fn num(range: RangeInclusive<f64>) -> Num {
    let range = (*range.start(), *range.end());
    Num { range, hand: range, scale: 1.0, explicit: false, bounded: false }
}

impl Num {
    /// Turned by hand, only so far.
    pub(crate) const fn hand(self, hand: RangeInclusive<f64>) -> Self {
        Self { hand: (*hand.start(), *hand.end()), ..self }
    }

    /// Milliseconds in files, seconds in values.
    pub(crate) const fn milli(self) -> Self {
        Self { scale: 1000.0, ..self }
    }

    /// Degrees in files, radians in values.
    pub(crate) const fn degrees(self) -> Self {
        Self { scale: 180.0 / std::f64::consts::PI, ..self }
    }

    /// Written even where it is as its default.
    pub(crate) const fn explicit(self) -> Self {
        Self { explicit: true, ..self }
    }

    /// Whether a file may hold `value`.
    pub(crate) fn holds(&self, value: f32) -> bool {
        (self.range.0..=self.range.1).contains(&f64::from(value))
    }

    /// Keeps to what bounds such numbers in the record around it.
    pub(crate) const fn bounded(self) -> Self {
        Self { bounded: true, ..self }
    }
}

/// A type whose values are numbers in files.
pub(crate) trait Scalar: Copy + PartialEq {
    /// Whether only whole numbers are values.
    const WHOLE: bool = false;

    /// The value of a number that is written, `scale` of which are 1.
    fn of(written: Number, scale: f64) -> Self;

    /// The number that reads back as the same value.
    fn to_ron(self, scale: f64) -> String;

    /// The value as a hand sees it.
    fn shown(self) -> f32;

    /// What a hand made of it.
    fn turned(shown: f32) -> Self;
}

impl Scalar for f32 {
    fn of(written: Number, scale: f64) -> Self {
        written.single / scale as Self
    }

    fn to_ron(self, scale: f64) -> String {
        number(self, scale)
    }

    fn shown(self) -> f32 {
        self
    }

    fn turned(shown: f32) -> Self {
        shown
    }
}

impl Scalar for Newtons {
    fn of(written: Number, scale: f64) -> Self {
        Self(f32::of(written, scale))
    }

    fn to_ron(self, scale: f64) -> String {
        self.0.to_ron(scale)
    }

    fn shown(self) -> f32 {
        self.0
    }

    fn turned(shown: f32) -> Self {
        Self(shown)
    }
}

/// To the microsecond.
impl Scalar for Duration {
    fn of(written: Number, scale: f64) -> Self {
        Self::from_micros((written.value / scale * 1e6).round() as u64)
    }

    fn to_ron(self, scale: f64) -> String {
        let text = format!("{:.6}", self.as_secs_f64() * scale);
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
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

            fn to_ron(self, _: f64) -> String {
                self.to_string()
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

whole!(u8, u16, u32, usize);

impl<T: Scalar> Codec<T> for Num {
    fn read(&self, node: Node<'_>, _: Option<&T>) -> Option<T> {
        let range = self.range.0..=self.range.1;
        let number = if self.bounded { node.bounded(range) } else { node.number(range) }?;
        if T::WHOLE && !number.whole {
            node.report_fraction();
            return None;
        }
        Some(T::of(number, self.scale))
    }

    fn write(&self, value: &T) -> RonText {
        RonText::Plain(value.to_ron(self.scale))
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
        // Numbers of a list are edited as a list.
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
