//! What apps may ask, as the wire spells it. The decoder, the reference and the tests go by one table.

use std::net::SocketAddr;

use glam::Vec2;
use rosc::OscType;

use super::pattern::{is_pattern, matches};
use super::prefix::Prefix;
use crate::floor::TileId;
use crate::widget::{Indicator, Value, WidgetId};

/// Most characters of a label, as in layouts.
pub const MAX_LABEL: usize = 64;

/// What an app asks of a control or of the floor.
///
/// Whether there is such a control or page, and whether the value suits it, only
/// the engine knows: it takes a number other than 0 for "on" where the control
/// is a switch, and a whole number for a choice where it is a selector.
#[derive(Clone, Debug, PartialEq)]
pub enum ControlMessage {
    /// Hold this value; its numbers are finite.
    Set {
        /// Which control.
        id: WidgetId,
        /// `Switch` if the app sent OSC true or false, `Number` if it sent any number, `Pair` for two.
        value: Value,
    },
    /// React to feet again.
    Enable {
        /// Which control.
        id: WidgetId,
    },
    /// React to feet no more.
    Disable {
        /// Which control.
        id: WidgetId,
    },
    /// Keep the value, whatever feet and apps do.
    Lock {
        /// Which control.
        id: WidgetId,
    },
    /// Change the value again.
    Unlock {
        /// Which control.
        id: WidgetId,
    },
    /// Carry another label.
    Label {
        /// Which control.
        id: WidgetId,
        /// At most [`MAX_LABEL`] characters, none of which controls a terminal or the direction of writing.
        text: String,
    },
    /// Switch the lamp.
    Indicate {
        /// Which control.
        id: WidgetId,
        /// What it shows.
        indicator: Indicator,
    },
    /// Have this range, in place of what the layout says.
    SetRange {
        /// Which control.
        id: WidgetId,
        /// The least value; finite.
        least: f32,
        /// The greatest value; finite.
        greatest: f32,
    },
    /// Tell the sender how the control is.
    Get {
        /// Which control.
        id: WidgetId,
    },
    /// Tell the sender, and everybody else who is told, how all controls are, and the floor.
    GetAll,
    /// Show another page, as soon as no foot is engaged.
    ShowPage {
        /// Which page.
        page: WidgetId,
    },
    /// Tell the sender which page is shown.
    GetPage,
    /// Let nothing be felt or heard, or everything again.
    Mute {
        /// Whether to.
        on: bool,
    },
    /// Let one tile not be felt, or again.
    MuteTile {
        /// Which tile.
        tile: TileId,
        /// Whether to.
        on: bool,
    },
    /// Tell the sender what is muted.
    GetMute,
}

impl ControlMessage {
    /// The control it is about, if it is about one.
    pub(crate) fn id_mut(&mut self) -> Option<&mut WidgetId> {
        match self {
            Self::Set { id, .. }
            | Self::Enable { id }
            | Self::Disable { id }
            | Self::Lock { id }
            | Self::Unlock { id }
            | Self::Label { id, .. }
            | Self::Indicate { id, .. }
            | Self::SetRange { id, .. }
            | Self::Get { id } => Some(id),
            Self::ShowPage { .. }
            | Self::GetPage
            | Self::GetAll
            | Self::Mute { .. }
            | Self::MuteTile { .. }
            | Self::GetMute => None,
        }
    }

    /// The address behind the prefix that says so, such as `widget/zoom/set`.
    #[must_use]
    pub fn path(&self) -> String {
        let (verb, id) = match self {
            Self::Set { id, .. } => ("set", id),
            Self::Enable { id } => ("enable", id),
            Self::Disable { id } => ("disable", id),
            Self::Lock { id } => ("lock", id),
            Self::Unlock { id } => ("unlock", id),
            Self::Label { id, .. } => ("label", id),
            Self::Indicate { id, .. } => ("indicator", id),
            Self::SetRange { id, .. } => ("range/set", id),
            Self::Get { id } => ("get", id),
            Self::ShowPage { .. } => return "page/set".into(),
            Self::GetPage => return "page/get".into(),
            Self::GetAll => return "get".into(),
            Self::Mute { .. } => return "mute/set".into(),
            Self::MuteTile { .. } => return "mute/tile".into(),
            Self::GetMute => return "mute/get".into(),
        };
        format!("widget/{id}/{verb}")
    }
}

