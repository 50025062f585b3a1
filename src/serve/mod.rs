//! A floor at work: packets in, events, cues and snapshots out, in one thread.
//!
//! [`Server`] pulls packets from a source, assembles frames, steps the engine
//! and hands out what comes of it. Nothing it waits for depends on a window,
//! a disk or another program.

mod server;

pub use server::{Command, Ended, Server};
