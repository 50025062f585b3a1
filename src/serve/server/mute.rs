//! What a floor does not play because somebody said so.

use thiserror::Error;

use super::Server;
use crate::floor::TileId;
use crate::units::Instant;
use crate::wire::LinkState;

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

impl Server {
    /// Mutes everything, or ends that.
    pub(super) fn mute(&mut self, on: bool) -> Result<(), MuteError> {
        if self.feel.is_none() {
            return Err(MuteError::Unplayed);
        }
        if on != self.muted.all {
            self.muted.all = on;
            self.update_mute();
            self.tell_mute();
        }
        Ok(())
    }

    /// Mutes one tile, or ends that; tiles on the same channel go with it.
    pub(super) fn mute_tile(&mut self, tile: TileId, on: bool) -> Result<(), MuteError> {
        let feel = self.feel.as_mut().ok_or(MuteError::Unplayed)?;
        let geometry = self.engine.geometry();
        let index = geometry.index(tile).ok_or(MuteError::OffTheFloor)?;
        let number = u16::try_from(index).map_err(|_| MuteError::OffTheFloor)?;
        if !feel.mute(number, on) {
            return Err(MuteError::Unmoved);
        }
        let before = self.muted.tiles.len();
        let muted = (0..).zip(geometry.tiles()).filter(|(number, _)| feel.mutes(*number));
        self.muted.tiles.clear();
        self.muted.tiles.extend(muted.map(|(_, tile)| tile));
        if self.muted.tiles.len() != before {
            self.tell_mute();
        }
        Ok(())
    }

    /// Lets nothing be felt while the floor is lost or somebody wants it so.
    pub(super) fn update_mute(&mut self) {
        match &mut self.feel {
            Some(feel) if self.muted.all || self.link == LinkState::Lost => feel.silence(),
            Some(feel) => feel.resume(),
            None => {}
        }
    }

    /// Tells listeners, and shows a window at once, also while no frames come.
    fn tell_mute(&mut self) {
        if let Some(events) = &mut self.events {
            events.muted(self.source.now(), &self.muted);
        }
        self.shown = Instant::START;
        self.show(self.source.now());
    }
}
