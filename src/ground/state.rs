//! The output of grounds: events, counters and visible state.

use glam::Vec2;

use super::{Crack, Relief, Seed};
use crate::feel::Click;
use crate::sense::ContactId;
use crate::units::Instant;

/// A ground event: a crack, a collision or a slip under a foot; one event for touch, sound and picture.
#[derive(Clone, Debug, PartialEq)]
pub struct GroundEvent {
    /// Playback time: one millisecond after the force that caused it, with the same place within the millisecond.
    pub at: Instant,
    /// Index of the layout's ground.
    pub ground: usize,
    /// Index of the tile, in tile-index order.
    pub tile: usize,
    /// The contact that loads it; `None` if it has just left.
    pub contact: Option<ContactId>,
    /// Its place, in floor metres.
    pub place: Vec2,
    /// Its energy, in joules.
    pub energy_j: f32,
    /// The seed of the crack that it opened; `None` on grounds that don't crack.
    pub seed: Option<u32>,
    /// Its click, felt and heard.
    pub click: Click,
}

/// Counts of events and of faults since the start of the ground.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GroundCounters {
    /// Events.
    pub events: u64,
    /// Events that were not felt one by one because there were more than 32 in a frame. They left their marks.
    pub unfelt: u64,
    /// Pieces of crack that new ones evicted before their time.
    pub evicted: u64,
}

/// The visible state of one ground.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GroundState {
    /// Changes whenever anything below does, except for healing by time alone.
    pub revision: u64,
    /// Pieces of crack; those of one line follow each other in order.
    pub cracks: Vec<Crack>,
    /// Seeds, the origins of cracks.
    pub seeds: Vec<Seed>,
    /// Its wear.
    pub relief: Relief,
    /// Counts of its events.
    pub counters: GroundCounters,
}
