//! The content of a message at one moment: values scaled to the range that its layout writes.

use super::midi::{MidiMessage, ProgramSettings};
use super::order::{Act, Holdable, OscValue};
use super::plan::MessageLine;
use super::pointer::{numbers, share, wheel};
use super::sending::{OscArgument, OscSettings, Payload, When};
use crate::widget::Value;

/// The moment of a control: its value, and force and place of the foot.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ControlMoment {
    pub(super) value: Option<Value>,
    /// Force, and place east and north, at the last event.
    pub(super) foot: [f32; 3],
}

/// The act at an event of the control; `None` for a message that only follows values, and for notes, which last.
pub(super) fn of_event(line: &MessageLine, moment: &ControlMoment) -> Option<Act> {
    Some(match &line.payload {
        Payload::Key(key) => Act::Stroke(Holdable::Key(key.clone())),
        Payload::Button(button) => Act::Stroke(Holdable::Button(*button)),
        Payload::Wheel(steps) => Act::Wheel(*steps),
        Payload::Osc(address, settings) => Act::Osc(address.clone(), arguments(line, moment, settings)),
        Payload::Controller(settings) => Act::Midi(settings.at(1.0)),
        Payload::Program(number, ProgramSettings { channel }) => {
            Act::Midi(MidiMessage::Program(*channel, *number))
        }
        Payload::Dmx(settings) => Act::Dmx(settings.at(1.0)),
        Payload::Mqtt(topic, settings) => {
            let When::On(trigger) = line.when else { return None };
            Act::Mqtt(settings.at_event(topic, trigger.name()))
        }
        Payload::Run(arguments) => Act::Run(arguments.clone()),
        Payload::Pointer(_) | Payload::Note(..) | Payload::Bend(_) | Payload::Pressure(_) => return None,
    })
}

/// The act that follows `value`, where `steps` of the wheel have gone out; `None` for the pointer, which moves with time.
pub(super) fn of_value(line: &MessageLine, moment: &ControlMoment, value: Value, steps: i32) -> Option<Act> {
    let part = || share(numbers(value).x, line.ends[0]);
    Some(match &line.payload {
        Payload::Wheel(all) => Act::Wheel(wheel(value, line.ends[0], *all) - steps),
        Payload::Osc(address, settings) => Act::Osc(address.clone(), arguments(line, moment, settings)),
        Payload::Controller(settings) => Act::Midi(settings.at(part())),
        Payload::Bend(settings) => Act::Midi(settings.at(part())),
        Payload::Pressure(settings) => Act::Midi(settings.at(part())),
        Payload::Dmx(settings) => Act::Dmx(settings.at(part())),
        Payload::Mqtt(topic, settings) => Act::Mqtt(settings.of_value(topic, value, line.ends)),
        _ => return None,
    })
}

/// The arguments of an OSC message now.
fn arguments(line: &MessageLine, moment: &ControlMoment, settings: &OscSettings) -> Vec<OscValue> {
    let [force, x, y] = moment.foot;
    let usual: &[OscArgument] = if line.when == When::Value { &[OscArgument::Value] } else { &[] };
    let mut values = Vec::new();
    for argument in settings.arguments.as_deref().unwrap_or(usual) {
        match argument {
            OscArgument::Int(number) => values.push(OscValue::Int(*number)),
            OscArgument::Float(number) => values.push(OscValue::Float(*number)),
            OscArgument::Text(text) => values.push(OscValue::Text(text.clone())),
            OscArgument::Force => values.push(OscValue::Float(force)),
            OscArgument::X => values.push(OscValue::Float(x)),
            OscArgument::Y => values.push(OscValue::Float(y)),
            // The reader of layouts allows it in regions only.
            OscArgument::Foot => {}
            OscArgument::Value => values.extend(moment.value.iter().flat_map(|value| {
                let scaled = |number: f32, ends: [f32; 2]| match settings.range {
                    Some([from, to]) => OscValue::Float(from + (to - from) * share(number, ends)),
                    None => OscValue::Float(number),
                };
                let both = numbers(*value);
                match value {
                    Value::Pair(_) => vec![scaled(both.x, line.ends[0]), scaled(both.y, line.ends[1])],
                    Value::Switch(_) | Value::Choice(_) if settings.range.is_none() => {
                        vec![OscValue::Int(both.x as i32)]
                    }
                    _ => vec![scaled(both.x, line.ends[0])],
                }
            })),
        }
    }
    values
}
