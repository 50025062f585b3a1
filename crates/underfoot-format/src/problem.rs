//! A problem of a text, independent of its file.

use std::ops::Range;

use super::diagnostic::Severity;

/// A problem of a text, independent of the file that holds the text.
#[derive(Clone, Debug)]
pub struct Problem {
    /// Its severity.
    pub severity: Severity,
    /// Bytes of the text to mark.
    pub span: Range<usize>,
    /// The problem, in one clause.
    pub message: String,
    /// The expected text, shown beside the carets.
    pub expected: String,
    /// Advice on how to solve the problem.
    pub help: Option<String>,
    /// The field that is missing at `span`.
    pub missing: Option<&'static str>,
}

impl Problem {
    /// A problem that makes the file unusable.
    pub fn error(span: Range<usize>, message: impl Into<String>) -> Self {
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
    pub fn warning(span: Range<usize>, message: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(span, message) }
    }

    /// Sets the text beside the carets.
    pub fn expected(self, expected: impl Into<String>) -> Self {
        Self { expected: expected.into(), ..self }
    }

    /// Sets the advice.
    pub fn help(self, help: impl Into<String>) -> Self {
        Self { help: Some(help.into()), ..self }
    }

    /// Sets the advice, if there is any.
    pub fn help_if(self, help: Option<String>) -> Self {
        Self { help, ..self }
    }
}
