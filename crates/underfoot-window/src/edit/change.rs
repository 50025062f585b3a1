//! Edits of a layout, and the changes of its text that they cause.

use super::address::{Address, list_of};
use super::refusal::EditRefusal;
use super::rename::renaming;
use super::splice::{LayoutLines, RecordText, Splice, spliced};
use underfoot_format::outline::{Outline, OutlineShape};
use underfoot_format::text::Text;

/// One change of a layout. In a sequence, each edit addresses the records as the edits before it left them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Edit {
    /// Write a field: replace its value, or add it behind the others.
    Set {
        /// The record of the field.
        record: Address,
        /// Its name; dotted for a field within a field, such as `look.face`.
        field: String,
        /// The text behind the colon.
        value: String,
    },
    /// Remove a field, so that its value comes from the kind again. No effect on an absent field.
    Unset {
        /// The record of the field.
        record: Address,
        /// Its name, as in [`Edit::Set`].
        field: String,
    },
    /// Insert a record into a list; creates the list if necessary.
    Insert {
        /// Its future address; an index beyond the end puts it last.
        at: Address,
        /// Its text, with its comments before and behind it.
        text: String,
    },
    /// Delete a record. Comments above it stay; the one behind it on its line is deleted.
    Delete {
        /// The record.
        record: Address,
    },
    /// Remove a record to insert it elsewhere, with the comments directly above it.
    Take {
        /// The record.
        record: Address,
    },
    /// Move a record within its list, with its comments.
    Reorder {
        /// The record.
        record: Address,
        /// Its new index in the list, counted without the record.
        to: usize,
    },
    /// Give a record another id, and update the references to it: neighbours in its list, those of the cells of a
    /// grid included, and buttons that show a page.
    Rename {
        /// The record.
        record: Address,
        /// Its new id.
        id: String,
    },
}

impl Edit {
    /// [`Edit::Set`].
    #[must_use]
    pub fn set(record: &Address, field: &str, value: impl Into<String>) -> Self {
        Self::Set { record: record.clone(), field: field.into(), value: value.into() }
    }

    /// [`Edit::Unset`].
    #[must_use]
    pub fn unset(record: &Address, field: &str) -> Self {
        Self::Unset { record: record.clone(), field: field.into() }
    }

    /// Returns `text` after the edit; `root` is its outline.
    pub(super) fn done(&self, text: &str, root: &Outline) -> Result<String, EditRefusal> {
        let lines = LayoutLines(text);
        let splices = match self {
            Self::Set { record, field, value } => {
                let path: Vec<&str> = field.split('.').collect();
                lines.set(find(root, record)?, &path, value)
            }
            Self::Unset { record, field } => {
                let path: Vec<&str> = field.split('.').collect();
                lines.unset(find(root, record)?, &path)
            }
            Self::Insert { at, text } => {
                insert(lines, root, at, &RecordText::parse(text).ok_or(EditRefusal::NotARecord)?)?
            }
            Self::Delete { record } => {
                let (list, index) = in_list(root, record)?;
                lines.cut(list, index)
            }
            Self::Take { record } => {
                let (list, index) = in_list(root, record)?;
                lines.take(list, index)
            }
            Self::Reorder { record, to } => return reorder(lines, root, record, *to),
            Self::Rename { record, id } => renaming(root, record, id)?,
        };
        Ok(spliced(text, splices))
    }
}

pub(super) fn find<'o>(root: &'o Outline, address: &Address) -> Result<&'o Outline, EditRefusal> {
    address.find(root).ok_or_else(|| EditRefusal::Missing(address.clone()))
}

/// The list that contains the record at `address`, and its index there.
pub(super) fn in_list<'o>(root: &'o Outline, address: &Address) -> Result<(&'o Outline, usize), EditRefusal> {
    let missing = || EditRefusal::Missing(address.clone());
    find(root, address)?;
    let (parent, list, index) = address.split().ok_or_else(missing)?;
    let list = parent.find(root).and_then(|parent| list_of(parent, list)).ok_or_else(missing)?;
    Ok((list, index))
}

fn insert(
    lines: LayoutLines<'_>,
    root: &Outline,
    at: &Address,
    piece: &RecordText,
) -> Result<Vec<Splice>, EditRefusal> {
    let (parent, list, index) = at.split().ok_or_else(|| EditRefusal::Missing(at.clone()))?;
    let parent = find(root, &parent)?;
    if let Some(list) = list_of(parent, list) {
        return Ok(lines.insert(list, index, piece));
    }
    let list = RecordText::new(format!("{}: [\n{}]", list.field(), piece.listed("    ")));
    Ok(lines.insert(parent, parent.elements.len(), &list))
}

fn reorder(
    lines: LayoutLines<'_>,
    root: &Outline,
    record: &Address,
    to: usize,
) -> Result<String, EditRefusal> {
    let (list, index) = in_list(root, record)?;
    let to = to.min(list.elements.len() - 1);
    if to == index {
        return Ok(lines.0.to_owned());
    }
    let piece = lines.piece(list, index).ok_or_else(|| EditRefusal::Missing(record.clone()))?;
    let without = spliced(lines.0, lines.take(list, index));
    let again = Outline::parse(&without).ok_or_else(|| EditRefusal::Missing(record.clone()))?;
    let (parent, kind, _) = record.split().ok_or_else(|| EditRefusal::Missing(record.clone()))?;
    let splices = insert(LayoutLines(&without), &again, &parent.entry(kind, to), &piece)?;
    Ok(spliced(&without, splices))
}

/// `text` in quotes, with the escapes of the file format.
#[must_use]
pub fn quoted(text: &str) -> String {
    Text::quoted(text).inline()
}

/// Whether `outline` is one record, which a list can hold.
pub(super) fn is_record(outline: &Outline) -> bool {
    outline.shape == OutlineShape::Record
}
