//! A scan of quotes, comments and characters before the text is parsed.
//!
//! A parser reports the place where it failed; for an unclosed quote that is often the end of the file. This pass
//! knows the line of the opening quote. It also rejects every text that the parser might split into tokens
//! differently, so that the results of [`super::pairs`] about brackets hold for the parser too.

use std::ops::Range;

use super::diagnostic::Diagnostics;
use super::pairs::Punctuation;
use super::problem::Problem;

/// Result of a scan.
#[derive(Default)]
pub struct Scan {
    /// Problems of its quotes, comments and characters.
    pub problems: Vec<Problem>,
    /// Its brackets and commas, except those in texts and comments.
    pub marks: Vec<Punctuation>,
    /// Its comments.
    pub comments: Vec<Range<usize>>,
    /// Number of its words, numbers, texts, opening brackets and commas; a parser makes values of these.
    pub tokens: usize,
    /// Whether `marks` is reliable in spite of `problems`.
    pub certain: bool,
}

/// Scans `text`; stops when it holds more than `most` tokens.
pub fn scan(text: &str, most: usize) -> Scan {
    let mut scanner = Scanner { text, at: 0, misled: false, braces: false, scan: Scan::default() };
    while scanner.step() {
        if scanner.scan.tokens > most {
            let message = format!("the file holds more than {most} words, numbers and marks");
            scanner.report_at(0, message, "gave up here");
            scanner.misled = true;
            break;
        }
        if scanner.scan.problems.len() > Diagnostics::LIMIT {
            scanner.misled = true;
            break;
        }
    }
    scanner.scan.certain = !scanner.misled;
    scanner.scan
}

struct Scanner<'t> {
    text: &'t str,
    at: usize,
    /// A token may have hidden brackets, so that the bracket marks are unreliable.
    misled: bool,
    /// Curly brackets have been reported; one report is enough.
    braces: bool,
    scan: Scan,
}

