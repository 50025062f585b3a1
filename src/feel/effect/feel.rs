//! The effects of a control for each of its events.

use std::sync::Arc;

use super::click::SHARE;
use super::reading::{Effects, Played};
use super::{Effect, Use};
use underfoot_format::{Opt, record};

record! {
    /// The effects of a control; each may be absent.
    pub struct Feel = "Feel", Default with Effects;
    /// Felt when the control engages.
    pub press: Option<Arc<Effect>> = "press", Opt(Played(Use::Once)) => None;
    /// Felt when the control releases.
    pub release: Option<Arc<Effect>> = "release", Opt(Played(Use::Once)) => None;
    /// Felt when a foot passes a step, a detent or a choice.
    pub step: Option<Arc<Effect>> = "step", Opt(Played(Use::Step)) => None;
    /// Felt when its number reaches either end, and while a foot pushes on.
    pub end: Option<Arc<Effect>> = "end", Opt(Played(Use::End)) => None;
    /// Felt when a press becomes long or reaches its second stage; where absent, the press effect is repeated.
    pub stage: Option<Arc<Effect>> = "stage", Opt(Played(Use::Once)) => None;
    /// Felt when a first press has armed it.
    pub arm: Option<Arc<Effect>> = "arm", Opt(Played(Use::Once)) => None;
    /// Felt when the control will soon stop by itself, or when it is locked.
    pub warn: Option<Arc<Effect>> = "warn", Opt(Played(Use::Once)) => None;
    /// Felt when a foot turns it on.
    pub on: Option<Arc<Effect>> = "on", Opt(Played(Use::Once)) => None;
    /// Felt when a foot turns it off.
    pub off: Option<Arc<Effect>> = "off", Opt(Played(Use::Once)) => None;
    /// Felt for as long as a foot keeps it pressed.
    pub hold: Option<Arc<Effect>> = "hold", Opt(Played(Use::Hold)) => None;
    /// Felt while the foot slides along it.
    pub drag: Option<Arc<Effect>> = "drag", Opt(Played(Use::Drag)) => None;
    /// Share of all this that is also heard, from the floor's loudspeakers: 0 (not at all) to 1.
    pub sound: f32 = "sound", SHARE => 0.0;
}
