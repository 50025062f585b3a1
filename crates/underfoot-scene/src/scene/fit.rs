//! Breaks labels into lines and sizes them to fit.

use std::ops::Range;

use arrayvec::ArrayVec;
use glam::Vec2;
use unicode_linebreak::linebreaks;
use unicode_segmentation::UnicodeSegmentation;

use super::widths::{LINE_HEIGHT, width};

/// Maximum number of lines of a label.
pub(super) const MAX_LINES: usize = 3;

/// Layout of a label that fits.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Fitted {
    /// Size of an em, in metres.
    pub(super) size_m: f32,
    /// Byte range of each line, top first.
    pub(super) lines: ArrayVec<Range<usize>, MAX_LINES>,
    /// True if the end is cut off and an ellipsis must follow the last line.
    pub(super) shortened: bool,
}

impl Fitted {
    /// Total height of the lines, in metres.
    pub(super) fn height_m(&self) -> f32 {
        self.lines.len() as f32 * LINE_HEIGHT * self.size_m
    }
}

/// Returns the largest layout of `text` within `room` metres, between the two sizes.
///
/// Lines break where the Unicode line breaking algorithm allows it: at white space, and between Chinese and Japanese
/// letters. One line is preferred over more if it is nearly as large. Text that does not fit at `smallest_m` is cut
/// off with an ellipsis.
pub(super) fn fit(text: &str, room: Vec2, largest_m: f32, smallest_m: f32) -> Fitted {
    let mut size_m = largest_m;
    let wrapped = loop {
        let allowed = ((room.y / (LINE_HEIGHT * size_m)) as usize).min(MAX_LINES);
        if let Some(lines) = wrap(text, room.x / size_m, allowed) {
            break Some(Fitted { size_m, lines, shortened: false });
        }
        if size_m <= smallest_m {
            break None;
        }
        size_m = (size_m * 0.95).max(smallest_m);
    };
    match wrapped {
        Some(fitted) if fitted.lines.len() > 1 => {
            one_line(text, room, (0.8 * fitted.size_m).max(smallest_m)).unwrap_or(fitted)
        }
        Some(fitted) => fitted,
        None => shorten(text, room, smallest_m),
    }
}

/// Returns the largest layout of `text` on one line of `room_m` metres, between the two sizes; cuts it off if
/// necessary.
pub(super) fn fit_line(text: &str, room_m: f32, largest_m: f32, smallest_m: f32) -> Fitted {
    let room = Vec2::new(room_m, smallest_m);
    let size_m = (room_m / width(text.trim())).min(largest_m);
    let whole = trimmed(text);
    if size_m >= smallest_m && !whole.is_empty() {
        Fitted { size_m, lines: [whole].into_iter().collect(), shortened: false }
    } else {
        shorten(text, room, smallest_m)
    }
}

/// The layout of `text` on one line, if its size is at least `smallest_m`.
fn one_line(text: &str, room: Vec2, smallest_m: f32) -> Option<Fitted> {
    let size_m = room.x / width(text.trim());
    let whole = trimmed(text);
    (size_m >= smallest_m).then(|| Fitted { size_m, lines: [whole].into_iter().collect(), shortened: false })
}

/// Greedy line breaks at `room` em; `None` if that needs more than `allowed` lines or a word is too long.
fn wrap(text: &str, room: f32, allowed: usize) -> Option<ArrayVec<Range<usize>, MAX_LINES>> {
    let mut lines = ArrayVec::<Range<usize>, MAX_LINES>::new();
    for word in words(text) {
        let joined = lines.last().map(|line| line.start..word.end);
        match joined.filter(|joined| width(&text[joined.clone()]) <= room) {
            Some(joined) => {
                lines.pop();
                lines.push(joined);
            }
            None if width(&text[word.clone()]) > room || lines.len() >= allowed => return None,
            None => lines.push(word),
        }
    }
    Some(lines)
}

/// As much of `text` as fits at `size_m`, with words broken if necessary, including the ellipsis if the end is cut
/// off; no line if even that does not fit.
fn shorten(text: &str, room: Vec2, size_m: f32) -> Fitted {
    // A single line may be a little closer to its neighbours above and below.
    let fitting = (room.y / (LINE_HEIGHT * size_m)) as usize;
    let allowed = if room.y >= size_m { fitting.clamp(1, MAX_LINES) } else { 0 };
    let mut lines = ArrayVec::<Range<usize>, MAX_LINES>::new();
    let mut left = trimmed(text);
    while !left.is_empty() && lines.len() < allowed {
        let last = lines.len() + 1 == allowed;
        let mut end = left.start + prefix(&text[left.clone()], room.x / size_m);
        if last && end < left.end {
            end = left.start + prefix(&text[left.clone()], room.x / size_m - width("…"));
        } else if end < left.end && !text[end..].starts_with(char::is_whitespace) {
            // Prefer a break between words to one within a word.
            end = text[left.start..end].rfind(char::is_whitespace).map_or(end, |at| left.start + at);
        }
        let line = left.start..left.start + text[left.start..end].trim_end().len();
        if line.is_empty() {
            // No further letter fits: the ellipsis must go to an earlier line.
            while let Some(before) = lines.pop() {
                let kept = prefix(&text[before.clone()], room.x / size_m - width("…"));
                if kept > 0 {
                    lines.push(before.start..before.start + kept);
                    break;
                }
            }
            break;
        }
        lines.push(line);
        left.start = end + (text[end..left.end].len() - text[end..left.end].trim_start().len());
    }
    Fitted { size_m, lines, shortened: !left.is_empty() }
}

