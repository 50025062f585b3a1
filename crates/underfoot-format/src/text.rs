//! Values as they are written to files.

/// A named field of a record.
pub type Entry = (&'static str, Text);

/// A value in its written form.
#[derive(Clone, Debug, PartialEq)]
pub enum Text {
    /// A number, a name or a text in quotes.
    Plain(String),
    /// Values in square brackets.
    List(Vec<Text>),
    /// Named fields in round brackets behind a name, which may be empty.
    Fields(&'static str, Vec<Entry>),
}

/// Maximum length of a line that holds a whole record, in characters.
const WIDTH: usize = 96;

impl Text {
    /// Formats the value on one line.
    pub fn inline(&self) -> String {
        match self {
            Self::Plain(text) => text.clone(),
            Self::List(values) => {
                format!("[{}]", values.iter().map(Self::inline).collect::<Vec<_>>().join(", "))
            }
            Self::Fields(name, entries) => {
                let entries = entries.iter().map(|(field, value)| format!("{field}: {}", value.inline()));
                format!("{name}({})", entries.collect::<Vec<_>>().join(", "))
            }
        }
    }

    /// Formats the value behind `column` characters of a line at indentation level `indent`, on as many lines as
    /// needed.
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
        match self {
            Self::Plain(_) => whole,
            Self::List(values) => {
                let values = values.iter().map(|value| value.lay_out(indent + 1, pad.len()));
                format!("[\n{}{end}]", lines(values.collect()))
            }
            Self::Fields(name, entries) => {
                let entries = entries.iter().map(|(field, value)| {
                    format!("{field}: {}", value.lay_out(indent + 1, pad.len() + field.len() + 2))
                });
                format!("{name}(\n{}{end})", lines(entries.collect()))
            }
        }
    }
}

/// Returns the shortest text that reads back as `value` after division by `scale`, without a decimal point where none
/// is needed.
pub fn number(value: f32, scale: f64) -> String {
    if !value.is_finite() {
        return "0".to_owned();
    }
    if scale == 1.0 {
        let is_small = value != 0.0 && value.abs() < 1e-4;
        return if is_small { format!("{value:e}") } else { format!("{value}") };
    }
    // Most values are whole hundredths; the others need all digits, found by trial.
    let written = f64::from(value) * scale;
    (2..=9)
        .map(|digits| format!("{written:.digits$}"))
        .map(|text| text.trim_end_matches('0').trim_end_matches('.').to_owned())
        .find(|text| text.parse::<f32>().is_ok_and(|read| read / scale as f32 == value))
        .unwrap_or_else(|| format!("{}", written as f32))
}
