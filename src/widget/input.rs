//! What one control senses in one frame.

use glam::Vec2;

use crate::units::Newtons;

/// What one control senses in one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Input {
    /// A foot is on it, or it keeps the foot that engaged it.
    Foot {
        /// The foot's force; zero for a foot that has just left the floor.
        force: Newtons,
        /// Whether the force is good enough to start an engagement.
        trusted: bool,
        /// Where the foot is: 0 to 1 across the control from west to east and from south to north, beyond that outside.
        place: Vec2,
        /// The weight of the person whose foot it is; `None` while it is not known.
        weight: Option<Newtons>,
    },
    /// No foot is on it.
    Clear,
    /// A foot that was already loaded slid onto it; it must be seen unloaded before it works.
    SlidOn {
        /// The foot's force.
        force: Newtons,
    },
    /// The foot on it takes a step: it carries the body, rolls over or belongs to a walk.
    ///
    /// A press is cancelled, none begins, and the control must be seen unloaded before it works.
    Stepping {
        /// The foot's force.
        force: Newtons,
    },
    /// The foot that engaged it left it without lifting.
    SlidOff,
    /// The floor under it can't be sensed.
    Lost,
}

/// A small lamp on a control, which only apps switch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Indicator {
    /// No lamp.
    #[default]
    Off,
    /// What the control stands for is at work.
    On,
    /// What the control stands for is on its way.
    Busy,
    /// What the control stands for needs looking after.
    Attention,
}

impl Indicator {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Off, Self::On, Self::Busy, Self::Attention];

    /// The word for it: `off`, `on`, `busy` or `attention`.
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
