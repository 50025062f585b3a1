//! The guided set-up of a floor: from boards that send to a floor file and a first layout.
//!
//! ```text
//! boards -BoardListener (program)-> HeardBoards -wires-> boards and serial ports of a floor
//! packets -SetupBench-> walks, readings, fits -SetupView-> the window
//! the window -SetupOrder-> SetupBench -SetupRequest-> files, sockets and threads of the program
//! ```
//!
//! | file | content |
//! |---|---|
//! | `heard` | the boards that send to this machine, and how to describe them |
//! | `shape` | the plates to choose from |
//! | `wires` | channels of boards given to the sensors of a floor |
//! | `first_layout` | a button on each tile |
//! | `standing` | marks in words; the laws that a person's stands give, in the floor |
//! | `bench` | the steps at work: packets and orders in, a view and requests out; without threads, files and clocks |
//! | `window` | the window (feature `window`; no browser has boards) |
//!
//! The set-up at the terminal shares all but the last two.

mod bench;
mod first_layout;
mod heard;
mod messages;
mod shape;
#[cfg(test)]
mod site;
mod standing;
mod step;
mod view;
#[cfg(all(feature = "window", not(target_arch = "wasm32")))]
mod window;
mod wires;

pub use bench::{FitJob, SetupBench};
pub use first_layout::first_layout;
pub use heard::{HeardBoards, board_kind, board_name, live_words};
pub use messages::{SetupAnswer, SetupInput, SetupOrder, SetupRequest};
pub use shape::{FloorShape, GridShape, SHIPPED_SHAPES};
pub use standing::{fit_words, keep_laws, mark_words, needy_tiles};
pub use step::SetupStep;
pub use view::{
    BoardView, SensorState, SensorView, SetupView, StandingView, StepState, StepView, WiringView, WorkView,
};
#[cfg(all(feature = "window", not(target_arch = "wasm32")))]
pub use window::{SetupChannels, SetupOptions, run};
pub use wires::{Wires, assign};
