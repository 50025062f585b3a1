//! Pairing of brackets, and the entry that holds a place.

use std::ops::Range;

use super::problem::Problem;

/// Limits on the content of one file.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Nesting of brackets; bounds the stack of the parser.
    pub depth: usize,
    /// Entries of one list.
    pub entries: usize,
    /// Words, numbers, texts, opening brackets and commas in the whole file; bounds the memory of the parser.
    pub tokens: usize,
}

impl Limits {
    /// For layouts and kinds.
    pub const LAYOUT: Self = Self { depth: 64, entries: 4096, tokens: 500_000 };

    /// For floors, which list every sensor.
    pub const FLOOR: Self = Self { entries: 262_144, tokens: 1_200_000, ..Self::LAYOUT };
}

/// A round or square bracket or a comma.
#[derive(Clone, Copy, Debug)]
pub struct Punctuation {
    /// Its byte in the text.
    pub at: usize,
    /// The bracket or comma.
    pub character: u8,
}

/// A bracket not yet closed.
#[derive(Clone, Copy)]
struct Open {
    bracket: u8,
    at: usize,
    commas: usize,
}

impl Open {
    fn closed_by(&self, character: u8) -> bool {
        matches!((self.bracket, character), (b'(', b')') | (b'[', b']'))
    }
}

/// Maximum number of problems reported about brackets: after the first few, most are consequences.
const MOST: usize = 20;

/// Checks the brackets of `text` and returns their problems.
pub fn check(text: &str, marks: &[Punctuation], limits: Limits) -> Vec<Problem> {
    let mut problems = Vec::new();
    let mut open: Vec<Open> = Vec::new();
    for (index, &Punctuation { at, character }) in marks.iter().enumerate() {
        let here = at..at + 1;
        match character {
            b'(' | b'[' if open.len() == limits.depth => {
                let message = format!("brackets nest deeper than {}", limits.depth);
                problems.push(Problem::error(here, message).expected("one bracket too many"));
                return problems;
            }
            b'(' | b'[' => open.push(Open { bracket: character, at, commas: 0 }),
            b',' => {
                let Some(list) = open.last_mut() else { continue };
                list.commas += 1;
                if list.bracket == b'[' && list.commas > limits.entries {
                    let message = format!("this list has more than {} entries", limits.entries);
                    problems.push(Problem::error(list.at..list.at + 1, message).expected("begins here"));
                    return problems;
                }
            }
            _ if open.last().is_some_and(|last| last.closed_by(character)) => {
                open.pop();
            }
            _ => {
                problems.push(mend(text, &mut open, &marks[index..]));
                if problems.len() == MOST {
                    return problems;
                }
            }
        }
    }
    if let Some(inner) = open.last() {
        let help = match open.len() {
            1 => "the file ends before it is closed: was it saved half-way?".to_owned(),
            open => format!("the file ends with {open} brackets open: was it saved half-way?"),
        };
        problems.push(never_closed(inner).help(help));
    }
    problems
}

/// Finds the error where the first of `rest` closes another bracket than the one opened last.
///
/// Either that bracket was never closed, or this one is surplus: the function chooses the repair with which more of
/// the rest of the file pairs up.
fn mend(text: &str, open: &mut Vec<Open>, rest: &[Punctuation]) -> Problem {
    let Some((closing, rest)) = rest.split_first() else { return Problem::error(0..0, "") };
    let matching = open.iter().rposition(|bracket| bracket.closed_by(closing.character));
    if let (Some(matching), Some(inner)) = (matching, open.last().copied())
        && horizon(&open[..matching], rest) >= horizon(open, rest)
    {
        let outer = char::from(open[matching].bracket);
        open.truncate(matching);
        let line = text[..closing.at].matches('\n').count() + 1;
        let closer = char::from(closing.character);
        return never_closed(&inner)
            .help(format!("line {line} closes the `{outer}` around it with `{closer}`"));
    }
    let message = format!("this `{}` closes nothing", char::from(closing.character));
    Problem::error(closing.at..closing.at + 1, message).expected("one bracket too many")
}

/// Counts the marks of `rest` that pair up with the `open` brackets; all and one more if no bracket stays open.
fn horizon(open: &[Open], rest: &[Punctuation]) -> usize {
    let mut open: Vec<u8> = open.iter().map(|bracket| bracket.bracket).collect();
    for (index, mark) in rest.iter().enumerate() {
        match (mark.character, open.last()) {
            (b'(' | b'[', _) => open.push(mark.character),
            (b',', _) => {}
            (b')', Some(b'(')) | (b']', Some(b'[')) => {
                open.pop();
            }
            _ => return index,
        }
    }
    rest.len() + usize::from(open.is_empty())
}

