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
    /// as the fonts of a picture or a window do.
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
