//! Values as they are written to files: trees that serde passes on and the `ron` crate writes.

use ron::ser::{PrettyConfig, to_string_pretty};
use serde::ser::{
    SerializeSeq, SerializeStruct, SerializeStructVariant, SerializeTuple, SerializeTupleVariant,
};
use serde::{Serialize, Serializer};

/// A named field of a record.
pub type Entry = (&'static str, RonText);

/// A value in its written form.
#[derive(Clone, Debug, PartialEq)]
pub enum RonText {
    /// `None`.
    Nothing,
    /// `true` or `false`.
    Flag(bool),
    /// A number without a decimal point.
    Whole(i64),
    /// A number of single precision; always with a decimal point or an exponent.
    Single(f32),
    /// A number of double precision; always with a decimal point or an exponent.
    Double(f64),
    /// One of a few names.
    Name(&'static str),
    /// RonText in quotes.
    Quoted(String),
    /// Values in round brackets.
    Tuple(Vec<RonText>),
    /// Values in square brackets.
    List(Vec<RonText>),
    /// Named fields in round brackets. RON leaves the record's name out unless a caller of `ron` asks for it.
    Record(&'static str, Vec<Entry>),
    /// Named fields in round brackets behind a name, which tells them from other variants.
    Variant(&'static str, Vec<Entry>),
    /// Values in round brackets behind a name.
    Call(&'static str, Vec<RonText>),
}

/// Maximum length of a line that holds a whole record, in characters.
const WIDTH: usize = 96;

/// Whole numbers from here on are written with an exponent.
const LARGE: f64 = 1e16;

/// Name of the enum that serde gets for names and variants; RON never writes it.
const ENUM: &str = "Choice";

impl RonText {
    /// `value`, without a decimal point where none is needed.
    pub fn single(value: f32) -> Self {
        let whole = value.fract() == 0.0 && f64::from(value).abs() < LARGE;
        if whole { Self::Whole(value as i64) } else { Self::Single(value) }
    }

    /// `value`, without a decimal point where none is needed.
    pub fn double(value: f64) -> Self {
        let whole = value.fract() == 0.0 && value.abs() < LARGE;
        if whole { Self::Whole(value as i64) } else { Self::Double(value) }
    }

    /// `value` with four decimals, or all of them where it would become 0.
    pub fn rounded(value: f64) -> Self {
        let rounded = (value * 1e4).round() / 1e4;
        Self::double(if rounded == 0.0 { value } else { rounded })
    }

    /// `text` in quotes.
    pub fn quoted(text: impl Into<String>) -> Self {
        Self::Quoted(text.into())
    }

    /// Two numbers in round brackets.
    pub fn pair([first, second]: [f64; 2]) -> Self {
        Self::Tuple(vec![Self::double(first), Self::double(second)])
    }

    /// Formats the value on one line.
    pub fn inline(&self) -> String {
        let config = PrettyConfig::new()
            .compact_arrays(true)
            .compact_structs(true)
            .escape_strings(self.needs_escapes());
        // Names of fields, records and variants are words of Rust, and a tree of values nests as files may.
        to_string_pretty(self, config).unwrap_or_default()
    }

    /// Whether a text in quotes holds a character that must be escaped.
    fn needs_escapes(&self) -> bool {
        // `ron` would also escape apostrophes and the joiners of emoji, which people can read as they are.
        match self {
            Self::Quoted(text) => text.contains(|c: char| c.is_control() || matches!(c, '"' | '\\')),
            Self::Tuple(values) | Self::List(values) | Self::Call(_, values) => {
                values.iter().any(Self::needs_escapes)
            }
            Self::Record(_, entries) | Self::Variant(_, entries) => {
                entries.iter().any(|(_, value)| value.needs_escapes())
            }
            _ => false,
        }
    }

    /// Formats the value behind `column` characters of a line at indentation level `indent`, on as many lines as
    /// needed.
    ///
    /// Lists and records that fit into a line stay on it, which no setting of `ron` does: this breaks the lines, and
    /// `ron` writes what stands on each.
    pub fn lay_out(&self, indent: usize, column: usize) -> String {
        let whole = self.inline();
        if column + whole.chars().count() <= WIDTH {
            return whole;
        }
        let pad = "    ".repeat(indent + 1);
        let lines = |lines: Vec<String>| -> String {
            lines.into_iter().map(|line| format!("{pad}{line},\n")).collect()
        };
        let end = "    ".repeat(indent);
        let fields = |name: &str, entries: &[Entry]| {
            let entries = entries.iter().map(|(field, value)| {
                format!("{field}: {}", value.lay_out(indent + 1, pad.len() + field.len() + 2))
            });
            format!("{name}(\n{}{end})", lines(entries.collect()))
        };
        match self {
            Self::List(values) => {
                let values = values.iter().map(|value| value.lay_out(indent + 1, pad.len()));
                format!("[\n{}{end}]", lines(values.collect()))
            }
            Self::Record(_, entries) => fields("", entries),
            Self::Variant(name, entries) => fields(name, entries),
            _ => whole,
        }
    }
}

/// Passes on the value as files hold it: names, units and texts as in the file format.
impl Serialize for RonText {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Nothing => serializer.serialize_none(),
            Self::Flag(flag) => serializer.serialize_bool(*flag),
            Self::Whole(number) => serializer.serialize_i64(*number),
            Self::Single(number) => serializer.serialize_f32(*number),
            Self::Double(number) => serializer.serialize_f64(*number),
            Self::Name(name) => serializer.serialize_unit_variant(ENUM, 0, name),
            Self::Quoted(text) => serializer.serialize_str(text),
            Self::Tuple(values) => {
                let mut tuple = serializer.serialize_tuple(values.len())?;
                values.iter().try_for_each(|value| tuple.serialize_element(value))?;
                tuple.end()
            }
            Self::List(values) => {
                let mut list = serializer.serialize_seq(Some(values.len()))?;
                values.iter().try_for_each(|value| list.serialize_element(value))?;
                list.end()
            }
            Self::Call(name, values) => {
                let mut call = serializer.serialize_tuple_variant(ENUM, 0, name, values.len())?;
                values.iter().try_for_each(|value| call.serialize_field(value))?;
                call.end()
            }
            Self::Record(name, entries) => {
                let mut record = serializer.serialize_struct(name, entries.len())?;
                entries.iter().try_for_each(|(name, value)| record.serialize_field(name, value))?;
                record.end()
            }
            Self::Variant(name, entries) => {
                let mut record = serializer.serialize_struct_variant(ENUM, 0, name, entries.len())?;
                entries.iter().try_for_each(|(name, value)| record.serialize_field(name, value))?;
                record.end()
            }
        }
    }
}

/// Returns the shortest number that reads back as `value` after division by `scale`, without a decimal point where
/// none is needed.
pub fn number(value: f32, scale: f64) -> RonText {
    if !value.is_finite() {
        return RonText::Whole(0);
    }
    if scale == 1.0 {
        return RonText::single(value);
    }
    // Most values are whole hundredths; the others need all digits, found by trial.
    let written = f64::from(value) * scale;
    let reads_back = |text: &String| text.parse::<f32>().is_ok_and(|read| read / scale as f32 == value);
    let shortest = (2..=9).map(|digits| format!("{written:.digits$}")).find(reads_back);
    shortest
        .and_then(|text| text.parse().ok())
        .map_or_else(|| RonText::single(written as f32), RonText::double)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_as_short_as_they_can_be() {
        let written = |value, scale| number(value, scale).inline();
        assert_eq!(written(60.0, 1.0), "60");
        assert_eq!(written(-0.1, 1.0), "-0.1");
        assert_eq!(written(0.000_02, 1.0), "2e-5");
        assert_eq!(written(0.016, 1000.0), "16");
        assert_eq!(written(0.001_5, 1000.0), "1.5");
        assert_eq!(written(f32::NAN, 1.0), "0");
    }

    #[test]
    fn values_stand_on_one_line_or_on_many() {
        let modes = RonText::List(vec![RonText::Record("Mode", vec![("hz", RonText::Whole(180))])]);
        let click = |title: &str| {
            let entries = vec![
                ("modes", modes.clone()),
                ("title", RonText::quoted(title)),
                ("at", RonText::pair([0.5, 1.0])),
            ];
            RonText::Variant("Click", entries)
        };
        let text = click("it's");
        assert_eq!(text.inline(), r#"Click(modes: [(hz: 180)], title: "it's", at: (0.5, 1))"#);
        assert_eq!(text.lay_out(0, 0), text.inline());
        let long = "x".repeat(90);
        let laid_out =
            format!("Click(\n    modes: [(hz: 180)],\n    title: \"{long}\",\n    at: (0.5, 1),\n)");
        assert_eq!(click(&long).lay_out(0, 0), laid_out);
        assert_eq!(RonText::List(Vec::new()).inline(), "[]");
        assert_eq!(RonText::Record("Mode", Vec::new()).inline(), "()");
    }

    #[test]
    fn texts_are_escaped_where_they_must_be() {
        for (text, written) in [
            ("it's 👩\u{200d}👩 Größe", "\"it's 👩\u{200d}👩 Größe\""),
            ("a \"b\" \\ c", r#""a \"b\" \\ c""#),
            ("\n\t\u{7}", r#""\n\t\u{7}""#),
        ] {
            assert_eq!(RonText::quoted(text).inline(), written);
        }
    }
}
