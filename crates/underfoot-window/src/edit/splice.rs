//! Local changes of a text: inserts, replaces and cuts out fields and list entries.
//!
//! All other bytes stay: comments, the order of fields, line breaks, blanks.

use std::ops::Range;

use underfoot_format::outline::{Element, Outline, OutlineShape};
use underfoot_format::scan::scan;

/// One step of indentation.
const STEP: &str = "    ";

/// A range of a text and its replacement.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Splice {
    pub(super) at: Range<usize>,
    pub(super) text: String,
}

impl Splice {
    pub(super) fn new(at: Range<usize>, text: impl Into<String>) -> Self {
        Self { at, text: text.into() }
    }

    fn insert(at: usize, text: impl Into<String>) -> Self {
        Self::new(at..at, text)
    }
}

/// `text` with all `splices`, which must not overlap.
pub(super) fn spliced(text: &str, mut splices: Vec<Splice>) -> String {
    splices.sort_by_key(|splice| (splice.at.start, splice.at.end));
    let mut result = String::with_capacity(text.len() + 64);
    let mut from = 0;
    for splice in splices {
        result.push_str(text.get(from..splice.at.start).unwrap_or_default());
        result.push_str(&splice.text);
        from = splice.at.end.max(from);
    }
    result.push_str(text.get(from..).unwrap_or_default());
    result
}

/// An entry with its comments, for insertion elsewhere.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct RecordText {
    /// The comments on the lines above it, line by line.
    pub(super) above: Vec<String>,
    /// Its text; the further lines have the indentation of an entry at the margin.
    pub(super) text: String,
    /// The comment behind it on its line.
    pub(super) comment: String,
}

impl RecordText {
    pub(super) fn new(text: impl Into<String>) -> Self {
        Self { text: text.into(), ..Self::default() }
    }

    /// The single entry in `text`, with the comments before and behind it; `None` for no entry or several.
    pub(super) fn parse(text: &str) -> Option<Self> {
        let list = format!("[\n{}\n]", text.trim());
        let root = Outline::parse(&list)?;
        let [element] = &root.elements[..] else { return None };
        let mut piece = LayoutLines(&list).piece(&root, 0)?;
        let before = list.get(2..element.start())?;
        let rest = list.get(element.end()..list.len() - 2)?;
        // All comments, including those with an empty line between them.
        piece.above = comments(before).into_iter().flat_map(lines_of).collect();
        let before_comma = comments(list.get(element.value.span.end..element.end())?);
        let mut behind: Vec<String> = before_comma.into_iter().map(closed).collect();
        if let [first @ .., last] = &comments(rest)[..] {
            behind.extend(first.iter().map(|comment| closed(comment)).chain([(*last).to_owned()]));
        }
        piece.comment = behind.join(" ");
        Some(piece)
    }

    /// Its lines in a list of records, including comments, each behind `indent`.
    pub(super) fn listed(&self, indent: &str) -> String {
        let mut listed: String = self.above.iter().map(|line| format!("{indent}{line}\n")).collect();
        let line_break = format!("\n{indent}");
        listed.push_str(&format!("{indent}{},", self.text.replace('\n', &line_break)));
        if !self.comment.is_empty() {
            listed.push_str(&format!(" {}", self.comment));
        }
        listed.push('\n');
        listed
    }

    /// Its comments for an entry that shares its line, before and behind it, as block comments: none may end the
    /// line.
    fn inline(&self) -> (String, String) {
        let all_closed = |text: &str| -> Vec<String> { comments(text).into_iter().map(closed).collect() };
        let above = all_closed(&self.above.join("\n"));
        let above: String = above.iter().map(|comment| format!("{} ", comment.replace('\n', " "))).collect();
        let behind: String = all_closed(&self.comment).iter().map(|comment| format!(" {comment}")).collect();
        (above, behind)
    }
}

/// The comments of a text, in order.
pub(super) fn comments(text: &str) -> Vec<&str> {
    let found = scan(text, usize::MAX).comments;
    found.into_iter().filter_map(|at| text.get(at)).collect()
}

/// The lines of a comment.
fn lines_of(comment: &str) -> Vec<String> {
    comment.lines().map(|line| line.trim_end().to_owned()).collect()
}

/// The comment as a block comment.
fn closed(comment: &str) -> String {
    match comment.strip_prefix("//") {
        Some(line) => format!("/* {} */", line.trim().replace("*/", "* /").replace("/*", "/ *")),
        None => comment.to_owned(),
    }
}

