//! A floor at work: packets in, events, cues and snapshots out, in one thread.
//!
//! [`Server`] pulls packets from a source, assembles frames, steps the engine
//! and hands out what comes of it. Nothing it waits for depends on a window,
//! a disk or another program. [`take_tare`] and [`ForceWatch`] are for the
//! people who set a floor up.

mod measure;
mod reference;
mod request;
mod server;
mod tare;
mod trial;

pub use measure::{ForceRange, ForceWatch, TileRange};
pub use reference::{Argument, Direction, Entry, Reference};
pub use server::{Command, Ended, Server};
pub use tare::{TareFailure, take_tare};
