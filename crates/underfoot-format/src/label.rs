//! Valid characters of labels and names from all sources: files, the network, apps.
//!
//! Characters that control a terminal, change the direction of writing, or are invisible are removed, so that no
//! label imitates another. Characters that scripts and emoji need stay: right-to-left letters, joiners between
//! letters that join, variation selectors, the tags of flags.

use std::borrow::Cow;

use unicode_properties::{GeneralCategory, UnicodeEmoji, UnicodeGeneralCategory};

/// Maximum number of characters of a label.
pub const MAX_LABEL: usize = 64;

/// A character that is invalid in a label.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unfit {
    /// Its place in the text, in bytes.
    pub at: usize,
    /// The character.
    pub character: char,
}

/// Returns the first character of `text` that is invalid in a label; `None` if the text is a valid label.
#[must_use]
pub fn first_unfit(text: &str) -> Option<Unfit> {
    let mut before = None;
    text.char_indices().find_map(|(at, character)| {
        let is_fit = is_fit(character, before);
        before = Some(character);
        (!is_fit).then_some(Unfit { at, character })
    })
}

/// Returns `text` without the characters that are invalid in a label, and at most `longest` of the others.
#[must_use]
pub fn cleaned(text: &str, longest: usize) -> Cow<'_, str> {
    if first_unfit(text).is_none() && text.chars().nth(longest).is_none() {
        return text.into();
    }
    let mut before = None;
    let fit = text.chars().filter(|&character| {
        let is_fit = is_fit(character, before);
        before = if is_fit { Some(character) } else { before };
        is_fit
    });
    fit.take(longest).collect::<String>().into()
}

/// Describes an unfit character for messages: its kind and its number.
pub fn describe(character: char) -> String {
    let kind = match character {
        _ if character.is_control() => "a control character",
        '\u{2028}' | '\u{2029}' => "a line break",
        '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => {
            "a character that changes the direction of writing"
        }
        _ => "a character that is not seen",
    };
    format!("{kind} (U+{:04X})", u32::from(character))
}

/// Whether a label may contain `character` after `before`.
///
/// # Source
/// General categories of the Unicode Character Database; property Default_Ignorable_Code_Point for invisible
/// characters; Unicode Standard, 23.2 for joiners, 23.4 for variation selectors; Unicode Technical Standard 51 for
/// emoji.
fn is_fit(character: char, before: Option<char>) -> bool {
    let follows = |holds: fn(char) -> bool| before.is_some_and(holds);
    match character {
        // Joiners between Arabic and Indic letters; the second one also between emoji.
        '\u{200c}' => follows(joins),
        '\u{200d}' => follows(joins) || follows(is_pictorial),
        '\u{fe00}'..='\u{fe0f}' => follows(varies),
        '\u{e0100}'..='\u{e01ef}' => follows(|before| before >= '\u{3400}'),
        '\u{180b}'..='\u{180f}' => follows(|before| matches!(before, '\u{1800}'..='\u{18af}')),
        // The tags of flags such as that of Wales.
        '\u{e0020}'..='\u{e007f}' => {
            follows(|before| matches!(before, '\u{1f3f4}' | '\u{e0020}'..='\u{e007e}'))
        }
        _ => !is_hidden(character),
    }
}

/// Whether `character` is invisible everywhere, or changes the appearance of others.
pub fn is_hidden(character: char) -> bool {
    match character {
        // Signs that span digits in Arabic, Syriac and Kaithi are visible.
        '\u{600}'..='\u{605}'
        | '\u{6dd}'
        | '\u{70f}'
        | '\u{890}'..='\u{891}'
        | '\u{8e2}'
        | '\u{110bd}'
        | '\u{110cd}' => false,
        // Invisible letters, marks and reserved code points.
        '\u{34f}'
        | '\u{115f}'
        | '\u{1160}'
        | '\u{17b4}'
        | '\u{17b5}'
        | '\u{180b}'..='\u{180f}'
        | '\u{2060}'..='\u{206f}'
        | '\u{3164}'
        | '\u{fe00}'..='\u{fe0f}'
        | '\u{ffa0}'
        | '\u{fff0}'..='\u{fffb}'
        | '\u{e0000}'..='\u{e0fff}' => true,
        _ if is_noncharacter(character) => true,
        _ => matches!(
            character.general_category(),
            GeneralCategory::Control
                | GeneralCategory::Format
                | GeneralCategory::LineSeparator
                | GeneralCategory::ParagraphSeparator
        ),
    }
}

fn is_noncharacter(character: char) -> bool {
    matches!(character, '\u{fdd0}'..='\u{fdef}') || u32::from(character) & 0xFFFE == 0xFFFE
}

/// Whether joiners after `before` change the shape of letters: in scripts with joining letters or a virama.
fn joins(before: char) -> bool {
    matches!(
        before,
        '\u{600}'..='\u{77f}'
            | '\u{7c0}'..='\u{7ff}'
            | '\u{840}'..='\u{dff}'
            | '\u{f00}'..='\u{109f}'
            | '\u{1700}'..='\u{1cff}'
            | '\u{a840}'..='\u{a8ff}'
            | '\u{a930}'..='\u{aaff}'
            | '\u{abc0}'..='\u{abff}'
            | '\u{fb50}'..='\u{fdff}'
            | '\u{fe70}'..='\u{fefc}'
            | '\u{10a00}'..='\u{11fff}'
            | '\u{1e900}'..='\u{1e95f}'
    )
}

