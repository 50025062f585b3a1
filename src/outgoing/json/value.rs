//! A value of any kind.

use std::fmt;

use serde::de::{Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Serialize, Serializer};
use serde_json::{Value as Json, json};

use super::text::Word;
use crate::engine::ValueRange;
use crate::widget::{Detail, Scale, Value};

/// A value of a control, its range or another property.
///
/// Reading accepts anything: [`JsonValue::Nothing`] stands for what no control has.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum JsonValue {
    /// Null.
    #[default]
    Nothing,
    /// True or false.
    Flag(bool),
    /// A number without decimal places, such as the index of an option.
    Whole(i64),
    /// A number with decimal places, which may be zeros.
    Number(f32),
    /// A text.
    Text(Word),
    /// Two numbers: a pair, or the minimum and maximum of a number.
    Numbers([f32; 2]),
    /// Minimum and maximum of both numbers of a pair.
    Ranges([[f32; 2]; 2]),
}

impl JsonValue {
    /// Returns the value as arguments of a request; `None` if no request has such arguments.
    #[must_use]
    pub fn arguments(&self) -> Option<Vec<Json>> {
        Some(match self {
            Self::Nothing | Self::Ranges(_) => return None,
            Self::Flag(on) => vec![json!(on)],
            Self::Whole(number) => vec![json!(number)],
            // Requests take a choice as an integer.
            Self::Number(number) if number.fract() == 0.0 => vec![json!(*number as i64)],
            Self::Number(number) => vec![json!(number)],
            Self::Text(text) => vec![json!(text)],
            Self::Numbers(numbers) => numbers.iter().map(|number| json!(number)).collect(),
        })
    }

    /// Returns the flag; `None` for other kinds of value.
    #[must_use]
    pub const fn flag(&self) -> Option<bool> {
        if let Self::Flag(on) = self { Some(*on) } else { None }
    }

    /// Returns the number, with or without decimal places; `None` for other kinds of value.
    #[must_use]
    pub const fn number(&self) -> Option<f32> {
        match self {
            Self::Whole(number) => Some(*number as f32),
            Self::Number(number) => Some(*number),
            _ => None,
        }
    }

    const fn numbers(&self) -> Option<[f32; 2]> {
        if let Self::Numbers(numbers) = self { Some(*numbers) } else { None }
    }
}

/// Reads a flag; anything else is `None`.
pub(super) fn flag<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<bool>, D::Error> {
    Ok(JsonValue::deserialize(deserializer)?.flag())
}

/// Reads a number; anything else is `None`.
pub(super) fn number<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f32>, D::Error> {
    Ok(JsonValue::deserialize(deserializer)?.number())
}

/// Reads a text; anything else is `None`.
pub(super) fn word<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Word>, D::Error> {
    let JsonValue::Text(word) = JsonValue::deserialize(deserializer)? else { return Ok(None) };
    Ok(Some(word))
}

impl From<Value> for JsonValue {
    fn from(value: Value) -> Self {
        match value {
            Value::Switch(on) => Self::Flag(on),
            Value::Number(number) => Self::Number(number),
            Value::Choice(choice) => Self::Whole(choice.into()),
            Value::Pair(pair) => Self::Numbers(pair.to_array()),
        }
    }
}

impl From<Detail> for JsonValue {
    fn from(detail: Detail) -> Self {
        match detail {
            Detail::Value(value) => value.into(),
            Detail::Direction(direction) => Self::Text(direction.name().into()),
        }
    }
}

/// A list of choices has no minimum and maximum.
impl From<&ValueRange> for JsonValue {
    fn from(range: &ValueRange) -> Self {
        let ends = |scale: &Scale| [scale.min, scale.max];
        match range {
            ValueRange::Number(scale) => Self::Numbers(ends(scale)),
            ValueRange::Pair(x, y) => Self::Ranges([ends(x), ends(y)]),
            ValueRange::Choices(_) => Self::Nothing,
        }
    }
}

impl Serialize for JsonValue {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Nothing => serializer.serialize_unit(),
            Self::Flag(on) => serializer.serialize_bool(*on),
            Self::Whole(number) => serializer.serialize_i64(*number),
            Self::Number(number) => serializer.serialize_f32(*number),
            Self::Text(text) => text.serialize(serializer),
            Self::Numbers(numbers) => numbers.serialize(serializer),
            Self::Ranges(ranges) => ranges.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for JsonValue {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ValueVisitor)
    }
}

struct ValueVisitor;

impl<'de> Visitor<'de> for ValueVisitor {
    type Value = JsonValue;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("anything")
    }

    fn visit_bool<E>(self, on: bool) -> Result<JsonValue, E> {
        Ok(JsonValue::Flag(on))
    }

    fn visit_i64<E>(self, number: i64) -> Result<JsonValue, E> {
        Ok(JsonValue::Whole(number))
    }

    fn visit_u64<E>(self, number: u64) -> Result<JsonValue, E> {
        Ok(i64::try_from(number).map_or(JsonValue::Number(number as f32), JsonValue::Whole))
    }

    fn visit_f64<E>(self, number: f64) -> Result<JsonValue, E> {
        Ok(JsonValue::Number(number as f32))
    }

    fn visit_str<E>(self, text: &str) -> Result<JsonValue, E> {
        Ok(JsonValue::Text(Word::cleaned(text)))
    }

    fn visit_unit<E>(self) -> Result<JsonValue, E> {
        Ok(JsonValue::Nothing)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<JsonValue, A::Error> {
        let mut pair = [JsonValue::Nothing, JsonValue::Nothing];
        for entry in &mut pair {
            *entry = list.next_element()?.unwrap_or_default();
        }
        let mut is_longer = false;
        while list.next_element::<IgnoredAny>()?.is_some() {
            is_longer = true;
        }
        let [first, second] = pair;
        let numbers = || Some([first.number()?, second.number()?]);
        let ranges = || Some([first.numbers()?, second.numbers()?]);
        let read = numbers().map(JsonValue::Numbers).or_else(|| ranges().map(JsonValue::Ranges));
        Ok(read.filter(|_| !is_longer).unwrap_or_default())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<JsonValue, A::Error> {
        while map.next_entry::<IgnoredAny, IgnoredAny>()?.is_some() {}
        Ok(JsonValue::Nothing)
    }
}
