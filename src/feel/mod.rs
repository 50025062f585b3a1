//! What the floor feels like: cues in, actuator samples out.
//!
//! ```text
//! CueSender ==ring==> schedule -> clicks strike ModalBanks -+
//!           ==rubs==> friction voices ---------------------+-> mix -> limiter -> samples
//! ```
//!
//! [`renderer()`] makes both ends. Everything behind [`Renderer::render`] is
//! free of allocation, locks, logs and system calls.

mod click;
mod cue;
mod device_status;
mod friction;
mod limiter;
mod mix;
mod modal;
mod newest;
mod renderer;
mod schedule;
mod scope;
mod sender;

pub use cue::{Click, Cue, Feel, Friction, MAX_MODES, MAX_RUBS, MAX_SPOTS, Mode, Rub, Rubs, Spot, Spots};
pub use device_status::{DeviceState, DeviceStatus, Priority};
pub use modal::ModalBank;
pub use renderer::{Onset, Renderer, RendererConfig, renderer};
pub use scope::{MinMax, ScopeReader};
pub use sender::{CueSender, FeelCounters};
