//! The AHAP file format.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::AhapError;

/// Maximum size of a file, in bytes: a minute of a control curve with a point every millisecond.
const LARGEST: usize = 4_000_000;

/// Latest valid time in a pattern, in seconds: a day.
const LATEST_S: f64 = 86_400.0;

/// The file as written; unknown entries are kept for messages.
#[derive(Debug, Deserialize, Serialize)]
#[serde(rename_all = "PascalCase")]
pub(super) struct File {
    #[serde(default)]
    pub(super) version: Value,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) metadata: Option<Value>,
    #[serde(default)]
    pub(super) pattern: Vec<PatternEntry>,
}

/// One entry of a pattern, with exactly one of its fields.
#[derive(Debug, Default, Deserialize, Serialize)]
#[serde(rename_all = "PascalCase")]
pub(super) struct PatternEntry {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) event: Option<PatternEvent>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) parameter: Option<DynamicParameter>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) parameter_curve: Option<ParameterCurve>,
    #[serde(flatten)]
    pub(super) other: serde_json::Map<String, Value>,
}

#[derive(Debug, Deserialize, Serialize)]
#[serde(rename_all = "PascalCase")]
pub(super) struct PatternEvent {
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
    pub(super) value: JsonNumber,
}

/// A number, or a boolean in its place.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(untagged)]
pub(super) enum JsonNumber {
    Number(f64),
    Truth(bool),
}

impl JsonNumber {
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

impl File {
    /// Parses the file in `text`: JSON with trailing commas and comments, as in files that Apple publishes.
    pub(super) fn parse(text: &str, name: &str) -> Result<Self, AhapError> {
        if text.len() > LARGEST {
            return Err(AhapError::TooLarge(name.to_owned()));
        }
        let written = text.strip_prefix('\u{feff}').unwrap_or(text).as_bytes();
        let mut bytes = written.to_vec();
        if json_strip_comments::strip_slice(&mut bytes).is_err() {
            // The comments are malformed: the JSON reader reports the place.
            bytes = written.to_vec();
        }
        let file: Self = serde_json::from_slice(&bytes).map_err(|error| AhapError::Json {
            name: name.to_owned(),
            line: error.line(),
            column: error.column(),
            reason: error.to_string(),
        })?;
        file.check_times(name)?;
        Ok(file)
    }

    /// Rejects invalid times: negative, not finite, beyond a day.
    fn check_times(&self, name: &str) -> Result<(), AhapError> {
        let check = |entry: usize, field: &'static str, seconds: f64| {
            if (0.0..=LATEST_S).contains(&seconds) {
                return Ok(());
            }
            Err(AhapError::Time { name: name.to_owned(), entry: entry + 1, field, seconds })
        };
        for (index, entry) in self.pattern.iter().enumerate() {
            if let Some(event) = &entry.event {
                check(index, "Time", event.time)?;
                check(index, "EventDuration", event.event_duration.unwrap_or_default())?;
            }
            if let Some(parameter) = &entry.parameter {
                check(index, "Time", parameter.time)?;
            }
            if let Some(curve) = &entry.parameter_curve {
                check(index, "Time", curve.time)?;
                curve
                    .points
                    .iter()
                    .try_for_each(|point| check(index, "Time of a control point", point.time))?;
            }
        }
        Ok(())
    }
}
