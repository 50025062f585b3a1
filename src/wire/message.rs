//! What an app asks, and who asks it.

use std::net::SocketAddr;

use rosc::OscType;

use crate::floor::TileId;
use crate::widget::{Indicator, Value, WidgetId};

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
        /// As it was sent: what no label may hold is left out where it is written on the control.
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
    /// Cancel what feet hold: nothing is held or commits until a foot lifts and presses anew.
    CancelAll,
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
    #[must_use]
    pub fn id(&self) -> Option<&WidgetId> {
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
            | Self::CancelAll
            | Self::Mute { .. }
            | Self::MuteTile { .. }
            | Self::GetMute => None,
        }
    }

    /// The same, to be changed.
    pub fn id_mut(&mut self) -> Option<&mut WidgetId> {
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
            | Self::CancelAll
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
            Self::CancelAll => return "cancel".into(),
            Self::Mute { .. } => return "mute/set".into(),
            Self::MuteTile { .. } => return "mute/tile".into(),
            Self::GetMute => return "mute/get".into(),
        };
        format!("widget/{id}/{verb}")
    }

    /// The arguments behind that address.
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
            Self::MuteTile { tile, on } => {
                vec![OscType::Int(tile.column.into()), OscType::Int(tile.row.into()), OscType::Bool(*on)]
            }
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
