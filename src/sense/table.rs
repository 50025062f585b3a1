//! Reading CSV tables of measurements: everything wrong with one at once.

use std::fmt;
use std::ops::{Range, RangeInclusive};

/// Something wrong with a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TableProblem {
    /// Which line, from 1.
    pub line: usize,
    /// Which column, by its name in the header; empty if it is about the whole line.
    pub column: &'static str,
    /// What is wrong, and what was expected.
    pub problem: String,
}

/// Everything wrong with a table: the first problems in full, the rest counted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TableProblems {
    shown: Vec<TableProblem>,
    more: usize,
}

impl TableProblems {
    /// Most problems that are kept in full.
    pub const MOST: usize = 20;

    /// The first of them, in the order of the table.
    #[must_use]
    pub fn shown(&self) -> &[TableProblem] {
        &self.shown
    }

    /// How many there are besides.
    #[must_use]
    pub const fn more(&self) -> usize {
        self.more
    }

    fn add(&mut self, line: usize, column: &'static str, problem: String) {
        if self.shown.len() < Self::MOST {
            self.shown.push(TableProblem { line, column, problem });
        } else {
            self.more += 1;
        }
    }
}

impl fmt::Display for TableProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}", self.line)?;
        if !self.column.is_empty() {
            write!(f, ", column {}", self.column)?;
        }
        write!(f, ": {}", self.problem)
    }
}

impl fmt::Display for TableProblems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (number, problem) in self.shown.iter().enumerate() {
            write!(f, "{}{problem}", if number == 0 { "" } else { "\n" })?;
        }
        match self.more {
            0 => Ok(()),
            more => write!(f, "\nand {more} more like these"),
        }
    }
}

impl std::error::Error for TableProblems {}

/// A table under reading: its rows, and what was wrong so far.
pub(super) struct Table<'t> {
    lines: std::iter::Enumerate<std::str::Lines<'t>>,
    columns: &'static [&'static str],
    problems: TableProblems,
}

/// One row, its fields as written.
pub(super) struct Row<'t> {
    line: usize,
    columns: &'static [&'static str],
    fields: Vec<&'t str>,
}

impl<'t> Table<'t> {
    /// The table in `text`, whose header must be one of `headers`; gives which one, too.
    pub(super) fn new(
        text: &'t str,
        headers: &[&'static [&'static str]],
    ) -> Result<(Self, usize), TableProblems> {
        let mut lines = text.strip_prefix('\u{feff}').unwrap_or(text).lines().enumerate();
        let first = lines.next().map(|(_, line)| line).unwrap_or_default();
        let written: Vec<_> = first.split(',').map(str::trim).collect();
        match headers.iter().position(|columns| **columns == written[..]) {
            Some(which) => {
                let columns = headers[which];
                Ok((Self { lines, columns, problems: TableProblems::default() }, which))
            }
            None => {
                let known: Vec<String> = headers.iter().map(|columns| columns.join(",")).collect();
                let mut problems = TableProblems::default();
                problems.add(1, "", format!("expected the header {}", known.join(" or ")));
                Err(problems)
            }
        }
    }

    /// The next row with the right number of fields; empty lines are passed over.
    pub(super) fn next_row(&mut self) -> Option<Row<'t>> {
        loop {
            let (index, line) = self.lines.next()?;
            if line.trim().is_empty() {
                continue;
            }
            let fields: Vec<_> = line.split(',').map(str::trim).collect();
            let (line, expected) = (index + 1, self.columns.len());
            if fields.len() == expected {
                return Some(Row { line, columns: self.columns, fields });
            }
            self.problems.add(line, "", format!("expected {expected} fields, found {}", fields.len()));
        }
    }

    /// Notes that something is wrong in one field of `row`.
    pub(super) fn report(&mut self, row: &Row<'_>, field: usize, problem: String) {
        self.problems.add(row.line, row.columns.get(field).copied().unwrap_or_default(), problem);
    }

    /// The number in one field of `row`; anything but a finite number in the range is noted.
    pub(super) fn number(&mut self, row: &Row<'_>, field: usize, range: RangeInclusive<f64>) -> Option<f64> {
        let written = row.fields.get(field).copied().unwrap_or_default();
        let number = written.parse::<f64>().ok().filter(|number| range.contains(number));
        if number.is_none() {
            let (least, most) = (range.start(), range.end());
            self.report(
                row,
                field,
                format!("expected a number from {least} to {most}, found {}", shown(written)),
            );
        }
        number
    }

    /// The whole number of `range` in one field of `row`.
    pub(super) fn whole(&mut self, row: &Row<'_>, field: usize, range: Range<u16>) -> Option<u16> {
        let written = row.fields.get(field).copied().unwrap_or_default();
        let number = written.parse::<u16>().ok().filter(|number| range.contains(number));
        if number.is_none() {
            let (least, most) = (range.start, range.end.saturating_sub(1));
            self.report(
                row,
                field,
                format!("expected a whole number from {least} to {most}, found {}", shown(written)),
            );
        }
        number
    }

    /// `read`, unless anything was wrong.
    pub(super) fn conclude<T>(self, read: T) -> Result<T, TableProblems> {
        if self.problems.shown.is_empty() { Ok(read) } else { Err(self.problems) }
    }
}

impl<'t> Row<'t> {
    /// One field as written.
    pub(super) fn text(&self, field: usize) -> &'t str {
        self.fields.get(field).copied().unwrap_or_default()
    }
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
