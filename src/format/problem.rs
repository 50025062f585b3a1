//! A problem of a text, before its file is known.

use std::ops::Range;

use super::diagnostic::Severity;

/// Something wrong with a text, before it is known which file the text is.
#[derive(Clone, Debug)]
pub(crate) struct Problem {
    pub(crate) severity: Severity,
    /// Bytes of the text to mark.
    pub(crate) span: Range<usize>,
    pub(crate) message: String,
    pub(crate) expected: String,
    pub(crate) help: Option<String>,
    /// The field that is missing from what stands at `span`.
    pub(crate) missing: Option<&'static str>,
}

impl Problem {
    /// Something because of which the file cannot be used.
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

    /// Something that is probably not meant so.
    pub(crate) fn warning(span: Range<usize>, message: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(span, message) }
    }

    /// The same, with `expected` written beside the carets.
    pub(crate) fn expected(self, expected: impl Into<String>) -> Self {
        Self { expected: expected.into(), ..self }
    }

    /// The same, saying what to do about it.
    pub(crate) fn help(self, help: impl Into<String>) -> Self {
        Self { help: Some(help.into()), ..self }
    }

    /// The same, with what to do about it if that is known.
    pub(crate) fn help_if(self, help: Option<String>) -> Self {
        Self { help, ..self }
    }
}
