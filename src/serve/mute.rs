//! What a floor does not play because somebody said so.

use thiserror::Error;

use crate::feel::{CueSender, Muted};
use crate::floor::{Geometry, TileId};

/// Why something can't be muted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub(super) enum MuteError {
    /// There are no actuators.
    #[error("this floor plays nothing that could be muted")]
    Unplayed,
    /// The floor is smaller.
    #[error("the floor has no such tile")]
    OffTheFloor,
    /// The tile has no actuator.
    #[error("nothing moves that tile")]
    Unmoved,
}

/// Mutes one tile, or lets it be felt again, and says so in `muted`; tiles on the same channel go with it.
pub(super) fn mute_tile(
    geometry: &Geometry,
    feel: &mut CueSender,
    tile: TileId,
    on: bool,
    muted: &mut Muted,
) -> Result<(), MuteError> {
    let index = geometry.index(tile).ok_or(MuteError::OffTheFloor)?;
    let number = u16::try_from(index).map_err(|_| MuteError::OffTheFloor)?;
    if !feel.mute(number, on) {
        return Err(MuteError::Unmoved);
    }
    muted.tiles.clear();
    muted
        .tiles
        .extend((0..).zip(geometry.tiles()).filter(|(number, _)| feel.mutes(*number)).map(|(_, tile)| tile));
    Ok(())
}
