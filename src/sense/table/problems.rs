//! The problems of a table.

use std::fmt;

/// Notes about a table that was read: the skipped lines, and the columns without meaning here.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TableNotes {
    /// The problems of its lines.
    pub problems: TableProblems,
    /// Names of the columns that were not read, as the header has them.
    pub unread: Vec<String>,
}

/// A problem of one line of a table. The line is skipped; all others are read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TableProblem {
    /// Number of the line, from 1; blank lines and comments count.
    pub line: u64,
    /// Column by its name in the header; empty if the problem concerns the whole line.
    pub column: &'static str,
    /// The problem, with the text that was expected.
    pub problem: String,
}

/// The problems of a table's lines: the first ones in full, the others counted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TableProblems {
    shown: Vec<TableProblem>,
    more: usize,
    lines: u64,
    last_line: u64,
}

impl TableProblems {
    /// Maximum number of problems kept in full: as many as fit on a screen.
    pub const MOST: usize = 20;

    /// The first problems, in the order in which they were found.
    #[must_use]
    pub fn shown(&self) -> &[TableProblem] {
        &self.shown
    }

    /// Number of problems that are not among [`Self::shown`].
    #[must_use]
    pub const fn more(&self) -> usize {
        self.more
    }

    /// Number of skipped lines, each with one or several problems.
    #[must_use]
    pub const fn lines(&self) -> u64 {
        self.lines
    }

    /// Whether every line was good.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.lines == 0
    }

    pub(super) fn add(&mut self, line: u64, column: &'static str, problem: String) {
        // All problems of one line come before those of the next.
        if line != self.last_line {
            self.lines += 1;
            self.last_line = line;
        }
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
