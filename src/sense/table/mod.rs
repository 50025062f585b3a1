//! Tables of measurements in CSV: the reader for all of them.
//!
//! ```text
//! bytes -lines-> lines -record-> fields -header-> the columns that are wanted -> numbers in range
//! ```
//!
//! A line that cannot be read is skipped and reported; all others are read. Where semicolons separate the fields, a
//! comma is the decimal mark, as spreadsheets write tables in most of Europe.

mod force_table;
mod header;
mod lines;
mod problems;
mod record;

use std::borrow::Cow;
use std::io::{self, BufRead};
use std::ops::{Range, RangeInclusive};

use thiserror::Error;

pub use force_table::ForceTable;
use header::{TableHeader, unquoted};
use lines::{TableLine, TableLines};
pub use problems::{TableNotes, TableProblem, TableProblems};
use record::{LineFields, Splitter};

/// A table that cannot be read at all, or not to its end.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TableError {
    /// The file cannot be read.
    #[error("it cannot be read: {0}")]
    Io(#[source] io::Error),
    /// The first line is not the header of such a table.
    #[error("line {line}: {problem}")]
    Header {
        /// Number of the line, from 1.
        line: u64,
        /// The problem, with the header that was expected.
        problem: String,
    },
}

/// A table that is being read.
#[derive(Debug)]
pub(super) struct TableReader<R> {
    lines: TableLines<R>,
    splitter: Splitter,
    header: TableHeader,
    names: &'static [&'static str],
    problems: TableProblems,
}

/// One row of a table.
#[derive(Clone, Debug, Default)]
pub(super) struct TableRow {
    line: u64,
    record: LineFields,
}

