//! Reasons why an edit is refused.

use thiserror::Error;

use super::address::Address;
use underfoot::schema::Diagnostics;

/// The reason why an edit is refused; the layout is unchanged then.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum EditRefusal {
    /// The resulting layout would be invalid.
    #[error("{0}")]
    Unreadable(Diagnostics),
    /// There is no such record.
    #[error("there is no {0} in this layout")]
    Missing(Address),
    /// The text to insert is not a record.
    #[error("this is not a record such as (id: \"home\", kind: \"button\", at: (1, 1), size: (1, 1))")]
    NotARecord,
    /// The text to paste is no control whose appearance or feel could be taken, or no control is selected.
    #[error("copy a control first, and select the controls that get its appearance or feel")]
    NotAControl,
    /// A group or a grid has the size that its controls give it.
    #[error("{0} has no size of its own to change here")]
    NoSize(Address),
    /// The text to insert exceeds the maximum length of a layout.
    #[error("this is longer than a layout may be")]
    TooLong,
    /// The records for a group stand in several lists, such as those of two pages.
    #[error("only what stands in one list can be one group, and regions, places to stand and grounds can't")]
    Apart,
    /// Its place follows from a neighbour, in a group without a place of its own.
    #[error("{0} stands where its group stands; give the group a place of its own first")]
    PlacedByGroup(Address),
}

impl EditRefusal {
    /// The first error in one line: the problem and its remedy.
    #[must_use]
    pub fn short(&self) -> String {
        match self {
            Self::Unreadable(problems) => {
                let errors = problems.iter().filter(|one| one.severity == underfoot::schema::Severity::Error);
                errors.into_iter().next().map_or_else(
                    || self.to_string(),
                    |one| match &one.help {
                        Some(help) => format!("{}: {help}", one.message),
                        None if one.expected.is_empty() => one.message.clone(),
                        None => format!("{}: {}", one.message, one.expected),
                    },
                )
            }
            other => other.to_string(),
        }
    }
}
