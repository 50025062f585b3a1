//! Updates the values in a hand-written text from a generated one; the text between the values stays.

use super::splice::{LayoutLines, Splice, spliced};
use underfoot_format::outline::{Element, Outline, OutlineShape};

/// Maximum number of values to update one by one; a file with more differences is a different file.
const MOST: usize = 2000;

/// `old` with the values of `new`: comments, order and line breaks stay, and only differing values are written.
///
/// Both are RON. If `old` cannot be parsed or differs too much, the result is `new`.
#[must_use]
pub fn refit(old: &str, new: &str) -> String {
    let Some(wanted) = Outline::parse(new) else { return new.to_owned() };
    let mut text = old.to_owned();
    for _ in 0..MOST {
        let Some(root) = Outline::parse(&text) else { break };
        match (Fit { lines: LayoutLines(&text), new }).next(&root, &wanted) {
            Some(splices) => text = spliced(&text, splices),
            None => return text,
        }
    }
    new.to_owned()
}

struct Fit<'t> {
    lines: LayoutLines<'t>,
    new: &'t str,
}

impl Fit<'_> {
    /// The splices for the first value that differs; `None` if all are equal.
    fn next(&self, old: &Outline, wanted: &Outline) -> Option<Vec<Splice>> {
        let text = |value: &Outline| self.new.get(value.span.clone()).unwrap_or_default();
        let is_same = old.shape == wanted.shape && old.name == wanted.name;
        let has_fields = |outline: &Outline| outline.elements.iter().all(|element| element.field.is_some());
        match wanted.shape {
            OutlineShape::Record if is_same && has_fields(old) && has_fields(wanted) => {
                let name = |element: &Element| element.field.as_ref().map(|(name, _)| name.clone());
                let written = |element: &Element| Some((name(element)?, element.value.clone()));
                let mut fields = wanted.elements.iter().filter_map(written);
                let changed = fields.find_map(|(name, value)| match old.field(&name) {
                    Some(element) => self.next(&element.value, &value),
                    None => Some(self.lines.set(old, &[&name], text(&value))),
                });
                let left = || {
                    let mut names = old.elements.iter().filter_map(name);
                    let gone = names.find(|name| wanted.field(name).is_none())?;
                    Some(self.lines.unset(old, &[&gone]))
                };
                changed.or_else(left)
            }
            OutlineShape::List if is_same => {
                let pairs = old.elements.iter().zip(&wanted.elements);
                let changed = pairs.into_iter().find_map(|(old, new)| self.next(&old.value, &new.value));
                let (count, more) = (wanted.elements.len(), wanted.elements.get(old.elements.len()));
                changed.or_else(|| match more {
                    Some(more) => {
                        let piece = super::splice::RecordText::new(text(&more.value));
                        Some(self.lines.insert(old, old.elements.len(), &piece))
                    }
                    None => (old.elements.len() > count).then(|| self.lines.cut(old, count)),
                })
            }
            _ => Some(self.lines.replace(old, text(wanted))).filter(|splices| !splices.is_empty()),
        }
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
        assert_eq!(refit(OLD, new), expected);
        assert_eq!(refit(OLD, OLD), OLD);
    }

    #[test]
    fn fields_and_entries_come_and_go_and_comments_stay() {
        let new = "Effect(version: 1, tone: Tone(hz: 80))\n";
        let text = refit(OLD, new);
        assert!(
            text.starts_with("// Like a light switch.\nEffect(\n    version: 1, // the format\n"),
            "{text}"
        );
        assert!(text.contains("tone: Tone(hz: 80)") && !text.contains("click") && text.ends_with("// end\n"));
        let old = "S(\n  // steps\n  at: [\n    (a: 1), // one\n    (a: 2),\n  ],\n)";
        let more = "S(at: [(a: 1), (a: 3), (a: 4)])";
        let fitted = "S(\n  // steps\n  at: [\n    (a: 1), // one\n    (a: 3),\n    (a: 4),\n  ],\n)";
        assert_eq!(refit(old, more), fitted);
        assert_eq!(refit(fitted, "S(at: [(a: 1)])"), "S(\n  // steps\n  at: [\n    (a: 1), // one\n  ],\n)");
        assert_eq!(refit("", new), new);
        assert_eq!(refit("(a: [", new), new);
    }

    proptest! {
        #[test]
        fn a_text_in_place_of_itself_is_itself_and_no_text_panics(
            text in "[a-z0-9 .:,()/*\"\\\\\n\u{e4}-]{0,60}", old in "[a-c0-9 :,()\\[\\]]{0,40}",
        ) {
            prop_assert_eq!(refit(&text, &text), text.clone());
            let _ = refit(&old, &text);
        }
    }
}
