//! Arguments of requests from apps.

use glam::Vec2;
use rosc::OscType;

use crate::floor::{Corner, SensorChoice, SensorId, TileId};
use crate::widget::{Indicator, Value};

pub use underfoot_format::label::MAX_LABEL;

/// The arguments that a command takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArgumentKind {
    /// No argument.
    Nothing,
    /// A value of the control: one number (or OSC true or false), two for a pair.
    Value,
    /// A string of at most [`MAX_LABEL`] characters.
    Label,
    /// A string: `off`, `on`, `busy` or `attention`; or 0 or 1.
    Indicator,
    /// Two numbers: the minimum and the maximum.
    Range,
    /// A string: the id of a page.
    Page,
    /// 0 or 1, or OSC true or false.
    Flag,
    /// Nothing, which means 1; or 0 or 1, or OSC true or false.
    Switch,
    /// Two whole numbers, column and row of a tile, and then 0 or 1, or OSC true or false.
    TileFlag,
    /// Column and row of a tile, a sensor as `sw`, `se`, `nw`, `ne` or its number from 0, and then 0 or 1, or OSC true
    /// or false.
    SensorFlag,
    /// Two whole numbers, a board and its channel from 0, and then 0 or 1, or OSC true or false.
    ChannelFlag,
}

/// An argument as read.
pub(super) enum DecodedArgument {
    Nothing,
    Value(Value),
    Text(String),
    Indicator(Indicator),
    Range(f32, f32),
    Flag(bool),
    TileFlag(TileId, bool),
    SensorsFlag(SensorChoice, bool),
}

impl ArgumentKind {
    pub(super) fn read(self, args: &[OscType]) -> Option<DecodedArgument> {
        match (self, args) {
            (Self::Nothing, []) => Some(DecodedArgument::Nothing),
            (Self::Value, [one]) => value(one).map(DecodedArgument::Value),
            (Self::Value, [x, y]) => match (value(x)?, value(y)?) {
                (Value::Number(x), Value::Number(y)) => {
                    Some(DecodedArgument::Value(Value::Pair(Vec2::new(x, y))))
                }
                _ => None,
            },
            (Self::Range, [least, greatest]) => match (value(least)?, value(greatest)?) {
                (Value::Number(least), Value::Number(greatest)) => {
                    Some(DecodedArgument::Range(least, greatest))
                }
                _ => None,
            },
            (Self::Label, [OscType::String(text)]) if text.chars().count() <= MAX_LABEL => {
                Some(DecodedArgument::Text(text.clone()))
            }
            (Self::Page, [OscType::String(text)]) => Some(DecodedArgument::Text(text.clone())),
            (Self::Switch, []) => Some(DecodedArgument::Flag(true)),
            (Self::Flag | Self::Switch, [on]) => flag(on).map(DecodedArgument::Flag),
            (Self::TileFlag, [column, row, on]) => {
                let tile = TileId::new(index(column)?, index(row)?);
                flag(on).map(|on| DecodedArgument::TileFlag(tile, on))
            }
            (Self::SensorFlag, [column, row, sensor, on]) => {
                let tile = TileId::new(index(column)?, index(row)?);
                let sensor = SensorId { tile, corner: corner(sensor)? };
                flag(on).map(|on| DecodedArgument::SensorsFlag(SensorChoice::Sensor(sensor), on))
            }
            (Self::ChannelFlag, [board, channel, on]) => {
                let choice = SensorChoice::Channel { board: index(board)?, channel: index(channel)? };
                flag(on).map(|on| DecodedArgument::SensorsFlag(choice, on))
            }
            (Self::Indicator, [OscType::String(text)]) => {
                let found = Indicator::ALL.into_iter().find(|indicator| indicator.name() == text);
                found.map(DecodedArgument::Indicator)
            }
            (Self::Indicator, [one]) => {
                let lamp = if flag(one)? { Indicator::On } else { Indicator::Off };
                Some(DecodedArgument::Indicator(lamp))
            }
            _ => None,
        }
    }

    /// Describes the expected arguments, for the sender of other ones.
    pub(super) const fn expected(self) -> &'static str {
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
            Self::SensorFlag => {
                "column and row of a tile, a sensor (sw, se, nw, ne, or its number), and 0 or 1"
            }
            Self::ChannelFlag => "three numbers: a board, its channel, and 0 or 1",
        }
    }
}

/// Reads on or off.
fn flag(argument: &OscType) -> Option<bool> {
    match value(argument)? {
        Value::Switch(true) | Value::Number(1.0) => Some(true),
        Value::Switch(false) | Value::Number(0.0) => Some(false),
        _ => None,
    }
}

/// Reads a column or a row.
fn index(argument: &OscType) -> Option<u16> {
    match value(argument)? {
        Value::Number(number) if number.fract() == 0.0 && (0.0..=f32::from(u16::MAX)).contains(&number) => {
            Some(number as u16)
        }
        _ => None,
    }
}

/// Reads a sensor of a tile, by name or number.
fn corner(argument: &OscType) -> Option<Corner> {
    match argument {
        OscType::String(name) => Corner::ALL.into_iter().find(|corner| corner.name() == name),
        number => Corner::ALL.get(usize::from(index(number)?)).copied(),
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