fn never_closed(open: &Open) -> Problem {
    let closing = if open.bracket == b'(' { ')' } else { ']' };
    let message = format!("this `{}` is never closed", char::from(open.bracket));
    Problem::error(open.at..open.at + 1, message).expected(format!("expected a `{closing}` further down"))
}

/// Returns the entry of a list, tuple or struct that holds the byte at `offset`, with the comma behind it.
///
/// `None` outside of all brackets. The brackets must pair up.
pub fn entry_around(marks: &[Punctuation], offset: usize) -> Option<Range<usize>> {
    let here = marks.partition_point(|mark| mark.at < offset);
    let before = end_of_entry(marks[..here].iter().rev(), *b")]")?;
    let after = end_of_entry(marks[here..].iter(), *b"([")?;
    Some(before.at + 1..after.at + usize::from(after.character == b','))
}

/// Returns the first comma or bracket along `marks` that ends an entry; skips pairs that begin with one of `inner`.
fn end_of_entry<'m>(
    mut marks: impl Iterator<Item = &'m Punctuation>,
    inner: [u8; 2],
) -> Option<&'m Punctuation> {
    let mut depth = 0;
    marks.find(|mark| match mark.character {
        character if inner.contains(&character) => {
            depth += 1;
            false
        }
        b',' => depth == 0,
        _ if depth == 0 => true,
        _ => {
            depth -= 1;
            false
        }
    })
}

#[cfg(test)]
mod tests {
    use super::super::scan::scan;
    use super::*;

    fn problems(text: &str) -> Vec<(String, Range<usize>)> {
        let found = check(text, &scan(text, 1000).marks, Limits::LAYOUT);
        found.into_iter().map(|problem| (problem.message, problem.span)).collect()
    }

    #[test]
    fn a_bracket_too_many_is_told_from_one_missing() {
        assert_eq!(problems("(a: [(1, 2)], b: [3])"), []);
        assert_eq!(problems("(a: [(1, 2))], b: [3])"), [("this `)` closes nothing".into(), 11..12)]);
        assert_eq!(problems("(a: [(1, 2], b: [3])"), [("this `(` is never closed".into(), 5..6)]);
        assert_eq!(problems("(a: [(1, 2), b: [3])"), [("this `[` is never closed".into(), 4..5)]);
        assert_eq!(problems("(a: [(1, 2)"), [("this `[` is never closed".into(), 4..5)]);
        assert_eq!(problems("())"), [("this `)` closes nothing".into(), 2..3)]);
    }

    #[test]
    fn brackets_in_texts_and_comments_don_t_count() {
        assert_eq!(problems("(a: \"((\", /* ( /* [ */ */ b: r#\"\"]\"#, c: b\"(\") // ]"), []);
    }

    #[test]
    fn nesting_and_lists_are_bounded() {
        let nested = |depth| format!("{}{}", "[".repeat(depth), "]".repeat(depth));
        assert_eq!(problems(&nested(64)), []);
        assert_eq!(problems(&nested(65)), [("brackets nest deeper than 64".into(), 64..65)]);
        // A million brackets need no deeper stack.
        let bottomless = "(".repeat(1_000_000);
        let marks = scan(&bottomless, 2_000_000).marks;
        assert_eq!(check(&bottomless, &marks, Limits::LAYOUT).len(), 1);

        let list = format!("[{}]", "1,".repeat(5000));
        let marks = scan(&list, 10_000).marks;
        let found = check(&list, &marks, Limits::LAYOUT);
        assert_eq!(found[0].message, "this list has more than 4096 entries");
    }

    #[test]
    fn entries_reach_from_comma_to_comma_of_the_same_bracket() {
        let text = "(a: (1, 2), b: [(3, 4), (5)], c)";
        let marks = scan(text, 100).marks;
        let entry = |word: &str| entry_around(&marks, text.find(word).unwrap()).map(|range| &text[range]);
        assert_eq!(entry("a"), Some("a: (1, 2),"));
        assert_eq!(entry("2"), Some(" 2"));
        assert_eq!(entry("b"), Some(" b: [(3, 4), (5)],"));
        assert_eq!(entry("(3"), Some("(3, 4),"));
        assert_eq!(entry("c"), Some(" c"));
        assert_eq!(entry_around(&marks, 0), None);
        assert_eq!(entry_around(&marks, text.len()), None);
    }
}