impl Scanner<'_> {
    /// Consumes one token; false at the end.
    fn step(&mut self) -> bool {
        let rest = &self.text[self.at..];
        let Some(first) = rest.chars().next() else { return false };
        self.scan.tokens +=
            usize::from(first.is_alphanumeric() || matches!(first, '_' | '"' | '(' | '[' | ','));
        match first {
            '"' => self.string(0),
            'r' | 'b' if self.at_boundary() => match string_prefix(rest) {
                Some(prefix) => self.string(prefix),
                None => self.word(),
            },
            '/' if rest.starts_with("//") => {
                let line = rest.lines().next().unwrap_or_default().len();
                self.scan.comments.push(self.at..self.at + line);
                self.at += line;
            }
            '/' if rest.starts_with("/*") => self.block_comment(),
            '(' | '[' | ')' | ']' | ',' => {
                self.scan.marks.push(Punctuation { at: self.at, character: first as u8 });
                self.at += 1;
            }
            '{' | '}' => self.curly_bracket(),
            '\'' | '`' | '‘' | '’' | '“' | '”' | '„' | '«' | '»' => self.wrong_quote(first),
            c if c.is_alphanumeric() || c == '_' => self.word(),
            c if c.is_ascii() => self.at += 1,
            c => {
                self.report_at(
                    c.len_utf8(),
                    format!("the character U+{:04X} can't stand here", c as u32),
                    "",
                );
                self.help(if c.is_whitespace() {
                    "an ordinary space will do"
                } else {
                    "only text in quotes may hold it"
                });
                self.at += c.len_utf8();
            }
        }
        true
    }

    fn report_at(&mut self, length: usize, message: impl Into<String>, expected: &str) {
        self.scan.problems.push(Problem::error(self.at..self.at + length, message).expected(expected));
    }

    fn help(&mut self, help: &str) {
        if let Some(problem) = self.scan.problems.last_mut() {
            problem.help = Some(help.into());
        }
    }

    /// Whether a new token certainly begins here.
    fn at_boundary(&self) -> bool {
        let before = self.text[..self.at].chars().next_back();
        before.is_none_or(|c| c.is_ascii_whitespace() || matches!(c, '(' | '[' | ',' | ':' | '=' | '/'))
    }

    fn word(&mut self) {
        let rest = &self.text[self.at..];
        let is_number = rest.starts_with(|c: char| c.is_ascii_digit());
        let in_word = |c: char| c.is_alphanumeric() || c == '_' || (is_number && c == '.');
        let word = rest.split(|c| !in_word(c)).next().unwrap_or_default();
        if !word.is_ascii() {
            self.report_at(
                word.len(),
                format!("`{word}` can't be a name"),
                "names are made of a-z, A-Z, 0-9 and _",
            );
        }
        // Where the parser would split this in two (`2r"..."`), a quote follows, and the scan rejects that.
        self.at += word.len();
    }

    /// Consumes a text in quotes whose quote stands `prefix` bytes on; the text must end on its line.
    fn string(&mut self, prefix: usize) {
        let start = self.at;
        let line = self.text[start..].lines().next().unwrap_or_default();
        if prefix == 0 && !self.at_boundary() {
            self.report_at(
                1,
                "the quotes on this line don't pair up",
                "text would begin in the middle of something",
            );
            self.misled = true;
            self.at += line.len();
            return;
        }
        let raw = line[..prefix].contains('r');
        let hashes = line[..prefix].matches('#').count();
        if hashes > 8 {
            self.report_at(prefix, "a raw text begins with 8 `#` at most", "");
            self.misled = true;
        }
        let closing = format!("\"{}", "#".repeat(hashes));
        let mut at = prefix + 1;
        while let Some(byte) = line.as_bytes().get(at) {
            if *byte == b'"' && line[at..].starts_with(&closing) {
                self.at = start + at + closing.len();
                return;
            }
            at += if *byte == b'\\' && !raw { 2 } else { 1 };
        }
        let shown = line.trim_end().len();
        self.report_at(
            shown,
            "this text is never closed",
            &format!("expected a closing `{closing}` on this line"),
        );
        self.help("a line break within text is written \\n");
        self.misled = true;
        self.at += line.len();
    }

    /// Comments nest.
    fn block_comment(&mut self) {
        let start = self.at;
        let bytes = self.text.as_bytes();
        let mut depth = 0;
        while let Some(pair) = bytes.get(self.at..self.at + 2) {
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
                self.scan.comments.push(start..self.at);
                return;
            }
        }
        self.at = start;
        self.report_at(2, "this comment is never closed", "expected `*/` further down");
        self.help("comments nest: each `/*` needs its own `*/`");
        self.misled = true;
        self.at = self.text.len();
    }

    fn curly_bracket(&mut self) {
        if !self.braces {
            self.report_at(1, "curly brackets mean nothing here", "expected a round bracket");
            self.help("these files are RON, not JSON: Layout(version: 1, widgets: [(id: \"home\", kind: \"button\")])");
        }
        self.braces = true;
        self.misled = true;
        self.at += 1;
    }

    fn wrong_quote(&mut self, quote: char) {
        let line = self.text[self.at..].lines().next().unwrap_or_default();
        let closes = |c: char| match quote {
            '\'' | '`' => c == quote,
            _ => matches!(c, '‘' | '’' | '“' | '”' | '«' | '»'),
        };
        let end = line.char_indices().skip(1).find(|&(_, c)| closes(c)).map(|(at, c)| at + c.len_utf8());
        self.report_at(
            end.unwrap_or(quote.len_utf8()),
            "text stands in straight double quotes",
            "expected `\"`",
        );
        match end {
            Some(end) => {
                let inner = line[..end].trim_matches(|c| c == quote || closes(c));
                self.help(&format!("write \"{inner}\""));
                self.at += end;
            }
            None => {
                self.misled = true;
                self.at += line.len();
            }
        }
    }
}

/// Returns the number of bytes before the quote of a raw or byte text that begins here; `None` for a plain word.
fn string_prefix(rest: &str) -> Option<usize> {
    let letters = ["br", "r", "b"].into_iter().find(|letters| rest.starts_with(letters))?;
    let hashes =
        if letters == "b" { 0 } else { rest[letters.len()..].bytes().take_while(|b| *b == b'#').count() };
    let prefix = letters.len() + hashes;
    rest[prefix..].starts_with('"').then_some(prefix)
}
