//! The AHAP file as written.

use serde::{Deserialize, Serialize};
use serde_json::Value;

/// The file as written; what is not known is kept so that it can be named.
#[derive(Debug, Deserialize, Serialize)]
#[serde(rename_all = "PascalCase")]
pub(super) struct File {
    #[serde(default = "one")]
    pub(super) version: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) metadata: Option<Value>,
    #[serde(default)]
    pub(super) pattern: Vec<Entry>,
}

fn one() -> f64 {
    1.0
}

/// One entry of a pattern: exactly one of its fields is there.
#[derive(Debug, Default, Deserialize, Serialize)]
#[serde(rename_all = "PascalCase")]
pub(super) struct Entry {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) event: Option<Event>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) parameter: Option<DynamicParameter>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) parameter_curve: Option<ParameterCurve>,
    #[serde(flatten)]
    pub(super) other: serde_json::Map<String, Value>,
}

#[derive(Debug, Deserialize, Serialize)]
#[serde(rename_all = "PascalCase")]
pub(super) struct Event {
    #[serde(default)]
    pub(super) time: f64,
    pub(super) event_type: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) event_duration: Option<f64>,
    #[serde(default)]
    pub(super) event_parameters: Vec<EventParameter>,
    #[serde(flatten)]
    pub(super) other: serde_json::Map<String, Value>,
}

#[derive(Debug, Deserialize, Serialize)]
pub(super) struct EventParameter {
    #[serde(rename = "ParameterID")]
    pub(super) id: String,
    #[serde(rename = "ParameterValue")]
    pub(super) value: Number,
}

/// A number, or a truth where people write one.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(untagged)]
pub(super) enum Number {
    Number(f64),
    Truth(bool),
}

impl Number {
    pub(super) fn value(self) -> f64 {
        match self {
            Self::Number(number) => number,
            Self::Truth(truth) => f64::from(u8::from(truth)),
        }
    }
}

#[derive(Debug, Deserialize, Serialize)]
pub(super) struct DynamicParameter {
    #[serde(rename = "ParameterID")]
    pub(super) id: String,
    #[serde(rename = "ParameterValue")]
    pub(super) value: f64,
    #[serde(rename = "Time", default)]
    pub(super) time: f64,
}

#[derive(Debug, Deserialize, Serialize)]
pub(super) struct ParameterCurve {
    #[serde(rename = "ParameterID")]
    pub(super) id: String,
    #[serde(rename = "Time", default)]
    pub(super) time: f64,
    #[serde(rename = "ParameterCurveControlPoints", default)]
    pub(super) points: Vec<ControlPoint>,
}

#[derive(Debug, Deserialize, Serialize)]
#[serde(rename_all = "PascalCase")]
pub(super) struct ControlPoint {
    #[serde(default)]
    pub(super) time: f64,
    #[serde(default)]
    pub(super) parameter_value: f64,
}
