//! Problems of a file with their places, as people and programs read them.

use std::error::Error;
use std::fmt;
use std::ops::Range;

use serde::Serialize;

use super::excerpt::Excerpt;

/// Severity of a problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The file cannot be used.
    Error,
    /// The file can be used, but probably not as meant.
    Warning,
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Error => "error",
            Self::Warning => "warning",
        })
    }
}

/// One problem of one file, at its place.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Diagnostic {
    /// How bad it is.
    pub severity: Severity,
    /// The ergonomic rule that the file breaks, such as `U101`; `None` for an error of the format itself.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub code: Option<&'static str>,
    /// The file, as it was named when it was read.
    pub path: String,
    /// Line, from 1; 0 if the problem is the file as a whole.
    pub line: usize,
    /// Column in characters, from 1; 0 if the problem is the file as a whole.
    pub column: usize,
    /// Bytes of the file that the carets stand under; a byte-order mark counts.
    pub span: Range<usize>,
    /// The field, as a path from the file's root such as `widgets[2].press_n`; empty outside of any field.
    pub field: String,
    /// The problem, in one clause.
    pub message: String,
    /// The expected text, shown beside the carets; may be empty.
    pub expected: String,
    /// Advice on how to solve the problem.
    pub help: Option<String>,
    /// The line as shown: tabs become four spaces; a very long line is cut around the place.
    pub source_line: String,
    #[serde(skip)]
    pub(crate) excerpt: Excerpt,
}

impl Diagnostic {
    /// A problem of the file at `path` as a whole, for example a missing file.
    pub fn of_file(path: &str, message: String, help: Option<String>) -> Self {
        Self {
            severity: Severity::Error,
            code: None,
            path: path.into(),
            line: 0,
            column: 0,
            span: 0..0,
            field: String::new(),
            message,
            expected: String::new(),
            help,
            source_line: String::new(),
            excerpt: Excerpt::default(),
        }
    }

    /// Sets the code of the rule that the file breaks.
    #[must_use]
    pub fn with_code(self, code: &'static str) -> Self {
        Self { code: Some(code), ..self }
    }
}

impl fmt::Display for Diagnostic {
    /// Several lines: message, place, the line with carets, and advice; `{:#}` adds colours for terminals.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let paint = |colour: &'static str| if f.alternate() { (colour, "\x1b[0m") } else { ("", "") };
        let (bold, end) = paint("\x1b[1m");
        let (frame, _) = paint("\x1b[1;34m");
        let (loud, _) = paint(match self.severity {
            Severity::Error => "\x1b[1;31m",
            Severity::Warning => "\x1b[1;33m",
        });
        let margin = self.line.max(1).ilog10() as usize + 1;
        let code = self.code.map(|code| format!("[{code}]")).unwrap_or_default();
        writeln!(f, "{loud}{}{code}{end}{bold}: {}{end}", self.severity, self.message)?;
        if self.line == 0 {
            writeln!(f, "{:margin$}{frame}-->{end} {}", "", self.path)?;
        } else {
            let (indent, carets) = self.excerpt.carets();
            let beside = if self.expected.is_empty() { String::new() } else { format!(" {}", self.expected) };
            writeln!(f, "{:margin$}{frame}-->{end} {}:{}:{}", "", self.path, self.line, self.column)?;
            writeln!(f, "{:margin$} {frame}|{end}", "")?;
            writeln!(f, "{frame}{} |{end} {}", self.line, self.excerpt.text)?;
            writeln!(f, "{:margin$} {frame}|{end} {indent}{loud}{carets}{beside}{end}", "")?;
        }
        if let Some(help) = &self.help {
            writeln!(f, "{:margin$} {frame}={end} {bold}help{end}: {help}", "")?;
        }
        Ok(())
    }
}

/// The problems of one reading, in the order of the text; `Display` prints them for people.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub struct Diagnostics {
    list: Vec<Diagnostic>,
    /// Errors and warnings beyond [`Diagnostics::LIMIT`] of one file, counted and not kept.
    #[serde(skip)]
    omitted: [usize; 2],
}

impl Diagnostics {
    /// Maximum number of problems kept for one file; the closing line counts the others.
    pub const LIMIT: usize = 500;

    /// Sorts `list` in the order of the text; `without` holds the severities of the problems that were left out.
    pub fn new(mut list: Vec<Diagnostic>, without: impl Iterator<Item = Severity>) -> Self {
        list.sort_by_key(|problem| (problem.line, problem.column, problem.severity));
        let mut omitted = [0; 2];
        without.for_each(|severity| omitted[severity as usize] += 1);
        Self { list, omitted }
    }

