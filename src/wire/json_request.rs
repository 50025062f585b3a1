//! Requests of apps as JSON: the addresses and arguments of OSC.

use rosc::OscType;
use serde_json::Value;

use super::command::{NoCommand, read};
use super::message::ControlMessage;
use super::prefix::Prefix;

/// Reads the request at `path` (an address without its prefix, such as `widget/zoom/set`) with JSON's numbers,
/// booleans and texts as arguments.
///
/// # Errors
/// Says why the request is invalid, in words for its author.
pub fn read_json(path: &str, args: &[Value]) -> Result<ControlMessage, String> {
    let prefix = Prefix::default();
    let args: Option<Vec<OscType>> = args.iter().map(argument).collect();
    let args = args.ok_or("arguments are numbers, true or false, and texts")?;
    let found = read(&prefix, &prefix.address(path), &args).map_err(|no| match no {
        NoCommand::Unknown => "there is no such request".to_owned(),
        NoCommand::Expected(what) => format!("expected {what}"),
    })?;
    match <[ControlMessage; 1]>::try_from(found) {
        Ok([message]) => Ok(message),
        Err(_) => Err("patterns are for OSC: name one request".to_owned()),
    }
}

/// Returns the path and the arguments from which [`read_json`] makes `message`; its numbers are finite, as in all
/// requests.
///
/// A choice becomes a whole number, as in OSC; a selector reads it as a choice.
#[must_use]
pub fn write_json(message: &ControlMessage) -> (String, Vec<Value>) {
    let value = |argument| match argument {
        OscType::Bool(on) => Value::Bool(on),
        OscType::Int(number) => number.into(),
        OscType::Float(number) => f64::from(number).into(),
        OscType::String(text) => Value::String(text),
        // Requests have no other arguments.
        _ => Value::Null,
    };
    (message.path(), message.arguments().into_iter().map(value).collect())
}

fn argument(value: &Value) -> Option<OscType> {
    match value {
        Value::Bool(on) => Some(OscType::Bool(*on)),
        // A number beyond the range of a float becomes infinite, which is rejected.
        Value::Number(number) => match number.as_i64().and_then(|whole| i32::try_from(whole).ok()) {
            Some(whole) => Some(OscType::Int(whole)),
            None => number.as_f64().map(|number| OscType::Float(number as f32)),
        },
        Value::String(text) => Some(OscType::String(text.clone())),
        Value::Null | Value::Array(_) | Value::Object(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::widget::{self, WidgetId};

    #[test]
    fn a_request_in_json_is_that_of_osc() {
        let id = WidgetId::new("zoom");
        let set = ControlMessage::Set { id: id.clone(), value: widget::Value::Number(0.5) };
        assert_eq!(read_json("widget/zoom/set", &[json!(0.5)]), Ok(set));
        let range = ControlMessage::SetRange { id, least: 1.0, greatest: 120.0 };
        assert_eq!(read_json("widget/zoom/range/set", &[json!(1), json!(120)]), Ok(range));
        let id = WidgetId::new("zoom");
        for message in [
            ControlMessage::Set { id: id.clone(), value: widget::Value::Number(0.1) },
            ControlMessage::Set { id: id.clone(), value: widget::Value::Number(2.0) },
            ControlMessage::Set { id: id.clone(), value: widget::Value::Switch(true) },
            ControlMessage::Set { id: id.clone(), value: widget::Value::Pair(glam::Vec2::new(0.5, -1.0)) },
            ControlMessage::Label { id: id.clone(), text: "Zoom".into() },
            ControlMessage::Indicate { id: id.clone(), indicator: widget::Indicator::Busy },
            ControlMessage::SetRange { id: id.clone(), least: 0.0, greatest: 0.5 },
            ControlMessage::Disable { id },
            ControlMessage::ShowPage { page: WidgetId::new("more") },
            ControlMessage::MuteTile { tile: crate::floor::TileId::new(3, 4), on: true },
            ControlMessage::UseSensors {
                choice: crate::floor::SensorChoice::Channel { board: 2, channel: 31 },
                on: true,
            },
            ControlMessage::UseSensors {
                choice: crate::floor::SensorChoice::Sensor(crate::floor::SensorId {
                    tile: crate::floor::TileId::new(5, 1),
                    corner: crate::floor::Corner::NorthWest,
                }),
                on: false,
            },
            ControlMessage::GetAll,
        ] {
            let (path, args) = write_json(&message);
            assert_eq!(read_json(&path, &args), Ok(message));
        }
        for (path, args) in [
            ("widget/zoom/burn", vec![]),
            ("widget/zoom/set", vec![json!("much")]),
            ("widget/zoom/set", vec![json!(1e300)]),
            ("widget/zoom/set", vec![json!({})]),
            ("widget/*/*", vec![]),
        ] {
            assert!(read_json(path, &args).is_err(), "{path} {args:?}");
        }
    }
}
