//! Whether feet can use a layout: rules with numbers and sources, tried on a checked layout.

mod rules;

pub use rules::{RULES, Rule, rule};

use crate::schema::Severity;

/// What of a control a finding is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The control as a whole.
    Id,
    /// Where it is.
    Place,
    /// How large it is.
    Size,
    /// The force that presses it.
    Press,
    /// The step between its values.
    Step,
    /// What is written on it.
    Label,
    /// Its colours.
    Look,
}

/// One thing about one control that feet or eyes will have trouble with.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// The rule.
    pub rule: &'static Rule,
    /// How bad it is.
    pub severity: Severity,
    /// Index in [`crate::layout::Layout::widgets`].
    pub widget: usize,
    /// What of the control it is about.
    pub part: Part,
    /// What is wrong, in one clause.
    pub message: String,
    /// The measure found and the one wanted; beside the carets.
    pub expected: String,
    /// What to do about it.
    pub help: Option<String>,
}
