//! Descriptions of controls by which Home Assistant finds them, as its page on MQTT discovery has them.

use serde_json::{Map, Value as Json, json};

use super::mqtt::{MqttMessage, MqttTarget};
use super::plan::MessageLine;
use super::sending::{Payload, When};
use crate::widget::Value;

/// The first part of the topics that Home Assistant reads.
const PREFIX: &str = "homeassistant";

/// Returns the retained message that describes `line` to Home Assistant; `None` for a message that is not of MQTT.
///
/// An event is an entity of the sort *event*, a hold and a switch are binary sensors, any other value is a sensor.
pub(super) fn description(line: &MessageLine, target: &MqttTarget) -> Option<MqttMessage> {
    let Payload::Mqtt(topic, settings) = &line.payload else { return None };
    let (base, control) = (target.base(), line.control.as_str());
    let (component, part, own) = match (line.when, line.initial) {
        (When::On(trigger), _) => {
            let event = trigger.name();
            // Its texts are free: the template makes the event of any of them.
            let template = json!({ "event_type": event }).to_string();
            ("event", event, json!({ "event_types": [event], "value_template": template }))
        }
        (When::While, _) => {
            let switch = settings.switch(topic);
            ("binary_sensor", "held", json!({ "payload_on": switch.on, "payload_off": switch.off }))
        }
        (When::Value, Some(Value::Switch(_))) if settings.from.is_none() => {
            ("binary_sensor", "on", json!({ "payload_on": "ON", "payload_off": "OFF" }))
        }
        (When::Value, _) => ("sensor", "value", json!({})),
    };
    let id = object(&format!("{base}_{control}_{part}"));
    let common = json!({
        "name": format!("{control} {}", part.replace('_', " ")),
        "unique_id": id,
        "state_topic": topic,
        "availability_topic": target.availability(),
        "device": { "identifiers": [base], "name": base, "manufacturer": "underfoot" },
        "origin": { "name": "underfoot", "sw_version": env!("CARGO_PKG_VERSION") },
    });
    let mut all = Map::new();
    for part in [common, own] {
        if let Json::Object(fields) = part {
            all.extend(fields);
        }
    }
    let topic = format!("{PREFIX}/{component}/{}/{id}/config", object(base));
    Some(MqttMessage { topic, payload: Json::Object(all).to_string(), retained: true })
}

/// `text` in the characters that Home Assistant allows in its topics.
fn object(text: &str) -> String {
    text.chars().map(|c| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' }).collect()
}
