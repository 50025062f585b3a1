//! Frames in; events, cues and a snapshot out. No clocks, no threads, no I/O.
//!
//! The same frames give the same events and cues, to the bit.
//!
//! ```text
//! Contacts -feet, people-> since when, whose, how heavy -step, still-> press, step or object
//!   -region-> cursors, by the region's rule -interact-> the control under each
//!   -control-> events -response-> cues; a click may show another page
//! ```

mod control_state;
mod event;
mod feet;
mod floor_engine;
mod ignored;
mod interact;
mod overrides;
mod page;
mod people;
mod region;
mod response;
mod rise;
mod snapshot;
mod step;
mod still;
mod weight;

pub use control_state::{ControlState, Off, ValueRange};
pub use floor_engine::{Engine, FrameResults};
pub use ignored::{AnsweredPress, Ignored, IgnoredPress};
pub use page::PageShown;
pub use snapshot::{FootRole, FootState, Snapshot, TileState, WidgetState};

#[cfg(test)]
mod tests;
