//! Clicks and their modes, as effects describe them.

use arrayvec::ArrayVec;
use serde::{Deserialize, Serialize};

use crate::format::{List, Num, Rec, list, num, record};
use crate::units::Newtons;

/// Frequencies that a mode may have, in hertz.
pub const MODE_HZ: std::ops::RangeInclusive<f32> = 20.0..=1000.0;

/// Most modes that one click excites.
pub const MAX_MODES: usize = 8;

/// Force at the plate; actuators give 40 N and more.
pub(crate) const LEVEL: Num = num(0.0..=200.0).hand(0.0..=40.0);

/// What the floor's actuators move and a foot can feel, within the effect's band.
pub(crate) const HZ: Num = num(20.0..=1000.0).bounded();

/// A share.
pub(crate) const SHARE: Num = num(0.0..=1.0);

record! {
    /// One decaying resonance: `amplitude * exp(-t / decay_s) * sin(2 pi frequency_hz t)`.
    pub struct Mode = "Mode", Copy, Serialize, Deserialize;
    /// Frequency, in hertz; 20 to 1000.
    pub frequency_hz: f32 = "hz", HZ;
    /// Time after which a factor 1/e is left, in seconds; 0.001 to 2.
    pub decay_s: f32 = "decay_ms", num(1.0..=2000.0).milli();
    /// Share of the click's level, -1 to 1.
    pub amplitude: f32 = "amplitude", num(-1.0..=1.0) => 1.0;
}

record! {
    /// A short transient: a bank of decaying modes struck once.
    ///
    /// # Source
    /// `s(t) = sum a_i exp(-b_i t) sin(2 pi f_i t)` (paper, section 4.1.1).
    pub struct Click = "Click", Default, Serialize, Deserialize;
    /// Force at the plate for a mode of amplitude 1, before the spots' weights.
    pub level: Newtons = "level_n", LEVEL;
    /// What they are struck with.
    pub impulse: Impulse = "impulse", Rec => Impulse::default();
    /// The modes struck together.
    pub modes: ArrayVec<Mode, MAX_MODES> = "modes", MODES;
}

const MODES: List<Rec> = list("mode", MAX_MODES, Rec)
    .at_least(1, "a click needs a mode")
    .help("for no click at all write None instead of Click(...)");

impl Click {
    /// The same, `share` times as strong and with every frequency times `pitch` (within what a mode may have).
    #[must_use]
    pub(crate) fn scaled(&self, share: f32, pitch: f32) -> Self {
        let modes = self.modes.iter().map(|mode| Mode {
            frequency_hz: (mode.frequency_hz * pitch).clamp(*MODE_HZ.start(), *MODE_HZ.end()),
            ..*mode
        });
        Self { modes: modes.collect(), level: self.level * share, impulse: self.impulse }
    }

    /// How long it is felt: until its slowest mode has fallen to a thousandth, in seconds.
    #[must_use]
    pub fn length_s(&self) -> f32 {
        let slowest = self.modes.iter().fold(0.0_f32, |slowest, mode| slowest.max(mode.decay_s));
        self.impulse.width_s + 6.9 * slowest
    }
}

record! {
    /// The push that strikes a click's modes.
    ///
    /// An ideal one lasts no time. One with a width is a soft hammer: what swings
    /// faster than it lasts is hardly struck, so that the click gets rounder. The
    /// strongest mode keeps its level.
    pub struct Impulse = "Impulse", Copy, Default, Serialize, Deserialize;
    /// How long the push lasts, in seconds; 0 (ideal) to 0.01.
    pub width_s: f32 = "width_ms", num(0.0..=10.0).milli() => 0.0;
    /// Its shape, from an even push (0) to a bell (1).
    pub round: f32 = "round", SHARE => 0.0;
}

impl Impulse {
    /// The longest push.
    pub(crate) const WIDEST_S: f32 = 0.01;
}
