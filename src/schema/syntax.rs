//! Text to syntax tree, with the parser's complaints in the words of layout authors.

use std::ops::Range;

use ron2::ast::{AttributeContent, Document, Expr, parse_document_lossy};
use ron2::error::ErrorKind;

use super::problem::Problem;
use super::scan::{Limits, scan};
use super::suggest::did_you_mean;

/// What could be made of a text.
pub(super) struct Syntax<'t> {
    /// The value the file holds; where the text is broken, only what stands before `sound` counts.
    pub(super) root: Option<Expr<'t>>,
    /// What is wrong with the text as such.
    pub(super) problems: Vec<Problem>,
    /// Up to here the tree is what was meant.
    pub(super) sound: usize,
}

/// Parses `text`, which is expected to hold one `kind` of thing, such as a `Layout`.
pub(super) fn parse<'t>(text: &'t str, kind: &str, limits: Limits) -> Syntax<'t> {
    let problems = scan(text, limits);
    if !problems.is_empty() {
        return Syntax { root: None, problems, sound: 0 };
    }
    let (document, errors) = parse_document_lossy(text);
    let mut problems = rephrased(text, &errors);
    if problems.is_empty() && document.value.is_none() {
        let message = format!("there is no {kind} in this file");
        problems.push(Problem::error(0..0, message).expected(format!("expected {kind}(...)")));
    }
    let sound = problems.iter().map(|problem| problem.span.start).min().unwrap_or(text.len());
    problems.extend(unknown_attributes(&document));
    Syntax { root: document.value, problems, sound }
}

/// The parser's errors that are real: after losing its way among brackets it only sees consequences.
fn rephrased(text: &str, errors: &[ron2::Error]) -> Vec<Problem> {
    let mut problems: Vec<Problem> = Vec::new();
    let mut last_line = None;
    for error in errors {
        let span = error.span().start_offset..error.span().end_offset;
        let line = text.get(..span.start).map(|before| before.matches('\n').count());
        let lost = matches!(error.kind(), ErrorKind::TrailingCharacters) && !problems.is_empty();
        if line != last_line && !lost {
            problems.push(rephrase(text, span, error.kind()));
        }
        last_line = line;
        if problems.len() > 100 || is_bracket_trouble(error.kind()) {
            break;
        }
    }
    problems
}

fn is_bracket_trouble(kind: &ErrorKind) -> bool {
    matches!(kind, ErrorKind::Expected { expected, .. } if expected.starts_with("closing"))
}

fn rephrase(text: &str, span: Range<usize>, kind: &ErrorKind) -> Problem {
    let rest = text.get(span.start..).unwrap_or_default();
    match rest.chars().next() {
        Some('.') => {
            return Problem::error(
                span.start..span.start + 1,
                "a number needs digits on both sides of its point",
            )
            .expected("no digit on one side")
            .help("write 0.5 rather than .5, and 2.0 or 2 rather than 2.");
        }
        Some('=') => {
            return Problem::error(span.start..span.start + 1, "a field and its value are joined by a colon")
                .expected("expected `:`");
        }
        Some(';') => {
            return Problem::error(span.start..span.start + 1, "fields and entries are separated by commas")
                .expected("expected `,`");
        }
        _ => {}
    }
    let word: String = rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
    match kind {
        ErrorKind::Expected { expected, context } => match (&**expected, *context) {
            ("comma", _) => {
                Problem::error(first(rest, &span), "a comma is missing").expected("expected `,` before this")
            }
            ("`:` after map key", _) => Problem::error(span, format!("`{word}` has no value"))
                .expected(format!("expected `{word}: ...`")),
            ("value", _) => Problem::error(before(text, &span), "this field has no value")
                .expected("expected a value after the colon"),
            ("identifier", None) => Problem::error(first(rest, &span), "the name of a field is missing")
                .expected("expected `name: value`"),
            (closing, _) if closing.starts_with("closing") => {
                let bracket = if closing.contains(']') { ']' } else { ')' };
                Problem::error(first(rest, &span), "this doesn't belong here")
                    .expected(format!("expected `,` or `{bracket}`"))
            }
            _ => Problem::error(span, kind.to_string().to_lowercase()),
        },
        ErrorKind::TrailingCharacters => Problem::error(first(rest, &span), "the file goes on after its end")
            .expected("expected nothing more")
            .help("a file holds one thing, such as one Layout(...)"),
        ErrorKind::UnexpectedChar(c) => {
            Problem::error(first(rest, &span), format!("`{c}` has no meaning here"))
                .expected("expected a value")
        }
        ErrorKind::InvalidEscape(_) => Problem::error(span, "text has no such escape")
            .expected("what does this `\\` do?")
            .help("a backslash itself is written \\\\, a quote \\\", a line break \\n"),
        ErrorKind::Eof => {
            Problem::error(span, "the file ends where a value should stand").expected("expected a value")
        }
        other => Problem::error(span, other.to_string().to_lowercase()),
    }
}

/// The first word of `rest`, or its first character.
fn first(rest: &str, span: &Range<usize>) -> Range<usize> {
    let word = rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').map(char::len_utf8).sum();
    let one = rest.chars().next().map_or(0, char::len_utf8);
    span.start..span.start + Ord::max(one, word)
}

/// The word before `span` and what stands between: the field whose value is missing.
fn before(text: &str, span: &Range<usize>) -> Range<usize> {
    let head = text.get(..span.start).unwrap_or_default().trim_end();
    let name = head.trim_end_matches(':').trim_end();
    let start = name.rfind(|c: char| !c.is_alphanumeric() && c != '_').map_or(0, |at| at + 1);
    start..head.len()
}

/// `#![enable(...)]` is understood by other RON readers; whatever it asks for is on here anyway.
fn unknown_attributes(document: &Document<'_>) -> Vec<Problem> {
    const EXTENSIONS: [&str; 4] =
        ["implicit_some", "unwrap_newtypes", "unwrap_variant_newtypes", "explicit_struct_names"];
    let mut problems = Vec::new();
    for attribute in &document.attributes {
        let span = attribute.span.start_offset..attribute.span.end_offset;
        match (&*attribute.name, &attribute.content) {
            ("enable", AttributeContent::Args(names)) => {
                for name in names.iter().filter(|name| !EXTENSIONS.contains(&&***name)) {
                    let message = format!("unknown extension `{name}`");
                    problems.push(Problem::warning(span.clone(), message).help_if(did_you_mean(
                        name,
                        &EXTENSIONS,
                        '`',
                    )));
                }
            }
            _ => {
                problems
                    .push(Problem::warning(span, "this attribute means nothing here").expected("ignored"));
            }
        }
    }
    problems
}
