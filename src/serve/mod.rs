//! A running floor: packets in, events, cues and snapshots out, in one thread.
//!
//! [`Server`] pulls packets from a source, assembles frames, steps the engine and passes the results on. It never
//! waits for a window, a disk or another program. `take_tare`, `ForceWatch`, `WiringWalk` and `WalkTest` serve the
//! people who set up a floor.

mod cause;
mod changes;
#[cfg(any(feature = "internals", test))]
mod measure;
mod neighbours;
#[cfg(any(feature = "internals", test))]
mod reference;
mod refusal;
mod request;
#[cfg(any(feature = "internals", test))]
mod rest;
mod server;
#[cfg(any(feature = "internals", test))]
mod tare;
mod trial;
#[cfg(any(feature = "internals", test))]
mod walk_test;
#[cfg(any(feature = "internals", test))]
mod wiring;

#[cfg(any(feature = "internals", test))]
pub use measure::{ForceRange, ForceWatch, TileRange};
pub use neighbours::Neighbours;
#[cfg(any(feature = "internals", test))]
pub use reference::{Argument, Direction, Entry, Reference};
pub use refusal::Refusal;
pub use server::{Command, Ended, Server};
#[cfg(any(feature = "internals", test))]
pub use tare::{TareFailure, take_tare};
#[cfg(any(feature = "internals", test))]
pub use walk_test::{SensorVerdict, WalkTest};
#[cfg(any(feature = "internals", test))]
pub use wiring::{FeltLoad, FeltTwice, STEP_N, Wiring, WiringStep, WiringTask, WiringWalk};