/// Whether `before` can be a part of a composed emoji.
fn is_pictorial(before: char) -> bool {
    before == '\u{fe0f}' || (before > '\u{a8}' && before.is_emoji_char())
}

/// Whether variation selectors after `before` change its appearance.
fn varies(before: char) -> bool {
    before.is_emoji_char() || before >= '\u{2190}'
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn labels_of_people_stay_as_they_are() {
        for label in [
            "Zoom in",
            "Größe",
            "放大",
            "ズーム",
            "확대",
            "ขยาย",
            "הגדל",
            "تكبير",
            // Persian and Hindi with joiners, and an Arabic abbreviation.
            "نمی‌خواهم",
            "कर्\u{200d}ता",
            "ह\u{94d}\u{200c}ल",
            "ه\u{200d}",
            // A number sign in Arabic, Mongolian with a variant, and a Japanese name with one.
            "\u{601}٢٠",
            "ᠮ\u{180b}",
            "葛\u{e0100}",
            "❤\u{fe0f}",
            "1\u{fe0f}\u{20e3}",
            "👩\u{200d}⚕\u{fe0f}",
            "🏳\u{fe0f}\u{200d}🌈",
            "👩🏽\u{200d}🚀",
            "🏴\u{e0067}\u{e0062}\u{e0077}\u{e006c}\u{e0073}\u{e007f}",
            "e\u{301}",
            "5 µm",
            "",
        ] {
            assert_eq!(first_unfit(label), None, "{label:?}");
            assert_eq!(cleaned(label, MAX_LABEL), label);
        }
    }

    #[test]
    fn tricks_are_taken_out() {
        for (trick, seen) in [
            ("Al\u{202e}arm", "Alarm"),
            ("\u{2066}on\u{2069}", "on"),
            ("o\u{200e}n\u{200f}\u{61c}", "on"),
            ("\u{1b}[31mred", "[31mred"),
            ("two\nlines\ttabs\r", "twolinestabs"),
            ("two\u{2028}lines\u{2029}", "twolines"),
            ("\u{85}\u{9b}31m\u{7f}", "31m"),
            ("st\u{200b}op\u{feff}\u{2060}\u{ad}\u{34f}", "stop"),
            // Joiners, selectors and tags in places where they have no effect.
            ("st\u{200d}o\u{200c}p\u{fe0f}", "stop"),
            ("\u{200d}a", "a"),
            ("ک\u{200c}\u{200c}ا", "ک\u{200c}ا"),
            ("on\u{e0067}\u{e007f}\u{e0001}", "on"),
            ("\u{3164}\u{115f}a\u{ffa0}", "a"),
            ("a\u{fff9}b\u{fffa}c\u{fffb}", "abc"),
            ("a\u{ffff}\u{fdd0}b", "ab"),
        ] {
            assert_eq!(cleaned(trick, MAX_LABEL), seen, "{trick:?}");
            assert!(first_unfit(trick).is_some(), "{trick:?}");
        }
    }

    #[test]
    fn a_place_and_a_kind_are_named() {
        let unfit = first_unfit("Größe\u{202e}x").unwrap();
        assert_eq!(unfit.at, "Größe".len());
        assert_eq!(describe(unfit.character), "a character that changes the direction of writing (U+202E)");
        assert_eq!(describe('\u{1b}'), "a control character (U+001B)");
        assert_eq!(describe('\u{200b}'), "a character that is not seen (U+200B)");
    }

    #[test]
    fn a_text_that_is_too_long_is_cut_at_a_character() {
        assert_eq!(cleaned(&"ß".repeat(65), 64), "ß".repeat(64));
        assert_eq!(cleaned("\u{200b}abc", 3), "abc");
    }

    proptest! {
        #[test]
        fn what_is_cleaned_is_fit(text in any::<String>(), longest in 0_usize..80) {
            let clean = cleaned(&text, longest);
            prop_assert_eq!(first_unfit(&clean), None);
            prop_assert!(clean.chars().count() <= longest);
            prop_assert_eq!(cleaned(&clean, longest), clean.as_ref());
        }

        #[test]
        fn no_control_or_direction_character_passes(
            tricks in prop::collection::vec(
                prop::sample::select(&[
                    '\u{202a}', '\u{202e}', '\u{2066}', '\u{2069}', '\u{200e}', '\u{200b}', '\u{200c}', '\u{200d}', '\n',
                    '\u{1b}', '\u{9b}', '\u{2028}', '\u{fe0f}', 'a', 'ب', 'क', '😀',
                ][..]),
                0..12,
            ),
        ) {
            let text: String = tricks.into_iter().collect();
            let clean = cleaned(&text, 64);
            let turns = |c: char| matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
            let found = clean.chars().find(|&c| c.is_control() || turns(c));
            prop_assert_eq!(found, None);
        }
    }
}
