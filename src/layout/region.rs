//! Regions, in which feet operate controls, and zones where people stand.

use crate::floor::Rect;
use crate::messages::ContactSending;
use underfoot_format::Named;

/// Rule that selects the contacts in a region that operate its controls.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CursorRule {
    /// The one with the largest force: for people who stand beside the region.
    ///
    /// # Source
    /// Paper, section 4.2.
    #[default]
    Largest,
    /// The one with the largest force of those that press on a control and are not steps: for people who stand inside
    /// the region, between its controls.
    Working,
    /// Each of them, so that several controls can be engaged at once, each by one foot.
    Each,
}

impl Named for CursorRule {
    const ALL: &'static [(&'static str, Self)] =
        &[("Largest", Self::Largest), ("Working", Self::Working), ("Each", Self::Each)];
}

/// An active control area with cursors of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// Unique among the layout's regions.
    pub id: String,
    /// Its area.
    pub area: Rect,
    /// The rule that selects the contacts that operate its controls.
    pub cursor: CursorRule,
    /// The messages of the feet on its free floor.
    pub send: Vec<ContactSending>,
}

/// A place to stand while using the controls.
///
/// A contact with its centroid in it is a standing foot and cannot be a cursor, also where the zone lies in a region.
/// A control keeps a foot that it has engaged.
#[derive(Clone, Debug, PartialEq)]
pub struct Stance {
    /// Its area.
    pub area: Rect,
    /// The text on it; may be empty.
    pub label: String,
}
