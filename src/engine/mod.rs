//! Frames in; events, cues and a snapshot out. No clocks, no threads, no I/O.
//!
//! The same frames give the same events and cues, to the bit.

mod floor_engine;
mod interact;
mod response;
mod rise;
mod snapshot;

pub use floor_engine::{Engine, Step};
pub use snapshot::{LinkState, Snapshot, TileState, WidgetState};

#[cfg(test)]
mod tests;
