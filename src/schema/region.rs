//! What regions have beyond a place: which contacts operate their controls.

use super::fields::Fields;
use crate::layout::CursorRule;

const RULES: [(&str, CursorRule); 3] =
    [("Largest", CursorRule::Largest), ("Working", CursorRule::Working), ("Each", CursorRule::Each)];

/// The rule in the field `cursor`; the paper's if it is not written.
pub(super) fn read_cursor(fields: &mut Fields<'_>) -> Option<CursorRule> {
    fields.read("cursor", Some(CursorRule::default()), |node| node.choice(&RULES))
}