/// A request and who made it.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// What is asked.
    pub message: ControlMessage,
    /// Where an answer goes; `None` if nobody can be answered.
    pub sender: Option<SocketAddr>,
}

impl From<ControlMessage> for Request {
    /// A request that nobody waits for an answer to.
    fn from(message: ControlMessage) -> Self {
        Self { message, sender: None }
    }
}

/// What a command takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArgumentKind {
    /// No argument.
    Nothing,
    /// What the control holds: one number (or OSC true or false), two for a pair.
    Value,
    /// A string of at most [`MAX_LABEL`] characters.
    Label,
    /// A string: `off`, `on`, `busy` or `attention`; or 0 or 1.
    Indicator,
    /// Two numbers: the least, and the greatest.
    Range,
    /// A string: the id of a page.
    Page,
    /// 0 or 1, or OSC true or false.
    Flag,
    /// Nothing, which means 1; or 0 or 1, or OSC true or false.
    Switch,
    /// Two whole numbers, column and row of a tile, and then 0 or 1, or OSC true or false.
    TileFlag,
}

/// One thing that apps may ask.
#[derive(Clone, Copy, Debug)]
pub struct Command {
    /// The address behind the prefix; `<id>` stands for a control's id.
    pub path: &'static str,
    /// Its arguments.
    pub argument: ArgumentKind,
    /// What it does, in a sentence.
    pub says: &'static str,
    make: fn(WidgetId, Argument) -> Option<ControlMessage>,
}

/// An argument as read.
enum Argument {
    Nothing,
    Value(Value),
    Text(String),
    Indicator(Indicator),
    Range(f32, f32),
    Flag(bool),
    TileFlag(TileId, bool),
}

/// Everything that apps may ask.
pub const COMMANDS: [Command; 15] = [
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
            Argument::Value(value) => Some(ControlMessage::Set { id, value }),
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
            Argument::Flag(true) => Some(ControlMessage::Enable { id }),
            Argument::Flag(false) => Some(ControlMessage::Disable { id }),
            _ => None,
        },
    },
    Command {
        path: "widget/<id>/disable",
        argument: ArgumentKind::Switch,
        says: "React to feet no more; a press under way is cancelled.",
        make: |id, argument| match argument {
            Argument::Flag(true) => Some(ControlMessage::Disable { id }),
            Argument::Flag(false) => Some(ControlMessage::Enable { id }),
            _ => None,
        },
    },
    Command {
        path: "widget/<id>/lock",
        argument: ArgumentKind::Switch,
        says: "Keep the value, whatever feet and apps do; a press under way is cancelled.",
        make: |id, argument| match argument {
            Argument::Flag(true) => Some(ControlMessage::Lock { id }),
            Argument::Flag(false) => Some(ControlMessage::Unlock { id }),
            _ => None,
        },
    },
    Command {
        path: "widget/<id>/unlock",
        argument: ArgumentKind::Switch,
        says: "Change the value again.",
        make: |id, argument| match argument {
            Argument::Flag(true) => Some(ControlMessage::Unlock { id }),
            Argument::Flag(false) => Some(ControlMessage::Lock { id }),
            _ => None,
        },
    },
    Command {
        path: "widget/<id>/label",
        argument: ArgumentKind::Label,
        says: "Carry this label.",
        make: |id, argument| match argument {
            Argument::Text(text) => Some(ControlMessage::Label { id, text }),
            _ => None,
        },
    },
    Command {
        path: "widget/<id>/indicator",
        argument: ArgumentKind::Indicator,
        says: "Switch the lamp.",
        make: |id, argument| match argument {
            Argument::Indicator(indicator) => Some(ControlMessage::Indicate { id, indicator }),
            _ => None,
        },
    },
    Command {
        path: "widget/<id>/range/set",
        argument: ArgumentKind::Range,
        says: "Have this range, also in layouts that come later; the value is brought into it.",
        make: |id, argument| match argument {
            Argument::Range(least, greatest) => Some(ControlMessage::SetRange { id, least, greatest }),
            _ => None,
        },
    },
    Command {
        path: "page/set",
        argument: ArgumentKind::Page,
        says: "Show this page, as soon as no foot is engaged.",
        make: |_, argument| match argument {
            Argument::Text(text) => Some(ControlMessage::ShowPage { page: WidgetId::new(&text) }),
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
        path: "mute/set",
        argument: ArgumentKind::Flag,
        says: "Let nothing be felt or heard (1), or everything again but single tiles that are muted (0).",
        make: |_, argument| match argument {
            Argument::Flag(on) => Some(ControlMessage::Mute { on }),
            _ => None,
        },
    },
    Command {
        path: "mute/tile",
        argument: ArgumentKind::TileFlag,
        says: "Let the actuator of one tile not be felt (1), or again (0); loudspeakers go on.",
        make: |_, argument| match argument {
            Argument::TileFlag(tile, on) => Some(ControlMessage::MuteTile { tile, on }),
            _ => None,
        },
    },
    Command {
        path: "mute/get",
        argument: ArgumentKind::Nothing,
        says: "Answer with what is muted.",
        make: |_, _| Some(ControlMessage::GetMute),
    },
];

