//! Requests of apps in OSC. The decoder, the reference and the tests share one table.

use rosc::OscType;

use super::argument::{ArgumentKind, DecodedArgument};
use super::message::ControlMessage;
use super::pattern::{is_pattern, matches};
use super::prefix::Prefix;
use crate::floor::SensorChoice;
use crate::widget::WidgetId;

/// One request that apps can make.
#[derive(Clone, Copy, Debug)]
pub struct Command {
    /// The address behind the prefix; `<id>` stands for a control's id.
    pub path: &'static str,
    /// Its arguments.
    pub argument: ArgumentKind,
    /// Its effect, in a sentence.
    pub says: &'static str,
    make: fn(WidgetId, DecodedArgument) -> Option<ControlMessage>,
}

/// All requests that apps can make.
pub const COMMANDS: [Command; 19] = [
    Command {
        path: "get",
        argument: ArgumentKind::Nothing,
        says: "Answer with everything: each control's value, state, range and page; the page that is shown; what is muted.",
        make: |_, _| Some(ControlMessage::GetAll),
    },
    Command {
        path: "widget/<id>/set",
        argument: ArgumentKind::Value,
        says: "Hold this value; refused while a foot uses the control, while it is locked, and for what only a foot holds.",
        make: |id, argument| match argument {
            DecodedArgument::Value(value) => Some(ControlMessage::Set { id, value }),
            _ => None,
        },
    },
    Command {
        path: "widget/<id>/get",
        argument: ArgumentKind::Nothing,
        says: "Answer with value and state.",
        make: |id, _| Some(ControlMessage::Get { id }),
    },
    Command {
        path: "widget/<id>/enable",
        argument: ArgumentKind::Switch,
        says: "React to feet again.",
        make: |id, argument| match argument {
            DecodedArgument::Flag(true) => Some(ControlMessage::Enable { id }),
            DecodedArgument::Flag(false) => Some(ControlMessage::Disable { id }),
            _ => None,
        },
    },
    Command {
        path: "widget/<id>/disable",
        argument: ArgumentKind::Switch,
        says: "React to feet no more; a press under way is cancelled.",
        make: |id, argument| match argument {
            DecodedArgument::Flag(true) => Some(ControlMessage::Disable { id }),
            DecodedArgument::Flag(false) => Some(ControlMessage::Enable { id }),
            _ => None,
        },
    },
    Command {
        path: "widget/<id>/lock",
        argument: ArgumentKind::Switch,
        says: "Keep the value, whatever feet and apps do; a press under way is cancelled.",
        make: |id, argument| match argument {
            DecodedArgument::Flag(true) => Some(ControlMessage::Lock { id }),
            DecodedArgument::Flag(false) => Some(ControlMessage::Unlock { id }),
            _ => None,
        },
    },
    Command {
        path: "widget/<id>/unlock",
        argument: ArgumentKind::Switch,
        says: "Change the value again.",
        make: |id, argument| match argument {
            DecodedArgument::Flag(true) => Some(ControlMessage::Unlock { id }),
            DecodedArgument::Flag(false) => Some(ControlMessage::Lock { id }),
            _ => None,
        },
    },
    Command {
        path: "widget/<id>/label",
        argument: ArgumentKind::Label,
        says: "Carry this label.",
        make: |id, argument| match argument {
            DecodedArgument::Text(text) => Some(ControlMessage::Label { id, text }),
            _ => None,
        },
    },
    Command {
        path: "widget/<id>/indicator",
        argument: ArgumentKind::Indicator,
        says: "Switch the lamp.",
        make: |id, argument| match argument {
            DecodedArgument::Indicator(indicator) => Some(ControlMessage::Indicate { id, indicator }),
            _ => None,
        },
    },
    Command {
        path: "widget/<id>/range/set",
        argument: ArgumentKind::Range,
        says: "Have this range, also in layouts that come later; the value is brought into it.",
        make: |id, argument| match argument {
            DecodedArgument::Range(least, greatest) => Some(ControlMessage::SetRange { id, least, greatest }),
            _ => None,
        },
    },
    Command {
        path: "page/set",
        argument: ArgumentKind::Page,
        says: "Show this page, as soon as no foot is engaged.",
        make: |_, argument| match argument {
            DecodedArgument::Text(text) => Some(ControlMessage::ShowPage { page: WidgetId::new(&text) }),
            _ => None,
        },
    },
    Command {
        path: "page/get",
        argument: ArgumentKind::Nothing,
        says: "Answer with the page that is shown.",
        make: |_, _| Some(ControlMessage::GetPage),
    },
    Command {
        path: "cancel",
        argument: ArgumentKind::Nothing,
        says: "Cancel what feet hold; nothing is held until a foot lifts and presses anew.",
        make: |_, _| Some(ControlMessage::CancelAll),
    },
    Command {
        path: "mute/set",
        argument: ArgumentKind::Flag,
        says: "Let nothing be felt or heard (1), or everything again but single tiles that are muted (0).",
        make: |_, argument| match argument {
            DecodedArgument::Flag(on) => Some(ControlMessage::Mute { on }),
            _ => None,
        },
    },
    Command {
        path: "mute/tile",
        argument: ArgumentKind::TileFlag,
        says: "Let the actuator of one tile not be felt (1), or again (0); loudspeakers go on.",
        make: |_, argument| match argument {
            DecodedArgument::TileFlag(tile, on) => Some(ControlMessage::MuteTile { tile, on }),
            _ => None,
        },
    },
    Command {
        path: "mute/get",
        argument: ArgumentKind::Nothing,
        says: "Answer with what is muted.",
        make: |_, _| Some(ControlMessage::GetMute),
    },
    Command {
        path: "sensor/tile",
        argument: ArgumentKind::TileFlag,
        says: "Ignore all sensors of a tile (0), or use them again (1), until the program ends.",
        make: |_, argument| match argument {
            DecodedArgument::TileFlag(tile, on) => {
                Some(ControlMessage::UseSensors { choice: SensorChoice::Tile(tile), on })
            }
            _ => None,
        },
    },
    Command {
        path: "sensor/set",
        argument: ArgumentKind::SensorFlag,
        says: "Ignore a sensor (0), or use it again (1), until the program ends; its tile goes on with the others.",
        make: |_, argument| use_sensors(&argument),
    },
    Command {
        path: "sensor/channel",
        argument: ArgumentKind::ChannelFlag,
        says: "The same for the sensor on a channel of a board.",
        make: |_, argument| use_sensors(&argument),
    },
];

