//! The line of a file that a message shows.

use std::ops::Range;

use unicode_width::UnicodeWidthStr;

use crate::label::is_hidden;

/// Maximum number of characters of a line that are shown.
const WIDTH: usize = 160;

/// Number of characters shown before the place in a line that was cut.
const LEAD: usize = 60;

/// The part of a line that is shown, and the columns of the carets.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Excerpt {
    /// The text shown: tabs as spaces, control characters replaced.
    pub(crate) text: String,
    /// Terminal columns of `text` above the carets, from 0.
    marked: Range<usize>,
}

impl Excerpt {
    /// Cuts `line` so that its bytes `marked` are visible; places beyond the line mark its end.
    pub(crate) fn of(line: &str, marked: Range<usize>) -> Self {
        let start = line.floor_char_boundary(marked.start);
        let end = line.floor_char_boundary(marked.end).max(start);
        let from = if line.len() <= WIDTH { 0 } else { back(line, start, LEAD) };
        let to = forth(line, from, WIDTH);

        let mut text = String::new();
        if from > 0 {
            text.push('…');
        }
        show(&line[from..start.min(to)], &mut text);
        let first = text.width();
        show(&line[start.min(to)..end.min(to)], &mut text);
        let last = text.width();
        show(&line[end.min(to)..to], &mut text);
        if to < line.len() {
            text.push('…');
        }
        Self { text, marked: first..last.max(first + 1) }
    }

    /// Returns the spaces and the carets of the line under `text`.
    pub(crate) fn carets(&self) -> (String, String) {
        (" ".repeat(self.marked.start), "^".repeat(self.marked.len()))
    }
}

/// Returns the place `count` characters before `at`.
fn back(line: &str, at: usize, count: usize) -> usize {
    line[..at].char_indices().rev().take(count).last().map_or(at, |(place, _)| place)
}

/// Returns the place `count` characters after `at`.
fn forth(line: &str, at: usize, count: usize) -> usize {
    line[at..].char_indices().nth(count).map_or(line.len(), |(offset, _)| at + offset)
}

/// Appends `part` with tabs as four spaces and hidden characters replaced.
fn show(part: &str, text: &mut String) {
    for character in part.chars() {
        match character {
            '\t' => text.push_str("    "),
            c if is_hidden(c) && !matches!(c, '\u{200c}' | '\u{200d}' | '\u{fe0f}') => text.push('\u{fffd}'),
            c => text.push(c),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn under(excerpt: &Excerpt) -> String {
        let (indent, carets) = excerpt.carets();
        indent + &carets
    }

    #[test]
    fn carets_stand_under_the_marked_characters_also_behind_tabs_and_accents() {
        let line = "\tlabel: \"Größe\", x";
        let at = line.find('"').unwrap();
        let excerpt = Excerpt::of(line, at..line.find(',').unwrap());
        assert_eq!(excerpt.text, "    label: \"Größe\", x");
        assert_eq!(under(&excerpt), "           ^^^^^^^");

        // Chinese characters are two columns wide.
        let line = "label: \"放大\", prss_n: 60";
        let at = line.find("prss").unwrap();
        let excerpt = Excerpt::of(line, at..at + 6);
        assert_eq!(under(&excerpt), "               ^^^^^^");
    }

    #[test]
    fn a_line_of_a_megabyte_is_cut_around_the_place() {
        let line = format!("{}HERE{}", "a".repeat(600_000), "b".repeat(400_000));
        let excerpt = Excerpt::of(&line, 600_000..600_004);
        assert!(excerpt.text.chars().count() <= WIDTH + 2);
        let marked: String = excerpt.text.chars().skip(under(&excerpt).len() - 4).take(4).collect();
        assert_eq!(marked, "HERE");
        assert!(excerpt.text.starts_with('…') && excerpt.text.ends_with('…'));
    }

    #[test]
    fn the_end_of_a_line_gets_one_caret() {
        assert_eq!(under(&Excerpt::of("abc", 3..3)), "   ^");
        assert_eq!(under(&Excerpt::of("", 0..0)), "^");
    }
}
