//! The messages from the sensing thread to the renderer: clicks, tones and sustained cues, with their tiles.

use arrayvec::ArrayVec;
use glam::Vec2;

use super::{Click, Lasting, Manner, Tone};
use crate::units::{Instant, Newtons};

/// Maximum number of tiles that one cue reaches: a foot covers at most four (paper, section 3.4).
pub const MAX_SPOTS: usize = 4;

/// Maximum number of simultaneous sustained cues (frictions, textures, held tones).
pub const MAX_SUSTAINED: usize = 40;

/// One tile that a cue reaches.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spot {
    /// Tile index.
    pub tile: u16,
    /// Share of the cue's level, 0 to 1 (Eq. 4's weight of that tile).
    pub weight: f32,
}

/// The tiles that a cue reaches, at most `MAX_SPOTS`.
pub type Spots = ArrayVec<Spot, MAX_SPOTS>;

/// A cue that is played once: a click, or a tone of known length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cue {
    /// Time of its cause, on the floor's sample clock.
    pub at: Instant,
    /// Arrival time of the packet that caused it, for measuring latency.
    pub received: Instant,
    /// The tiles on which it is felt.
    pub spots: Spots,
    /// The click; without modes, none.
    pub click: Click,
    /// A tone beside the click or instead of it.
    pub tone: Option<Tone>,
    /// Its band, ducking and priority.
    pub manner: Manner,
    /// Share that is also heard, from the loudspeakers nearest to `heard_at`: 0 (not at all) to 1.
    pub audio_gain: f32,
    /// Place of the sound, in floor metres; the middle of its spots if `None`.
    pub heard_at: Option<Vec2>,
}

/// A cue that lasts as long as a foot slides, presses or pushes, in its present state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SustainedCue {
    /// Identifies this sustained cue from one update to the next.
    pub key: u32,
    /// The tiles on which it is felt.
    pub spots: Spots,
    /// The effect.
    pub effect: Lasting,
    /// Its band, ducking and priority.
    pub manner: Manner,
    /// Slip speed along the floor, in metres per second; not negative.
    pub speed_m_s: f32,
    /// Normal force.
    pub force: Newtons,
    /// Share that is also heard, from the loudspeakers nearest to its spots: 0 (not at all) to 1.
    pub audio_gain: f32,
}

/// All sustained cues at this moment; a sustained cue that is missing from it fades out.
pub type SustainedCues = ArrayVec<SustainedCue, MAX_SUSTAINED>;