    /// Whether there are no problems.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Number of problems kept.
    #[must_use]
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Number of errors, those beyond [`Diagnostics::LIMIT`] included.
    #[must_use]
    pub fn errors(&self) -> usize {
        self.count(Severity::Error)
    }

    /// Number of warnings, those beyond [`Diagnostics::LIMIT`] included.
    #[must_use]
    pub fn warnings(&self) -> usize {
        self.count(Severity::Warning)
    }

    /// The problems, file by file in the order of the text.
    pub fn iter(&self) -> std::slice::Iter<'_, Diagnostic> {
        self.list.iter()
    }

    /// Appends the problems of another reading.
    pub fn append(&mut self, other: Self) {
        self.list.extend(other.list);
        self.omitted.iter_mut().zip(other.omitted).for_each(|(sum, more)| *sum += more);
    }

    /// Merges the problems of another reading of the same file in the order of its text.
    pub fn merge(&mut self, other: Self) {
        self.append(other);
        self.list.sort_by_key(|problem| (problem.line, problem.column, problem.severity));
    }

    fn count(&self, severity: Severity) -> usize {
        let kept = self.list.iter().filter(|problem| problem.severity == severity).count();
        kept + self.omitted[severity as usize]
    }
}

impl From<Diagnostic> for Diagnostics {
    fn from(problem: Diagnostic) -> Self {
        Self { list: vec![problem], omitted: [0; 2] }
    }
}

impl IntoIterator for Diagnostics {
    type Item = Diagnostic;
    type IntoIter = std::vec::IntoIter<Diagnostic>;

    fn into_iter(self) -> Self::IntoIter {
        self.list.into_iter()
    }
}

impl<'a> IntoIterator for &'a Diagnostics {
    type Item = &'a Diagnostic;
    type IntoIter = std::slice::Iter<'a, Diagnostic>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl fmt::Display for Diagnostics {
    /// Prints every problem with its line and carets, then one line that counts them; prints nothing if there are
    /// none.
    ///
    /// `{:#}` adds colours for terminals.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for problem in &self.list {
            fmt::Display::fmt(problem, f)?;
            writeln!(f)?;
        }
        let omitted: usize = self.omitted.iter().sum();
        if omitted > 0 {
            writeln!(f, "... and {}", counted(omitted, "more problem"))?;
        }
        let mut paths: Vec<&str> = self.list.iter().map(|problem| problem.path.as_str()).collect();
        paths.dedup();
        let place = match paths[..] {
            [] => return Ok(()),
            [path] => path.to_owned(),
            _ => counted(paths.len(), "file"),
        };
        match (self.errors(), self.warnings()) {
            (errors, 0) => write!(f, "{place}: {}", counted(errors, "error")),
            (0, warnings) => write!(f, "{place}: {}", counted(warnings, "warning")),
            (errors, warnings) => {
                write!(f, "{place}: {}, {}", counted(errors, "error"), counted(warnings, "warning"))
            }
        }
    }
}

impl Error for Diagnostics {}

fn counted(count: usize, noun: &str) -> String {
    if count == 1 { format!("1 {noun}") } else { format!("{count} {noun}s") }
}

#[cfg(test)]
mod tests {
    use super::super::source::Source;
    use super::*;

    #[test]
    fn a_terminal_gets_the_same_words_in_colour() {
        let source = Source::new("map.ron", "(id: 5)").unwrap();
        let problem = source.diagnostic(Severity::Error, &(5..6), "`id` must be text".into());
        let problems = Diagnostics::from(Diagnostic { expected: "expected text".into(), ..problem });
        let plain = problems.to_string();
        assert_eq!(
            plain,
            "error: `id` must be text\n --> map.ron:1:6\n  |\n1 | (id: 5)\n  |      ^ expected text\n\nmap.ron: 1 error"
        );
        let coloured = format!("{problems:#}");
        assert!(coloured.contains("\x1b[1;31m^ expected text\x1b[0m"));
        let stripped = coloured.split('\x1b').map(|part| part.split_once('m').map_or(part, |(_, rest)| rest));
        // The text before the first escape is empty here.
        assert_eq!(stripped.collect::<String>(), plain);
    }

    #[test]
    fn several_files_are_counted_together() {
        let of = |path| Diagnostics::from(Diagnostic::of_file(path, "there is no such file".into(), None));
        let mut problems = of("a.ron");
        assert_eq!(problems.to_string(), "error: there is no such file\n --> a.ron\n\na.ron: 1 error");
        problems.append(of("b.ron"));
        assert!(problems.to_string().ends_with("2 files: 2 errors"));
        assert_eq!(Diagnostics::default().to_string(), "");
    }
}
