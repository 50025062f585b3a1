//! What goes from the sensing thread to the renderer: clicks, tones and what lasts, and where they are felt.

use arrayvec::ArrayVec;
use glam::Vec2;

use super::{Click, Lasting, Manner, Tone};
use crate::units::{Instant, Newtons};

/// Most tiles that one cue reaches: a foot covers at most four (paper, section 3.4).
pub const MAX_SPOTS: usize = 4;

/// Most things that last (frictions, textures, held tones) and are felt at once.
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

/// What is to be played once: a click, or something that lasts a known time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cue {
    /// When the foot caused it, on the floor's sample clock.
    pub at: Instant,
    /// When the packet that caused it arrived, for measuring latency.
    pub received: Instant,
    /// Where it is felt.
    pub spots: Spots,
    /// The click that is felt; without modes, none.
    pub click: Click,
    /// What sounds for a while, beside the click or instead of it.
    pub tone: Option<Tone>,
    /// How it gets along with what else is felt there.
    pub manner: Manner,
    /// How much of it is also heard, from the loudspeakers nearest to `heard_at`: 0 (not at all) to 1.
    pub audio_gain: f32,
    /// Where it is heard, in floor metres; from the middle of its spots if `None`.
    pub heard_at: Option<Vec2>,
}

/// Something felt for as long as a foot slides, presses or pushes, as it is now.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SustainedCue {
    /// Tells this sustained cue from others from one update to the next.
    pub key: u32,
    /// Where it is felt.
    pub spots: Spots,
    /// What is felt.
    pub effect: Lasting,
    /// How it gets along with what else is felt there.
    pub manner: Manner,
    /// Slip speed along the floor, in metres per second; not negative.
    pub speed_m_s: f32,
    /// Normal force.
    pub force: Newtons,
    /// How much of it is also heard, from the loudspeakers nearest to its spots: 0 (not at all) to 1.
    pub audio_gain: f32,
}

/// All that lasts at this moment; a sustained cue that is not in it fades out.
pub type SustainedCues = ArrayVec<SustainedCue, MAX_SUSTAINED>;