fn use_sensors(argument: &DecodedArgument) -> Option<ControlMessage> {
    match *argument {
        DecodedArgument::SensorsFlag(choice, on) => Some(ControlMessage::UseSensors { choice, on }),
        _ => None,
    }
}

/// Reason for which a message is not a command.
pub(super) enum NoCommand {
    /// No command has such an address.
    Unknown,
    /// The command expects these arguments.
    Expected(&'static str),
}

impl Command {
    /// Returns the part of `path` in the place of `<id>`, empty without `<id>`; `None` if the address does not match.
    fn id_in<'a>(&self, path: &'a str) -> Option<&'a str> {
        match self.path.split_once("<id>") {
            Some((before, after)) => {
                let id = path.strip_prefix(before)?.strip_suffix(after)?;
                (!id.is_empty() && !id.contains('/')).then_some(id)
            }
            None => (path == self.path).then_some(""),
        }
    }

    /// Returns the part of `pattern` in the place of `<id>`, empty without `<id>`; `None` if the pattern does not
    /// match.
    fn id_in_pattern<'a>(&self, prefix: &Prefix, pattern: &'a str) -> Option<&'a str> {
        let address = prefix.address(self.path);
        let (mut id, mut parts) = ("", pattern.split('/'));
        for part in address.split('/') {
            let wanted = parts.next()?;
            if part == "<id>" && !wanted.is_empty() {
                id = wanted;
            } else if !matches(wanted, part) {
                return None;
            }
        }
        parts.next().is_none().then_some(id)
    }

    /// Returns the address behind the prefix for the control with this `id`.
    #[must_use]
    pub(crate) fn path_of(&self, id: &str) -> String {
        self.path.replace("<id>", id)
    }

    /// Whether it concerns one control.
    #[must_use]
    pub(crate) fn is_of_a_control(&self) -> bool {
        self.path.contains("<id>")
    }
}

/// Reads the commands at `address`, which may be a pattern, with these arguments.
///
/// A pattern selects the matching commands that accept these arguments. An id in a pattern stays a pattern: only the
/// floor knows its controls.
pub(super) fn read(
    prefix: &Prefix,
    address: &str,
    args: &[OscType],
) -> Result<Vec<ControlMessage>, NoCommand> {
    let path = prefix.path(address);
    let (mut found, mut expected) = (Vec::new(), None);
    for command in &COMMANDS {
        let id = if is_pattern(address) {
            command.id_in_pattern(prefix, address)
        } else {
            path.and_then(|path| command.id_in(path))
        };
        let Some(id) = id else { continue };
        let argument = command.argument.read(args);
        match argument.and_then(|argument| (command.make)(WidgetId::new(id), argument)) {
            Some(message) => found.push(message),
            None => expected = Some(command.argument.expected()),
        }
    }
    match (found.is_empty(), expected) {
        (false, _) => Ok(found),
        (true, Some(expected)) => Err(NoCommand::Expected(expected)),
        (true, None) => Err(NoCommand::Unknown),
    }
}
