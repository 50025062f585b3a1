//! Frames in; events, cues and a snapshot out. No clocks, no threads, no I/O.

mod snapshot;

pub use snapshot::{LinkState, Snapshot, TileState, WidgetState};
