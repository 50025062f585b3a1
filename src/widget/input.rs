//! The input of one control in one frame.

use glam::Vec2;

use crate::units::Newtons;

/// The input of one control in one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Input {
    /// A foot is on it, or it keeps the foot that engaged it.
    Foot {
        /// The foot's force; zero for a foot that has just left the floor.
        force: Newtons,
        /// Whether the force is reliable enough to start an engagement.
        trusted: bool,
        /// Place of the foot: 0 to 1 across the control from west to east and from south to north, beyond that
        /// outside.
        place: Vec2,
        /// The weight of the foot's person; `None` while it is unknown.
        weight: Option<Newtons>,
    },
    /// No foot is on it.
    Clear,
    /// A foot that was already loaded slid onto it; the control works only once it has been seen unloaded.
    SlidOn {
        /// The foot's force.
        force: Newtons,
    },
    /// The foot on it takes a step: it carries the body, rolls over or belongs to a walk.
    ///
    /// A press is cancelled, none begins, and the control works only once it has been seen unloaded.
    Stepping {
        /// The foot's force.
        force: Newtons,
    },
    /// The foot that engaged it left it without lifting.
    SlidOff,
    /// The floor under it is not sensed.
    Lost,
}

/// A small lamp on a control, set only by apps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Indicator {
    /// No lamp.
    #[default]
    Off,
    /// The function of the control is active.
    On,
    /// The function of the control is in progress.
    Busy,
    /// The function of the control needs attention.
    Attention,
}

impl Indicator {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Off, Self::On, Self::Busy, Self::Attention];

    /// Its name: `off`, `on`, `busy` or `attention`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::On => "on",
            Self::Busy => "busy",
            Self::Attention => "attention",
        }
    }
}
