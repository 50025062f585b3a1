//! What the floor feels like: cues in, actuator samples out.

mod cue;

pub use cue::{Click, Cue, Feel, Friction, MAX_MODES, MAX_RUBS, MAX_SPOTS, Mode, Rub, Rubs, Spot, Spots};
