//! Clicks and their modes, as records of effects.

use arrayvec::ArrayVec;
use serde::{Deserialize, Serialize};

use crate::units::Newtons;
use underfoot_format::{List, Num, Rec, list, num, record};

/// Range of a mode's frequency, in hertz.
pub const MODE_HZ: std::ops::RangeInclusive<f32> = 20.0..=1000.0;

/// Maximum number of modes in one click.
pub const MAX_MODES: usize = 8;

/// Range of a force at the plate; actuators give 40 N and more.
pub(crate) const LEVEL: Num = num(0.0..=200.0).hand(0.0..=40.0);

/// Range of a frequency: within the effect's band, the actuators move it and a foot feels it.
pub(crate) const HZ: Num = num(20.0..=1000.0).bounded();

/// Range of a share.
pub(crate) const SHARE: Num = num(0.0..=1.0);

record! {
    /// One decaying resonance: `amplitude * exp(-t / decay_s) * sin(2 pi frequency_hz t)`.
    pub struct Mode = "Mode", Copy, Serialize, Deserialize;
    /// Frequency, in hertz; 20 to 1000.
    pub frequency_hz: f32 = "hz", HZ;
    /// Time in which it decays by a factor of 1/e, in seconds; 0.001 to 2.
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
    /// The push that strikes the modes.
    pub impulse: Impulse = "impulse", Rec => Impulse::default();
    /// The modes struck together.
    pub modes: ArrayVec<Mode, MAX_MODES> = "modes", MODES;
}

const MODES: List<Rec> = list("mode", MAX_MODES, Rec)
    .at_least(1, "a click needs a mode")
    .help("for no click at all write None instead of Click(...)");

impl Click {
    /// This click with its level times `share` and its frequencies times `pitch`, kept within the range of a mode.
    #[must_use]
    pub(crate) fn scaled(&self, share: f32, pitch: f32) -> Self {
        let modes = self.modes.iter().map(|mode| Mode {
            frequency_hz: (mode.frequency_hz * pitch).clamp(*MODE_HZ.start(), *MODE_HZ.end()),
            ..*mode
        });
        Self { modes: modes.collect(), level: self.level * share, impulse: self.impulse }
    }

    /// Its duration: until the slowest mode has decayed to a thousandth, in seconds.
    #[must_use]
    pub fn length_s(&self) -> f32 {
        let slowest = self.modes.iter().fold(0.0_f32, |slowest, mode| slowest.max(mode.decay_s));
        self.impulse.width_s + 6.9 * slowest
    }
}

record! {
    /// The push that strikes a click's modes.
    ///
    /// An ideal push has no width. A push with a width is a soft hammer: it hardly strikes modes with a period
    /// shorter than itself, so that the click gets rounder. The strongest mode keeps its level.
    pub struct Impulse = "Impulse", Copy, Default, Serialize, Deserialize;
    /// Duration of the push, in seconds; 0 (ideal) to 0.01.
    pub width_s: f32 = "width_ms", num(0.0..=10.0).milli() => 0.0;
    /// Its shape, from constant (0) to a bell (1).
    pub round: f32 = "round", SHARE => 0.0;
}

impl Impulse {
    /// Maximum duration of a push, in seconds.
    pub(crate) const WIDEST_S: f32 = 0.01;
}
