//! A generated text in place of one that somebody has written: what stands between the values stays.

/// `new` with the comments and the spacing of `old`, where both have the same parts in the same order and differ in
/// their values only; otherwise `new` after the comments at the head of `old`.
///
/// Both are RON. A value is what stands alone: a number, a string, a name.
#[must_use]
pub fn keep_comments(old: &str, new: &str) -> String {
    let (before, after) = (pieces(old), pieces(new));
    let shape = |pieces: &[Piece<'_>]| -> Vec<String> { pieces.iter().map(Piece::shape).collect() };
    if before.len() == after.len() && shape(&before) == shape(&after) {
        let mut text = String::with_capacity(old.len());
        for (before, after) in before.iter().zip(&after) {
            text.push_str(before.space);
            text.push_str(after.token);
        }
        text.push_str(&old[end(old, &before)..]);
        return text;
    }
    let head = before.first().map_or("", |piece| piece.space);
    if head.trim().is_empty() { new.to_owned() } else { format!("{head}{}", new.trim_start()) }
}

/// A token and what stands before it.
struct Piece<'a> {
    space: &'a str,
    token: &'a str,
    /// Whether a colon follows: it is a field's name.
    named: bool,
}

impl Piece<'_> {
    /// What has to be alike for one to take the other's place: punctuation and names of fields are themselves, values
    /// are of a sort.
    fn shape(&self) -> String {
        let first = self.token.chars().next().unwrap_or(' ');
        match first {
            _ if self.named => format!("{}:", self.token),
            '"' => "string".into(),
            '0'..='9' | '-' | '+' | '.' => "number".into(),
            _ => self.token.to_owned(),
        }
    }
}

/// Where the last token of `text` ends.
fn end(text: &str, pieces: &[Piece<'_>]) -> usize {
    pieces.iter().map(|piece| piece.space.len() + piece.token.len()).sum::<usize>().min(text.len())
}

fn pieces(text: &str) -> Vec<Piece<'_>> {
    let mut pieces: Vec<Piece<'_>> = Vec::new();
    let mut at = 0;
    loop {
        let space = space_length(&text[at..]);
        let token = token_length(&text[at + space..]);
        if token == 0 {
            return pieces;
        }
        let piece = Piece {
            space: &text[at..at + space],
            token: &text[at + space..at + space + token],
            named: false,
        };
        if let (":", Some(last)) = (piece.token, pieces.last_mut()) {
            last.named = true;
        }
        pieces.push(piece);
        at += space + token;
    }
}

/// Length of white space and comments at the beginning of `text`; what never ends goes to its end.
fn space_length(text: &str) -> usize {
    let mut rest = text;
    loop {
        rest = rest.trim_start();
        if rest.starts_with("//") {
            rest = rest.find('\n').map_or("", |end| &rest[end..]);
        } else if rest.starts_with("/*") {
            let mut depth = 0_u32;
            let mut at = 0;
            loop {
                if rest[at..].starts_with("/*") {
                    (depth, at) = (depth + 1, at + 2);
                } else if rest[at..].starts_with("*/") {
                    (depth, at) = (depth - 1, at + 2);
                } else {
                    at += rest[at..].chars().next().map_or(0, char::len_utf8);
                }
                if depth == 0 || at >= rest.len() {
                    break;
                }
            }
            rest = &rest[at..];
        } else {
            return text.len() - rest.len();
        }
    }
}

/// Length of the token that `text` begins with; 0 at its end.
fn token_length(text: &str) -> usize {
    let is_word = |letter: char| letter.is_alphanumeric() || matches!(letter, '_' | '.' | '-' | '+' | '#');
    match text.chars().next() {
        None => 0,
        Some('"') => {
            let mut escaped = false;
            let close = text.char_indices().skip(1).find(|(_, letter)| {
                let closes = *letter == '"' && !escaped;
                escaped = *letter == '\\' && !escaped;
                closes
            });
            close.map_or(text.len(), |(at, _)| at + 1)
        }
        Some(letter) if is_word(letter) => text.find(|letter| !is_word(letter)).unwrap_or(text.len()),
        Some(letter) => letter.len_utf8(),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const OLD: &str = "// Like a light switch.\nEffect(\n    version: 1, // the format\n    click: Click(level_n: 4.5, name: \"a \\\" b\"), /* as measured */\n)\n// end\n";

    #[test]
    fn a_changed_number_changes_nothing_else() {
        let new = "Effect(version: 1, click: Click(level_n: 12, name: \"c\"),)";
        let expected = OLD.replace("4.5", "12").replace("a \\\" b", "c");
        assert_eq!(keep_comments(OLD, new), expected);
    }

    #[test]
    fn another_structure_keeps_the_head() {
        let new = "Effect(version: 1, tone: Tone(hz: 80))\n";
        assert_eq!(keep_comments(OLD, new), format!("// Like a light switch.\n{new}"));
        assert_eq!(keep_comments("", new), new);
    }

    proptest! {
        #[test]
        fn a_text_in_place_of_itself_is_itself_and_no_text_panics(text in "[a-z0-9 .:,()/*\"\\\\\n\u{e4}-]{0,60}") {
            prop_assert_eq!(keep_comments(&text, &text), text);
        }
    }
}
