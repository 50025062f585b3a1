//! Divides a line of text into pieces of one direction and one script, in drawing order from left to right.
//!
//! Letters stay in reading order. A painter that shapes each piece and places the pieces beside each other, starting
//! at the left, draws Arabic and Hebrew correctly, also with numbers and Latin words among them.
//!
//! # Source
//! Unicode Standard Annex #9 (bidirectional algorithm), by the crate `unicode-bidi`; Annex #24 (scripts).

use std::borrow::Cow;
use std::ops::Range;

use unicode_bidi::{BidiClass, BidiInfo, Level, bidi_class, get_base_direction};
use unicode_bidi_mirroring::get_mirrored;
use unicode_script::{Script, UnicodeScript};
use unicode_segmentation::UnicodeSegmentation;

/// Order of the parts of a line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TextDirection {
    /// Direction of the line's first letter with a direction; left to right without one.
    #[default]
    OfItsLetters,
    /// Left to right, like Latin.
    LeftToRight,
    /// Right to left, like Arabic and Hebrew.
    RightToLeft,
}

impl TextDirection {
    /// Returns the direction of `text`, which may have several lines: that of its first letter with a direction.
    #[must_use]
    pub fn of(text: &str) -> Self {
        match get_base_direction(text) {
            unicode_bidi::Direction::Rtl => Self::RightToLeft,
            _ => Self::LeftToRight,
        }
    }

    fn level(self) -> Option<Level> {
        match self {
            Self::OfItsLetters => None,
            Self::LeftToRight => Some(Level::ltr()),
            Self::RightToLeft => Some(Level::rtl()),
        }
    }
}

/// Letters to shape together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextPiece<'t> {
    /// The letters in reading order; brackets are already mirrored for display.
    pub text: Cow<'t, str>,
    /// True if the first letter is the rightmost one.
    pub right_to_left: bool,
}

/// The first code point of a right-to-left script: Hebrew starts there. Latin, Greek, Cyrillic and Armenian are below
/// it.
const FIRST_RIGHT_TO_LEFT: char = '\u{590}';

/// Returns the pieces of one line, the leftmost first; none for an empty line.
#[must_use]
pub fn pieces(line: &str, direction: TextDirection) -> Vec<TextPiece<'_>> {
    if direction != TextDirection::RightToLeft && line.chars().all(|letter| letter < FIRST_RIGHT_TO_LEFT) {
        let whole = TextPiece { text: line.into(), right_to_left: false };
        return if line.is_empty() { Vec::new() } else { vec![whole] };
    }
    let bidi = BidiInfo::new(line, direction.level());
    let mut pieces = Vec::new();
    for paragraph in &bidi.paragraphs {
        let (levels, runs) = bidi.visual_runs(paragraph, paragraph.range.clone());
        for run in runs {
            let is_rightwards = levels.get(run.start).is_none_or(Level::is_ltr);
            let text = line.get(run).unwrap_or_default();
            if is_rightwards { rightwards(text, &mut pieces) } else { leftwards(text, &mut pieces) }
        }
    }
    pieces
}

/// Returns the line as a text with its parts in drawing order, for a painter that reverses each Arabic or Hebrew word
/// but keeps the order of the words.
#[must_use]
pub fn in_drawn_order(line: &str) -> Cow<'_, str> {
    let mut pieces = pieces(line, TextDirection::OfItsLetters);
    match pieces.len() {
        0 | 1 => pieces.pop().map_or(Cow::Borrowed(""), |piece| piece.text),
        _ => pieces.iter().map(|piece| &*piece.text).collect::<String>().into(),
    }
}

/// Divides a left-to-right run at changes of script.
fn rightwards<'t>(run: &'t str, pieces: &mut Vec<TextPiece<'t>>) {
    let mut begin = 0;
    let mut script = None;
    for (at, letter) in run.char_indices() {
        let Some(own) = script_of(letter) else { continue };
        if script.is_some_and(|script| script != own) {
            pieces.push(piece(run, begin..at, false));
            begin = at;
        }
        script = Some(own);
    }
    if begin < run.len() {
        pieces.push(piece(run, begin..run.len(), false));
    }
}

/// Divides a right-to-left run into words and the single signs between them, the last one first.
fn leftwards<'t>(run: &'t str, pieces: &mut Vec<TextPiece<'t>>) {
    let mut parts: Vec<(Range<usize>, Option<Script>)> = Vec::new();
    for (at, cluster) in run.grapheme_indices(true) {
        let end = at + cluster.len();
        let letter = cluster.chars().next().filter(|letter| is_letter(*letter));
        let script = letter.map(|letter| script_of(letter).unwrap_or(Script::Common));
        match parts.last_mut() {
            // The elongation stroke and marks have no script of their own.
            Some((part, Some(before)))
                if script.is_some_and(|script| script == *before || script == Script::Common) =>
            {
                part.end = end;
            }
            _ => parts.push((at..end, script)),
        }
    }
    for (part, script) in parts.into_iter().rev() {
        if script.is_some() {
            pieces.push(piece(run, part, true));
        } else {
            let text = run.get(part).unwrap_or_default();
            pieces.push(TextPiece { text: mirrored(text), right_to_left: false });
        }
    }
}

fn piece(run: &str, part: Range<usize>, right_to_left: bool) -> TextPiece<'_> {
    TextPiece { text: run.get(part).unwrap_or_default().into(), right_to_left }
}

/// True for a letter of a right-to-left script, which joins its neighbours.
fn is_letter(letter: char) -> bool {
    matches!(bidi_class(letter), BidiClass::R | BidiClass::AL)
}

