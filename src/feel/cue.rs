use arrayvec::ArrayVec;

use crate::units::{Instant, Newtons};

/// Most modes that one click excites.
pub const MAX_MODES: usize = 8;

/// Most tiles that one cue reaches: a foot covers at most four (paper, section 3.4).
pub const MAX_SPOTS: usize = 4;

/// Most rubbing contacts that are felt at once.
pub const MAX_RUBS: usize = 16;

/// One decaying resonance: `amplitude * exp(-t / decay_s) * sin(2 pi frequency_hz t)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    /// Frequency, in hertz; 20 to 1000.
    pub frequency_hz: f32,
    /// Time after which a factor 1/e is left, in seconds; 0.001 to 2.
    pub decay_s: f32,
    /// Share of the click's level, -1 to 1.
    pub amplitude: f32,
}

/// A short transient: a bank of decaying modes struck once.
///
/// # Source
/// `s(t) = sum a_i exp(-b_i t) sin(2 pi f_i t)` (paper, section 4.1.1).
#[derive(Clone, Debug, PartialEq)]
pub struct Click {
    /// The modes struck together.
    pub modes: ArrayVec<Mode, MAX_MODES>,
    /// Force at the plate for a mode of amplitude 1, before the spots' weights.
    pub level: Newtons,
}

/// A rubbing texture: noise whose band follows the slip speed and whose level follows speed and force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// Force at the plate at full slip speed and full normal force.
    pub level: Newtons,
    /// Centre of the noise band when barely moving, in hertz; 20 to 1000.
    pub low_hz: f32,
    /// Centre of the noise band at full slip speed, in hertz; `low_hz` to 1000.
    pub high_hz: f32,
    /// Slip speed at which level and band reach their upper end, in metres per second.
    pub full_speed_m_s: f32,
    /// Normal force at which the level reaches its upper end.
    pub full_force: Newtons,
}

/// What a control feels like; each part may be absent.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Feel {
    /// Felt when the control engages.
    pub press: Option<Click>,
    /// Felt when it lets go.
    pub release: Option<Click>,
    /// Felt when a foot passes a step, a detent or a choice.
    pub step: Option<Click>,
    /// Felt when a press becomes long or reaches its second stage; the press once more where absent.
    pub stage: Option<Click>,
    /// Felt when a first press has armed it.
    pub arm: Option<Click>,
    /// Felt when it will soon stop by itself, or is locked.
    pub warn: Option<Click>,
    /// Felt while the foot slides along it.
    pub drag: Option<Friction>,
    /// How much of its clicks is also heard, from the floor's loudspeakers: 0 (not at all) to 1.
    pub sound: f32,
}

/// One tile that a cue reaches.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spot {
    /// Tile index.
    pub tile: u16,
    /// Share of the cue's level, 0 to 1 (Eq. 4's weight of that tile).
    pub weight: f32,
}

/// The tiles that a cue reaches, at most [`MAX_SPOTS`].
pub type Spots = ArrayVec<Spot, MAX_SPOTS>;

/// A click to be played once.
#[derive(Clone, Debug, PartialEq)]
pub struct Cue {
    /// When the foot caused it, on the floor's sample clock.
    pub at: Instant,
    /// When the packet that caused it arrived, for measuring latency.
    pub received: Instant,
    /// Where it is felt.
    pub spots: Spots,
    /// What is felt.
    pub click: Click,
    /// How much of it is also heard, from the loudspeakers nearest to its spots: 0 (not at all) to 1.
    pub to_air: f32,
}

/// A foot sliding on a control, as it is now.
#[derive(Clone, Debug, PartialEq)]
pub struct Rub {
    /// Tells this rub from others from one update to the next: the contact's number.
    pub key: u32,
    /// Where it is felt.
    pub spots: Spots,
    /// What is felt.
    pub friction: Friction,
    /// Slip speed along the floor, in metres per second; not negative.
    pub speed_m_s: f32,
    /// Normal force.
    pub force: Newtons,
}

/// All feet sliding on controls at this moment; a rub that is not in it fades out.
pub type Rubs = ArrayVec<Rub, MAX_RUBS>;