/// A text, split into lines.
#[derive(Clone, Copy)]
pub(super) struct LayoutLines<'t>(pub(super) &'t str);

impl<'t> LayoutLines<'t> {
    fn start(self, at: usize) -> usize {
        self.0[..at].rfind('\n').map_or(0, |line_break| line_break + 1)
    }

    /// The end of the line around `at`, before its line break.
    fn end(self, at: usize) -> usize {
        let rest = &self.0[at..];
        let line = rest.split('\n').next().unwrap_or_default();
        at + line.strip_suffix('\r').unwrap_or(line).len()
    }

    /// The indentation of the line around `at`.
    fn indent(self, at: usize) -> &'t str {
        let line = &self.0[self.start(at)..at];
        &line[..line.len() - line.trim_start().len()]
    }

    fn line_break(self) -> &'static str {
        if self.0.contains("\r\n") { "\r\n" } else { "\n" }
    }

    fn is_first(self, at: usize) -> bool {
        self.0[self.start(at)..at].trim().is_empty()
    }

    /// The rest of the line after `at` if it is empty or holds only comments; otherwise `None`.
    fn only_comment(self, at: usize) -> Option<&'t str> {
        let rest = self.0[at..self.end(at)].trim();
        let mut left = 0;
        for comment in scan(rest, usize::MAX).comments {
            let is_blank = rest.get(left..comment.start).is_some_and(|between| between.trim().is_empty());
            left = if is_blank { comment.end } else { return None };
        }
        rest.get(left..).is_some_and(|after| after.trim().is_empty()).then_some(rest)
    }

    /// The comment behind `element`, or an empty text, if no other code shares its lines; otherwise `None`.
    fn owns_lines(self, element: &Element) -> Option<&'t str> {
        self.only_comment(element.end()).filter(|_| self.is_first(element.start()))
    }

    /// The element number `index` of `parent` with its comments: those on the lines directly above it, and the one
    /// behind it. `None` if there is no such element.
    pub(super) fn piece(self, parent: &Outline, index: usize) -> Option<RecordText> {
        let element = parent.elements.get(index)?;
        let indent = self.indent(element.start());
        let text = self.0.get(element.start()..element.value.span.end)?;
        let mut lines = text.split('\n');
        let mut dedented = lines.next().unwrap_or_default().to_owned();
        for line in lines {
            dedented.push('\n');
            dedented
                .push_str(line.strip_prefix(indent).unwrap_or_else(|| line.trim_start_matches([' ', '\t'])));
        }
        let before_comma = self.0.get(element.value.span.end..element.end()).unwrap_or_default();
        let mut behind: Vec<String> = comments(before_comma).into_iter().map(closed).collect();
        behind.extend(
            self.only_comment(element.end()).filter(|comment| !comment.is_empty()).map(str::to_owned),
        );
        let above = self.0.get(self.above(parent, index)..element.start()).unwrap_or_default().trim_end();
        let line =
            |line: &str| line.strip_prefix(indent).unwrap_or_else(|| line.trim_start()).trim_end().to_owned();
        let above = above.lines().map(line).collect();
        Some(RecordText { above, text: dedented.replace("\r\n", "\n"), comment: behind.join(" ") })
    }

    /// The start of the comments that belong to the element number `index` of `parent`: those before it on its line,
    /// and those on the lines directly above, without an empty line between; without comments, the start of the
    /// element.
    fn above(self, parent: &Outline, index: usize) -> usize {
        let Some(element) = parent.elements.get(index) else { return 0 };
        let before = index.checked_sub(1).and_then(|before| parent.elements.get(before));
        let limit = before.map(Element::end).or(parent.inside.as_ref().map(|inside| inside.start));
        let limit = limit.unwrap_or(element.start());
        // A comment behind the previous entry, on its line, belongs to that entry; on a shared line, to the next one.
        let rest = self.0.get(limit..element.start()).unwrap_or_default();
        let limit = limit + rest.find('\n').map_or(0, |line_break| line_break + 1);
        let Some(between) = self.0.get(limit..element.start()) else { return element.start() };
        let mut begin = between.len();
        for comment in scan(between, usize::MAX).comments.into_iter().rev() {
            let gap = between.get(comment.end..begin).unwrap_or_default();
            if !gap.trim().is_empty() || gap.matches('\n').count() > 1 {
                break;
            }
            begin = comment.start;
        }
        limit + begin
    }

    fn indented(self, text: &str, indent: &str) -> String {
        let mut lines = text.split('\n').map(|line| line.trim_end_matches('\r'));
        let mut indented = lines.next().unwrap_or_default().to_owned();
        for line in lines {
            indented.push_str(self.line_break());
            if !line.trim().is_empty() {
                indented.push_str(indent);
                indented.push_str(line);
            }
        }
        indented
    }

    /// Inserts `piece` as the element number `index` of `parent`, a record or a list, in the style of its neighbours.
    pub(super) fn insert(self, parent: &Outline, index: usize, piece: &RecordText) -> Vec<Splice> {
        let own_line = |indent: &str| {
            let line_break = self.line_break();
            let above: String =
                piece.above.iter().map(|line| format!("{line_break}{indent}{line}")).collect();
            let text = self.indented(&piece.text, indent);
            let comment =
                if piece.comment.is_empty() { String::new() } else { format!(" {}", piece.comment) };
            format!("{above}{line_break}{indent}{text},{comment}")
        };
        let inline = || {
            let indent = self.indent(parent.span.start);
            let (above, comment) = piece.inline();
            (format!("{above}{}", self.indented(&piece.text, indent)), comment)
        };
        let Some(inside) = &parent.inside else {
            // A bare name gets brackets.
            return vec![Splice::insert(parent.span.end, format!("({})", inline().0))];
        };
        let before = index.min(parent.elements.len()).checked_sub(1).and_then(|at| parent.elements.get(at));
        match (before, parent.elements.first()) {
            (Some(before), _) => {
                let missing = before.comma.is_none().then(|| Splice::insert(before.value.span.end, ","));
                if self.owns_lines(before).is_some() {
                    let place = self.end(before.end());
                    let line = Splice::insert(place, own_line(self.indent(before.start())));
                    return missing.into_iter().chain([line]).collect();
                }
                let (text, comment) = inline();
                let closing = if before.comma.is_some() { "," } else { "" };
                let entry = Splice::insert(before.end(), format!(" {text}{closing}{comment}"));
                missing.into_iter().chain([entry]).collect()
            }
            (None, Some(first))
                if self.is_first(first.start()) && self.only_comment(inside.start).is_some() =>
            {
                // Above the comments that belong to the first one, and below any others.
                let line = own_line(self.indent(first.start()));
                let line = line.trim_start_matches(['\r', '\n']);
                let place = self.start(self.above(parent, 0));
                vec![Splice::insert(place, format!("{line}{}", self.line_break()))]
            }
            (None, Some(first)) => {
                let (text, comment) = inline();
                vec![Splice::insert(first.start(), format!("{text},{comment} "))]
            }
            (None, None) if self.0[inside.clone()].contains('\n') && self.is_first(inside.end) => {
                let indent = format!("{}{STEP}", self.indent(inside.end));
                let line = own_line(&indent);
                let line = line.trim_start_matches(['\r', '\n']);
                vec![Splice::insert(self.start(inside.end), format!("{line}{}", self.line_break()))]
            }
            (None, None) if parent.shape == OutlineShape::List => {
                let outer = self.indent(parent.span.start);
                let line = own_line(&format!("{outer}{STEP}"));
                vec![Splice::insert(inside.end, format!("{line}{}{outer}", self.line_break()))]
            }
            (None, None) => vec![Splice::insert(inside.end, inline().0)],
        }
    }

    /// Removes the element number `index` of `parent`, with its comma and the comment behind it.
    pub(super) fn cut(self, parent: &Outline, index: usize) -> Vec<Splice> {
        let Some(element) = parent.elements.get(index) else { return Vec::new() };
        if self.owns_lines(element).is_some() {
            let end = self.end(element.end());
            let line_break = self.0[end..].find('\n').map_or(0, |at| at + 1);
            return vec![Splice::new(self.start(element.start())..end + line_break, "")];
        }
        let before = index.checked_sub(1).and_then(|before| parent.elements.get(before));
        let Some(before) = before else {
            let rest = &self.0[element.end()..];
            let blanks = rest.len() - rest.trim_start_matches([' ', '\t']).len();
            return vec![Splice::new(element.start()..element.end() + blanks, "")];
        };
        let between = &self.0[before.end()..element.start()];
        // Removing an entry of a list leaves the previous entry's line unchanged; fields belong to one record.
        let shares_line = !between.contains('\n') || parent.shape != OutlineShape::List;
        let joins = between.trim().is_empty() && shares_line;
        let start = if joins { before.end() } else { element.start() };
        // The last element leaves no comma behind if it had none itself.
        let comma = before.comma.clone().filter(|comma| element.comma.is_none() && comma.end == start);
        let start = comma.map_or(start, |comma| comma.start);
        vec![Splice::new(start..element.end(), "")]
    }

    /// Removes the element number `index` of `parent` as [`LayoutLines::cut`] does, together with the comments above it,
    /// which move with it.
    pub(super) fn take(self, parent: &Outline, index: usize) -> Vec<Splice> {
        let mut splices = self.cut(parent, index);
        let above = self.above(parent, index);
        if let [splice] = &mut splices[..] {
            splice.at.start = splice.at.start.min(above);
            let element = parent.elements.get(index);
            if let Some(last) = element.filter(|element| self.only_comment(element.end()).is_some()) {
                // The comment at the end of a line that it shares with the entries before it.
                splice.at.end = splice.at.end.max(self.end(last.end()));
            }
            // Also remove the line if nothing else is on it.
            let start = self.start(splice.at.start);
            let is_begin_blank = self.0[start..splice.at.start].trim().is_empty();
            let (end, is_whole) = (self.end(splice.at.end), splice.at.end == self.start(splice.at.end));
            let is_end_blank = is_whole || self.0[splice.at.end..end].trim().is_empty();
            if is_begin_blank && is_end_blank && start < above {
                splice.at.start = start;
                if !is_whole {
                    splice.at.end = end + self.0[end..].find('\n').map_or(0, |at| at + 1);
                }
            }
        }
        splices
    }

    /// Writes `value` for the field at `path` of `record`, with the smallest possible change of the text.
    pub(super) fn set(self, record: &Outline, path: &[&str], value: &str) -> Vec<Splice> {
        let Some((name, rest)) = path.split_first() else { return self.replace(record, value) };
        match record.field(name) {
            Some(element) if element.value.shape == OutlineShape::Record || rest.is_empty() => {
                self.set(&element.value, rest, value)
            }
            Some(element) => {
                vec![Splice::new(element.value.span.clone(), nested(rest, value))]
            }
            None => {
                let field = format!("{name}: {}", nested(rest, value));
                self.insert(record, record.elements.len(), &RecordText::new(field))
            }
        }
    }

    /// Replaces a value by `value`, with the smallest possible change of the text.
    pub(super) fn replace(self, old: &Outline, value: &str) -> Vec<Splice> {
        let written = &self.0[old.span.clone()];
        let number = |text: &str| text.trim().parse::<f64>().ok();
        if written == value || (number(written).is_some() && number(written) == number(value)) {
            return Vec::new();
        }
        if old.shape == OutlineShape::Tuple
            && let Some(new) = Outline::parse(value)
            && new.shape == OutlineShape::Tuple
            && new.elements.len() == old.elements.len()
        {
            let pairs = old.elements.iter().zip(&new.elements);
            return pairs
                .flat_map(|(old, new)| self.replace(&old.value, &value[new.value.span.clone()]))
                .collect();
        }
        vec![Splice::new(old.span.clone(), self.indented(value, self.indent(old.span.start)))]
    }

    /// Removes the field at `path` of `record`, and a record that has no other field.
    pub(super) fn unset(self, record: &Outline, path: &[&str]) -> Vec<Splice> {
        let Some((name, rest)) = path.split_first() else { return Vec::new() };
        let is_called = |element: &Element| element.field.as_ref().is_some_and(|(own, _)| own == name);
        let Some(index) = record.elements.iter().position(is_called) else { return Vec::new() };
        let value = &record.elements[index].value;
        let is_only = rest.len() == 1 && value.elements.len() == 1 && value.field(rest[0]).is_some();
        if rest.is_empty() || (is_only && value.name.is_none()) {
            self.cut(record, index)
        } else {
            self.unset(value, rest)
        }
    }
}

