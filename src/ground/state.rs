//! What grounds tell others: events, counters, what they look like.

use glam::Vec2;

use super::{Crack, Relief, Seed};
use crate::feel::Click;
use crate::sense::ContactId;
use crate::units::Instant;

/// A ground event: something broke or moved under a foot; one event for touch, sound and picture.
#[derive(Clone, Debug, PartialEq)]
pub struct GroundEvent {
    /// When it is felt: as long after its millisecond began as the force that caused it, one millisecond later.
    pub at: Instant,
    /// Which of the layout's grounds.
    pub ground: usize,
    /// The tile it happened on, in tile-index order.
    pub tile: usize,
    /// The contact that loads it; `None` for one that has just left.
    pub contact: Option<ContactId>,
    /// Where, in floor metres.
    pub place: Vec2,
    /// How much energy it took, in joules.
    pub energy_j: f32,
    /// The seed of the crack that it opened; `None` on grounds that don't crack.
    pub seed: Option<u32>,
    /// What is felt and heard.
    pub click: Click,
}

/// What could not be done as it should, and what was, since the ground was laid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GroundCounters {
    /// Events.
    pub events: u64,
    /// Events that came too thick to be felt one by one: more than 32 in a millisecond. They left their marks.
    pub unfelt: u64,
    /// Pieces of crack that healed before their time to make room for new ones.
    pub evicted: u64,
}

/// What one ground looks like.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GroundState {
    /// Changes whenever anything below does, but not as time alone makes things heal.
    pub revision: u64,
    /// Pieces of crack; those of one line follow each other in order.
    pub cracks: Vec<Crack>,
    /// Seeds that cracks come from.
    pub seeds: Vec<Seed>,
    /// How far it is worn.
    pub relief: Relief,
    /// What happened on it.
    pub counters: GroundCounters,
}
