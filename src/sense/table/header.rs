//! The header of a table: its separator, and the place of each column.

use std::io::{self, BufRead};

use super::TableError;
use super::lines::{TableLine, TableLines};
use super::record::{LineFields, Splitter};
use super::shown;
use underfoot_format::suggest::nearest;

/// Separators of tables; the first is the usual one.
const SEPARATORS: [u8; 3] = [b',', b';', b'\t'];

/// A header that fits one of the expected ones.
#[derive(Debug)]
pub(super) struct TableHeader {
    /// Index of the expected header.
    pub(super) which: usize,
    pub(super) separator: u8,
    /// For each expected column its place in the file.
    pub(super) places: Vec<usize>,
    /// Number of columns of the file.
    pub(super) width: usize,
    /// Columns of the file that are not read.
    pub(super) unread: Vec<String>,
}

impl TableHeader {
    /// Reads up to the header. `lines` then returns the first row.
    ///
    /// A header may be in a comment, as `numpy.savetxt` writes it.
    pub(super) fn read<R: BufRead>(
        lines: &mut TableLines<R>,
        expected: &[&'static [&'static str]],
    ) -> Result<Self, TableError> {
        let mut in_comment = None;
        loop {
            let line = match lines.next()? {
                Some(TableLine::Bytes(line)) => line,
                Some(TableLine::Broken(reason)) => {
                    let problem = reason.to_owned();
                    return Err(TableError::Header { line: lines.number(), problem });
                }
                None => return in_comment.map_or_else(|| Err(no_header(expected)), Ok),
            };
            if is_utf16(line) {
                let problem = "this is UTF-16; save the table as UTF-8 text".to_owned();
                return Err(TableError::Header { line: lines.number(), problem });
            }
            let text = String::from_utf8_lossy(line).into_owned();
            let text = text.trim_start_matches('\u{feff}').trim();
            if let Some(comment) = text.strip_prefix('#') {
                in_comment = Self::of(comment.trim_start_matches('#'), expected).ok().or(in_comment);
            } else if !is_blank(text) && !is_hint(text) {
                return match (Self::of(text, expected), in_comment) {
                    (Ok(header), _) => Ok(header),
                    (Err(_), Some(header)) => {
                        lines.put_back();
                        Ok(header)
                    }
                    (Err(problem), None) => Err(TableError::Header { line: lines.number(), problem }),
                };
            }
        }
    }

    /// The header in `text`, or the reason for which it is none of the expected ones.
    fn of(text: &str, expected: &[&'static [&'static str]]) -> Result<Self, String> {
        let mut closest: Option<(usize, String)> = None;
        for separator in SEPARATORS {
            let names = split(text, separator);
            // The longest header that fits reads most of the table.
            let mut fitting: Option<Self> = None;
            for (which, columns) in expected.iter().enumerate() {
                match place(&names, columns) {
                    Ok(places) if fitting.as_ref().is_none_or(|other| other.places.len() < places.len()) => {
                        let unread = (0..).zip(&names).filter(|(at, _)| !places.contains(at));
                        let unread = unread.map(|(_, name)| name.clone()).collect();
                        fitting = Some(Self { which, separator, places, width: names.len(), unread });
                    }
                    Ok(_) => {}
                    Err((missing, problem)) => {
                        if closest.as_ref().is_none_or(|(least, _)| missing < *least) {
                            closest = Some((missing, problem));
                        }
                    }
                }
            }
            if let Some(header) = fitting {
                return Ok(header);
            }
        }
        let known: Vec<String> = expected.iter().map(|columns| columns.join(",")).collect();
        let known = known.join(" or ");
        // For a line that shares no column with any header, the expected ones are the whole message.
        match closest.filter(|(missing, _)| expected.iter().all(|columns| *missing < columns.len())) {
            Some((_, problem)) => Err(format!("{problem}; expected the header {known}")),
            None => Err(format!("expected the header {known}, found {}", shown(text))),
        }
    }
}

/// The place of each column among `names`; if one is missing or occurs twice, the number of missing ones and the
/// first problem.
fn place(names: &[String], columns: &[&'static str]) -> Result<Vec<usize>, (usize, String)> {
    let (mut places, mut missing) = (Vec::with_capacity(columns.len()), Vec::new());
    let is = |name: &String, column: &str| name.eq_ignore_ascii_case(column);
    for column in columns {
        let mut found = (0..).zip(names).filter(|(_, name)| is(name, column)).map(|(at, _)| at);
        match (found.next(), found.next()) {
            (Some(at), None) => places.push(at),
            (Some(_), Some(_)) => return Err((0, format!("the column {column} is there twice"))),
            (None, _) => missing.push(*column),
        }
    }
    let Some(first) = missing.first() else { return Ok(places) };
    let others = names.iter().map(String::as_str).filter(|name| !columns.contains(name));
    let meant = nearest(first, others).map(|name| format!(" (is it {}?)", shown(name))).unwrap_or_default();
    Err((missing.len(), format!("the column {first} is missing{meant}")))
}

/// The names in a header line, without the empty ones at its end.
fn split(text: &str, separator: u8) -> Vec<String> {
    let mut record = LineFields::default();
    Splitter::new(separator).split(text.as_bytes(), &mut record);
    let names = record.iter().take(record.filled());
    names.map(|name| unquoted(&String::from_utf8_lossy(name)).to_owned()).collect()
}

/// `text` without surrounding blanks and without quotation marks after a blank.
pub(super) fn unquoted(text: &str) -> &str {
    let text = text.trim();
    let inner = text.strip_prefix('"').and_then(|text| text.strip_suffix('"'));
    inner.map_or(text, str::trim)
}

fn is_blank(text: &str) -> bool {
    text.chars().all(|c| c.is_whitespace() || matches!(c, ',' | ';' | '"'))
}

/// The line that declares the separator to spreadsheets: `sep=;`.
fn is_hint(text: &str) -> bool {
    let text = text.trim_matches('"');
    text.len() <= 5 && text.get(..4).is_some_and(|begins| begins.eq_ignore_ascii_case("sep="))
}

fn is_utf16(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") || bytes.contains(&0)
}

fn no_header(expected: &[&'static [&'static str]]) -> TableError {
    let known: Vec<String> = expected.iter().map(|columns| columns.join(",")).collect();
    let problem = format!("expected the header {}: the table is empty", known.join(" or "));
    TableError::Header { line: 1, problem }
}

impl From<io::Error> for TableError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}
