//! A running floor: packets in, events, cues and snapshots out, in one thread.
//!
//! [`Server`] pulls packets from a source, assembles frames, steps the engine and passes the results on. It never
//! waits for a window, a disk or another program. `BoardSurvey`, `take_tare`, `ForceWatch`, `WiringWalk`,
//! `WalkTest` and `StandWalk` serve the people who set up a floor.

mod cause;
mod changes;
mod measure;
mod neighbours;
mod reference;
mod refusal;
mod request;
mod rest;
mod server;
mod stand_walk;
mod survey;
mod tare;
mod trial;
mod walk_test;
mod wiring;

pub use measure::{ForceRange, ForceWatch, TileRange};
pub use neighbours::Neighbours;
pub use reference::{AddressEntry, Argument, ArgumentLimits, MessageDirection, Reference};
pub use refusal::Refusal;
pub use server::{Ended, FloorCommand, Server};
pub use stand_walk::{StandNews, StandTask, StandWalk};
pub use survey::{BoardSurvey, FoundBoard, SentNumbers};
pub use tare::{TareFailure, take_tare};
pub use walk_test::{SensorVerdict, WalkTest};
pub use wiring::{FeltLoad, FeltTwice, STEP_N, Wiring, WiringStep, WiringTask, WiringWalk};
