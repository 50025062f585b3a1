//! What is muted.

use crate::floor::TileId;

/// What somebody has muted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Muted {
    /// Whether nothing is felt or heard at all.
    pub all: bool,
    /// The tiles that are not felt, in tile-index order.
    pub tiles: Vec<TileId>,
}

impl Muted {
    /// Whether everything can be felt.
    #[must_use]
    pub fn is_nothing(&self) -> bool {
        !self.all && self.tiles.is_empty()
    }
}
