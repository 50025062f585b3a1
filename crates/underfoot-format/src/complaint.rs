//! Errors of the parser in the words of layout authors, and the character that repairs each.

use std::ops::Range;

use ron2::error::ErrorKind;

use super::problem::Problem;

/// An error of the parser, and the repair after which parsing can go on.
pub(crate) struct Complaint {
    pub(crate) problem: Problem,
    /// Place and character of the repair; `None` if only a person can decide.
    pub(crate) repair: Option<(usize, u8)>,
}

impl From<Problem> for Complaint {
    fn from(problem: Problem) -> Self {
        Self { problem, repair: None }
    }
}

/// Restates the error of the parser at `span` of `text` in the words of layout authors.
pub(crate) fn rephrase(text: &str, span: &Range<usize>, kind: &ErrorKind) -> Complaint {
    let start = text.floor_char_boundary(span.start);
    let (before, rest) = text.split_at(start);
    let word = leading_word(rest);
    let here = start..start + word.len().max(rest.chars().next().map_or(0, char::len_utf8));
    if let Some(complaint) = by_character(rest, &here) {
        return complaint;
    }
    let expected = match kind {
        ErrorKind::Expected { expected, .. } => &**expected,
        _ => "",
    };
    let problem = match kind {
        _ if expected == "comma" || expected.starts_with("closing") => return missing_comma(before, here),
        _ if expected.contains("after map key") => {
            Problem::error(here, format!("`{word}` has no value")).expected(format!("expected `{word}: ...`"))
        }
        _ if expected == "value" => Problem::error(field_before(before), "this field has no value")
            .expected("expected a value after the colon"),
        _ if expected == "identifier" => {
            Problem::error(here, "the name of a field is missing").expected("expected `name: value`")
        }
        ErrorKind::TrailingCharacters => Problem::error(here, "the file goes on after its end")
            .expected("expected nothing more")
            .help("a file holds one thing, such as one Layout(...)"),
        ErrorKind::UnexpectedChar(character) => {
            Problem::error(here, format!("`{character}` can't stand here")).expected("expected a value")
        }
        ErrorKind::InvalidEscape(_) => Problem::error(start..span.end.max(start), "text has no such escape")
            .expected("what does this `\\` do?")
            .help("a backslash itself is written \\\\, a quote \\\", a line break \\n"),
        other => Problem::error(span.clone(), other.to_string().to_lowercase()),
    };
    problem.into()
}

/// Errors that the character at the place explains better than the parser does.
fn by_character(rest: &str, here: &Range<usize>) -> Option<Complaint> {
    let problem = |message: &str| Problem::error(here.clone(), message);
    let (problem, meant) = match rest.chars().next()? {
        '=' => (problem("a field and its value are joined by a colon").expected("expected `:`"), Some(b':')),
        ';' => (problem("fields and entries are separated by commas").expected("expected `,`"), Some(b',')),
        ',' => (problem("there is nothing before this comma").expected("one comma too many"), Some(b' ')),
        '.' => {
            let problem =
                problem("a number needs digits on both sides of its point").expected("no digits on one side");
            (problem.help("write 0.5 rather than .5, and 2 or 2.0 rather than 2."), None)
        }
        '#' => (problem("colours stand in quotes").expected("expected text").help("write \"#d8e4f0\""), None),
        _ => return None,
    };
    Some(Complaint { problem, repair: meant.map(|character| (here.start, character)) })
}

/// Two things in a row: a name and its value without a colon, or two entries without a comma.
fn missing_comma(before: &str, here: Range<usize>) -> Complaint {
    let name = trailing_word(before.trim_end());
    let opening = before.trim_end().trim_end_matches(name).trim_end();
    let is_name = opening.ends_with(['(', ',']) && name.starts_with(|c: char| c.is_ascii_lowercase());
    // A line break may end a comment; the repair must not end up inside that comment.
    let room = before.ends_with([' ', '\t']).then(|| here.start.saturating_sub(1));
    let (problem, meant) = if is_name {
        let problem = Problem::error(here, format!("`{name}` and its value are joined by a colon"));
        (problem.expected("expected `:` before this"), b':')
    } else {
        (Problem::error(here, "a comma is missing").expected("expected `,` before this"), b',')
    };
    Complaint { problem, repair: room.map(|at| (at, meant)) }
}

/// Returns the name and colon at the end of `before`.
fn field_before(before: &str) -> Range<usize> {
    let head = before.trim_end();
    let name = head.trim_end_matches(':').trim_end();
    name.len() - trailing_word(name).len()..head.len()
}

fn leading_word(text: &str) -> &str {
    text.split(is_no_word).next().unwrap_or_default()
}

fn trailing_word(text: &str) -> &str {
    text.rsplit(is_no_word).next().unwrap_or_default()
}

fn is_no_word(c: char) -> bool {
    !c.is_alphanumeric() && c != '_'
}