/// Whether a character may stand in a label: not if it controls a terminal or turns the direction of what follows,
/// with which one label can pass for another.
///
/// # Source
/// Unicode Standard Annex 9, explicit and implicit directional marks; line and paragraph separators.
fn is_shown(c: char) -> bool {
    let turns =
        matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    !c.is_control() && !turns && !matches!(c, '\u{2028}' | '\u{2029}')
}

/// Why a message is not a command.
pub(super) enum NoCommand {
    /// No command has such an address.
    Unknown,
    /// The command takes something else: this.
    Expected(&'static str),
}

impl Command {
    /// The id that `path` has where this command's has `<id>`, empty if it has none; `None` if it is another address.
    fn id_in<'a>(&self, path: &'a str) -> Option<&'a str> {
        match self.path.split_once("<id>") {
            Some((before, after)) => {
                let id = path.strip_prefix(before)?.strip_suffix(after)?;
                (!id.is_empty() && !id.contains('/')).then_some(id)
            }
            None => (path == self.path).then_some(""),
        }
    }

    /// What `pattern` has where this command's address has `<id>`, empty if it has none; `None` if it means none such.
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

    /// The address behind the prefix for the control named `id`.
    #[must_use]
    pub(crate) fn path_of(&self, id: &str) -> String {
        self.path.replace("<id>", id)
    }

    /// Whether it is about one control.
    #[must_use]
    pub(crate) fn is_of_a_control(&self) -> bool {
        self.path.contains("<id>")
    }
}

/// The commands at `address`, which may be a pattern, with these arguments.
///
/// Of the commands that a pattern means, those take part that take such arguments. Where it has a control's id it
/// stays a pattern: only the floor knows its controls.
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

/// Whether a floor itself sends this, behind its prefix: an answer to it could be answered for ever.
pub(super) fn is_sent_by_floors(path: &str) -> bool {
    match path.split_once('/') {
        None => SENT.contains(&path),
        Some(("widget", rest)) => {
            rest.rsplit('/').next().is_some_and(|what| SENT_OF_CONTROLS.contains(&what))
        }
        Some(_) => false,
    }
}

