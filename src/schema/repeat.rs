//! Grids: one written control that stands for many, such as the keys of a keypad or the tiles of a menu.

use super::node::Node;
use super::problem::Problem;
use super::suggest::did_you_mean;
use super::units::Units;

/// Maximum number of columns or rows of one grid.
const MOST: u32 = 256;

/// A grid of controls, in reading order: row by row from the north-west.
pub(super) struct RepeatRecord<'r> {
    pub(super) columns: u32,
    pub(super) rows: u32,
    /// Gaps between columns and between rows.
    pub(super) gap: [f64; 2],
    /// Names for ids, one per cell; `None` leaves the cell empty.
    ids: Option<Vec<Option<Node<'r>>>>,
    /// Labels, likewise.
    labels: Option<Vec<Option<Node<'r>>>>,
}

/// One cell of a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cell {
    /// Index in reading order, from 0.
    pub(super) index: u32,
    /// Column from the west, from 0.
    pub(super) column: u32,
    /// Row from the north, from 0.
    pub(super) row: u32,
}

impl<'r> RepeatRecord<'r> {
    pub(super) fn read(node: Node<'r>, units: Units) -> Option<Self> {
        let mut fields = node.fields("Repeat")?;
        let far = units.furthest();
        let rows = fields.read("rows", Some(1), |node| node.whole(1..=MOST));
        // One of the two must be written, otherwise there is no repetition.
        let alone = fields.value_span("rows").map(|_| 1);
        let columns = fields.read("columns", alone, |node| node.whole(1..=MOST));
        let gap = fields.read("gap", Some([0.0; 2]), |node| node.one_or_two(0.0..=far));
        let count = columns.zip(rows).map(|(columns, rows)| columns * rows);
        let ids = fields.read("ids", Some(None), |node| words(node, "id", count).map(Some));
        let labels = fields.read("labels", Some(None), |node| words(node, "label", count).map(Some));
        fields.finish();
        Some(Self { columns: columns?, rows: rows?, gap: gap?, ids: ids?, labels: labels? })
    }

    /// A grid of one cell.
    pub(super) fn single() -> Self {
        Self { columns: 1, rows: 1, gap: [0.0; 2], ids: None, labels: None }
    }

    /// Whether the ids come from a list.
    pub(super) fn has_ids(&self) -> bool {
        self.ids.is_some()
    }

    /// Whether the labels come from a list.
    pub(super) fn has_labels(&self) -> bool {
        self.labels.is_some()
    }

    /// Returns all cells that are not empty.
    pub(super) fn cells(&self) -> impl Iterator<Item = Cell> + '_ {
        let columns = self.columns;
        let all = (0..columns * self.rows).map(move |index| Cell {
            index,
            column: index % columns,
            row: index / columns,
        });
        let is_empty = |list: &Option<Vec<Option<Node<'_>>>>, cell: &Cell| {
            list.as_ref().and_then(|list| list.get(cell.index as usize)).is_some_and(Option::is_none)
        };
        all.filter(move |cell| !is_empty(&self.ids, cell) && !is_empty(&self.labels, cell))
    }

    /// Returns the entry of this cell in the list of ids.
    pub(super) fn id(&self, cell: Cell) -> Option<Node<'r>> {
        self.ids.as_ref()?.get(cell.index as usize).copied().flatten()
    }

    /// Returns the entry of this cell in the list of labels.
    pub(super) fn label(&self, cell: Cell) -> Option<Node<'r>> {
        self.labels.as_ref()?.get(cell.index as usize).copied().flatten()
    }
}

/// Reads a list with an entry per cell, `None` for an empty one.
fn words<'r>(node: Node<'r>, entry: &'static str, count: Option<u32>) -> Option<Vec<Option<Node<'r>>>> {
    let nodes = node.list(entry, (MOST * MOST) as usize)?;
    if let Some(count) = count
        && nodes.len() != count as usize
    {
        let message = format!("`{}` doesn't fit the grid", node.name);
        let expected = format!("expected {count} entries, found {}", nodes.len());
        let problem = Problem::error(node.span(), message).expected(expected);
        node.report(
            problem.help("one for each place, row by row from the north-west; None leaves a place empty"),
        );
        return None;
    }
    Some(nodes.into_iter().map(|node| (!node.is_none()).then_some(node)).collect())
}

/// Replaces `{n}`, `{row}`, `{column}` and `{label}` in `pattern`; numbers count from 1.
///
/// # Errors
/// The unknown word in braces, and a suggestion for it.
pub(super) fn filled(
    pattern: &str,
    cell: Cell,
    label: Option<&str>,
) -> Result<String, (String, Option<String>)> {
    let mut text = String::new();
    let mut rest = pattern;
    while let Some((before, behind)) = rest.split_once('{') {
        text.push_str(before);
        let (name, after) = behind.split_once('}').ok_or_else(|| {
            ("this `{` is never closed".into(), Some("write {n}, {row} or {column}".into()))
        })?;
        let mut valid = vec!["n", "row", "column"];
        valid.extend(label.map(|_| "label"));
        match (name, label) {
            ("n", _) => text.push_str(&(cell.index + 1).to_string()),
            ("row", _) => text.push_str(&(cell.row + 1).to_string()),
            ("column", _) => text.push_str(&(cell.column + 1).to_string()),
            ("label", Some(label)) => text.push_str(&as_id(label)),
            _ => return Err((format!("nothing is called {{{name}}} here"), did_you_mean(name, &valid, '`'))),
        }
        rest = after;
    }
    text.push_str(rest);
    Ok(text)
}

/// Whether `pattern` gives a different text in every cell of a grid.
pub(super) fn varies(pattern: &str) -> bool {
    pattern.contains("{n}")
        || pattern.contains("{label}")
        || (pattern.contains("{row}") && pattern.contains("{column}"))
}

/// Converts a label to a part of an id: small letters and digits, `_` for all other characters.
fn as_id(label: &str) -> String {
    let part = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' };
    label.chars().map(part).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_name_the_places_of_a_grid() {
        let cell = Cell { index: 9, column: 0, row: 3 };
        let fill = |pattern, label| filled(pattern, cell, label);
        assert_eq!(fill("key_{n}", None).unwrap(), "key_10");
        assert_eq!(fill("r{row}c{column}", None).unwrap(), "r4c1");
        assert_eq!(fill("key_{label}", Some("All Clear")).unwrap(), "key_all_clear");
        let (message, help) = fill("key_{colum}", None).unwrap_err();
        assert_eq!(message, "nothing is called {colum} here");
        assert_eq!(help.as_deref(), Some("did you mean `column`?"));
        assert!(fill("key_{n", None).is_err());
        assert!(varies("k{n}") && varies("{row}{column}") && !varies("{row}"));
    }
}
