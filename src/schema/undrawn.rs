//! Places of letters in a layout that no font contains.

use super::diagnostic::Diagnostics;
use super::pairs::Limits;
use super::places::Places;
use super::problem::Problem;
use super::reader::Reader;
use super::source::Source;
use underfoot_format::outline::Outline;

/// The rule's code in `underfoot check --explain`.
const CODE: &str = "U304";

/// Maximum number of letters listed.
const NAMED: usize = 6;

impl Places {
    /// Returns a warning for each text in quotes with letters that cannot be drawn; `missing` returns those letters,
    /// for example [`Fonts::missing`](crate::letters::Fonts::missing).
    #[must_use]
    pub fn undrawn(&self, mut missing: impl FnMut(&str) -> Vec<char>) -> Diagnostics {
        // The text has been read before, so it is not too large, and it has an outline.
        let (Ok(source), Some(root)) = (Source::new(&self.name, &self.text), Outline::parse(&self.text))
        else {
            return Diagnostics::default();
        };
        let reader = Reader::new(&source, "Layout", Limits::LAYOUT);
        let mut problems = Vec::new();
        let mut waiting = vec![&root];
        while let Some(value) = waiting.pop() {
            waiting.extend(value.elements.iter().rev().map(|element| &element.value));
            let missing = value.says.as_deref().map(&mut missing).unwrap_or_default();
            if missing.is_empty() {
                continue;
            }
            let problem = Problem::warning(value.span.clone(), format!("no font has {}", named(&missing)))
                .expected("a box is drawn for each of them")
                .help_if(Some(
                    "install a font that has them where the layout is shown, or write other letters".into(),
                ));
            problems.extend(reader.only(problem).into_iter().map(|one| one.with_code(CODE)));
        }
        Diagnostics::new(problems, std::iter::empty())
    }
}

/// Lists the letters with their numbers; only the first ones if there are many.
fn named(letters: &[char]) -> String {
    let first = letters.iter().take(NAMED);
    let mut named: Vec<String> =
        first.map(|letter| format!("{letter} (U+{:04X})", u32::from(*letter))).collect();
    match letters.len().checked_sub(NAMED) {
        None | Some(0) => {}
        Some(1) => named.push("one more letter".into()),
        Some(more) => named.push(format!("{more} more letters")),
    }
    match named.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, first)) => format!("{} and {last}", first.join(", ")),
        None => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use crate::floor::Geometry;
    use crate::letters::Fonts;
    use crate::schema::{Kinds, parse_layout};

    fn undrawn(text: &str) -> String {
        let loaded = parse_layout(text, "it.ron", &Kinds::builtin(), &Geometry::default()).unwrap();
        let fonts = Fonts::built_in();
        loaded.places.undrawn(|text| fonts.missing(text)).to_string()
    }

    fn layout(title: &str, stance: &str, label: &str) -> String {
        format!(
            "Layout(version: 1, title: \"{title}\", regions: [(id: \"r\", at: (0, 2), size: (6, 4))],\n\
             stances: [(at: (2, 0.5), size: (2, 1), label: \"{stance}\")], widgets: [\n\
             (id: \"a\", kind: \"button\", at: (0.4, 2.6), size: (0.8, 0.8), label: \"{label}\"),\n])"
        )
    }

    #[test]
    fn letters_that_no_font_has_are_told_with_their_place() {
        let told = undrawn(&layout("Map", "Stand here", "首页 Home"));
        assert!(told.contains("warning[U304]: no font has 首 (U+9996) and 页 (U+9875)"), "{told}");
        assert!(told.contains("it.ron:3:"), "{told}");
        // All texts are drawn, not only labels of controls.
        let told = undrawn(&layout("地図", "ここ", "Home"));
        assert_eq!(told.matches("U304").count(), 2, "{told}");
        assert!(told.contains("it.ron:1:") && told.contains("it.ron:2:"), "{told}");
    }

    #[test]
    fn a_letter_is_told_once_and_many_are_counted() {
        let told = undrawn(&layout("Map", "Stand", "いいろはにほへとち"));
        assert!(told.contains("い (U+3044), ろ (U+308D)"), "{told}");
        assert!(told.contains("へ (U+3078) and 2 more letters"), "{told}");
    }

    #[test]
    fn what_the_programs_own_fonts_have_is_drawn_everywhere() {
        assert_eq!(undrawn(&layout("Žluť", "Дом Σ", "🏠 → 12 %")), "");
    }
}
