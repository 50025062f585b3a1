//! One tile of one ground, and what a material is told of it.

use glam::Vec2;

use super::{Elastic, Motion};
use crate::sense::ContactId;
use crate::units::Instant;

/// One tile of one ground under load.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tread {
    pub(super) motion: Motion,
    /// Whether it is followed.
    pub(super) is_awake: bool,
    /// The contact that presses it hardest, if any does, and where that is or was.
    pub(super) contact: Option<ContactId>,
    pub(super) place: Vec2,
    /// Force of that contact, in newtons.
    pub(super) weight: f32,
    /// Share of the tile's load that is on this ground; that of the last contact once it has gone.
    pub(super) share: f64,
}

/// One tile's millisecond, as a material sees it.
pub(super) struct Stride<'a> {
    pub(super) tile: usize,
    pub(super) place: Vec2,
    pub(super) elastic: &'a Elastic,
    pub(super) before: Motion,
    pub(super) after: Motion,
    /// When it begins.
    pub(super) from: Instant,
}

/// One event of a tile.
pub(super) struct Event {
    /// When in the millisecond, 0 to 1.
    pub(super) share: f64,
    pub(super) energy_j: f32,
    pub(super) place: Vec2,
    pub(super) seed: Option<u32>,
    pub(super) click: crate::feel::Click,
}
