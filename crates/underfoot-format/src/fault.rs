//! Conflicts between the fields of a record.

use super::diagnostic::Severity;
use super::number::plain;

/// A conflict between fields of a record.
pub struct Fault {
    /// Its severity.
    pub severity: Severity,
    /// The fields concerned, the cause first. The message points at the first of them that is written.
    pub fields: &'static [&'static str],
    /// The conflict, in one clause.
    pub message: String,
    /// The expected text, shown beside the carets.
    pub expected: String,
    /// Advice on how to solve it.
    pub help: Option<String>,
}

/// The conflicts found in a record.
#[derive(Default)]
pub struct Faults(pub Vec<Fault>);

impl Faults {
    /// Adds a conflict that makes the record unusable; `expected` stands beside the carets.
    pub fn error(
        &mut self,
        fields: &'static [&'static str],
        message: impl Into<String>,
        expected: impl Into<String>,
    ) {
        let (message, expected) = (message.into(), expected.into());
        self.0.push(Fault { severity: Severity::Error, fields, message, expected, help: None });
    }

    /// Adds a conflict that is probably a mistake.
    pub fn warning(
        &mut self,
        fields: &'static [&'static str],
        message: impl Into<String>,
        expected: impl Into<String>,
    ) {
        self.error(fields, message, expected);
        if let Some(last) = self.0.last_mut() {
            last.severity = Severity::Warning;
        }
    }

    /// Adds advice to the conflict noted last.
    pub fn help(&mut self, help: impl Into<String>) {
        if let Some(last) = self.0.last_mut() {
            last.help = Some(help.into());
        }
    }

    /// Two `fields` must be written together; `is` says which of them are written.
    pub fn together(&mut self, fields: &'static [&'static str; 2], is: [bool; 2]) {
        let (here, lacking) = match is {
            [true, false] => (fields[0], fields[1]),
            [false, true] => (fields[1], fields[0]),
            _ => return,
        };
        self.error(
            fields,
            format!("`{here}` needs `{lacking}` beside it"),
            format!("`{lacking}` is missing"),
        );
    }

    /// The first of two `fields` must not be less than the second.
    pub fn not_below(&mut self, fields: &'static [&'static str; 2], [high, low]: [f32; 2]) {
        let [high_name, low_name] = fields;
        if high < low {
            let found = format!("{low_name} is {}, {high_name} is {}", plain(low.into()), plain(high.into()));
            self.error(fields, format!("`{high_name}` must not be below `{low_name}`"), found);
        }
    }

    /// The first of two `fields` must not be more than the second.
    pub fn not_above(&mut self, fields: &'static [&'static str; 2], [low, high]: [f32; 2]) {
        let [low_name, high_name] = fields;
        if low > high {
            let found = format!("{high_name} is {}, {low_name} is {}", plain(high.into()), plain(low.into()));
            self.error(fields, format!("`{low_name}` must not be above `{high_name}`"), found);
        }
    }
}
