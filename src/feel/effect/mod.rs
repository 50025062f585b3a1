//! Haptic effects as data: named in a file of `effects/`, or written at the place of use.
//!
//! ```text
//! once:     Click  Continuous (a Tone)  Sequence    a control's event plays it
//! lasting:  Friction  StickSlip  Texture  Grains    a sliding foot drives it: slip speed, normal force
//! by value: Detents  EndStop                        a control's number drives it: which value, which side
//! ```

mod click;
mod feel;
mod knobs;
mod lasting;
mod parts;
mod reading;
mod sequence;
mod stops;
mod timeline;
mod tone;

use serde::{Deserialize, Serialize};

pub use click::{Click, Impulse, MAX_MODES, MODE_HZ, Mode};
pub use feel::Feel;
pub use lasting::{Friction, Grains, Hum, Lasting, Material, Resonance, StickSlip, Texture};
pub use reading::{Effects, NamedEffect};
pub use sequence::{CurvePoint, MAX_PARTS, Part, PartKind, Sequence};
pub use stops::{Detents, EndStop, MAX_MARKS, Push};
pub(crate) use timeline::EffectTimeline;
pub use tone::{MAX_POINTS, Tone, TonePoint};

use self::reading::BandFields;
pub use underfoot_format::hand::Knob;
use underfoot_format::{Flat, Opt, Rec, Variants, choices, num, record};

/// One effect, with its band, ducking and priority.
#[derive(Clone, Debug, PartialEq)]
pub struct Effect {
    /// The effect itself.
    pub kind: EffectKind,
    /// Its band, ducking and priority.
    pub manner: Manner,
}

choices! {
    /// The kinds of effects.
    pub enum EffectKind with Effects;
    /// Modes struck once, and optionally others at the release.
    Click(Clicks),
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
    /// Grains that crunch at random.
    Grains(Grains),
    /// A click at each step of a value.
    Detents(Detents),
    /// The ends of a value.
    EndStop(EndStop),
}

/// The cause that plays an effect; it decides which kinds fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// An event, once.
    Once,
    /// Each step of a value.
    Step,
    /// The ends of a value.
    End,
    /// A press that lasts.
    Hold,
    /// A foot that slides.
    Drag,
}

impl Use {
    /// The kinds for this use, the most common one first.
    #[must_use]
    pub const fn kinds(self) -> &'static [&'static str] {
        match self {
            Self::Once => &["Click", "Continuous", "Sequence"],
            Self::Step => &["Click", "Detents"],
            Self::End => &["Click", "EndStop"],
            Self::Hold => &["Continuous", "Sequence"],
            Self::Drag => &["Friction", "StickSlip", "Texture", "Grains"],
        }
    }

    /// Whether an effect of this kind fits this use.
    #[must_use]
    pub fn fits(self, kind: &EffectKind) -> bool {
        self.kinds().contains(&kind.name())
    }
}

record! {
    /// A click, and optionally another one for the release.
    pub struct Clicks = "Click";
    /// Felt for every event, except for releases if there is a `release`.
    pub press: Click = "", Flat;
    /// Felt for a release.
    pub release: Option<Click> = "release", Opt(Rec) => None;
}

impl EffectKind {
    /// Its name in files.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.variant()
    }

    /// The names of all kinds: first those played once, then lasting ones, then those driven by a value.
    #[must_use]
    pub const fn names() -> &'static [&'static str] {
        Self::NAMES
    }

    /// The clicks and tones that it plays; `None` for effects driven by a foot or a value.
    pub(crate) fn timeline(&self) -> Option<&dyn EffectTimeline> {
        match self {
            Self::Click(clicks) => Some(clicks),
            Self::Continuous(tone) => Some(tone),
            Self::Sequence(sequence) => Some(sequence),
            _ => None,
        }
    }

    /// The effect as a moving foot drives it; `None` for effects played once or driven by a value.
    #[must_use]
    pub fn lasting(&self) -> Option<Lasting> {
        match self {
            Self::Friction(friction) => Some(Lasting::Friction(*friction)),
            Self::StickSlip(stick) => Some(Lasting::StickSlip(*stick)),
            Self::Texture(texture) => Some(Lasting::Texture(*texture)),
            Self::Grains(grains) => Some(Lasting::Grains(*grains)),
            _ => None,
        }
    }

    /// The common part of rubbed materials; `None` for other effects.
    fn material_mut(&mut self) -> Option<&mut Material> {
        match self {
            Self::StickSlip(stick) => Some(&mut stick.material),
            Self::Texture(texture) => Some(&mut texture.material),
            Self::Grains(grains) => Some(&mut grains.material),
            _ => None,
        }
    }
}

record! {
    /// The relation of an effect to others on the same tiles.
    pub struct Manner = "Manner", Copy, Serialize, Deserialize;
    /// The frequencies that it may move, in hertz.
    pub band: Band = "band_hz", BandFields => Band::USEFUL;
    /// Attenuation of all lasting effects of the same or lower priority while it plays, in decibels; 0 to 60.
    pub duck_db: f32 = "duck_db", num(0.0..=60.0).hand(0.0..=40.0) => 0.0;
    /// Priority, 0 to 9: when there are too many voices, the one with the lowest priority is stolen.
    pub priority: u8 = "priority", num(0.0..=9.0) => 5;
}

impl Manner {
    /// The default: the useful band of the actuators, no ducking, middle priority.
    pub const PLAIN: Self = Self { band: Band::USEFUL, duck_db: 0.0, priority: 5 };
}

impl Default for Manner {
    fn default() -> Self {
        Self::PLAIN
    }
}

/// The frequency band of an effect.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Band {
    /// The lowest, in hertz; 20 to 1000.
    pub low_hz: f32,
    /// The highest, in hertz; at least 1.5 times the lowest, at most 1000.
    pub high_hz: f32,
}

impl Band {
    /// The band that actuators move well and soles feel: 50 to 750 Hz.
    pub const USEFUL: Self = Self { low_hz: 50.0, high_hz: 750.0 };

    /// Whether the band contains this frequency.
    #[must_use]
    pub fn contains(&self, hz: f32) -> bool {
        (self.low_hz..=self.high_hz).contains(&hz)
    }

    /// The nearest frequency within the band; the lowest for NaN.
    #[must_use]
    pub fn clamp(&self, hz: f32) -> f32 {
        if hz.is_nan() { self.low_hz } else { hz.max(self.low_hz).min(self.high_hz) }
    }

    /// The band limited to the range of a voice: finite numbers, in order, within 20 to 1000 Hz.
    #[must_use]
    pub fn sound(&self) -> Self {
        let low = if self.low_hz >= 20.0 { self.low_hz.min(600.0) } else { 20.0 };
        let high = if self.high_hz <= 1000.0 { self.high_hz } else { 1000.0 };
        Self { low_hz: low, high_hz: high.max(1.5 * low) }
    }
}

impl From<Click> for Effect {
    fn from(press: Click) -> Self {
        Self { kind: EffectKind::Click(Clicks { press, release: None }), manner: Manner::PLAIN }
    }
}

impl From<Friction> for Effect {
    fn from(friction: Friction) -> Self {
        Self { kind: EffectKind::Friction(friction), manner: Manner::PLAIN }
    }
}
