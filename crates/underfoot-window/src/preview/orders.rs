//! The commands of the window that a floor carries out by itself.

use super::feed::PreviewCommand;
use underfoot::serve::Command;
use underfoot::wire::ControlMessage;

impl PreviewCommand {
    /// The same command for a running floor.
    ///
    /// # Errors
    /// Returns a command unchanged that concerns layouts, files or checks: the program carries it out.
    pub fn for_floor(self) -> Result<Command, Self> {
        let message = match self {
            Self::Enable { id, enabled: true } => ControlMessage::Enable { id },
            Self::Enable { id, enabled: false } => ControlMessage::Disable { id },
            Self::Set { id, value } => ControlMessage::Set { id, value },
            Self::Mute(on) => ControlMessage::Mute { on },
            Self::MuteTile { tile, on } => ControlMessage::MuteTile { tile, on },
            Self::Feel { effect, gesture, tile } => {
                let tile = u16::try_from(tile).unwrap_or(u16::MAX);
                return Ok(Command::Audition { effect, gesture: Box::new(gesture), tile });
            }
            other => return Err(other),
        };
        Ok(Command::Control(message))
    }
}
