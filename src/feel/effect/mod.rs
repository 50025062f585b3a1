//! What a floor can feel like, as data: named in a file of `effects/`, or written where it is used.
//!
//! ```text
//! once:     Click  Continuous (a Tone)  Sequence    a control's event plays it
//! lasting:  Friction  StickSlip  Texture  Grains    a sliding foot drives it: slip speed, normal force
//! by value: Detents  EndStop                        a control's number drives it: which value, which side
//! ```

mod feel;
mod lasting;
mod sequence;
mod stops;
mod tone;

pub use feel::{Feel, Use};
pub use lasting::{Friction, Grains, Hum, Lasting, Material, Resonance, StickSlip, Texture};
pub use sequence::{Beat, CurvePoint, MAX_PARTS, Part, Sequence};
pub use stops::{Detents, EndStop, MAX_MARKS, Push};
pub use tone::{MAX_POINTS, Tone, TonePoint};

use super::Click;

/// One effect, with how it gets along with others.
#[derive(Clone, Debug, PartialEq)]
pub struct Effect {
    /// What is felt.
    pub kind: EffectKind,
    /// How it gets along with what else is felt.
    pub manner: Manner,
}

/// What is felt.
#[derive(Clone, Debug, PartialEq)]
pub enum EffectKind {
    /// Modes struck once, and perhaps others where the foot lets go.
    Click {
        /// Felt wherever it is played, but for releases if there is a `release`.
        press: Click,
        /// Felt where it answers a release.
        release: Option<Click>,
    },
    /// A tone or a band of noise under an envelope.
    Continuous(Tone),
    /// Clicks and tones one after the other.
    Sequence(Sequence),
    /// Rubbing: noise whose band follows the slip speed. The cheap model.
    Friction(Friction),
    /// Sticking and slipping. The physical model.
    StickSlip(StickSlip),
    /// Ridges at even distances.
    Texture(Texture),
    /// Grains that crunch by chance.
    Grains(Grains),
    /// A click at each step of a value.
    Detents(Detents),
    /// The ends of a value.
    EndStop(EndStop),
}

impl EffectKind {
    /// The name by which files call it.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Click { .. } => "Click",
            Self::Continuous(_) => "Continuous",
            Self::Sequence(_) => "Sequence",
            Self::Friction(_) => "Friction",
            Self::StickSlip(_) => "StickSlip",
            Self::Texture(_) => "Texture",
            Self::Grains(_) => "Grains",
            Self::Detents(_) => "Detents",
            Self::EndStop(_) => "EndStop",
        }
    }

    /// What it is when a moving foot drives it; `None` for what is played once or driven by a value.
    #[must_use]
    pub fn lasting(&self) -> Option<Lasting> {
        match self {
            Self::Friction(friction) => Some(Lasting::Friction(*friction)),
            Self::StickSlip(stick) => Some(Lasting::StickSlip(*stick)),
            Self::Texture(texture) => Some(Lasting::Texture(*texture)),
            Self::Grains(grains) => Some(Lasting::Grains(*grains)),
            Self::Click { .. }
            | Self::Continuous(_)
            | Self::Sequence(_)
            | Self::Detents(_)
            | Self::EndStop(_) => None,
        }
    }
}

/// How an effect gets along with what else is felt on the same tiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Manner {
    /// What it may move, in hertz.
    pub band: Band,
    /// How far everything that lasts and is no more important goes down while it plays, in decibels; 0 to 60.
    pub duck_db: f32,
    /// How important it is, 0 to 9: when there are too many voices, the least important one makes room.
    pub priority: u8,
}

impl Manner {
    /// That of effects that don't say: the useful band of the actuators, no ducking, of middling importance.
    pub const PLAIN: Self = Self { band: Band::USEFUL, duck_db: 0.0, priority: 5 };
}

impl Default for Manner {
    fn default() -> Self {
        Self::PLAIN
    }
}

/// The frequencies that an effect keeps to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// The lowest, in hertz; 20 to 1000.
    pub low_hz: f32,
    /// The highest, in hertz; at least 1.5 times the lowest, at most 1000.
    pub high_hz: f32,
}

impl Band {
    /// What the actuators move well and soles feel: 50 to 750 Hz.
    pub const USEFUL: Self = Self { low_hz: 50.0, high_hz: 750.0 };

    /// Whether it holds this frequency.
    #[must_use]
    pub fn contains(&self, hz: f32) -> bool {
        (self.low_hz..=self.high_hz).contains(&hz)
    }

    /// The nearest frequency within; the lowest for NaN.
    #[must_use]
    pub fn clamp(&self, hz: f32) -> f32 {
        if hz.is_nan() { self.low_hz } else { hz.max(self.low_hz).min(self.high_hz) }
    }

    /// The same, brought to what a voice can keep: ordinary numbers, in order, within 20 to 1000 Hz.
    #[must_use]
    pub fn sound(&self) -> Self {
        let low = if self.low_hz >= 20.0 { self.low_hz.min(600.0) } else { 20.0 };
        let high = if self.high_hz <= 1000.0 { self.high_hz } else { 1000.0 };
        Self { low_hz: low, high_hz: high.max(1.5 * low) }
    }
}

impl From<Click> for Effect {
    fn from(press: Click) -> Self {
        Self { kind: EffectKind::Click { press, release: None }, manner: Manner::PLAIN }
    }
}

impl From<Friction> for Effect {
    fn from(friction: Friction) -> Self {
        Self { kind: EffectKind::Friction(friction), manner: Manner::PLAIN }
    }
}
