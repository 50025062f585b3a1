//! What is wrong between the fields of a record.

use super::diagnostic::Severity;
use super::number::plain;

/// Something wrong between the fields of a record.
pub(crate) struct Fault {
    pub(crate) severity: Severity,
    /// The fields that it concerns, the causes first; the first that is written is where it is shown.
    pub(crate) fields: &'static [&'static str],
    pub(crate) message: String,
    pub(crate) expected: String,
    pub(crate) help: Option<String>,
}

/// What is wrong between the fields of a record.
#[derive(Default)]
pub(crate) struct Faults(pub(crate) Vec<Fault>);

impl Faults {
    /// Something because of which the record cannot be used; `expected` stands beside the carets.
    pub(crate) fn error(
        &mut self,
        fields: &'static [&'static str],
        message: impl Into<String>,
        expected: impl Into<String>,
    ) {
        let (message, expected) = (message.into(), expected.into());
        self.0.push(Fault { severity: Severity::Error, fields, message, expected, help: None });
    }

    /// Something that is probably not meant so.
    pub(crate) fn warning(
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

    /// What to do about the one noted last.
    pub(crate) fn help(&mut self, help: impl Into<String>) {
        if let Some(last) = self.0.last_mut() {
            last.help = Some(help.into());
        }
    }

    /// Either of two `fields` must be written with the other one; `is` tells which are.
    pub(crate) fn together(&mut self, fields: &'static [&'static str; 2], is: [bool; 2]) {
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
    pub(crate) fn not_below(&mut self, fields: &'static [&'static str; 2], [high, low]: [f32; 2]) {
        let [high_name, low_name] = fields;
        if high < low {
            let found = format!("{low_name} is {}, {high_name} is {}", plain(low.into()), plain(high.into()));
            self.error(fields, format!("`{high_name}` must not be below `{low_name}`"), found);
        }
    }

    /// The first of two `fields` must not be more than the second.
    pub(crate) fn not_above(&mut self, fields: &'static [&'static str; 2], [low, high]: [f32; 2]) {
        let [low_name, high_name] = fields;
        if low > high {
            let found = format!("{high_name} is {}, {low_name} is {}", plain(high.into()), plain(low.into()));
            self.error(fields, format!("`{low_name}` must not be above `{high_name}`"), found);
        }
    }
}