/// Length in bytes of the longest prefix of `text` that is at most `room` em wide; keeps letters and their marks
/// together.
fn prefix(text: &str, room: f32) -> usize {
    let mut used = 0.0;
    let fits = |(_, cluster): &(usize, &str)| {
        used += width(cluster);
        used <= room
    };
    text.grapheme_indices(true).take_while(fits).last().map_or(0, |(at, cluster)| at + cluster.len())
}

fn trimmed(text: &str) -> Range<usize> {
    let start = text.len() - text.trim_start().len();
    start..start + text.trim().len()
}

/// The parts between line breaks, without surrounding white space.
fn words(text: &str) -> impl Iterator<Item = Range<usize>> {
    let mut begin = 0;
    linebreaks(text).filter_map(move |(end, _)| {
        let part = std::mem::replace(&mut begin, end)..end;
        let word = trimmed(text.get(part.clone())?);
        (!word.is_empty()).then(|| part.start + word.start..part.start + word.end)
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn lines<'a>(text: &'a str, fitted: &Fitted) -> Vec<&'a str> {
        fitted.lines.iter().map(|line| &text[line.clone()]).collect()
    }

    #[test]
    fn short_labels_stay_large_on_one_line() {
        let fitted = fit("Home", Vec2::new(0.3, 0.2), 0.05, 0.02);
        assert_eq!(fitted.size_m, 0.05);
        assert_eq!(lines("Home", &fitted), ["Home"]);
    }

    #[test]
    fn long_labels_break_before_they_shrink_much() {
        let text = "Next patient record";
        let fitted = fit(text, Vec2::new(0.2, 0.2), 0.05, 0.02);
        assert!(fitted.lines.len() > 1);
        assert!(fitted.size_m > 0.03, "{fitted:?}");
    }

    #[test]
    fn chinese_breaks_between_its_letters_before_it_shrinks_much() {
        let text = "地図を拡大する";
        let fitted = fit(text, Vec2::new(0.2, 0.2), 0.05, 0.02);
        assert_eq!(lines(text, &fitted).len(), 2, "{fitted:?}");
        assert!(fitted.size_m > 0.04, "{fitted:?}");
        assert_eq!(lines(text, &fitted).concat(), text);
    }

    #[test]
    fn a_letter_is_not_cut_off_from_its_marks() {
        // 3.5 cm hold one letter of 2 cm with an ellipsis; each of the first two letters has two marks.
        let text = "ที่นี่ดี";
        let fitted = fit(text, Vec2::new(0.035, 0.02), 0.02, 0.02);
        assert_eq!(lines(text, &fitted), ["ที่"], "{fitted:?}");
    }

    #[test]
    fn what_cannot_fit_is_cut_off_visibly() {
        // 15 cm hold about nine letters of 3 cm, and 5 cm hold one line of them.
        let name = "Donaudampfschifffahrt";
        let fitted = fit(name, Vec2::new(0.15, 0.05), 0.05, 0.03);
        assert!(fitted.shortened);
        assert_eq!(lines(name, &fitted), ["Donaud"]);
        let deeper = fit(name, Vec2::new(0.15, 0.12), 0.05, 0.03);
        assert!(!deeper.shortened, "{deeper:?}");
        assert_eq!(lines(name, &deeper).concat(), name);
        assert!(fit("Home", Vec2::ZERO, 0.05, 0.02).lines.is_empty());
    }

    proptest! {
        #[test]
        fn every_line_fits_its_room(
            text in "[ a-zA-ZäöüÄÖß\\-…靴を👟א-ת\u{5b0}\u{627}-\u{64a}ก-ู]{0,60}",
            across in 0.0_f32..1.0,
            down in 0.0_f32..0.5,
        ) {
            let room = Vec2::new(across, down);
            let fitted = fit(&text, room, 0.05, 0.02);
            for (at, line) in fitted.lines.iter().enumerate() {
                let last = at + 1 == fitted.lines.len();
                let ellipsis = if fitted.shortened && last { width("…") } else { 0.0 };
                let line_m = (width(&text[line.clone()]) + ellipsis) * fitted.size_m;
                prop_assert!(line_m <= room.x + 1e-4, "{line_m} m in {} m", room.x);
            }
            prop_assert!(fitted.lines.is_empty() || fitted.height_m() <= room.y + 0.004);
            prop_assert!((0.0199..=0.0501).contains(&fitted.size_m));
        }
    }
}