/// `value` as the field at `path` of a new record.
fn nested(path: &[&str], value: &str) -> String {
    path.iter().rev().fold(value.to_owned(), |value, name| format!("({name}: {value})"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn changed(text: &str, change: impl Fn(LayoutLines<'_>, &Outline) -> Vec<Splice>) -> String {
        let root = Outline::parse(text).unwrap();
        spliced(text, change(LayoutLines(text), &root))
    }

    fn set(text: &str, path: &str, value: &str) -> String {
        let path: Vec<&str> = path.split('.').collect();
        changed(text, |lines, root| lines.set(root, &path, value))
    }

    fn unset(text: &str, path: &str) -> String {
        let path: Vec<&str> = path.split('.').collect();
        changed(text, |lines, root| lines.unset(root, &path))
    }

    fn insert(text: &str, index: usize, entry: &str) -> String {
        changed(text, |lines, root| {
            lines.insert(&root.field("w").unwrap().value, index, &RecordText::new(entry))
        })
    }

    fn cut(text: &str, index: usize) -> String {
        changed(text, |lines, root| lines.cut(&root.field("w").unwrap().value, index))
    }

    #[test]
    fn a_field_is_replaced_where_it_stands() {
        assert_eq!(set("(a: 1, /* b */ c: 2)", "a", "5"), "(a: 5, /* b */ c: 2)");
        assert_eq!(set("(at: (1.50 /*e*/, 2))", "at", "(1.5, 3)"), "(at: (1.50 /*e*/, 3))");
        assert_eq!(set("(look: (face: 1, ink: 2))", "look.ink", "7"), "(look: (face: 1, ink: 7))");
        assert_eq!(set("(g: Confirm)", "g.x", "7"), "(g: Confirm(x: 7))");
    }

    #[test]
    fn a_new_field_is_written_as_its_neighbours_are() {
        assert_eq!(set("(a: 1)", "b", "2"), "(a: 1, b: 2)");
        assert_eq!(set("(a: 1,)", "b", "2"), "(a: 1, b: 2,)");
        assert_eq!(set("(\n  a: 1 // one\n)", "b", "2"), "(\n  a: 1, // one\n  b: 2,\n)");
        assert_eq!(set("Snow", "at", "(1, 2)"), "Snow(at: (1, 2))");
        assert_eq!(set("(a: 1)", "look.ink", "2"), "(a: 1, look: (ink: 2))");
        assert_eq!(set("()", "a", "2"), "(a: 2)");
    }

    #[test]
    fn a_field_is_taken_out_with_its_comma() {
        assert_eq!(unset("(a: 1, b: 2, c: 3)", "b"), "(a: 1, c: 3)");
        assert_eq!(unset("(a: 1, b: 2)", "b"), "(a: 1)");
        assert_eq!(unset("(a: 1, b: 2)", "a"), "(b: 2)");
        assert_eq!(unset("(a: 1,\n    b: 2)", "b"), "(a: 1)");
        assert_eq!(unset("(\n  a: 1,\n  // why\n  b: 2, // how\n)", "b"), "(\n  a: 1,\n  // why\n)");
        assert_eq!(unset("(a: 1, look: (ink: 2))", "look.ink"), "(a: 1)");
    }

    #[test]
    fn entries_come_and_go_as_their_neighbours_are_written() {
        let lines = "(w: [\n  // first\n  (a), // one\n  (b)\n])";
        assert_eq!(insert(lines, 1, "(n)"), "(w: [\n  // first\n  (a), // one\n  (n),\n  (b)\n])");
        assert_eq!(insert(lines, 2, "(n)"), "(w: [\n  // first\n  (a), // one\n  (b),\n  (n),\n])");
        assert_eq!(
            insert(lines, 0, "(n,\n  m)"),
            "(w: [\n  (n,\n    m),\n  // first\n  (a), // one\n  (b)\n])"
        );
        assert_eq!(cut(lines, 0), "(w: [\n  // first\n  (b)\n])");
        assert_eq!(insert("(w: [(a), (b)])", 2, "(n)"), "(w: [(a), (b), (n)])");
        assert_eq!(insert("(w: [(a), (b)])", 0, "(n)"), "(w: [(n), (a), (b)])");
        assert_eq!(cut("(w: [(a), (b)])", 1), "(w: [(a)])");
        assert_eq!(cut("(w: [(a), (b)])", 0), "(w: [(b)])");
        assert_eq!(cut("(w: [(a),\n  (b) /* c */ ])", 1), "(w: [(a),\n   /* c */ ])");
        assert_eq!(insert("(\n  w: [])", 0, "(n)"), "(\n  w: [\n      (n),\n  ])");
        assert_eq!(insert("(w: [\n])", 0, "(n)"), "(w: [\n    (n),\n])");
        assert_eq!(insert("(w: [\r\n  (a),\r\n])", 1, "(n)"), "(w: [\r\n  (a),\r\n  (n),\r\n])");
    }
}