/// What a floor tells of itself.
const SENT: [&str; 9] =
    ["alive", "contact", "contacts", "crack", "device", "error", "health", "mute", "page"];

/// What a floor tells of its controls.
const SENT_OF_CONTROLS: [&str; 20] = [
    "armed",
    "cancelled",
    "changed",
    "clicked",
    "disarmed",
    "double_tapped",
    "hard_pressed",
    "hard_released",
    "held",
    "long_pressed",
    "page",
    "pressed",
    "range",
    "refused",
    "released",
    "state",
    "swiped",
    "ticked",
    "value",
    "warned",
];

impl ArgumentKind {
    fn read(self, args: &[OscType]) -> Option<Argument> {
        match (self, args) {
            (Self::Nothing, []) => Some(Argument::Nothing),
            (Self::Value, [one]) => value(one).map(Argument::Value),
            (Self::Value, [x, y]) => match (value(x)?, value(y)?) {
                (Value::Number(x), Value::Number(y)) => Some(Argument::Value(Value::Pair(Vec2::new(x, y)))),
                _ => None,
            },
            (Self::Range, [least, greatest]) => match (value(least)?, value(greatest)?) {
                (Value::Number(least), Value::Number(greatest)) => Some(Argument::Range(least, greatest)),
                _ => None,
            },
            (Self::Label, [OscType::String(text)]) if text.chars().count() <= MAX_LABEL => {
                Some(Argument::Text(text.chars().filter(|&c| is_shown(c)).collect()))
            }
            (Self::Page, [OscType::String(text)]) => Some(Argument::Text(text.clone())),
            (Self::Switch, []) => Some(Argument::Flag(true)),
            (Self::Flag | Self::Switch, [on]) => flag(on).map(Argument::Flag),
            (Self::TileFlag, [column, row, on]) => {
                let tile = TileId::new(index(column)?, index(row)?);
                flag(on).map(|on| Argument::TileFlag(tile, on))
            }
            (Self::Indicator, [OscType::String(text)]) => {
                let found = Indicator::ALL.into_iter().find(|indicator| indicator.name() == text);
                found.map(Argument::Indicator)
            }
            (Self::Indicator, [one]) => {
                let lamp = if flag(one)? { Indicator::On } else { Indicator::Off };
                Some(Argument::Indicator(lamp))
            }
            _ => None,
        }
    }

    /// What is expected, for those who sent something else.
    const fn expected(self) -> &'static str {
        match self {
            Self::Nothing => "no argument",
            Self::Value => "one finite number, true or false, or two numbers for a pair",
            Self::Label => "one string of at most 64 characters",
            Self::Indicator => "off, on, busy or attention, or 0 or 1",
            Self::Range => "two numbers: the least, and the greatest",
            Self::Page => "one string: the id of a page",
            Self::Flag => "0 or 1, or true or false",
            Self::Switch => "no argument, 0 or 1, or true or false",
            Self::TileFlag => "three numbers: column and row of a tile, and 0 or 1",
        }
    }
}

/// On or off.
fn flag(argument: &OscType) -> Option<bool> {
    match value(argument)? {
        Value::Switch(true) | Value::Number(1.0) => Some(true),
        Value::Switch(false) | Value::Number(0.0) => Some(false),
        _ => None,
    }
}

/// A column or a row.
fn index(argument: &OscType) -> Option<u16> {
    match value(argument)? {
        Value::Number(number) if number.fract() == 0.0 && (0.0..=f32::from(u16::MAX)).contains(&number) => {
            Some(number as u16)
        }
        _ => None,
    }
}

fn value(argument: &OscType) -> Option<Value> {
    let number = match *argument {
        OscType::Bool(on) => return Some(Value::Switch(on)),
        OscType::Int(number) => number as f32,
        OscType::Long(number) => number as f32,
        OscType::Float(number) => number,
        OscType::Double(number) => number as f32,
        _ => return None,
    };
    number.is_finite().then_some(Value::Number(number))
}
