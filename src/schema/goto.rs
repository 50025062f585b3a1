//! The page that a control switches to.

use std::ops::Range;

use super::fields::Fields;

/// The page that a control switches to.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Goto {
    pub(super) id: String,
    pub(super) at: Range<usize>,
}

impl Goto {
    pub(super) fn read(fields: &mut Fields<'_>) -> Option<Self> {
        let node = fields.take("goto")?;
        let id = node.id()?;
        Some(Self { id: id.to_owned(), at: node.span() })
    }
}