/// Script of a letter; `None` for letters of several scripts.
fn script_of(letter: char) -> Option<Script> {
    match letter.script() {
        Script::Common | Script::Inherited | Script::Unknown => None,
        // Japanese mixes three scripts with a common font.
        Script::Hiragana | Script::Katakana => Some(Script::Han),
        script => Some(script),
    }
}

fn mirrored(text: &str) -> Cow<'_, str> {
    if text.chars().any(|letter| get_mirrored(letter).is_some()) {
        text.chars().map(|letter| get_mirrored(letter).unwrap_or(letter)).collect::<String>().into()
    } else {
        text.into()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Pieces in drawing order, the right-to-left ones in angle brackets.
    fn drawn(line: &str, direction: TextDirection) -> Vec<String> {
        let show = |piece: &TextPiece<'_>| {
            if piece.right_to_left { format!("<{}>", piece.text) } else { piece.text.to_string() }
        };
        pieces(line, direction).iter().map(show).collect()
    }

    fn by_itself(line: &str) -> Vec<String> {
        drawn(line, TextDirection::OfItsLetters)
    }

    #[test]
    fn a_line_without_foreign_letters_is_one_piece() {
        assert_eq!(by_itself("Zoom 12 %"), ["Zoom 12 %"]);
        assert_eq!(by_itself("Žluť, Дом"), ["Žluť, Дом"]);
        assert_eq!(by_itself(""), Vec::<String>::new());
    }

    #[test]
    fn the_first_word_of_hebrew_and_arabic_is_the_rightmost_one() {
        assert_eq!(by_itself("בית חדש"), ["<חדש>", " ", "<בית>"]);
        assert_eq!(by_itself("منزل جديد"), ["<جديد>", " ", "<منزل>"]);
    }

    #[test]
    fn numbers_and_latin_words_among_them_keep_their_own_order() {
        // "Room 12 B" in Hebrew: the number is left of the word, with its digits in order.
        assert_eq!(by_itself("חדר 12"), ["12", " ", "<חדר>"]);
        assert_eq!(by_itself("تكبير Zoom 2x"), ["Zoom 2x", " ", "<تكبير>"]);
        // In a Latin line only the Hebrew words change places.
        assert_eq!(by_itself("Go בית חדש now"), ["Go ", "<חדש>", " ", "<בית>", " now"]);
    }

    #[test]
    fn brackets_and_signs_at_the_end_are_where_readers_expect_them() {
        assert_eq!(by_itself("בית (2)!"), ["!", "(", "2", ")", " ", "<בית>"]);
        assert_eq!(by_itself("«بيت»"), ["«", "<بيت>", "»"]);
        assert_eq!(by_itself("בית…"), ["…", "<בית>"]);
    }

    #[test]
    fn a_line_of_a_longer_text_follows_the_direction_of_the_whole() {
        let whole = "הגדל Zoom פי 2";
        assert_eq!(TextDirection::of(whole), TextDirection::RightToLeft);
        assert_eq!(drawn("Zoom פי 2", TextDirection::of(whole)), ["2", " ", "<פי>", " ", "Zoom"]);
        assert_eq!(drawn("12 %", TextDirection::RightToLeft), ["%", " ", "12"]);
        assert_eq!(TextDirection::of("12 %"), TextDirection::LeftToRight);
    }

    #[test]
    fn scripts_from_left_to_right_are_told_apart() {
        assert_eq!(by_itself("घर Home"), ["घर ", "Home"]);
        assert_eq!(by_itself("Đường, Дом"), ["Đường, ", "Дом"]);
        assert_eq!(by_itself("บ้าน 2"), ["บ้าน 2"]);
        assert_eq!(by_itself("地図ホームへ"), ["地図ホームへ"]);
        assert_eq!(by_itself("🏠 首页"), ["🏠 首页"]);
    }

    #[test]
    fn marks_and_joining_signs_stay_with_their_letters() {
        assert_eq!(by_itself("שָׁלוֹם"), ["<שָׁלוֹם>"]);
        assert_eq!(by_itself("بـيـت"), ["<بـيـت>"]);
        // Persian, with a zero-width non-joiner.
        assert_eq!(by_itself("می\u{200c}روم"), ["<می\u{200c}روم>"]);
    }

    #[test]
    fn a_text_in_drawn_order_is_one_string() {
        assert_eq!(in_drawn_order("Zoom"), "Zoom");
        assert!(matches!(in_drawn_order("Zoom"), Cow::Borrowed(_)));
        assert_eq!(in_drawn_order("חדר 12"), "12 חדר");
        assert_eq!(in_drawn_order(""), "");
    }

    proptest! {
        #[test]
        fn every_letter_is_in_one_piece(line in "[ a-z0-9()«»،א-ת\u{5b0}-\u{5bd}\u{627}-\u{64a}\u{64b}-\u{652}ก-ู\u{915}-\u{94d}首页ホ🏠‍…]{0,40}") {
            let sorted = |text: &mut dyn Iterator<Item = char>| {
                let mut all: Vec<char> = text.map(|letter| get_mirrored(letter).map_or(letter, |it| it.min(letter))).collect();
                all.sort_unstable();
                all
            };
            for direction in [TextDirection::OfItsLetters, TextDirection::LeftToRight, TextDirection::RightToLeft] {
                let pieces = pieces(&line, direction);
                let mut drawn = pieces.iter().flat_map(|piece| piece.text.chars());
                prop_assert_eq!(sorted(&mut drawn), sorted(&mut line.chars()));
                prop_assert!(pieces.iter().all(|piece| !piece.text.is_empty()));
            }
        }
    }
}
