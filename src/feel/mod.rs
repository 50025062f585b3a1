//! What the floor feels like: cues in, actuator samples out.
//!
//! ```text
//! CueSender ==ring==> schedule -> clicks strike ModalBanks -+
//!           ==rubs==> friction voices ---------------------+-> mix -> rack -> samples
//! ```
//!
//! [`renderer()`] makes both ends. Everything behind [`Renderer::render`] is
//! free of allocation, locks, logs and system calls.

mod click;
mod cue;
mod friction;
mod limiter;
mod loudspeakers;
mod mix;
mod modal;
mod rack;
mod renderer;
mod ringing;
mod schedule;
mod scope;
mod sender;

pub use cue::{Click, Cue, Feel, Friction, MAX_MODES, MAX_RUBS, MAX_SPOTS, Mode, Rub, Rubs, Spot, Spots};
pub use modal::ModalBank;
pub use renderer::{Onset, Renderer, RendererConfig, renderer};
pub use scope::{MinMax, ScopeReader};
pub use sender::{CueSender, FeelCounters};
