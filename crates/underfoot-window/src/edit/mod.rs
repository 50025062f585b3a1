//! Editing of layouts: no window, no clock, no files but [`LayoutFile`].
//!
//! ```text
//! Edit -change, splice-> text with a few other bytes -schema-> Layout, warnings -ergonomics-> findings
//!   -history-> undo, redo
//! Item (a record on the floor) -snap, arrange, place, mend-> Edit
//! Document -file, merge-> file, draft
//! ```
//!
//! The text is authoritative: comments, order and line breaks stay, and an edit changes the bytes of its own record
//! only.

mod address;
mod alike;
mod arrange;
mod change;
mod clipboard;
#[cfg(test)]
mod comment_tests;
mod document;
mod facets;
mod file;
mod free_row;
mod grid_room;
mod group;
#[cfg(test)]
mod habit_tests;
mod history;
mod inspect;
mod item;
mod mend;
mod mend_all;
#[cfg(test)]
mod mend_all_tests;
mod merge;
mod place;
mod place_plan;
mod refit;
mod refusal;
mod rename;
mod room;
mod shared;
mod snap;
mod spacing;
mod splice;
mod template;
#[cfg(test)]
mod tests;
mod threshold;
mod zones;

pub use address::{Address, RecordList};
pub use alike::alike_edits;
pub use arrange::{Align, align, distribute};
pub use change::{Edit, quoted};
pub use document::Document;
pub use facets::{Facet, facet_edits};
pub use file::{LayoutFile, Saving};
pub use free_row::free_row;
pub use group::{grouping, ungrouping};
pub use inspect::{FieldOrigin, FieldSection, Property};
pub use item::{Item, around};
pub use mend::{Mend, mend, mend_warning};
pub use mend_all::{mend_all, mends_together};
pub use merge::{Merge, merge};
pub use refit::refit;
pub use refusal::EditRefusal;
pub use shared::{PlaceNumber, SharedNumber, TypedChange, changing, shared_number};
pub use snap::{Edges, SnapGrid, SnapGuide, SnapReason, round_step_m};
pub use spacing::{NeighbourGap, gaps_around};
pub use template::Template;
pub use threshold::{pressing, releasing};
