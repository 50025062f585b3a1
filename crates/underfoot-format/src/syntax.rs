//! Parses a text into a syntax tree and collects all syntax errors.
//!
//! The parser reports its first error only. If one character repairs it, that character is put in; otherwise the
//! entry with the error is blanked out, up to the brackets or commas around it. Then the text is parsed again, so
//! that everything beside a broken entry is still read and checked.

use std::ops::Range;

use ron2::ast::{AttributeContent, Document, Expr, parse_document_lossy};
use ron2::error::ErrorKind;

use super::complaint::{Complaint, rephrase};
use super::pairs::{self, Limits, Punctuation, entry_around};
use super::problem::Problem;
use super::scan::{Scan, scan};
use super::suggest::did_you_mean;

/// Maximum number of tokens parsed in total while one error after the other is found.
const EFFORT: usize = 2_000_000;

/// Result of parsing a text.
pub(crate) struct Syntax<'t> {
    /// The root value, as far as it could be parsed.
    pub(crate) root: Option<Expr<'t>>,
    /// Syntax errors.
    pub(crate) problems: Vec<Problem>,
    /// Places where `root` differs from the text and must not be checked.
    pub(crate) holes: Vec<Range<usize>>,
}

/// Parses `text`, which is expected to hold one `kind` of thing, such as a `Layout`.
pub(crate) fn parse<'t>(text: &'t str, kind: &str, limits: Limits) -> Syntax<'t> {
    let Scan { mut problems, marks, tokens, certain, .. } = scan(text, limits.tokens);
    if certain {
        let mispaired = pairs::check(text, &marks, limits);
        if mispaired.is_empty() {
            let holes: Option<Vec<_>> =
                problems.iter().map(|problem| entry_around(&marks, problem.span.start)).collect();
            if let Some(holes) = holes {
                let mut mended = Mended { text, marks, holes, repairs: Vec::new() };
                let rounds = (EFFORT / tokens.max(1)).clamp(1, 100);
                let root = mended.parse(kind, rounds, &mut problems);
                return Syntax { root, problems, holes: mended.holes };
            }
        }
        problems.extend(mispaired);
    }
    Syntax { root: None, problems, holes: Vec::new() }
}

/// A text whose errors are repaired or blanked out as they are found.
struct Mended<'t> {
    text: &'t str,
    marks: Vec<Punctuation>,
    holes: Vec<Range<usize>>,
    repairs: Vec<(usize, u8)>,
}

impl<'t> Mended<'t> {
    fn parse(&mut self, kind: &str, mut rounds: usize, problems: &mut Vec<Problem>) -> Option<Expr<'t>> {
        loop {
            let masked;
            let (seen, (document, errors)) = if self.holes.is_empty() && self.repairs.is_empty() {
                (self.text, parse_document_lossy(self.text))
            } else {
                masked = self.masked();
                let (document, errors) = parse_document_lossy(&masked);
                (masked.as_str(), (document.into_owned(), errors))
            };
            let Some(error) = errors.first() else {
                problems.extend(unknown_attributes(&document));
                if document.value.is_none() && problems.is_empty() {
                    let nothing = Problem::error(0..0, format!("there is no {kind} in this file"));
                    problems.push(nothing.expected(format!("expected {kind}(...)")));
                }
                return document.value;
            };
            let span = error.span().start_offset..error.span().end_offset;
            let Complaint { problem, repair } = rephrase(seen, &span, error.kind());
            problems.push(problem);
            rounds -= 1;
            let behind = matches!(error.kind(), ErrorKind::TrailingCharacters);
            let entry = entry_around(&self.marks, span.start).filter(|_| rounds > 0 && !behind);
            match (entry, repair) {
                (Some(_), Some(repair)) => self.repair(repair),
                (Some(entry), None) if !seen[entry.clone()].trim().is_empty() => self.holes.push(entry),
                // The error is outside of all brackets, or the brackets do not pair up: only the text before it can
                // be checked.
                _ => {
                    self.holes.push(span.start..self.text.len());
                    return document.value;
                }
            }
        }
    }

    fn repair(&mut self, (at, character): (usize, u8)) {
        self.repairs.push((at, character));
        let index = self.marks.partition_point(|mark| mark.at < at);
        match character {
            b',' => self.marks.insert(index, Punctuation { at, character }),
            b' ' => self.marks.retain(|mark| mark.at != at),
            _ => {}
        }
    }

    /// Returns the text with spaces in place of the holes, and with the repairs.
    fn masked(&self) -> String {
        let mut bytes = self.text.as_bytes().to_vec();
        for hole in &self.holes {
            bytes.get_mut(hole.clone()).unwrap_or_default().fill(b' ');
        }
        for &(at, character) in &self.repairs {
            if let Some(byte) = bytes.get_mut(at) {
                *byte = character;
            }
        }
        // Holes end at brackets and commas, and repairs replace one ASCII character by another, so the text stays
        // UTF-8.
        String::from_utf8(bytes).unwrap_or_default()
    }
}

/// Other RON readers know `#![enable(...)]`; all extensions that it can enable are on here anyway.
fn unknown_attributes(document: &Document<'_>) -> Vec<Problem> {
    const EXTENSIONS: [&str; 4] =
        ["implicit_some", "unwrap_newtypes", "unwrap_variant_newtypes", "explicit_struct_names"];
    let mut problems = Vec::new();
    for attribute in &document.attributes {
        let span = attribute.span.start_offset..attribute.span.end_offset;
        match (&*attribute.name, &attribute.content) {
            ("enable", AttributeContent::Args(names)) => {
                for name in names.iter().filter(|name| !EXTENSIONS.contains(&&***name)) {
                    let problem = Problem::warning(span.clone(), format!("unknown extension `{name}`"));
                    problems.push(problem.help_if(did_you_mean(name, &EXTENSIONS, '`')));
                }
            }
            _ => {
                let problem = Problem::warning(span, "this attribute means nothing here");
                problems.push(problem.expected("ignored"));
            }
        }
    }
    problems
}
