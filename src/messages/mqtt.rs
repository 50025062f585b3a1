//! MQTT: a broker as a target, and messages to its topics.
//!
//! A message of an event is gone once it is delivered. The state of a hold or of a value is *retained*: the broker gives it
//! to all who come later.

use std::fmt;

use serde::{Deserialize, Serialize};
use underfoot_format::{Num, Opt, Text, num, record};

use super::pointer::{numbers, share};
use crate::widget::Value;

/// Ends of a range of numbers.
const ENDS: Num = num(-1e6..=1e6);

/// The first part of the topics of a target, where none is written.
const USUAL_BASE: &str = "underfoot";

/// A broker of MQTT.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct MqttTarget {
    /// Host and port, such as `127.0.0.1:1883`.
    pub address: String,
    /// The first part of the topic that says whether the floor is there, and the name of the floor as a client.
    pub base: Option<String>,
    /// Whether Home Assistant finds the controls by itself.
    pub discovery: bool,
    /// The user; the password is in the environment variable `UNDERFOOT_MQTT_PASSWORD`.
    pub user: Option<String>,
}

record! {
    /// The content of an MQTT message.
    pub struct MqttSettings = "Mqtt" => |it, faults| {
        if it.from.is_some() != it.to.is_some() {
            faults.error(&["from", "to"], "this range has one end", "`from` and `to` belong together");
        }
    };
    /// The text of an event, its name where none is written; and of a hold, `ON` where none is written.
    pub payload: Option<String> = "payload", Opt(Text(1000)) => None;
    /// The text after a hold, `OFF` where none is written.
    pub off: Option<String> = "off", Opt(Text(1000)) => None;
    /// The number for the least value of the control; without it the value goes out as it is.
    pub from: Option<f32> = "from", Opt(ENDS) => None;
    /// The number for the greatest value of the control.
    pub to: Option<f32> = "to", Opt(ENDS) => None;
}

/// A topic that is on while a foot holds a control.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Deserialize, Serialize)]
pub struct MqttSwitch {
    /// The topic.
    pub topic: String,
    /// The text that is retained while it is down.
    pub on: String,
    /// The text that is retained while it is up.
    pub off: String,
}

/// One message to a topic.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct MqttMessage {
    /// The topic.
    pub topic: String,
    /// The text.
    pub payload: String,
    /// Whether the broker keeps it for those who come later.
    pub retained: bool,
}

impl MqttTarget {
    /// The first part of its topics.
    #[must_use]
    pub fn base(&self) -> &str {
        self.base.as_deref().unwrap_or(USUAL_BASE)
    }

    /// The topic that retains `online` while the floor is there, and `offline` otherwise.
    #[must_use]
    pub fn availability(&self) -> String {
        format!("{}/status", self.base())
    }

    /// Whether `text` can be a topic of a message: 1 to 200 bytes that can be seen, without the wildcards + and #, and
    /// not one of the broker's own, which begin with $.
    #[must_use]
    pub fn is_topic(text: &str) -> bool {
        (1..=200).contains(&text.len())
            && !text.starts_with('$')
            && !text.contains(|c: char| matches!(c, '+' | '#') || c.is_control())
    }
}

impl MqttSettings {
    /// Nothing written.
    pub const PLAIN: Self = Self { payload: None, off: None, from: None, to: None };

    /// The message of the event called `event`.
    pub(super) fn at_event(&self, topic: &str, event: &str) -> MqttMessage {
        let payload = self.payload.clone().unwrap_or_else(|| event.to_owned());
        MqttMessage { topic: topic.to_owned(), payload, retained: false }
    }

    /// The topic of a hold.
    pub(super) fn switch(&self, topic: &str) -> MqttSwitch {
        let text =
            |written: &Option<String>, usual: &str| written.clone().unwrap_or_else(|| usual.to_owned());
        MqttSwitch { topic: topic.to_owned(), on: text(&self.payload, "ON"), off: text(&self.off, "OFF") }
    }

    /// The message of a control that has `value`, with these ends of its range.
    pub(super) fn of_value(&self, topic: &str, value: Value, ends: [[f32; 2]; 2]) -> MqttMessage {
        let range = self.from.zip(self.to);
        let scaled = |number: f32, ends: [f32; 2]| match range {
            Some((from, to)) => from + (to - from) * share(number, ends),
            None => number,
        };
        let both = numbers(value);
        let payload = match value {
            Value::Pair(_) => format!("[{}, {}]", scaled(both.x, ends[0]), scaled(both.y, ends[1])),
            Value::Switch(on) if range.is_none() => (if on { "ON" } else { "OFF" }).to_owned(),
            _ => scaled(both.x, ends[0]).to_string(),
        };
        MqttMessage { topic: topic.to_owned(), payload, retained: true }
    }
}

impl MqttSwitch {
    /// The message that turns it on or off.
    #[must_use]
    pub fn turned(&self, on: bool) -> MqttMessage {
        let payload = if on { &self.on } else { &self.off };
        MqttMessage { topic: self.topic.clone(), payload: payload.clone(), retained: true }
    }
}

impl fmt::Display for MqttMessage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {:?}", self.topic, self.payload)
    }
}
