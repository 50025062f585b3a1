//! A look at brackets, quotes and comments before the text is parsed.
//!
//! Parsers report what they stumbled over; for a bracket or quote left open
//! that is often the end of the file. This pass knows where it was opened. It
//! also bounds nesting and the number of values, so that what is parsed
//! afterwards can exhaust neither the stack nor the memory, and it refuses
//! every text that the parser might cut into tokens differently.

use super::diagnostic::Diagnostics;
use super::problem::Problem;

/// How much one file may hold.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// Brackets within brackets.
    pub(super) depth: usize,
    /// Entries of one list.
    pub(super) entries: usize,
    /// Brackets and commas in the whole file.
    pub(super) values: usize,
}

impl Limits {
    /// For layouts and kinds.
    pub(super) const LAYOUT: Self = Self { depth: 64, entries: 4096, values: 400_000 };

    /// For floors, which list every sensor.
    pub(super) const FLOOR: Self = Self { entries: 400_000, ..Self::LAYOUT };
}

/// What is wrong with the brackets, quotes, comments and characters of `text`, in order; usually nothing.
pub(super) fn scan(text: &str, limits: Limits) -> Vec<Problem> {
    let mut scan =
        Scan { text, at: 0, limits, open: Vec::new(), values: 0, misled: false, problems: Vec::new() };
    while scan.step() {}
    scan.close_all();
    scan.problems
}

/// A bracket not yet closed.
struct Open {
    bracket: u8,
    at: usize,
    commas: usize,
}

struct Scan<'t> {
    text: &'t str,
    at: usize,
    limits: Limits,
    open: Vec<Open>,
    values: usize,
    /// A quote was left open: brackets after it may have been swallowed and prove nothing.
    misled: bool,
    problems: Vec<Problem>,
}