impl<R: BufRead> TableReader<R> {
    /// The table in `reader`, whose header must have the columns of one of `expected`, in any order.
    pub(super) fn new(reader: R, expected: &[&'static [&'static str]]) -> Result<Self, TableError> {
        let mut lines = TableLines::new(reader);
        let header = TableHeader::read(&mut lines, expected)?;
        let names = expected.get(header.which).copied().unwrap_or_default();
        let splitter = Splitter::new(header.separator);
        Ok(Self { lines, splitter, header, names, problems: TableProblems::default() })
    }

    /// Index of the header, among the expected ones.
    pub(super) const fn header(&self) -> usize {
        self.header.which
    }

    /// Problems so far.
    pub(super) const fn problems(&self) -> &TableProblems {
        &self.problems
    }

    /// Columns of the file that are not read.
    pub(super) fn unread(&self) -> &[String] {
        &self.header.unread
    }

    /// Problems of the whole table, and the columns that are not read.
    pub(super) fn into_notes(self) -> TableNotes {
        TableNotes { problems: self.problems, unread: self.header.unread }
    }

    /// Reads the next row that has all columns into `row`; false at the end.
    pub(super) fn next_row(&mut self, row: &mut TableRow) -> io::Result<bool> {
        loop {
            let problem = match self.lines.next()? {
                None => return Ok(false),
                Some(TableLine::Broken(reason)) => Some(reason.to_owned()),
                Some(TableLine::Bytes(line)) if line.trim_ascii_start().first() == Some(&b'#') => continue,
                Some(TableLine::Bytes(line)) => {
                    self.splitter.split(line, &mut row.record);
                    if row.record.filled() == 0 {
                        continue;
                    }
                    self.fault_of_width(&row.record)
                }
            };
            row.line = self.lines.number();
            match problem {
                None => return Ok(true),
                Some(problem) => self.problems.add(row.line, "", problem),
            }
        }
    }

    /// The problem of a line with too few or too many fields; empty fields at its end do not count.
    fn fault_of_width(&self, record: &LineFields) -> Option<String> {
        let (found, filled, expected) = (record.len(), record.filled(), self.header.width);
        if filled > expected {
            let is_comma = self.splitter.separator() == b',';
            let hint =
                if is_comma { "; where a comma is the decimal mark, semicolons separate fields" } else { "" };
            return Some(format!("expected {expected} fields, found {filled}{hint}"));
        }
        if self.header.places.iter().all(|place| *place < found) {
            return None;
        }
        let others = [(b',', "commas"), (b';', "semicolons"), (b'\t', "tabs")];
        let other = others.into_iter().find(|(separator, _)| {
            let further = record.iter().flatten().filter(|byte| *byte == separator).count();
            *separator != self.splitter.separator() && found + further == expected
        });
        let hint = other.map(|(_, name)| format!("; {name} separate them, unlike those of the header"));
        Some(format!("expected {expected} fields, found {found}{}", hint.unwrap_or_default()))
    }

    /// Reports a problem in one field of `row`.
    pub(super) fn report(&mut self, row: &TableRow, field: usize, problem: String) {
        self.problems.add(row.line, self.names.get(field).copied().unwrap_or_default(), problem);
    }

    /// Reports a problem of `line`.
    pub(super) fn report_line(&mut self, line: u64, problem: String) {
        self.problems.add(line, "", problem);
    }

    /// One field as written, without blanks and quotation marks around it.
    pub(super) fn text<'r>(&self, row: &'r TableRow, field: usize) -> Cow<'r, str> {
        let place = self.header.places.get(field).copied();
        let bytes = place.and_then(|place| row.record.get(place)).unwrap_or_default();
        match String::from_utf8_lossy(bytes) {
            Cow::Borrowed(text) => Cow::Borrowed(unquoted(text)),
            Cow::Owned(text) => Cow::Owned(unquoted(&text).to_owned()),
        }
    }

    /// The number in one field of `row`; reports anything but a finite number in the range.
    pub(super) fn number(&mut self, row: &TableRow, field: usize, range: RangeInclusive<f64>) -> Option<f64> {
        let written = self.text(row, field);
        let number = self.parse(&written).filter(|number| range.contains(number));
        if number.is_none() {
            let (least, most) = (range.start(), range.end());
            let found = shown(&written);
            let decimal = self.splitter.separator() != b';' && with_point(&written).parse::<f64>().is_ok();
            let hint =
                if decimal && written.contains(',') { "; write the decimal mark as a point" } else { "" };
            self.report(row, field, format!("expected a number from {least} to {most}, found {found}{hint}"));
        }
        number
    }

    /// The whole number of `range` in one field of `row`.
    pub(super) fn whole(&mut self, row: &TableRow, field: usize, range: Range<u16>) -> Option<u16> {
        let written = self.text(row, field);
        // Programs without integers write 3 as 3.0.
        let number = self.parse(&written).filter(|number| number.fract() == 0.0);
        let number = number.filter(|number| (f64::from(range.start)..f64::from(range.end)).contains(number));
        if number.is_none() {
            let (least, most) = (range.start, range.end.saturating_sub(1));
            let found = shown(&written);
            self.report(row, field, format!("expected a whole number from {least} to {most}, found {found}"));
        }
        number.map(|number| number as u16)
    }

    fn parse(&self, written: &str) -> Option<f64> {
        let has_comma = self.splitter.separator() == b';' && written.contains(',');
        if has_comma { with_point(written).parse().ok() } else { written.parse().ok() }
    }
}

impl TableRow {
    /// Number of its line, from 1.
    pub(super) const fn line(&self) -> u64 {
        self.line
    }
}

/// `written` with its only decimal mark as a point.
fn with_point(written: &str) -> Cow<'_, str> {
    let is_alone = written.matches(',').count() == 1 && !written.contains('.');
    if is_alone { Cow::Owned(written.replace(',', ".")) } else { Cow::Borrowed(written) }
}

/// A field in quotation marks, cut short if it is long.
pub(super) fn shown(written: &str) -> String {
    const MOST: usize = 24;
    if written.chars().count() > MOST {
        format!("{:?}...", written.chars().take(MOST).collect::<String>())
    } else {
        format!("{written:?}")
    }
}

#[cfg(test)]
mod tests;
