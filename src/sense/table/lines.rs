//! The lines of a table, one at a time.

use std::io::{self, BufRead};

/// Maximum length of a line, in bytes. A row of our widest table has about 120; other tables may have many more
/// columns.
const LONGEST: usize = 64 << 10;

/// Reads a table line by line. Lines end with LF, CR or both; a line without an end takes no more than the maximum.
#[derive(Debug)]
pub(super) struct TableLines<R> {
    reader: R,
    line: Vec<u8>,
    /// Number of the current line, from 1; 0 before the first.
    number: u64,
    /// Whether it ended with CR, which an LF may follow.
    ended_by_cr: bool,
    /// Whether the next call returns the current line again.
    is_put_back: bool,
}

/// A line of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TableLine<'l> {
    /// Its bytes without the end; blank ones are lines as well.
    Bytes(&'l [u8]),
    /// It cannot be a row, with the reason.
    Broken(&'static str),
}

impl<R: BufRead> TableLines<R> {
    pub(super) const fn new(reader: R) -> Self {
        Self { reader, line: Vec::new(), number: 0, ended_by_cr: false, is_put_back: false }
    }

    /// Number of the current line, from 1; 0 before the first.
    pub(super) const fn number(&self) -> u64 {
        self.number
    }

    /// Makes the next call return the current line again.
    pub(super) const fn put_back(&mut self) {
        self.is_put_back = true;
    }

    /// The next line; `None` at the end.
    pub(super) fn next(&mut self) -> io::Result<Option<TableLine<'_>>> {
        if !std::mem::take(&mut self.is_put_back) && !self.advance()? {
            return Ok(None);
        }
        let is_comment = self.line.trim_ascii_start().first() == Some(&b'#');
        let is_open = self.line.iter().filter(|byte| **byte == b'"').count() % 2 == 1;
        Ok(Some(if self.line.len() > LONGEST {
            TableLine::Broken("longer than 64 kB")
        } else if is_open && !is_comment {
            TableLine::Broken("a quotation mark is not closed")
        } else {
            TableLine::Bytes(&self.line)
        }))
    }

    /// Reads a line, or the first bytes of one that is too long, one more than the maximum; returns false at the end.
    fn advance(&mut self) -> io::Result<bool> {
        self.line.clear();
        let mut is_there = false;
        loop {
            let available = match self.reader.fill_buf() {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                available => available?,
            };
            if available.is_empty() {
                break;
            }
            if std::mem::take(&mut self.ended_by_cr) && available.first() == Some(&b'\n') {
                self.reader.consume(1);
                continue;
            }
            is_there = true;
            let end = available.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
            let part = available.get(..end.unwrap_or(available.len())).unwrap_or_default();
            let room = (LONGEST + 1).saturating_sub(self.line.len());
            self.line.extend(part.iter().take(room));
            let Some(end) = end else {
                let all = available.len();
                self.reader.consume(all);
                continue;
            };
            self.ended_by_cr = available.get(end) == Some(&b'\r');
            self.reader.consume(end + 1);
            break;
        }
        self.number += u64::from(is_there);
        Ok(is_there)
    }

    #[cfg(test)]
    pub(super) fn capacity(&self) -> usize {
        self.line.capacity()
    }
}
