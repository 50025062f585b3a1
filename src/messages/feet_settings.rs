//! Messages of feet themselves, as a region of a layout writes them.

use std::fmt;

use underfoot_format::{Num, num, record};

use super::sending::OscSettings;
use super::target::TargetSort;

/// Semitones of a full bend of an MPE channel, which receivers assume.
pub(super) const MPE_BEND: u8 = 48;

/// Force of a foot that counts as arrived, where a layout writes none (our choice: more than a foot that swings by).
pub const ARRIVAL_N: f32 = 40.0;

const KEYS: Num = num(0.0..=127.0);

record! {
    /// Each foot of a region as a voice of MPE: its place east bends the note, its place north is controller 74, its
    /// force is the pressure.
    pub struct MpeSettings = "Mpe", Copy => |it, faults| {
        if it.from.abs_diff(it.to) > MPE_BEND {
            let expected = "a foot that slides across bends its note by up to 48 semitones";
            faults.error(&["from", "to"], "these keys are too far apart", expected);
        }
    };
    /// The key at the western edge of the region.
    pub from: u8 = "from", KEYS => 48;
    /// The key at the eastern edge.
    pub to: u8 = "to", KEYS => 72;
    /// The number of feet that sound at once.
    pub feet: u8 = "feet", num(1.0..=15.0) => 15;
    /// The force that gives the pressure and the velocity 127.
    pub force_n: f32 = "force_n", num(20.0..=2000.0) => 800.0;
}

/// One message of the feet in a region.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactSending {
    /// The name of its target.
    pub target: String,
    /// Its content.
    pub payload: ContactPayload,
    /// The force in newtons at which a foot arrives; it leaves at half of it.
    pub press_n: f32,
}

/// The content of a message of feet.
#[derive(Clone, Debug, PartialEq)]
pub enum ContactPayload {
    /// An OSC message for each foot, with force 0 when it leaves.
    Osc(String, OscSettings),
    /// A voice of MPE for each foot.
    Mpe(MpeSettings),
    /// The pointer stands where the first foot stands in the region, whose edges are those of the screen.
    Pointer,
}

impl ContactPayload {
    /// Its name in files.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Osc(..) => "Osc",
            Self::Mpe(_) => "Mpe",
            Self::Pointer => "Pointer",
        }
    }

    /// The sort of target that receives it.
    #[must_use]
    pub const fn sort(&self) -> TargetSort {
        match self {
            Self::Osc(..) => TargetSort::Osc,
            Self::Mpe(_) => TargetSort::Midi,
            Self::Pointer => TargetSort::Keyboard,
        }
    }

    /// Maximum number of feet that it serves at once: 16 for OSC (our choice: a crowded stage), one for the pointer.
    #[must_use]
    pub const fn most_feet(&self) -> u8 {
        match self {
            Self::Osc(..) => 16,
            Self::Mpe(settings) => settings.feet,
            Self::Pointer => 1,
        }
    }
}

impl fmt::Display for ContactPayload {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Osc(address, _) => f.write_str(address),
            Self::Mpe(MpeSettings { from, to, feet, .. }) => {
                write!(f, "MPE, keys {from} to {to}, up to {feet} feet")
            }
            Self::Pointer => f.write_str("pointer at the place of the foot"),
        }
    }
}
