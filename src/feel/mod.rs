//! What the floor feels like: cues in, actuator samples out.
//!
//! ```text
//! CueSender ==ring==> schedule -> clicks strike ModalBanks -+
//!                              -> tones -+                 |
//!           ==sustained cues======> voices of what lasts --+-> mix -> rack -> samples
//! ```
//!
//! [`renderer()`] makes both ends. Everything behind [`Renderer::render`] is
//! free of allocation, locks, logs and system calls. Two tools check that: clippy refuses the types, methods and
//! macros that `clippy.toml` lists in all of this module, and `tests/measured` renders the busiest ten seconds under
//! `assert_no_alloc`.

#![deny(clippy::disallowed_macros, clippy::disallowed_methods, clippy::disallowed_types)]

mod active_modes;
mod analysis;
mod audition;
mod click;
mod cue;
mod device_status;
mod effect;
mod evicting_queue;
mod limiter;
mod loudspeakers;
mod mix;
mod modal;
mod muted;
mod player;
mod push;
mod rack;
mod renderer;
mod schedule;
mod scope;
mod sender;
mod voice;

pub use analysis::{Analysis, analyse};
pub use audition::{Audition, Gesture, Moment, audition};
pub use cue::{Cue, MAX_SPOTS, MAX_SUSTAINED, Spot, Spots, SustainedCue, SustainedCues};
pub use device_status::{DeviceState, DeviceStatus, Priority};
pub(crate) use effect::effect_at;
pub use effect::{
    Band, Click, Clicks, CurvePoint, Detents, Effect, EffectKind, Effects, EndStop, Feel, Friction, Grains,
    Hum, Impulse, Knob, Lasting, MAX_MARKS, MAX_MODES, MAX_PARTS, MAX_POINTS, MODE_HZ, Manner, Material,
    Mode, NamedEffect, Part, PartKind, Push, Resonance, Sequence, StickSlip, Texture, Tone, TonePoint, Use,
};
pub use modal::ModalBank;
pub use muted::Muted;
pub use player::{Player, key};
pub use renderer::{Onset, Renderer, RendererConfig, renderer};
pub use scope::{MinMax, ScopeReader};
pub use sender::{CueSender, FeelCounters};
