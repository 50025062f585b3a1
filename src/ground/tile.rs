//! The state of one tile of one ground, and the inputs of its material.

use glam::Vec2;

use super::{Elastic, Motion};
use crate::sense::ContactId;
use crate::units::Instant;

/// One tile of one ground under load.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tread {
    pub(super) motion: Motion,
    /// Whether it is in motion or under load.
    pub(super) is_awake: bool,
    /// The heaviest contact on it, if any, and its present or last place.
    pub(super) contact: Option<ContactId>,
    pub(super) place: Vec2,
    /// Force of that contact, in newtons.
    pub(super) weight: f32,
    /// Share of the tile's load that is on this ground; the last contact's share after it has left.
    pub(super) share: f64,
}

/// One millisecond of one tile, the input of a material.
pub(super) struct Stride<'a> {
    pub(super) tile: usize,
    pub(super) place: Vec2,
    pub(super) elastic: &'a Elastic,
    pub(super) before: Motion,
    pub(super) after: Motion,
    /// Start of the millisecond.
    pub(super) from: Instant,
}

/// One event of a tile.
pub(super) struct TileEvent {
    /// Time within the millisecond, 0 to 1.
    pub(super) share: f64,
    pub(super) energy_j: f32,
    pub(super) place: Vec2,
    pub(super) seed: Option<u32>,
    pub(super) click: crate::feel::Click,
}
