//! Requests of apps, with their senders.

use std::net::SocketAddr;

use rosc::OscType;

use crate::floor::{SensorChoice, TileId};
use crate::widget::{Indicator, Value, WidgetId};

/// A request of an app, about a control or the floor.
///
/// Only the engine knows whether there is such a control or page, and whether the value fits: for a switch it converts
/// 0 to off and other numbers to on, for a selector a whole number to a choice.
#[derive(Clone, Debug, PartialEq)]
pub enum ControlMessage {
    /// Set the value; its numbers are finite.
    Set {
        /// The control.
        id: WidgetId,
        /// `Switch` if the app sent OSC true or false, `Number` if it sent any number, `Pair` for two.
        value: Value,
    },
    /// Respond to feet again.
    Enable {
        /// The control.
        id: WidgetId,
    },
    /// Stop responding to feet.
    Disable {
        /// The control.
        id: WidgetId,
    },
    /// Keep the value, regardless of feet and apps.
    Lock {
        /// The control.
        id: WidgetId,
    },
    /// Allow changes of the value again.
    Unlock {
        /// The control.
        id: WidgetId,
    },
    /// Set the label.
    Label {
        /// The control.
        id: WidgetId,
        /// The text as sent: the server removes forbidden characters when it sets the label.
        text: String,
    },
    /// Set the lamp.
    Indicate {
        /// The control.
        id: WidgetId,
        /// The state of the lamp.
        indicator: Indicator,
    },
    /// Set the range, in place of the one in the layout.
    SetRange {
        /// The control.
        id: WidgetId,
        /// The minimum value; finite.
        least: f32,
        /// The maximum value; finite.
        greatest: f32,
    },
    /// Report the state of the control to the sender.
    Get {
        /// The control.
        id: WidgetId,
    },
    /// Report the state of all controls and of the floor to the sender and to all other listeners.
    GetAll,
    /// Show another page, as soon as no foot is engaged.
    ShowPage {
        /// The page.
        page: WidgetId,
    },
    /// Report the current page to the sender.
    GetPage,
    /// Cancel everything held: nothing is held or commits until a foot lifts and presses again.
    CancelAll,
    /// Mute all haptics and sound, or unmute them.
    Mute {
        /// Whether to mute.
        on: bool,
    },
    /// Mute the haptics of one tile, or unmute them.
    MuteTile {
        /// The tile.
        tile: TileId,
        /// Whether to mute.
        on: bool,
    },
    /// Report the mute state to the sender.
    GetMute,
    /// Use the readings of some sensors, or ignore them.
    UseSensors {
        /// The sensors.
        choice: SensorChoice,
        /// Whether to use them.
        on: bool,
    },
}

/// The control that a message concerns, borrowed as the message is.
macro_rules! id_of {
    ($message:expr) => {
        match $message {
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
            | Self::CancelAll
            | Self::Mute { .. }
            | Self::MuteTile { .. }
            | Self::GetMute
            | Self::UseSensors { .. } => None,
        }
    };
}

impl ControlMessage {
    /// Returns the control that it concerns, if any.
    #[must_use]
    pub fn id(&self) -> Option<&WidgetId> {
        id_of!(self)
    }

    /// Returns the control that it concerns, for changing.
    pub fn id_mut(&mut self) -> Option<&mut WidgetId> {
        id_of!(self)
    }

    /// Returns the address of the message behind the prefix, such as `widget/zoom/set`.
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
            Self::CancelAll => return "cancel".into(),
            Self::Mute { .. } => return "mute/set".into(),
            Self::MuteTile { .. } => return "mute/tile".into(),
            Self::GetMute => return "mute/get".into(),
            Self::UseSensors { choice: SensorChoice::Tile(_), .. } => return "sensor/tile".into(),
            Self::UseSensors { choice: SensorChoice::Sensor(_), .. } => return "sensor/set".into(),
            Self::UseSensors { choice: SensorChoice::Channel { .. }, .. } => return "sensor/channel".into(),
        };
        format!("widget/{id}/{verb}")
    }

    /// Returns the arguments of the message.
    #[must_use]
    pub(crate) fn arguments(&self) -> Vec<OscType> {
        match self {
            Self::Set { value, .. } => match *value {
                Value::Switch(on) => vec![OscType::Bool(on)],
                Value::Number(number) => vec![OscType::Float(number)],
                Value::Choice(choice) => vec![OscType::Int(choice.into())],
                Value::Pair(pair) => vec![OscType::Float(pair.x), OscType::Float(pair.y)],
            },
            Self::Label { text, .. } => vec![OscType::String(text.clone())],
            Self::Indicate { indicator, .. } => vec![OscType::String(indicator.name().into())],
            Self::SetRange { least, greatest, .. } => {
                vec![OscType::Float(*least), OscType::Float(*greatest)]
            }
            Self::ShowPage { page } => vec![OscType::String(page.to_string())],
            Self::Mute { on } => vec![OscType::Bool(*on)],
            Self::MuteTile { tile, on } => numbers([tile.column, tile.row], *on),
            Self::UseSensors { choice, on } => match choice {
                SensorChoice::Tile(tile) => numbers([tile.column, tile.row], *on),
                SensorChoice::Sensor(sensor) => {
                    let number = sensor.corner.index() as u16;
                    numbers([sensor.tile.column, sensor.tile.row, number], *on)
                }
                SensorChoice::Channel { board, channel } => numbers([*board, *channel], *on),
            },
            Self::Enable { .. }
            | Self::Disable { .. }
            | Self::Lock { .. }
            | Self::Unlock { .. }
            | Self::Get { .. }
            | Self::GetAll
            | Self::CancelAll
            | Self::GetPage
            | Self::GetMute => Vec::new(),
        }
    }
}

/// Whole numbers, and on or off behind them.
fn numbers<const N: usize>(numbers: [u16; N], on: bool) -> Vec<OscType> {
    let numbers = numbers.map(|number| OscType::Int(number.into()));
    numbers.into_iter().chain([OscType::Bool(on)]).collect()
}

/// A request and its sender.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// The request.
    pub message: ControlMessage,
    /// Destination of an answer; `None` if there is none.
    pub sender: Option<SocketAddr>,
}

impl From<ControlMessage> for Request {
    /// A request without a destination for an answer.
    fn from(message: ControlMessage) -> Self {
        Self { message, sender: None }
    }
}
