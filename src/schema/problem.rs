use std::ops::Range;

use super::diagnostic::Severity;

/// Something wrong with a text, before it is known which file the text is.
#[derive(Clone, Debug)]
pub(super) struct Problem {
    pub(super) severity: Severity,
    /// Bytes of the text to mark.
    pub(super) span: Range<usize>,
    pub(super) message: String,
    pub(super) expected: String,
    pub(super) help: Option<String>,
    /// The field that is missing from what stands at `span`.
    pub(super) missing: Option<&'static str>,
}

impl Problem {
    /// Something because of which the file cannot be used.
    pub(super) fn error(span: Range<usize>, message: impl Into<String>) -> Self {
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
    pub(super) fn warning(span: Range<usize>, message: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(span, message) }
    }

    /// The same, with `expected` written beside the carets.
    pub(super) fn expected(self, expected: impl Into<String>) -> Self {
        Self { expected: expected.into(), ..self }
    }

    /// The same, saying what to do about it.
    pub(super) fn help(self, help: impl Into<String>) -> Self {
        Self { help: Some(help.into()), ..self }
    }

    /// The same, with what to do about it if that is known.
    pub(super) fn help_if(self, help: Option<String>) -> Self {
        Self { help, ..self }
    }
}
