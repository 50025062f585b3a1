//! The limits of an argument, for people and for programs.

use crate::widget::{Indicator, Scale};
use crate::wire::sent::FieldRange;

/// The values that an argument may have, for programs.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum ArgumentLimits {
    /// Any value of its type.
    #[default]
    Open,
    /// Numbers from the least to the greatest.
    Numbers {
        /// The least number.
        least: f64,
        /// The greatest number.
        greatest: f64,
    },
    /// One of these words.
    Words(Vec<String>),
}

/// The limits of an argument: a sentence, its unit, and its values.
#[derive(Clone, Debug, Default)]
pub(super) struct DescribedLimits {
    /// May be empty.
    pub(super) text: String,
    /// Empty without one.
    pub(super) unit: &'static str,
    pub(super) limits: ArgumentLimits,
}

impl DescribedLimits {
    /// Only a sentence.
    pub(super) fn text(text: impl Into<String>) -> Self {
        Self { text: text.into(), ..Self::default() }
    }

    /// Numbers from the least to the greatest; the sentence says so.
    pub(super) fn numbers(least: f64, greatest: f64) -> Self {
        Self::text(format!("{least} to {greatest}")).within(least, greatest)
    }

    /// Adds the least and the greatest number.
    pub(super) fn within(self, least: f64, greatest: f64) -> Self {
        Self { limits: ArgumentLimits::Numbers { least, greatest }, ..self }
    }

    /// 0 or 1.
    pub(super) fn flag() -> Self {
        Self::text("0 or 1").within(0.0, 1.0)
    }

    /// One of these words.
    pub(super) fn words<'a>(words: impl IntoIterator<Item = &'a str>) -> Self {
        let words: Vec<String> = words.into_iter().map(Into::into).collect();
        Self { text: words.join(", "), unit: "", limits: ArgumentLimits::Words(words) }
    }

    /// The states of a lamp.
    pub(super) fn indicators() -> Self {
        Self::words(Indicator::ALL.map(Indicator::name))
    }

    /// The numbers of a control with this scale.
    pub(super) fn scale(scale: &Scale) -> Self {
        let steps = if scale.step > 0.0 { format!(", steps of {}", scale.step) } else { String::new() };
        let text = format!("{} to {}{steps}", scale.min, scale.max);
        Self::text(text).within(scale.min.into(), scale.max.into())
    }

    /// Those that the table of messages has, if they do not depend on the layout.
    pub(super) fn of_table(range: FieldRange) -> Option<Self> {
        Some(match range {
            FieldRange::Text(text) => Self::text(text),
            FieldRange::Measure(unit, "") => Self { unit, ..Self::text(unit) },
            FieldRange::Measure(unit, more) => Self { unit, ..Self::text(format!("{unit}, {more}")) },
            FieldRange::Flag => Self::flag(),
            FieldRange::Words(words) => {
                let text = match words {
                    [all @ .., last] if !all.is_empty() => format!("{} or {last}", all.join(", ")),
                    _ => words.concat(),
                };
                Self { text, ..Self::words(words.iter().copied()) }
            }
            FieldRange::Indicators => Self::indicators(),
            FieldRange::OfValue | FieldRange::OffReasons | FieldRange::IgnoredReasons | FieldRange::Pages => {
                return None;
            }
        })
    }
}