impl Scan<'_> {
    /// Passes one token; false at the end, or where going on is pointless.
    fn step(&mut self) -> bool {
        let rest = &self.text[self.at..];
        let Some(first) = rest.chars().next() else { return false };
        if self.problems.len() > Diagnostics::LIMIT {
            return false;
        }
        match first {
            '"' => self.string(0),
            'r' | 'b' if self.at_boundary() => match string_prefix(rest) {
                Some(prefix) => self.string(prefix),
                None => self.word(),
            },
            '/' if rest.starts_with("//") => self.at += rest.find('\n').unwrap_or(rest.len()),
            '/' if rest.starts_with("/*") => self.block_comment(),
            '(' | '[' => return self.opens(first as u8),
            ')' | ']' => self.closes(first as u8),
            ',' => return self.comma(),
            '{' | '}' => {
                self.report_at(1, "curly brackets have no use here", "expected `(` or `)`");
                self.help("fields stand in round brackets: (id: \"home\", at: (1, 2))");
                self.at += 1;
            }
            '\'' | '`' | '‘' | '’' | '“' | '”' | '„' | '«' | '»' => self.wrong_quote(first),
            c if c.is_ascii_alphabetic() || c == '_' => self.word(),
            c if c.is_ascii() || c.is_whitespace() && c != '\u{a0}' => self.at += c.len_utf8(),
            c => {
                let shown = if c.is_alphanumeric() { format!(" `{c}`") } else { String::new() };
                let name =
                    format!("the character U+{:04X}{shown} may only stand in text and comments", c as u32);
                self.report_at(c.len_utf8(), name, "");
                self.at += c.len_utf8();
            }
        }
        true
    }

    fn report_at(&mut self, length: usize, message: impl Into<String>, expected: &str) {
        self.problems.push(Problem::error(self.at..self.at + length, message).expected(expected));
    }

    fn help(&mut self, help: &str) {
        if let Some(problem) = self.problems.last_mut() {
            problem.help = Some(help.into());
        }
    }

    /// Whether a new token certainly begins here.
    fn at_boundary(&self) -> bool {
        let before = self.text[..self.at].chars().next_back();
        before.is_none_or(|c| c.is_whitespace() || matches!(c, '(' | '[' | ',' | ':' | '=' | '/'))
    }

    fn word(&mut self) {
        let rest = &self.text.as_bytes()[self.at..];
        self.at += rest.iter().take_while(|byte| byte.is_ascii_alphanumeric() || **byte == b'_').count();
    }

    /// Passes text whose quote stands `prefix` bytes on; it must end on its line.
    fn string(&mut self, prefix: usize) {
        if prefix == 0 && !self.at_boundary() {
            self.report_at(1, "a comma is missing before this text", "expected `,` or a space");
        }
        let start = self.at;
        let raw = self.text[start..start + prefix].contains('r');
        let hashes = prefix.saturating_sub(usize::from(self.text[start..].starts_with("br")) + 1);
        let closing = format!("\"{}", "#".repeat(if raw { hashes } else { 0 }));
        if hashes > 8 {
            self.report_at(prefix, "a raw text may begin with 8 `#` at most", "");
        }
        let mut at = start + prefix + 1;
        let bytes = self.text.as_bytes();
        loop {
            match bytes.get(at) {
                None | Some(b'\n') => break,
                Some(b'"') if self.text[at..].starts_with(&closing) => {
                    self.at = at + closing.len();
                    return;
                }
                // An escaped line break doesn't hide the end of the line.
                Some(b'\\') if !raw && !matches!(bytes.get(at + 1), None | Some(b'\r' | b'\n')) => at += 2,
                Some(_) => at += 1,
            }
        }
        self.at = at;
        let shown = self.text[start..at].trim_end().len();
        self.problems.push(
            Problem::error(start..start + shown, "this text is never closed")
                .expected(format!("expected a closing `{closing}` on this line"))
                .help("a line break within text is written \\n"),
        );
        self.misled = true;
    }

    /// Comments nest.
    fn block_comment(&mut self) {
        let start = self.at;
        let mut depth = 0;
        let bytes = self.text.as_bytes();
        while self.at < bytes.len() {
            let pair = &bytes[self.at..(self.at + 2).min(bytes.len())];
            match pair {
                b"/*" => depth += 1,
                b"*/" => depth -= 1,
                _ => {
                    self.at += 1;
                    continue;
                }
            }
            self.at += 2;
            if depth == 0 {
                return;
            }
        }
        self.problems.push(
            Problem::error(start..start + 2, "this comment is never closed")
                .expected("expected `*/` further down")
                .help("comments nest: each `/*` needs its own `*/`"),
        );
        self.misled = true;
    }

    fn wrong_quote(&mut self, quote: char) {
        let line = self.text[self.at..].lines().next().unwrap_or_default();
        let closing = |c: char| c == quote || matches!(c, '‘' | '’' | '“' | '”' | '«' | '»') && quote != '\'';
        let length = line.char_indices().skip(1).find(|&(_, c)| closing(c)).map(|(at, c)| at + c.len_utf8());
        let length = length.unwrap_or(quote.len_utf8());
        self.report_at(length, "text stands in straight double quotes", "expected `\"`");
        let inner = self.text[self.at..self.at + length].trim_matches(|c| closing(c) || c == quote);
        if !inner.is_empty() {
            self.help(&format!("write \"{inner}\""));
        }
        self.at += length;
    }

    fn opens(&mut self, bracket: u8) -> bool {
        if self.open.len() == self.limits.depth {
            self.report_at(
                1,
                format!("brackets nest deeper than {}", self.limits.depth),
                "one bracket too many",
            );
            self.open.clear();
            return false;
        }
        self.open.push(Open { bracket, at: self.at, commas: 0 });
        self.at += 1;
        self.counts_value()
    }

    fn comma(&mut self) -> bool {
        self.at += 1;
        if let Some(open) = self.open.last_mut() {
            open.commas += 1;
            if open.bracket == b'[' && open.commas > self.limits.entries {
                let (from, most) = (open.at, self.limits.entries);
                self.open.clear();
                let message = format!("this list has more than {most} entries");
                self.problems.push(Problem::error(from..from + 1, message).expected("begins here"));
                return false;
            }
        }
        self.counts_value()
    }

    fn counts_value(&mut self) -> bool {
        self.values += 1;
        if self.values > self.limits.values {
            let message = format!("the file holds more than {} values", self.limits.values);
            self.open.clear();
            self.report_at(0, message, "gave up here");
            return false;
        }
        true
    }

    fn closes(&mut self, bracket: u8) {
        let opening = if bracket == b')' { b'(' } else { b'[' };
        let at = self.at;
        self.at += 1;
        match self.open.iter().rposition(|open| open.bracket == opening) {
            Some(matching) => {
                let left_open = self.open.drain(matching..).nth(1);
                if let (Some(inner), false) = (left_open, self.misled) {
                    let line = self.text[..at].matches('\n').count() + 1;
                    self.problems.push(never_closed(&inner).help(format!(
                        "line {line} closes a `{}` around it with `{}`",
                        char::from(opening),
                        char::from(bracket),
                    )));
                }
            }
            None if self.misled => {}
            None => {
                let message = format!("this `{}` closes nothing", char::from(bracket));
                self.problems.push(Problem::error(at..at + 1, message).expected("one bracket too many"));
            }
        }
    }

    /// The end of the file: whatever is still open was never closed.
    fn close_all(&mut self) {
        if self.misled {
            return;
        }
        if let Some(inner) = self.open.last() {
            let help = match self.open.len() {
                1 => "the file ends before it is closed: was it saved half-way?".to_owned(),
                open => format!("the file ends with {open} brackets open: was it saved half-way?"),
            };
            self.problems.push(never_closed(inner).help(help));
        }
    }
}

fn never_closed(open: &Open) -> Problem {
    let closing = if open.bracket == b'(' { ')' } else { ']' };
    let message = format!("this `{}` is never closed", char::from(open.bracket));
    Problem::error(open.at..open.at + 1, message).expected(format!("expected a `{closing}` further down"))
}

/// Bytes before the quote of a raw or byte text that begins here; `None` if a plain word does.
fn string_prefix(rest: &str) -> Option<usize> {
    let letters = ["br", "r", "b"].into_iter().find(|letters| rest.starts_with(letters))?;
    let hashes =
        if letters == "b" { 0 } else { rest[letters.len()..].bytes().take_while(|b| *b == b'#').count() };
    let prefix = letters.len() + hashes;
    rest[prefix..].starts_with('"').then_some(prefix)
}
