//! The arguments of values and events.

use rosc::OscType;

use super::FieldRange::{Flag, Measure, OfValue, Words};
use super::{Append, Arguments, Field, arguments};
use crate::widget::{Detail, Value};

arguments! {
    /// Off or on.
    Switch { on: bool = Flag, }
    /// The index of a choice.
    Choice { choice: i32 = OfValue, }
    /// A number.
    Number { value: f32 = OfValue, }
    /// Two numbers.
    Pair { x_value: f32 = OfValue, y_value: f32 = OfValue, }
    /// The direction of a swipe.
    Swipe { direction: String = Words(&["north", "east", "south", "west"]), }
    /// The force and the place of an event.
    Place {
        force: f32 = Measure("N", ""),
        x: f32 = Measure("m", "eastwards"),
        y: f32 = Measure("m", "northwards"),
    }
}

/// Appends the arguments of `value` to `args`; returns their descriptions.
pub(crate) fn arguments_of_value(value: Value, args: &mut Vec<OscType>) -> &'static [Field] {
    match value {
        Value::Number(value) => append(Number { value }, args),
        Value::Switch(on) => append(Switch { on }, args),
        Value::Choice(choice) => append(Choice { choice: choice.into() }, args),
        Value::Pair(pair) => append(Pair { x_value: pair.x, y_value: pair.y }, args),
    }
}

/// Appends the arguments of `detail` to `args`; returns their descriptions.
pub(crate) fn arguments_of_detail(detail: Detail, args: &mut Vec<OscType>) -> &'static [Field] {
    match detail {
        Detail::Value(value) => arguments_of_value(value, args),
        Detail::Direction(direction) => append(Swipe { direction: direction.name().into() }, args),
    }
}

impl Append for Value {
    fn append(self, args: &mut Vec<OscType>) {
        arguments_of_value(self, args);
    }
}

fn append<T: Arguments>(content: T, args: &mut Vec<OscType>) -> &'static [Field] {
    content.append(args);
    T::FIELDS
}
