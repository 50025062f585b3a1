//! Mutes of the whole floor and of single tiles.

use crate::floor::TileId;

/// The mutes that are set.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Muted {
    /// Whether everything is muted, felt and heard.
    pub all: bool,
    /// The muted tiles, in tile-index order.
    pub tiles: Vec<TileId>,
}

impl Muted {
    /// Whether no mute is set.
    #[must_use]
    pub fn is_nothing(&self) -> bool {
        !self.all && self.tiles.is_empty()
    }
}
