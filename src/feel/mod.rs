//! The haptic renderer: cues in, actuator samples out.
//!
//! ```text
//! CueSender ==ring==> schedule -> clicks strike ModalBanks -+
//!                              -> tones -+                 |
//!           ==sustained cues======> voices of what lasts --+-> mix -> rack -> samples
//! ```
//!
//! [`renderer()`] makes both ends. Everything behind [`Renderer::render`] is free of allocation, locks, logs and
//! system calls. Two tools check that: clippy rejects the types, methods and macros that `clippy.toml` lists in all
//! of this module, and `tests/measured` renders the busiest ten seconds under `assert_no_alloc`.

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
mod silence;
mod voice;

pub use audition::{Gesture, Moment};
pub use cue::{Cue, Spot, Spots, SustainedCue, SustainedCues};
pub use device_status::{DeviceState, DeviceStatus, Priority};
pub use effect::{
    Band, Click, Clicks, CurvePoint, Detents, Effect, EffectKind, Effects, EndStop, Feel, Friction, Grains,
    Hum, Impulse, Lasting, Manner, Material, Mode, NamedEffect, Part, PartKind, Push, Resonance, Sequence,
    StickSlip, Texture, Tone, TonePoint,
};
pub use muted::Muted;
pub use renderer::{Renderer, RendererConfig, renderer};

pub use analysis::{Analysis, analyse};
pub use audition::{Audition, audition};
pub use cue::{MAX_SPOTS, MAX_SUSTAINED};
pub use effect::{Knob, MAX_MARKS, MAX_MODES, MAX_PARTS, MAX_POINTS, MODE_HZ, Use};
pub use modal::ModalBank;
pub use player::{Player, key};
pub use renderer::Onset;
pub use scope::{MinMax, ScopeReader};
pub use sender::{CueSender, FeelCounters};
