use glam::Vec2;
use serde::Serialize;
use smallvec::SmallVec;

use crate::floor::TileId;
use crate::units::Newtons;

/// The lasting name of one contact: given when it lands, never used again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(transparent)]
pub struct ContactId(pub u32);

/// The part of a contact that one tile carries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TileLoad {
    /// The tile.
    pub tile: TileId,
    /// Its place in tile-index order.
    pub index: usize,
    /// What the contact presses on this tile, positive.
    pub force: Newtons,
    /// Where that part acts, in floor metres.
    pub centroid: Vec2,
}

/// One foot (or other object) on the floor.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// Its name, the same for as long as it stays down.
    pub id: ContactId,
    /// Force-weighted centroid, in floor metres; always finite.
    pub centroid: Vec2,
    /// Total normal force, positive.
    pub force: Newtons,
    /// Velocity of the centroid, in metres per second.
    pub velocity: Vec2,
    /// The tiles that carry it, heaviest first, at least one.
    pub tiles: SmallVec<[TileLoad; 4]>,
}
