//! Why a layout was not changed.

use thiserror::Error;

use super::address::Address;
use crate::schema::Diagnostics;

/// Why a layout was not changed; it is as it was.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Refusal {
    /// The layout could not be used any more.
    #[error("{0}")]
    Unreadable(Diagnostics),
    /// There is no such record.
    #[error("there is no {0} in this layout")]
    Missing(Address),
    /// What was to be put in is not a record.
    #[error("this is not a record such as (id: \"home\", kind: \"button\", at: (1, 1), size: (1, 1))")]
    NotARecord,
    /// What was to be put in is longer than a layout may be.
    #[error("this is longer than a layout may be")]
    TooLong,
    /// What is to be one group stands in several lists, such as those of two pages.
    #[error("only what stands in one list can be one group, and regions, places to stand and grounds can't")]
    Apart,
    /// Where it is follows from a neighbour in a group that has no place of its own.
    #[error("{0} stands where its group stands; give the group a place of its own first")]
    PlacedByGroup(Address),
}

impl Refusal {
    /// The first thing that is wrong, in one line: what, and what to do.
    #[must_use]
    pub fn short(&self) -> String {
        match self {
            Self::Unreadable(problems) => {
                let errors = problems.iter().filter(|one| one.severity == crate::schema::Severity::Error);
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
