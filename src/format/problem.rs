//! A problem of a text, independent of its file.

use std::ops::Range;

use super::diagnostic::Severity;

/// A problem of a text, independent of the file that holds the text.
#[derive(Clone, Debug)]
pub(crate) struct Problem {
    pub(crate) severity: Severity,
    /// Bytes of the text to mark.
    pub(crate) span: Range<usize>,
    pub(crate) message: String,
    pub(crate) expected: String,
    pub(crate) help: Option<String>,
    /// The field that is missing at `span`.
    pub(crate) missing: Option<&'static str>,
}

impl Problem {
    /// A problem that makes the file unusable.
    pub(crate) fn error(span: Range<usize>, message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Error,
            span,
            message: message.into(),
            expected: String::new(),
            help: None,
            missing: None,
        }
    }

    /// A problem that is probably a mistake.
    pub(crate) fn warning(span: Range<usize>, message: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(span, message) }
    }

    /// Sets the text beside the carets.
    pub(crate) fn expected(self, expected: impl Into<String>) -> Self {
        Self { expected: expected.into(), ..self }
    }

    /// Sets the advice.
    pub(crate) fn help(self, help: impl Into<String>) -> Self {
        Self { help: Some(help.into()), ..self }
    }

    /// Sets the advice, if there is any.
    pub(crate) fn help_if(self, help: Option<String>) -> Self {
        Self { help, ..self }
    }
}
